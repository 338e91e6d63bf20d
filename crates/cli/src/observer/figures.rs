//! Figure of the recurrence observer's convergence: the regions of its weights with a frozen regressor (\[Timakov14\],
//! figure 2), and the error's contraction per sample over the gain of the identification.

use flexsc_core::analysis::damping::{Convergence, GainMargin};
use flexsc_figure::{Figure, FigureAxis, Layer, LayerShape, Panel, Point, RGBColor, band, colour};

use crate::grid::PositiveGrid;

/// Least and largest gain of the second panel, and number of gains.
const GAINS: (f64, f64, u32) = (1e-3, 1.0, 400);
/// Number of abscissae of a region.
const STEPS: u32 = 800;
/// Colours of the regions, cyclic.
const COLOURS: [RGBColor; 5] = [colour::SKY, colour::ORANGE, colour::GREEN, colour::BLUE, colour::VERMILLION];

/// Returns the figure, with a region for each gain.
pub fn figure(convergence: &Convergence, kappas: &[f64], margin: Option<GainMargin>) -> Figure {
    let title = format!("convergence of the recurrence observer of {:.4} rad/s", convergence.frequency);
    Figure {
        title,
        panels: vec![regions(convergence, kappas), radii(convergence, margin)],
        panel_height: 260,
    }
}

/// Returns the panel of the regions of W2 and W3, with the observer's own weights.
fn regions(convergence: &Convergence, kappas: &[f64]) -> Panel {
    // The strip |W1 + W2 - 1| < 1/B contains every region.
    let (w1, (_, b)) = (convergence.weights[0], convergence.recurrence());
    let (low, high) = (1.0 - w1 - 1.0 / b, 1.0 - w1 + 1.0 / b);
    let step = (high - low) / f64::from(STEPS);
    let abscissae: Vec<f64> = (0..STEPS).map(|i| low + step * (f64::from(i) + 0.5)).collect();
    let mut layers = Vec::new();
    let mut heights = vec![convergence.weights[2]];
    for (index, &kappa) in kappas.iter().enumerate() {
        let bounds = convergence.region(kappa, &abscissae);
        let side = |pick: fn((f64, f64)) -> f64| -> Vec<Point> {
            bounds.iter().map(|edge| (edge.elastic, edge.next.map_or(f64::NAN, pick))).collect()
        };
        let (lower, upper) = (side(|(low, _)| low), side(|(_, high)| high));
        heights.extend(lower.iter().chain(&upper).map(|point| point.1));
        let colour = COLOURS[index % COLOURS.len()];
        layers.push(Layer::new(
            &format!("converges, W4 |g| = {kappa}"),
            colour,
            LayerShape::Area(0.35),
            band(&lower, &upper),
        ));
        layers.push(Layer::new("", colour, LayerShape::Line(1.4), lower));
        layers.push(Layer::new("", colour, LayerShape::Line(1.4), upper));
    }
    layers.push(Layer::new(
        "weights",
        colour::BLACK,
        LayerShape::Diamond,
        vec![(convergence.weights[1], convergence.weights[2])],
    ));
    let x = FigureAxis::around("W2, regressor frozen", "", [low, high, convergence.weights[1]]);
    Panel::new(x, FigureAxis::around("W3", "", heights), layers)
}

/// Returns the panel of the error's contraction per sample over W4 V, with a turning regressor.
fn radii(convergence: &Convergence, margin: Option<GainMargin>) -> Panel {
    let (low, high, count) = GAINS;
    let PositiveGrid(decades) = PositiveGrid::new(low.log10(), high.log10(), count);
    let line: Vec<Point> = decades
        .iter()
        .map(|decade| 10_f64.powf(*decade))
        .map(|kappa| (kappa, convergence.spectral_radius(kappa)))
        .collect();
    let y =
        FigureAxis::around("left of an error by a sample", "", line.iter().map(|point| point.1).chain([1.0]));
    let mut layers = vec![
        Layer::new(
            "beyond this it diverges",
            colour::VERMILLION,
            LayerShape::Dashes,
            vec![(low, 1.0), (high, 1.0)],
        ),
        Layer::new("", colour::BLUE, LayerShape::Line(1.6), line),
    ];
    if let Some(margin) = margin {
        let best = vec![(margin.gain_best, margin.spectral_radius)];
        layers.push(Layer::new("soonest", colour::GREEN, LayerShape::Disc, best));
        layers.push(Layer::new(
            "limit",
            colour::VERMILLION,
            LayerShape::Square,
            vec![(margin.gain_max, 1.0)],
        ));
    }
    Panel::new(FigureAxis::decades("W4 V, regressor turning", "", [low, high]), y, layers)
}
