//! Comparison of the functions with those of the crate `libm`, bit by bit.

use std::hint::black_box;

use crate::exponentials::{exp, expm1, log};
use crate::hypotenuse::hypot;
use crate::integer_square_root::root_by_digits;
use crate::inverse_trigonometry::{acos, asin, atan, atan2};
use crate::maths::{clamp, floor, max, min, round, trunc};
use crate::square_root::sqrt;
use crate::trigonometry::{cos, sin, sincos, tan};

mod arguments;

use arguments::{Arguments, SPECIAL};

/// Arguments of each kind in the short comparison, and in the long one.
const SHORT: usize = 100_000;
const LONG: usize = 10_000_000;

/// Function of one argument, what it is compared with, and the range in which most calls are.
struct Case {
    name: &'static str,
    function: fn(f64) -> f64,
    reference: fn(f64) -> f64,
    range: [f64; 2],
}

/// Function of two arguments, and what it is compared with.
struct PairCase {
    name: &'static str,
    function: fn(f64, f64) -> f64,
    reference: fn(f64, f64) -> f64,
}

const CASES: [Case; 20] = [
    Case { name: "sin", function: sin, reference: libm::sin, range: [-10.0, 10.0] },
    Case { name: "cos", function: cos, reference: libm::cos, range: [-10.0, 10.0] },
    Case { name: "tan", function: tan, reference: libm::tan, range: [-10.0, 10.0] },
    Case { name: "sin far", function: sin, reference: libm::sin, range: [-2e6, 2e6] },
    Case { name: "cos far", function: cos, reference: libm::cos, range: [-2e6, 2e6] },
    Case { name: "tan far", function: tan, reference: libm::tan, range: [-2e6, 2e6] },
    Case { name: "sine of both", function: sine_of_both, reference: libm::sin, range: [-10.0, 10.0] },
    Case { name: "cosine of both", function: cosine_of_both, reference: libm::cos, range: [-10.0, 10.0] },
    Case { name: "atan", function: atan, reference: libm::atan, range: [-4.0, 4.0] },
    Case { name: "asin", function: asin, reference: libm::asin, range: [-1.0, 1.0] },
    Case { name: "acos", function: acos, reference: libm::acos, range: [-1.0, 1.0] },
    Case { name: "exp", function: exp, reference: libm::exp, range: [-750.0, 715.0] },
    Case { name: "exp of small numbers", function: exp, reference: libm::exp, range: [-3.0, 3.0] },
    Case { name: "expm1 of small numbers", function: expm1, reference: libm::expm1, range: [-1.5, 1.5] },
    Case { name: "expm1", function: expm1, reference: libm::expm1, range: [-45.0, 45.0] },
    Case { name: "log", function: log, reference: libm::log, range: [0.0, 4.0] },
    Case { name: "sqrt", function: sqrt, reference: libm::sqrt, range: [0.0, 100.0] },
    Case { name: "round", function: round, reference: libm::round, range: [-100.0, 100.0] },
    Case { name: "trunc", function: trunc, reference: libm::trunc, range: [-100.0, 100.0] },
    Case { name: "floor", function: floor, reference: libm::floor, range: [-100.0, 100.0] },
];

const PAIR_CASES: [PairCase; 2] = [
    PairCase { name: "atan2", function: atan2, reference: libm::atan2 },
    PairCase { name: "hypot", function: hypot, reference: libm::hypot },
];

/// Square root by integers, which is compared whatever the features are.
const DIGITS: Case =
    Case { name: "root by digits", function: root_by_digits, reference: libm::sqrt, range: [0.0, 100.0] };

fn sine_of_both(x: f64) -> f64 {
    sincos(x).sin
}

fn cosine_of_both(x: f64) -> f64 {
    sincos(x).cos
}

/// True if two numbers have the same bits, or are both NaN.
fn equal(a: f64, b: f64) -> bool {
    a.to_bits() == b.to_bits() || (a.is_nan() && b.is_nan())
}

fn check(case: &Case, x: f64) {
    let (found, expected) = ((case.function)(x), (case.reference)(x));
    assert!(
        equal(found, expected),
        "{}({x:e}) = {found:e}, not {expected:e}; bits {:016x}, {:016x}, {:016x}",
        case.name,
        x.to_bits(),
        found.to_bits(),
        expected.to_bits()
    );
}

fn check_pair(case: &PairCase, x: f64, y: f64) {
    let (found, expected) = ((case.function)(x, y), (case.reference)(x, y));
    assert!(equal(found, expected), "{}({x:e}, {y:e}) = {found:e}, not {expected:e}", case.name);
}

fn compare(case: &Case, count: usize) {
    let mut arguments = Arguments::new();
    for x in SPECIAL {
        for x in arguments::neighbours(x) {
            check(case, x);
            check(case, -x);
        }
        for _ in 0..300 {
            let x = arguments.near(x);
            check(case, x);
            check(case, -x);
        }
    }
    for _ in 0..count {
        check(case, arguments.any());
        check(case, arguments.within(case.range));
        check(case, arguments.near_multiple());
    }
}

fn compare_pair(case: &PairCase, count: usize) {
    let mut arguments = Arguments::new();
    for x in SPECIAL {
        for y in SPECIAL {
            for (x, y) in [(x, y), (-x, y), (x, -y), (-x, -y)] {
                check_pair(case, x, y);
            }
        }
    }
    for _ in 0..count {
        check_pair(case, arguments.any(), arguments.any());
        check_pair(case, arguments.within([-2.0, 2.0]), arguments.within([-2.0, 2.0]));
        let x = arguments.any();
        check_pair(case, x, x * arguments.within([-100.0, 100.0]));
    }
}

#[test]
fn functions_have_the_bits_of_libm() {
    for case in &CASES {
        compare(case, SHORT);
    }
    for case in &PAIR_CASES {
        compare_pair(case, SHORT);
    }
    compare(&DIGITS, SHORT / 5);
}

#[test]
#[ignore = "takes minutes: `cargo test --release -p flexsc-flight -- --ignored`"]
fn functions_have_the_bits_of_libm_for_many_arguments() {
    for case in CASES.iter().chain([&DIGITS]) {
        compare(case, LONG);
        std::eprintln!("{}: {} arguments", case.name, 3 * LONG);
    }
    for case in &PAIR_CASES {
        compare_pair(case, LONG);
        std::eprintln!("{}: {} pairs", case.name, 3 * LONG);
    }
}

#[test]
fn every_nan_has_the_same_bits() {
    for x in [f64::NAN, -f64::NAN, f64::INFINITY, -f64::INFINITY, 2.0, -2.0] {
        for case in CASES.iter().filter(|case| !["round", "trunc", "floor", "sqrt"].contains(&case.name)) {
            let value = (case.function)(x);
            assert!(!value.is_nan() || value.to_bits() == 0x7ff8_0000_0000_0000, "{}({x})", case.name);
        }
        assert!(atan2(x, f64::NAN).to_bits() == 0x7ff8_0000_0000_0000);
    }
}

#[test]
fn minimum_maximum_and_limits_are_those_of_rust() {
    let mut arguments = Arguments::new();
    let compare = |a: f64, b: f64, c: f64| {
        // The sign of a zero among two is not specified in Rust.
        if a != 0.0 || b != 0.0 {
            assert!(equal(min(a, b), black_box(a).min(black_box(b))), "{a} {b}");
            assert!(equal(max(a, b), black_box(a).max(black_box(b))), "{a} {b}");
        }
        if b <= c {
            assert!(equal(clamp(a, b, c), black_box(a).clamp(b, c)), "{a} {b} {c}");
        }
    };
    for a in SPECIAL {
        for b in SPECIAL {
            for (a, b) in [(a, b), (-a, b), (a, -b), (-a, -b)] {
                compare(a, b, 1.0);
                compare(a, b, f64::INFINITY);
            }
        }
    }
    for _ in 0..SHORT {
        compare(arguments.any(), arguments.any(), arguments.any());
    }
    for (a, b) in [(0.0, -0.0), (-0.0, 0.0)] {
        assert!(equal(min(a, b), a) && equal(max(a, b), a) && equal(clamp(a, b, b), a));
    }
}
