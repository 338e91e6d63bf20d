//! Self-test: a hash over the outputs of many calls with random and extreme inputs, which the exported code repeats.

use flexsc_flight::ticks::Ticks;
use flexsc_flight_precision::Precision;

use crate::control_system::{CallLayout, Channel, ControlSystem, NumberKind};

/// Cycles after which the state is set again, so that inputs that are not numbers do not stay in it.
pub const BLOCK: u64 = 256;
/// Number of blocks, of which the last has extreme inputs.
pub const EXTREME_BLOCK: u64 = 16;
/// State of the generator at the start.
pub const SEED: u64 = 0x9E37_79B9_7F4A_7C15;
/// Returns the extreme inputs: zeros of both signs, the least and the largest subnormal number, a huge one, infinities, NaN.
pub fn extremes(precision: Precision) -> [u64; 8] {
    let [zero, negative_zero, _, _, _, infinity, negative_infinity, nan] = EXTREMES;
    match precision {
        Precision::Double => EXTREMES,
        Precision::Single => {
            let [least, largest, huge] =
                [0x0000_0001, 0x007F_FFFF, 0x7E96_7699].map(|bits| f64::from(f32::from_bits(bits)).to_bits());
            [zero, negative_zero, least, largest, huge, infinity, negative_infinity, nan]
        }
    }
}

/// Extreme inputs in double precision.
const EXTREMES: [u64; 8] = [
    0x0000_0000_0000_0000,
    0x8000_0000_0000_0000,
    0x0000_0000_0000_0001,
    0x000F_FFFF_FFFF_FFFF,
    0x7E37_E43C_8800_759C,
    0x7FF0_0000_0000_0000,
    0xFFF0_0000_0000_0000,
    0x7FF8_0000_0000_0000,
];

/// Generator of inputs: xorshift with 64 bits.
struct Inputs(u64);

impl Inputs {
    fn draw(&mut self) -> u64 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        self.0
    }

    /// Returns the next input of a channel.
    fn word(&mut self, channel: &Channel, extremes: Option<&[u64; 8]>) -> u64 {
        let bits = self.draw();
        match channel.kind {
            NumberKind::Flag => bits & 1,
            NumberKind::Integer(below) => bits % below.max(1),
            NumberKind::Real => {
                if let Some(extremes) = extremes.filter(|_| bits.is_multiple_of(8)) {
                    return extremes[(bits >> 3 & 7) as usize];
                }
                let size = match bits & 3 {
                    0 => 1024.0,
                    1 => 1.0 / 1024.0,
                    _ => 1.0,
                };
                let unit = 2.0 * ((bits >> 11) as f64 / 9_007_199_254_740_992.0) - 1.0;
                (unit * channel.scale * size).to_bits()
            }
        }
    }
}

/// Function of the control system, with one entry for each word.
struct WordLayout<'a> {
    inputs: Vec<&'a Channel>,
    outputs: Vec<NumberKind>,
    is_start: bool,
}

impl<'a> WordLayout<'a> {
    fn new(call: &'a CallLayout) -> Self {
        let words = |channels: &'a [Channel]| {
            channels.iter().flat_map(|channel| std::iter::repeat_n(channel, channel.count))
        };
        Self {
            inputs: words(&call.inputs).collect(),
            outputs: words(&call.outputs).map(|channel| channel.kind).collect(),
            is_start: call.is_start,
        }
    }
}

/// Returns the hash (FNV-1a of 64 bits) over the outputs of all functions in a number of cycles; all NaN count as one value.
pub fn self_test(system: &ControlSystem, cycles: u64) -> u64 {
    self_tests(system, [cycles])[0]
}

/// Returns the hashes of [`self_test`] for several numbers of cycles, in one pass.
pub fn self_tests<const N: usize>(system: &ControlSystem, cycles: [u64; N]) -> [u64; N] {
    let calls = system.calls();
    let layouts: Vec<_> = calls.iter().map(WordLayout::new).collect();
    let (milliseconds, extremes) = (cycle_milliseconds(system), extremes(system.precision()));
    let (mut inputs, mut hash) = (Inputs(SEED), 0xCBF2_9CE4_8422_2325_u64);
    let mut hashes = [hash; N];
    let (mut current, mut words) = (system.clone(), Vec::new());
    for cycle in 0..cycles.into_iter().max().unwrap_or(0) {
        let is_extreme = cycle / BLOCK % EXTREME_BLOCK == EXTREME_BLOCK - 1;
        let time = cycle * milliseconds;
        let now = Ticks { whole: (time / 1000) as i64, part: (time % 1000) as i64 * 1_000_000_000_000 };
        if cycle % BLOCK == 0 {
            current = system.clone();
            current.start_at(now);
        }
        let due = |call: &WordLayout<'_>| !call.is_start || cycle % BLOCK == 0;
        for (index, call) in layouts.iter().enumerate().filter(|(_, call)| due(call)) {
            words.clear();
            let own = is_extreme.then_some(&extremes);
            words.extend(call.inputs.iter().map(|channel| inputs.word(channel, own)));
            let mut place = 0;
            for channel in &calls[index].inputs {
                if channel.is_unit && !is_extreme {
                    unit_words(&mut words[place..place + channel.count]);
                }
                place += channel.count;
            }
            let outputs = current.call(index, now, &words);
            for (word, kind) in outputs.into_iter().zip(&call.outputs) {
                for byte in canonical(word, *kind).to_le_bytes() {
                    hash = (hash ^ u64::from(byte)).wrapping_mul(0x0000_0100_0000_01B3);
                }
            }
        }
        for (known, _) in hashes.iter_mut().zip(cycles).filter(|(_, cycles)| *cycles == cycle + 1) {
            *known = hash;
        }
    }
    hashes
}

/// Replaces words of numbers by those of a unit vector, whose last number is free: the inverse stereographic projection.
fn unit_words(words: &mut [u64]) {
    let count = words.len() - 1;
    let mut square = 0.0;
    for word in &words[..count] {
        square += f64::from_bits(*word) * f64::from_bits(*word);
    }
    for word in &mut words[..count] {
        *word = (2.0 * f64::from_bits(*word) / (1.0 + square)).to_bits();
    }
    words[count] = ((1.0 - square) / (1.0 + square)).to_bits();
}

/// Returns the milliseconds of a period of the self-test.
pub fn cycle_milliseconds(system: &ControlSystem) -> u64 {
    (flexsc_flight::maths::round(system.period() * 1000.0) as u64).max(1)
}

/// Returns a word with one pattern for all NaN.
fn canonical(word: u64, kind: NumberKind) -> u64 {
    if kind == NumberKind::Real && f64::from_bits(word).is_nan() { 0x7FF8_0000_0000_0000 } else { word }
}
