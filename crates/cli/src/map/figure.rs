//! Map of the spectral radius over the frequency of the dominant mode and the sampling period.

use flexsc_figure::palette::between;
use flexsc_figure::{
    Bar, Figure, FigureAxis, Layer, LayerShape, Panel, Point, RGBColor, ScalarField, colour,
};

use super::{LoopFamily, MapResults};
use crate::plot::readable;

/// Spectral radii on the colour bar: finest near 1, where stability ends.
const EDGES: [f64; 13] = [0.7, 0.9, 0.97, 0.99, 0.997, 0.999, 1.0, 1.001, 1.003, 1.01, 1.03, 1.1, 1.3];
/// Colours between the radii: blue if the loop is stable, orange if not, darker farther from 1 (after Brewer).
const COLOURS: [RGBColor; 14] = [
    RGBColor(8, 69, 148),
    RGBColor(33, 113, 181),
    RGBColor(66, 146, 198),
    RGBColor(107, 174, 214),
    RGBColor(158, 202, 225),
    RGBColor(198, 219, 239),
    RGBColor(226, 235, 247),
    RGBColor(254, 237, 222),
    RGBColor(253, 208, 162),
    RGBColor(253, 174, 107),
    RGBColor(253, 141, 60),
    RGBColor(241, 105, 19),
    RGBColor(217, 72, 1),
    RGBColor(140, 45, 4),
];

/// Number of shades between two labelled limits.
const SHADES: usize = 3;
/// Number of points along an axis for which the grid of the map is refined.
const FINE: usize = 160;
/// Number of floating-point operations for the refined grid: some seconds.
const WORK: f64 = 1e10;
/// Distance from 1 up to which radii have a linear scale; beyond it the scale is logarithmic.
const NEAR: f64 = 1e-3;

/// Returns the position of a radius on the colour scale; radii that are not finite lie at its end.
fn place(radius: f64) -> f64 {
    if radius.is_finite() { ((radius - 1.0) / NEAR).asinh() } else { f64::INFINITY }
}

/// Returns the positions of the limits between shades, with a text for each labelled one.
fn limits() -> Vec<(f64, String)> {
    let mut limits: Vec<(f64, String)> = Vec::new();
    for pair in EDGES.windows(2) {
        limits.push((place(pair[0]), pair[0].to_string()));
        let step = (place(pair[1]) - place(pair[0])) / SHADES as f64;
        limits.extend((1..SHADES).map(|shade| (place(pair[0]) + shade as f64 * step, String::new())));
    }
    let last = EDGES[EDGES.len() - 1];
    limits.push((place(last), last.to_string()));
    limits
}

/// Returns the colour of a shade: 0 lies below all limits.
fn shade(index: usize) -> RGBColor {
    let place = if index == 0 { 0.0 } else { 0.5 + (index as f64 - 0.5) / SHADES as f64 };
    between(&COLOURS, place)
}

/// Divides each step between increasing abscissae into `steps`.
fn divided(values: &[f64], steps: usize) -> Vec<f64> {
    let between = |pair: &[f64]| -> Vec<f64> {
        let part = |step: usize| step as f64 / steps as f64;
        (0..steps).map(|step| pair[0] + part(step) * (pair[1] - pair[0])).collect()
    };
    values.windows(2).flat_map(between).chain(values.last().copied()).collect()
}

/// Returns the number of parts into which the figure divides each step of the map; 1 for a loop of many modes, whose
/// spectral radii take long.
fn subdivision(family: &LoopFamily, frequencies: &[f64], periods: &[f64]) -> usize {
    let fine = (WORK / family.cost()).sqrt().min(FINE as f64);
    (fine as usize / frequencies.len().max(periods.len()).max(1)).max(1)
}

/// Returns the spectral radii on a grid that divides each step of the map evenly. They are computed at every point of it:
/// interpolated between the cells of the map, the limit of stability and narrow resonances would have steps.
fn refined(family: &LoopFamily, frequencies: &[f64], periods: &[f64], steps: usize) -> ScalarField {
    let (x, y) = (divided(frequencies, steps), divided(periods, steps));
    let values = family.radii(&x, &y);
    ScalarField { x, y, values }
}

/// Returns the figure of a map.
pub fn figure(map: &MapResults) -> Figure {
    let MapResults { name, cells, own, family, .. } = map;
    let mut frequencies: Vec<f64> = cells.iter().map(|cell| cell.frequency_rad_s).collect();
    frequencies.dedup();
    let periods = cells.iter().take(cells.len() / frequencies.len().max(1)).map(|cell| cell.period_s);
    let periods: Vec<f64> = periods.collect();
    let mut field = match subdivision(family, &frequencies, &periods) {
        1 => {
            let radii = cells.iter().map(|cell| cell.spectral_radius).collect();
            ScalarField { x: frequencies, y: periods, values: radii }
        }
        steps => refined(family, &frequencies, &periods, steps),
    };
    // Contours of the positions on the colour scale cross the edges of cells where the colours change.
    field.values.iter_mut().for_each(|radius| *radius = place(*radius));
    let ends = |values: &[f64]| values[0]..values[values.len() - 1];
    let x = FigureAxis::exact("frequency of the dominant mode", "rad/s", ends(&field.x)).in_hertz();
    let y = FigureAxis::exact("period of the samples (s)", "", ends(&field.y));

    // Only the shades that occur are in the bar.
    let limits = limits();
    let class = |place: &f64| limits.iter().filter(|(limit, _)| place >= limit).count();
    let classes = || field.values.iter().map(class);
    let (lowest, highest) = (classes().min().unwrap_or(0), classes().max().unwrap_or(0));
    let levels: Vec<f64> = limits[lowest..highest].iter().map(|(place, _)| *place).collect();
    let filled = |(class, points): (usize, Vec<Point>)| {
        Layer::new("", shade(lowest + class), LayerShape::Area(1.0), points)
    };
    let mut layers: Vec<Layer> = field.areas(&levels).into_iter().map(filled).collect();
    layers.push(Layer::new("limit of stability", colour::BLACK, LayerShape::Line(1.8), field.lines(0.0)));
    layers.push(Layer::new("scenario", colour::BLACK, LayerShape::Diamond, vec![*own]));
    let bar = Bar {
        name: "spectral radius".to_owned(),
        colours: (lowest..=highest).map(shade).collect(),
        edges: limits[lowest..highest].iter().map(|(_, text)| text.clone()).collect(),
    };
    let panel = Panel { bar: Some(bar), ..Panel::new(x, y, layers) };
    let title = format!("{}: stability of the sampled loop", readable(name));
    Figure { title, panels: vec![panel], panel_height: 420 }
}

#[cfg(test)]
mod tests {
    use flexsc_core::Scenario;
    use flexsc_core::analysis::sampled_loop::Scaling;

    use super::*;
    use crate::sampled_loop::sampled;

    #[test]
    fn the_drawn_limit_is_the_limit_of_stability() {
        let path = concat!(env!("CARGO_MANIFEST_DIR"), "/../../scenarios/wheel-settling-fit.toml");
        let scenario = Scenario::load(path.as_ref()).expect("a scenario");
        let (of, law) = sampled(&scenario).expect("a sampled loop");
        let family = LoopFamily { of, law: law.clone(), gain: Some(1.2), scaling: Scaling::All };
        let even = |low: f64, high: f64, count: u32| -> Vec<f64> {
            (0..count).map(|i| low + f64::from(i) / f64::from(count - 1) * (high - low)).collect()
        };
        let (frequencies, periods) = (even(0.5, 2.0, 12), even(0.1, 1.0, 10));
        let steps = subdivision(&family, &frequencies, &periods);
        let mut field = refined(&family, &frequencies, &periods, steps);
        field.values.iter_mut().for_each(|radius| *radius = place(*radius));
        let line = field.lines(0.0);
        let points: Vec<&Point> = line.iter().filter(|point| point.0.is_finite()).collect();
        assert!(points.len() > 100, "{}", points.len());
        for (frequency, period) in points {
            let off = |period: f64| place(family.radii(&[*frequency], &[period])[0]);
            // The sign changes within a fraction of a step of the map, which is 0.1 s.
            assert!(off(period - 2e-3) < 0.0 && off(period + 2e-3) > 0.0, "{frequency} rad/s, {period} s");
        }
    }
}
