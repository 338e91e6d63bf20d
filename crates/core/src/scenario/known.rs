//! Scenario data for the estimator, the monitor of the envelope and the meter of an objective, before a run.

use super::{Scenario, Written};
use crate::adaptation::{Adaptation, Objective};
use crate::body::Axes;
use crate::estimator::{Estimator, Known, Meter, Monitor, Searching};
use crate::random::Seed;

impl Scenario {
    /// Returns the scenario data that the estimator needs before a run.
    pub fn known(&self) -> Known<'_> {
        let study = &self.study;
        let axes = 0..study.axes.len();
        Known {
            estimator: self.estimator.as_ref(),
            axes: &study.axes,
            back_emf: study.back_emf,
            drift: self.drift.as_ref(),
            sampling: study.sampling,
            angle_noise: self.sensor.angle_noise(),
            rate_noise: axes.clone().map(|axis| self.sensor.rate_noise(axis)).collect(),
            reads: axes.map(|axis| self.law.about(axis).reads()).collect(),
            adaptive: study.adaptive.as_deref(),
            attitude: study.attitude.as_ref(),
        }
    }

    /// Creates the monitor of the envelope, if the scenario has one.
    pub fn monitor(&self, seed: Seed) -> Option<Monitor> {
        let envelope = self.estimator.as_ref().and_then(Estimator::envelope)?;
        let learns = self.objective() == Some(Objective::EnvelopeMean);
        let search = self.searching(seed).filter(|_| learns);
        let body = match self.model.axes() {
            Axes::One(body) => return Some(Monitor::new(envelope, body, search)),
            Axes::Three(body) => body,
        };
        let point = self.study.sensed_at.first().map_or("", String::as_str);
        let rotations = body.shapes(point).into_iter().map(|(_, rotation)| rotation.norm());
        let modes: Vec<_> = body.modes.iter().cloned().zip(rotations).collect();
        Some(Monitor::of_three_axes(envelope, &modes, search))
    }

    /// Creates the meter of the adaptation's objective, if it has one other than the envelope's mean.
    pub fn meter(&self, seed: Seed) -> Option<Meter> {
        let (adaptation, objective) = (self.adaptation.as_ref()?, self.objective()?);
        let window = adaptation.window().filter(|_| objective != Objective::EnvelopeMean)?;
        let goal = self.goal();
        Some(Meter::new(objective, window, goal, self.searching(seed)?))
    }

    /// Returns the unit of the torques.
    pub fn torque_unit(&self) -> &'static str {
        self.model.commanded().1
    }
}

impl Written {
    /// Returns the objective of the adaptation, if there is one.
    pub fn objective(&self) -> Option<Objective> {
        self.adaptation.as_ref().map(Adaptation::objective)
    }

    /// Returns the initial value of the law's parameter that the adaptation tunes; `None` without an adaptation.
    pub fn tuned(&self) -> Option<f64> {
        let tunes = self.adaptation.as_ref()?.tunes();
        self.law.tunable().into_iter().find(|number| number.key == tunes).map(|number| number.value)
    }

    fn searching(&self, seed: Seed) -> Option<Searching> {
        Some(Searching::new(self.adaptation.as_ref()?, self.tuned()?, seed))
    }
}
