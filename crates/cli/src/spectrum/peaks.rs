//! Largest peaks of the lines of unbalanced wheels over their speed, as text.

use std::io::Write;

use flexsc_core::formats::reader_units::time_span;
use serde_json::{Value as Json, json};

use super::waterfall::OutputWaterfall;
use crate::human::Units;
use crate::row_table::{Column, column, print_rows};
use crate::say;

/// Largest number of peaks of an output.
const MOST: usize = 12;
/// Rise above the median over the speed that makes a peak.
const RISE: f64 = 8.0;

/// Columns of the peaks.
const PEAKS: [Column<'_>; 4] = [
    column("output", "output"),
    column("speed_rad_s", "speed"),
    column("rms", "rms").unit_of_row(),
    column("within", "within\nwindows").unit_of_row(),
];

/// Prints the peaks of the lines of sight over the speed, or without them those of all outputs.
pub fn print(all: &[OutputWaterfall<'_>], units: Units) {
    let is_sight = |one: &&OutputWaterfall<'_>| one.output.output.starts_with("line_of_sight");
    let has_sight = all.iter().any(|one| is_sight(&one));
    let shown = all.iter().filter(|one| !has_sight || is_sight(one));
    let rows: Vec<Json> = shown.flat_map(rows).collect();
    if rows.is_empty() {
        return;
    }
    let window = all.iter().find_map(OutputWaterfall::window);
    let within =
        window.map_or_else(String::new, |window| format!(", and within windows of {}", time_span(window)));
    say!("  largest peaks over the speed, rms of all frequencies{within}");
    let columns = if window.is_some() { &PEAKS[..] } else { &PEAKS[..PEAKS.len() - 1] };
    print_rows(&rows, columns, units);
}

/// Returns the peaks of an output, in the order of their speeds.
fn rows(one: &OutputWaterfall<'_>) -> Vec<Json> {
    let (rms, within) = (one.rms(), one.rms_within_window());
    let mut sorted = rms.to_vec();
    sorted.sort_by(f64::total_cmp);
    let level = RISE * sorted.get(sorted.len() / 2).copied().unwrap_or(0.0);
    // The largest within the windows may be far below the largest of all frequencies.
    let within_largest =
        within.as_ref().and_then(|within| (0..within.len()).max_by(|a, b| within[*a].total_cmp(&within[*b])));
    let is_peak = |place: &usize| {
        let value = rms[*place];
        let rises = *place == 0 || rms[*place - 1] < value;
        let falls = rms.get(*place + 1).is_none_or(|next| *next <= value);
        value > level && rises && falls && within_largest != Some(*place)
    };
    let mut peaks: Vec<usize> = (0..rms.len()).filter(is_peak).collect();
    peaks.sort_by(|a, b| rms[*b].total_cmp(&rms[*a]));
    peaks.truncate(MOST);
    peaks.extend(within_largest);
    peaks.sort_unstable();
    let row = |(index, place): (usize, usize)| {
        json!({
            "output": if index == 0 { one.output.output.as_str() } else { "" },
            "speed_rad_s": one.wheels.speed_rad_s[place],
            "rms": rms[place],
            "within": within.as_ref().map(|within| within[place]),
            "unit": one.output.unit,
        })
    };
    peaks.into_iter().enumerate().map(row).collect()
}
