//! Block by mode of operation, and lines on a run without modes.

use flexsc_core::answer::{Answer, ModeAnswer};
use flexsc_core::formats::reader_units::{ReaderUnits, number};

use super::html::{HtmlRow, HtmlTable, cell, head, number_head};

/// Returns the table by mode of operation.
pub fn table(answer: &Answer) -> String {
    let units = ReaderUnits::default();
    let errors = || answer.by_mode.iter().filter_map(|row| row.error_rad.as_ref());
    let unit = units.fitting(errors().map(|own| own.p95).fold(0.0, f64::max), "rad");
    let speed = units.rotor_speed();
    let heads = vec![
        head("Mode"),
        number_head("Visits"),
        number_head("Time, s"),
        number_head(format!("Error: median, {}", unit.name)),
        number_head(format!("95 %, {}", unit.name)),
        number_head(format!("largest, {}", unit.name)),
        number_head(format!("Fastest wheel, {}", speed.name)),
        number_head("At limit, s"),
    ];
    let row = |own: &ModeAnswer| {
        let error = |value: f64| cell(&unit.number(value));
        let errors = match &own.error_rad {
            Some(error_of) => [error_of.median, error_of.p95, error_of.largest].map(error),
            None => [cell("no target"), cell("-"), cell("-")],
        };
        let mut cells = vec![cell(&own.mode), cell(&own.visits.to_string()), cell(&number(own.time_s))];
        cells.extend(errors);
        cells.push(own.wheel_speed_rad_s.map_or_else(|| cell("-"), |value| cell(&speed.number(value))));
        let limit = own.at_limit_s.unwrap_or(0.0);
        cells.push(if limit > 0.0 { cell(&number(limit)).hot(true) } else { cell("-") });
        HtmlRow { cells, is_missed: false }
    };
    HtmlTable { heads, rows: answer.by_mode.iter().map(row).collect(), is_cards: false }.html()
}

/// Returns the table of what is known of a run.
pub fn lines(answer: &Answer) -> String {
    let row = |line: &flexsc_core::answer::Line| HtmlRow {
        cells: vec![cell(&line.head), cell(&line.text)],
        is_missed: false,
    };
    let rows =
        answer.lines.iter().filter(|line| line.is_main || answer.by_mode.is_empty()).map(row).collect();
    HtmlTable { heads: vec![head(""), head("")], rows, is_cards: false }.html()
}
