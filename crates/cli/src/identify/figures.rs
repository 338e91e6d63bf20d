//! Figure of an adaptive observer's trials: the fraction of runs that have identified their modes over time, a panel
//! for each set.

use std::f64::consts::TAU;

use flexsc_core::analysis::identification::IdentificationRow;
use flexsc_figure::{Figure, FigureAxis, Layer, LayerShape, Panel, RGBColor, colour, steps};

use super::ModeSetResults;

/// Colours of the relative frequency errors at the start, cyclic.
const COLOURS: [RGBColor; 5] =
    [colour::BLUE, colour::GREEN, colour::ORANGE, colour::VERMILLION, colour::BLACK];

/// Time after the last run has found its modes, relative to that before.
const AFTER: f64 = 1.5;

/// Returns the figure; a run lasts `whole` seconds, of which it shows those until all runs have found their modes.
pub fn figure(sets: &[ModeSetResults], whole: f64) -> Figure {
    let all = || sets.iter().flat_map(|set| &set.rows);
    let is_complete = all().all(|row| row.times_s.len() as f64 >= row.runs as f64);
    let last = all().flat_map(|row| &row.times_s).copied().fold(0.0, f64::max);
    let whole = if is_complete && last > 0.0 { whole.min(AFTER * last) } else { whole };
    let x = FigureAxis::exact("time (s)", "", 0.0..whole);
    let panel = |set: &ModeSetResults| {
        let layer = |(index, row): (usize, &IdentificationRow)| {
            let found = row.times_s.iter().zip(1_u32..);
            let part = |count: u32| 100.0 * f64::from(count) / row.runs as f64;
            let line = steps(
                std::iter::once((0.0, 0.0)).chain(found.map(|(time, count)| (*time, part(count)))),
                whole,
            );
            let off = format!("{} % off", (1000.0 * row.off).round() / 10.0);
            let name = if index == 0 { format!("{} Hz, {off}", set.frequencies(1.0 / TAU)) } else { off };
            Layer::new(&name, COLOURS[index % COLOURS.len()], LayerShape::Line(1.4), line)
        };
        let layers = set.rows.iter().enumerate().map(layer).collect();
        let y = FigureAxis::exact("found (%)", "", 0.0..104.0);
        Panel::new(x.unnamed(), y, layers)
    };
    let mut panels: Vec<Panel> = sets.iter().map(panel).collect();
    if let Some(last) = panels.last_mut() {
        last.x = x;
    }
    Figure { title: "modes found within 2 % of their frequency".to_owned(), panels, panel_height: 170 }
}
