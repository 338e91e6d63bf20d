//! Quantities as people read them: in the unit in which the question was asked, else in one that fits their size; three
//! significant digits, no exponent.

use std::borrow::Cow;
use std::f64::consts::PI;
use std::str::FromStr;

use crate::chosen_units::ChosenUnits;
use crate::document::{unit_of_text, units_ratio};

/// Units of what is printed for people; logs, tables and JSON values are in SI units always.
#[derive(Copy, Clone, Debug, Default, PartialEq, Eq)]
pub enum ReaderUnits {
    /// Units that fit the size of the numbers: deg, arcsec, rpm, mN m, g.
    #[default]
    Engineering,
    /// SI units: rad, rad/s, N m, kg.
    Si,
    /// Units that were asked for, where they measure the quantity, and else units that fit.
    Chosen(ChosenUnits),
}

impl FromStr for ReaderUnits {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        match text {
            "engineering" => Ok(Self::Engineering),
            "si" => Ok(Self::Si),
            units => units
                .parse()
                .map(Self::Chosen)
                .map_err(|why| format!("must be `engineering`, `si` or units such as `deg, mN m`: {why}")),
        }
    }
}

/// Unit in which a quantity is shown.
#[derive(Clone, Debug, PartialEq)]
pub struct ReaderUnit {
    /// Name, such as `deg`; empty for a number without a unit.
    pub name: Cow<'static, str>,
    /// Size of the unit in SI.
    size: f64,
    /// True for SI throughout, where small numbers have exponents.
    is_si: bool,
}

const DEGREE: f64 = PI / 180.0;
const ARCSEC: f64 = DEGREE / 3600.0;

/// Unit with its size and the least value for which it is chosen.
type Rung = (&'static str, f64, f64);

/// Units of a quantity by its SI unit, the largest first.
const LADDERS: [(&str, &[Rung]); 5] = [
    ("rad", &[("deg", DEGREE, 0.1 * DEGREE), ("arcsec", ARCSEC, 1e-3 * ARCSEC), ("mas", 1e-3 * ARCSEC, 0.0)]),
    (
        "rad/s",
        &[
            ("deg/s", DEGREE, 0.01 * DEGREE),
            ("arcsec/s", ARCSEC, 1e-3 * ARCSEC),
            ("mas/s", 1e-3 * ARCSEC, 0.0),
        ],
    ),
    (
        "rad/s²",
        &[
            ("deg/s²", DEGREE, 0.01 * DEGREE),
            ("arcsec/s²", ARCSEC, 1e-3 * ARCSEC),
            ("mas/s²", 1e-3 * ARCSEC, 0.0),
        ],
    ),
    ("Hz", &[("Hz", 1.0, 1e-3), ("mHz", 1e-3, 0.0)]),
    ("kg", &[("kg", 1.0, 0.1), ("g", 1e-3, 1e-4), ("mg", 1e-6, 0.0)]),
];

/// Units with prefixes in steps of a thousand, such as mN m.
const PREFIXED: [&str; 12] =
    ["N m", "N m s", "J", "N", "N s", "m", "m/s", "m/s²", "A m²", "T", "J/(kg m²)", "N m s/rad"];

/// Prefixes with their sizes, and the least value for which each is chosen.
const PREFIXES: [(&str, f64, f64); 6] = [
    ("M", 1e6, 1e7),
    ("k", 1e3, 1e4),
    ("", 1.0, 0.1),
    ("m", 1e-3, 1e-4),
    ("µ", 1e-6, 1e-7),
    ("n", 1e-9, 0.0),
];

/// Names of keys that are angular frequencies, and of those that are speeds of rotors.
const FREQUENCIES: [&str; 4] = ["frequenc", "bandwidth", "mount.translation", "mount.rocking"];
const SPEED: &str = "speed";

impl ReaderUnits {
    /// Returns the unit in place of the usual one of a quantity, whose SI unit is given, if there is another one.
    pub fn in_place_of(self, usual: &ReaderUnit, unit: &str) -> Option<ReaderUnit> {
        match self {
            Self::Engineering => None,
            Self::Si => Some(ReaderUnit { is_si: true, ..ReaderUnit::plain(unit) }),
            Self::Chosen(chosen) => {
                let (name, size) = chosen.measuring(unit, &usual.name)?;
                Some(ReaderUnit { name: name.into(), size, is_si: name == unit })
            }
        }
    }

    fn instead(self, usual: ReaderUnit, unit: &str) -> ReaderUnit {
        self.in_place_of(&usual, unit).unwrap_or(usual)
    }

    /// Returns the unit that fits the largest of some values of an SI unit.
    pub fn fitting(self, largest: f64, unit: &str) -> ReaderUnit {
        self.instead(ReaderUnit::fitting(largest, unit), unit)
    }

    /// Returns a value of an SI unit as text with a unit that fits its size.
    pub fn quantity(self, value: f64, unit: &str) -> String {
        self.fitting(value, unit).quantity(value)
    }

    /// Returns values of an SI unit as text, joined by `between`, with one unit that fits the largest of them.
    pub fn list(self, values: &[f64], between: &str, unit: &str) -> String {
        let largest =
            values.iter().filter(|value| value.is_finite()).fold(0.0, |most: f64, own| most.max(own.abs()));
        self.fitting(largest, unit).list(values, between)
    }

    /// Returns the unit of the speeds of rotors (rad/s).
    pub fn rotor_speed(self) -> ReaderUnit {
        self.instead(ReaderUnit { name: "rpm".into(), size: PI / 30.0, is_si: false }, "rad/s")
    }

    /// Returns the unit of natural frequencies (rad/s).
    pub fn frequency(self) -> ReaderUnit {
        self.instead(ReaderUnit { name: "Hz".into(), size: 2.0 * PI, is_si: false }, "rad/s")
    }

    /// Returns the unit of values of a metric, the largest of which is given: Hz of frequencies, rpm of speeds of rotors, else
    /// one that fits.
    pub fn for_metric(self, name: &str, largest: f64, unit: &str) -> ReaderUnit {
        match unit {
            "rad/s" if is_frequency(name) => self.frequency(),
            "rad/s" if last_name(name).contains(SPEED) => self.rotor_speed(),
            _ => self.fitting(largest, unit),
        }
    }

    /// Returns the unit of values of a scenario's key, the largest of which is given: that in which the key is `written`, or
    /// else one that fits. A frequency without a unit is in rad/s, as the number in the file.
    pub fn for_key(self, key: &str, written: Option<&str>, largest: f64, unit: &str) -> ReaderUnit {
        match written.and_then(|name| ReaderUnit::written(name, unit)) {
            Some(written) => self.instead(written, unit),
            None if unit == "rad/s" && is_frequency(key) => self.instead(ReaderUnit::plain(unit), unit),
            None => self.for_metric(key, largest, unit),
        }
    }

    /// Returns the unit in which a text such as `0.1 deg` is written, if it measures the SI unit, else one that fits the
    /// value.
    pub fn as_written(self, text: Option<&str>, value: f64, unit: &str) -> ReaderUnit {
        let written = text.and_then(unit_of_text).and_then(|name| ReaderUnit::written(name, unit));
        self.instead(written.unwrap_or_else(|| ReaderUnit::fitting(value, unit)), unit)
    }
}

/// Returns the name at the end of a path, without an index.
fn last_name(path: &str) -> &str {
    let last = path.rsplit('.').next().unwrap_or_default();
    last.split('[').next().unwrap_or_default()
}

fn is_frequency(path: &str) -> bool {
    FREQUENCIES.iter().any(|own| last_name(path).contains(own) || path.ends_with(own))
}

/// Units of times on an axis, with their sizes (s) and the longest axis (s) that has each.
const TIMES: [(&str, f64, f64); 4] =
    [("µs", 1e-6, 1e-4), ("ms", 1e-3, 0.1), ("s", 1.0, 7200.0), ("h", 3600.0, f64::INFINITY)];

/// Returns a unit that has a ladder or prefixes.
pub fn known_unit(unit: &str) -> Option<&'static str> {
    LADDERS.iter().map(|(name, _)| *name).chain(PREFIXED).find(|name| *name == unit)
}

impl ReaderUnit {
    /// Returns the unit of an axis over a length of time (s): s up to two hours, h beyond.
    pub fn for_time_axis(length: f64) -> Self {
        let (name, size, _) = TIMES.into_iter().find(|(.., most)| length <= *most).unwrap_or(TIMES[2]);
        Self { name: name.into(), size, is_si: false }
    }

    /// Returns the size of the unit in SI.
    pub fn size(&self) -> f64 {
        self.size
    }

    /// Returns the unit of this name, if it measures the SI unit. An angle in rad is read as one in deg or arcsec.
    fn written(name: &str, unit: &str) -> Option<Self> {
        let name = Some(name).filter(|name| !name.contains("rad"))?;
        Some(Self { size: units_ratio(name, unit)?, name: name.to_owned().into(), is_si: false })
    }

    fn plain(unit: &str) -> Self {
        Self { name: unit.to_owned().into(), size: 1.0, is_si: false }
    }

    fn fitting(largest: f64, unit: &str) -> Self {
        let size = largest.abs();
        if let Some((_, ladder)) = LADDERS.iter().find(|(name, _)| *name == unit) {
            let fits =
                ladder.iter().find(|(.., least)| size >= *least).filter(|_| size > 0.0 && size.is_finite());
            let (name, size, _) = *fits.unwrap_or(&ladder[0]);
            return Self { name: name.into(), size, is_si: false };
        }
        if PREFIXED.contains(&unit) && size > 0.0 && size.is_finite() {
            let fits = PREFIXES.iter().find(|(.., least)| size >= *least);
            let (prefix, size, _) = *fits.unwrap_or(&PREFIXES[2]);
            return Self { name: format!("{prefix}{unit}").into(), size, is_si: false };
        }
        Self::plain(unit)
    }

    /// Returns the value of an SI number in the unit.
    pub fn value(&self, si: f64) -> f64 {
        si / self.size
    }

    /// Returns an SI value as a number in the unit.
    pub fn number(&self, si: f64) -> String {
        if self.is_si { four_digits(si) } else { number(self.value(si)) }
    }

    /// Returns an SI value as text with the unit.
    pub fn quantity(&self, si: f64) -> String {
        self.with_name(self.number(si))
    }

    /// Returns a limit as it was written, if in this unit, or else with it.
    pub fn limit(&self, si: f64, written: Option<&str>) -> String {
        let written =
            written.map(str::trim).filter(|text| !self.name.is_empty() && text.ends_with(&*self.name));
        written.map_or_else(|| self.exact(si), str::to_owned)
    }

    /// Returns an SI value as text with the unit, without the zeros at its end.
    fn exact(&self, si: f64) -> String {
        let number = self.number(si);
        let is_decimal = number.contains('.') && !number.contains('e');
        self.with_name(if is_decimal { without_zeros(&number).to_owned() } else { number })
    }

    /// Returns SI values as numbers joined by `between`, with the unit once.
    pub fn list(&self, si: &[f64], between: &str) -> String {
        let numbers: Vec<String> = si.iter().map(|value| self.number(*value)).collect();
        self.with_name(numbers.join(between))
    }

    /// Returns an SI value as a number that is on the same side of a limit as the value, with as many digits as that takes.
    pub fn number_against(&self, si: f64, limit: f64) -> String {
        let (value, limit) = (self.value(si), self.value(limit));
        if self.is_si || !value.is_finite() || value == limit {
            return self.number(si);
        }
        let is_apart = |text: &str| {
            let rounded: f64 = text.replace(THIN_SPACE, "").parse().unwrap_or(value);
            (rounded - limit) * (value - limit) > 0.0
        };
        let short = number(value);
        if is_apart(&short) {
            return short;
        }
        let places = decimals(value);
        let longer = (places + 1..=places + 12).map(|places| grouped(&format!("{value:.places$}")));
        longer.into_iter().find(|text| is_apart(text)).unwrap_or_else(|| grouped(&value.to_string()))
    }

    fn with_name(&self, number: String) -> String {
        if self.name.is_empty() { number } else { format!("{number} {}", self.name) }
    }
}

/// Space within numbers of five digits and more.
pub const THIN_SPACE: char = '\u{202f}';

/// Smallest number that is not rounded to 0.
const LEAST: f64 = 1e-6;

/// Returns a number in three significant digits, integers up to 9999 in full, with thin spaces from 10 000 on, and without
/// an exponent; `none` for NaN.
pub fn number(value: f64) -> String {
    if value.is_nan() {
        return "none".to_owned();
    }
    if value.is_infinite() {
        return if value > 0.0 { "infinite".to_owned() } else { "-infinite".to_owned() };
    }
    let size = value.abs();
    if size < LEAST {
        return "0".to_owned();
    }
    if size >= 1e15 {
        return format!("{value:.2e}");
    }
    // Whole numbers have no decimals; a conversion may have rounded them.
    if (value - value.round()).abs() < 1e-12 * size {
        return grouped(&format!("{value:.0}"));
    }
    let places = decimals(value);
    grouped(&format!("{value:.places$}"))
}

/// Returns the decimals of three significant digits of a number after rounding.
fn decimals(value: f64) -> usize {
    let scientific = format!("{value:.2e}");
    let exponent = scientific.split_once('e').and_then(|(_, exponent)| exponent.parse::<i32>().ok());
    usize::try_from(2 - exponent.unwrap_or(0)).unwrap_or(0)
}

/// Returns the text of a number with thin spaces between the thousands of its whole part, from five digits on.
pub fn grouped(text: &str) -> String {
    let (whole, rest) = text.find('.').map_or((text, ""), |point| text.split_at(point));
    let (sign, digits) = whole.strip_prefix('-').map_or(("", whole), |digits| ("-", digits));
    if digits.len() < 5 || !digits.bytes().all(|byte| byte.is_ascii_digit()) {
        return text.to_owned();
    }
    let first = digits.len() % 3;
    let mut all = sign.to_owned();
    for (index, digit) in digits.chars().enumerate() {
        if index > 0 && index % 3 == first {
            all.push(THIN_SPACE);
        }
        all.push(digit);
    }
    all + rest
}

/// Returns a number in at most four significant digits, with an exponent where it is small or large; `none` for a number
/// that is not finite.
pub fn four_digits(value: f64) -> String {
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
        return without_zeros(&format!("{value:.decimals$}")).to_owned();
    }
    format!("{}e{exponent}", without_zeros(mantissa))
}

/// Returns a number without the zeros at the end of its decimals.
fn without_zeros(number: &str) -> &str {
    if number.contains('.') { number.trim_end_matches('0').trim_end_matches('.') } else { number }
}

/// Returns a time as a number of seconds with its unit, such as `8846 s`.
pub fn time(seconds: f64) -> String {
    format!("{} s", number(seconds))
}

/// Returns the length of a window or a period as text, in seconds if three digits would round it: `20 ms`, `0.5 s`, `300 s`, `3 h`.
pub fn time_span(seconds: f64) -> String {
    let unit = ReaderUnit::for_time_axis(seconds);
    let shown = unit.number(seconds).replace(THIN_SPACE, "").parse().unwrap_or(f64::NAN) * unit.size;
    if (shown - seconds).abs() <= 1e-9 * seconds {
        return unit.exact(seconds);
    }
    format!("{} s", grouped(without_zeros(&format!("{seconds:.9}"))))
}

/// Returns a duration, roughly: `3 ms`, `20 s`, `5 min`, `7 h`.
pub fn rough_time(seconds: f64) -> String {
    match seconds {
        s if s < 0.9995e-3 => "1 ms".to_owned(),
        s if s < 0.9995 => {
            let milliseconds = format!("{:.1e}", s * 1e3).parse().unwrap_or(s * 1e3);
            format!("{} ms", four_digits(milliseconds))
        }
        s if s < 120.0 => format!("{s:.0} s"),
        s if s < 7200.0 => format!("{:.0} min", s / 60.0),
        s if s < 172_800.0 => format!("{:.0} h", s / 3600.0),
        s => format!("{:.0} days", s / 86_400.0),
    }
}

/// Returns a share as a percentage, which is 0 or 100 only where the share is none or all.
pub fn percent(share: f64) -> String {
    let value = 100.0 * share;
    let text = (0..8).map(|decimals| format!("{value:.decimals$}")).find(|text| {
        let rounded: f64 = text.parse().unwrap_or(value);
        (rounded > 0.0 || value <= 0.0) && (rounded < 100.0 || value >= 100.0)
    });
    format!("{} %", text.unwrap_or_else(|| value.to_string()))
}

/// Returns a share as a percentage in three significant digits or more, on the same side of a limit as the share.
pub fn percent_against(share: f64, limit: f64) -> String {
    let unit = ReaderUnit { name: "%".into(), size: 0.01, is_si: false };
    unit.with_name(unit.number_against(share, limit))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_have_three_digits_and_no_exponent() {
        let cases = [
            (0.071_96, "0.0720"),
            (19.51, "19.5"),
            (8846.4, "8846"),
            (17_000.0, "17\u{202f}000"),
            (-123_456.7, "-123\u{202f}457"),
            (9.996, "10.0"),
            (0.001_16, "0.00116"),
            (200.0, "200"),
            (0.0, "0"),
            (4e-7, "0"),
            (f64::NAN, "none"),
        ];
        for (value, text) in cases {
            assert_eq!(number(value), text);
        }
    }

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
            assert_eq!(four_digits(value), text);
        }
    }

    #[test]
    fn lengths_of_windows_are_whole_numbers_where_they_can_be() {
        for (value, text) in
            [(0.02, "20 ms"), (0.5, "0.5 s"), (300.0, "300 s"), (10_800.0, "3 h"), (2.5e-5, "25 µs")]
        {
            assert_eq!(time_span(value), text);
        }
        assert_eq!([10_000.0, 12.345].map(time_span), ["10\u{202f}000 s", "12.345 s"]);
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
            assert_eq!(rough_time(value), text);
        }
    }

    #[test]
    fn units_fit_the_size() {
        let cases = [
            (0.5, "rad", "28.6 deg"),
            (0.1 * DEGREE, "rad", "0.100 deg"),
            (1.979e-5, "rad", "4.08 arcsec"),
            (2e-9, "rad", "0.413 mas"),
            (1e-4, "rad/s", "20.6 arcsec/s"),
            (0.0, "rad", "0 deg"),
            (0.012, "N m", "12 mN m"),
            (5.03e-5, "N m s", "50.3 µN m s"),
            (0.02, "kg", "20 g"),
            (25_000.0, "J", "25 kJ"),
            (3.5, "", "3.50"),
        ];
        for (value, unit, text) in cases {
            assert_eq!(ReaderUnits::Engineering.quantity(value, unit), text);
        }
        assert_eq!(ReaderUnits::Si.quantity(1.979e-5, "rad"), "1.979e-5 rad");
        assert_eq!(ReaderUnits::Engineering.list(&[0.031, 2.0], " -> ", "rad"), "1.78 -> 115 deg");
    }

    #[test]
    fn the_unit_of_the_question_is_that_of_the_answer() {
        let unit = ReaderUnits::Engineering.as_written(Some("0.1 deg"), 1e-9, "rad");
        assert_eq!(unit.quantity(0.001_257_432), "0.0720 deg");
        assert_eq!(
            ReaderUnits::Engineering.as_written(Some("3000 rpm"), 1.0, "rad/s").quantity(PI),
            "30 rpm"
        );
        // A number, or a unit of something else.
        for text in [None, Some("4e-4"), Some("2 kg"), Some("4e-4 rad")] {
            assert_eq!(ReaderUnits::Engineering.as_written(text, 4e-4, "rad").name, "arcsec");
        }
    }

    #[test]
    fn keys_have_the_units_in_which_they_are_written() {
        let units = ReaderUnits::Engineering;
        for (key, written, value, unit, text) in [
            ("law.attitude.bandwidth", None, 0.1, "rad/s", "0.100 rad/s"),
            ("law.attitude.bandwidth", Some("rad/s"), 0.1, "rad/s", "0.100 rad/s"),
            ("law.attitude.bandwidth", Some("Hz"), 2.0 * PI, "rad/s", "1 Hz"),
            ("actuator.wheels.speeds[2]", None, PI, "rad/s", "30 rpm"),
            ("spacecraft.rate[0]", None, DEGREE, "rad/s", "1 deg/s"),
            ("spacecraft.rate[0]", Some("rpm"), PI, "rad/s", "30 rpm"),
            ("body.planar.angle", Some("arcmin"), DEGREE, "rad", "60 arcmin"),
            ("sensor.gyro.frequency", None, 2.0, "N m", "2 N m"),
        ] {
            assert_eq!(units.for_key(key, written, value, unit).quantity(value), text, "{key}");
        }
        assert_eq!(
            ReaderUnits::Si.for_key("law.attitude.bandwidth", Some("Hz"), 1.0, "rad/s").quantity(1.0),
            "1 rad/s"
        );
        // Metrics are frequencies as people know them.
        assert_eq!(units.for_metric("frequency_error_max_rad_s", 1.0, "rad/s").name, "Hz");
    }

    #[test]
    fn units_that_are_asked_for_come_before_others() {
        let units: ReaderUnits = "deg, mHz, mN m".parse().expect("units");
        for (unit, text) in [
            (units.as_written(Some("3 arcsec"), 1e-5, "rad"), "0.000573 deg"),
            (units.frequency(), "1.59 mHz"),
            (units.for_key("law.attitude.bandwidth", None, 1.0, "rad/s"), "1.59 mHz"),
            (units.fitting(1.0, "N m"), "0.0100 mN m"),
            (units.rotor_speed(), "0.0000955 rpm"),
        ] {
            assert_eq!(unit.quantity(1e-5 * if unit.name == "mHz" { 1e3 } else { 1.0 }), text);
        }
        assert_eq!("rad".parse::<ReaderUnits>().expect("a unit").quantity(1e-7, "rad"), "1e-7 rad");
        assert!(
            "engineerin"
                .parse::<ReaderUnits>()
                .is_err_and(|why| why.contains("`engineering`, `si` or units"))
        );
    }

    #[test]
    fn a_rounded_value_stays_on_its_side_of_the_limit() {
        let unit = ReaderUnits::Engineering.as_written(Some("0.03 N m s"), 0.03, "N m s");
        assert_eq!(unit.number_against(0.030_004_9, 0.03), "0.030005");
        assert_eq!(unit.number_against(0.029_999_999, 0.03), "0.029999999");
        assert_eq!(unit.number_against(0.03, 0.03), "0.0300");
        // A sequence that covers the interval evenly.
        let mut state = 0.5;
        for _ in 0..10_000 {
            state = (state * 997.0_f64 + 0.618_034).fract();
            let limit = libm::pow(10.0, 8.0 * state - 4.0);
            let value = limit * (1.0 + (state - 0.5) * 1e-3);
            let text = ReaderUnit::plain("").number_against(value, limit);
            let shown: f64 = text.replace(THIN_SPACE, "").parse().expect("a number");
            assert!((shown - limit) * (value - limit) > 0.0, "{value} {limit} {text}");
        }
    }

    #[test]
    fn a_part_is_neither_none_nor_all() {
        assert_eq!(percent(0.515), "52 %");
        assert_eq!(percent(0.995), "99.5 %");
        assert_eq!(percent(0.999_6), "99.96 %");
        assert_eq!(percent(1.0), "100 %");
        assert_eq!(percent(0.0), "0 %");
        assert_eq!(percent(0.001), "0.1 %");
        assert_eq!(percent_against(0.899_96, 0.9), "89.996 %");
    }
}
