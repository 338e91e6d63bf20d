//! Run-time observer of one axis, between the actuator's pulses and the state estimate.

use super::{
    AdaptiveObserver, AxisObserverDesign, GradientObserver, ModeEstimate, MovingResidual, ObserverDesign,
    ObserverForm, Pulse, RecurrenceObserver,
};

/// Share of the elastic rate, in mean square, or floor (rad/s) below which innovations are small; our choice.
const SHARE: f64 = 0.1;
const FLOOR: f64 = 3.16e-6;

/// Run-time observer of one axis.
#[derive(Clone, Debug)]
pub struct AxisObserver {
    observer: ObserverVariant,
    inputs: Vec<usize>,
    own: usize,
}

#[derive(Clone, Debug)]
enum ObserverVariant {
    Gradient(GradientObserver),
    Recurrence(RecurrenceObserver),
}

impl ObserverVariant {
    fn observer(&mut self) -> &mut dyn AdaptiveObserver {
        match self {
            Self::Gradient(observer) => observer,
            Self::Recurrence(observer) => observer,
        }
    }

    fn as_observer(&self) -> &dyn AdaptiveObserver {
        match self {
            Self::Gradient(observer) => observer,
            Self::Recurrence(observer) => observer,
        }
    }
}

impl ObserverDesign {
    /// Creates the observers at the start of a run.
    pub fn channels(&self) -> Vec<AxisObserver> {
        let channel = |axis: usize| {
            let design: &AxisObserverDesign = &self.axes[axis];
            let observer = match (&self.form, design.start.first()) {
                (ObserverForm::Recurrence(form), Some(tracker)) => {
                    ObserverVariant::Recurrence(form.observer(tracker, self.period))
                }
                // Without a mode, the recurrence is a rigid rate observer, like the gradient form.
                (ObserverForm::Recurrence(_), None) => ObserverVariant::Gradient(
                    super::Gradient::default().observer(&[], &design.rigid, self.period),
                ),
                (ObserverForm::Gradient(form), _) => {
                    ObserverVariant::Gradient(form.observer(&design.start, &design.rigid, self.period))
                }
            };
            AxisObserver { observer, inputs: design.inputs.clone(), own: design.own_axis_input(axis) }
        };
        (0..self.axes.len()).map(channel).collect()
    }
}

impl AxisObserver {
    /// Updates the estimates with the rate measured at a sample (rad/s).
    pub fn update(&mut self, measured: f64) {
        self.observer.observer().update(measured);
    }

    /// Propagates the estimates over a cycle under the pulses of all axes, whose inputs are axis indices.
    pub fn advance(&mut self, pulses: &[Pulse]) {
        let pulses = self.own_pulses(pulses);
        self.observer.observer().advance(&pulses);
    }

    /// Predicts the elastic rate of each mode (rad/s) at `ahead` (s) after the last sample, under the pulses until
    /// then.
    pub fn predict(&self, ahead: f64, pulses: &[Pulse]) -> Vec<f64> {
        self.observer.as_observer().predict(ahead, &self.own_pulses(pulses))
    }

    /// Returns the rigid rate (rad/s).
    pub fn rate(&self) -> f64 {
        self.observer.as_observer().rate()
    }

    /// Writes the mode estimates into `modes`, replacing its contents.
    pub fn write_modes(&self, modes: &mut Vec<ModeEstimate>) {
        self.observer.as_observer().put_modes(modes);
    }

    /// Returns the influence of the axis' own actuator on a mode.
    pub fn influence(&self, mode: &ModeEstimate) -> f64 {
        mode.influence.get(self.own).copied().unwrap_or(0.0)
    }

    /// Returns the moving mean squares of innovation and elastic rate.
    pub fn residual(&self) -> MovingResidual {
        self.observer.as_observer().residual()
    }

    /// Returns true if the innovations are small enough for laws to act on the elastic rates.
    pub fn is_trusted(&self) -> bool {
        self.residual().is_below(SHARE, FLOOR)
    }

    /// Returns the pulses that are inputs of this observer, with their indices among its inputs.
    fn own_pulses(&self, pulses: &[Pulse]) -> Vec<Pulse> {
        let pulse_on_axis = |pulse: &Pulse| {
            let input = self.inputs.iter().position(|input| *input == pulse.input)?;
            Some(Pulse { input, ..*pulse })
        };
        pulses.iter().filter_map(pulse_on_axis).collect()
    }
}
