//! Figures of noise: densities with the cumulative rms, and lines of the wheels over their speed.

use std::f64::consts::TAU;

use flexsc_core::analysis::noise::{NoiseReport, OutputNoise, WheelSpectrum, WindowRms};
use flexsc_figure::{
    Figure, FigureAxis, Layer, LayerShape, Named, Panel, Point, RGBColor, colour, name_and_unit, palette,
};

use super::welch::WelchEstimate;

/// Colours of the sources.
const COLOURS: [RGBColor; 6] =
    [colour::BLUE, colour::VERMILLION, colour::GREEN, colour::ORANGE, colour::SKY, colour::GREY];
/// Decades of amplitudes that a waterfall shows.
const DECADES: usize = 5;

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
    let y = FigureAxis::decades(&format!("density ({unit})²/Hz"), "", output.density.iter().copied());
    let line = |name: &str, colour: RGBColor, width: f64, values: &[f64]| {
        let points: Vec<Point> = frequencies.iter().copied().zip(values.iter().copied()).collect();
        Layer::new(name, colour, LayerShape::Line(width), points)
    };
    let mut layers: Vec<Layer> = welch.map(estimate_layer).into_iter().collect();
    if report.sources.len() > 1 {
        let each = report.sources.iter().zip(&output.density_by_source).zip(COLOURS.iter().cycle());
        let is_driven = |values: &[f64]| values.iter().any(|value| *value > 0.0);
        let driven = each.filter(|((_, values), _)| is_driven(values));
        layers.extend(driven.map(|((source, values), colour)| line(source, *colour, 1.0, values)));
    }
    let all = if report.sources.len() > 1 { "all" } else { &report.sources[0] };
    layers.push(line(all, colour::BLACK, 1.5, &output.density));
    let (name_of_rms, unit_of_rms) = name_and_unit("rms up to the frequency", unit);
    let rms = FigureAxis::from_zero(&name_of_rms, unit_of_rms, output.cumulative_rms.iter().copied());
    let cumulative = line("", colour::BLACK, 1.5, &output.cumulative_rms);
    let panels = vec![Panel::new(x.clone(), y, layers), Panel::new(x, rms, vec![cumulative])];
    Figure { title: format!("{name}: noise of {}", output.output), panels, panel_height: 240 }
}

/// Returns the estimate of a log.
fn estimate_layer(estimate: &WelchEstimate) -> Layer {
    let points = estimate.frequency_hz.iter().copied().zip(estimate.density.iter().copied());
    Layer::new("log (Welch)", colour::SKY, LayerShape::Line(1.0), points.collect())
}

/// Returns a figure of the lines of each output over frequency and speed, and of their rms over speed.
pub fn waterfalls(name: &str, report: &NoiseReport) -> Vec<Named> {
    let Some(wheels) = &report.wheels else { return Vec::new() };
    let figure = |(index, output): (usize, &OutputNoise)| {
        (format!("{name}-waterfall_{}", output.output), waterfall(name, wheels, (index, output)))
    };
    report.outputs.iter().enumerate().map(figure).collect()
}

fn waterfall(name: &str, wheels: &WheelSpectrum, (index, output): (usize, &OutputNoise)) -> Figure {
    let mut lines: Vec<(Point, f64)> = Vec::new();
    for of_wheel in &wheels.lines {
        let found = &of_wheel.outputs[index];
        for line in found.aliases.iter().chain([&found.direct]) {
            lines.push(((line.frequency_rad_s / TAU, of_wheel.speed_rad_s), line.amplitude));
        }
    }
    let largest = lines.iter().map(|(_, amplitude)| *amplitude).fold(0.0, f64::max);
    let top = largest.log10().ceil();
    let colours = palette::viridis(DECADES);
    let layer = |decade: usize| {
        let high = top - decade as f64;
        let range = 10_f64.powf(high - 1.0)..10_f64.powf(high);
        let points = lines.iter().filter(|(_, amplitude)| range.contains(amplitude)).map(|(point, _)| *point);
        let name = format!("to 1e{high} {}", output.unit);
        Layer::new(&name, colours[DECADES - 1 - decade], LayerShape::Dot, points.collect())
    };
    let layers: Vec<Layer> = if largest > 0.0 { (0..DECADES).rev().map(layer).collect() } else { Vec::new() };
    let speed = || FigureAxis::around("speed", "rad/s", wheels.speed_rad_s.iter().copied());
    let frequency = FigureAxis::around("frequency", "Hz", lines.iter().map(|(point, _)| point.0));
    let rms = &wheels.rms[index];
    let over_speed = |name: &str, colour: RGBColor, values: &[f64]| {
        let points = wheels.speed_rad_s.iter().copied().zip(values.iter().copied()).collect();
        Layer::new(name, colour, LayerShape::Line(1.5), points)
    };
    let mut all = rms.clone();
    let curves = match wheels.windows.get(index) {
        Some(windows) => {
            let of = |value: fn(&WindowRms) -> f64| windows.iter().map(value).collect::<Vec<f64>>();
            let (mpe, rpe) = (of(|index| index.mpe), of(|index| index.rpe_uniform));
            all.extend(mpe.iter().chain(&rpe));
            let length = windows.first().map_or(0.0, |index| index.window_s);
            vec![
                over_speed("rms", colour::BLUE, rms),
                over_speed(&format!("MPE, {length} s"), colour::GREEN, &mpe),
                over_speed(&format!("RPE uniform, {length} s"), colour::VERMILLION, &rpe),
            ]
        }
        None => vec![over_speed("", colour::BLUE, rms)],
    };
    let size = FigureAxis::decades(&format!("rms ({})", output.unit), "", all);
    let panels = vec![Panel::new(frequency, speed(), layers), Panel::new(speed(), size, curves)];
    Figure { title: format!("{name}: lines of the wheels in {}", output.output), panels, panel_height: 260 }
}
