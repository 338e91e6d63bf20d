//! Custom law: proportional, integral and derivative feedback.

use flexsc_core::control::law::{
    Authority, Command, ControlOutput, DecisionCause, Guards, Law, LawSpec, Phase, Setpoint,
};
use flexsc_core::control::state_estimate::StateEstimate;
use flexsc_core::numerics::time::{Instant, Span};

/// u = -k_p e - k_i (integral of e) - k_d e', held between samples (N m/rad, N m/(rad s), N m s/rad, s).
#[derive(Copy, Clone, Debug)]
pub struct Pid {
    pub k_p: f64,
    pub k_i: f64,
    pub k_d: f64,
    pub period: f64,
}

/// Run-time state of the law, with the integral of the error (rad s).
#[derive(Copy, Clone, Debug)]
struct Integrating(Pid, f64);

impl LawSpec for Pid {
    fn start(&self, _: &Authority) -> Box<dyn Law> {
        Box::new(Integrating(*self, 0.0))
    }

    fn period(&self) -> Option<Span> {
        Some(Span::from_seconds(self.period))
    }
}

impl Law for Integrating {
    fn decide(
        &mut self,
        now: Instant,
        _: DecisionCause,
        goal: &Setpoint,
        belief: &StateEstimate,
    ) -> ControlOutput {
        let Self(law, integral) = self;
        let (angle, rate) = goal.at(now);
        let error = belief.angle - angle;
        *integral += error * law.period;
        let torque = -law.k_p * error - law.k_i * *integral - law.k_d * (belief.rate - rate);
        let until = Some(now + Span::from_seconds(law.period));
        ControlOutput { command: Command::Torque(torque), until, guards: Guards::NONE }
    }

    fn state(&self) -> Phase {
        Phase::Feedback
    }

    fn copy(&self) -> Box<dyn Law> {
        Box::new(*self)
    }
}
