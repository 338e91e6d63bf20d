//! Attitude profile from target to target: steps, slews with limits, or tables, relative to frames that may rotate.

use flexsc_dynamics::axis_model::AxisMode;
use flexsc_formats::document::ConfigError;
use flexsc_numerics::quantity::Positive;
use flexsc_numerics::time::Instant;
use flexsc_spacecraft::environment::OrbitEnvironment;
use flexsc_spacecraft::manoeuvre::{AttitudeMotion, AttitudeTable, PlannedSlew, Slew};
use nalgebra::Quaternion;

use super::{AttitudeTarget, TargetFrame};

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
    Shaped(PlannedSlew),
    Table(AttitudeTable),
}

impl SegmentPath {
    fn at(&self, t: f64) -> AttitudeMotion {
        match self {
            Self::Turn(slew) => slew.at(t),
            Self::Shaped(turn) => turn.at(t),
            Self::Table(table) => table.at(t),
        }
    }

    fn duration(&self) -> f64 {
        match self {
            Self::Turn(slew) => slew.duration(),
            Self::Shaped(turn) => turn.duration(),
            Self::Table(table) => table.duration(),
        }
    }

    fn to(&self) -> Quaternion<f64> {
        match self {
            Self::Turn(slew) => slew.final_attitude(),
            Self::Shaped(turn) => turn.to(),
            Self::Table(table) => table.final_attitude(),
        }
    }
}

impl AttitudeProfile {
    /// Creates the profile through these targets under a sky, of a body with these modes. Before the first target the
    /// attitude is inertial; a slew starts at the reference of its start time.
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
                let attitudes = [profile.relative_to(frame, begins), target.attitude()];
                let turn =
                    target.slew(attitudes, modes).map_err(|fault| fault.within(&format!("[{index}]")))?;
                SegmentPath::Shaped(turn)
            } else if target.table.is_empty() {
                SegmentPath::Turn(turn_to(target, || profile.relative_to(frame, begins)))
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
        let path = SegmentPath::Turn(turn_to(target, || from));
        self.legs.push(ProfileSegment { begins: now, frame, path });
    }

    /// Adds an attitude in inertial axes from `now` on, later than all others.
    pub fn hold(&mut self, attitude: Quaternion<f64>, now: Instant) {
        let path = SegmentPath::Turn(Slew::instantaneous(attitude));
        self.legs.push(ProfileSegment { begins: now, frame: TargetFrame::INERTIAL, path });
    }

    /// Returns the largest rate of the slew to a target (rad/s), if it is planned for modes.
    pub fn fastest(&self, target: usize) -> Option<f64> {
        match &self.legs.get(target)?.path {
            SegmentPath::Shaped(turn) => Some(turn.fastest()),
            _ => None,
        }
    }

    /// Returns the attitude of the profile at an instant relative to a frame.
    fn relative_to(&self, frame: TargetFrame, now: Instant) -> Quaternion<f64> {
        let current = self.at(now).attitude;
        if frame == TargetFrame::INERTIAL {
            return current;
        }
        frame.state_at(&self.sky, now.seconds()).attitude.conjugate() * current
    }

    fn leg(&self, now: Instant) -> Option<&ProfileSegment> {
        self.legs.iter().rev().find(|leg| leg.begins <= now)
    }

    /// Returns the reference attitude with its rate and acceleration at an instant.
    pub fn at(&self, now: Instant) -> AttitudeMotion {
        self.leg(now).map_or_else(
            || AttitudeMotion::at_rest(AttitudeTarget::INERTIAL.attitude()),
            |leg| self.to_inertial(leg.frame, now, leg.path.at(now.since(leg.begins).seconds())),
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
            self.to_inertial(leg.frame, now, AttitudeMotion::at_rest(leg.path.to())).attitude
        };
        self.leg(now).map_or_else(|| AttitudeTarget::INERTIAL.attitude(), frame_motion)
    }

    /// Returns the current target as written: the frame, and the attitude in it.
    pub fn target_as_written(&self, now: Instant) -> (TargetFrame, Quaternion<f64>) {
        let leg = self.leg(now);
        leg.map_or_else(
            || (TargetFrame::INERTIAL, AttitudeTarget::INERTIAL.attitude()),
            |leg| (leg.frame, leg.path.to()),
        )
    }

    /// Returns the start time of the next target after an instant.
    pub fn next(&self, now: Instant) -> Option<Instant> {
        self.legs.iter().map(|leg| leg.begins).find(|begins| *begins > now)
    }

    /// Returns true if the reference moves at an instant.
    pub fn is_moving(&self, now: Instant) -> bool {
        self.leg(now).is_some_and(|leg| {
            leg.frame.rotates(&self.sky) || now.since(leg.begins).seconds() < leg.path.duration()
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

/// Returns the turn to a target from an attitude in its frame.
fn turn_to(target: &AttitudeTarget, from: impl FnOnce() -> Quaternion<f64>) -> Slew {
    let to = target.attitude();
    let rate_limit = target.rate_limit.map_or(f64::INFINITY, Positive::get);
    match target.acceleration {
        None => Slew::instantaneous(to),
        Some(acceleration) => Slew::new([from(), to], acceleration.get(), rate_limit, target.profile),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use flexsc_numerics::attitude::Vector;
    use flexsc_numerics::time::Span;

    fn targets(text: &str) -> Vec<AttitudeTarget> {
        #[derive(serde::Deserialize)]
        struct Of {
            target: Vec<AttitudeTarget>,
        }
        flexsc_formats::document::from_text::<Of>(text).unwrap().target
    }

    fn at(seconds: f64) -> Instant {
        Instant::START + Span::from_seconds(seconds)
    }

    #[test]
    fn a_target_is_reached_at_once_or_along_a_turn() {
        let two = targets(
            "target = [{ from = 10.0, yaw = 0.5 }, { from = 20.0, yaw = 0.9, acceleration = 2e-3, rate_limit = 0.02 }]",
        );
        let sky = OrbitEnvironment::default();
        assert_eq!(AttitudeProfile::validate(&two, &sky, &[]), None);
        let profile = AttitudeProfile::new(&two, &sky, &[]);
        let yaw = |seconds: f64| flexsc_numerics::attitude::angles(&profile.at(at(seconds)).attitude)[2];
        // The rate is 0.02 rad/s after 10 s; 0.4 rad take 30 s.
        for (seconds, exact) in
            [(9.0, 0.0), (10.0, 0.5), (20.0, 0.5), (30.0, 0.6), (35.0, 0.7), (50.0, 0.9), (90.0, 0.9)]
        {
            assert!((yaw(seconds) - exact).abs() < 1e-15, "{seconds} {}", yaw(seconds));
        }
        assert!((profile.at(at(25.0)).rate.z - 0.01).abs() < 1e-15);
        assert!((profile.at(at(45.0)).acceleration.z + 2e-3).abs() < 1e-15);
        let moving = [9.0, 10.0, 15.0, 20.0, 49.0, 51.0].map(|seconds| profile.is_moving(at(seconds)));
        assert_eq!(moving, [false, false, false, true, true, false]);
    }

    #[test]
    fn targets_that_do_not_fit_are_refused() {
        let fault = |text: &str| {
            AttitudeProfile::validate(&targets(text), &OrbitEnvironment::default(), &[]).unwrap().to_string()
        };
        let soon = fault(
            "target = [{ from = 0, yaw = 0.4, acceleration = 2e-3, rate_limit = 0.02 }, { from = 29.0 }]",
        );
        assert!(
            soon.starts_with("`[1].from` must not be before the end of the previous turn, 30.000 s"),
            "{soon}"
        );
        assert!(
            fault("target = [{ from = 0, yaw = 0.4, rate_limit = 0.02 }]")
                .starts_with("`[0].rate_limit` needs")
        );
        assert!(fault("target = [{ from = 0, profile = \"versine\" }]").starts_with("`[0].profile` needs"));
    }

    #[test]
    fn a_target_of_the_orbit_turns_with_it_and_is_reached_from_where_the_body_was() {
        let environment = flexsc_formats::document::from_text(
            "orbit = { semi_major_axis = 8e6, eccentricity = 0.1, inclination = 1.2 }\nsun = [1, 2, 3]",
        );
        let sky = OrbitEnvironment::new(&environment.unwrap(), Span::from_seconds(1e4), None);
        let profile_targets = targets(
            "target = [{ from = 0, frame = \"sun\", yaw = 0.3 }, { from = 50, frame = \"nadir\", roll = 0.2, acceleration = 2e-3 }, \
             { from = 400, frame = \"nadir\", table = [{ time = 0, roll = 0.2 }, { time = 20, pitch = 0.4 }, { time = 60, yaw = -0.3 }] }]",
        );
        assert_eq!(AttitudeProfile::validate(&profile_targets, &sky, &[]), None);
        let profile = AttitudeProfile::new(&profile_targets, &sky, &[]);
        let direction = |seconds: f64, axis: Vector| -> Vector {
            let q = profile.at(at(seconds)).attitude;
            (q * Quaternion::from_imag(axis) * q.conjugate()).vector().into_owned()
        };
        assert!((direction(10.0, Vector::z()) - Vector::new(1.0, 2.0, 3.0).normalize()).norm() < 1e-15);
        assert!(!profile.is_moving(at(10.0)) && profile.is_moving(at(60.0)) && profile.is_moving(at(390.0)));
        // The slew starts at the previous target.
        assert!((profile.at(at(50.0)).attitude - profile.at(at(49.999_999_999)).attitude).norm() < 1e-9);
        // At its end the body's z is 0.2 rad from the nadir about the local x.
        let local = sky.position(390.0).unwrap().local;
        assert!((direction(390.0, Vector::x()) - local[0]).norm() < 1e-14);
        assert!((direction(390.0, Vector::z()).dot(&local[2]) - libm::cos(0.2)).abs() < 1e-14);
        // Rate and acceleration are derivatives: during the slew, along the orbit and through the table.
        let h = 1e-3;
        for seconds in [60.0, 150.0, 390.0, 410.0, 435.0, 470.0] {
            let [before, now, after] = [seconds - h, seconds, seconds + h].map(|t| profile.at(at(t)));
            let turn = (before.attitude.conjugate() * after.attitude).vector() * 2.0;
            assert!((turn / (2.0 * h) - now.rate).norm() < 1e-9, "{seconds}");
            let change = (after.rate - before.rate) / (2.0 * h);
            assert!((change - now.acceleration).norm() < 1e-8, "{seconds}");
        }
        assert!(
            (profile.at(at(390.0)).rate.norm() - sky.position(390.0).unwrap().turning[0].norm()).abs()
                < 1e-15
        );
    }

    #[test]
    fn a_target_of_the_sun_follows_its_motion() {
        let environment = flexsc_formats::document::from_text("sun = \"epoch\"");
        // Seconds from 1970 to 2027-01-03T12:00:00Z.
        let epoch = Some(1_798_977_600_000_000_000);
        let sky = OrbitEnvironment::new(&environment.unwrap(), Span::from_seconds(1e7), epoch);
        let targets = targets("target = [{ from = 0, frame = \"sun\", yaw = 0.3, pitch = 0.1 }]");
        let profile = AttitudeProfile::new(&targets, &sky, &[]);
        assert!(profile.is_moving(at(1e6)));
        let h = 2e3;
        for seconds in [1e5, 3e6, 9e6] {
            let [before, now, after] = [seconds - h, seconds, seconds + h].map(|t| profile.at(at(t)));
            let turn = (before.attitude.conjugate() * after.attitude).vector() * 2.0;
            // The Sun's rate is 2e-7 rad/s, and the rate of the obliquity, 8e-14 rad/s, is not in that of the axes.
            let off = (turn / (2.0 * h) - now.rate).norm();
            assert!(off < 2e-13, "{seconds} {off:e}");
            assert!(now.rate.norm() > 1.7e-7 && now.rate.norm() < 2.4e-7, "{seconds}");
            let change = (after.rate - before.rate) / (2.0 * h);
            assert!(
                (change - now.acceleration).norm() < 1e-19,
                "{seconds} {:e}",
                (change - now.acceleration).norm()
            );
        }
    }

    #[test]
    fn a_frame_that_is_not_there_is_refused() {
        let fault = |text: &str| {
            AttitudeProfile::validate(&targets(text), &OrbitEnvironment::default(), &[]).unwrap().to_string()
        };
        assert!(
            fault("target = [{ from = 0, frame = \"nadir\" }]")
                .starts_with("`[0].frame` points to the planet")
        );
        assert!(
            fault("target = [{ from = 0, frame = \"sun\" }]")
                .starts_with("`[0].frame` points to `environment.sun`")
        );
        assert!(
            fault("target = [{ from = 0, yaw = 1, table = [{ time = 0 }, { time = 1 }] }]")
                .starts_with("`[0].yaw` must be left out")
        );
        assert!(
            fault("target = [{ from = 0, table = [{ time = 0 }] }]")
                .starts_with("`[0].table` must have at least two")
        );
    }
}
