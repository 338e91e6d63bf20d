//! The observer of one axis at work, between the jets of a spatial body and the belief of its law.

use super::{
    AxisObserver, Form, GradientObserver, ModeEstimate, MovingResidual, Observer, ObserverDesign, Pulse,
    RecurrenceObserver,
};

/// The innovations are small if below this part of the elastic rate, in mean square, or below the floor (rad/s); ours.
const SHARE: f64 = 0.1;
const FLOOR: f64 = 3.16e-6;

/// The observer of one axis.
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
    /// The observers at the start of a run.
    pub fn channels(&self) -> Vec<Channel> {
        let channel = |axis: usize| {
            let design: &AxisObserver = &self.axes[axis];
            let observer = match (&self.form, design.start.first()) {
                (Form::Recurrence(of), Some(tracker)) => {
                    Either::Recurrence(of.observer(tracker, self.period))
                }
                // Without a mode a recurrence is a rigid rate, as a gradient is.
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
    /// Takes the rate measured at a sample (rad/s).
    pub fn update(&mut self, measured: f64) {
        self.observer.observer().update(measured);
    }

    /// Carries the estimates over a cycle under the pulses of all axes, whose inputs are axes.
    pub fn advance(&mut self, pulses: &[Pulse]) {
        let pulses = self.mine(pulses);
        self.observer.observer().advance(&pulses);
    }

    /// The elastic rates of each mode (rad/s) so long after the last sample (s), under the pulses until then.
    pub fn predict(&self, ahead: f64, pulses: &[Pulse]) -> Vec<f64> {
        self.observer.seen().predict(ahead, &self.mine(pulses))
    }

    /// Rigid rate (rad/s).
    pub fn rate(&self) -> f64 {
        self.observer.seen().rate()
    }

    /// Writes down the modes, in the place of those of the sample before.
    pub fn put_modes(&self, modes: &mut Vec<ModeEstimate>) {
        self.observer.seen().put_modes(modes);
    }

    /// The influence of the axis' own jets on a mode.
    pub fn influence(&self, mode: &ModeEstimate) -> f64 {
        mode.influence.get(self.own).copied().unwrap_or(0.0)
    }

    /// How well it follows.
    pub fn residual(&self) -> MovingResidual {
        self.observer.seen().residual()
    }

    /// Whether the elastic rates may be acted on.
    pub fn is_trusted(&self) -> bool {
        self.residual().is_small(SHARE, FLOOR)
    }

    /// The pulses that are inputs, by their index among them.
    fn mine(&self, pulses: &[Pulse]) -> Vec<Pulse> {
        let of = |pulse: &Pulse| {
            let input = self.inputs.iter().position(|input| *input == pulse.input)?;
            Some(Pulse { input, ..*pulse })
        };
        pulses.iter().filter_map(of).collect()
    }
}
