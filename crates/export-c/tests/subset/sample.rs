//! Sample of each construct of the subset.
//!
//! A second paragraph stays one.

use crate::angles::{AXES, Frame, FramedVector, GAINS, HALF_TURN, add_rows, halved, min};

/// Mask, written in hexadecimal digits.
pub const MASK: u64 = 0x0000_ffff_0000_ffff;
/// Least integer.
const LEAST: i64 = -9_223_372_036_854_775_808;
/// Matrix.
const MATRIX: [[f64; 3]; 2] = [[1.0, 0.1, -0.3], [2.0, HALF_TURN, 1e-300]];
/// Number of states, twice that of the axes.
const STATES: usize = 2 * AXES;
/// Start of a filter.
const START: Filter = Filter { state: [0.25; STATES], inner: FramedVector::ZERO, is_valid: true, count: 3 };
/// Bits of 1.5.
const FROM_BITS: f64 = f64::from_bits(0x3ff8_0000_0000_0000);
/// Flags by number.
const FLAGS: [bool; 4] = [true, false, false, true];

/// Filter with an array and a struct.
#[derive(Clone, Copy)]
pub struct Filter {
    /// State.
    pub state: [f64; STATES],
    /// Vector within.
    pub inner: FramedVector,
    /// True if it may be used.
    pub is_valid: bool,
    /// Number of updates.
    pub count: u32,
}

/// Scalars whose names C reserves.
struct Words {
    double: f64,
    register: i32,
    class: u64,
}

/// Mode of a law.
#[derive(Clone, Copy, PartialEq, Eq)]
enum LawMode {
    Idle,
    Coast,
    MinusTorque,
    PlusTorque,
}

impl Filter {
    /// Number that all filters share.
    const SHARED: u32 = 5;

    /// Returns a filter at its start, with a state copied from an array.
    fn started(x: f64) -> Self {
        let mut state = [0.0; STATES];
        state[1] = x;
        Filter { state, inner: FramedVector::ZERO.with_first(x), is_valid: x > 0.0, count: Self::SHARED }
    }

    /// Advances the state and returns the sum.
    fn advance(&mut self, rate: f64) -> f64 {
        let before = self.state[0];
        self.state[0] = before + rate * self.state[1];
        self.inner.scale(1.0 + rate);
        self.count = self.count.wrapping_add(Filter::SHARED);
        self.settle();
        self.state[0] + self.inner.squared()
    }

    fn settle(&mut self) {
        if !self.is_valid {
            return;
        }
        self.state[2] -= 0.125;
    }

    fn total(&self) -> f64 {
        let mut sum = 0.0;
        for value in 0..self.state.len() {
            sum += self.state[value];
        }
        sum + f64::from(self.count)
    }
}

/// Returns a mode from bits.
fn mode_for(n: u64) -> LawMode {
    match n & 3 {
        0 => LawMode::Idle,
        1 => LawMode::Coast,
        2 => LawMode::MinusTorque,
        _ => LawMode::PlusTorque,
    }
}

/// Covers sums and products, whose order counts.
pub fn arithmetic(a: f64, b: f64, _n: u64) -> f64 {
    let left = (a + b) + 0.1 - (b - a) - (0.3 - a);
    let right = a * (b * a) / (b / (a * 3.0)) - -b;
    let grouped = -(a - b) * -(-a) + (1.0 - 2.0 * (left + right) * 1e-3);
    (left * (right + grouped)) / HALF_TURN + GAINS[1] * FROM_BITS + core::f64::consts::FRAC_PI_6
}

/// Covers comparisons and logical operators.
pub fn logic(a: f64, b: f64, n: u64) -> u64 {
    let small = a < b || (a == b && n > 3) || !(a >= 1.0) && b != 2.0;
    let equal = (a < 1.0) == (b < 1.0);
    let differ = small != !equal;
    let mut all = small & equal | differ ^ FLAGS[(n & 3) as usize];
    all &= n != 7;
    all |= a.is_nan() || b.is_finite();
    u64::from(all) + 2 * u64::from(small) + 4 * u64::from(differ) + (usize::from(equal) as u64) * 8
}

/// Covers bit operations of unsigned integers.
pub fn bits(a: f64, _b: f64, n: u64) -> u64 {
    let word = (n >> 32) as u32;
    let mut mixed = n ^ (a.to_bits() & MASK) | n << 3 & !MASK;
    mixed ^= mixed >> 7;
    mixed <<= 2;
    mixed |= 1;
    mixed &= !0 - 4;
    let count: u32 = 3 + (word & 7);
    let shifted = word >> count | word << (32 - count);
    let turned: usize = 1 << (word & 31);
    mixed.wrapping_mul(0x9e37_79b9_7f4a_7c15).wrapping_add(u64::from(shifted)).wrapping_sub(turned as u64)
        + u64::from(mixed.leading_zeros())
        + u64::from(word.leading_zeros())
        + u64::from((n as i64).leading_zeros())
        + u64::from((n as usize).leading_zeros())
        + (n >> 9 == 4) as u64
}

/// Covers casts: floats saturate.
pub fn casts(a: f64, b: f64, n: u64) -> u64 {
    let first = a as i64;
    let second = (a * 1e-3) as i32;
    let third = b as u32;
    let fourth = (b * 1e9) as u64;
    let fifth = a as usize;
    let back = first as f64 + f64::from(second) + f64::from(third) + fourth as f64 + fifth as f64;
    let wrapped = n as i32 as i64 as u64 ^ (n as u32 as i32) as u64;
    back.to_bits() ^ wrapped ^ (mode_for(n) as u64) ^ (i64::from(a > b) as u64) ^ (i64::from(second) as u64)
}

/// Covers divisions of integers.
pub fn divisions(a: f64, b: f64, n: u64) -> i64 {
    let numerator = a as i32 as i64 - (n as i32) as i64;
    let divisor = i64::from((b as i32).wrapping_mul(3)) * 2 + 1;
    let small = (n as i32).wrapping_add(3).wrapping_sub(i32::MAX);
    let least = LEAST.wrapping_add(numerator).wrapping_mul(31).wrapping_sub(i64::MIN);
    numerator / divisor
        + numerator % divisor * 3
        + numerator.div_euclid(divisor) * 5
        + numerator.rem_euclid(divisor) * 7
        + i64::from((small / 2).div_euclid(-3))
        + i64::from(small.rem_euclid(-7))
        + (n / 10 + n % 10 + n.rem_euclid(9) + n.div_euclid(8)) as i64 / 2
        + least / 4
}

/// Covers branches as statements and as values.
pub fn branches(a: f64, b: f64, n: u64) -> f64 {
    let mode = mode_for(n);
    let factor = match mode {
        LawMode::Idle => 0.0,
        LawMode::Coast | LawMode::PlusTorque => {
            let inner = a * 0.5;
            inner + 1.0
        }
        LawMode::MinusTorque => -1.0,
    };
    let limit: f64;
    if mode == LawMode::Idle {
        limit = 1.0;
    } else if matches!(mode, LawMode::Coast | LawMode::MinusTorque) {
        limit = 2.0;
    } else {
        limit = 3.0;
    }
    // A comment above a statement is kept.
    let bounded = if factor > limit {
        limit
    } else if factor < -limit {
        -limit
    } else {
        let scale = match (n >> 2) % 5 {
            0 | 3 => 0.1,
            1 => return a,
            _ => 0.7,
        };
        factor * scale
    };
    let turn = match (n >> 5) as i32 {
        -1 | 0x7fff_ffff => 0.125,
        0 => -0.5,
        _ => 0.25,
    };
    if n > 3 {
        return bounded * turn;
    }
    if bounded.is_nan() { b } else { min(bounded, halved(b)) }
}

/// Covers loops.
pub fn loops(a: f64, b: f64, n: u64) -> f64 {
    let mut sum = 0.0;
    let mut end: usize = (n & 15) as usize;
    for i in 1..end {
        end -= 1;
        sum += a / (i as f64);
        if i == 9 {
            break;
        }
    }
    for _ in 0..2 {
        sum *= 0.75;
    }
    for sign in -2..(n & 3) as i32 {
        if sign == 0 {
            continue;
        }
        sum += f64::from(sign) * b;
    }
    let mut step: u32 = 0;
    loop {
        step += 1;
        match mode_for(n >> step) {
            LawMode::Idle => break,
            LawMode::Coast => sum += 1.0,
            LawMode::MinusTorque => {
                sum -= 0.3;
                continue;
            }
            LawMode::PlusTorque => {
                if step > 20 {
                    break;
                }
            }
        }
        if step >= 30 {
            break;
        }
    }
    while step > 2 && sum.abs() < 1e6 {
        step /= 2;
        sum *= 1.5;
    }
    sum + end as f64
}

/// Covers structs, methods and copies of arrays.
pub fn structs(a: f64, b: f64, n: u64) -> f64 {
    let mut filter = Filter::started(a);
    let mut other = START;
    let mut sum = filter.advance(b);
    other.inner.scale(a);
    filter.advance(sum * 1e-3);
    if (n & 1) == 0 {
        let twice = filter.advance_twice(b);
        other.state[(n % 6) as usize] = twice;
        sum += other.total();
        let state = [a, b, sum, 0.5, 0.5, 0.5];
        other = Filter { inner: filter.inner, state, is_valid: false, count: 1 };
    }
    let copy = filter;
    let moved = FramedVector { components: filter.inner.components, frame: Frame::LocalOrbit };
    filter.state[3] = f64::from(moved.frame_number()) + moved.frame.number() as f64;
    filter.total() + other.total() + copy.state[3] + moved.squared() + other.inner.components[AXES - 1]
}

impl Filter {
    fn advance_twice(&mut self, rate: f64) -> f64 {
        self.advance(rate);
        self.advance(rate)
    }
}

/// Adds to a number and counts.
fn add_to(sum: &mut f64, term: &f64, count: &mut u32) {
    *sum += *term * 0.5;
    *count += 1;
}

/// Fills and adds a slice.
fn fill(values: &mut [f64], start: f64) -> f64 {
    let mut sum = 0.0;
    for i in 0..values.len() {
        values[i] = start + i as f64;
        sum += values[i];
    }
    sum
}

/// Returns the weighted sum of a slice.
fn weigh(values: &[f64], weights: &[f64; AXES]) -> f64 {
    first_of(values) + values[1] * weights[1] + weights[2]
}

fn first_of(values: &[f64]) -> f64 {
    values[0]
}

fn trace(matrix: &[[f64; 3]; 3]) -> f64 {
    matrix[0][0] + matrix[1][1] + matrix[2][2]
}

fn transpose(matrix: &mut [[f64; 3]; 3]) {
    for i in 0..3 {
        for j in 0..i {
            let held = matrix[i][j];
            matrix[i][j] = matrix[j][i];
            matrix[j][i] = held;
        }
    }
}

/// Covers references, slices and arrays of arrays.
pub fn references(a: f64, b: f64, n: u64) -> f64 {
    let mut sum = a;
    let mut count: u32 = 0;
    add_to(&mut sum, &b, &mut count);
    add_to(&mut sum, &GAINS[2], &mut count);
    let mut filter = START;
    let filled = fill(&mut filter.state, b);
    let mut vector = [a, b, 1.0];
    add_rows(&MATRIX, &GAINS, &mut vector);
    let mut square = [[vector[0], vector[1], vector[2]], [a, 0.5, b], [0.0; 3]];
    square[2][0] = filled;
    transpose(&mut square);
    let held = Held { matrix: square };
    weigh(&vector, &GAINS)
        + held.trace()
        + trace(&square)
        + sum
        + f64::from(count)
        + weigh(&filter.state, &vector) * (n & 1) as f64
        + sum_of(&[])
        + sum_of(&[a, 2.0 * b])
}

/// Returns the sum of numbers, of which there may be none.
fn sum_of(values: &[f64]) -> f64 {
    let mut sum = 0.0;
    for index in 0..values.len() {
        sum += values[index];
    }
    sum
}

/// Matrix in a struct.
struct Held {
    matrix: [[f64; 3]; 3],
}

impl Held {
    fn trace(&self) -> f64 {
        trace(&self.matrix) + self.matrix[0][2]
    }
}

/// Covers names: shadowed ones, and those that C reserves.
pub fn names(a: f64, b: f64, n: u64) -> f64 {
    let x = a;
    let x = x + 1.0;
    let int = {
        let x = b;
        x * 2.0
    };
    let default = if n > 5 {
        let x = x * int;
        x - 1.0
    } else {
        x
    };
    let words = Words { double: default, register: -3, class: n };
    let f64_abs = words.double.copysign(x) + f64::from(words.register);
    let mut selected = words_of(f64_abs);
    selected.class = words.class.wrapping_add(1);
    f64_abs.abs() + selected.class as f64 + infinite(n).min_of(x)
}

fn words_of(double: f64) -> Words {
    Words { double, register: i32::MIN, class: u64::MAX }
}

impl Words {
    fn min_of(self, x: f64) -> f64 {
        min(self.double, x) + f64::from(self.register) * 1e-9 + (self.class >> 60) as f64
    }
}

fn infinite(n: u64) -> Words {
    let double = if n > 9 { f64::INFINITY } else { f64::MIN_POSITIVE };
    words_of(double)
}
