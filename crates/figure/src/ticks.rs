//! Ticks of an axis, and the texts of their numbers.

use std::ops::Range;

use flexsc_formats::reader_units::grouped;

/// Powers of ten that are written as numbers.
pub(crate) const SHORT_POWERS: Range<i32> = -6..5;

/// Ticks of an axis.
#[derive(Clone, Debug)]
pub struct Ticks {
    /// Values of the ticks, in the axis' SI unit.
    pub at: Vec<f64>,
    /// Size of the unit of the numbers.
    pub(crate) factor: f64,
    pub(crate) form: Form,
}

/// Format of the ticks.
#[derive(Copy, Clone, Debug)]
pub enum Form {
    /// Numbers with a count of decimals.
    Decimal(usize),
    /// Numbers with the decimals that each needs.
    Short,
    /// Powers of ten.
    Power,
}

impl Ticks {
    /// Returns the text of a tick.
    pub fn text(&self, value: f64) -> String {
        let value = value / self.factor;
        let text = match self.form {
            Form::Power => return format!("10{}", superscript(value.log10().round() as i32)),
            // Rounding in the conversion of the unit is left out.
            Form::Short => format!("{}", (value * 1e6).round() / 1e6),
            Form::Decimal(decimals) if decimals <= 6 && value.abs() < 1e7 => format!("{value:.decimals$}"),
            Form::Decimal(_) => format!("{value:.1e}"),
        };
        let zero = text.trim_start_matches('-').chars().all(|c| matches!(c, '0' | '.' | 'e'));
        if zero { "0".to_owned() } else { grouped(&text).replace('-', "−") }
    }
}

/// Returns a power of ten as text: a number from 0.000001 to 10 000, else 10 with an exponent.
pub fn power_text(power: i32) -> String {
    let form = if SHORT_POWERS.contains(&power) { Form::Short } else { Form::Power };
    Ticks { at: Vec::new(), factor: 1.0, form }.text(10_f64.powi(power))
}

/// Formats an integer as a superscript.
fn superscript(number: i32) -> String {
    let raised = |character: char| match character {
        '-' => '⁻',
        digit => ['⁰', '¹', '²', '³', '⁴', '⁵', '⁶', '⁷', '⁸', '⁹'][digit.to_digit(10).unwrap_or(0) as usize],
    };
    number.to_string().chars().map(raised).collect()
}
