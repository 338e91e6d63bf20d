//! Custom law: proportional, integral and derivative feedback, which logs its integral.

use std::sync::Arc;

use flexsc_core::control::custom::Custom;
use flexsc_core::control::law::{
    Authority, Command, ControlOutput, DecisionCause, Guards, Law, LawKind, LawSpec, LawState, Phase,
    Setpoint,
};
use flexsc_core::control::offers::LawOffers;
use flexsc_core::control::part::{Occasion, Part, ReportContext};
use flexsc_core::control::state_estimate::{EstimateNeeds, StateEstimate};
use flexsc_core::numerics::time::{Instant, Span};
use flexsc_core::record::{CustomField, CustomTopic, Report};

/// u = -k_p e - k_i (integral of e) - k_d e', held between samples (N m/rad, N m/(rad s), N m s/rad, s).
#[derive(Clone, Debug)]
pub struct Pid {
    pub k_p: f64,
    pub k_i: f64,
    pub k_d: f64,
    pub period: f64,
    /// Topic of the integral.
    topic: Arc<CustomTopic>,
}

/// Run-time state of the law about an axis, with the integral of the error (rad s).
#[derive(Clone, Debug)]
struct Integrating {
    law: Pid,
    axis: usize,
    integral: f64,
}

impl Pid {
    /// Creates the law with its gains k_p, k_i and k_d and its period.
    pub fn kind([k_p, k_i, k_d]: [f64; 3], period: f64) -> LawKind {
        let fields = vec![
            CustomField::new("axis", "", "Index of the axis, from 0."),
            CustomField::new("integral", "rad s", "Integral of the error."),
        ];
        let topic = CustomTopic::new("/pid", "Law with an integral.", fields).expect("a topic");
        let topics = vec![Arc::clone(&topic)];
        LawKind::Own(Custom::with_topics(Arc::new(Self { k_p, k_i, k_d, period, topic }), topics))
    }
}

impl LawSpec for Pid {
    fn start(&self, authority: &Authority) -> Box<dyn Law> {
        Box::new(Integrating { law: self.clone(), axis: authority.axis, integral: 0.0 })
    }

    fn offers(&self) -> LawOffers {
        LawOffers::new(Some(Span::from_seconds(self.period)), EstimateNeeds::Motion)
    }
}

impl Part for Integrating {
    fn report(&self, at: &ReportContext<'_>, report: &mut Report) {
        if at.occasion == Occasion::Period {
            report.add(self.law.topic.row([self.axis as f64, self.integral]).expect("two values"));
        }
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
        let Self { law, integral, .. } = self;
        let (angle, rate) = goal.at(now);
        let error = belief.angle - angle;
        *integral += error * law.period;
        let torque = -law.k_p * error - law.k_i * *integral - law.k_d * (belief.rate - rate);
        let until = Some(now + Span::from_seconds(law.period));
        ControlOutput { command: Command::Torque(torque), until, guards: Guards::NONE }
    }

    fn state(&self) -> LawState<'_> {
        LawState::new(Phase::Feedback)
    }

    fn copy(&self) -> Box<dyn Law> {
        Box::new(self.clone())
    }
}
