//! Attitude ephemeris message: CCSDS 504.0-B-2, in keyword-value notation.

use std::fmt::Write as _;

use crate::calendar::CivilDate;
use crate::error::HandoverError;
use crate::motion_rows::RunLog;
use crate::options::{HandoverOptions, keyword_value};

/// Returns the message with the attitude of a run.
pub fn write(run: &RunLog<'_>, options: &HandoverOptions) -> Result<String, HandoverError> {
    let rows = run.attitude_rows()?;
    let (epoch, axes) = (options.date(run)?, options.axes(run)?);
    let (_, frame) = axes.frame.names();
    let date = |time_ns: u64| CivilDate::from_nanoseconds(epoch.saturating_add(time_ns)).to_text();
    let end = rows.last().map_or(0, |row| row.time_ns);
    let name = keyword_value(&run.scenario.name);
    let id = keyword_value(options.object_id.as_deref().unwrap_or_default());
    let subject = if run.scenario.model.one_axis().is_some() {
        "Rotation of the hub about its z axis, elastic part included"
    } else if run.scenario.model.three_axis().is_some_and(|body| body.coupling.is_some()) {
        "Attitude of the hub, elastic part included"
    } else {
        "Attitude of the body's axes"
    };
    let start = date(0);
    let mut text = format!(
        "CCSDS_AEM_VERS = 2.0\n\
         CREATION_DATE = {start}\n\
         ORIGINATOR = FLEXSC\n\n\
         META_START\n\
         COMMENT {subject}; quaternion from REF_FRAME_A to REF_FRAME_B, scalar last; rates in deg/s\n\
         OBJECT_NAME = {name}\n\
         OBJECT_ID = {id}\n\
         REF_FRAME_A = {frame}\n\
         REF_FRAME_B = SC_BODY_1\n\
         TIME_SYSTEM = UTC\n\
         START_TIME = {}\n\
         STOP_TIME = {}\n\
         ATTITUDE_TYPE = QUATERNION/ANGVEL\n\
         ANGVEL_FRAME = REF_FRAME_B\n\
         INTERPOLATION_METHOD = LINEAR\n\
         INTERPOLATION_DEGREE = 1\n\
         META_STOP\n\n\
         DATA_START\n",
        date(rows.first().map_or(0, |row| row.time_ns)),
        date(end),
    );
    text.reserve(200 * rows.len());
    let turn = axes.turn.quaternion();
    for row in &rows {
        // Adding 0 removes the sign of a zero.
        let (q, rate) = (turn * row.attitude, row.rate.map(|rate| rate.to_degrees() + 0.0));
        let _ = writeln!(
            text,
            "{} {:.16} {:.16} {:.16} {:.16} {:.15e} {:.15e} {:.15e}",
            date(row.time_ns),
            q.i + 0.0,
            q.j + 0.0,
            q.k + 0.0,
            q.w + 0.0,
            rate.x,
            rate.y,
            rate.z
        );
    }
    text.push_str("DATA_STOP\n");
    Ok(text)
}
