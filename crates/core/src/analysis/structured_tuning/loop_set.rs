//! Loops of a tuning: that of each plant, with its margins and their derivatives in the parameters.

use rayon::prelude::*;

use super::linear_step::{PENALTY, Slope};
use super::sensitivity_minima::LoopSensitivity;
use super::{TunedParameter, TuningFault};
use crate::analysis::margins::{ROUNDING, modulus};
use crate::analysis::open_loop::OpenLoop;

/// Minima that exceed the least one by more than this are not linearised: they do not become the least in a step.
const TRACKED: f64 = 0.25;
/// Step of the differences, relative to the range of a parameter.
const DIFFERENCE: f64 = 1e-5;

/// Returns the loop of a plant with these parameters; the reason if there is none.
type LoopAt<'a> = dyn Fn(&[f64], usize) -> Result<OpenLoop, String> + Sync + 'a;

/// Loops of the plants.
pub struct LoopSet<'a> {
    /// Loop of a plant with these parameters; the reason if there is none.
    pub loop_at: &'a LoopAt<'a>,
    /// Number of plants; the first is the nominal one.
    pub plants: usize,
    /// Frequency (rad/s) up to which the loop gain of the nominal plant is to be at least 1.
    pub bandwidth: Option<f64>,
}

/// Margin of a plant.
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct PlantMargin {
    /// Index of the plant.
    pub plant: usize,
    /// Modulus margin of all signals together; 0 if the loop is not stable.
    pub margin: f64,
    /// Frequency at which it is attained (rad/s).
    pub frequency_rad_s: f64,
    /// Largest magnitude of a pole of the closed loop.
    pub spectral_radius: f64,
}

/// Loop of a plant with some parameters.
#[derive(Clone, Debug)]
struct PlantLoop {
    /// Period of the loop (s).
    period: f64,
    /// Frequency (rad/s) of the least minimum.
    frequency: f64,
    spectral_radius: f64,
    /// Angle and value of each minimum.
    minima: Vec<(f64, f64)>,
    /// Loop gain at the frequency of the bandwidth.
    gain: Option<f64>,
}

/// Loops of all plants with some parameters.
#[derive(Clone, Debug)]
pub struct Evaluation(Vec<PlantLoop>);

impl LoopSet<'_> {
    /// Forms the sensitivity of a plant's loop.
    fn sensitivity(&self, values: &[f64], plant: usize) -> Result<LoopSensitivity, TuningFault> {
        let opened = (self.loop_at)(values, plant).map_err(TuningFault::Loop)?;
        LoopSensitivity::new(&opened).ok_or(TuningFault::Unstable(plant, f64::INFINITY))
    }

    /// Returns the angle of the bandwidth for a plant that has the constraint.
    fn constrained_angle(&self, plant: usize, period: f64) -> Option<f64> {
        self.bandwidth.filter(|_| plant == 0).map(|frequency| frequency * period)
    }

    /// Evaluates the loops of all plants.
    pub(super) fn evaluate(&self, values: &[f64]) -> Result<Evaluation, TuningFault> {
        let evaluate = |plant: usize| {
            let loop_of = self.sensitivity(values, plant)?;
            let closed = loop_of.closed_poles().ok_or(TuningFault::Unstable(plant, f64::INFINITY))?;
            let spectral_radius = closed.iter().map(|pole| modulus(*pole)).fold(0.0, f64::max);
            let is_stable = spectral_radius <= 1.0 + ROUNDING;
            let period = loop_of.samples.period;
            let angle = self.constrained_angle(plant, period);
            let minima = if is_stable { loop_of.minima(&closed, TRACKED) } else { Vec::new() };
            let least = minima.iter().min_by(|a, b| a.1.total_cmp(&b.1));
            Ok(PlantLoop {
                period,
                frequency: least.map_or(0.0, |(angle, _)| loop_of.frequency(*angle)),
                spectral_radius,
                minima,
                gain: angle.map(|angle| loop_of.loop_gain_at(angle)),
            })
        };
        let plants: Result<Vec<PlantLoop>, TuningFault> =
            (0..self.plants).into_par_iter().map(evaluate).collect();
        plants.map(Evaluation)
    }

    /// Linearises the minima of all plants that are near to the least one, and the constraint.
    pub(super) fn slopes(
        &self,
        here: &Evaluation,
        values: &[f64],
        parameters: &[TunedParameter],
    ) -> Result<Vec<Slope>, TuningFault> {
        let most = here.least() + TRACKED;
        let of_plant = |plant: usize| -> Result<Vec<Slope>, TuningFault> {
            let own = &here.0[plant];
            let near: Vec<(f64, f64)> =
                own.minima.iter().copied().filter(|(_, value)| *value <= most).collect();
            let mut slopes: Vec<Slope> = near
                .iter()
                .map(|(_, value)| Slope { value: *value, gradient: Vec::new(), is_constraint: false })
                .collect();
            let angle = self.constrained_angle(plant, own.period);
            let constraint =
                |gain: f64| Slope { value: gain - 1.0, gradient: Vec::new(), is_constraint: true };
            slopes.extend(own.gain.map(constraint));
            if slopes.is_empty() {
                return Ok(slopes);
            }
            for (place, parameter) in parameters.iter().enumerate() {
                let step = DIFFERENCE * (parameter.range[1] - parameter.range[0]);
                let beside = [values[place] + step, values[place] - step]
                    .map(|value| value.clamp(parameter.range[0], parameter.range[1]));
                let loops = beside.map(|value| {
                    let mut moved = values.to_vec();
                    moved[place] = value;
                    self.sensitivity(&moved, plant)
                });
                let [high, low] = loops;
                let (high, low) = (high?, low?);
                let slope =
                    |of: &dyn Fn(&LoopSensitivity) -> f64| (of(&high) - of(&low)) / (beside[0] - beside[1]);
                for (kept, (angle, _)) in slopes.iter_mut().zip(&near) {
                    kept.gradient.push(slope(&|of| of.margin_at(*angle)));
                }
                if let (Some(angle), Some(last)) = (angle, slopes.last_mut()) {
                    last.gradient.push(slope(&|of| of.loop_gain_at(angle)));
                }
            }
            Ok(slopes)
        };
        let all: Result<Vec<Vec<Slope>>, TuningFault> =
            (0..self.plants).into_par_iter().map(of_plant).collect();
        Ok(all?.into_iter().flatten().collect())
    }
}

impl Evaluation {
    /// Returns the first plant whose loop is not stable, and its spectral radius.
    pub fn unstable(&self) -> Option<(usize, f64)> {
        let of =
            |(plant, own): (usize, &PlantLoop)| own.minima.is_empty().then_some((plant, own.spectral_radius));
        self.0.iter().enumerate().find_map(of)
    }

    /// Returns the least margin of all plants.
    pub fn least(&self) -> f64 {
        let all = self.0.iter().flat_map(|own| own.minima.iter().map(|minimum| minimum.1));
        all.fold(f64::INFINITY, f64::min)
    }

    /// Returns the least margin less the penalty of a constraint that is violated.
    pub fn merit(&self) -> f64 {
        let missing = self.0.iter().filter_map(|own| own.gain).map(|gain| (gain - 1.0).min(0.0));
        self.least() + PENALTY * missing.sum::<f64>()
    }

    /// Returns the loop gain of the nominal plant at the bandwidth.
    pub fn bandwidth_gain(&self) -> Option<f64> {
        self.0.first().and_then(|nominal| nominal.gain)
    }

    /// Returns the margin of each plant.
    pub fn margins(&self) -> Vec<PlantMargin> {
        let of = |(plant, own): (usize, &PlantLoop)| {
            let least = own.minima.iter().min_by(|a, b| a.1.total_cmp(&b.1));
            PlantMargin {
                plant,
                margin: least.map_or(0.0, |minimum| minimum.1),
                frequency_rad_s: own.frequency,
                spectral_radius: own.spectral_radius,
            }
        };
        self.0.iter().enumerate().map(of).collect()
    }
}
