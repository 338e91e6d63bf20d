//! Figure of the lines of unbalanced wheels over their speed: above what they do to an output, in the unit of its limit, below
//! where they lie, with the modes that they meet.

use std::f64::consts::{PI, TAU};

use flexsc_core::analysis::noise::{NoiseReport, OutputNoise, SpectralLine, WheelSpectrum};
use flexsc_core::formats::reader_units::{ReaderUnit, ReaderUnits, number, time_span};
use flexsc_figure::palette::viridis;
use flexsc_figure::{
    Bar, Figure, FigureAxis, Layer, LayerShape, Named, Note, NoteSide, Panel, Point, colour, name_and_unit,
    power_text,
};

use super::named_mode::{NamedMode, ShownModes};
use super::required_index::RequiredIndex;

/// Decades of amplitudes that have colours, and colours of each.
const DECADES: usize = 4;
const PER_DECADE: usize = 2;
/// Lowest frequency shown, relative to the lowest of the modes and of the lines at the frequency of the wheels.
const LOWEST: f64 = 0.1;
/// Distance from a mode, relative to its frequency, at which its lines lie, and that of those beside it.
const NEAR: f64 = 0.015;
const BESIDE: [f64; 2] = [0.05, 0.3];
/// Rise of the lines of a mode above those beside it that makes it one of the modes that are met.
const RISE: f64 = 1.5;
/// Ratio of frequencies of modes of one name that share a label, and that of those that are named once.
const TOGETHER: f64 = 2.5;
const EQUAL: f64 = 1.02;

/// Lines of one output over the speed of the wheels.
pub struct OutputWaterfall<'a> {
    pub wheels: &'a WheelSpectrum,
    pub output: &'a OutputNoise,
    /// Place of the output among those of the spectrum.
    pub index: usize,
    pub required: Option<&'a RequiredIndex>,
    /// Window of the indices (s), if one was asked for: it replaces that of the requirement.
    pub window_s: Option<f64>,
}

/// Returns a figure for each output of a report.
pub fn figures(
    name: &str,
    report: &NoiseReport,
    (required, window_s): (&[Option<RequiredIndex>], Option<f64>),
    modes: &ShownModes,
) -> Vec<Named> {
    let all = OutputWaterfall::all(report, required, window_s).into_iter();
    all.map(|one| (format!("{name}-waterfall_{}", one.output.output), one.figure(name, modes))).collect()
}

impl<'a> OutputWaterfall<'a> {
    /// Returns the lines of each output of a report; none without wheels that are unbalanced.
    pub fn all(
        report: &'a NoiseReport,
        required: &'a [Option<RequiredIndex>],
        window_s: Option<f64>,
    ) -> Vec<Self> {
        let Some(wheels) = &report.wheels else { return Vec::new() };
        let each = report.outputs.iter().zip(required).enumerate();
        each.map(|(index, (output, own))| Self { wheels, output, index, required: own.as_ref(), window_s })
            .collect()
    }

    /// Returns the length of the windows (s), if there are any.
    pub fn window(&self) -> Option<f64> {
        self.window_s.or_else(|| self.required.and_then(|own| own.window_s))
    }

    /// Returns the rms of all frequencies over the speed.
    pub fn rms(&self) -> &'a [f64] {
        &self.wheels.rms[self.index]
    }

    /// Returns the rms within the windows over the speed, if there are any.
    pub fn rms_within_window(&self) -> Option<Vec<f64>> {
        let window = self.window()?;
        let lines = |place: usize| self.lines_at(place).flat_map(|(_, lines)| lines);
        let count = self.wheels.speed_rad_s.len();
        Some((0..count).map(|place| RequiredIndex::rms_within(self.required, lines(place), window)).collect())
    }

    /// Returns the lines at a speed, those of each harmonic of each wheel with its order.
    fn lines_at(
        &self,
        place: usize,
    ) -> impl Iterator<Item = (f64, impl Iterator<Item = &'a SpectralLine> + use<'a>)> {
        let (wheels, index) = (self.wheels, self.index);
        let each = wheels.lines.len() / wheels.speed_rad_s.len().max(1);
        wheels.lines[place * each..(place + 1) * each]
            .iter()
            .map(move |own| (own.order, own.outputs[index].all()))
    }

    /// Returns the lines at each speed (Hz, amplitude): equal ones of several wheels, whose phases are unrelated, are one.
    fn points(&self) -> Vec<(f64, Vec<(f64, f64)>)> {
        let at = |place: usize| {
            let lines = self.lines_at(place).flat_map(|(_, lines)| lines);
            let mut all: Vec<(f64, f64)> =
                lines.map(|line| (line.frequency_rad_s / TAU, line.amplitude * line.amplitude)).collect();
            all.sort_by(|a, b| a.0.total_cmp(&b.0));
            all.dedup_by(|next, kept| {
                let is_one = next.0 - kept.0 <= 1e-9 * kept.0;
                if is_one {
                    kept.1 += next.1;
                }
                is_one
            });
            all.into_iter().map(|(frequency, square)| (frequency, square.sqrt())).collect()
        };
        self.wheels.speed_rad_s.iter().enumerate().map(|(place, speed)| (*speed, at(place))).collect()
    }

    /// Returns the unit in which the output is shown: that of its limit, else one that fits its largest value.
    pub fn unit(&self) -> ReaderUnit {
        let largest = self.rms().iter().copied().fold(0.0, f64::max);
        let fitting = || ReaderUnits::Engineering.fitting(largest, &self.output.unit);
        self.required.map_or_else(fitting, |own| own.required.unit.clone())
    }

    fn figure(&self, name: &str, modes: &ShownModes) -> Figure {
        let lines = self.points();
        let panels = [Some(self.effect()), self.contrast(), Some(self.places(&lines, modes))];
        let name = format!("{name}: lines of the wheels in {}", self.output.output);
        Figure { title: name, panels: panels.into_iter().flatten().collect(), panel_height: 260 }
    }

    fn speed(&self) -> FigureAxis {
        let largest = self.wheels.speed_rad_s.iter().copied().fold(0.0, f64::max);
        FigureAxis::exact("wheel speed", "rad/s", 0.0..largest).in_rpm()
    }

    /// Returns the panel of the rms over the speed, of all frequencies and within the windows.
    fn effect(&self) -> Panel {
        let (speeds, rms, within) = (&self.wheels.speed_rad_s, self.rms(), self.rms_within_window());
        let line =
            |values: &[f64]| -> Vec<Point> { speeds.iter().copied().zip(values.iter().copied()).collect() };
        let mut layers =
            vec![Layer::new("all frequencies, rms", colour::GREY, LayerShape::Line(1.2), line(rms))];
        let mut values = rms.to_vec();
        let (label, unit) = name_and_unit(&readable(&self.output.output), &self.output.unit);
        let mut notes = Vec::new();
        if let (Some(within), Some(window)) = (&within, self.window()) {
            let name = format!("within windows of {}, rms", time_span(window));
            layers.push(Layer::new(&name, colour::BLUE, LayerShape::Line(1.6), line(within)));
            values.extend(within);
            notes.extend(self.largest(within, colour::BLUE));
        }
        notes.extend(self.largest(rms, colour::GREY));
        values.extend(self.required.map(|own| own.required.limit));
        // The names of the peaks are above them.
        values.push(2.0 * rms.iter().copied().fold(0.0, f64::max));
        let x = self.speed();
        if let Some(RequiredIndex { name, required, .. }) = self.required {
            let line = required.across(&x);
            layers.push(Layer { name: String::new(), ..line });
            let text = format!("{name}: {}", required.words());
            notes.push(Note::new(text, (x.range.end, required.limit), colour::RED));
        }
        let y = FigureAxis::decades(&label, unit, values).in_unit(self.unit());
        Panel::new(x.unnamed(), y, layers).noted(notes)
    }

    /// Returns the panel of the contrast of an image over the speed, if a pixel was given.
    fn contrast(&self) -> Option<Panel> {
        let mtf = self.wheels.mtf.get(self.index).filter(|mtf| !mtf.is_empty())?;
        let points: Vec<Point> = self.wheels.speed_rad_s.iter().copied().zip(mtf.iter().copied()).collect();
        let (speed, least) = points.iter().copied().min_by(|a, b| a.1.total_cmp(&b.1))?;
        let text = format!("{least:.4} at {:.0} rpm", speed * 30.0 / PI);
        let note = Note::new(text, (speed, least), colour::BLUE).on(NoteSide::Below);
        // Room for the note below.
        let low = (least - 0.25 * (1.0 - least)).min(0.9);
        let y = FigureAxis::exact("contrast (MTF)", "", low..1.0);
        let line = Layer::new("", colour::BLUE, LayerShape::Line(1.6), points);
        Some(Panel::new(self.speed().unnamed(), y, vec![line]).noted(vec![note]))
    }

    /// Returns a note at the largest of some values over the speed.
    fn largest(&self, values: &[f64], colour: flexsc_figure::RGBColor) -> Option<Note> {
        let all = self.wheels.speed_rad_s.iter().zip(values);
        let (speed, value) = all.max_by(|a, b| a.1.total_cmp(b.1)).filter(|(_, value)| **value > 0.0)?;
        let text = format!("{} at {:.0} rpm", self.unit().quantity(*value), speed * 30.0 / PI);
        Some(Note::new(text, (*speed, *value), colour))
    }

    /// Returns the panel of the frequencies of the lines over the speed, coloured by their amplitude.
    fn places(&self, lines: &[(f64, Vec<(f64, f64)>)], modes: &ShownModes) -> Panel {
        let all = || lines.iter().flat_map(|(speed, own)| own.iter().map(move |line| (*speed, *line)));
        let orders = |place: usize| self.lines_at(place).map(|(order, _)| order);
        let excited = excited_modes(&all().map(|(_, line)| line).collect::<Vec<_>>(), &modes.named);
        let slowest = self.wheels.speed_rad_s.first().copied().unwrap_or(1.0);
        let direct = orders(0).fold(f64::INFINITY, f64::min) * slowest / TAU;
        let lowest = excited.iter().map(|mode| mode.frequency_rad_s / TAU).fold(direct, f64::min);
        let fastest = orders(0).fold(f64::INFINITY, f64::min) * self.speed().range.end / TAU;
        let highest = all().map(|(_, line)| line.0).fold(0.0, f64::max);
        let frequency = FigureAxis::decades("frequency", "Hz", [LOWEST * lowest, highest]);
        let largest = all().map(|(_, line)| line.1).fold(0.0, f64::max);
        let unit = self.unit();
        let top = unit.value(largest).log10().ceil();
        let colours = viridis(DECADES * PER_DECADE);
        let layer = |class: usize| {
            let edge = |class: usize| top - DECADES as f64 + class as f64 / PER_DECADE as f64;
            let (low, high) = (10_f64.powf(edge(class)), 10_f64.powf(edge(class + 1)));
            let is_own = |value: f64| (value >= low || class == 0) && value < high;
            let own = all().filter(|(_, line)| line.1 > 0.0 && is_own(unit.value(line.1)));
            // Frequencies below the axis lie on its lower end.
            let points = own.map(|(speed, line)| (speed, line.0.max(frequency.range.start))).collect();
            Layer::new("", colours[colours.len() - 1 - class], LayerShape::Dot, points)
        };
        let x = self.speed();
        let is_shown = |point: &Point| frequency.range.contains(&point.1);
        let whirl = modes.whirling.iter().map(|curve| {
            let shown = curve.iter().copied().filter(is_shown).collect();
            Layer::new("", colour::GREEN, LayerShape::Line(1.0), shown)
        });
        let mut layers: Vec<Layer> = whirl.collect();
        let mut notes = Vec::new();
        for (name, mut hertz) in labels(&excited) {
            for height in &hertz {
                let ends = vec![(0.0, *height), (x.range.end, *height)];
                layers.push(Layer::new("", colour::GREEN, LayerShape::Dashes, ends));
            }
            let first = hertz.first().copied().unwrap_or_default();
            let last = hertz.pop().unwrap_or_default();
            let before: Vec<String> = hertz.iter().map(|height| number(*height)).collect();
            let and = if before.is_empty() { String::new() } else { format!("{} and ", before.join(", ")) };
            let text = format!("{name}, {and}{} Hz", number(last));
            // The lines at the frequency of the wheels end at the upper right.
            if last < 0.4 * fastest {
                notes.push(Note::new(text, (x.range.end, first), colour::GREEN).on(NoteSide::Below));
            } else {
                notes.push(Note::new(text, (0.0, last), colour::GREEN));
            }
        }
        let mut named: Vec<f64> = orders(0).collect();
        named.dedup();
        for order in &named {
            let ends = [slowest, x.range.end].map(|speed| (speed, order * speed / TAU));
            // A straight line is a curve over a logarithm.
            let along = |part: u32| {
                let part = f64::from(part) / 100.0;
                (ends[0].0 + part * (ends[1].0 - ends[0].0), ends[0].1 + part * (ends[1].1 - ends[0].1))
            };
            let line = (0..=100).map(along).collect();
            layers.push(Layer::new("", colour::GREY, LayerShape::Line(0.7), line));
        }
        if largest > 0.0 {
            layers.extend((0..DECADES * PER_DECADE).map(layer));
        }
        for order in named.into_iter().take(3) {
            let speed = 0.75 * x.range.end;
            let text = if order == 1.0 { "once per turn".to_owned() } else { format!("{order} per turn") };
            notes.push(Note::new(text, (speed, order * speed / TAU), colour::BLACK).on(NoteSide::Below));
        }
        if self.wheels.lines.iter().any(|own| !own.outputs[self.index].aliases.is_empty()) {
            let height = frequency.range.start * 1.0001;
            let note = Note::new("aliases", (0.5 * x.range.end, height), colour::BLACK);
            notes.push(note);
        }
        let edge = |class: usize| {
            let power = top - DECADES as f64 + (class / PER_DECADE) as f64;
            if class.is_multiple_of(PER_DECADE) { power_text(power as i32) } else { String::new() }
        };
        let bar = Bar {
            name: format!(
                "amplitude ({})",
                if unit.name.is_empty() { &self.output.unit } else { &*unit.name }
            ),
            colours: colours.iter().rev().copied().collect(),
            edges: (1..DECADES * PER_DECADE).map(edge).collect(),
        };
        Panel { bar: Some(bar), ..Panel::new(x, frequency, layers).noted(notes) }
    }
}

/// Returns the name of an output in words: `line_of_sight0_x` as "line of sight, x".
fn readable(output: &str) -> String {
    let digits = |text: &str| text.trim_start_matches(|c: char| c.is_ascii_digit()).to_owned();
    match output.strip_prefix("line_of_sight") {
        Some(rest) => format!("line of sight{}", digits(rest).replacen('_', ", ", 1)),
        None => output.replace('_', " "),
    }
}

/// Returns the modes that lines (Hz, amplitude) excite: at whose frequencies these are larger than beside them.
fn excited_modes<'a>(lines: &[(f64, f64)], modes: &'a [NamedMode]) -> Vec<&'a NamedMode> {
    let is_excited = |mode: &&NamedMode| {
        let off = |line: &&(f64, f64)| (TAU * line.0 / mode.frequency_rad_s - 1.0).abs();
        let largest = |range: std::ops::Range<f64>| {
            let own = lines.iter().filter(|line| range.contains(&off(line)));
            own.map(|line| line.1).fold(0.0, f64::max)
        };
        largest(0.0..NEAR) > RISE * largest(BESIDE[0]..BESIDE[1])
    };
    modes.iter().filter(is_excited).collect()
}

/// Returns the labels of modes: a name, and the frequencies (Hz) that it stands for.
fn labels(modes: &[&NamedMode]) -> Vec<(String, Vec<f64>)> {
    let mut labels: Vec<(String, Vec<f64>)> = Vec::new();
    for mode in modes {
        let hertz = mode.frequency_rad_s / TAU;
        match labels.last_mut() {
            Some((name, own))
                if *name == mode.name && own.last().is_some_and(|last| hertz < TOGETHER * last) =>
            {
                if own.last().is_some_and(|last| hertz > EQUAL * last) {
                    own.push(hertz);
                }
            }
            _ => labels.push((mode.name.clone(), vec![hertz])),
        }
    }
    labels
}
