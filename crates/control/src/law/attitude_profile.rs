//! Attitude profile from target to target: steps, slews with limits, or tables, relative to frames that may rotate.

use flexsc_dynamics::axis_model::AxisMode;
use flexsc_formats::document::ConfigError;
use flexsc_numerics::quantity::Positive;
use flexsc_numerics::time::Instant;
use flexsc_spacecraft::environment::{OrbitEnvironment, to_body};
use flexsc_spacecraft::manoeuvre::{AttitudeMotion, AttitudeTable, PlannedSlew, RateDecay, Slew};
use nalgebra::Quaternion;

use super::{AttitudeTarget, TargetFrame};
use crate::guidance::{GuidanceRun, OwnGuidance};

/// Attitude profile through targets, in the order of their times.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct AttitudeProfile {
    legs: Vec<ProfileSegment>,
    /// Sky that defines the frames of the targets.
    sky: OrbitEnvironment,
}

/// Segment of the profile to one target.
#[derive(Clone, Debug, PartialEq)]
struct ProfileSegment {
    begins: Instant,
    frame: TargetFrame,
    path: SegmentPath,
}

/// Path of a segment within its frame.
#[derive(Clone, Debug, PartialEq)]
enum SegmentPath {
    Turn(Slew),
    /// The rate of the reference decays to that of the frame before the turn.
    Moving(RateDecay, Slew),
    /// Decay of the rate, if there is one, and turn, which leave modes at rest.
    Shaped(Option<PlannedSlew>, PlannedSlew),
    Table(AttitudeTable),
    /// Motion of a guidance that another crate provides.
    Own(OwnGuidance),
}

impl SegmentPath {
    /// Returns the motion at `now`, `t` (s) after the start of the segment.
    fn at(&self, now: Instant, t: f64, sky: &OrbitEnvironment) -> AttitudeMotion {
        match self {
            Self::Own(guidance) => guidance.0.aim(now, &sky.observation(now.seconds())),
            Self::Turn(slew) => slew.at(t),
            Self::Moving(decay, slew) if t >= decay.duration() => slew.at(t - decay.duration()),
            Self::Moving(decay, _) => decay.at(t.max(0.0)),
            Self::Shaped(Some(decay), turn) if t >= decay.duration() => turn.at(t - decay.duration()),
            Self::Shaped(Some(decay), _) => decay.at(t),
            Self::Shaped(None, turn) => turn.at(t),
            Self::Table(table) => table.at(t),
        }
    }

    fn duration(&self) -> f64 {
        match self {
            Self::Turn(slew) => slew.duration(),
            Self::Moving(decay, slew) => decay.duration() + slew.duration(),
            Self::Shaped(decay, turn) => decay.as_ref().map_or(0.0, PlannedSlew::duration) + turn.duration(),
            Self::Table(table) => table.duration(),
            Self::Own(_) => 0.0,
        }
    }

    /// Returns the attitude at the end; of a guidance, at `now`.
    fn to(&self, now: Instant, sky: &OrbitEnvironment) -> Quaternion<f64> {
        match self {
            Self::Own(_) => self.at(now, 0.0, sky).attitude,
            Self::Turn(slew) | Self::Moving(_, slew) => slew.final_attitude(),
            Self::Shaped(_, turn) => turn.to(),
            Self::Table(table) => table.final_attitude(),
        }
    }
}

impl AttitudeProfile {
    /// Creates the profile through these targets under a sky, of a body with these modes. Before the first target the
    /// attitude is inertial; a slew starts at the reference of its start time, with its rate.
    pub fn new(targets: &[AttitudeTarget], sky: &OrbitEnvironment, modes: &[AxisMode]) -> Self {
        // Targets whose slews cannot be planned were rejected before.
        Self::from_targets(targets, sky, modes).unwrap_or_default()
    }

    /// Creates the profile, or returns the key of a target that does not fit the modes.
    fn from_targets(
        targets: &[AttitudeTarget],
        sky: &OrbitEnvironment,
        modes: &[AxisMode],
    ) -> Result<Self, ConfigError> {
        let mut profile = Self { legs: Vec::new(), sky: sky.clone() };
        for (index, target) in targets.iter().enumerate() {
            let (begins, frame) = (target.starts(), target.target_frame());
            let path = if target.is_shaped() {
                let from = profile.relative_to(frame, begins);
                let planned = target.slew(&from, modes);
                let (decay, turn) = planned.map_err(|fault| fault.within(&format!("[{index}]")))?;
                SegmentPath::Shaped(decay, turn)
            } else if target.table.is_empty() {
                turn_to(target, || profile.relative_to(frame, begins))
            } else {
                SegmentPath::Table(AttitudeTable::new(&target.table))
            };
            profile.legs.push(ProfileSegment { begins, frame, path });
        }
        Ok(profile)
    }

    /// Adds a target from `now` on, later than all others; it has no planned command and no table.
    pub fn enter(&mut self, target: &AttitudeTarget, now: Instant) {
        let frame = target.target_frame();
        let from = self.relative_to(frame, now);
        let path = turn_to(target, || from);
        self.legs.push(ProfileSegment { begins: now, frame, path });
    }

    /// Adds an attitude in inertial axes from `now` on, later than all others.
    pub fn hold(&mut self, attitude: Quaternion<f64>, now: Instant) {
        let path = SegmentPath::Turn(Slew::instantaneous(attitude));
        self.legs.push(ProfileSegment { begins: now, frame: TargetFrame::INERTIAL, path });
    }

    /// Adds a guidance from `now` on, later than all targets.
    pub fn follow(&mut self, guidance: Box<dyn GuidanceRun>, now: Instant) {
        let path = SegmentPath::Own(OwnGuidance(guidance));
        self.legs.retain(|leg| leg.begins < now);
        self.legs.push(ProfileSegment { begins: now, frame: TargetFrame::INERTIAL, path });
    }

    /// Returns the guidance that another crate provides, if it gives the reference at an instant.
    pub fn guidance(&self, now: Instant) -> Option<&dyn GuidanceRun> {
        match &self.leg(now)?.path {
            SegmentPath::Own(guidance) => Some(&*guidance.0),
            _ => None,
        }
    }

    /// Returns the largest rate of the slew to a target (rad/s), if it is planned for modes.
    pub fn fastest(&self, target: usize) -> Option<f64> {
        match &self.legs.get(target)?.path {
            SegmentPath::Shaped(decay, turn) => {
                Some(decay.as_ref().map_or(0.0, PlannedSlew::fastest).max(turn.fastest()))
            }
            _ => None,
        }
    }

    /// Returns attitude and rate of the profile at an instant relative to a frame; the acceleration is left out.
    fn relative_to(&self, frame: TargetFrame, now: Instant) -> AttitudeMotion {
        let current = self.at(now);
        if frame == TargetFrame::INERTIAL {
            return current;
        }
        let axes = frame.state_at(&self.sky, now.seconds());
        let attitude = axes.attitude.conjugate() * current.attitude;
        let rate = current.rate - to_body(&attitude, &axes.rate);
        AttitudeMotion { rate, ..AttitudeMotion::at_rest(attitude) }
    }

    fn leg(&self, now: Instant) -> Option<&ProfileSegment> {
        self.legs.iter().rev().find(|leg| leg.begins <= now)
    }

    /// Returns the reference attitude with its rate and acceleration at an instant.
    pub fn at(&self, now: Instant) -> AttitudeMotion {
        self.leg(now).map_or_else(
            || AttitudeMotion::at_rest(AttitudeTarget::INERTIAL.attitude()),
            |leg| {
                self.to_inertial(leg.frame, now, leg.path.at(now, now.since(leg.begins).seconds(), &self.sky))
            },
        )
    }

    /// Converts a pose in a frame to inertial axes.
    fn to_inertial(&self, frame: TargetFrame, now: Instant, pose: AttitudeMotion) -> AttitudeMotion {
        if frame == TargetFrame::INERTIAL {
            return pose;
        }
        pose.compose(&frame.state_at(&self.sky, now.seconds()))
    }

    /// Returns the attitude of the current target at an instant.
    pub fn target(&self, now: Instant) -> Quaternion<f64> {
        let frame_motion = |leg: &ProfileSegment| {
            self.to_inertial(leg.frame, now, AttitudeMotion::at_rest(leg.path.to(now, &self.sky))).attitude
        };
        self.leg(now).map_or_else(|| AttitudeTarget::INERTIAL.attitude(), frame_motion)
    }

    /// Returns the number of the current target, counted from 1; 0 before the first one.
    pub fn target_number(&self, now: Instant) -> usize {
        self.legs.iter().rposition(|leg| leg.begins <= now).map_or(0, |index| index + 1)
    }

    /// Returns the current target as written: the frame, and the attitude in it.
    pub fn target_as_written(&self, now: Instant) -> (TargetFrame, Quaternion<f64>) {
        let leg = self.leg(now);
        leg.map_or_else(
            || (TargetFrame::INERTIAL, AttitudeTarget::INERTIAL.attitude()),
            |leg| (leg.frame, leg.path.to(now, &self.sky)),
        )
    }

    /// Returns the start time of the next target after an instant.
    pub fn next(&self, now: Instant) -> Option<Instant> {
        self.legs.iter().map(|leg| leg.begins).find(|begins| *begins > now)
    }

    /// Returns true if an instant is in a motion that no acceleration of a target limits: a planned command, a table, or the
    /// guidance of a program.
    pub fn has_unlimited_acceleration(&self, now: Instant) -> bool {
        self.leg(now).is_some_and(|leg| match &leg.path {
            SegmentPath::Own(_) => true,
            SegmentPath::Shaped(..) | SegmentPath::Table(_) => {
                now.since(leg.begins).seconds() < leg.path.duration()
            }
            SegmentPath::Turn(_) | SegmentPath::Moving(..) => false,
        })
    }

    /// Returns true if the reference moves at an instant.
    pub fn is_moving(&self, now: Instant) -> bool {
        self.leg(now).is_some_and(|leg| {
            let is_guided = matches!(leg.path, SegmentPath::Own(_));
            is_guided || leg.frame.rotates(&self.sky) || now.since(leg.begins).seconds() < leg.path.duration()
        })
    }

    /// Whether the target moves within its frame at an instant, from one attitude to another.
    pub fn slews(&self, now: Instant) -> bool {
        self.leg(now).is_some_and(|leg| now.since(leg.begins).seconds() < leg.path.duration())
    }

    /// True if the target moves at any time.
    pub fn has_slews(&self) -> bool {
        self.legs.iter().any(|leg| leg.path.duration() > 0.0)
    }

    /// Checks the targets: frames that are not defined, inconsistent keys, or a start before the end of the previous
    /// slew. Returns the first such key and the reason.
    pub fn validate(
        targets: &[AttitudeTarget],
        sky: &OrbitEnvironment,
        modes: &[AxisMode],
    ) -> Option<ConfigError> {
        for (index, target) in targets.iter().enumerate() {
            if let Some(fault) = target.validate(sky) {
                return Some(fault.within(&format!("[{index}]")));
            }
        }
        let profile = match Self::from_targets(targets, sky, modes) {
            Ok(profile) => profile,
            Err(fault) => return Some(fault),
        };
        for (index, pair) in profile.legs.windows(2).enumerate() {
            let ends = pair[0].begins.seconds() + pair[0].path.duration();
            if pair[1].begins.seconds() < ends {
                let why = format!(
                    "must not be before the end of the previous turn, {ends:.3} s, got {}",
                    pair[1].begins.seconds()
                );
                return Some(ConfigError::new(format!("[{}].from", index + 1), why));
            }
        }
        None
    }
}

/// Returns the path to a target from a motion in its frame.
fn turn_to(target: &AttitudeTarget, from: impl FnOnce() -> AttitudeMotion) -> SegmentPath {
    let to = target.attitude();
    let rate_limit = target.rate_limit.map_or(f64::INFINITY, Positive::get);
    let Some(acceleration) = target.acceleration.map(Positive::get) else {
        return SegmentPath::Turn(Slew::instantaneous(to));
    };
    let AttitudeMotion { attitude, rate, .. } = from();
    let slew = |from| Slew::new([from, to], acceleration, rate_limit, target.profile);
    match RateDecay::new(attitude, &rate, acceleration, target.profile) {
        None => SegmentPath::Turn(slew(attitude)),
        Some(decay) => {
            let slew = slew(decay.final_attitude());
            SegmentPath::Moving(decay, slew)
        }
    }
}

#[cfg(test)]
mod tests;
