//! Run-time observer of one axis, between the actuator's pulses and the state estimate.

use super::{
    AxisObserver, Form, GradientObserver, ModeEstimate, MovingResidual, Observer, ObserverDesign, Pulse,
    RecurrenceObserver,
};

/// Share of the elastic rate, in mean square, or floor (rad/s) below which innovations are small; our choice.
const SHARE: f64 = 0.1;
const FLOOR: f64 = 3.16e-6;

/// Run-time observer of one axis.
#[derive(Clone, Debug)]
pub struct Channel {
    observer: Either,
    inputs: Vec<usize>,
    own: usize,
}

#[derive(Clone, Debug)]
enum Either {
    Gradient(GradientObserver),
    Recurrence(RecurrenceObserver),
}

impl Either {
    fn observer(&mut self) -> &mut dyn Observer {
        match self {
            Self::Gradient(observer) => observer,
            Self::Recurrence(observer) => observer,
        }
    }

    fn seen(&self) -> &dyn Observer {
        match self {
            Self::Gradient(observer) => observer,
            Self::Recurrence(observer) => observer,
        }
    }
}

impl ObserverDesign {
    /// Creates the observers at the start of a run.
    pub fn channels(&self) -> Vec<Channel> {
        let channel = |axis: usize| {
            let design: &AxisObserver = &self.axes[axis];
            let observer = match (&self.form, design.start.first()) {
                (Form::Recurrence(of), Some(tracker)) => {
                    Either::Recurrence(of.observer(tracker, self.period))
                }
                // Without a mode, the recurrence is a rigid rate observer, like the gradient form.
                (Form::Recurrence(_), None) => {
                    Either::Gradient(super::Gradient::default().observer(&[], &design.rigid, self.period))
                }
                (Form::Gradient(of), _) => {
                    Either::Gradient(of.observer(&design.start, &design.rigid, self.period))
                }
            };
            Channel { observer, inputs: design.inputs.clone(), own: design.own(axis) }
        };
        (0..self.axes.len()).map(channel).collect()
    }
}

impl Channel {
    /// Updates the estimates with the rate measured at a sample (rad/s).
    pub fn update(&mut self, measured: f64) {
        self.observer.observer().update(measured);
    }

    /// Propagates the estimates over a cycle under the pulses of all axes, whose inputs are axis indices.
    pub fn advance(&mut self, pulses: &[Pulse]) {
        let pulses = self.mine(pulses);
        self.observer.observer().advance(&pulses);
    }

    /// Predicts the elastic rate of each mode (rad/s) at `ahead` (s) after the last sample, under the pulses until
    /// then.
    pub fn predict(&self, ahead: f64, pulses: &[Pulse]) -> Vec<f64> {
        self.observer.seen().predict(ahead, &self.mine(pulses))
    }

    /// Returns the rigid rate (rad/s).
    pub fn rate(&self) -> f64 {
        self.observer.seen().rate()
    }

    /// Writes the mode estimates into `modes`, replacing its contents.
    pub fn put_modes(&self, modes: &mut Vec<ModeEstimate>) {
        self.observer.seen().put_modes(modes);
    }

    /// Returns the influence of the axis' own actuator on a mode.
    pub fn influence(&self, mode: &ModeEstimate) -> f64 {
        mode.influence.get(self.own).copied().unwrap_or(0.0)
    }

    /// Returns the moving mean squares of innovation and elastic rate.
    pub fn residual(&self) -> MovingResidual {
        self.observer.seen().residual()
    }

    /// Returns true if the innovations are small enough for laws to act on the elastic rates.
    pub fn is_trusted(&self) -> bool {
        self.residual().is_small(SHARE, FLOOR)
    }

    /// Returns the pulses that are inputs of this observer, with their indices among its inputs.
    fn mine(&self, pulses: &[Pulse]) -> Vec<Pulse> {
        let of = |pulse: &Pulse| {
            let input = self.inputs.iter().position(|input| *input == pulse.input)?;
            Some(Pulse { input, ..*pulse })
        };
        pulses.iter().filter_map(of).collect()
    }
}
