//! Scenario data for the estimator, the monitor of the envelope and the meter of an objective, before a run.

use flexsc_control::adaptation::Objective;
use flexsc_control::estimator::{
    AdaptationRun, EstimatorContext, EstimatorKind, ObjectiveMeter, WindowedEnvelope,
};
use flexsc_numerics::random::Seed;
use flexsc_spacecraft::body::BodyAxes;

use super::{Scenario, ScenarioSpec};

impl Scenario {
    /// Returns the scenario data that the estimator needs before a run.
    pub fn estimator_context(&self) -> EstimatorContext<'_> {
        let study = &self.study;
        let axes = 0..study.axes.len();
        EstimatorContext {
            estimator: self.estimator.as_ref(),
            axes: &study.axes,
            back_emf: study.back_emf,
            drift: study.drift.as_ref(),
            sampling: study.sample_period,
            angle_noise: self.sensor.angle_noise(),
            rate_noise: axes.clone().map(|axis| self.sensor.rate_noise(axis)).collect(),
            reads: axes.map(|axis| self.law.about(axis).needs()).collect(),
            adaptive: study.adaptive.as_deref(),
            attitude: study.attitude.as_ref(),
        }
    }

    /// Creates the monitor of the envelope, if the scenario has one.
    pub fn monitor(&self, seed: Seed) -> Option<WindowedEnvelope> {
        let envelope = self.estimator.as_ref().and_then(EstimatorKind::envelope)?;
        let learns = self.objective() == Some(Objective::EnvelopeMean);
        let search = self.adaptation_state(seed).filter(|_| learns);
        let body = match self.model.axes() {
            BodyAxes::One(body) => return Some(WindowedEnvelope::new(envelope, body, search)),
            BodyAxes::Three(body) => body,
        };
        let point = self.study.sensor_points.first().map_or("", String::as_str);
        let rotations = body.shapes(point).into_iter().map(|(_, rotation)| rotation.norm());
        let modes: Vec<_> = body.modes.iter().copied().zip(rotations).collect();
        Some(WindowedEnvelope::for_three_axes(envelope, &modes, search))
    }

    /// Creates the meter of the adaptation's objective, if it has one other than the envelope's mean.
    pub fn objective_meter(&self, seed: Seed) -> Option<ObjectiveMeter> {
        let (adaptation, objective) = (self.adaptation.as_ref()?, self.objective()?);
        let window = adaptation.window().filter(|_| objective != Objective::EnvelopeMean)?;
        let goal = self.goal();
        Some(ObjectiveMeter::new(objective, window, goal, self.adaptation_state(seed)?))
    }

    /// Returns the unit of the torques.
    pub fn torque_unit(&self) -> &'static str {
        self.model.commanded_quantity().1
    }
}

impl ScenarioSpec {
    /// Returns the objective of the adaptation, if there is one.
    pub fn objective(&self) -> Option<Objective> {
        self.adaptation.as_ref().map(|adaptation| adaptation.objective())
    }

    /// Returns the initial value of the law's parameter that the adaptation tunes; `None` without an adaptation.
    pub fn tuned_parameter(&self) -> Option<f64> {
        let tunes = self.adaptation.as_ref()?.tunes();
        self.law.tunable().into_iter().find(|number| number.key == tunes).map(|number| number.value)
    }

    /// Returns the key of the law's parameter that the adaptation tunes, such as `law.relay.k_t`; `None` without an adaptation.
    pub fn tuned_key(&self) -> Option<String> {
        Some(format!("{}.{}", self.law.key(), self.adaptation.as_ref()?.tunes()))
    }

    fn adaptation_state(&self, seed: Seed) -> Option<AdaptationRun> {
        Some(AdaptationRun::new(self.adaptation.as_ref()?, self.tuned_parameter()?, seed))
    }
}
