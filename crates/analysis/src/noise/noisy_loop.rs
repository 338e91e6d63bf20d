//! Closed loop of a scenario under its noise, with the stationary covariance of its states.

use std::fmt;

use flexsc_formats::document::ConfigError;
use nalgebra::{Complex, DMatrix};

use super::covariance::DoublingSeries;
use super::mirror_states::with_mirrors;
use super::motion::Motion;
use super::output::{is_line_about_axis, outputs};
use super::period_rows::PeriodRows;
use super::source::sources;
use crate::eigenvalues::eigenvalues;
use crate::fine_mirror::{MirrorLoop, mirrors};
use crate::linear_model::Signal;
use crate::margins::UnstableLoop;
use crate::margins::poles::require_stable;
use crate::open_loop::attitude_rows::seconds;
use crate::open_loop::{LoopBreak, LoopParts, OpenLoop};
use flexsc_scenario::Scenario;

/// Closed loop under noise. It repeats after a period, in which the law has one or several samples.
///
/// With the states s at the start of a period and the draws v of the period, all of variance 1, the next states are
/// a s + g v, and each output at each time of the period is a row over s and v.
#[derive(Clone, Debug)]
pub struct NoisyLoop {
    /// Outputs.
    pub outputs: Vec<Signal>,
    /// Sources of noise: the keys of the scenario that give them.
    pub sources: Vec<String>,
    /// Period after which the loop repeats (s).
    pub period: f64,
    /// Samples of the law in a period.
    pub samples: usize,
    /// Largest magnitude of a pole of the closed loop.
    pub spectral_radius: f64,
    /// Transition of the states that noise reaches, over a period.
    pub(super) a: DMatrix<f64>,
    /// Response of the states to the draws of a period.
    pub(super) g: DMatrix<f64>,
    /// Index of the source of each draw.
    pub(super) drawn_by: Vec<usize>,
    /// Motion over a period.
    pub(super) motion: Motion,
    /// Time between samples of the law (fs).
    pub(super) step: i64,
    /// Natural frequencies of the body (rad/s).
    pub(super) frequencies: Vec<f64>,
    /// Covariance of the states at the start of a period, of each source.
    pub(super) covariances: Vec<DMatrix<f64>>,
}

/// Reason why a loop has no stationary noise.
#[derive(Clone, Debug, PartialEq)]
pub enum NoiseError {
    /// Part of the scenario that has no linear model.
    Key(ConfigError),
    /// Loop that is not stable.
    Unstable(UnstableLoop),
    /// Source of noise whose variance grows without limit.
    Unsettled(String),
    /// Request that cannot be met: a text that begins with the name of the argument.
    Request(String),
}

impl fmt::Display for NoiseError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Key(fault) => write!(f, "{fault}"),
            Self::Request(why) => f.write_str(why),
            Self::Unstable(unstable) => f.write_str(&unstable.reason("spectrum")),
            Self::Unsettled(key) => write!(
                f,
                "the noise of `{key}` drives a motion that the loop does not damp: its variance grows without limit"
            ),
        }
    }
}

impl std::error::Error for NoiseError {}

impl NoiseError {
    /// Returns the fault of wheels without a largest speed.
    pub(super) fn without_speed() -> Self {
        Self::Request("speeds must be given: the scenario gives no largest speed of its wheels".to_owned())
    }
}

impl From<ConfigError> for NoiseError {
    fn from(fault: ConfigError) -> Self {
        Self::Key(fault)
    }
}

impl NoisyLoop {
    /// Returns the closed loop of a scenario under its noise, about the target at rest, with natural frequencies as they
    /// are at the start. Limits are left out, and disturbances act at all times.
    ///
    /// # Errors
    /// A part that has no linear model, a loop that is not stable, and noise whose variance grows without limit.
    pub fn from_scenario(scenario: &Scenario) -> Result<Self, NoiseError> {
        Self::from_parts(&LoopParts::from_scenario(scenario, LoopBreak::Command)?)
    }

    /// Returns the closed loop of these parts, which are cut open at the command, under its noise.
    ///
    /// # Errors
    /// See [`Self::from_scenario`].
    pub(crate) fn from_parts(parts: &LoopParts<'_>) -> Result<Self, NoiseError> {
        let spectral_radius = stable_loops(parts)?;
        let parts = &with_mirrors(parts);
        let sources = sources(parts)?;
        let PeriodRows { a, g, pieces, period, step, drawn_by, .. } = PeriodRows::new(parts, &sources)?;
        let (outputs, rows) = outputs(parts);
        let motion = Motion::new((&parts.body.a, &parts.body.b), pieces, rows);
        let series = DoublingSeries::new(&a);
        let covariance = |index: usize| {
            let own: Vec<usize> = (0..drawn_by.len()).filter(|draw| drawn_by[*draw] == index).collect();
            let g = g.select_columns(&own);
            let unsettled = || NoiseError::Unsettled(sources[index].key.clone());
            series.solve(&(&g * g.transpose())).ok_or_else(unsettled)
        };
        let covariances = (0..sources.len()).map(covariance).collect::<Result<_, _>>()?;
        let poles = eigenvalues(&parts.body.a).unwrap_or_default();
        Ok(Self {
            outputs,
            sources: sources.into_iter().map(|source| source.key).collect(),
            period: seconds(period),
            samples: usize::try_from(period / step).unwrap_or(1),
            spectral_radius,
            a,
            g,
            drawn_by,
            motion,
            step,
            frequencies: poles.iter().map(|pole| pole.im.abs()).collect(),
            covariances,
        })
    }

    /// Returns the index of an output; `None` for a name that no output has.
    pub fn output(&self, name: &str) -> Option<usize> {
        self.outputs.iter().position(|output| output.name == name)
    }

    /// Returns the length of the period (fs).
    pub(crate) fn period_ticks(&self) -> i64 {
        self.step * self.samples as i64
    }

    /// Returns the number of states and of draws in a period.
    pub(crate) fn size(&self) -> usize {
        self.a.nrows() + self.drawn_by.len()
    }

    /// Returns the indices of the outputs that a user looks at first: measured angles, and lines of sight.
    pub fn first_outputs(&self) -> Vec<usize> {
        self.named_or_sights(&["angle", "roll", "pitch", "yaw"])
    }

    /// Returns the indices of the outputs that a user compares with a log first: the angle or the pointing error about
    /// each axis, and lines of sight.
    pub fn compared_outputs(&self) -> Vec<usize> {
        self.named_or_sights(&["angle", "roll_error", "pitch_error", "yaw_error"])
    }

    fn named_or_sights(&self, names: &[&str]) -> Vec<usize> {
        let is_chosen =
            |signal: &Signal| names.contains(&signal.name.as_str()) || is_line_about_axis(&signal.name);
        (0..self.outputs.len()).filter(|index| is_chosen(&self.outputs[*index])).collect()
    }

    /// Returns the time between samples of the law (s).
    pub fn sample_period(&self) -> f64 {
        seconds(self.step)
    }

    /// Returns the variance of an output at a time of the period (s) from each source, right-continuous.
    pub fn variance_at(&self, output: usize, time: f64) -> Vec<f64> {
        self.variances(&self.motion.rows_at(&[output], time)).remove(0)
    }

    /// Returns the mean variances of outputs over the samples of the law, from each source.
    pub fn sample_variances(&self, outputs: &[usize]) -> Vec<Vec<f64>> {
        let mut sums = vec![vec![0.0; self.sources.len()]; outputs.len()];
        for sample in 0..self.samples {
            let rows = self.motion.rows_at_ticks(outputs, self.step * sample as i64);
            self.add_variances(&mut sums, &rows, 1.0 / self.samples as f64);
        }
        sums
    }

    /// Returns the mean variances of outputs over time, from each source.
    pub fn mean_variances(&self, outputs: &[usize]) -> Vec<Vec<f64>> {
        let mut sums = vec![vec![0.0; self.sources.len()]; outputs.len()];
        self.motion.integrate(outputs, [0.0, self.period], 0.0, |_, weight, rows| {
            self.add_variances(&mut sums, rows, weight / self.period);
        });
        sums
    }

    /// Returns the autocovariance of an output at its samples: over 0, 1, .. `lags` samples of the law, the mean over the
    /// period.
    pub fn autocovariance(&self, output: usize, lags: usize) -> Vec<f64> {
        let (count, order) = (self.samples, self.a.nrows());
        let covariance: DMatrix<f64> =
            self.covariances.iter().fold(DMatrix::zeros(order, order), |sum, own| sum + own);
        let at = |sample: usize| self.motion.rows_at_ticks(&[output], self.step * sample as i64);
        let rows: Vec<DMatrix<f64>> = (0..count).map(at).collect();
        let mut found = vec![0.0; lags + 1];
        for first in 0..count {
            let (state, drawn) = rows[first].columns_range_pair(..order, order..);
            // Covariance of the output with the states at the start of its period, and with those that follow.
            let mut with = state * &covariance;
            let mut period = 0;
            for (lag, value) in found.iter_mut().enumerate() {
                let (ahead, sample) = ((first + lag) / count, (first + lag) % count);
                let (later, later_drawn) = rows[sample].columns_range_pair(..order, order..);
                while period < ahead {
                    with = if period == 0 {
                        &with * self.a.transpose() + drawn * self.g.transpose()
                    } else {
                        &with * self.a.transpose()
                    };
                    period += 1;
                }
                let mut product = (&with * later.transpose())[(0, 0)];
                if ahead == 0 {
                    product += (drawn * later_drawn.transpose())[(0, 0)];
                }
                *value += product / count as f64;
            }
        }
        found
    }

    /// Returns the variance of each row over the states and the draws, from each source.
    pub(super) fn variances(&self, rows: &DMatrix<f64>) -> Vec<Vec<f64>> {
        let mut sums = vec![vec![0.0; self.sources.len()]; rows.nrows()];
        self.add_variances(&mut sums, rows, 1.0);
        sums
    }

    fn add_variances(&self, sums: &mut [Vec<f64>], rows: &DMatrix<f64>, weight: f64) {
        let (state, drawn) = rows.columns_range_pair(..self.a.nrows(), self.a.nrows()..);
        for (source, covariance) in self.covariances.iter().enumerate() {
            let with = state * covariance;
            for (row, sum) in sums.iter_mut().enumerate() {
                sum[source] += weight * with.row(row).dot(&state.row(row));
            }
        }
        for (draw, source) in self.drawn_by.iter().enumerate() {
            for (row, sum) in sums.iter_mut().enumerate() {
                sum[*source] += weight * drawn[(row, draw)] * drawn[(row, draw)];
            }
        }
    }

    /// Returns the poles of the closed loop over a sample of the law: of those that a pole over the whole period may
    /// stand for, the one next to a natural frequency of the body.
    pub(super) fn sample_poles(&self) -> Vec<Complex<f64>> {
        let poles = eigenvalues(&self.a).unwrap_or_default();
        if self.samples == 1 {
            return poles;
        }
        let (turn, count) = (std::f64::consts::TAU, self.samples as f64);
        let folded = |angle: f64| (angle - turn * libm::round(angle / turn)).abs();
        let known: Vec<f64> =
            self.frequencies.iter().map(|frequency| folded(frequency * seconds(self.step))).collect();
        let pole = |pole: Complex<f64>| {
            let angle = libm::atan2(pole.im, pole.re);
            let candidate = |k: usize| (angle + turn * k as f64) / count;
            let distance = |angle: f64| {
                known.iter().map(|known| (folded(angle) - known).abs()).fold(folded(angle), f64::min)
            };
            let nearest = (0..self.samples)
                .map(candidate)
                .min_by(|a, b| distance(*a).total_cmp(&distance(*b)))
                .unwrap_or(angle);
            let size = libm::pow(libm::hypot(pole.re, pole.im), 1.0 / count);
            [Complex::new(size * libm::cos(nearest), size * libm::sin(nearest).abs())]
        };
        poles.into_iter().flat_map(pole).collect()
    }
}

/// Returns the spectral radius of the closed loop of a law; the loops of fine mirrors must be stable, too.
pub(super) fn stable_loops(parts: &LoopParts<'_>) -> Result<f64, NoiseError> {
    let radius = stable_radius(&OpenLoop::from_parts(parts)?)?;
    for (line, mirror) in mirrors(parts.scenario) {
        stable_radius(&MirrorLoop::new(mirror).open_loop(line))?;
    }
    Ok(radius)
}

/// Returns the spectral radius of a loop when it is closed.
fn stable_radius(opened: &OpenLoop) -> Result<f64, NoiseError> {
    let first = opened.signals.first().map_or("", |signal| &signal.name);
    let failed = || NoiseError::Unstable(UnstableLoop::with_unknown_poles(first));
    let closed = opened.transfer.sensitivity().ok_or_else(failed)?;
    let poles = eigenvalues(&closed.a).ok_or_else(failed)?;
    require_stable(opened, &closed.a, &poles).map_err(NoiseError::Unstable)
}
