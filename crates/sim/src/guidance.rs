//! Guidance: the reference motion on a manoeuvre and at its end, or along the targets of a three-axis body.

use std::sync::Arc;

use flexsc_control::guidance::{GuidanceRun, OwnGuidance};
use flexsc_control::law::{AttitudeProfile, AttitudeTarget, ReferenceNeeds, Setpoint, TargetFrame};
use flexsc_control::operation::{ModeTarget, OperatingMode, SlewStart};
use flexsc_control::sensor::Orientation;
use flexsc_control::state_estimate::StateEstimate;
use flexsc_dynamics::waveform::Waveform;
use flexsc_numerics::attitude::Vector;
use flexsc_numerics::random::Seed;
use flexsc_numerics::time::{Instant, Span};
use flexsc_record::TargetVisit;
use flexsc_spacecraft::manoeuvre::AttitudeMotion;
use nalgebra::Quaternion;

use flexsc_scenario::Scenario;

/// Rotation (rad) between equal targets, by rounding.
const SAME_TARGET: f64 = 1e-9;

/// Reference motion of a scenario.
#[derive(Clone, Debug)]
pub struct Guidance {
    /// Setpoint after the manoeuvre; angle 0 without one.
    pub setpoint: Setpoint,
    /// Manoeuvre of a one-axis body, if there is one.
    planned: Option<PlannedManoeuvre>,
    /// Sequence of targets of a three-axis body.
    profile: Option<AttitudeProfile>,
    /// Reference motion at the instant for which it was computed last.
    computed: Option<(Instant, AttitudeMotion)>,
    /// Target of each mode of operation that has one.
    mode_targets: Vec<Option<ModeReference>>,
    /// For each mode of operation, true if its law pursues a target.
    pursuing: Vec<bool>,
    /// Index of the mode of operation, and number of its changes.
    mode: (usize, u64),
}

/// Reference of a mode of operation.
#[derive(Clone, Debug)]
enum ModeReference {
    /// Target; and for each mode before, true if a slew to it starts at the estimated attitude, and not at the reference.
    Target(Box<AttitudeTarget>, Vec<bool>),
    /// Guidance of a program.
    Own(OwnGuidance),
}

/// Manoeuvre as a rigid body executes it.
#[derive(Clone, Debug)]
struct PlannedManoeuvre {
    waveform: Arc<Waveform>,
    /// Initial angle (rad) and rate (rad/s).
    from: (f64, f64),
    /// Inertia (kg m²) that converts the waveform into acceleration.
    inertia: f64,
}

impl ModeReference {
    /// Creates the reference of a mode of operation; `None` if the reference stays.
    fn of_mode(mode: &OperatingMode, scenario: &Scenario, seed: Seed) -> Option<Self> {
        match scenario.guidance(&mode.name) {
            Some(own) => Some(Self::Own(OwnGuidance(own.start(seed)))),
            None => mode.target.as_ref().map(|target| Self::new(target, scenario)),
        }
    }

    /// Creates the reference with a target; a mode before whose law does not read the motion leaves the attitude anywhere.
    fn new(target: &ModeTarget, scenario: &Scenario) -> Self {
        let is_loose = |mode: &OperatingMode| !mode.law.offers().reads_motion();
        let starts = |mode: &OperatingMode| match target.slew_from {
            Some(start) => start == SlewStart::Estimate,
            None => is_loose(mode),
        };
        let slews = target.acceleration.is_some();
        let from_estimate = scenario.mode.iter().map(|mode| slews && starts(mode)).collect();
        Self::Target(Box::new(target.at_start()), from_estimate)
    }
}

impl PlannedManoeuvre {
    /// Creates the planned manoeuvre of a scenario; `None` without one.
    fn new(scenario: &Scenario) -> Option<Self> {
        let (manoeuvre, plan) = scenario.manoeuvre.as_ref().zip(scenario.plan.as_ref())?;
        let body = scenario.model.one_axis()?;
        Some(Self {
            waveform: Arc::new(plan.waveform.clone()),
            from: (body.angle.get(), body.rate.get()),
            inertia: manoeuvre.planned_for(body).commanded_inertia(),
        })
    }
}

impl Guidance {
    /// Creates the reference of a scenario.
    pub fn new(scenario: &Scenario, seed: Seed) -> Self {
        let mut profile = scenario.model.three_axis().map(|_| scenario.study.profile.clone());
        if let (Some(profile), Some(own)) = (&mut profile, scenario.first_guidance()) {
            profile.follow(own.start(seed), Instant::START);
        }
        Self {
            setpoint: scenario.goal(),
            planned: PlannedManoeuvre::new(scenario),
            profile,
            computed: None,
            mode_targets: scenario
                .mode
                .iter()
                .map(|mode| ModeReference::of_mode(mode, scenario, seed))
                .collect(),
            pursuing: scenario.mode.iter().map(|mode| mode.law.offers().reads_motion()).collect(),
            mode: (0, 0),
        }
    }

    /// Takes the target of a mode that begins at `now`, if it has one; returns true if it has. A slew starts at the reference,
    /// or at the estimated attitude.
    pub fn enter_mode(&mut self, now: Instant, [before, mode]: [usize; 2], estimated: &Orientation) -> bool {
        self.mode = (mode, self.mode.1 + 1);
        let reference = self.mode_targets.get(mode).and_then(Option::as_ref);
        let (Some(reference), Some(profile)) = (reference, self.profile.as_mut()) else { return false };
        match reference {
            ModeReference::Own(guidance) => profile.follow(guidance.0.copy(), now),
            ModeReference::Target(target, from_estimate) => {
                let from_estimate = from_estimate.get(before) == Some(&true);
                if let Some(attitude) = estimated.attitude().filter(|_| from_estimate) {
                    profile.hold(attitude, now);
                }
                profile.enter(target, now);
            }
        }
        self.computed = None;
        true
    }

    /// Returns the reference angle (rad) and rate (rad/s) of a one-axis body: during the manoeuvre, those of a rigid
    /// body.
    pub fn manoeuvre_state(&self, now: Instant) -> (f64, f64) {
        match &self.planned {
            Some(PlannedManoeuvre { waveform, from: (angle, rate), inertia }) if now < self.setpoint.from => {
                let t = now.seconds();
                let (travel, impulse) = (waveform.travel(0.0, t), waveform.impulse(0.0, t));
                (angle + rate * t + travel / inertia, rate + impulse / inertia)
            }
            _ => self.setpoint.at(now),
        }
    }

    /// Returns the setpoint of a law about an axis: `led`, if the three-axis reference moves; for laws that track, the state
    /// of the manoeuvre, until its end; otherwise the setpoint after the manoeuvre.
    pub fn setpoint_for(&self, needs: ReferenceNeeds, now: Instant, led: Option<Setpoint>) -> Setpoint {
        if let Some(goal) = led {
            return goal;
        }
        if now < self.setpoint.from && needs.tracks_manoeuvre {
            let (angle, rate) = self.manoeuvre_state(now);
            return Setpoint { from: now, angle, rate, acceleration: 0.0 };
        }
        self.setpoint
    }

    /// Computes the reference motion of three axes at `now`, and keeps it for all that read it at this instant.
    pub fn compute_reference(&mut self, now: Instant) {
        self.computed = self.profile.as_ref().map(|way| (now, way.at(now)));
    }

    /// Returns the reference motion of three axes; `None` for one axis.
    fn reference(&self, now: Instant) -> Option<AttitudeMotion> {
        match self.computed {
            Some((at, motion)) if at == now => Some(motion),
            _ => self.profile.as_ref().map(|way| way.at(now)),
        }
    }

    /// Returns the origin of the angles: the current reference attitude of three axes, or angle 0.
    pub fn origin(&self, now: Instant) -> Orientation {
        self.reference(now).map_or(Orientation::ZERO_ANGLE, |motion| Orientation::Attitude(motion.attitude))
    }

    /// Returns true if the target of three axes moves from one attitude to another.
    pub fn slews(&self, now: Instant) -> bool {
        self.profile.as_ref().is_some_and(|way| way.slews(now))
    }

    /// Returns the target attitude towards which a three-axis body turns; angle 0 for one axis.
    pub fn target(&self, now: Instant) -> Orientation {
        match &self.profile {
            Some(way) if way.slews(now) => Orientation::Attitude(way.target(now)),
            // The reference has arrived.
            _ => self.origin(now),
        }
    }

    /// Returns the number of the current target, which changes with the target; 0 before the first one.
    pub fn target_number(&self, now: Instant) -> usize {
        self.profile.as_ref().map_or(0, |way| way.target_number(now))
    }

    /// Returns true if the mode before pursued the present target too, where it `held` another one or this one.
    pub fn is_held(&self, before: usize, now: Instant, held: &Orientation) -> bool {
        let turn = self.target(now).error_from(held);
        self.pursuing.get(before) == Some(&true) && turn.iter().all(|angle| angle.abs() < SAME_TARGET)
    }

    /// Returns the mode of operation and the target at an instant.
    pub fn visit(&self, now: Instant) -> TargetVisit {
        let (mode, changes) = self.mode;
        TargetVisit { mode, changes, target: self.target_number(now) }
    }

    /// Returns the current target as written in the scenario: its reference frame and the attitude in it; `None` for
    /// one axis.
    pub fn target_as_written(&self, now: Instant) -> Option<(TargetFrame, Quaternion<f64>)> {
        self.profile.as_ref().map(|way| way.target_as_written(now))
    }

    /// Returns the setpoints of the three axes while the reference moves, at the estimated angles; `None` while it
    /// rests.
    pub fn reference_motion(&self, now: Instant, state_estimates: &[StateEstimate]) -> Option<[Setpoint; 3]> {
        self.profile.as_ref().filter(|way| way.is_moving(now))?;
        let beyond = Vector::from_fn(|axis, _| {
            state_estimates.get(axis).map_or(0.0, |state_estimate| state_estimate.angle)
        });
        let [rate, acceleration] = self.reference(now)?.in_body_axes(&beyond);
        let goal = |axis: usize| Setpoint {
            from: now,
            angle: 0.0,
            rate: rate[axis],
            acceleration: acceleration[axis],
        };
        Some([0, 1, 2].map(goal))
    }

    /// Returns the rate of the reference attitude (rad/s) in the axes of a body that is `error` (rad) away from it.
    pub fn reference_rate(&self, now: Instant, error: &Vector) -> Vector {
        self.reference(now).map_or_else(Vector::zeros, |motion| motion.in_body_axes(error)[0])
    }

    /// Returns the guidance of a program, if it gives the reference at an instant.
    pub fn own(&self, now: Instant) -> Option<&dyn GuidanceRun> {
        self.profile.as_ref()?.guidance(now)
    }

    /// Returns true if the largest acceleration of the reference of three axes from an instant on is not known: that of a
    /// planned command, a table or the guidance of a program.
    pub fn has_unlimited_acceleration(&self, now: Instant) -> bool {
        self.profile.as_ref().is_some_and(|way| way.has_unlimited_acceleration(now))
    }

    /// Returns the start of the next target of three axes.
    pub fn next_target(&self, now: Instant) -> Option<Instant> {
        self.profile.as_ref().and_then(|way| way.next(now))
    }

    /// Returns the size of the acceleration of the reference attitude (rad/s²).
    pub fn reference_acceleration(&self, now: Instant) -> f64 {
        self.reference(now).map_or(0.0, |motion| motion.acceleration.norm())
    }

    /// Returns the instant after `now` at which the origin changes: the next tick while the reference moves, else the
    /// start of the next target.
    pub fn next_change(&self, now: Instant) -> Option<Instant> {
        self.profile
            .as_ref()
            .and_then(|way| if way.is_moving(now) { Some(now + Span::TICK) } else { way.next(now) })
    }

    /// Returns the feedforward torque of the manoeuvre (N m).
    pub fn feedforward(&self, now: Instant) -> f64 {
        self.planned.as_ref().map_or(0.0, |planned| planned.waveform.at(now.seconds()))
    }
}
