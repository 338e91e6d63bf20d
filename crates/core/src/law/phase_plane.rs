//! The phase-plane law of a spatial body: for each axis a relay with hysteresis on the rate, and pulses of measured length.
//!
//! Seed paper 4 tells that the station's jets follow a relay law with pulse-width modulation in the phase plane; its switching
//! lines are not known. Here, about each axis, s is how far the rigid rate, what is on its way included, is from the rate that
//! the [`SwitchingLines`] want at the angle beyond the goal. Where it is further than they allow the jets fire against s, for
//! |s|/m or the whole cycle if that is longer, until it is within `switch_off` and half of what is allowed.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::damping::{Damped, Damping, DampingRelay};
use super::{Control, Phase, SwitchingLines};
use crate::actuator::Jets;
use crate::belief::AxesBelief;
use crate::body::spatial::turned;
use crate::quantity::{Finite, Fraction, Positive, Time};
use crate::time::{Instant, Span};

/// The phase-plane law.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct PhasePlane {
    /// Cycle of gyro, estimator, law and jets (s).
    pub period: Span,
    /// Half width of the angles that are left alone (rad).
    pub dead_zone: Positive,
    /// Largest rate at which the law turns the body (rad/s).
    pub rate_limit: Positive,
    /// Largest rate of the return for each unit of the angle beyond the dead zone (1/s).
    #[serde(default = "slope")]
    pub slope: Positive,
    /// Part of the jets' acceleration that slowing down may take.
    #[serde(default = "half")]
    pub braking: Fraction,
    /// The jets begin to fire where the rate is further than this from where it should be (rad/s), near and beyond the
    /// edges of the dead zone where it is less far.
    pub switch_on: Positive,
    /// They end where it is nearer than this (rad/s), at which rate the body returns at least.
    pub switch_off: Positive,
    /// Attitudes to turn to, in the order of their times; before the first it is the inertial one.
    #[serde(default)]
    pub targets: Vec<Target>,
    /// What the jets do against elastic motion while they have nothing else to do; left out, nothing.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub damping: Option<Damping>,
}

fn slope() -> Positive {
    Positive::new(0.05).unwrap_or(Positive::ONE)
}

fn half() -> Fraction {
    Fraction::HALF
}

/// An attitude to turn to: yaw, then pitch about the turned axis, then roll about the one turned twice.
#[derive(Copy, Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Target {
    /// From when on (s).
    pub from: Time,
    /// Roll (rad).
    #[serde(default)]
    pub roll: Finite,
    /// Pitch (rad).
    #[serde(default)]
    pub pitch: Finite,
    /// Yaw (rad).
    #[serde(default)]
    pub yaw: Finite,
}

impl PhasePlane {
    /// The attitude to turn to at an instant.
    pub fn target(&self, now: Instant) -> nalgebra::Quaternion<f64> {
        let begun = |target: &&Target| Instant::START + Span::from_seconds(target.from.get()) <= now;
        let target = self.targets.iter().rev().find(begun);
        let angles = target.map_or([0.0; 3], |t| [t.roll, t.pitch, t.yaw].map(Finite::get));
        turned(angles[0], angles[1], angles[2])
    }

    /// When the last target begins that does so before an instant; the start without one.
    pub fn last_target(&self, before: Instant) -> Instant {
        let begins = |target: &Target| Instant::START + Span::from_seconds(target.from.get());
        self.targets.iter().rev().map(begins).find(|from| *from < before).unwrap_or(Instant::START)
    }

    /// What single values cannot show to be wrong: a key within the law, and why.
    pub fn inconsistency(&self) -> Option<(String, String)> {
        let (on, off) = (self.switch_on.get(), self.switch_off.get());
        if off >= on {
            return Some(("switch_off".to_owned(), format!("must be below `switch_on`, {on}, got {off}")));
        }
        let late = self.targets.windows(2).position(|pair| pair[0].from >= pair[1].from)? + 1;
        let why = format!("must be later than the one before, got {}", self.targets[late].from.get());
        Some((format!("targets[{late}].from"), why))
    }
}

impl Control for PhasePlane {
    fn state(&self) -> Phase {
        Phase::Open
    }
}

/// The law at work on a body whose jets give these accelerations.
#[derive(Clone, Debug)]
pub struct PhasePlaneLaw {
    spec: PhasePlane,
    jets: Jets,
    /// Of plus and minus, about each axis (rad/s²).
    accelerations: [[f64; 2]; 3],
    lines: [SwitchingLines; 3],
    firing: [bool; 3],
    damping: Option<[DampingRelay; 3]>,
    damped: [Damped; 3],
}

impl PhasePlaneLaw {
    /// The law before its first cycle, with the thresholds of active damping (rad/s).
    pub fn new(spec: &PhasePlane, jets: &Jets, accelerations: [[f64; 2]; 3], thresholds: [f64; 3]) -> Self {
        let period = spec.period.seconds();
        let relay = |damping| thresholds.map(|threshold| DampingRelay::new(damping, jets, period, threshold));
        Self {
            damping: spec.damping.as_ref().map(relay),
            lines: accelerations.map(|accelerations| SwitchingLines::new(spec, jets, accelerations)),
            spec: spec.clone(),
            jets: jets.clone(),
            accelerations,
            firing: [false; 3],
            damped: [Damped::default(); 3],
        }
    }

    /// The attitude to turn to at an instant.
    pub fn target(&self, now: Instant) -> nalgebra::Quaternion<f64> {
        self.spec.target(now)
    }

    /// How far ahead of a sample the law wants to know the elastic rates (s).
    pub fn ahead(&self) -> f64 {
        self.damping.as_ref().map_or(0.0, |[relay, ..]| relay.ahead())
    }

    /// What active damping did in the last cycle.
    pub fn damped(&self) -> &[Damped; 3] {
        &self.damped
    }

    /// How long the jets of each axis shall fire in a cycle (s), with the sign of the rate that they push to.
    pub fn decide(&mut self, belief: &AxesBelief) -> [f64; 3] {
        std::array::from_fn(|axis| {
            let (lines, angle) = (&self.lines[axis], belief.angle[axis]);
            let excess = belief.rate[axis] + belief.queued[axis] - lines.wanted(angle);
            let allowed = lines.allowed(angle);
            let on = self.relay(axis, excess, allowed);
            let Some(damping) = &mut self.damping else { return on };
            let free = !self.firing[axis] && !is_beyond(excess, allowed);
            self.damped[axis] = damping[axis].decide(
                &belief.elastic[axis],
                [free, belief.trusted[axis]],
                (excess, allowed),
                self.accelerations[axis],
            );
            on + self.damped[axis].on
        })
    }

    fn relay(&mut self, axis: usize, excess: f64, allowed: [f64; 2]) -> f64 {
        let Self { spec, jets, accelerations, lines, firing, .. } = self;
        if is_beyond(excess, allowed) {
            firing[axis] = true;
        } else if excess.abs() < lines[axis].release(allowed[usize::from(excess < 0.0)]) {
            firing[axis] = false;
        }
        if !firing[axis] {
            return 0.0;
        }
        let [plus, minus] = accelerations[axis];
        let (sign, acceleration) = if excess > 0.0 { (-1.0, minus) } else { (1.0, plus) };
        let on = jets.on_time(excess.abs() / acceleration, spec.period.seconds());
        // What is too little for a pulse ends the firing.
        firing[axis] = on > 0.0;
        sign * on
    }
}

/// Whether a rate is further from where it should be than is allowed above and below (rad/s).
pub(super) fn is_beyond(excess: f64, [above, below]: [f64; 2]) -> bool {
    excess > above || -excess > below
}
