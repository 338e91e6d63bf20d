//! Delay that all commands of a loop tolerate together.
//!
//! A pole reaches the unit circle where an eigenvalue of the loop transfer L is -1. Without the delay, an eigenvalue of magnitude
//! 1 at the frequency w tolerates its lag divided by w. A delay that is no multiple of the period changes L by a little more than
//! a phase, so Newton's steps in w and in the delay follow, each with the transfer of that delay. Whole periods of it are a
//! power of z: the size of the problem does not grow with the delay.

use std::f64::consts::TAU;

use flexsc_formats::document::ConfigError;
use nalgebra::Complex;

use super::crossings::{Crossings, SampledTransfer};
use super::frequency_grid::coarse_frequency_grid;
use super::frequency_response::{FrequencyResponse, modulus, unit_circle};
use super::loci::loci;
use super::poles::is_stable;
use crate::eigenvalues::{complex_eigenvalues, eigenvalues};
use crate::open_loop::{LoopParts, OpenLoop};

/// Largest number of Newton's steps.
const STEPS: usize = 30;
/// Steps of the differences: relative to the frequency, and of the delay relative to the period of the law.
const DIFFERENCES: [f64; 2] = [1e-6, 1e-5];
/// Last change of the delay, relative to it, at which the steps have converged.
const CONVERGED: f64 = 1e-10;
/// Parts of the delay at which the poles confirm that the loop is stable.
const CONFIRMED: [f64; 8] = [0.125, 0.25, 0.375, 0.5, 0.625, 0.75, 0.875, 0.999];
/// Largest number of states of a loop whose poles are computed for that: with more, the period is short beside the delay, and the
/// delay is a phase.
const MOST_STATES: usize = 150;
/// Number of halvings between a delay that the loop tolerates and one that it does not.
const HALVINGS: usize = 40;

/// Loop whose commands act later.
struct LateLoop<'a> {
    parts: &'a LoopParts<'a>,
    /// Period after which the loop repeats (s).
    period: f64,
}

/// Loop transfer with a delay of whole periods and a rest.
struct LateTransfer {
    /// Response with the rest.
    response: FrequencyResponse,
    /// Delay of whole periods (s).
    whole: f64,
    /// Period (s).
    period: f64,
}

/// Delay at which a pole is on the unit circle.
#[derive(Copy, Clone, Debug)]
struct DelayLimit {
    /// Frequency of the pole (rad/s).
    frequency: f64,
    /// Delay (s).
    delay: f64,
}

/// Returns the smallest additional delay (s) of all commands together that makes a stable loop unstable, which is cut open at its
/// commands; none if there is none.
///
/// # Errors
/// See [`OpenLoop::from_scenario`].
pub fn common_delay(parts: &LoopParts<'_>) -> Result<Option<f64>, ConfigError> {
    let opened = OpenLoop::from_parts(parts)?;
    let late = LateLoop { parts, period: opened.period };
    let mut least: Option<f64> = None;
    for start in limits_by_phase(&opened) {
        let is_nearer = |delay: &f64| least.is_none_or(|least| *delay < least);
        // A limit by the phase alone is off by a part of a period.
        if is_nearer(&(start.delay - late.period)) {
            // Without convergence the phase remains, which is that of the loop for one sample in a period.
            let limit = late.newton(start)?.or((opened.samples == 1).then_some(start));
            least = limit.map(|limit| limit.delay).filter(is_nearer).or(least);
        }
    }
    let earlier = late.earlier_limit(&opened, least.unwrap_or(opened.period))?;
    Ok(earlier.or(least))
}

/// Returns the limits that eigenvalues of magnitude 1 have if a delay is a phase, the least delay first.
fn limits_by_phase(opened: &OpenLoop) -> Vec<DelayLimit> {
    let closed = opened.transfer.sensitivity().and_then(|closed| eigenvalues(&closed.a));
    let (Some(closed), Some(others)) = (closed, eigenvalues(&opened.transfer.a)) else { return Vec::new() };
    let response = FrequencyResponse::new(&opened.transfer);
    let angles = coarse_frequency_grid(&closed, &others);
    let transfers = angles.iter().filter_map(|angle| Some((*angle, response.scan(unit_circle(*angle))?)));
    let all = loci(transfers);
    let transfer = SampledTransfer { response: &response, period: opened.period, samples: opened.samples };
    let crossings = Crossings::find(&transfer, &all).gain.into_iter();
    let limit = |frequency: f64, phase: f64| DelayLimit {
        frequency,
        delay: if phase < 0.0 { phase + TAU } else { phase } / frequency,
    };
    let mut limits: Vec<DelayLimit> =
        crossings.map(|crossing| limit(crossing.frequency_rad_s, crossing.phase_rad)).collect();
    limits.sort_by(|a, b| a.delay.total_cmp(&b.delay));
    limits
}

impl LateLoop<'_> {
    /// Returns the loop, cut open, with commands that act later by a delay (s).
    fn opened(&self, delay: f64) -> Result<OpenLoop, ConfigError> {
        let mut late = self.parts.clone();
        late.actuators.delay += delay;
        OpenLoop::from_parts(&late)
    }

    /// Returns the loop transfer with a delay (s).
    fn transfer(&self, delay: f64) -> Result<LateTransfer, ConfigError> {
        let whole = libm::floor(delay / self.period) * self.period;
        let opened = self.opened((delay - whole).max(0.0))?;
        Ok(LateTransfer { response: FrequencyResponse::new(&opened.transfer), whole, period: self.period })
    }

    /// Returns the limit near to another one at which an eigenvalue is -1, by Newton's steps; none if they do not converge.
    fn newton(&self, start: DelayLimit) -> Result<Option<DelayLimit>, ConfigError> {
        let DelayLimit { mut frequency, mut delay } = start;
        for _ in 0..STEPS {
            let steps = [DIFFERENCES[0] * frequency, DIFFERENCES[1] * self.parts.law.period.seconds()];
            let (here, later) = (self.transfer(delay)?, self.transfer(delay + steps[1])?);
            let off = here.distance(frequency);
            let beside = [here.distance(frequency + steps[0]), later.distance(frequency)];
            let (Some(off), [Some(higher), Some(later)]) = (off, beside) else { return Ok(None) };
            let (by_frequency, by_delay) = ((higher - off) / steps[0], (later - off) / steps[1]);
            let area = by_frequency.re * by_delay.im - by_frequency.im * by_delay.re;
            let change = [
                (off.im * by_delay.re - off.re * by_delay.im) / area,
                (off.re * by_frequency.im - off.im * by_frequency.re) / area,
            ];
            frequency += change[0];
            delay += change[1];
            if !(frequency > 0.0 && delay > 0.0 && frequency.is_finite() && delay.is_finite()) {
                return Ok(None);
            }
            if change[1].abs() <= CONVERGED * delay && change[0].abs() <= CONVERGED * frequency {
                return Ok(Some(DelayLimit { frequency, delay }));
            }
        }
        Ok(None)
    }

    /// Returns a delay below a limit (s) at which the loop becomes unstable too, by the poles of loops that are later by parts of
    /// the limit; none if there is none.
    fn earlier_limit(&self, opened: &OpenLoop, limit: f64) -> Result<Option<f64>, ConfigError> {
        let (order, inputs) = (opened.states.len(), self.parts.body.inputs.len() as f64);
        let states = |delay: f64| order as f64 + inputs * delay / self.parts.law.period.seconds();
        let mut low = 0.0;
        let delays = CONFIRMED.iter().map(|part| part * limit);
        for mut high in delays.take_while(|delay| states(*delay) <= MOST_STATES as f64) {
            let Some(mut pole) = self.unstable_pole(high)? else {
                low = high;
                continue;
            };
            let stable = low;
            for _ in 0..HALVINGS {
                let middle = 0.5 * (low + high);
                match self.unstable_pole(middle)? {
                    None => low = middle,
                    Some(own) => (high, pole) = (middle, own),
                }
            }
            let frequency = libm::atan2(pole.im, pole.re).abs() / self.period;
            let exact = self.newton(DelayLimit { frequency, delay: high })?.map(|limit| limit.delay);
            let is_same = |delay: &f64| (stable..=high).contains(delay) && (delay - low).abs() < 1e-3 * low;
            return Ok(Some(exact.filter(is_same).unwrap_or(low)));
        }
        Ok(None)
    }

    /// Returns the pole that makes the loop with a delay (s) unstable; none if it is stable.
    fn unstable_pole(&self, delay: f64) -> Result<Option<Complex<f64>>, ConfigError> {
        let closed = self.opened(delay)?.transfer.sensitivity();
        let poles = closed.and_then(|closed| eigenvalues(&closed.a)).unwrap_or_default();
        let worst = poles.into_iter().max_by(|a, b| a.norm_sqr().total_cmp(&b.norm_sqr()));
        Ok(worst.filter(|pole| !is_stable(modulus(*pole), self.period)))
    }
}

impl LateTransfer {
    /// Returns the distance of the nearest eigenvalue from -1 at a frequency (rad/s): the logarithm of their ratio.
    fn distance(&self, frequency: f64) -> Option<Complex<f64>> {
        let values = complex_eigenvalues(self.response.at(unit_circle(frequency * self.period))?)?;
        let turn = unit_circle(-self.whole * frequency);
        let away = |value: &Complex<f64>| (value + 1.0).norm_sqr();
        let turned = values.into_iter().map(|value| value * turn);
        let nearest = turned.min_by(|a, b| away(a).total_cmp(&away(b)))?;
        Some(Complex::new(libm::log(modulus(nearest)), libm::atan2(-nearest.im, -nearest.re)))
    }
}
