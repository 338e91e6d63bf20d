//! Design of the observer of each axis: true modes, initial values and inputs.

use flexsc_formats::document::ConfigError;
use flexsc_numerics::attitude::AXES;
use flexsc_numerics::quantity::{Finite, Frequency};

use super::{Adaptive, MergedTracker, ObserverForm, Tracker, bounds, merge};
use crate::estimator::EstimatorSpec;

/// Design of the observers of all axes, from the scenario and its body.
#[derive(Clone, Debug, PartialEq)]
pub struct ObserverDesign {
    /// Form and settings of the observers.
    pub form: ObserverForm,
    /// Design of each axis.
    pub axes: Vec<AxisObserverDesign>,
    /// Period of the samples (s).
    pub period: f64,
}

/// Design of the observer of one axis.
#[derive(Clone, Debug, PartialEq)]
pub struct AxisObserverDesign {
    /// True modes, by frequency.
    pub modes: Vec<MergedTracker>,
    /// Initial values of the observer.
    pub start: Vec<Tracker>,
    /// Axes whose groups of jets are the observer's inputs, in the order of the inputs.
    pub inputs: Vec<usize>,
    /// Change of the rigid rate of this axis by each input, per unit of its change of the rigid rate of its own axis.
    pub rigid: Vec<f64>,
    /// Rotations of the body's modes about this axis at the gyro (rad/(m sqrt(kg))).
    pub visibilities: Vec<f64>,
}

/// Data of a body whose rates are measured: modes, measurement and actuation.
#[derive(Clone, Debug, PartialEq)]
pub struct RateMeasurement {
    /// Natural frequencies of the modes.
    pub frequencies: Vec<Frequency>,
    /// Rotation per unit of each mode at the rate sensor, for each axis.
    pub visibilities: Vec<Vec<f64>>,
    /// Effect of the actuator of each axis.
    pub inputs: Vec<ActuatorInput>,
}

/// Effect of an axis' actuator while it exerts a torque.
#[derive(Clone, Debug, PartialEq)]
pub struct ActuatorInput {
    /// Modal forces of the modes.
    pub forces: Vec<f64>,
    /// Angular acceleration about the actuator's own axis (rad/s²).
    pub acceleration: f64,
    /// Change of the rigid rate about each axis, per unit of its change about the actuator's own axis.
    pub turning: Vec<f64>,
}

impl ObserverDesign {
    /// Creates the design for sampled rates with the period `period` (s).
    ///
    /// # Errors
    /// A `ConfigError` with a key within the estimator and the reason.
    pub fn new(spec: &Adaptive, measured: &RateMeasurement, period: f64) -> Result<Self, ConfigError> {
        if let Some(fault) = spec.validate() {
            return Err(fault);
        }
        let axes = measured.inputs.len();
        if axes == 1 && spec.trackers.is_some() {
            let why =
                "apply only to three axes: for a body with one angle, `count` is the number of tracked modes";
            return Err(ConfigError::new("trackers", why));
        }
        let form = spec.effective_form();
        let axis = |axis: usize| AxisObserverDesign::new(spec, &form, axis, measured, period);
        let axes: Vec<AxisObserverDesign> = (0..axes).map(axis).collect::<Result<_, _>>()?;
        if axes.iter().all(|design| design.start.is_empty()) {
            return Err(ConfigError::new("", "must have a mode to track, and the gyro sees none"));
        }
        Ok(Self { form, axes, period })
    }
}

impl AxisObserverDesign {
    fn new(
        spec: &Adaptive,
        form: &ObserverForm,
        axis: usize,
        measured: &RateMeasurement,
        period: f64,
    ) -> Result<Self, ConfigError> {
        let RateMeasurement { frequencies, visibilities, inputs: sources } = measured;
        let inputs = if spec.uses_cross_axis() { (0..sources.len()).collect() } else { vec![axis] };
        let influence = |input: usize, mode: usize| {
            let source = &sources[input];
            visibilities[axis][mode] * source.forces[mode] / source.acceleration
        };
        let tracker = |frequency: Frequency, influence: Vec<f64>| Tracker {
            frequency,
            influence: influence.into_iter().map(|value| Finite::new(value).unwrap_or_default()).collect(),
            bounds: None,
        };
        // The dominant modes follow from the axis' own jets, which are to damp them.
        let sampled = |mode: &usize| frequencies[*mode].get() * period < std::f64::consts::PI;
        let visible: Vec<usize> =
            (0..frequencies.len()).filter(sampled).filter(|mode| influence(axis, *mode) != 0.0).collect();
        let own: Vec<Tracker> =
            visible.iter().map(|mode| tracker(frequencies[*mode], vec![influence(axis, *mode)])).collect();
        let mut all = merge(&own, spec.merge.get());
        for one in &mut all {
            for mode in &mut one.modes {
                *mode = visible[*mode];
            }
            let summed = |input: &usize| one.modes.iter().map(|mode| influence(*input, *mode)).sum();
            one.tracker = tracker(one.tracker.frequency, inputs.iter().map(summed).collect());
        }
        let own = inputs.iter().position(|input| *input == axis).unwrap_or(0);
        let trackers = spec.trackers.as_ref().map(|trackers| trackers.axes()[axis]);
        let modes =
            trackers.map_or_else(|| strongest(&all, own, spec.count()), |trackers| nearest(&all, trackers));
        let designed: Vec<Tracker> =
            trackers.map_or_else(|| modes.iter().map(|mode| mode.tracker.clone()).collect(), <[_]>::to_vec);
        let start = started(spec, form, axis, &designed, inputs.len(), period)?;
        let turn = |input: &usize| if spec.uses_cross_axis() { sources[*input].turning[axis] } else { 1.0 };
        let rigid = inputs.iter().map(turn).collect();
        Ok(Self { modes, start, rigid, inputs, visibilities: visibilities[axis].clone() })
    }

    /// Returns the index of the axis' own jets among the inputs.
    pub fn own_axis_input(&self, axis: usize) -> usize {
        self.inputs.iter().position(|input| *input == axis).unwrap_or(0)
    }
}

/// Returns the `count` modes that a long burn of an input excites most, by frequency: a step a of the elastic
/// acceleration causes an elastic rate of a/w.
fn strongest(all: &[MergedTracker], input: usize, count: usize) -> Vec<MergedTracker> {
    let strength =
        |mode: &MergedTracker| mode.tracker.influence[input].get().abs() / mode.tracker.frequency.get();
    let mut modes = all.to_vec();
    modes.sort_by(|a, b| strength(b).total_cmp(&strength(a)));
    modes.truncate(count);
    modes.sort_by(|a, b| a.tracker.frequency.get().total_cmp(&b.tracker.frequency.get()));
    modes
}

/// Returns the mode nearest to each tracker; the tracker without modes if there is none.
fn nearest(all: &[MergedTracker], trackers: &[Tracker]) -> Vec<MergedTracker> {
    let model_of = |tracker: &Tracker| {
        let far = |mode: &&MergedTracker| (mode.tracker.frequency.get() - tracker.frequency.get()).abs();
        let found = all.iter().min_by(|a, b| far(a).total_cmp(&far(b)));
        found.cloned().unwrap_or_else(|| MergedTracker { tracker: tracker.clone(), modes: Vec::new() })
    };
    trackers.iter().map(model_of).collect()
}

/// Returns the trackers with the initial errors of the scenario, limited to the bounds of the design.
fn started(
    spec: &Adaptive,
    form: &ObserverForm,
    axis: usize,
    designed: &[Tracker],
    inputs: usize,
    period: f64,
) -> Result<Vec<Tracker>, ConfigError> {
    if designed.is_empty() {
        return Ok(Vec::new());
    }
    let with_axis = |ConfigError { key, why, .. }: ConfigError| {
        ConfigError::new(key.replacen("trackers", &format!("trackers.{}", AXES[axis]), 1), why)
    };
    let (wrong, reach) = match form {
        ObserverForm::Gradient(form) => (form.validate(designed, inputs, period), form.reach),
        ObserverForm::Recurrence(_) if designed.len() > 1 => {
            let why = format!("must be one mode in the form `recurrence`, got {}", designed.len());
            return Err(with_axis(ConfigError::new("trackers", why)));
        }
        ObserverForm::Recurrence(form) => (form.validate(&designed[0], period), form.reach),
    };
    if let Some(fault) = wrong {
        let kind = if matches!(form, ObserverForm::Gradient(_)) { "gradient" } else { "recurrence" };
        let own = !fault.key.starts_with("trackers");
        return Err(if own { fault.within(&format!("form.{kind}")) } else { with_axis(fault) });
    }
    let factor = |error: Finite| 1.0 + error.get();
    let bounds = bounds(designed, reach.get(), period);
    let frequency = |value: f64, default: Frequency| {
        Frequency::new(value.clamp(Frequency::SMALLEST, Frequency::LARGEST)).unwrap_or(default)
    };
    let start = |(tracker, [low, high]): (&Tracker, [f64; 2])| {
        let known = tracker.frequency;
        let influence = tracker.influence.iter().map(|influence| {
            Finite::new(influence.get() * factor(spec.influence_error)).unwrap_or(*influence)
        });
        Tracker {
            // Beyond its bounds, it would be identified as another mode.
            frequency: frequency((known.get() * factor(spec.frequency_error)).clamp(low, high), known),
            influence: influence.collect(),
            bounds: Some([low, high].map(|bound| frequency(bound, known))),
        }
    };
    Ok(designed.iter().zip(bounds).map(start).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_modes_that_a_long_burn_excites_most_are_followed() {
        let mode = |index: usize, frequency: f64, influence: f64| MergedTracker {
            tracker: Tracker {
                frequency: Frequency::new(frequency).expect("a frequency"),
                influence: vec![Finite::new(influence).expect("an influence")],
                bounds: None,
            },
            modes: vec![index],
        };
        // Elastic rates of 0.2, 2, -1.5 and 0.5 per unit of acceleration: the largest influence is not the strongest
        // mode.
        let all = [mode(0, 1.0, 0.2), mode(1, 2.0, 4.0), mode(2, 3.0, -4.5), mode(3, 10.0, 5.0)];
        let followed = |count: usize| -> Vec<usize> {
            strongest(&all, 0, count).iter().flat_map(|mode| mode.modes.clone()).collect()
        };
        assert_eq!([followed(1), followed(2), followed(3)], [vec![1], vec![1, 2], vec![1, 2, 3]]);
        let trackers = [mode(9, 2.6, 1.0), mode(9, 0.1, 1.0)].map(|mode| mode.tracker);
        let nearest: Vec<usize> =
            nearest(&all, &trackers).iter().flat_map(|mode| mode.modes.clone()).collect();
        assert_eq!(nearest, [2, 0]);
    }
}
