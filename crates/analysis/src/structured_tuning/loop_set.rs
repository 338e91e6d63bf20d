//! Loops of a tuning: that of each plant, with the quantities of the goal and their derivatives in the parameters.

use rayon::prelude::*;
use schemars::JsonSchema;
use serde::Serialize;

use super::goal::TuningGoal;
use super::linear_step::{PENALTY, Slope};
use super::sensitivity_minima::LoopSensitivity;
use super::{TunedParameter, TuningFault};
use crate::margins::{is_stable, modulus};
use crate::open_loop::OpenLoop;

/// Values that exceed the least one by more than this are not linearised: they do not become the least in a step.
const TRACKED: f64 = 0.25;
/// Step of the differences, relative to the range of a parameter.
const DIFFERENCE: f64 = 1e-5;

/// Loop of a plant, and its quantities besides the margins.
#[derive(Clone, Debug)]
pub struct TunedPlant {
    /// Loop, cut open.
    pub opened: OpenLoop,
    /// Components of each measure of the goal, of which the largest counts.
    pub measures: Vec<Vec<f64>>,
}

/// Returns a plant with these parameters; the reason if there is none.
type PlantAt<'a> = dyn Fn(&[f64], usize) -> Result<TunedPlant, String> + Sync + 'a;

/// Loops of the plants.
pub struct LoopSet<'a> {
    /// Plant with these parameters; the reason if there is none.
    pub plant_at: &'a PlantAt<'a>,
    /// Number of plants; the first is the nominal one.
    pub plants: usize,
    /// Goal.
    pub goal: TuningGoal,
}

/// Margin of a plant.
#[derive(Copy, Clone, Debug, PartialEq, Serialize, JsonSchema)]
pub struct PlantMargin {
    /// Index of the plant.
    #[serde(skip)]
    pub plant: usize,
    /// Modulus margin of all signals together; 0 if the loop is not stable.
    pub margin: f64,
    /// Frequency (rad/s) at which it is attained; it is often attained at several, of which this is one.
    pub frequency_rad_s: f64,
    /// Largest magnitude of a pole of the closed loop.
    pub spectral_radius: f64,
}

/// Sensitivity of a plant's loop, and its measures.
struct PlantModel {
    sensitivity: LoopSensitivity,
    measures: Vec<Vec<f64>>,
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
    /// Components of each measure.
    measures: Vec<Vec<f64>>,
}

/// Loops of all plants with some parameters.
#[derive(Clone, Debug)]
pub struct Evaluation(Vec<PlantLoop>);

/// Value of a plant that is to be large: part of the objective, or a constraint that it is at least 0.
#[derive(Copy, Clone, Debug)]
struct GoalValue {
    value: f64,
    source: ValueSource,
    is_constraint: bool,
}

/// Origin of a value.
#[derive(Copy, Clone, Debug)]
enum ValueSource {
    /// Modulus margin at an angle, less an offset.
    Margin { angle: f64, offset: f64 },
    /// Loop gain at an angle, less 1.
    Gain { angle: f64 },
    /// Component of a measure: an offset less its value in a unit.
    Measure { index: usize, component: usize, offset: f64, unit: f64 },
}

impl ValueSource {
    fn value(self, model: &PlantModel) -> f64 {
        match self {
            Self::Margin { angle, offset } => model.sensitivity.margin_at(angle) - offset,
            Self::Gain { angle } => model.sensitivity.loop_gain_at(angle) - 1.0,
            Self::Measure { index, component, offset, unit } => {
                offset - model.measures[index].get(component).copied().unwrap_or(f64::INFINITY) / unit
            }
        }
    }
}

impl LoopSet<'_> {
    /// Forms the model of a plant.
    fn model(&self, values: &[f64], plant: usize) -> Result<PlantModel, TuningFault> {
        let TunedPlant { opened, measures } = (self.plant_at)(values, plant).map_err(TuningFault::Loop)?;
        let sensitivity = LoopSensitivity::new(&opened).ok_or(TuningFault::Unstable(plant, f64::INFINITY))?;
        Ok(PlantModel { sensitivity, measures })
    }

    /// Returns the angle of the bandwidth for a plant that has the constraint.
    fn constrained_angle(&self, plant: usize, period: f64) -> Option<f64> {
        self.goal.bandwidth.filter(|_| plant == 0).map(|frequency| frequency * period)
    }

    /// Evaluates the loops of all plants.
    pub(super) fn evaluate(&self, values: &[f64]) -> Result<Evaluation, TuningFault> {
        let evaluate = |plant: usize| {
            let PlantModel { sensitivity, measures } = self.model(values, plant)?;
            let closed = sensitivity.closed_poles().ok_or(TuningFault::Unstable(plant, f64::INFINITY))?;
            let spectral_radius = closed.iter().map(|pole| modulus(*pole)).fold(0.0, f64::max);
            let period = sensitivity.samples.period;
            let angle = self.constrained_angle(plant, period);
            let minima = if is_stable(spectral_radius, period) {
                sensitivity.minima(&closed, TRACKED)
            } else {
                Vec::new()
            };
            let least = minima.iter().min_by(|a, b| a.1.total_cmp(&b.1));
            Ok(PlantLoop {
                period,
                frequency: least.map_or(0.0, |(angle, _)| sensitivity.frequency(*angle)),
                spectral_radius,
                minima,
                gain: angle.map(|angle| sensitivity.loop_gain_at(angle)),
                measures,
            })
        };
        let plants: Result<Vec<PlantLoop>, TuningFault> =
            (0..self.plants).into_par_iter().map(evaluate).collect();
        plants.map(Evaluation)
    }

    /// Returns the values of a plant's objective and constraints. A minimised measure is in units of `unit`.
    fn goal_values(&self, plant: usize, own: &PlantLoop, unit: f64) -> Vec<GoalValue> {
        let mut values = Vec::new();
        let mut add = |value: f64, source: ValueSource, is_constraint: bool| {
            values.push(GoalValue { value, source, is_constraint });
        };
        for (angle, value) in &own.minima {
            if self.goal.minimised.is_none() {
                add(*value, ValueSource::Margin { angle: *angle, offset: 0.0 }, false);
            }
            if let Some(offset) = self.goal.least_margin {
                add(value - offset, ValueSource::Margin { angle: *angle, offset }, true);
            }
        }
        if let (Some(gain), Some(angle)) = (own.gain, self.constrained_angle(plant, own.period)) {
            add(gain - 1.0, ValueSource::Gain { angle }, true);
        }
        for (index, components) in own.measures.iter().enumerate() {
            for (component, value) in components.iter().enumerate() {
                if self.goal.minimised == Some(index) {
                    add(-value / unit, ValueSource::Measure { index, component, offset: 0.0, unit }, false);
                }
                if let Some(limit) = self.goal.measures[index].limit {
                    let source = ValueSource::Measure { index, component, offset: 1.0, unit: limit };
                    add(1.0 - value / limit, source, true);
                }
            }
        }
        values
    }

    /// Returns the values of all plants.
    fn all_values(&self, here: &Evaluation, unit: f64) -> Vec<Vec<GoalValue>> {
        here.0.iter().enumerate().map(|(plant, own)| self.goal_values(plant, own, unit)).collect()
    }

    /// Returns the least value of the objective less the penalties of constraints that are violated. A minimised measure is
    /// in units of `unit`.
    pub(super) fn merit(&self, here: &Evaluation, unit: f64) -> f64 {
        let (mut least, mut missing) = (f64::INFINITY, 0.0);
        for GoalValue { value, is_constraint, .. } in self.all_values(here, unit).into_iter().flatten() {
            if is_constraint {
                missing += value.min(0.0);
            } else {
                least = least.min(value);
            }
        }
        least + PENALTY * missing
    }

    /// Linearises the values of all plants that are near to the least one, and the constraints.
    pub(super) fn slopes(
        &self,
        here: &Evaluation,
        unit: f64,
        values: &[f64],
        parameters: &[TunedParameter],
    ) -> Result<Vec<Slope>, TuningFault> {
        let all = self.all_values(here, unit);
        let objective = all.iter().flatten().filter(|value| !value.is_constraint);
        let least = objective.map(|value| value.value).fold(f64::INFINITY, f64::min);
        let is_near = |of: &&GoalValue| of.value <= TRACKED + if of.is_constraint { 0.0 } else { least };
        let slopes = |plant: usize| -> Result<Vec<Slope>, TuningFault> {
            let near: Vec<GoalValue> = all[plant].iter().filter(is_near).copied().collect();
            let mut slopes: Vec<Slope> = near
                .iter()
                .map(|of| Slope { value: of.value, gradient: Vec::new(), is_constraint: of.is_constraint })
                .collect();
            if slopes.is_empty() {
                return Ok(slopes);
            }
            for (place, parameter) in parameters.iter().enumerate() {
                let step = DIFFERENCE * (parameter.range[1] - parameter.range[0]);
                let beside = [values[place] + step, values[place] - step]
                    .map(|value| value.clamp(parameter.range[0], parameter.range[1]));
                let models = beside.map(|value| {
                    let mut moved = values.to_vec();
                    moved[place] = value;
                    self.model(&moved, plant)
                });
                let [high, low] = models;
                let (high, low) = (high?, low?);
                for (kept, near) in slopes.iter_mut().zip(&near) {
                    let change = near.source.value(&high) - near.source.value(&low);
                    let slope = change / (beside[0] - beside[1]);
                    kept.gradient.push(if slope.is_finite() { slope } else { 0.0 });
                }
            }
            Ok(slopes)
        };
        let each: Result<Vec<Vec<Slope>>, TuningFault> =
            (0..self.plants).into_par_iter().map(slopes).collect();
        Ok(each?.into_iter().flatten().filter(|slope| slope.value.is_finite()).collect())
    }

    /// Returns the largest value of a measure, and the plant that has it.
    pub(super) fn largest(here: &Evaluation, measure: usize) -> (f64, usize) {
        let of = |(plant, own): (usize, &PlantLoop)| {
            (own.measures[measure].iter().copied().fold(0.0, f64::max), plant)
        };
        here.0.iter().enumerate().map(of).fold((0.0, 0), |most, own| if own.0 > most.0 { own } else { most })
    }
}

impl Evaluation {
    /// Returns the first plant whose loop is not stable, and its spectral radius.
    pub fn unstable(&self) -> Option<(usize, f64)> {
        let of =
            |(plant, own): (usize, &PlantLoop)| own.minima.is_empty().then_some((plant, own.spectral_radius));
        self.0.iter().enumerate().find_map(of)
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
