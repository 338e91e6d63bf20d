//! How a manoeuvre's command stands in the field, as a table.

use std::io::Write;

use flexsc_core::body::Planar;
use flexsc_core::manoeuvre::{Common, Row};

use crate::say;

/// Tells the field; `column` is the index of the coordinate that it shows, of the hub's angle and the outputs.
pub fn tell(name: &str, body: &Planar, band: f64, column: usize, common: Common, rows: &[Row]) {
    let chosen = column.checked_sub(1).map_or("angle", |index| &body.outputs[index].name);
    match common {
        Common::Time(time) => say!("{name}   every command in {} s", time.seconds()),
        Common::PeakTorque(peak) => say!("{name}   every command at a peak of {} N m", peak.get()),
    }
    let (band, hub) = (super::percent(band), "angle");
    say!(
        "  {:<28}{:>10}{:>10}{:>10}{:>10}{:>11}{:>11}{:>11}{:>11}{:>11}",
        "",
        "time",
        "peak",
        "RMS",
        "at 0+",
        chosen,
        "±5 %",
        format!("±{band} %"),
        hub,
        format!("±{band} %")
    );
    say!(
        "  {:<28}{:>10}{:>10}{:>10}{:>10}{:>11}{:>11}{:>11}{:>11}{:>11}",
        "",
        "s",
        "N m",
        "N m",
        "N m",
        "left",
        "worst",
        "worst",
        "left",
        "worst"
    );
    for row in rows {
        match &row.outcome {
            Err((_, why)) => say!("  {:<28}{why}", row.name),
            Ok(outcome) => {
                let (own, hub) = (&outcome.residuals[column], &outcome.residuals[0]);
                say!(
                    "  {:<28}{:>10.4}{:>10.2}{:>10.2}{:>10.2}{:>11.3e}{:>11.3e}{:>11.3e}{:>11.3e}{:>11.3e}",
                    row.name,
                    outcome.plan.time,
                    outcome.torque.peak.value,
                    outcome.torque.rms,
                    outcome.torque.initial,
                    own.nominal,
                    own.near,
                    own.worst,
                    hub.nominal,
                    hub.worst
                );
            }
        }
    }
}
