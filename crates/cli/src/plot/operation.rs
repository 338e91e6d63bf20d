//! Bands of the modes of operation in every figure over time.

use flexsc_figure::{Figure, Layer, LayerShape, Point, RGBColor, colour};

use super::run_events::RunEvents;
use super::time;

/// Opacity of a band.
const DARKNESS: f64 = 0.13;
/// Height of the strip at the top of a panel, relative to the panel, and its opacity.
const STRIP: (f64, f64) = (0.04, 0.8);
/// Colours of the modes, in the order of the scenario.
const COLOURS: [RGBColor; 6] =
    [colour::SKY, colour::GREEN, colour::ORANGE, colour::BLUE, colour::GREY, colour::BLACK];

/// Adds the modes of operation of a run to a figure: each is a band of its colour, darker at the top.
pub fn shaded(mut figure: Figure, story: &RunEvents) -> Figure {
    let axis = time(0.0..1.0).name;
    let is_over_time = figure.panels.last().is_some_and(|panel| panel.x.name == axis);
    if story.modes.is_empty() || !is_over_time {
        return figure;
    }
    let mut is_first = true;
    for panel in &mut figure.panels {
        let (x, y) = (panel.x.range.clone(), panel.y.range.clone());
        let mut bands = Vec::new();
        for (index, mode) in story.scenario.mode.iter().enumerate() {
            let visits = story.modes.iter().enumerate().filter(|(_, start)| start.index == index);
            let spans: Vec<[f64; 2]> = visits
                .map(|(place, start)| {
                    let end = story.modes.get(place + 1).map_or(story.end, |next| next.time);
                    [start.time.max(x.start), end.min(x.end)]
                })
                .filter(|[from, to]| from < to)
                .collect();
            if spans.is_empty() {
                continue;
            }
            let area = |low: f64| -> Vec<Point> {
                let corners = |[from, to]: &[f64; 2]| {
                    [(*from, low), (*to, low), (*to, y.end), (*from, y.end), (f64::NAN, f64::NAN)]
                };
                spans.iter().flat_map(corners).collect()
            };
            let name = if is_first { mode.name.as_str() } else { "" };
            let colour = COLOURS[index % COLOURS.len()];
            let top = y.end - STRIP.0 * (y.end - y.start);
            bands.push(Layer::new("", colour, LayerShape::Area(DARKNESS), area(y.start)));
            bands.push(Layer::new(name, colour, LayerShape::Area(STRIP.1), area(top)));
        }
        is_first = false;
        panel.layers.splice(0..0, bands);
    }
    figure
}
