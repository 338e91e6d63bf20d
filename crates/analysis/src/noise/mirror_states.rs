//! Fine mirrors of lines of sight among the states of a loop: they follow the body, and do not act back on it.

use flexsc_numerics::attitude::Vector;
use nalgebra::{DMatrix, RowDVector};

use super::spectral_line::ComplexLine;
use crate::fine_mirror::{MirrorLoop, mirrors};
use crate::linear_model::Signal;
use crate::margins::frequency_response::modulus;
use crate::open_loop::LoopParts;
use flexsc_scenario::{FineMirror, LineSensitivity, Scenario};

/// Aliases of a line on either side, and the least of them that counts, relative to the line before the mirror.
const ALIASES: i32 = 8;
const LEAST: f64 = 1e-6;

/// Fine mirror whose states are among those of the body: about each of two axes the angle, its rate, the command, the means
/// that wait, the latest first, and the integral of the error.
#[derive(Clone, Debug)]
pub struct MirrorStates {
    /// Index of the line of sight.
    pub line: usize,
    pub mirror: FineMirror,
    /// Period (fs).
    pub period: i64,
    /// Axes across the line of sight.
    axes: [Vector; 2],
    /// First state.
    first: usize,
}

/// Place in the loop of a mirror at which an output is.
#[derive(Copy, Clone, Debug, PartialEq, Eq)]
pub enum MirrorTap {
    /// Error behind the mirror.
    Error,
    /// Angle of the mirror.
    Angle,
}

/// Output of a mirror's loop.
#[derive(Clone, Debug)]
pub struct MirrorOutput {
    within: MirrorLoop,
    tap: MirrorTap,
}

/// Returns how a line of sight turns about an axis, as a row over the states of a loop.
pub fn line_row(sensitivity: &LineSensitivity, about: &Vector, order: usize) -> RowDVector<f64> {
    let LineSensitivity { rigid, modes } = sensitivity;
    let mut row = RowDVector::zeros(order);
    row.columns_mut(0, 3).copy_from(&(about.transpose() * rigid));
    modes.iter().enumerate().for_each(|(mode, own)| row[6 + 2 * mode] = about.dot(own));
    row
}

/// Returns the parts of a loop with the mirrors of its lines of sight as further states of the body.
pub fn with_mirrors<'a>(parts: &LoopParts<'a>) -> LoopParts<'a> {
    let mut parts = parts.clone();
    let Some(body) = parts.scenario.model.three_axis() else { return parts };
    for (line, mirror) in mirrors(parts.scenario) {
        let sight = &parts.scenario.line_of_sight[line];
        let sensitivity = sight.sensitivity(body);
        let first = parts.body.a.nrows();
        let own = MirrorStates {
            line,
            mirror,
            period: mirror.period.leading_femtoseconds(),
            axes: sight.across(),
            first,
        };
        parts.body.resize(first + 2 * own.count());
        let a = &mut parts.body.a;
        let (frequency, damping) = (mirror.frequency.get(), mirror.damping.get());
        for (axis, about) in own.axes.iter().enumerate() {
            let [angle, rate, command, integral] = own.places(axis);
            a[(angle, rate)] = 1.0;
            (a[(rate, angle)], a[(rate, rate)]) = (-frequency * frequency, -2.0 * damping * frequency);
            a[(rate, command)] = frequency * frequency;
            let row = line_row(&sensitivity, about, first);
            a.view_mut((integral, 0), (1, first)).copy_from(&row);
            a[(integral, angle)] = -1.0;
        }
        parts.mirrors.push(own);
    }
    parts
}

impl MirrorStates {
    /// Returns the number of states about an axis.
    fn count(&self) -> usize {
        4 + self.mirror.computing_periods
    }

    /// Returns the places of the angle, its rate, the command and the integral about an axis among the states.
    fn places(&self, axis: usize) -> [usize; 4] {
        let first = self.first + axis * self.count();
        [first, first + 1, first + 2, first + self.count() - 1]
    }

    /// Returns the mirror's angle about an axis of the body, as a row over the states.
    pub fn angle_row(&self, about: &Vector, order: usize) -> RowDVector<f64> {
        let mut row = RowDVector::zeros(order);
        self.axes.iter().enumerate().for_each(|(axis, own)| row[self.places(axis)[0]] = own.dot(about));
        row
    }

    /// Ends an exposure: the command follows the mean that has waited, and the mean of the exposure, with a noise about each axis,
    /// begins to wait.
    pub fn end_exposure(&self, states: &mut DMatrix<f64>, noise: Option<&DMatrix<f64>>) {
        for axis in 0..2 {
            let [_, _, command, integral] = self.places(axis);
            let mut mean = states.row(integral) / self.mirror.period.seconds();
            if let Some(noise) = noise {
                mean += noise.row(axis);
            }
            states.row_mut(integral).fill(0.0);
            let waiting = command + 1..integral;
            let last =
                waiting.clone().last().map_or_else(|| mean.clone(), |last| states.row(last).into_owned());
            for place in waiting.clone().skip(1).rev() {
                let before = states.row(place - 1).into_owned();
                states.set_row(place, &before);
            }
            if let Some(latest) = waiting.into_iter().next() {
                states.set_row(latest, &mean);
            }
            let mut command = states.row_mut(command);
            command += last * self.mirror.gain.get();
        }
    }
}

impl MirrorOutput {
    /// Number of lines for each line before the mirror.
    pub const LINES: usize = 2 * ALIASES as usize + 1;

    /// Returns for each output of a loop the mirror behind which it is, if it is behind one.
    pub fn all(scenario: &Scenario, outputs: &[Signal]) -> Vec<Option<Self>> {
        let behind = |output: &Signal| {
            mirrors(scenario).find_map(|(line, mirror)| {
                let axis = |name: &str| {
                    let axis = output.name.strip_prefix(&format!("{name}{line}_"))?;
                    (!axis.contains('_')).then_some(())
                };
                let is_error = axis("line_of_sight").map(|()| MirrorTap::Error);
                let tap = is_error.or(axis("mirror").map(|()| MirrorTap::Angle))?;
                Some(Self { within: MirrorLoop::new(mirror), tap })
            })
        };
        outputs.iter().map(behind).collect()
    }

    /// Returns the lines of the output, with frequencies (rad/s) and complex amplitudes, for those of the line of sight before the
    /// mirror under each of some loads of one frequency. The last line is that of the last one at its own frequency.
    pub fn lines(&self, before: &[Vec<ComplexLine>]) -> Vec<Vec<ComplexLine>> {
        let shares = before.first().map_or_else(Vec::new, |first| self.shares(first));
        before.iter().map(|own| behind(&shares, own)).collect()
    }

    /// Returns the lines that a unit of each line before the mirror makes.
    fn shares(&self, before: &[ComplexLine]) -> Vec<Vec<ComplexLine>> {
        let of_line = |(frequency, _): &ComplexLine| {
            let answer = self.within.answer(*frequency);
            let share = |k: i32| match self.tap {
                MirrorTap::Error => (answer.alias(k), answer.error(k)),
                MirrorTap::Angle => (answer.alias(k), answer.mirror(k)),
            };
            (-ALIASES..=ALIASES).filter(|k| *k != 0).chain([0]).map(share).collect()
        };
        before.iter().map(of_line).collect()
    }
}

/// Returns lines behind a mirror, for those before it and what a unit of each makes, the last at its own frequency.
fn behind(shares: &[Vec<ComplexLine>], before: &[ComplexLine]) -> Vec<ComplexLine> {
    let largest = before.iter().map(|(_, amplitude)| modulus(*amplitude)).fold(0.0, f64::max);
    let made = |(own, (_, amplitude)): (&Vec<ComplexLine>, &ComplexLine)| {
        own.iter().map(|(at, share)| (*at, amplitude * share)).collect::<Vec<ComplexLine>>()
    };
    let mut all: Vec<ComplexLine> = shares.iter().zip(before).flat_map(made).collect();
    let Some(direct) = all.pop() else { return all };
    all.retain(|(_, amplitude)| modulus(*amplitude) > LEAST * largest);
    all.push(direct);
    all.sort_by(|a, b| a.0.total_cmp(&b.0));
    // Lines of one frequency add up with their phases.
    let is_same = |one: f64, other: f64| (one - other).abs() < 1e-9 * (1.0 + one.abs());
    all.dedup_by(|later, kept| {
        let is_same = is_same(later.0, kept.0);
        if is_same {
            kept.1 += later.1;
        }
        is_same
    });
    if let Some(place) = all.iter().position(|(at, _)| is_same(*at, direct.0)) {
        let own = all.remove(place);
        all.push(own);
    }
    all
}
