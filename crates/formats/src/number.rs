//! Numbers in text files, as C and Fortran print them.

/// Parses a finite number: `D` stands for `E`, and behind digits with a point an exponent may have neither.
pub fn real(field: &str) -> Option<f64> {
    let field = field.trim();
    if let Some(number) =
        field.parse::<f64>().ok().filter(|_| field.ends_with(|c: char| c.is_ascii_digit() || c == '.'))
    {
        return Some(number).filter(|number| number.is_finite());
    }
    let (digits, exponent) = if let Some(at) = field.find(['e', 'E', 'd', 'D']) {
        (&field[..at], &field[at + 1..])
    } else {
        field.split_at(field.rfind(['+', '-']).filter(|at| field[..*at].contains('.'))?)
    };
    let is_number = |text: &str, more: &str| {
        text.bytes().all(|byte| byte.is_ascii_digit() || more.as_bytes().contains(&byte))
    };
    if !is_number(digits, "+-.") || !is_number(exponent, "+-") {
        return None;
    }
    format!("{digits}e{exponent}").parse().ok().filter(|number: &f64| number.is_finite())
}

#[cfg(test)]
mod tests {
    use super::real;

    #[test]
    fn exponents_of_fortran_are_read() {
        for (text, number) in [
            ("1.5", 1.5),
            (" -2 ", -2.0),
            ("-100", -100.0),
            (".5E+01", 5.0),
            ("0.25D+01", 2.5),
            ("2.5d-3", 2.5e-3),
            ("0.1234567-100", 1.234_567e-101),
            ("-.5+102", -0.5e102),
            ("+1E0", 1.0),
            ("1.5-4", 1.5e-4),
            ("1.+2", 100.0),
            ("+3", 3.0),
            ("1.", 1.0),
        ] {
            assert_eq!(real(text), Some(number), "{text}");
        }
        for none in [
            "",
            "x",
            "nan",
            "inf",
            "-Infinity",
            "1e999",
            "1.0.0",
            "1-2",
            "2026-11-29",
            "1e",
            "--1",
            "**",
            "1,5",
            "1D",
            "d",
            "0x1",
        ] {
            assert_eq!(real(none), None, "{none}");
        }
    }
}
