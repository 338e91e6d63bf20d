//! Comparison of a manoeuvre's command with all other commands.

use std::io::Write;

use flexsc_core::body::Planar;
use flexsc_core::manoeuvre::{CommandCost, ComparisonBasis};
use serde_json::Value as Json;

use super::percent;
use crate::error::CliError;
use crate::results::Results;
use crate::say;

/// Comparison of all commands for a manoeuvre.
pub struct AlternativesResults {
    /// Name of the scenario.
    pub name: String,
    /// Body of the scenario.
    pub body: Planar,
    /// Relative uncertainty of the frequencies.
    pub band: f64,
    /// Index of the coordinate in the table: the hub's angle or an output.
    pub shown: usize,
    /// Data that all commands have in common.
    pub common: ComparisonBasis,
    pub rows: Vec<CommandCost>,
}

impl Results for AlternativesResults {
    fn json(&self) -> Vec<Json> {
        self.rows.iter().map(CommandCost::to_json).collect()
    }

    fn print(&self) -> Result<(), CliError> {
        let Self { name, body, shown, rows, .. } = self;
        let chosen = shown.checked_sub(1).map_or("angle", |index| &body.outputs[index].name);
        let unit = body.torque_unit();
        match self.common {
            ComparisonBasis::Time(time) => say!("{name}   every command in {} s", time.seconds()),
            ComparisonBasis::PeakTorque(peak) => {
                say!("{name}   every command at a peak of {} {unit}", peak.get());
            }
        }
        let (band, hub) = (percent(self.band), "angle");
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
            unit,
            unit,
            unit,
            "left",
            "worst",
            "worst",
            "left",
            "worst"
        );
        for row in rows {
            match &row.outcome {
                Err(fault) => say!("  {:<28}{}", row.name, fault.why),
                Ok(outcome) => {
                    let (own, hub) = (&outcome.residuals[*shown], &outcome.residuals[0]);
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
        Ok(())
    }
}
