//! Figure of a relay's damping over the frequency of a mode: the remaining part of its effect, the gain, and the limit
//! cycle that the delay causes.

use flexsc_core::analysis::damping::DampedMode;
use flexsc_figure::{Figure, FigureAxis, Layer, LayerShape, Panel, Point, colour};

/// Values whose ratio is at most this have a linear axis.
const NEAR: f64 = 10.0;

fn scaled(name: &str, unit: &'static str, values: Vec<f64>) -> FigureAxis {
    let (low, high) =
        values.iter().fold((f64::INFINITY, 0.0_f64), |(low, high), v| (low.min(*v), high.max(*v)));
    if high <= NEAR * low {
        FigureAxis::from_zero(name, unit, values)
    } else {
        FigureAxis::decades(name, unit, values)
    }
}

/// Returns the figure; `limit` is the frequency (rad/s) above which the relay excites the modes.
pub fn figure(rows: &[DampedMode], limit: f64) -> Figure {
    let (low, high) = (rows.first(), rows.last());
    let range = low.map_or(0.0, |row| row.frequency_rad_s)..high.map_or(1.0, |row| row.frequency_rad_s);
    let x = |name: &str| FigureAxis::exact(name, "rad/s", range.clone()).in_hertz();
    let line = |value: &dyn Fn(&DampedMode) -> Option<f64>| -> Vec<Point> {
        rows.iter().map(|row| (row.frequency_rad_s, value(row).unwrap_or(f64::NAN))).collect()
    };
    let part = line(&|row| Some(row.phase_factor));
    let gain = line(&|row| row.gain_limit_1_s);
    let cycle = line(&|row| row.limit_cycle_rate_rad_s);
    let values =
        |values: &[Point]| values.iter().map(|point| point.1).filter(|v| v.is_finite()).collect::<Vec<f64>>();
    let panel = |x: FigureAxis, y: FigureAxis, points: Vec<Point>, name: &str| {
        let mut layers = Vec::new();
        let label = y.name.split(" (").next().unwrap_or_default().to_owned();
        if limit < range.end {
            let edge = y.range.clone();
            let boundary = vec![(limit, edge.start), (limit, edge.end)];
            layers.push(Layer::new(name, colour::VERMILLION, LayerShape::Dashes, boundary));
        }
        layers.push(Layer::new(&label, colour::BLUE, LayerShape::Line(1.6), points));
        Panel::new(x, y, layers)
    };
    let factor = FigureAxis::around("phase factor", "", values(&part).into_iter().chain([0.0, 1.0]));
    let gains = scaled("gain limit (1/s)", "", values(&gain));
    let cycles = scaled("limit cycle", "rad/s", values(&cycle));
    let mut panels = vec![panel(x("").unnamed(), factor, part, "beyond this the relay drives the mode")];
    if !values(&gain).is_empty() {
        panels.push(panel(x("").unnamed(), gains, gain, ""));
    }
    if !values(&cycle).is_empty() {
        panels.push(panel(x("").unnamed(), cycles, cycle, ""));
    }
    if let Some(last) = panels.last_mut() {
        last.x = x("natural frequency");
    }
    Figure { title: "active damping by a relay".to_owned(), panels, panel_height: 200 }
}
