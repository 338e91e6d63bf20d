//! Largest lines of the wheels' imbalance, as text.

use std::io::Write;

use flexsc_core::analysis::noise::{NoiseReport, SpectralLine, WheelLines, WheelSpectrum, WindowRms};
use flexsc_core::formats::reader_units::time_span;
use serde_json::{Value as Json, json};

use super::{INDICES, index_row};
use crate::human::Units;
use crate::number_table::NumberTable;
use crate::row_table::{Column, column, print_rows};
use crate::say;

/// Selection of a line under a harmonic of a wheel.
type LineOf<'a> = &'a dyn Fn(&WheelLines) -> Option<SpectralLine>;

/// Value of an index over windows.
type IndexOf = fn(&WindowRms) -> Option<f64>;

/// Columns of the largest lines.
const LINES: [Column<'_>; 7] = [
    column("output", "output"),
    column("kind", "line"),
    column("amplitude", "amplitude").unit_of_row(),
    column("line.frequency_rad_s", "at"),
    column("wheel", "wheel"),
    column("order", "order"),
    column("speed_rad_s", "speed"),
];

/// Prints the largest direct line and the largest alias of each output.
pub fn print(report: &NoiseReport, wheels: &WheelSpectrum, units: Units) {
    let mut rows = Vec::new();
    for (index, output) in report.outputs.iter().enumerate() {
        let direct = |lines: &WheelLines| Some(lines.outputs[index].direct);
        let alias = |lines: &WheelLines| lines.outputs[index].aliases.first().copied();
        let kinds: [(&str, LineOf<'_>); 2] = [("direct", &direct), ("alias", &alias)];
        for (kind, line_of) in kinds {
            let all = wheels.lines.iter().filter_map(|lines| Some((lines, line_of(lines)?)));
            let largest = all.max_by(|a, b| a.1.amplitude.total_cmp(&b.1.amplitude));
            let Some((lines, line)) = largest else { continue };
            rows.push(json!({
                "output": if kind == "direct" { &output.output } else { "" },
                "kind": kind,
                "line": line,
                "unit": output.unit,
                "amplitude": line.amplitude,
                "wheel": lines.wheel,
                "order": lines.order,
                "speed_rad_s": lines.speed_rad_s,
            }));
        }
    }
    let speeds = &wheels.speed_rad_s;
    let [first, last] =
        [speeds.first(), speeds.last()].map(|speed| units.speed(speed.copied().unwrap_or(0.0)));
    say!("  largest lines of the wheels' imbalance, {first} to {last}");
    print_rows(&rows, &LINES, units);
    print_windows(report, wheels, units);
}

/// Prints the indices over windows at the speed at which the relative performance error is largest.
fn print_windows(report: &NoiseReport, wheels: &WheelSpectrum, units: Units) {
    let rows = report.outputs.iter().zip(&wheels.windows).filter_map(|(output, over_speed)| {
        let each = over_speed.iter().zip(&wheels.speed_rad_s);
        let (window, speed) = each.max_by(|a, b| a.0.rpe_uniform.total_cmp(&b.0.rpe_uniform))?;
        let mut row = index_row(window, output);
        row["speed_rad_s"] = json!(speed);
        Some(row)
    });
    let rows: Vec<Json> = rows.collect();
    let Some(window) = wheels.windows.first().and_then(|over_speed| over_speed.first()) else { return };
    say!(
        "  indices of these lines over windows of {}, rms, at the speed of the largest RPE uniform",
        time_span(window.window_s)
    );
    print_rows(&rows, &[&INDICES[..], &[column("speed_rad_s", "speed")]].concat(), units);
}

/// Returns rms, contrast and indices of each output as a table over the speed of the wheels.
pub fn table(report: &NoiseReport, wheels: &WheelSpectrum) -> NumberTable {
    let mut columns = vec!["speed_rad_s".to_owned()];
    let mut lists: Vec<Vec<Option<f64>>> =
        vec![wheels.speed_rad_s.iter().map(|speed| Some(*speed)).collect()];
    for (index, output) in report.outputs.iter().enumerate() {
        let name = &output.output;
        columns.push(format!("{name}_rms"));
        lists.push(wheels.rms[index].iter().map(|rms| Some(*rms)).collect());
        if let Some(mtf) = wheels.mtf.get(index).filter(|mtf| !mtf.is_empty()) {
            columns.push(format!("{name}_mtf"));
            lists.push(mtf.iter().map(|value| Some(*value)).collect());
        }
        let Some(over_speed) = wheels.windows.get(index) else { continue };
        let indices: [(&str, IndexOf); 7] = [
            ("mpe", |of| Some(of.mpe)),
            ("rpe_uniform", |of| Some(of.rpe_uniform)),
            ("rpe_end", |of| Some(of.rpe_end)),
            ("rpe_middle", |of| Some(of.rpe_middle)),
            ("smear", |of| Some(of.smear)),
            ("beyond_smear", |of| Some(of.beyond_smear)),
            ("pde", |of| of.pde),
        ];
        let is_given = |value: &IndexOf| over_speed.iter().any(|of| value(of).is_some());
        for (index, value) in indices.into_iter().filter(|(_, value)| is_given(value)) {
            columns.push(format!("{name}_{index}"));
            lists.push(over_speed.iter().map(value).collect());
        }
    }
    let row = |place: usize| lists.iter().map(|list| list[place]).collect();
    NumberTable { columns, rows: (0..wheels.speed_rad_s.len()).map(row).collect() }
}
