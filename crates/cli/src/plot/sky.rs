//! Bands of eclipses and of blinded star trackers in every figure over time.

use flexsc_core::record::{Light, Orbit};
use flexsc_figure::{Figure, Layer, LayerShape, Panel, Point, RGBColor, Scale, colour};

use super::cycle_data::CycleData;
use super::run_events::RunEvents;
use super::time;

/// Opacity of an eclipse, and of a blinded star tracker.
const DARKNESS: [f64; 2] = [0.2, 0.08];
/// Height of the strip at the bottom of a panel of a blinded star tracker, relative to the panel, and its opacity.
const STRIP: (f64, f64) = (0.04, 0.8);

/// Adds the eclipses of a run and the times at which a star tracker is blinded to a figure.
pub fn shaded(mut figure: Figure, story: &RunEvents, cycles: &CycleData) -> Figure {
    let axis = time(0.0..1.0).name;
    if figure.panels.last().is_none_or(|panel| panel.x.name != axis) {
        return figure;
    }
    let eclipses = eclipses(cycles, story.end);
    let (mut eclipse, mut blinded) = ("eclipse", "star tracker blinded");
    for panel in &mut figure.panels {
        let (low, high) = (panel.y.range.start, panel.y.range.end);
        let mut bands = Vec::new();
        let mut add = |name: &mut &'static str, colour: RGBColor, opacity: f64, points: Vec<Point>| {
            if !points.is_empty() {
                bands.push(Layer::new(std::mem::take(name), colour, LayerShape::Area(opacity), points));
            }
        };
        add(&mut eclipse, colour::GREY, DARKNESS[0], areas(panel, &eclipses, low..high));
        add(&mut "", colour::VERMILLION, DARKNESS[1], areas(panel, &story.blinded, low..high));
        let strip = low..match panel.y.scale {
            Scale::Linear => low + STRIP.0 * (high - low),
            Scale::Logarithmic => low * (high / low).powf(STRIP.0),
        };
        add(&mut blinded, colour::VERMILLION, STRIP.1, areas(panel, &story.blinded, strip));
        panel.layers.splice(0..0, bands);
    }
    figure
}

/// Returns intervals as areas within a panel.
fn areas(panel: &Panel, spans: &[[f64; 2]], y: std::ops::Range<f64>) -> Vec<Point> {
    let within = |[from, to]: &[f64; 2]| [from.max(panel.x.range.start), to.min(panel.x.range.end)];
    let corners = |[from, to]: [f64; 2]| {
        [(from, y.start), (to, y.start), (to, y.end), (from, y.end), (f64::NAN, f64::NAN)]
    };
    spans.iter().map(within).filter(|[from, to]| from < to).flat_map(corners).collect()
}

/// Returns the intervals of the rows in shadow (s).
fn eclipses(cycles: &CycleData, end: f64) -> Vec<[f64; 2]> {
    let mut eclipses = Vec::new();
    let mut since = None;
    for (time, row) in cycles.rows::<Orbit>() {
        match (row.light, since) {
            (Light::Shadow, None) => since = Some(time),
            (Light::Lit, Some(from)) => {
                eclipses.push([from, time]);
                since = None;
            }
            _ => {}
        }
    }
    eclipses.extend(since.map(|from| [from, end]));
    eclipses
}
