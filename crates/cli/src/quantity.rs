//! Numbers with units in command-line arguments, by the parser of numbers in scenarios.

use flexsc_core::formats::document::number_in;

/// Returns the parser of an option whose number has this unit: `20` and `0.02` are in it, `20 ms` and `1 min` are converted.
/// A dimensionless number takes `%`.
pub fn in_unit(unit: &'static str) -> impl Fn(&str) -> Result<f64, String> + Clone + Send + Sync + 'static {
    move |text| number_in(text, unit)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_converted_to_the_unit_of_their_option() {
        assert_eq!(in_unit("s")("20"), Ok(20.0));
        assert_eq!(in_unit("s")("10 ms"), Ok(0.01));
        assert_eq!(in_unit("mm")("8.5 cm"), Ok(85.0));
        assert_eq!(in_unit("")("5 %"), Ok(0.05));
        for text in ["10 deg", "ten", "inf", ""] {
            assert!(in_unit("s")(text).is_err_and(|why| why.contains("s`") || why.contains("2 s")), "{text}");
        }
    }
}
