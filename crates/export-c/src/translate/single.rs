//! C in single precision: the same text with floats for doubles.
//!
//! Every literal is rounded to a float, as the Rust twin of the code rounds the double, and has the suffix `f`: no operation is done
//! in double precision.

use super::literals::float_literal;

/// Words of C in double precision, with those in single precision.
const WORDS: [(&str, &str); 3] =
    [("double", "float"), ("binary64_infinity", "binary32_infinity"), ("binary64_nan", "binary32_nan")];

/// Parts of the guards about doubles, with those about floats.
const GUARDS: [(&str, &str); 8] = [
    ("doubles are not evaluated", "floats are not evaluated"),
    ("if doubles follow", "if floats follow"),
    (" * double, and none", " * float, and none"),
    ("DBL_MANT_DIG != 53", "FLT_MANT_DIG != 24"),
    ("DBL_MAX_EXP != 1024 || DBL_MIN_EXP != -1021", "FLT_MAX_EXP != 128 || FLT_MIN_EXP != -125"),
    ("double is not the 64-bit number", "float is not the 32-bit number"),
    ("(FLT_EVAL_METHOD != 0 && FLT_EVAL_METHOD != 1)", "FLT_EVAL_METHOD != 0"),
    ("double_has_8_bytes[sizeof(double) == 8", "float_has_4_bytes[sizeof(float) == 4"),
];

/// Returns the guards of a file in single precision, whose constants may be floats.
pub(super) fn guards(text: &str) -> String {
    let kept: Vec<&str> = text.lines().filter(|line| !line.contains("constant")).collect();
    GUARDS.iter().fold(kept.join("\n") + "\n", |text, (double, single)| text.replace(double, single))
}

/// Returns C in single precision; comments and texts stay.
pub fn in_single(text: &str) -> String {
    let mut single = String::with_capacity(text.len());
    let mut rest = text;
    while let Some(first) = rest.chars().next() {
        let length = if rest.starts_with("/*") {
            rest.find("*/").map_or(rest.len(), |end| end + 2)
        } else if first == '"' {
            rest[1..].find('"').map_or(rest.len(), |end| end + 2)
        } else if first.is_ascii_digit() {
            let number = &rest[..number_length(rest)];
            rest = &rest[number.len()..];
            match number_value(number) {
                Some(value) => {
                    single += &literal(value);
                    rest = without_decimal(rest);
                }
                None => single += number,
            }
            continue;
        } else if first.is_ascii_alphabetic() || first == '_' {
            let word = &rest[..word_length(rest)];
            rest = &rest[word.len()..];
            let known = WORDS.iter().find(|(double, _)| *double == word);
            match (known, word.strip_prefix("f64_")) {
                (Some((_, own)), _) => single += own,
                (None, Some(helper)) => single.extend(["f32_", helper]),
                (None, None) => single += word,
            }
            continue;
        } else {
            first.len_utf8()
        };
        single += &rest[..length];
        rest = &rest[length..];
    }
    single
}

/// Returns the length of the word at the start of a text.
fn word_length(text: &str) -> usize {
    text.find(|letter: char| !letter.is_ascii_alphanumeric() && letter != '_').unwrap_or(text.len())
}

/// Returns the length of the number at the start of a text, with its suffix.
fn number_length(text: &str) -> usize {
    let is_hexadecimal = text.starts_with("0x");
    let mut before = '0';
    let end = text.find(|letter: char| {
        let is_sign =
            (letter == '+' || letter == '-') && if is_hexadecimal { before == 'p' } else { before == 'e' };
        before = letter;
        !(letter.is_ascii_alphanumeric() || letter == '.' || is_sign)
    });
    end.unwrap_or(text.len())
}

/// Returns the value of the literal of a double; `None` of an integer.
fn number_value(text: &str) -> Option<f64> {
    let Some(digits) = text.strip_prefix("0x") else {
        return if text.contains(['.', 'e']) { text.parse().ok() } else { None };
    };
    let (significand, exponent) = digits.split_once('p')?;
    let (whole, fraction) = significand.split_once('.').unwrap_or((significand, ""));
    let bits = u64::from_str_radix(&format!("{whole}{fraction}"), 16).ok()?;
    let mut value = bits as f64;
    let power = exponent.parse::<i32>().ok()? - 4 * i32::try_from(fraction.len()).ok()?;
    // Steps of a factor of 2 are exact.
    for _ in 0..power.abs() {
        value *= if power < 0 { 0.5 } else { 2.0 };
    }
    Some(value)
}

/// Returns the literal of the float nearest to a number.
fn literal(value: f64) -> String {
    let rounded = value as f32;
    if rounded.is_infinite() {
        return "binary32_infinity()".to_owned();
    }
    let text = float_literal(f64::from(rounded));
    match text.split_once(" /*") {
        Some((hexadecimal, _)) => format!("{hexadecimal}f /* {rounded:?} */"),
        None => format!("{text}f"),
    }
}

/// Returns a text without the comment at its start that has the decimal digits of the literal before.
fn without_decimal(text: &str) -> &str {
    let Some((comment, rest)) = text.strip_prefix(" /* ").and_then(|text| text.split_once(" */")) else {
        return text;
    };
    if comment.parse::<f64>().is_ok() { rest } else { text }
}
