//! Formatting of numbers in tables for people.

/// Formats a number by `format`, or as missing.
pub fn number_or_none(value: Option<f64>, format: impl Fn(f64) -> String) -> String {
    value.map_or_else(|| "none".to_owned(), format)
}

/// Formats a number with `decimals` decimals, without the sign of one that is rounded to 0.
pub fn unsigned_zero(value: f64, decimals: usize) -> String {
    let text = format!("{value:.decimals$}");
    match text.strip_prefix('-') {
        Some(rest) if !rest.contains(|digit: char| ('1'..='9').contains(&digit)) => rest.to_owned(),
        _ => text,
    }
}

/// Formats a number in at most ten characters.
pub fn short(number: f64) -> String {
    if number.is_nan() {
        "-".to_owned()
    } else if number == 0.0 {
        "0".to_owned()
    } else if (1e-3..1e6).contains(&number.abs()) {
        // Four significant digits, and one decimal of large numbers.
        let scientific = format!("{number:.3e}");
        let exponent = scientific.split_once('e').and_then(|(_, exponent)| exponent.parse::<i32>().ok());
        let digits = usize::try_from(3 - exponent.unwrap_or(0)).unwrap_or(1).max(1);
        format!("{number:.digits$}")
    } else {
        format!("{number:.3e}")
    }
}
