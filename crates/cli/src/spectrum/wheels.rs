//! Largest lines of the wheels' imbalance, as text.

use std::io::Write;

use flexsc_core::analysis::noise::{NoiseReport, SpectralLine, WheelLines, WheelSpectrum};

use super::print_table;
use crate::human::{Units, digits};
use crate::say;

/// Selection of a line under a harmonic of a wheel.
type LineOf<'a> = &'a dyn Fn(&WheelLines) -> Option<SpectralLine>;

/// Prints the largest direct line and the largest alias of each output.
pub fn print(report: &NoiseReport, wheels: &WheelSpectrum, units: Units) {
    let (factor, unit) = units.frequency();
    let texts = |words: &[&str]| words.iter().map(|word| (*word).to_owned()).collect::<Vec<_>>();
    let mut rows = vec![
        texts(&["output", "line", "amplitude", "at", "wheel", "order", "speed"]),
        texts(&["", "", "", unit, "", "", ""]),
    ];
    for (index, output) in report.outputs.iter().enumerate() {
        let direct = |lines: &WheelLines| Some(lines.outputs[index].direct);
        let alias = |lines: &WheelLines| lines.outputs[index].aliases.first().copied();
        let kinds: [(&str, LineOf<'_>); 2] = [("direct", &direct), ("alias", &alias)];
        for (kind, line_of) in kinds {
            let all = wheels.lines.iter().filter_map(|lines| Some((lines, line_of(lines)?)));
            let largest = all.max_by(|a, b| a.1.amplitude.total_cmp(&b.1.amplitude));
            let Some((lines, line)) = largest else { continue };
            rows.push(vec![
                if kind == "direct" { output.output.clone() } else { String::new() },
                kind.to_owned(),
                units.quantity(line.amplitude, &output.unit),
                digits(line.frequency_rad_s * factor),
                lines.wheel.to_string(),
                digits(lines.order),
                units.speed(lines.speed_rad_s),
            ]);
        }
    }
    let speeds = &wheels.speed_rad_s;
    let [first, last] =
        [speeds.first(), speeds.last()].map(|speed| units.speed(speed.copied().unwrap_or(0.0)));
    say!("  largest lines of the wheels' imbalance, {first} to {last}");
    print_table(&rows, 0);
}
