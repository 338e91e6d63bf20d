//! Guidance: the reference motion on a manoeuvre and at its end, or along the targets of a three-axis body.

use std::sync::Arc;

use crate::attitude::Vector;
use crate::belief::Belief;
use crate::law::{Control, Frame, Goal, Itinerary};
use crate::scenario::Scenario;
use crate::sensor::Orientation;
use crate::time::{Instant, Span};
use crate::waveform::Waveform;
use nalgebra::Quaternion;

/// Reference motion of a scenario.
#[derive(Clone, Debug)]
pub struct Reference {
    /// Setpoint after the manoeuvre; angle 0 without one.
    pub goal: Goal,
    /// Manoeuvre of a one-axis body, if there is one.
    planned: Option<Planned>,
    /// Sequence of targets of a three-axis body.
    way: Option<Itinerary>,
}

/// Manoeuvre as a rigid body executes it.
#[derive(Clone, Debug)]
struct Planned {
    waveform: Arc<Waveform>,
    /// Initial angle (rad) and rate (rad/s).
    from: (f64, f64),
    /// Inertia (kg m²) that converts the waveform into acceleration.
    inertia: f64,
}

impl Planned {
    /// Creates the planned manoeuvre of a scenario; `None` without one.
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
    /// Creates the reference of a scenario.
    pub fn new(scenario: &Scenario) -> Self {
        Self {
            goal: scenario.goal(),
            planned: Planned::new(scenario),
            way: scenario.model.spatial().map(|_| scenario.study.way.clone()),
        }
    }

    /// Returns the reference angle (rad) and rate (rad/s) of a one-axis body: during the manoeuvre, those of a rigid
    /// body.
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

    /// Returns the setpoint of a law about an axis: `led` if the three-axis reference moves; the manoeuvre for laws
    /// that track; else the goal.
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

    /// Returns the origin of the angles: the current reference attitude of three axes, or angle 0.
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

    /// Returns the target attitude towards which a three-axis body turns; angle 0 for one axis.
    pub fn target(&self, now: Instant) -> Orientation {
        match &self.way {
            None => Orientation::Angle(0.0),
            Some(way) => Orientation::Attitude(way.target(now)),
        }
    }

    /// Returns the current target as written in the scenario: its reference frame and the attitude in it; `None` for
    /// one axis.
    pub fn written(&self, now: Instant) -> Option<(Frame, Quaternion<f64>)> {
        self.way.as_ref().map(|way| way.written(now))
    }

    /// Returns the setpoints of the three axes while the reference moves, at the estimated angles; `None` while it
    /// rests.
    pub fn led(&self, now: Instant, beliefs: &[Belief]) -> Option<[Goal; 3]> {
        let way = self.way.as_ref().filter(|way| way.moves(now))?;
        let beyond = Vector::from_fn(|axis, _| beliefs.get(axis).map_or(0.0, |belief| belief.angle));
        let [rate, acceleration] = way.at(now).seen_from(&beyond);
        let goal =
            |axis: usize| Goal { from: now, angle: 0.0, rate: rate[axis], acceleration: acceleration[axis] };
        Some([0, 1, 2].map(goal))
    }

    /// Returns the instant after `now` at which the origin changes: the next tick while the reference moves, else the
    /// start of the next target.
    pub fn next_target(&self, now: Instant) -> Option<Instant> {
        self.way.as_ref().and_then(|way| if way.moves(now) { Some(now + Span::TICK) } else { way.next(now) })
    }

    /// Returns the feedforward torque of the manoeuvre (N m).
    pub fn feedforward(&self, now: Instant) -> f64 {
        self.planned.as_ref().map_or(0.0, |planned| planned.waveform.at(now.seconds()))
    }
}
