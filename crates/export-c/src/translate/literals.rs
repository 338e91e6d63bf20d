//! Literals of C: hexadecimal floats, which no decimal parser rounds, and integers of their types.

use super::types::IntegerKind;

/// Returns a finite number as a literal of C: decimal if it is short and exact, else hexadecimal with the decimal in a
/// comment.
pub fn float_literal(value: f64) -> String {
    let decimal = format!("{value:?}");
    if is_short_and_exact(value) {
        return decimal;
    }
    format!("{} /* {decimal} */", hexadecimal(value))
}

/// Returns a finite number as a literal of C in a precision: the literal of a float is rounded as the Rust twin of the code rounds the
/// double.
pub(super) fn real_literal(value: f64, is_single: bool) -> String {
    if !is_single {
        return float_literal(value);
    }
    let rounded = value as f32;
    let text = float_literal(f64::from(rounded));
    match text.split_once(" /*") {
        Some((hexadecimal, _)) => format!("{hexadecimal}f /* {rounded:?} */"),
        None => format!("{text}f"),
    }
}

/// True if the decimal digits of a number give it without rounding: a multiple of 1/1024 below a million.
fn is_short_and_exact(value: f64) -> bool {
    let scaled = value * 1024.0;
    value.abs() < 1e6 && scaled == scaled.trunc() && format!("{value:?}").len() <= 8
}

/// Returns a finite number as a hexadecimal literal.
fn hexadecimal(value: f64) -> String {
    let bits = value.to_bits();
    let sign = if bits >> 63 == 1 { "-" } else { "" };
    let exponent = ((bits >> 52) & 0x7ff) as i32;
    let fraction = bits & 0x000f_ffff_ffff_ffff;
    let digits = format!("{fraction:013x}");
    let digits = digits.trim_end_matches('0');
    let point = if digits.is_empty() { "" } else { "." };
    if exponent == 0 {
        return format!("{sign}0x0{point}{digits}p-1022");
    }
    let exponent = exponent - 1023;
    format!("{sign}0x1{point}{digits}p{exponent:+}")
}

/// Returns an integer as a literal of C; `digits` are its hexadecimal ones, where Rust wrote those.
pub(super) fn integer_literal(value: i128, kind: IntegerKind, digits: Option<&str>) -> String {
    let sign = if value < 0 { "-" } else { "" };
    let magnitude = value.unsigned_abs();
    let text = match digits {
        Some(digits) => format!("0x{}", digits.to_lowercase()),
        None => magnitude.to_string(),
    };
    match kind {
        IntegerKind::I32 if value == i128::from(i32::MIN) => "(-2147483647 - 1)".to_owned(),
        IntegerKind::I64 if value == i128::from(i64::MIN) => "(-INT64_C(9223372036854775807) - 1)".to_owned(),
        IntegerKind::I32 => format!("{sign}{text}"),
        IntegerKind::I64 => format!("{sign}INT64_C({text})"),
        IntegerKind::U32 => format!("{text}U"),
        IntegerKind::U64 => format!("UINT64_C({text})"),
        IntegerKind::Usize if magnitude <= i32::MAX as u128 => text,
        IntegerKind::Usize => format!("(size_t)UINT64_C({text})"),
    }
}

/// Returns the hexadecimal digits of a written literal, or none if it is decimal.
pub(super) fn hexadecimal_digits(written: &str, suffix: &str) -> Option<String> {
    let digits = written.strip_prefix("0x")?;
    Some(digits.strip_suffix(suffix).unwrap_or(digits).replace('_', ""))
}

/// Returns a constant of `core::f64::consts`.
pub(super) fn mathematical_constant(name: &str) -> Option<f64> {
    use std::f64::consts as c;
    Some(match name {
        "PI" => c::PI,
        "TAU" => c::TAU,
        "E" => c::E,
        "FRAC_PI_2" => c::FRAC_PI_2,
        "FRAC_PI_3" => c::FRAC_PI_3,
        "FRAC_PI_4" => c::FRAC_PI_4,
        "FRAC_PI_6" => c::FRAC_PI_6,
        "FRAC_PI_8" => c::FRAC_PI_8,
        "FRAC_1_PI" => c::FRAC_1_PI,
        "FRAC_2_PI" => c::FRAC_2_PI,
        "FRAC_2_SQRT_PI" => c::FRAC_2_SQRT_PI,
        "SQRT_2" => c::SQRT_2,
        "FRAC_1_SQRT_2" => c::FRAC_1_SQRT_2,
        "LN_2" => c::LN_2,
        "LN_10" => c::LN_10,
        "LOG2_E" => c::LOG2_E,
        "LOG2_10" => c::LOG2_10,
        "LOG10_E" => c::LOG10_E,
        "LOG10_2" => c::LOG10_2,
        _ => return None,
    })
}

/// Returns a constant of the type `f64`.
pub(super) fn float_constant(name: &str) -> Option<f64> {
    Some(match name {
        "MAX" => f64::MAX,
        "MIN" => f64::MIN,
        "MIN_POSITIVE" => f64::MIN_POSITIVE,
        "EPSILON" => f64::EPSILON,
        "INFINITY" => f64::INFINITY,
        "NEG_INFINITY" => f64::NEG_INFINITY,
        "NAN" => f64::from_bits(0x7ff8_0000_0000_0000),
        _ => return None,
    })
}
