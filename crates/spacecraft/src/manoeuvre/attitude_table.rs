//! Attitude as a table in time: cubic splines of roll, pitch and yaw, at rest at both ends.

use flexsc_formats::document::ConfigError;
use flexsc_numerics::attitude::{Vector, from_yaw_pitch_roll};
use flexsc_numerics::quantity::{Finite, Time};
use nalgebra::Quaternion;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::AttitudeMotion;

/// A row of the table.
#[derive(Copy, Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(rename = "AttitudeAt")]
pub struct AttitudeRow {
    /// Time since the start of the target (s); 0 in the first row.
    pub time: Time,
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

impl AttitudeRow {
    fn angles(&self) -> Vector {
        Vector::new(self.roll.get(), self.pitch.get(), self.yaw.get())
    }
}

/// Spline through the rows of a table.
#[derive(Clone, Debug, PartialEq)]
pub struct AttitudeTable {
    times: Vec<f64>,
    /// Roll, pitch and yaw (rad); `bends` are their second derivatives (rad/s²).
    angles: Vec<Vector>,
    bends: Vec<Vector>,
}

impl AttitudeTable {
    /// Creates the spline through the rows, at least two whose times increase.
    pub fn new(rows: &[AttitudeRow]) -> Self {
        let times: Vec<f64> = rows.iter().map(|row| row.time.get()).collect();
        let angles: Vec<Vector> = rows.iter().map(AttitudeRow::angles).collect();
        let bends = clamped(&times, &angles);
        Self { times, angles, bends }
    }

    /// Returns the key and the reason, if the rows make no table.
    pub fn validate(rows: &[AttitudeRow]) -> Option<ConfigError> {
        if rows.len() < 2 {
            return Some(ConfigError::new(
                "table",
                format!("must have at least two rows, got {}", rows.len()),
            ));
        }
        let first = rows[0].time.get();
        if first != 0.0 {
            return Some(ConfigError::new(
                "table[0].time",
                format!("must be 0 of the first row, got {first}"),
            ));
        }
        let late = rows.windows(2).position(|pair| pair[0].time >= pair[1].time)? + 1;
        let why = format!("must be later than the one before, got {}", rows[late].time.get());
        Some(ConfigError::new(format!("table[{late}].time"), why))
    }

    /// Returns the duration (s).
    pub fn duration(&self) -> f64 {
        self.times.last().copied().unwrap_or(0.0)
    }

    /// Returns the final attitude.
    pub fn final_attitude(&self) -> Quaternion<f64> {
        self.angles.last().map_or_else(
            || from_yaw_pitch_roll(0.0, 0.0, 0.0),
            |last| from_yaw_pitch_roll(last.x, last.y, last.z),
        )
    }

    /// Returns an estimate of the largest rate in the table (rad/s), from samples.
    pub fn fastest(&self) -> f64 {
        let parts = |pair: &[f64]| {
            let (from, length) = (pair[0], pair[1] - pair[0]);
            (0..=8).map(move |part| from + length * f64::from(part) / 8.0).collect::<Vec<_>>()
        };
        self.times.windows(2).flat_map(parts).map(|t| self.at(t).rate.norm()).fold(0.0, f64::max)
    }

    /// Returns attitude, rate and acceleration at `t` seconds after the start of the table.
    pub fn at(&self, t: f64) -> AttitudeMotion {
        if t >= self.duration() {
            return AttitudeMotion::at_rest(self.final_attitude());
        }
        let after = self.times.partition_point(|time| *time <= t).clamp(1, self.times.len() - 1);
        let (h, s) = (self.times[after] - self.times[after - 1], t.max(0.0) - self.times[after - 1]);
        let [from, to] = [self.angles[after - 1], self.angles[after]];
        let [bend, next] = [self.bends[after - 1], self.bends[after]];
        let slope = (to - from) / h - (bend * 2.0 + next) * (h / 6.0);
        let jerk = (next - bend) / h;
        let angles = from + (slope + (bend * 0.5 + jerk * (s / 6.0)) * s) * s;
        attitude_motion(&angles, &(slope + (bend + jerk * (0.5 * s)) * s), &(bend + jerk * s))
    }
}

/// Returns attitude, rate and acceleration from roll, pitch and yaw and their first and second derivatives.
fn attitude_motion(angles: &Vector, rates: &Vector, seconds: &Vector) -> AttitudeMotion {
    let ((sr, cr), (sp, cp)) = (libm::sincos(angles.x), libm::sincos(angles.y));
    let (roll, pitch, yaw) = (rates.x, rates.y, rates.z);
    AttitudeMotion {
        attitude: from_yaw_pitch_roll(angles.x, angles.y, angles.z),
        rate: Vector::new(roll - yaw * sp, pitch * cr + yaw * cp * sr, yaw * cp * cr - pitch * sr),
        acceleration: Vector::new(
            seconds.x - seconds.z * sp - yaw * pitch * cp,
            seconds.y * cr - pitch * roll * sr + seconds.z * cp * sr - yaw * pitch * sp * sr
                + yaw * roll * cp * cr,
            seconds.z * cp * cr
                - yaw * pitch * sp * cr
                - yaw * roll * cp * sr
                - seconds.y * sr
                - pitch * roll * cr,
        ),
    }
}

/// Returns the second derivatives of the cubic spline through the values that is at rest at both ends.
fn clamped(times: &[f64], values: &[Vector]) -> Vec<Vector> {
    let count = times.len();
    let (h, slope): (Vec<f64>, Vec<Vector>) = (1..count)
        .map(|k| (times[k] - times[k - 1], (values[k] - values[k - 1]) / (times[k] - times[k - 1])))
        .unzip();
    // Elimination of a tridiagonal system with a dominant diagonal.
    let (mut upper, mut right_hand_side): (Vec<f64>, Vec<Vector>) = (Vec::new(), Vec::new());
    for k in 0..count {
        let (before, after) = (k.checked_sub(1).map_or(0.0, |k| h[k]), h.get(k).copied().unwrap_or(0.0));
        let previous = k.checked_sub(1).map_or_else(Vector::zeros, |k| slope[k]);
        let change = (slope.get(k).copied().unwrap_or_default() - previous) * 6.0;
        let last = k.checked_sub(1).map_or((0.0, Vector::zeros()), |k| (upper[k], right_hand_side[k]));
        let pivot = 2.0 * (before + after) - before * last.0;
        upper.push(after / pivot);
        right_hand_side.push((change - last.1 * before) / pivot);
    }
    for k in (0..count - 1).rev() {
        let next = right_hand_side[k + 1];
        right_hand_side[k] -= next * upper[k];
    }
    right_hand_side
}

#[cfg(test)]
mod tests {
    use super::*;

    fn table(rows: &[[f64; 4]]) -> AttitudeTable {
        let finite = |value: f64| Finite::new(value).unwrap();
        let row = |[time, roll, pitch, yaw]: &[f64; 4]| AttitudeRow {
            time: Time::new(*time).unwrap(),
            roll: finite(*roll),
            pitch: finite(*pitch),
            yaw: finite(*yaw),
        };
        let rows: Vec<AttitudeRow> = rows.iter().map(row).collect();
        assert_eq!(AttitudeTable::validate(&rows), None);
        AttitudeTable::new(&rows)
    }

    #[test]
    fn between_two_rows_it_is_a_cubic_at_rest_at_both_ends() {
        let table = table(&[[0.0, 0.0, 0.0, 0.0], [10.0, 0.0, 0.4, 0.0]]);
        for t in [0.0, 2.5, 5.0, 9.0] {
            let s: f64 = t / 10.0;
            let pose = table.at(t);
            assert!(
                (pose.attitude - from_yaw_pitch_roll(0.0, 0.4 * s * s * (3.0 - 2.0 * s), 0.0)).norm() < 1e-15
            );
            assert!((pose.rate.y - 0.04 * 6.0 * s * (1.0 - s)).abs() < 1e-16);
            assert!((pose.acceleration.y - 4e-3 * (6.0 - 12.0 * s)).abs() < 1e-16);
        }
        assert_eq!(table.at(10.0), AttitudeMotion::at_rest(from_yaw_pitch_roll(0.0, 0.4, 0.0)));
    }

    #[test]
    fn rate_and_acceleration_are_derivatives_and_continuous_at_rows() {
        let table = table(&[
            [0.0, 0.1, -0.2, 0.3],
            [7.0, 0.5, 0.3, 0.9],
            [12.0, -0.4, 0.8, 1.4],
            [30.0, 0.2, -0.1, 0.0],
        ]);
        let h = 1e-4;
        for k in 1..300 {
            let t = 0.1 * f64::from(k);
            let [before, now, after] = [t - h, t, t + h].map(|t| table.at(t));
            let turn = (before.attitude.conjugate() * after.attitude).vector() * 2.0;
            assert!((turn / (2.0 * h) - now.rate).norm() < 1e-8, "{t}");
            if t < 30.0 - h {
                let change = (after.rate - before.rate) / (2.0 * h);
                assert!((change - now.acceleration).norm() < 1e-5, "{t} {change} {}", now.acceleration);
            }
            assert!(now.rate.norm() <= 1.1 * table.fastest());
        }
        assert!((table.at(7.0).attitude - from_yaw_pitch_roll(0.5, 0.3, 0.9)).norm() < 1e-15);
    }

    #[test]
    fn rows_that_do_not_fit_are_refused() {
        let row = |time: f64| AttitudeRow {
            time: Time::new(time).unwrap(),
            roll: Finite::ZERO,
            pitch: Finite::ZERO,
            yaw: Finite::ZERO,
        };
        let fault = |times: &[f64]| {
            let rows: Vec<_> = times.iter().map(|time| row(*time)).collect();
            AttitudeTable::validate(&rows).unwrap().key
        };
        assert_eq!(
            [fault(&[0.0]), fault(&[1.0, 2.0]), fault(&[0.0, 2.0, 2.0])],
            ["table", "table[0].time", "table[2].time"]
        );
    }
}
