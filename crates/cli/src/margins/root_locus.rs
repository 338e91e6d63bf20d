//! Figure of the root locus: poles of the closed loop in the s plane over the gain of the loop with the least gain margin,
//! the rigid body and the elastic modes side by side.

use std::f64::consts::TAU;

use flexsc_core::analysis::margins::{LocusCrossing, RootLocus, SignalMargins};
use flexsc_core::analysis::open_loop::OpenLoop;
use flexsc_figure::palette::viridis;
use flexsc_figure::{Bar, Figure, FigureAxis, Layer, LayerShape, Note, NoteSide, Panel, Point, colour};
use rustfft::num_complex::Complex;

/// Gains of the locus (dB): the least, their number, and steps per dB.
const LEAST_DB: f64 = -34.0;
const GAINS: usize = 481;
const PER_DB: usize = 8;
/// Gains of one colour (dB), and those between two numbers of the colour bar.
const COLOUR_DB: usize = 2;
const NUMBER_DB: i32 = 10;
/// Damping ratio below which a pole is that of an elastic mode, and the ratio of its frequency to that of the loop above which it is.
const LIGHT: f64 = 0.2;
const BEYOND: f64 = 2.0;
/// Damping ratios of the rays (%).
const RAYS: [f64; 11] = [0.1, 0.2, 0.5, 1.0, 2.0, 5.0, 10.0, 30.0, 50.0, 70.0, 90.0];
/// Width of the unstable half relative to the stable one.
const RIGHT: f64 = 0.25;

/// Part of the s plane in a panel (Hz).
struct PlaneView {
    head: &'static str,
    left: f64,
    high: f64,
    /// True for the panel to the right of another.
    is_second: bool,
}

/// Returns the figure; `None` for a loop without poles.
pub fn figure(name: &str, opened: &OpenLoop, loops: &[SignalMargins]) -> Option<Figure> {
    let margin = |one: &SignalMargins| {
        let below = if one.gain_below > 0.0 { -one.gain_below.ln() } else { f64::INFINITY };
        one.gain_above.map_or(f64::INFINITY, f64::ln).min(below)
    };
    let (signal, one) = loops.iter().enumerate().min_by(|a, b| margin(a.1).total_cmp(&margin(b.1)))?;
    let decibels = |step: usize| LEAST_DB + step as f64 / PER_DB as f64;
    let factors: Vec<f64> = (0..GAINS).map(|step| 10_f64.powf(decibels(step) / 20.0)).collect();
    let locus = RootLocus::new(opened, signal, &factors)?;
    let crossing = one.crossings.gain.first().map(|crossing| crossing.frequency_rad_s / TAU);
    let views = views(&locus, crossing);
    let mut panels: Vec<Panel> = views.iter().map(|view| panel(&locus, view)).collect();
    // A crossing is named in the first panel that shows it well.
    for crossing in &locus.crossings {
        let frequency = crossing.frequency_rad_s / TAU;
        if let Some(place) = views.iter().position(|view| frequency < 0.97 * view.high) {
            mark(&mut panels[place], crossing, frequency);
        }
    }
    let colours = viridis(classes());
    let edge = |class: usize| {
        let edge = (LEAST_DB as i32) + (COLOUR_DB * class) as i32;
        if edge % NUMBER_DB == 0 { edge.to_string().replace('-', "−") } else { String::new() }
    };
    let edges = (1..classes()).map(edge).collect();
    let what = one.signal.replace('_', " ");
    panels[0].bar = Some(Bar { name: format!("gain of {what} (dB)"), colours, edges });
    Some(Figure { title: format!("{name}: root locus"), panels, panel_height: 330 })
}

fn classes() -> usize {
    (GAINS - 1) / (PER_DB * COLOUR_DB)
}

/// Returns the parts of the plane: around the poles of the rigid body, and around those of the elastic modes if there are any.
fn views(locus: &RootLocus, crossing: Option<f64>) -> Vec<PlaneView> {
    let hertz = |pole: &Complex<f64>| Point::from((-pole.re / TAU, pole.im / TAU));
    let upper: Vec<Point> = locus.designed.iter().map(hertz).filter(|pole| pole.1 > 0.0).collect();
    let largest = |values: &mut dyn Iterator<Item = f64>| values.fold(0.0, f64::max);
    let is_light = |pole: &&Point| pole.0 < LIGHT * pole.0.hypot(pole.1);
    let own = crossing.unwrap_or_else(|| {
        largest(&mut upper.iter().filter(|pole| !is_light(pole)).map(|pole| pole.0.hypot(pole.1)))
    });
    let elastic: Vec<&Point> =
        upper.iter().filter(|pole| is_light(pole) && pole.0.hypot(pole.1) > BEYOND * own).collect();
    let mut views = Vec::new();
    if own > 0.0 {
        let head = if elastic.is_empty() { "" } else { "rigid body" };
        views.push(PlaneView { head, left: 1.4 * own, high: 1.1 * own, is_second: false });
    }
    let crossings = locus.crossings.iter().map(|crossing| crossing.frequency_rad_s / TAU);
    if !elastic.is_empty() || own <= 0.0 {
        let high = 1.15 * largest(&mut elastic.iter().map(|pole| pole.1).chain(crossings));
        let high = if high > 0.0 { high } else { 1.0 };
        let left = 2.0 * largest(&mut elastic.iter().map(|pole| pole.0));
        let left = left.max(0.03 * high);
        views.push(PlaneView { head: "elastic modes", left, high, is_second: own > 0.0 });
    }
    views
}

fn panel(locus: &RootLocus, view: &PlaneView) -> Panel {
    let PlaneView { left, high, .. } = *view;
    let right = RIGHT * left;
    let corners = vec![(0.0, 0.0), (right, 0.0), (right, high), (0.0, high)];
    let mut layers = vec![Layer::new("", colour::RED, LayerShape::Area(0.1), corners)];
    let mut notes = vec![Note::new("unstable", (0.5 * right, 0.3 * high), colour::RED).on(NoteSide::Upright)];
    for (end, text) in rays(view) {
        layers.push(Layer::new("", colour::GREY, LayerShape::Line(0.5), vec![(0.0, 0.0), end]));
        notes.push(Note::new(text, (0.93 * end.0, 0.93 * end.1), colour::GREY).on(NoteSide::Centre));
    }
    let axis = vec![(0.0, 0.0), (0.0, high)];
    layers.push(Layer::new("", colour::BLACK, LayerShape::Line(1.0), axis));
    let each = (PER_DB * COLOUR_DB, viridis(classes()));
    for (class, colour) in each.1.into_iter().enumerate() {
        let points = class * each.0..=(class + 1) * each.0;
        let of_branch = |branch: &Vec<Complex<f64>>| -> Vec<Point> {
            let part = &branch[points.clone()];
            let mut line = Vec::with_capacity(part.len() + 1);
            for pair in part.windows(2) {
                let [from, to] = [&pair[0], &pair[1]].map(|pole| (pole.re / TAU, pole.im / TAU));
                // A step across the view is that to another pole; lower poles mirror the upper ones.
                let is_near = (from.0 - to.0).abs() < 0.5 * left && (from.1 - to.1).abs() < 0.3 * high;
                let is_upper = from.1 > -1e-9 * high && to.1 > -1e-9 * high;
                if is_near && is_upper {
                    line.extend([from, to]);
                } else {
                    line.push((f64::NAN, f64::NAN));
                }
            }
            line.push((f64::NAN, f64::NAN));
            line
        };
        let line = locus.branches.iter().flat_map(of_branch).collect();
        layers.push(Layer::new("", colour, LayerShape::Line(2.2), line));
    }
    let marks = |poles: &[Complex<f64>]| -> Vec<Point> {
        let shown = poles.iter().filter(|pole| pole.im >= -1e-9 * high);
        // Poles on an axis are within the panel in spite of rounding.
        shown.map(|pole| (pole.re / TAU, (pole.im / TAU).max(0.0))).collect()
    };
    let [open, designed, up] =
        if view.is_second { ["", "", ""] } else { ["loop open", "as designed", "imaginary part"] };
    layers.push(Layer::new(open, colour::GREY, LayerShape::Cross, marks(&locus.open)));
    layers.push(Layer::new(designed, colour::BLACK, LayerShape::Ring, marks(&locus.designed)));
    let x = FigureAxis::exact("real part", "Hz", -left..right);
    let panel = Panel::new(x, FigureAxis::exact(up, "Hz", 0.0..high), layers);
    let panel = panel.headed(view.head).noted(notes).plain();
    if view.is_second { panel.right_of_last() } else { panel }
}

/// Returns the ends of the rays of equal damping, each with its damping ratio: those that are apart from the axes.
fn rays(view: &PlaneView) -> Vec<(Point, String)> {
    let PlaneView { left, high, .. } = *view;
    let mut rays: Vec<(Point, String)> = Vec::new();
    for percent in RAYS {
        let damping = percent / 100.0;
        let slope = f64::sqrt(1.0 - damping * damping) / damping;
        let end = if slope * left > high { (-high / slope, high) } else { (-left, slope * left) };
        let last = rays.last().map_or((0.0, high), |ray| ray.0);
        let apart = ((last.0 - end.0) / left).abs().max(((last.1 - end.1) / high).abs());
        if apart > 0.22 && end.1 > 0.1 * high {
            rays.push((end, format!("{percent} %")));
        }
    }
    rays
}

/// Marks a crossing of the imaginary axis with its gain and its frequency (Hz).
fn mark(panel: &mut Panel, crossing: &LocusCrossing, frequency: f64) {
    let decibels = 20.0 * crossing.factor.log10();
    let gain = format!("{decibels:+.1} dB").replace('-', "−");
    let text = format!("{gain}\n{} Hz", flexsc_core::formats::reader_units::number(frequency));
    panel.notes.push(Note::new(text, (0.0, frequency), colour::RED).on(NoteSide::Left));
    panel.layers.push(Layer::new("", colour::RED, LayerShape::Disc, vec![(0.0, frequency)]));
}
