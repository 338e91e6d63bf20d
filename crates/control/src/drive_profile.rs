//! Angles of appendage drives over a run: in pieces of constant acceleration, or tracking the Sun.

use flexsc_dynamics::three_axis::DriveAngles;
use flexsc_numerics::attitude::Vector;
use flexsc_numerics::time::Instant;
use flexsc_numerics::time_arcs::{SplitTime, TimeArc, TimeArcs};
use flexsc_spacecraft::body::craft::DrivePiece;
use flexsc_spacecraft::environment::{OrbitEnvironment, SunPath, to_body};
use nalgebra::{Matrix3, Quaternion};

use crate::law::TargetFrame;

/// Angles of all drives over time.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct DriveProfiles {
    /// Angle of each drive.
    pub each: Vec<DriveProfile>,
    /// Upper bound of the drives' rates (rad/s).
    pub fastest: f64,
    /// Instants at which the modes are replaced or a rate changes, each with the time (s) in the middle of the interval
    /// that follows, at whose drive angles the modes are computed.
    pub changes: Vec<(Instant, f64)>,
}

/// Angle of one drive over time.
#[derive(Clone, Debug, PartialEq)]
pub enum DriveProfile {
    /// Pieces with constant acceleration.
    Pieces(Vec<DrivePiece>),
    /// Sun tracking.
    Sun(Box<SunTracking>),
}

/// Sun tracking of a drive.
#[derive(Clone, Debug, PartialEq)]
pub struct SunTracking {
    /// Environment on the orbit.
    pub sky: OrbitEnvironment,
    /// Direction to the Sun over time.
    pub sun: SunPath,
    /// Frame of the spacecraft's target.
    pub frame: TargetFrame,
    /// Target attitude in that frame.
    pub attitude: Quaternion<f64>,
    /// Axes of the appendage with the drive at angle 0, as columns in the body's axes.
    pub axes: Matrix3<f64>,
    /// Axis of the drive in the axes of the appendage.
    pub about: Vector,
    /// Normal that faces the Sun in the axes of the appendage, with the drive at angle 0.
    pub facing: Vector,
    /// Components of the Sun's direction, with their rates.
    pub arcs: TimeArcs<4>,
}

/// Error of the components up to which an arc is not halved.
const ERROR: f64 = 1e-13;

impl SunTracking {
    /// Returns the components of the direction to the Sun along the normal at drive angle 0 and at a quarter of a turn,
    /// each with its rate (1/s), at a time `t` since the start (s).
    fn sun_components(&self, t: f64) -> [[f64; 2]; 2] {
        let pose = self.frame.state_at(&self.sky, t);
        let rate: Vector = to_body(&self.attitude, &pose.rate);
        let motion = self.sun.motion(t);
        let [sun, moves]: [Vector; 2] =
            [motion.direction, motion.rate].map(|v| to_body(&(pose.attitude * self.attitude), &v));
        let (own, change) = (self.axes.tr_mul(&sun), self.axes.tr_mul(&(sun.cross(&rate) + moves)));
        let across = self.about.cross(&self.facing);
        [[self.facing.dot(&own), across.dot(&own)], [self.facing.dot(&change), across.dot(&change)]]
    }

    /// Returns the angle of the drive (rad) and its rate (rad/s) at a time `t` since the start (s).
    pub fn at(&self, t: f64) -> [f64; 2] {
        let [[x, y], [dx, dy]] = self.sun_components(t);
        angle([x, y, dx, dy])
    }

    /// Returns the angle of the drive (rad) and its rate (rad/s) at a time `t` since the start (s), from the arc about it.
    fn near(&self, t: f64) -> [f64; 2] {
        let components = |t: SplitTime| {
            let [[x, y], [dx, dy]] = self.sun_components(t.middle + t.offset);
            [x, y, dx, dy]
        };
        let span = || self.sky.span(t);
        let resolved = |_: &TimeArc<4>, tail: &[f64; 4]| tail[0].max(tail[1]) <= ERROR;
        angle(self.arcs.read(t, span, components, resolved, |arc| arc.at(t)))
    }

    /// Returns the sine of the angle between the Sun and the drive's axis at a time `t` since the start (s).
    pub fn across(&self, t: f64) -> f64 {
        let [[x, y], _] = self.sun_components(t);
        libm::hypot(x, y)
    }
}

/// Returns the angle of a drive (rad) and its rate (rad/s) from the components of the Sun's direction and their rates (1/s).
fn angle([x, y, dx, dy]: [f64; 4]) -> [f64; 2] {
    [libm::atan2(y, x), (x * dy - y * dx) / (x * x + y * y)]
}

impl DriveProfile {
    /// Returns the angle of the drive (rad) and its rate (rad/s) at a time `t` since the start (s).
    pub fn at(&self, t: f64) -> [f64; 2] {
        match self {
            Self::Sun(tracking) => tracking.near(t),
            Self::Pieces(pieces) => {
                let past = pieces.partition_point(|[from, ..]| *from <= t);
                let Some(last) = past.checked_sub(1) else {
                    return [pieces.first().map_or(0.0, |piece| piece[1]), 0.0];
                };
                let [from, angle, rate, acceleration] = pieces[last];
                let t = t - from;
                [angle + (rate + 0.5 * acceleration * t) * t, rate + acceleration * t]
            }
        }
    }
}

impl DriveAngles for DriveProfiles {
    fn at(&self, drive: usize, t: f64) -> [f64; 2] {
        self.each[drive].at(t)
    }

    fn fastest(&self) -> f64 {
        self.fastest
    }
}

impl DriveProfiles {
    /// Returns the number of drives.
    pub fn count(&self) -> usize {
        self.each.len()
    }
}
