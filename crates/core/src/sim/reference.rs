//! Where the body shall be: on a manoeuvre and at its end, or at targets of three axes.

use std::sync::Arc;

use crate::attitude::Vector;
use crate::belief::Belief;
use crate::law::{Control, Frame, Goal, Itinerary};
use crate::scenario::Scenario;
use crate::sensor::Orientation;
use crate::time::{Instant, Span};
use crate::waveform::Waveform;
use nalgebra::Quaternion;

/// Where the body shall be.
#[derive(Clone, Debug)]
pub struct Reference {
    /// The end of the manoeuvre, or angle 0.
    pub goal: Goal,
    /// The manoeuvre.
    planned: Option<Planned>,
    /// The way to the targets of a body with three axes.
    way: Option<Itinerary>,
}

/// A manoeuvre, as a rigid body makes it.
#[derive(Clone, Debug)]
struct Planned {
    waveform: Arc<Waveform>,
    /// Angle (rad) and rate (rad/s) at which it begins.
    from: (f64, f64),
    /// What a unit of its command accelerates (kg m²).
    inertia: f64,
}

impl Planned {
    /// That of a scenario, if it has one.
    fn new(scenario: &Scenario) -> Option<Self> {
        let (manoeuvre, plan) = scenario.manoeuvre.as_ref().zip(scenario.plan.as_ref())?;
        let body = scenario.model.planar()?;
        Some(Self {
            waveform: Arc::new(plan.waveform.clone()),
            from: (body.angle.get(), body.rate.get()),
            inertia: manoeuvre.planned_for(body).commanded_inertia(),
        })
    }
}

impl Reference {
    /// That of a scenario.
    pub fn new(scenario: &Scenario) -> Self {
        Self {
            goal: scenario.goal(),
            planned: Planned::new(scenario),
            way: scenario.model.spatial().map(|_| scenario.study.way.clone()),
        }
    }

    /// Angle (rad) and rate (rad/s) where a body with one angle shall be: on the manoeuvre, where it would be if it were rigid.
    pub fn at(&self, now: Instant) -> (f64, f64) {
        match &self.planned {
            Some(Planned { waveform, from: (angle, rate), inertia }) if now < self.goal.from => {
                let t = now.seconds();
                let (travel, impulse) = (waveform.travel(0.0, t), waveform.impulse(0.0, t));
                (angle + rate * t + travel / inertia, rate + impulse / inertia)
            }
            _ => self.goal.at(now),
        }
    }

    /// What a law about an axis aims at, where the reference of three axes leads it or not: one that tracks follows the manoeuvre.
    pub fn aim(&self, law: &dyn Control, now: Instant, led: Option<Goal>) -> Goal {
        if let Some(goal) = led {
            return goal;
        }
        if now < self.goal.from && law.tracks() {
            let (angle, rate) = self.at(now);
            return Goal { from: now, angle, rate, acceleration: 0.0 };
        }
        self.goal
    }

    /// From where angles count: from the target of three axes, or from 0.
    pub fn origin(&self, now: Instant) -> Orientation {
        match &self.way {
            None => Orientation::Angle(0.0),
            Some(way) => Orientation::Attitude(way.at(now).attitude),
        }
    }

    /// Whether the target moves from one attitude to another, of three axes.
    pub fn slews(&self, now: Instant) -> bool {
        self.way.as_ref().is_some_and(|way| way.slews(now))
    }

    /// The target that the body is on its way to, of three axes, or 0.
    pub fn target(&self, now: Instant) -> Orientation {
        match &self.way {
            None => Orientation::Angle(0.0),
            Some(way) => Orientation::Attitude(way.target(now)),
        }
    }

    /// The same as it is written, of three axes: the axes that it is from, and the attitude in them.
    pub fn written(&self, now: Instant) -> Option<(Frame, Quaternion<f64>)> {
        self.way.as_ref().map(|way| way.written(now))
    }

    /// What each of three axes is led along, while the reference moves, of a body that is believed to be where it is.
    pub fn led(&self, now: Instant, beliefs: &[Belief]) -> Option<[Goal; 3]> {
        let way = self.way.as_ref().filter(|way| way.moves(now))?;
        let beyond = Vector::from_fn(|axis, _| beliefs.get(axis).map_or(0.0, |belief| belief.angle));
        let [rate, acceleration] = way.at(now).seen_from(&beyond);
        let goal =
            |axis: usize| Goal { from: now, angle: 0.0, rate: rate[axis], acceleration: acceleration[axis] };
        Some([0, 1, 2].map(goal))
    }

    /// When the origin changes after an instant: at once while the reference moves, else when the next target begins.
    pub fn next_target(&self, now: Instant) -> Option<Instant> {
        self.way.as_ref().and_then(|way| if way.moves(now) { Some(now + Span::TICK) } else { way.next(now) })
    }

    /// What the manoeuvre commands (N m).
    pub fn feedforward(&self, now: Instant) -> f64 {
        self.planned.as_ref().map_or(0.0, |planned| planned.waveform.at(now.seconds()))
    }
}
