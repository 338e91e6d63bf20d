//! Rows of the estimates after a sample.

use flexsc_record::{Estimates, Record, RecordError, Sample};

use crate::sim::run_view::RunView;

/// Records the estimates after the current sample, if the record wants them.
pub fn record_estimates(run: &RunView<'_>, record: &mut dyn Record) -> Result<(), RecordError> {
    if !record.wants_estimates() {
        return Ok(());
    }
    let (now, estimation) = (run.now, run.estimation);
    let truth = run.plant.truth().orientation;
    if let Some(row) = estimation.estimator.attitude_row(now, &truth, run.sensors.gyro_bias()) {
        record.record(now, Sample::AttitudeEstimate(&row))?;
        let modes = estimation.estimator.elastic_row();
        return modes.map_or(Ok(()), |row| record.record(now, Sample::ElasticEstimates(&row)));
    }
    let about = |axis: usize| {
        estimation.estimator.estimate_row(axis, now, &run.plant.about_axis(axis, estimation.origin()))
    };
    if estimation.axis_count() == 1 {
        return about(0).map_or(Ok(()), |row| record.record(now, Sample::Estimate(&row)));
    }
    let axes: Option<Vec<_>> = (0..estimation.axis_count()).map(about).collect();
    axes.map_or(Ok(()), |axes| record.record(now, Sample::Estimates(&Estimates { axes })))
}
