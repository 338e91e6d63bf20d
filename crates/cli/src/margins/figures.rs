//! Figures of a loop that is cut open: Bode, Nichols, Nyquist and singular values.

use std::f64::consts::{PI, TAU};

use flexsc_core::analysis::margins::{Crossings, SignalMargins, SingularValues, StabilityMargins};
use flexsc_core::formats::reader_units::number;
use flexsc_figure::{Figure, FigureAxis, Layer, LayerShape, Named, Note, Panel, Point, RGBColor, colour};

use super::mask::NicholsMask;

/// Colours of the loops.
const COLOURS: [RGBColor; 6] =
    [colour::BLUE, colour::VERMILLION, colour::GREEN, colour::ORANGE, colour::SKY, colour::BLACK];
/// Magnitudes (dB) beyond which a loop is not drawn.
const SHOWN_DB: f64 = 80.0;
/// Largest magnitude in a Nyquist figure.
const SHOWN: f64 = 3.0;
/// Steps of a loop (dB, deg) that are jumps.
const JUMP_DB: f64 = 1.0;
const JUMP_DEG: f64 = 10.0;
/// Width of a Nyquist figure relative to its height.
const ASPECT: f64 = 1.37;

/// Locus of a loop over frequency: a line of a figure.
pub struct LocusLine {
    name: String,
    colour: RGBColor,
    /// Frequency (Hz), magnitude (dB) and phase (deg, without jumps) at each point.
    pub points: Vec<[f64; 3]>,
    /// Crossings with their least margins of gain (factor) and phase.
    crossings: Crossings,
}

/// Returns the lines of loops whose period is `period` (s).
pub fn locus_lines(loops: &[SignalMargins], period: f64) -> Vec<LocusLine> {
    let coloured = loops.iter().zip(COLOURS.iter().cycle());
    coloured.map(|(one, colour)| LocusLine::new(one, period, *colour)).collect()
}

/// Returns the figures of loops whose period is `period` (s).
pub fn figures(name: &str, loops: &[SignalMargins], period: f64, mask: Option<&NicholsMask>) -> Vec<Named> {
    let lines = locus_lines(loops, period);
    vec![
        (format!("{name}-bode"), bode(name, &lines)),
        (format!("{name}-nichols"), nichols(name, &lines, mask)),
        (format!("{name}-nyquist"), nyquist(name, loops)),
    ]
}

impl LocusLine {
    fn new(one: &SignalMargins, period: f64, colour: RGBColor) -> Self {
        let mut last: Option<f64> = None;
        let points = one.response().into_iter().map(|(frequency, value)| {
            let phase = value.im.atan2(value.re);
            let phase = match last {
                // The phase at the start is between -360 and 0 degrees.
                None if phase > 0.0 => phase - TAU,
                None => phase,
                Some(before) => phase + TAU * ((before - phase) / TAU).round(),
            };
            last = Some(phase);
            [frequency / TAU, 20.0 * value.re.hypot(value.im).log10(), phase * 180.0 / PI]
        });
        let mut points: Vec<[f64; 3]> = points.collect();
        // With several samples in a period, the loop may jump at multiples of half the rate of the period.
        let band = |frequency: f64| (2.0 * frequency * period).floor();
        let is_jump = |pair: &[[f64; 3]]| {
            band(pair[0][0]) < band(pair[1][0])
                && ((pair[1][1] - pair[0][1]).abs() > JUMP_DB || (pair[1][2] - pair[0][2]).abs() > JUMP_DEG)
        };
        let jumps: Vec<usize> =
            points.windows(2).enumerate().filter(|(_, pair)| is_jump(pair)).map(|(place, _)| place).collect();
        for place in jumps.into_iter().rev() {
            points.insert(place + 1, [points[place][0], f64::NAN, f64::NAN]);
        }
        Self { name: one.signal.replace('_', " "), colour, points, crossings: one.crossings.clone() }
    }

    /// Returns the point at a frequency (Hz), between those of the line.
    fn at(&self, frequency: f64) -> Option<[f64; 3]> {
        let next = self.points.partition_point(|point| point[0] < frequency);
        let (before, after) = (self.points.get(next.checked_sub(1)?)?, self.points.get(next)?);
        let part = (frequency - before[0]) / (after[0] - before[0]);
        Some([0, 1, 2].map(|k| before[k] + part * (after[k] - before[k])))
    }

    /// Returns the points at which the phase is that of -1, each with the factor on the gain that the loop tolerates.
    fn phase_crossings(&self) -> impl Iterator<Item = ([f64; 3], f64)> {
        self.crossings.phase.iter().filter_map(|crossing| {
            let point = self.at(crossing.frequency_rad_s / TAU)?;
            Some(([point[0], -20.0 * crossing.factor.log10(), point[2]], crossing.factor))
        })
    }

    /// Returns the points at which the gain is 1, each with the phase (rad) that the loop tolerates.
    fn gain_crossings(&self) -> impl Iterator<Item = ([f64; 3], f64)> {
        self.crossings.gain.iter().filter_map(|crossing| {
            let point = self.at(crossing.frequency_rad_s / TAU)?;
            Some(([point[0], 0.0, point[2]], crossing.phase_rad))
        })
    }

    /// Returns the line over two of its quantities, with gaps where it is out of the shown magnitudes.
    fn layer(&self, x: usize, y: usize) -> Layer {
        let point = |values: &[f64; 3]| {
            if values[1].abs() <= SHOWN_DB { (values[x], values[y]) } else { (f64::NAN, f64::NAN) }
        };
        Layer::new(&self.name, self.colour, LayerShape::Line(1.5), self.points.iter().map(point).collect())
    }
}

/// Returns the values of a quantity of all lines within the shown magnitudes.
fn values(lines: &[LocusLine], quantity: usize) -> impl Iterator<Item = f64> + '_ {
    let shown = lines.iter().flat_map(|line| &line.points).filter(|values| values[1].abs() <= SHOWN_DB);
    shown.map(move |values| values[quantity])
}

/// Returns a horizontal line over a range.
fn level(range: &std::ops::Range<f64>, height: f64) -> Layer {
    let points = vec![(range.start, height), (range.end, height)];
    Layer::new("", colour::GREY, LayerShape::Dashes, points)
}

/// Returns a mark at each crossing over two quantities, in the colour of its loop, and the least margins of all loops as words.
fn marks(
    lines: &[LocusLine],
    (x, y): (usize, usize),
    (gains, phases): (bool, bool),
) -> (Vec<Layer>, Vec<Note>) {
    let mut layers = Vec::new();
    let (mut least_gain, mut least_phase): (Option<LeastMargin>, Option<LeastMargin>) = (None, None);
    for line in lines {
        let mut points = Vec::new();
        for (point, factor) in line.phase_crossings().filter(|_| gains) {
            points.push((point[x], point[y]));
            let text =
                format!("{:+.1} dB at {} Hz", 20.0 * factor.log10(), number(point[0])).replace('-', "−");
            let margin = LeastMargin { size: factor.ln().abs(), point, text, colour: line.colour };
            least_gain = Some(LeastMargin::lesser(least_gain, margin));
        }
        for (point, phase) in line.gain_crossings().filter(|_| phases) {
            points.push((point[x], point[y]));
            let degrees = number(phase.abs() * 180.0 / PI);
            let text = format!("{degrees} deg at {} Hz", number(point[0]));
            let margin = LeastMargin { size: phase.abs(), point, text, colour: line.colour };
            least_phase = Some(LeastMargin::lesser(least_phase, margin));
        }
        layers.push(Layer::new("", line.colour, LayerShape::Disc, points));
    }
    let named = [least_gain, least_phase].into_iter().flatten();
    let notes = named.map(|margin| Note::new(margin.text, (margin.point[x], margin.point[y]), margin.colour));
    (layers, notes.collect())
}

/// Least margin of some loops, at a point of one of them.
struct LeastMargin {
    size: f64,
    point: [f64; 3],
    text: String,
    colour: RGBColor,
}

impl LeastMargin {
    fn lesser(before: Option<Self>, other: Self) -> Self {
        before.filter(|before| before.size <= other.size).unwrap_or(other)
    }
}

fn bode(title: &str, lines: &[LocusLine]) -> Figure {
    let x = FigureAxis::decades("frequency", "Hz", values(lines, 0));
    let panel = |quantity: usize, name: &str, unit: &'static str, marked: f64| {
        let (crossings, notes) = marks(lines, (0, quantity), (quantity == 1, quantity == 2));
        let y = FigureAxis::around(name, unit, values(lines, quantity).chain([marked]));
        let mut layers = vec![level(&x.range, marked)];
        layers.extend(lines.iter().map(|line| line.layer(0, quantity)));
        layers.extend(crossings);
        Panel::new(x.clone(), y, layers).noted(notes)
    };
    let panels = vec![panel(1, "magnitude", "dB", 0.0), panel(2, "phase", "deg", -180.0)];
    Figure { title: format!("{title}: loop transfer"), panels, panel_height: 220 }.named_once()
}

fn nichols(title: &str, lines: &[LocusLine], mask: Option<&NicholsMask>) -> Figure {
    // A mask is shown whole.
    let (gain, phase) = mask.map_or((0.0, 0.0), |mask| (mask.gain_db, mask.phase_deg));
    let x = FigureAxis::around("phase", "deg", values(lines, 2).chain([-180.0 - phase, -180.0 + phase]));
    let y = FigureAxis::around("magnitude", "dB", values(lines, 1).chain([-gain, gain]));
    // The points that the loop must not pass: -1 and its repetitions.
    let turns = (-40..40).map(|turn| f64::from(turn) * 360.0 - 180.0);
    let critical: Vec<Point> =
        turns.filter(|phase| x.range.contains(phase)).map(|phase| (phase, 0.0)).collect();
    let mut layers: Vec<Layer> = mask.map_or_else(Vec::new, |mask| mask.layers(&critical));
    layers.extend(lines.iter().map(|line| line.layer(2, 1)));
    let (crossings, notes) = marks(lines, (2, 1), (true, true));
    layers.extend(crossings);
    layers.push(Layer::new("-1", colour::BLACK, LayerShape::Ring, critical));
    Figure {
        title: format!("{title}: Nichols chart"),
        panels: vec![Panel::new(x, y, layers).noted(notes)],
        panel_height: 420,
    }
}

/// Returns a circle.
fn circle(centre: f64, radius: f64) -> Vec<Point> {
    let point = |k: u32| {
        let angle = TAU * f64::from(k) / 180.0;
        (centre + radius * angle.cos(), radius * angle.sin())
    };
    (0..=180).map(point).collect()
}

fn nyquist(title: &str, loops: &[SignalMargins]) -> Figure {
    let mut layers = vec![Layer::new("unit circle", colour::GREY, LayerShape::Dashes, circle(0.0, 1.0))];
    for (one, colour) in loops.iter().zip(COLOURS.iter().cycle()) {
        for locus in 0..one.loci.first().map_or(0, |first| first.values.len()) {
            let point = |sign: f64| {
                move |point: &flexsc_core::analysis::margins::LociValues| {
                    let value = point.values[locus];
                    let is_shown = value.re.hypot(value.im) <= 2.0 * SHOWN;
                    if is_shown { (value.re, sign * value.im) } else { (f64::NAN, f64::NAN) }
                }
            };
            let mut points: Vec<Point> = one.loci.iter().map(point(1.0)).collect();
            points.push((f64::NAN, f64::NAN));
            points.extend(one.loci.iter().map(point(-1.0)));
            let name = if locus == 0 { one.signal.replace('_', " ") } else { String::new() };
            layers.push(Layer::new(&name, *colour, LayerShape::Line(1.5), points));
        }
    }
    layers.push(Layer::new("-1", colour::BLACK, LayerShape::Ring, vec![(-1.0, 0.0)]));
    let x = FigureAxis::exact("real part", "", -ASPECT * SHOWN..ASPECT * SHOWN);
    let y = FigureAxis::exact("imaginary part", "", -SHOWN..SHOWN);
    Figure {
        title: format!("{title}: Nyquist"),
        panels: vec![Panel::new(x, y, layers).equal()],
        panel_height: 520,
    }
}

/// Returns the figure of the largest singular values of the sensitivity and of its complement.
pub fn singular_values(name: &str, margins: &StabilityMargins) -> Figure {
    let all = &margins.singular_values;
    let line = |of: fn(&SingularValues) -> f64| -> Vec<Point> {
        let decibels = |value: f64| if value > 0.0 { 20.0 * value.log10() } else { f64::NAN };
        let shown = all.iter().map(|at| (at.frequency_rad_s / TAU, decibels(of(at))));
        shown.map(|(x, y)| if y.abs() <= SHOWN_DB { (x, y) } else { (x, f64::NAN) }).collect()
    };
    let lines = [line(|at| at.sensitivity), line(|at| at.complementary)];
    // Where no sensitivity is shown, the loop gain is as large as its complement is flat.
    let shown = lines[0].iter().filter(|point| point.1.is_finite()).map(|point| point.0);
    let x = FigureAxis::decades("frequency", "Hz", shown);
    let y = FigureAxis::around(
        "largest singular value",
        "dB",
        lines.iter().flatten().map(|point| point.1).chain([0.0]),
    );
    let [sensitivity, complementary] = lines;
    let layers = vec![
        level(&x.range, 0.0),
        Layer::new("sensitivity S", colour::BLUE, LayerShape::Line(1.5), sensitivity),
        Layer::new("complementary sensitivity T", colour::VERMILLION, LayerShape::Line(1.5), complementary),
    ];
    Figure {
        title: format!("{name}: singular values of all loops"),
        panels: vec![Panel::new(x, y, layers)],
        panel_height: 320,
    }
}
