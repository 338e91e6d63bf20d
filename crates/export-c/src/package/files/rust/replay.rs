//! Replays the calls of a run of flexsc in `vectors.bin`, and compares every output by bits; then calls the functions with random and
//! extreme inputs, and compares a hash over their outputs.

#![allow(dead_code, clippy::all, reason = "the functions of a control system use a part of it")]

use NAME::control_system::*;
TICKS
/// True of a function that is called once in a block of cycles, before the others.
const IS_START: [bool; COUNT] = [STARTS];
/// Extreme inputs.
const EXTREMES: [u64; 8] = [EXTREME_WORDS];

/// Source of inputs.
enum Source {
    /// Bytes of the file: words of 64 bits, little endian.
    File(&'static [u8]),
    /// Generator of random inputs, and whether some are extreme.
    Random(u64, bool),
}

impl Source {
    fn word(&mut self) -> u64 {
        match self {
            Self::File(bytes) => {
                let (first, rest) = bytes.split_first_chunk().expect("a file of whole calls");
                *bytes = rest;
                u64::from_le_bytes(*first)
            }
            Self::Random(state, _) => {
                *state ^= *state << 13;
                *state ^= *state >> 7;
                *state ^= *state << 17;
                *state
            }
        }
    }

    /// Returns a number, at random one of this typical size.
    fn wide(&mut self, scale: f64) -> f64 {
        let word = self.word();
        match self {
            Self::File(_) => f64::from_bits(word),
            Self::Random(_, true) if word % 8 == 0 => f64::from_bits(EXTREMES[(word >> 3 & 7) as usize]),
            Self::Random(..) => {
                let size = match word & 3 {
                    0 => 1024.0,
                    1 => 1.0 / 1024.0,
                    _ => 1.0,
                };
                (2.0 * ((word >> 11) as f64 / 9_007_199_254_740_992.0) - 1.0) * scale * size
            }
        }
    }

    fn real(&mut self, scale: f64) -> REAL {
        self.wide(scale) as REAL
    }

    fn reals<const N: usize>(&mut self, scale: f64) -> [REAL; N] {
        std::array::from_fn(|_| self.real(scale))
    }

    /// Returns the components of a unit vector: at random by the inverse stereographic projection.
    fn units<const N: usize>(&mut self, scale: f64) -> [REAL; N] {
        let mut numbers: [f64; N] = std::array::from_fn(|_| self.wide(scale));
        if matches!(self, Self::Random(_, false)) {
            let square = numbers[..N - 1].iter().fold(0.0, |sum, number| sum + number * number);
            numbers[..N - 1].iter_mut().for_each(|number| *number = 2.0 * *number / (1.0 + square));
            numbers[N - 1] = (1.0 - square) / (1.0 + square);
        }
        numbers.map(|number| number as REAL)
    }

    fn flag(&mut self) -> bool {
        let word = self.word();
        if matches!(self, Self::File(_)) { word != 0 } else { word & 1 != 0 }
    }

    fn flags<const N: usize>(&mut self) -> [bool; N] {
        std::array::from_fn(|_| self.flag())
    }

    fn integer(&mut self, below: u64) -> i64 {
        let word = self.word();
        if matches!(self, Self::File(_)) { word as i64 } else { (word % below) as i64 }
    }
}

/// Returns the bits of a number, of all NaN alike.
fn bits(number: REAL) -> u64 {
    if number.is_nan() { 0x7FF8_0000_0000_0000 } else { f64::from(number).to_bits() }
}

fn begin(state: &mut State, _time: [i64; 2]) {
    INIT
}

/// Calls a function with the next inputs, and returns the words of its outputs with their names.
fn call(index: usize, _time: [i64; 2], state: &mut State, from: &mut Source) -> Vec<(&'static str, u64)> {
    let mut found = Vec::new();
    match index {
CALLS        _ => panic!("no function {index}"),
    }
    found
}

#[test]
fn every_call_of_the_run_is_equal() {
    let mut file = Source::File(include_bytes!("../vectors.bin"));
    assert_eq!(file.word().to_le_bytes(), *b"flexscV1");
    let count = file.word();
    let mut state = State::UNSET;
    begin(&mut state, [0, 0]);
    for number in 0..count {
        let index = file.word() as usize;
        let time = [file.word() as i64, file.word() as i64];
        for (name, found) in call(index, time, &mut state, &mut file) {
            let expected = file.word();
            let both_are_nan = f64::from_bits(found).is_nan() && f64::from_bits(expected).is_nan();
            assert!(
                found == expected || both_are_nan,
                "call {number} at {} s: {name} is {found:016x}, not {expected:016x}",
                time[0]
            );
        }
    }
    assert!(count > 0 && matches!(file, Source::File([])));
}

#[test]
fn the_hash_over_random_and_extreme_calls_is_equal() {
    let (mut hash, mut inputs) = (0xCBF2_9CE4_8422_2325_u64, Source::Random(SEED, false));
    let mut state = State::UNSET;
    for cycle in 0..CYCLES_u64 {
        let time = cycle * MILLISECONDS;
        let time = [(time / 1000) as i64, (time % 1000) as i64 * 1_000_000_000_000];
        if cycle % BLOCK == 0 {
            begin(&mut state, time);
        }
        if let Source::Random(_, is_extreme) = &mut inputs {
            *is_extreme = cycle / BLOCK % EXTREME == EXTREME - 1;
        }
        for (index, is_start) in IS_START.into_iter().enumerate() {
            if is_start && cycle % BLOCK != 0 {
                continue;
            }
            for (_, word) in call(index, time, &mut state, &mut inputs) {
                for byte in word.to_le_bytes() {
                    hash = (hash ^ u64::from(byte)).wrapping_mul(0x0000_0100_0000_01B3);
                }
            }
        }
    }
    assert_eq!(hash, HASH, "{hash:016x}");
}
