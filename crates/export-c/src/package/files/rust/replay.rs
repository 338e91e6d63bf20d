//! Replays the calls of a run of flexsc in `vectors.bin`, and compares every output by bits.

use NAME::control_system::*;
use NAME::ticks::Ticks;

/// Reader of words of 64 bits, little endian.
struct Words<'a>(&'a [u8]);

impl Words<'_> {
    fn word(&mut self) -> u64 {
        let (first, rest) = self.0.split_first_chunk().expect("a file of whole calls");
        self.0 = rest;
        u64::from_le_bytes(*first)
    }

    #[allow(dead_code)]
    fn real(&mut self) -> REAL {
        f64::from_bits(self.word()) as REAL
    }

    #[allow(dead_code)]
    fn flag(&mut self) -> bool {
        self.word() != 0
    }

    #[allow(dead_code)]
    fn integer(&mut self) -> i64 {
        self.word() as i64
    }
}

/// Returns the bits of a number, of all NaN alike.
#[allow(dead_code)]
fn bits(number: REAL) -> u64 {
    if number.is_nan() { f64::NAN.to_bits() } else { f64::from(number).to_bits() }
}

/// Calls a function with inputs from the file, and returns the words of its outputs with their names.
fn call(index: u64, _now: Ticks, state: &mut State, words: &mut Words<'_>) -> Vec<(&'static str, u64)> {
    let mut found = Vec::new();
    match index {
CALLS        _ => panic!("no function {index}"),
    }
    found
}

#[test]
fn every_call_of_the_run_is_equal() {
    let mut words = Words(include_bytes!("../vectors.bin"));
    assert_eq!(words.word().to_le_bytes(), *b"flexscV1");
    let count = words.word();
    let mut state = State::UNSET;
    init(INIT);
    for number in 0..count {
        let index = words.word();
        let now = Ticks { whole: words.word() as i64, part: words.word() as i64 };
        for (name, found) in call(index, now, &mut state, &mut words) {
            let expected = words.word();
            let both_are_nan = f64::from_bits(found).is_nan() && f64::from_bits(expected).is_nan();
            assert!(
                found == expected || both_are_nan,
                "call {number} at {} s: {name} is {found:016x}, not {expected:016x}",
                now.seconds()
            );
        }
    }
    assert!(words.0.is_empty() && count > 0);
}
