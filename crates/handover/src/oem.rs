//! Orbit ephemeris message: CCSDS 502.0-B-2, in keyword-value notation.

use std::fmt::Write as _;

use crate::calendar::CivilDate;
use crate::error::HandoverError;
use crate::motion_rows::RunLog;
use crate::options::{HandoverOptions, keyword_value, other_gravity};

/// Largest degree of the interpolation.
const DEGREE: usize = 7;
/// Returns the message with the orbit of a run.
pub fn write(run: &RunLog<'_>, options: &HandoverOptions) -> Result<String, HandoverError> {
    let none = || {
        HandoverError::refused(
            "the run has no orbit, which an orbit ephemeris message would hold",
            "a three-axis scenario with `environment.orbit` has one",
        )
    };
    let rows = run.orbit_rows()?.ok_or_else(none)?;
    let (epoch, axes, center) = (options.date(run)?, options.axes(run)?, center(run, options)?);
    let (frame, _) = axes.frame.names();
    let date = |time_ns: u64| CivilDate::from_nanoseconds(epoch.saturating_add(time_ns)).to_text();
    let name = keyword_value(&run.scenario.name);
    let id = keyword_value(options.object_id.as_deref().unwrap_or_default());
    let (start, end) = (date(rows[0].time_ns), date(rows[rows.len() - 1].time_ns));
    let mut text = format!(
        "CCSDS_OEM_VERS = 2.0\n\
         CREATION_DATE = {}\n\
         ORIGINATOR = FLEXSC\n\n\
         META_START\n\
         OBJECT_NAME = {name}\n\
         OBJECT_ID = {id}\n\
         CENTER_NAME = {center}\n\
         REF_FRAME = {frame}\n\
         TIME_SYSTEM = UTC\n\
         START_TIME = {start}\n\
         STOP_TIME = {end}\n",
        date(0),
    );
    // A reader can only interpolate with more states than the degree.
    let degree = DEGREE.min(rows.len() - 1);
    if degree > 0 {
        let _ = writeln!(text, "INTERPOLATION = LAGRANGE\nINTERPOLATION_DEGREE = {degree}");
    }
    text.push_str("META_STOP\n\n");
    text.reserve(140 * rows.len());
    for row in &rows {
        let (r, v) = (axes.turn * (row.position * 1e-3), axes.turn * (row.velocity * 1e-3));
        let date = date(row.time_ns);
        let _ = writeln!(text, "{date} {:.9} {:.9} {:.9} {:.12} {:.12} {:.12}", r.x, r.y, r.z, v.x, v.y, v.z);
    }
    Ok(text)
}

/// Returns the name of the orbited body.
pub fn center(run: &RunLog<'_>, options: &HandoverOptions) -> Result<String, HandoverError> {
    if let Some(center) = &options.center {
        return Ok(keyword_value(center).to_uppercase());
    }
    let Some(gravity) = other_gravity(run.scenario) else { return Ok("EARTH".to_owned()) };
    Err(HandoverError::refused(
        &format!("the orbit is not about the Earth: `environment.orbit.gravity` is {gravity:e} m³/s²"),
        "name the planet with --center, such as `--center MARS`",
    ))
}
