//! What the estimator and the monitor of the envelope are told of a scenario before a run.

use super::{Scenario, Written};
use crate::adaptation::{Adaptation, Objective};
use crate::body::Axes;
use crate::estimator::{Estimator, Known, Meter, Monitor, Searching};
use crate::random::Seed;

impl Scenario {
    /// What its estimator knows before a run.
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

    /// The monitor of the envelope that it asks for, if any.
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

    /// The meter of another objective of its adaptation, if any.
    pub fn meter(&self, seed: Seed) -> Option<Meter> {
        let (adaptation, objective) = (self.adaptation.as_ref()?, self.objective()?);
        let window = adaptation.window().filter(|_| objective != Objective::EnvelopeMean)?;
        let goal = self.goal();
        Some(Meter::new(objective, window, goal, self.searching(seed)?))
    }

    /// The unit of its torques.
    pub fn torque_unit(&self) -> &'static str {
        self.model.commanded().1
    }
}

impl Written {
    /// What its adaptation measures, if it has one.
    pub fn objective(&self) -> Option<Objective> {
        self.adaptation.as_ref().map(Adaptation::objective)
    }

    /// The number of the law that its adaptation tunes, as it is at the start; none without one.
    pub fn tuned(&self) -> Option<f64> {
        let tunes = self.adaptation.as_ref()?.tunes();
        self.law.tunable().into_iter().find(|number| number.key == tunes).map(|number| number.value)
    }

    fn searching(&self, seed: Seed) -> Option<Searching> {
        Some(Searching::new(self.adaptation.as_ref()?, self.tuned()?, seed))
    }
}
