//! Drive of an appendage: the axis about which it turns during a run, and its angle as a function of time.

use flexsc_formats::document::ConfigError;
use flexsc_numerics::attitude::{Vector, vector};
use flexsc_numerics::quantity::{Finite, NonNegative, Positive};
use nalgebra::Matrix3;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A drive.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(rename = "Drive")]
pub struct AppendageDrive {
    /// Axis through the root, in the axes of the appendage, of any nonzero length.
    pub about: [Finite; 3],
    /// Angle at the start (rad); at 0 the appendage has the orientation given by `turned`.
    #[serde(default)]
    pub angle: Finite,
    /// Constant rate of the drive (rad/s).
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub rate: Option<Finite>,
    /// Time at which it begins to turn (s); default: the start of the run.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub from: Option<NonNegative>,
    /// Time at which it begins to stop (s); default: it does not stop.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub until: Option<NonNegative>,
    /// Acceleration with which its rate changes (rad/s²), which rounds the corners of a table; default: the rate
    /// jumps, and excites the modes and the hub.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub acceleration: Option<Positive>,
    /// Table of angles over time, with constant rates between the points, at rest before the first and after the
    /// last.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub table: Vec<DrivePoint>,
    /// Object that the drive tracks.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub track: Option<TrackedObject>,
    /// Direction that is turned to the Sun, in the axes of the appendage, perpendicular to the drive's axis; default: z.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub normal: Option<[Finite; 3]>,
}

/// An angle at a time.
#[derive(Copy, Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct DrivePoint {
    /// Time since the start (s).
    pub time: NonNegative,
    /// Angle (rad).
    pub angle: Finite,
}

/// Object that a drive tracks.
#[derive(Copy, Clone, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
#[schemars(rename = "Track")]
pub enum TrackedObject {
    /// The Sun, as seen from a spacecraft that points exactly at its target.
    Sun,
}

/// Piece of a drive's profile: start time (s), with angle (rad), rate (rad/s) and constant acceleration (rad/s²) there.
pub type DrivePiece = [f64; 4];

/// Largest angle of a drive at the start (rad).
const MOST_ANGLE: f64 = 100.0;

impl AppendageDrive {
    /// Returns the unit vector along the drive's axis, in the axes of the appendage.
    pub fn axis(&self) -> Vector {
        vector(&self.about).normalize()
    }

    /// Returns the direction to turn to the Sun, a unit vector in the axes of the appendage.
    pub fn sun_facing(&self) -> Vector {
        self.normal.as_ref().map_or_else(Vector::z, |normal| vector(normal).normalize())
    }

    /// Returns the rotation by an angle (rad) about the drive's axis.
    pub fn rotation(&self, angle: f64) -> Matrix3<f64> {
        let axis = self.axis();
        let (sin, cos) = libm::sincos(angle);
        (1.0 - cos) * axis * axis.transpose() + cos * Matrix3::identity() + sin * axis.cross_matrix()
    }

    /// Checks the drive for values that are inconsistent with each other.
    ///
    /// # Errors
    /// A key within the drive, and the reason.
    pub fn validate(&self) -> Result<(), ConfigError> {
        let length = vector(&self.about).norm();
        if !(1e-6..=1e6).contains(&length) {
            return Err(ConfigError::new(
                "about",
                format!("must have a length of 1e-6 to 1e6, got {length}"),
            ));
        }
        if self.angle.get().abs() > MOST_ANGLE {
            let why =
                format!("must be an angle of -{MOST_ANGLE} to {MOST_ANGLE} rad, got {}", self.angle.get());
            return Err(ConfigError::new("angle", why));
        }
        let motions = [self.rate.is_some(), !self.table.is_empty(), self.track.is_some()];
        if motions.iter().filter(|is_given| **is_given).count() != 1 {
            let why = "needs exactly one of `rate`, `table` and `track`";
            return Err(ConfigError::new("", why));
        }
        let other_keys = [
            ("angle", self.angle.get() != 0.0, self.rate.is_some()),
            ("from", self.from.is_some(), self.rate.is_some()),
            ("until", self.until.is_some(), self.rate.is_some()),
            ("acceleration", self.acceleration.is_some(), self.track.is_none()),
            ("normal", self.normal.is_some(), self.track.is_some()),
        ];
        if let Some((key, ..)) = other_keys.into_iter().find(|(_, is_given, fits)| *is_given && !fits) {
            let with = match key {
                "normal" => "`track`",
                "acceleration" => "`rate` or `table`",
                _ => "`rate`",
            };
            return Err(ConfigError::new(key, format!("needs {with}")));
        }
        if let Some(normal) = &self.normal {
            let normal = vector(normal);
            let across = normal.norm() > 1e-6 && normal.normalize().dot(&self.axis()).abs() < 1e-6;
            if !across {
                return Err(ConfigError::new(
                    "normal",
                    "must be perpendicular to `about`: the drive cannot change its component along `about`",
                ));
            }
        } else if self.track.is_some() && self.axis().z.abs() > 1e-6 {
            return Err(ConfigError::new(
                "normal",
                "must be given if the drive's axis is not perpendicular to z",
            ));
        }
        self.fits_in_time()
    }

    /// Checks that each change of the rate begins after the previous one has ended.
    fn fits_in_time(&self) -> Result<(), ConfigError> {
        for (index, pair) in self.table.windows(2).enumerate() {
            let [before, after] = [pair[0].time.get(), pair[1].time.get()];
            if after <= before {
                let why = format!("must be after the time before, {before}, got {after}");
                return Err(ConfigError::new(format!("table[{}].time", index + 1), why));
            }
        }
        if self.table.len() == 1 {
            return Err(ConfigError::new("table", "must have at least two points"));
        }
        let pieces = self.profile();
        if let Some(pair) = pieces.windows(2).find(|pair| pair[1][0] < pair[0][0]) {
            let why = format!(
                "is too small: the change of the rate that begins at {:.3} s has not ended when the next begins, at {:.3} s",
                pair[0][0].min(pair[1][0]),
                pair[1][0].max(pair[0][0])
            );
            let key = if self.acceleration.is_some() { "acceleration" } else { "until" };
            return Err(ConfigError::new(key, why));
        }
        if pieces.first().is_some_and(|first| first[0] < 0.0) {
            let why = "is too small: the rate would have to change before the start";
            return Err(ConfigError::new("acceleration", why));
        }
        Ok(())
    }

    /// Returns the profile of a drive that tracks no object; before the first piece the drive rests at that piece's
    /// angle.
    pub fn profile(&self) -> Vec<DrivePiece> {
        // Each change of the rate: its time (s) and the new rate (rad/s).
        let changes: Vec<[f64; 2]> = if let Some(rate) = self.rate {
            let from = self.from.map_or(0.0, NonNegative::get);
            let until = self.until.map(|until| [until.get(), 0.0]);
            std::iter::once([from, rate.get()]).chain(until).collect()
        } else {
            let slope = |pair: &[DrivePoint]| {
                let [time, angle] =
                    [pair[1].time.get() - pair[0].time.get(), pair[1].angle.get() - pair[0].angle.get()];
                [pair[0].time.get(), angle / time]
            };
            let last = self.table.last().map(|last| [last.time.get(), 0.0]);
            self.table.windows(2).map(slope).chain(last).collect()
        };
        let start = self.table.first().map_or(self.angle.get(), |first| first.angle.get());
        // A drive that turns from the start on has turned before too.
        let mut now: DrivePiece = [0.0, start, 0.0, 0.0];
        let mut pieces = Vec::new();
        for (index, [time, rate]) in changes.into_iter().enumerate() {
            let change = rate - now[2];
            let lasts = match self.acceleration {
                Some(acceleration) if index > 0 || time > 0.0 => change.abs() / acceleration.get(),
                _ => 0.0,
            };
            // In a table, half of the change of rate is before the point.
            let begins = if self.rate.is_some() { time } else { time - 0.5 * lasts };
            if index == 0 {
                now[0] = begins;
            }
            let angle = now[1] + now[2] * (begins - now[0]);
            if lasts > 0.0 {
                pieces.push([begins, angle, now[2], change / lasts]);
            }
            now = [begins + lasts, angle + (now[2] + 0.5 * change) * lasts, rate, 0.0];
            pieces.push(now);
        }
        pieces
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn drive(text: &str) -> AppendageDrive {
        toml::from_str(&format!("about = [0, 2, 0]\n{text}")).unwrap()
    }

    #[test]
    fn rates_begin_and_end_along_a_trapezium() {
        let pieces = drive("rate = 0.02\nfrom = 10\nuntil = 40\nacceleration = 0.002\nangle = 0.1").profile();
        let near = |a: &DrivePiece, b: DrivePiece| a.iter().zip(b).all(|(a, b)| (a - b).abs() < 1e-15);
        let expected: [DrivePiece; 4] = [
            [10.0, 0.1, 0.0, 0.002],
            [20.0, 0.2, 0.02, 0.0],
            [40.0, 0.6, 0.02, -0.002],
            [50.0, 0.7, 0.0, 0.0],
        ];
        assert!(pieces.len() == 4 && pieces.iter().zip(expected).all(|(a, b)| near(a, b)), "{pieces:?}");
    }

    #[test]
    fn tables_are_met_and_their_corners_rounded() {
        let table =
            "table = [{ time = 10, angle = 0 }, { time = 20, angle = 0.1 }, { time = 40, angle = 0 }]";
        let sharp = drive(table).profile();
        assert_eq!(sharp.iter().map(|piece| piece[0]).collect::<Vec<_>>(), [10.0, 20.0, 40.0]);
        assert!((sharp[2][1]).abs() < 1e-16 && sharp[2][2] == 0.0);
        let round = drive(&format!("{table}\nacceleration = 0.005")).profile();
        // Half of the change of 0.01 rad/s is before 10 s, and after the last corner the angle is that of the table.
        assert_eq!(round[0], [9.0, 0.0, 0.0, 0.005]);
        let last = round.last().unwrap();
        assert!((last[0] - 40.5).abs() < 1e-12 && last[1].abs() < 1e-15 && last[2] == 0.0, "{last:?}");
    }

    #[test]
    fn what_does_not_fit_is_refused() {
        for (text, key) in [
            ("", ""),
            ("rate = 1.0\ntrack = \"sun\"", ""),
            ("track = \"sun\"\nfrom = 3", "from"),
            ("track = \"sun\"\nnormal = [0, 1, 1]", "normal"),
            ("rate = 0.02\nfrom = 1\nuntil = 5\nacceleration = 0.002", "acceleration"),
            ("rate = 0.02\nfrom = 6\nuntil = 5", "until"),
            ("table = [{ time = 1, angle = 0 }]", "table"),
            ("table = [{ time = 1, angle = 0 }, { time = 1, angle = 1 }]", "table[1].time"),
            (
                "table = [{ time = 1, angle = 0 }, { time = 2, angle = 1 }]\nacceleration = 0.1",
                "acceleration",
            ),
        ] {
            let fault = drive(text).validate().expect_err(text);
            assert_eq!(fault.key, key, "{text}: {fault}");
        }
        assert_eq!(drive("track = \"sun\"").validate(), Ok(()));
    }
}
