//! Values on which programs are known to fail.

use crate::chance::Chance;

/// Numbers, as they are written.
const NUMBERS: &[&str] = &[
    "0",
    "-0.0",
    "1",
    "2",
    "3",
    "-1",
    "0.5",
    "0.1",
    "1e-3",
    "nan",
    "inf",
    "-inf",
    "1e999",
    "-1e999",
    "5e-324",
    "1e-308",
    "1e-30",
    "1e-15",
    "1e-12",
    "1e-9",
    "1e-6",
    "1e3",
    "1e4",
    "1e5",
    "1e6",
    "1.45e7",
    "1e9",
    "1e10",
    "1e12",
    "1e15",
    "1e18",
    "1e20",
    "1e21",
    "1e30",
    "1e150",
    "1e154",
    "1e300",
    "1.7976931348623157e308",
    "-1e308",
    "3.141592653589793",
    "6.283185307179586",
    "1.0000000000000002",
    "0.9999999999999999",
    "10",
    "12",
    "100",
    "255",
    "256",
    "1000",
    "1024",
    "2000",
    "2001",
    "65535",
    "65536",
    "1000000",
    "16777217",
    "2147483647",
    "2147483648",
    "4294967295",
    "4294967296",
    "9007199254740993",
    "9223372036854775807",
    "-9223372036854775808",
    "9223372036854775808",
    "18446744073709551615",
    "18446744073709551616",
    "1e-400",
];

/// Values other than numbers.
const OTHERS: &[&str] = &[
    "true",
    "false",
    "\"\"",
    "\"a\"",
    "\"true\"",
    "\"none\"",
    "\"../x\"",
    "\"/dev/null\"",
    "\"\\u0000\"",
    "\"\\u001b[31m\"",
    "\"\u{202e}\u{1f680}\"",
    "\"a b\"",
    "\"%s%n\"",
    "[]",
    "[[]]",
    "[0]",
    "[1, 2, 3]",
    "[0, 0, 0]",
    "{}",
    "null",
    "2026-03-20T14:46:00Z",
    "0001-01-01T00:00:00Z",
    "9999-12-31T23:59:60Z",
    "0xffffffffffffffff",
    "1_0",
    "''",
    "{ uniform = [0, 1] }",
    "{ normal = [0, 1e308] }",
    "{ relative_normal = 1e9 }",
];

/// Whole numbers of 64 bits.
const WHOLE: &[u64] = &[
    0,
    1,
    2,
    3,
    7,
    8,
    127,
    128,
    255,
    256,
    1000,
    65_535,
    65_536,
    1 << 20,
    1 << 24,
    1 << 28,
    1 << 30,
    (1 << 31) - 1,
    1 << 31,
    (1 << 32) - 1,
    1 << 32,
    1 << 40,
    1 << 48,
    (1 << 63) - 1,
    1 << 63,
    u64::MAX - 8,
    u64::MAX - 1,
    u64::MAX,
];

/// A number, as it is written.
pub fn number(chance: &mut Chance) -> &'static str {
    chance.one(NUMBERS)
}

/// Any value, as it is written.
pub fn leaf(chance: &mut Chance) -> String {
    match chance.below(20) {
        0..14 => chance.one(NUMBERS).to_owned(),
        14..19 => chance.one(OTHERS).to_owned(),
        _ => format!("\"{}\"", "x".repeat(1 << chance.below(16))),
    }
}

/// A whole number, at times one near to `near`.
pub fn whole(chance: &mut Chance, near: u64) -> u64 {
    match chance.below(4) {
        0 => near.wrapping_add(chance.number() % 9).wrapping_sub(4),
        1 => near.wrapping_mul(1 + chance.number() % 5),
        _ => WHOLE[chance.below(WHOLE.len())],
    }
}
