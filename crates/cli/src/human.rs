//! Numbers for people: four significant digits, in SI units or in units of a suitable size.

use std::f64::consts::TAU;

use clap::ValueEnum;

/// Units of what is printed for people; JSON, tables and logs have SI units always.
#[derive(Copy, Clone, Debug, Default, PartialEq, Eq, ValueEnum)]
pub enum Units {
    /// Units that fit the size of the numbers: deg, arcsec, rpm, mN m, g
    #[default]
    Engineering,
    /// SI units: rad, rad/s, N m, kg
    Si,
}

impl From<Units> for flexsc_core::formats::reader_units::ReaderUnits {
    fn from(units: Units) -> Self {
        match units {
            Units::Engineering => Self::Engineering,
            Units::Si => Self::Si,
        }
    }
}

/// The option of verbs that print quantities for people.
#[derive(clap::Args, Copy, Clone, Default)]
#[group(skip)]
pub struct UnitsArgs {
    /// Units of the text; JSON and logs are in SI units always
    #[arg(long, value_name = "UNITS", default_value = "engineering")]
    pub units: Units,
}

/// Limit of a tenth of a degree (rad), below which angles are in arcsec.
const TENTH_DEGREE: f64 = TAU / 3600.0;
/// Limit of a tenth of an arcsec (rad), below which angles have SI prefixes.
const TENTH_ARCSEC: f64 = TAU / 12_960_000.0;
/// Units that get SI prefixes in steps of a thousand, such as mN m.
const PREFIXED: [&str; 9] = ["N m", "N m s", "J", "N", "m", "m/s²", "A m²", "J/(kg m²)", "N m s/rad"];
const PREFIXES: [(f64, &str); 7] =
    [(1e6, "M"), (1e3, "k"), (1.0, ""), (1e-3, "m"), (1e-6, "µ"), (1e-9, "n"), (1e-12, "p")];

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
        match self {
            Self::Engineering => format!("{} rpm", digits(value * 60.0 / TAU)),
            Self::Si => self.quantity(value, "rad/s"),
        }
    }

    /// Returns the factor from rad/s, and the unit, of natural frequencies.
    pub fn frequency(self) -> (f64, &'static str) {
        match self {
            Self::Engineering => (1.0 / TAU, "Hz"),
            Self::Si => (1.0, "rad/s"),
        }
    }

    /// Returns the factor from SI for a value of this size, and the unit.
    fn scale(self, value: f64, unit: &str) -> (f64, String) {
        let size = value.abs();
        if self == Self::Si || !size.is_finite() {
            return (1.0, unit.to_owned());
        }
        let degrees = 360.0 / TAU;
        match unit {
            "rad" if size >= TENTH_DEGREE || size == 0.0 => (degrees, "deg".to_owned()),
            "rad" if size >= TENTH_ARCSEC => (degrees * 3600.0, "arcsec".to_owned()),
            "rad/s" | "rad/s²" if size >= TENTH_DEGREE || size == 0.0 => {
                (degrees, unit.replacen("rad", "deg", 1))
            }
            "rad" | "rad/s" | "rad/s²" => prefixed(size, unit),
            "kg" if (1e-4..0.1).contains(&size) => (1e3, "g".to_owned()),
            "kg" if (1e-9..1e-4).contains(&size) => (1e6, "mg".to_owned()),
            _ if PREFIXED.contains(&unit) => prefixed(size, unit),
            _ => (1.0, unit.to_owned()),
        }
    }
}

/// Returns the factor and the unit with a suitable prefix for a size; no prefix beyond the known ones.
fn prefixed(size: f64, unit: &str) -> (f64, String) {
    match PREFIXES.iter().find(|(least, _)| size >= *least) {
        Some((least, prefix)) => (1.0 / least, format!("{prefix}{unit}")),
        None => (1.0, unit.to_owned()),
    }
}

/// Returns a duration, roughly: `3 ms`, `20 s`, `5 min`, `7 h`.
pub fn seconds(value: f64) -> String {
    match value {
        s if s < 0.9995e-3 => "1 ms".to_owned(),
        s if s < 0.9995 => format!("{} ms", digits(format!("{:.1e}", s * 1e3).parse().unwrap_or(s * 1e3))),
        s if s < 120.0 => format!("{s:.0} s"),
        s if s < 7200.0 => format!("{:.0} min", s / 60.0),
        s if s < 172_800.0 => format!("{:.0} h", s / 3600.0),
        s => format!("{:.0} days", s / 86_400.0),
    }
}

/// Returns a number in at most four significant digits.
pub fn digits(value: f64) -> String {
    if value == 0.0 {
        return "0".to_owned();
    }
    if !value.is_finite() {
        return "none".to_owned();
    }
    let scientific = format!("{value:.3e}");
    let (mantissa, exponent) = scientific.split_once('e').unwrap_or((&scientific, "0"));
    let exponent: i32 = exponent.parse().unwrap_or(0);
    if (-3..6).contains(&exponent) {
        let decimals = usize::try_from(3 - exponent).unwrap_or(0);
        return trimmed(&format!("{value:.decimals$}")).to_owned();
    }
    format!("{}e{exponent}", trimmed(mantissa))
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

/// Removes trailing zeros of the decimals.
fn trimmed(text: &str) -> &str {
    if text.contains('.') { text.trim_end_matches('0').trim_end_matches('.') } else { text }
}

/// Formats rows of text as columns of equal width, two spaces apart, right-aligned but for the last `left` columns.
pub fn columns(rows: &[Vec<String>], left_aligned: usize) -> Vec<String> {
    let count = rows.iter().map(Vec::len).max().unwrap_or(0);
    let width = |column: usize| {
        rows.iter().filter_map(|row| row.get(column)).map(|cell| cell.chars().count()).max().unwrap_or(0)
    };
    let widths: Vec<usize> = (0..count).map(width).collect();
    let line = |row: &Vec<String>| {
        let cells = row.iter().zip(&widths).enumerate().map(|(column, (cell, width))| {
            if column + left_aligned >= count { format!("{cell:<width$}") } else { format!("{cell:>width$}") }
        });
        cells.collect::<Vec<_>>().join("  ").trim_end().to_owned()
    };
    rows.iter().map(line).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_have_four_digits_at_most() {
        let cases = [
            (30.237_722_111, "30.24"),
            (std::f64::consts::FRAC_PI_2, "1.571"),
            (19.799_999_999_999_997, "19.8"),
            (12.0, "12"),
            (18000.0, "18000"),
            (9999.96, "10000"),
            (0.001_234_56, "0.001235"),
            (-0.5, "-0.5"),
            (1.234_56e-5, "1.235e-5"),
            (2.5e7, "2.5e7"),
            (0.0, "0"),
            (f64::NAN, "none"),
        ];
        for (value, text) in cases {
            assert_eq!(digits(value), text);
        }
    }

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
    fn units_fit_the_size() {
        let engineering = [
            (std::f64::consts::FRAC_PI_6, "rad", "30 deg"),
            (1.979e-5, "rad", "4.082 arcsec"),
            (2.269e-11, "rad", "22.69 prad"),
            (0.0, "rad", "0 deg"),
            (0.017_453_292_519_943, "rad/s", "1 deg/s"),
            (-1e-6, "rad/s", "-1 µrad/s"),
            (0.012, "N m", "12 mN m"),
            (2.097e-3, "J", "2.097 mJ"),
            (1.04e-3, "kg", "1.04 g"),
            (5.61, "kg", "5.61 kg"),
            (4e-20, "J", "4e-20 J"),
            (3.5, "", "3.5"),
        ];
        for (value, unit, text) in engineering {
            assert_eq!(Units::Engineering.quantity(value, unit), text);
        }
        assert_eq!(Units::Si.quantity(1.979e-5, "rad"), "1.979e-5 rad");
        assert_eq!(Units::Engineering.list(&[0.5e-3, 2.0], " -> ", "N m"), "5e-4 -> 2 N m");
        assert_eq!(Units::Engineering.speed(TAU), "60 rpm");
        assert_eq!(Units::Si.speed(TAU), "6.283 rad/s");
    }

    #[test]
    fn durations_are_rough() {
        let cases = [
            (3e-5, "1 ms"),
            (0.020_6, "21 ms"),
            (0.183, "180 ms"),
            (19.6, "20 s"),
            (340.0, "6 min"),
            (2e5, "2 days"),
        ];
        for (value, text) in cases {
            assert_eq!(seconds(value), text);
        }
    }

    #[test]
    fn columns_stay_apart() {
        let rows =
            [vec!["a".to_owned(), "b".to_owned()], vec!["123456789".to_owned(), "37917.7205".to_owned()]];
        assert_eq!(columns(&rows, 0), ["        a           b", "123456789  37917.7205"]);
    }
}
