//! Rows of the motion in a log, as the formats need them.

use flexsc_core::Scenario;
use flexsc_core::numerics::attitude::Vector;
use flexsc_core::record::{Column, Columns, Log, LogError};
use nalgebra::Quaternion;

use crate::error::HandoverError;

/// Log of a run with its scenario.
#[derive(Copy, Clone)]
pub struct RunLog<'a> {
    /// Log.
    pub log: &'a Log,
    /// Scenario of the run.
    pub scenario: &'a Scenario,
}

/// Attitude and rate at an instant.
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct AttitudeSample {
    /// Time since the start (ns).
    pub time_ns: u64,
    /// Unit quaternion that rotates vectors from the body's axes into inertial axes; of its two signs, the one nearer to
    /// the row before.
    pub attitude: Quaternion<f64>,
    /// Rate of these axes, in the body's axes (rad/s).
    pub rate: Vector,
}

/// Position and velocity on the orbit at an instant, in inertial axes.
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct OrbitSample {
    /// Time since the start (ns).
    pub time_ns: u64,
    /// Position from the planet's centre (m).
    pub position: Vector,
    /// Velocity (m/s).
    pub velocity: Vector,
}

impl RunLog<'_> {
    /// Returns the tables of some topics; `None` for a topic that the log does not have.
    pub fn tables<const N: usize>(&self, topics: [&str; N]) -> Result<[Option<Columns>; N], LogError> {
        let mut tables = self.log.tables(&topics)?.into_iter();
        Ok(std::array::from_fn(|_| tables.next().flatten()))
    }

    /// Returns the attitude at each row of the motion, without rows of equal times.
    ///
    /// # Errors
    /// A log without the motion, or with values that are no numbers.
    pub fn attitude_rows(&self) -> Result<Vec<AttitudeSample>, HandoverError> {
        let mut rows = if self.scenario.model.one_axis().is_some() {
            self.one_axis_rows()
        } else {
            self.three_axis_rows()
        }?;
        rows.dedup_by_key(|row| row.time_ns);
        check_order(rows.iter().map(|row| row.time_ns))?;
        let mut before = Quaternion::new(1.0, 0.0, 0.0, 0.0);
        for row in &mut rows {
            check_unit(row.time_ns, &row.attitude)?;
            if row.attitude.dot(&before) < 0.0 {
                row.attitude = -row.attitude;
            }
            before = row.attitude;
            let numbers = row.attitude.coords.iter().chain(row.rate.iter());
            check_finite(row.time_ns, numbers.copied())?;
        }
        Ok(rows)
    }

    /// Returns the rows of a one-axis body, whose axis is z.
    fn one_axis_rows(&self) -> Result<Vec<AttitudeSample>, HandoverError> {
        let [attitude, rate] = self.tables(["/attitude", "/rate"])?;
        let (attitude, rate) = (motion(attitude)?, motion(rate)?);
        let angles = numbers(&attitude, "angle_rad")?;
        let rates = numbers(&rate, "rate_rad_s")?;
        let times = numbers(&attitude, "time_s")?;
        same_length(times, &[angles, rates])?;
        let row = |index: usize| {
            let (sin, cos) = libm::sincos(0.5 * angles[index]);
            AttitudeSample {
                time_ns: nanoseconds(times[index]),
                attitude: Quaternion::new(cos, 0.0, 0.0, sin),
                rate: Vector::z() * rates[index],
            }
        };
        Ok((0..times.len()).map(row).collect())
    }

    fn three_axis_rows(&self) -> Result<Vec<AttitudeSample>, HandoverError> {
        let [pointing, rates, vibrations] = self.tables(["/pointing", "/rates", "/vibrations"])?;
        let (pointing, rates) = (motion(pointing)?, motion(rates)?);
        let times = numbers(&pointing, "time_s")?;
        let [w, x, y, z] = ["q_w", "q_x", "q_y", "q_z"].map(|name| numbers(&pointing, name));
        let (w, x, y, z) = (w?, x?, y?, z?);
        same_length(times, &[w, x, y, z])?;
        let offsets = self.gyro_offsets();
        let vibrating =
            vibrations.filter(|_| offsets.as_ref().is_some_and(|of| of.iter().any(|o| o.norm() > 0.0)));
        let modal = vibrating.as_ref().map(|of| nested(of, "modes", "rate", self.scenario.mode_count()));
        let modal = modal.transpose()?;
        let own = if offsets.is_some() { "rate_rad_s" } else { "rigid_rad_s" };
        let of_axes = nested(&rates, "axes", own, 3)?;
        let count = times.len();
        let modes = self.scenario.mode_count();
        if of_axes.len() != 3 * count || modal.is_some_and(|of| of.len() != modes * count) {
            return Err(damaged("rows of its topics do not belong together"));
        }
        let row = |index: usize| {
            let mut rate = Vector::from_fn(|axis, _| of_axes[3 * index + axis]);
            if let (Some(modal), Some(offsets)) = (modal, &offsets) {
                let rates = modal[modes * index..].iter().zip(offsets);
                rate -= rates.fold(Vector::zeros(), |sum, (of_mode, offset)| sum + offset * *of_mode);
            }
            AttitudeSample {
                time_ns: nanoseconds(times[index]),
                attitude: Quaternion::new(w[index], x[index], y[index], z[index]),
                rate,
            }
        };
        Ok((0..count).map(row).collect())
    }

    /// Returns the rotation of the hub per unit of each mode, if the logged attitude is that of the hub; `None` if it is
    /// that of the mean axes, because the modes do not act back on the rotation.
    pub fn hub_rotations(&self) -> Option<Vec<Vector>> {
        let coupling = self.scenario.model.three_axis()?.coupling.as_ref()?;
        Some(coupling.rotations.clone())
    }

    /// Returns the rotation of the first gyro relative to the hub per unit of each mode, if the logged attitude is that
    /// of the hub.
    fn gyro_offsets(&self) -> Option<Vec<Vector>> {
        let gyro = self.scenario.study.sensor_points.first().map_or("", String::as_str);
        let there = self.scenario.model.three_axis()?.shapes(gyro);
        let offset = |(there, hub): (&(Vector, Vector), Vector)| there.1 - hub;
        Some(there.iter().zip(self.hub_rotations()?).map(offset).collect())
    }

    /// Returns position and velocity at each row of the orbit, without rows of equal times; `None` without an orbit.
    ///
    /// # Errors
    /// A log without the motion, or with values that are no numbers.
    pub fn orbit_rows(&self) -> Result<Option<Vec<OrbitSample>>, HandoverError> {
        if self.scenario.study.surroundings.as_ref().is_none_or(|around| around.sky().orbit().is_none()) {
            return Ok(None);
        }
        let [orbit] = self.tables(["/orbit"])?;
        let orbit = motion(orbit)?;
        let times = numbers(&orbit, "time_s")?;
        let positions = nested(&orbit, "axes", "position_m", 3)?;
        let velocities = nested(&orbit, "axes", "velocity_m_s", 3)?;
        let mut rows = Vec::with_capacity(times.len());
        for (index, time) in times.iter().enumerate() {
            let at = |of: &[f64]| Vector::from_fn(|axis, _| of[3 * index + axis]);
            let row = OrbitSample {
                time_ns: nanoseconds(*time),
                position: at(positions),
                velocity: at(velocities),
            };
            check_finite(row.time_ns, row.position.iter().chain(row.velocity.iter()).copied())?;
            rows.push(row);
        }
        rows.dedup_by_key(|row| row.time_ns);
        check_order(rows.iter().map(|row| row.time_ns))?;
        Ok(Some(rows))
    }
}

/// Returns a time (s) in nanoseconds, in which a log counts.
pub fn nanoseconds(time: f64) -> u64 {
    libm::round(time * 1e9) as u64
}

/// Returns the table of a topic that every log of the motion has.
pub fn motion(table: Option<Columns>) -> Result<Columns, HandoverError> {
    table.filter(|table| !table.is_empty()).ok_or_else(|| {
        HandoverError::refused(
            "the log has no motion, only changes",
            "`flexsc simulate` with `--log full` or `--log scene` keeps the motion",
        )
    })
}

fn damaged(why: &str) -> HandoverError {
    HandoverError::Refused(format!("not a readable log of flexsc: {why}"))
}

/// Returns the numbers of a column.
pub fn numbers<'a>(table: &'a Columns, name: &str) -> Result<&'a [f64], HandoverError> {
    table.numbers(name).ok_or_else(|| damaged(&format!("column `{name}` is missing")))
}

/// Returns the numbers of a field of nested rows, `width` for each row of the table.
pub fn nested<'a>(
    table: &'a Columns,
    name: &str,
    field: &str,
    width: usize,
) -> Result<&'a [f64], HandoverError> {
    match table.get(name) {
        Some(Column::Rows(counts, inner)) if counts.iter().all(|count| *count as usize == width) => {
            if width == 0 { Ok(&[]) } else { numbers(inner, field) }
        }
        _ => Err(damaged(&format!("column `{name}` does not have {width} values in each row"))),
    }
}

fn same_length(times: &[f64], others: &[&[f64]]) -> Result<(), HandoverError> {
    if others.iter().all(|other| other.len() == times.len()) {
        return Ok(());
    }
    Err(damaged("rows of its topics do not belong together"))
}

/// Checks that times increase.
pub fn check_order(times: impl Iterator<Item = u64>) -> Result<(), HandoverError> {
    if times.is_sorted() { Ok(()) } else { Err(damaged("its rows are not in the order of their times")) }
}

/// Checks that a quaternion is that of a rotation.
pub fn check_unit(time_ns: u64, q: &Quaternion<f64>) -> Result<(), HandoverError> {
    const NEAR: f64 = 1e-6;
    if (q.norm() - 1.0).abs() < NEAR {
        return Ok(());
    }
    let time = time_ns as f64 / 1e9;
    Err(damaged(&format!("the attitude at {time} s is not a unit quaternion")))
}

/// Checks that values at a time are finite.
pub fn check_finite(time_ns: u64, mut values: impl Iterator<Item = f64>) -> Result<(), HandoverError> {
    if values.all(f64::is_finite) {
        return Ok(());
    }
    let time = time_ns as f64 / 1e9;
    Err(HandoverError::Refused(format!("a value of the motion at {time} s is not a finite number")))
}
