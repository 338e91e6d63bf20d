//! Text tables of serialisable rows: headers, units and cells follow from the names of the fields, which end in their SI
//! units.

use std::io::Write;

use flexsc_core::formats::reader_units::ReaderUnit;
use serde::Serialize;
use serde_json::{Value as Json, json};

use crate::human::{Units, columns, digits};
use crate::say;

/// Endings of the names of fields with the units that they stand for, the longer before their own endings.
const ENDINGS: [(&str, &str); 14] = [
    ("_rad_s2", "rad/s²"),
    ("_rad_s", "rad/s"),
    ("_nm_s", "N m s"),
    ("_1_s", "1/s"),
    ("_m_s", "m/s"),
    ("_kg_m2", "kg m²"),
    ("_rad", "rad"),
    ("_nm", "N m"),
    ("_kg", "kg"),
    ("_hz", "Hz"),
    ("_s2", "s²"),
    ("_j", "J"),
    ("_m", "m"),
    ("_s", "s"),
];

/// Form of the numbers in a column.
#[derive(Copy, Clone)]
enum NumberForm<'a> {
    /// In the unit that the ending of the field's name stands for.
    Named,
    /// Times a factor, in a unit that is given.
    Scaled(f64, &'a str),
    /// In the SI unit that the field `unit` of the row states; each cell has the unit that fits the row, its field `key` and the
    /// unit in which this key is `written`, or else the number.
    OfRow,
    /// Factor on a gain, in dB, of which there is none for 0; a list of two is a range.
    Gain,
    /// With this number of decimals.
    Decimals(usize),
    /// Fraction of 1, in percent.
    Percent,
}

/// Column of a table: a field of its rows with its header.
#[derive(Copy, Clone)]
pub struct Column<'a> {
    /// Name of the field, with those of the fields that it is in: `disk.alpha`.
    field: &'a str,
    header: &'a str,
    form: NumberForm<'a>,
}

/// Column with a header, whose lines are apart by `\n`, in the unit of the field's name.
pub const fn column<'a>(field: &'a str, header: &'a str) -> Column<'a> {
    Column { field, header, form: NumberForm::Named }
}

impl<'a> Column<'a> {
    /// Has the numbers times this factor in this unit, such as that of a limit.
    pub const fn scaled(self, factor: f64, unit: &'a str) -> Self {
        Self { form: NumberForm::Scaled(factor, unit), ..self }
    }

    /// Has numbers in the unit that each row states in its field `unit`.
    pub const fn unit_of_row(self) -> Self {
        Self { form: NumberForm::OfRow, ..self }
    }

    /// Has factors on a gain.
    pub const fn gain(self) -> Self {
        Self { form: NumberForm::Gain, ..self }
    }

    /// Has numbers with this number of decimals.
    pub const fn decimals(self, count: usize) -> Self {
        Self { form: NumberForm::Decimals(count), ..self }
    }

    /// Has fractions of 1 in percent.
    pub const fn percent(self) -> Self {
        Self { form: NumberForm::Percent, ..self }
    }

    /// Returns the cell of a row; null if the row does not have the field.
    fn cell<'row>(&self, row: &'row Json) -> Option<&'row Json> {
        self.field.split('.').try_fold(row, |value, name| match (value, name.parse::<usize>()) {
            (Json::Null, _) => Some(value),
            (_, Ok(index)) => value.get(index),
            _ => value.get(name),
        })
    }

    /// Returns the factor on the numbers of the column, and its unit.
    fn scale(&self, rows: &[Json], units: Units) -> (f64, String) {
        let unit = match self.form {
            NumberForm::Scaled(factor, unit) => return (factor, unit.to_owned()),
            NumberForm::Gain if units.has_decibels() => return (1.0, "dB".to_owned()),
            NumberForm::Percent => return (100.0, "%".to_owned()),
            NumberForm::Gain | NumberForm::Decimals(_) | NumberForm::OfRow => return (1.0, String::new()),
            NumberForm::Named => {
                let ending = ENDINGS.iter().find(|(ending, _)| self.field.ends_with(ending));
                ending.map_or("", |(_, unit)| *unit)
            }
        };
        let is_of = |word: &str| unit == "rad/s" && self.field.contains(word);
        if is_of("frequenc") {
            let (factor, unit) = units.frequency();
            return (factor, unit.into_owned());
        }
        if is_of("speed") {
            let unit = units.0.rotor_speed();
            return (unit.value(1.0), unit.name.into_owned());
        }
        let mut numbers = Vec::new();
        rows.iter().filter_map(|row| self.cell(row)).for_each(|cell| collect(cell, &mut numbers));
        units.common(&numbers, unit)
    }

    /// Returns the text of a cell.
    fn text(&self, cell: Option<&Json>, factor: f64, units: Units) -> String {
        match (cell, self.form) {
            (None, _) => String::new(),
            (Some(Json::String(text)), _) => text.clone(),
            (Some(Json::Bool(is)), _) => if *is { "yes" } else { "no" }.to_owned(),
            (Some(Json::Array(values)), _) => {
                let texts: Vec<_> =
                    values.iter().map(|value| self.text(Some(value), factor, units)).collect();
                texts.join(if matches!(self.form, NumberForm::Gain) { " to " } else { ", " })
            }
            (Some(cell), form) => match (cell.as_f64(), form) {
                (None, _) => "none".to_owned(),
                (Some(gain), NumberForm::Gain) if gain <= 0.0 => "none".to_owned(),
                (Some(gain), NumberForm::Gain) if units.has_decibels() => digits(20.0 * gain.log10()),
                (Some(number), NumberForm::Decimals(count)) => format!("{number:.count$}"),
                (Some(number), _) => digits(number * factor),
            },
        }
    }
}

/// Appends the numbers of a cell.
fn collect(cell: &Json, numbers: &mut Vec<f64>) {
    match cell {
        Json::Array(values) => values.iter().for_each(|value| collect(value, numbers)),
        cell => numbers.extend(cell.as_f64()),
    }
}

/// Prints rows of text in columns, the last of them left-aligned.
pub fn print_table(rows: &[Vec<String>], left_aligned: usize) {
    for line in columns(rows, left_aligned) {
        say!("  {line}");
    }
}

/// Prints rows with these columns; the last is left-aligned if it has texts.
pub fn print_rows<T: Serialize>(rows: &[T], shown: &[Column<'_>], units: Units) {
    let rows: Vec<Json> = rows.iter().map(|row| json!(row)).collect();
    let is_text = |column: &Column<'_>| rows.iter().any(|row| column.cell(row).is_some_and(Json::is_string));
    let left_aligned = shown.last().map_or(0, |last| usize::from(is_text(last)));
    print_table(&lines(&rows, shown, units), left_aligned);
}

/// Returns the lines of the header, that of the units if there are any, and the rows.
fn lines(rows: &[Json], shown: &[Column<'_>], units: Units) -> Vec<Vec<String>> {
    let scales: Vec<(f64, String)> = shown.iter().map(|column| column.scale(rows, units)).collect();
    let height = shown.iter().map(|column| column.header.split('\n').count()).max().unwrap_or(0);
    let header = (0..height).map(|line| {
        let word = |column: &Column<'_>| column.header.split('\n').nth(line).unwrap_or("").to_owned();
        shown.iter().map(word).collect()
    });
    let mut lines: Vec<Vec<String>> = header.collect();
    if scales.iter().any(|(_, unit)| !unit.is_empty()) {
        lines.push(scales.iter().map(|(_, unit)| unit.clone()).collect());
    }
    let cells = |row: &Json| {
        let largest = largest_of_row(row, shown);
        let cell = |(column, (factor, _)): (&Column<'_>, &(f64, String))| {
            let cell = column.cell(row);
            match (column.form, cell.and_then(Json::as_f64)) {
                (NumberForm::OfRow, Some(number)) => {
                    let text = quantity(number, &unit_of_row(row, largest, units));
                    // A number far below the others of its row has a smaller unit instead of an exponent.
                    let is_tiny = text.contains("e-");
                    if is_tiny { quantity(number, &unit_of_row(row, number, units)) } else { text }
                }
                _ => column.text(cell, *factor, units),
            }
        };
        shown.iter().zip(&scales).map(cell).collect()
    };
    lines.extend(rows.iter().map(cells));
    lines
}

/// Returns the largest size of the numbers of a row that are in the unit of the row.
fn largest_of_row(row: &Json, shown: &[Column<'_>]) -> f64 {
    let mut numbers = Vec::new();
    let own = shown.iter().filter(|column| matches!(column.form, NumberForm::OfRow));
    own.filter_map(|column| column.cell(row)).for_each(|cell| collect(cell, &mut numbers));
    numbers.iter().fold(0.0, |most: f64, number| most.max(number.abs()))
}

/// Returns the unit of a row that fits numbers up to a size.
fn unit_of_row(row: &Json, largest: f64, units: Units) -> ReaderUnit {
    let text = |name: &str| row.get(name).and_then(Json::as_str).unwrap_or_default();
    let written = row.get("written").and_then(Json::as_str);
    units.0.for_key(text("key"), written, largest, text("unit"))
}

/// Returns an SI value as text in a unit.
fn quantity(si: f64, unit: &ReaderUnit) -> String {
    format!("{} {}", digits(unit.value(si)), unit.name).trim_end().to_owned()
}

#[cfg(test)]
mod tests {
    use std::f64::consts::TAU;

    use flexsc_core::formats::reader_units::ReaderUnits;

    use super::*;

    #[test]
    fn units_follow_from_the_names_of_fields_and_the_sizes_of_numbers() {
        let rows = [
            json!({"axis": "roll", "at": {"frequency_rad_s": TAU}, "phase_rad": TAU / 4.0, "limits_nm": [-0.002, 0.004]}),
            json!({"axis": "yaw", "at": {"frequency_rad_s": 1.0}, "phase_rad": null, "gain": 10.0}),
        ];
        let shown = [
            column("at.frequency_rad_s", "at"),
            column("phase_rad", "phase\nmargin"),
            column("limits_nm", "limits"),
            column("gain", "gain").gain(),
            column("axis", "axis"),
        ];
        let expected: [[&str; 5]; 5] = [
            ["at", "phase", "limits", "gain", "axis"],
            ["", "margin", "", "", ""],
            ["Hz", "deg", "mN m", "dB", ""],
            ["1", "90", "-2, 4", "", "roll"],
            ["0.1592", "none", "", "20", "yaw"],
        ];
        assert_eq!(lines(&rows, &shown, Units::default()), expected);
        let si = lines(&rows, &shown, Units(ReaderUnits::Si));
        assert_eq!(si[2], ["rad/s", "rad", "N m", "", ""]);
        assert_eq!(si[3], ["6.283", "1.571", "-0.002, 0.004", "", "roll"]);
    }

    #[test]
    fn a_unit_may_come_from_outside() {
        let rows = [
            json!({"value": 0.5, "part": 0.25, "unit": "N"}),
            json!({"value": 2.0, "part": 1.0, "unit": "rad"}),
        ];
        let shown = [
            column("value", "a").scaled(60.0, "per minute"),
            column("part", "b").percent(),
            column("part", "c").decimals(1),
            column("value", "d").unit_of_row(),
        ];
        let printed = lines(&rows, &shown, Units::default());
        assert_eq!(printed[1], ["per minute", "%", "", ""]);
        assert_eq!(printed[2], ["30", "25", "0.2", "0.5 N"]);
        // A number far below the others of its row.
        let rows = [json!({"value": 1e-7, "part": 1e-10, "unit": "rad"})];
        let shown = [column("value", "a").unit_of_row(), column("part", "b").unit_of_row()];
        assert_eq!(lines(&rows, &shown, Units::default())[1], ["0.02063 arcsec", "0.02063 mas"]);
    }
}
