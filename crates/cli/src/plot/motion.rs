//! Motion of a run and the filter's estimates at each sample, from a full log or from a repeated run.

use flexsc_core::numerics::time::Instant;
use flexsc_core::record::{self, Column, Columns, Log, Record, RecordError, Report, Sample};

use super::columns::{labels, rows, topics};
use crate::error::CliError;

/// Motion of a run. All but the envelope and the estimates may be left out if no figure shows them.
#[derive(Default)]
pub struct MotionData {
    pub time: Vec<f64>,
    pub angle: Vec<f64>,
    pub rate: Vec<f64>,
    /// Sum of the modes' displacements.
    pub elastic: Vec<f64>,
    /// Displacements of each mode.
    pub modes: Vec<Vec<f64>>,
    /// Rates of each mode.
    pub mode_rates: Vec<Vec<f64>>,
    /// Target of the hub's angle; empty without a manoeuvre or a PD law.
    pub goal: Vec<f64>,
    /// Torques: planned, law, actuator, disturbance; each empty without a manoeuvre or a PD law.
    pub torques: [Vec<f64>; 4],
    /// Speed and momentum of the wheel; each empty without a wheel that stores momentum.
    pub wheel: [Vec<f64>; 2],
    /// Values of each observed coordinate.
    pub outputs: Vec<Vec<f64>>,
    /// Times and values of the total envelope; empty without an observer.
    pub envelope: Vec<(f64, f64)>,
    /// Estimates of a filter at each sample; empty without a filter.
    pub estimates: Vec<DominantModeEstimate>,
}

/// Filter estimates of the dominant mode at a sample.
#[derive(Copy, Clone)]
pub struct DominantModeEstimate {
    pub time: f64,
    /// Index of the mode.
    pub mode: usize,
    /// Natural frequency as the law reads it (rad/s).
    pub read_frequency: f64,
    /// Natural frequency as estimated by the filter (rad/s).
    pub frequency: f64,
    /// Standard deviation of the filter's frequency (rad/s).
    pub frequency_sd: f64,
    /// True natural frequency (rad/s).
    pub true_frequency: f64,
    /// Displacement as the law reads it (rad).
    pub displacement: f64,
    pub nis: f64,
    pub nees: f64,
    /// True if the mode moves too little for its frequency to be estimated.
    pub gated: bool,
    /// True if the filter has lost lock.
    pub lost: bool,
}

impl MotionData {
    /// Reads the motion from a full log.
    pub fn read(log: &Log) -> Result<Self, CliError> {
        let [attitude, rate, modes, envelope] = topics(log, ["/attitude", "/rate", "/modes", "/envelope"])?;
        let [goal, torque, outputs] = topics(log, ["/goal", "/torque", "/outputs"])?;
        let [wheel, estimator] = topics(log, ["/wheel", "/estimator"])?;
        let column = |columns: &Columns, name: &str| columns.numbers(name).unwrap_or_default().to_vec();
        let mut motion = Self {
            time: column(&attitude, "time_s"),
            angle: column(&attitude, "angle_rad"),
            rate: column(&rate, "rate_rad_s"),
            elastic: column(&modes, "elastic_rad"),
            modes: inner(&modes, "modes", "displacement_rad"),
            mode_rates: inner(&modes, "modes", "rate_rad_s"),
            goal: column(&goal, "angle_rad"),
            torques: ["feedforward_nm", "feedback_nm", "applied_nm", "disturbance_nm"]
                .map(|name| column(&torque, name)),
            wheel: ["speed_rad_s", "momentum_nm_s"].map(|name| column(&wheel, name)),
            outputs: inner(&outputs, "outputs", "value"),
            envelope: rows(&envelope, ["time_s", "envelope_rad"])
                .map(|[time, value]| (time, value))
                .collect(),
            estimates: estimates(&estimator),
        };
        motion.keep_whole_rows();
        Ok(motion)
    }

    /// Keeps only the instants that every topic has: a torn log may have a partial last instant.
    fn keep_whole_rows(&mut self) {
        let needed = [self.time.len(), self.angle.len(), self.rate.len(), self.elastic.len()];
        let Self { time, angle, rate, elastic, modes, mode_rates, goal, torques, wheel, outputs, .. } = self;
        let others = modes.iter_mut().chain(mode_rates).chain(torques).chain(wheel).chain(outputs);
        let mut others: Vec<_> = others.chain([goal]).filter(|column| !column.is_empty()).collect();
        let reported = needed.into_iter().chain(others.iter().map(|column| column.len())).min().unwrap_or(0);
        for column in [time, angle, rate, elastic].into_iter().chain(others.iter_mut().map(|c| &mut **c)) {
            column.truncate(reported);
        }
    }

    /// Returns the displacement of a mode at a time, by the cubic Hermite interpolation between two rows; NaN beyond
    /// the rows.
    pub fn displacement(&self, mode: usize, time: f64) -> f64 {
        let (Some(x), Some(v)) = (self.modes.get(mode), self.mode_rates.get(mode)) else { return f64::NAN };
        // The times of a log are whole nanoseconds.
        let after = self.time.partition_point(|row| *row < time - 1e-9);
        match (after, self.time.get(after)) {
            (_, Some(row)) if *row <= time + 1e-9 => x[after],
            (0, _) | (_, None) => f64::NAN,
            (_, Some(row)) => {
                let before = after - 1;
                let h = row - self.time[before];
                let p = (time - self.time[before]) / h;
                let q = 1.0 - p;
                let ends = q * q * (1.0 + 2.0 * p) * x[before] + p * p * (1.0 + 2.0 * q) * x[after];
                ends + h * p * q * (q * v[before] - p * v[after])
            }
        }
    }
}

fn estimates(columns: &Columns) -> Vec<DominantModeEstimate> {
    let modes = match columns.get("dominant") {
        Some(Column::Counts(values)) => values.as_slice(),
        _ => &[],
    };
    let (gated, lock) = (labels(columns, "gated"), labels(columns, "lock"));
    let is = |labels: &[String], index: usize, label: &str| labels.get(index).is_some_and(|own| own == label);
    let own = inner(columns, "modes", "frequency_rad_s");
    let names = [
        "time_s",
        "frequency_rad_s",
        "frequency_sd_rad_s",
        "true_frequency_rad_s",
        "displacement_rad",
        "nis",
        "nees",
    ];
    let row = |(index, numbers): (usize, [f64; 7])| {
        let [time, read_frequency, frequency_sd, true_frequency, displacement, nis, nees] = numbers;
        let mode = modes.get(index).copied().unwrap_or_default() as usize;
        let frequency =
            own.get(mode).and_then(|frequencies| frequencies.get(index)).copied().unwrap_or(f64::NAN);
        let (gated, lost) = (is(&gated, index, "gated"), is(&lock, index, "lost"));
        DominantModeEstimate {
            time,
            mode,
            read_frequency,
            frequency,
            frequency_sd,
            true_frequency,
            displacement,
            nis,
            nees,
            gated,
            lost,
        }
    };
    rows(columns, names).enumerate().map(row).collect()
}

/// Returns a column of nested rows, one vector for each index within a row.
fn inner(columns: &Columns, rows: &str, name: &str) -> Vec<Vec<f64>> {
    let Some(Column::Rows(counts, inner)) = columns.get(rows) else { return Vec::new() };
    let count = counts.first().map_or(0, |count| *count as usize);
    if counts.iter().any(|other| *other as usize != count) {
        return Vec::new();
    }
    let values = inner.numbers(name).unwrap_or_default();
    (0..count).map(|place| values.iter().skip(place).step_by(count).copied().collect()).collect()
}

/// Record that keeps the motion of a repeated run: all of it, or only until `early` and from `late` on.
pub struct MotionRecorder {
    pub motion: MotionData,
    early: f64,
    late: f64,
}

impl MotionRecorder {
    pub fn new(early: f64, late: f64) -> Self {
        Self { motion: MotionData::default(), early, late }
    }

    fn observe(&mut self, time: f64, report: &Report) {
        let data = &mut self.motion;
        data.envelope.extend(report.get().map(|row: &record::Envelope| (time, row.envelope_rad)));
        let Some(attitude) = report.get::<record::Attitude>() else { return };
        if time > self.early && time < self.late {
            return;
        }
        data.time.push(time);
        data.angle.push(attitude.angle_rad);
        data.rate.extend(report.get().map(|row: &record::Rate| row.rate_rad_s));
        if let Some(modes) = report.get::<record::Modes>() {
            data.elastic.push(modes.elastic_rad);
            extend(&mut data.modes, modes.modes.iter().map(|mode| mode.displacement_rad));
            extend(&mut data.mode_rates, modes.modes.iter().map(|mode| mode.rate_rad_s));
        }
        let outputs = report.get().into_iter().flat_map(|row: &record::Outputs| &row.outputs);
        extend(&mut data.outputs, outputs.map(|output| output.value));
        data.goal.extend(report.get().map(|row: &record::GoalMotion| row.angle_rad));
        if let Some(torque) = report.get::<record::Torque>() {
            let now = [torque.feedforward_nm, torque.feedback_nm, torque.applied_nm, torque.disturbance_nm];
            data.torques.iter_mut().zip(now).for_each(|(column, value)| column.push(value));
        }
        if let Some(wheel) = report.get::<record::WheelMotion>() {
            data.wheel[0].push(wheel.speed_rad_s);
            data.wheel[1].push(wheel.momentum_nm_s);
        }
    }
}

impl Record for MotionRecorder {
    fn wants_motion(&self) -> bool {
        true
    }

    fn record(&mut self, now: Instant, sample: Sample<'_>) -> Result<(), RecordError> {
        match sample {
            Sample::Report(report) => {
                self.observe(now.seconds(), report);
                let estimate = report.get().map(|row| DominantModeEstimate::from_row(now.seconds(), row));
                self.motion.estimates.extend(estimate);
            }
            Sample::Begin(_) | Sample::Switching(..) | Sample::Row(_) => {}
        }
        Ok(())
    }
}

impl DominantModeEstimate {
    fn from_row(time: f64, row: &record::Estimate) -> Self {
        let mode = row.dominant as usize;
        Self {
            time,
            mode,
            read_frequency: row.frequency_rad_s,
            frequency: row.modes.get(mode).map_or(f64::NAN, |mode| mode.frequency_rad_s),
            frequency_sd: row.frequency_sd_rad_s,
            true_frequency: row.true_frequency_rad_s,
            displacement: row.displacement_rad,
            nis: row.nis,
            nees: row.nees,
            gated: row.gated == record::Gate::Gated,
            lost: row.lock == record::Lock::Lost,
        }
    }
}

/// Appends a row to columns, which are created with the first row.
fn extend(columns: &mut Vec<Vec<f64>>, row: impl Iterator<Item = f64>) {
    for (index, value) in row.enumerate() {
        if index == columns.len() {
            columns.push(Vec::new());
        }
        columns[index].push(value);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_displacement_is_exact_at_rows_and_cubic_between() {
        let time: Vec<f64> = (0..20).map(f64::from).collect();
        let modes = vec![time.iter().map(|t| (0.3 * t).sin()).collect()];
        let mode_rates = vec![time.iter().map(|t| 0.3 * (0.3 * t).cos()).collect()];
        let motion = MotionData { time, modes, mode_rates, ..MotionData::default() };
        assert_eq!(motion.displacement(0, 7.0).to_bits(), motion.modes[0][7].to_bits());
        for t in [0.2, 6.5, 18.9] {
            assert!((motion.displacement(0, t) - (0.3 * t).sin()).abs() < 3e-5, "{t}");
        }
        assert!([-1.0, 19.5].iter().all(|t| motion.displacement(0, *t).is_nan()));
        assert!(motion.displacement(1, 7.0).is_nan());
    }
}
