//! Figures of noise: densities with the cumulative rms.

use flexsc_core::analysis::noise::{NoiseReport, OutputNoise};
use flexsc_core::formats::reader_units::ReaderUnits;
use flexsc_figure::{
    Figure, FigureAxis, Layer, LayerShape, Named, Panel, Point, RGBColor, colour, name_and_unit,
};

use super::welch::WelchEstimate;

/// Colours of the sources.
const COLOURS: [RGBColor; 6] =
    [colour::BLUE, colour::VERMILLION, colour::GREEN, colour::ORANGE, colour::SKY, colour::GREY];

/// Returns a figure of the density and the cumulative rms of each output.
pub fn densities(name: &str, report: &NoiseReport, welch: &[WelchEstimate]) -> Vec<Named> {
    if report.sources.is_empty() {
        return Vec::new();
    }
    let figure = |output: &OutputNoise| {
        let estimate = welch.iter().find(|estimate| estimate.output == output.output);
        (format!("{name}-density_{}", output.output), density_figure(name, report, output, estimate))
    };
    report.outputs.iter().map(figure).collect()
}

fn density_figure(
    name: &str,
    report: &NoiseReport,
    output: &OutputNoise,
    welch: Option<&WelchEstimate>,
) -> Figure {
    let frequencies = &report.frequency_hz;
    let x = FigureAxis::decades("frequency", "Hz", frequencies.iter().copied());
    let unit = &output.unit;
    // A density has the square of the unit in which people read the rms.
    let shown = ReaderUnits::Engineering.fitting(output.rms, unit);
    let squared = |value: f64| value / (shown.size() * shown.size());
    let label = format!("density (({})²/Hz)", shown.name);
    let y = FigureAxis::decades(&label, "", output.density.iter().copied().map(squared));
    let line = |name: &str, colour: RGBColor, width: f64, values: &[f64]| {
        let points: Vec<Point> = frequencies.iter().copied().zip(values.iter().copied()).collect();
        Layer::new(name, colour, LayerShape::Line(width), points)
    };
    let density = |name: &str, colour: RGBColor, width: f64, values: &[f64]| {
        line(name, colour, width, &values.iter().copied().map(squared).collect::<Vec<_>>())
    };
    let estimate = |own: &WelchEstimate| {
        let points = own.frequency_hz.iter().copied().zip(own.density.iter().copied().map(squared));
        Layer::new("log (Welch)", colour::SKY, LayerShape::Line(1.0), points.collect())
    };
    let mut layers: Vec<Layer> = welch.map(estimate).into_iter().collect();
    if report.sources.len() > 1 {
        let each = report.sources.iter().zip(&output.density_by_source).zip(COLOURS.iter().cycle());
        let is_driven = |values: &[f64]| values.iter().any(|value| *value > 0.0);
        let driven = each.filter(|((_, values), _)| is_driven(values));
        layers.extend(driven.map(|((source, values), colour)| density(source, *colour, 1.0, values)));
    }
    let all = if report.sources.len() > 1 { "all" } else { &report.sources[0] };
    layers.push(density(all, colour::BLACK, 1.5, &output.density));
    let (name_of_rms, unit_of_rms) = name_and_unit("rms up to the frequency", unit);
    let rms = FigureAxis::from_zero(&name_of_rms, unit_of_rms, output.cumulative_rms.iter().copied());
    let cumulative = line("", colour::BLACK, 1.5, &output.cumulative_rms);
    let panels = vec![Panel::new(x.clone(), y, layers), Panel::new(x, rms, vec![cumulative])];
    Figure { title: format!("{name}: noise of {}", output.output), panels, panel_height: 240 }
}
