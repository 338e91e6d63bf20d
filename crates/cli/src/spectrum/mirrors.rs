//! Fine mirrors of lines of sight: up to which frequency they help, as text and as a figure.

use std::f64::consts::TAU;
use std::io::Write;

use flexsc_core::analysis::fine_mirror::MirrorSensitivity;
use flexsc_figure::{Figure, FigureAxis, Layer, LayerShape, Named, Panel, Point, colour};

use crate::human::{Units, digits};
use crate::say;

/// Prints what each mirror leaves.
pub fn print(mirrors: &[MirrorSensitivity], units: Units) {
    let (factor, unit) = units.frequency();
    let frequency = |hertz: f64| format!("{} {unit}", digits(hertz * TAU * factor));
    for own in mirrors {
        let enlarges = own.crossing_hz.map_or_else(
            || "and enlarges none".to_owned(),
            |crossing| {
                let (peak, at) = (digits(own.peak), frequency(own.peak_hz));
                format!("makes it worse above {}, at most {peak} times at {at}", frequency(crossing))
            },
        );
        say!(
            "  fine mirror of {}: reduces slow motion, {enlarges}; spectral radius {:.6}; without limits and without its reaction \
             torque on the body",
            own.point,
            own.spectral_radius
        );
    }
}

/// Returns a figure of what each mirror leaves over frequency.
pub fn figures(name: &str, mirrors: &[MirrorSensitivity]) -> Vec<Named> {
    let figure = |own: &MirrorSensitivity| (format!("{name}-mirror_{}", own.line), figure(name, own));
    mirrors.iter().map(figure).collect()
}

fn figure(name: &str, own: &MirrorSensitivity) -> Figure {
    let x = FigureAxis::decades("frequency", "Hz", own.frequency_hz.iter().copied());
    let y = FigureAxis::decades("behind the mirror / before it", "", own.sensitivity.iter().copied());
    let points: Vec<Point> = own.frequency_hz.iter().copied().zip(own.sensitivity.iter().copied()).collect();
    let ends = [points.first(), points.last()].into_iter().flatten();
    let unity: Vec<Point> = ends.map(|(frequency, _)| (*frequency, 1.0)).collect();
    let layers = vec![
        Layer::new("", colour::GREY, LayerShape::Line(1.0), unity),
        Layer::new("", colour::BLUE, LayerShape::Line(1.5), points),
    ];
    let title = format!("{name}: fine mirror of {}", own.point);
    Figure { title, panels: vec![Panel::new(x, y, layers)], panel_height: 260 }
}
