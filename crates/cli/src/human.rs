//! Numbers for people: four significant digits, in SI units or in units of a suitable size.

use std::borrow::Cow;
use std::str::FromStr;

use flexsc_core::formats::reader_units::ReaderUnits;
pub use flexsc_core::formats::reader_units::{four_digits as digits, rough_time as seconds};
use flexsc_core::formats::text_columns;

/// Units of what is printed and drawn for people; JSON, tables and logs have SI units always.
#[derive(Copy, Clone, Debug, Default, PartialEq, Eq)]
pub struct Units(pub ReaderUnits);

impl From<Units> for ReaderUnits {
    fn from(units: Units) -> Self {
        units.0
    }
}

impl FromStr for Units {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        text.parse().map(Self)
    }
}

/// The option of verbs that print or draw quantities for people.
#[derive(clap::Args, Copy, Clone, Default)]
#[group(skip)]
pub struct UnitsArgs {
    /// Units of texts and figures: `engineering`, which fit the size of the numbers, `si`, or units of choice for what they
    /// measure, such as "deg, rpm, mN m"; JSON and logs are in SI units always
    #[arg(long, value_name = "UNITS", default_value = "engineering")]
    pub units: Units,
}

impl Units {
    /// Returns a value with its unit.
    pub fn quantity(self, value: f64, unit: &str) -> String {
        let (factor, unit) = self.scale(value, unit);
        let text = digits(value * factor);
        if unit.is_empty() { text } else { format!("{text} {unit}") }
    }

    /// Returns values with one unit that fits the largest of them: `1 -> 2 deg` with ` -> ` between them.
    pub fn list(self, values: &[f64], between: &str, unit: &str) -> String {
        let (factor, unit) = self.common(values, unit);
        let texts: Vec<String> = values.iter().map(|value| digits(value * factor)).collect();
        format!("{} {unit}", texts.join(between))
    }

    /// Returns the factor from SI, and the unit, that fit the largest of some values.
    pub fn common(self, values: &[f64], unit: &str) -> (f64, String) {
        let largest = values.iter().fold(0.0, |most: f64, value| most.max(value.abs()));
        self.scale(largest, unit)
    }

    /// Returns the speed of a rotor (rad/s) with its unit.
    pub fn speed(self, value: f64) -> String {
        let unit = self.0.rotor_speed();
        format!("{} {}", digits(unit.value(value)), unit.name)
    }

    /// True if factors on a gain are in dB.
    pub fn has_decibels(self) -> bool {
        self.0 != ReaderUnits::Si
    }

    /// Returns the factor from rad/s, and the unit, of natural frequencies.
    pub fn frequency(self) -> (f64, Cow<'static, str>) {
        let unit = self.0.frequency();
        (unit.value(1.0), unit.name)
    }

    /// Returns the factor from SI for a value of this size, and the unit.
    fn scale(self, value: f64, unit: &str) -> (f64, String) {
        let fitting = self.0.fitting(value, unit);
        (fitting.value(1.0), fitting.name.into_owned())
    }
}

/// Returns a number in some significant digits, rounded upwards or downwards.
pub fn outward_digits(value: f64, count: i32, upwards: bool) -> String {
    if value == 0.0 || !value.is_finite() {
        return digits(value);
    }
    let power = count - 1 - value.abs().log10().floor() as i32;
    let scale = 10.0_f64.powi(power);
    let scaled = value * scale;
    let rounded = if upwards { scaled.next_up().ceil() } else { scaled.next_down().floor() };
    let decimals = usize::try_from(power).unwrap_or(0);
    if power > 12 {
        let decimals = usize::try_from(count - 1).unwrap_or(0);
        return format!("{:.decimals$e}", rounded / scale);
    }
    format!("{:.decimals$}", rounded / scale)
}

/// Formats rows of text as columns of equal width, right-aligned but for the last `left_aligned` columns.
pub fn columns(rows: &[Vec<String>], left_aligned: usize) -> Vec<String> {
    let count = rows.iter().map(Vec::len).max().unwrap_or(0);
    text_columns::columns(rows, |column| column + left_aligned >= count)
}

#[cfg(test)]
mod tests {
    use std::f64::consts::TAU;

    use super::*;

    #[test]
    fn bounds_are_rounded_outwards() {
        let cases = [
            (171.118_71, true, "171.119"),
            (171.118_01, true, "171.119"),
            (-171.118_01, false, "-171.119"),
            (-171.118_91, true, "-171.118"),
            (1.0, true, "1.00001"),
            (1.234_567_8e-20, true, "1.23457e-20"),
            (0.0, true, "0"),
        ];
        for (value, upwards, text) in cases {
            assert_eq!(outward_digits(value, 6, upwards), text);
        }
    }

    #[test]
    fn units_are_those_that_are_asked_for() {
        assert_eq!(Units::default().quantity(1.979e-5, "rad"), "4.082 arcsec");
        assert_eq!(Units(ReaderUnits::Si).quantity(1.979e-5, "rad"), "1.979e-5 rad");
        assert_eq!(Units::default().list(&[0.5e-3, 2.0], " -> ", "N m"), "5e-4 -> 2 N m");
        assert_eq!(Units::default().speed(TAU), "60 rpm");
        assert_eq!(Units(ReaderUnits::Si).speed(TAU), "6.283 rad/s");
    }
}
