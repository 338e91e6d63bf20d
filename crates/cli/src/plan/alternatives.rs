//! Comparison of a manoeuvre's command with all other commands.

use std::io::Write;

use flexsc_core::dynamics::axis_model::AxisModel;
use flexsc_core::spacecraft::manoeuvre::{CommandCost, ComparisonBasis};
use serde_json::Value as Json;

use super::percent;
use crate::error::CliError;
use crate::human::{Units, columns, digits};
use crate::results::Results;
use crate::say;

/// Number of lines in the head of the printed table.
const HEAD: usize = 3;

/// Comparison of all commands for a manoeuvre.
pub struct AlternativesResults {
    /// Name of the scenario.
    pub name: String,
    /// Body of the scenario.
    pub body: AxisModel,
    /// Relative uncertainty of the frequencies.
    pub band: f64,
    /// Index of the coordinate in the table: the hub's angle or an output.
    pub shown: usize,
    /// Data that all commands have in common.
    pub common: ComparisonBasis,
    pub rows: Vec<CommandCost>,
    /// Units of the text.
    pub units: Units,
}

impl Results for AlternativesResults {
    fn json(&self) -> Vec<Json> {
        self.rows.iter().map(CommandCost::to_json).collect()
    }

    fn print(&self) -> Result<(), CliError> {
        let Self { name, body, units, rows, .. } = self;
        match self.common {
            ComparisonBasis::Time(time) => say!("{name}   every command in {} s", time.seconds()),
            ComparisonBasis::PeakTorque(peak) => {
                let peak = units.quantity(peak.get(), body.torque_unit());
                say!("{name}   every command at a peak of {peak}");
            }
        }
        let mut lines = columns(&self.table(), 0).into_iter();
        for line in lines.by_ref().take(HEAD) {
            say!("  {line}");
        }
        for row in rows {
            match &row.outcome {
                Err(fault) => say!("  {:<28}{}", row.name, fault.why),
                Ok(_) => {
                    if let Some(line) = lines.next() {
                        say!("  {line}");
                    }
                }
            }
        }
        Ok(())
    }
}

impl AlternativesResults {
    /// Returns the cells of the printed table: the lines of its head, and a line of each feasible command.
    fn table(&self) -> Vec<Vec<String>> {
        let Self { body, shown, units, rows, .. } = self;
        let shown = *shown;
        let output = shown.checked_sub(1).and_then(|index| body.outputs.get(index));
        let (chosen, unit) =
            output.map_or(("angle", "rad"), |output| (output.name.as_str(), output.unit.as_str()));
        let outcomes = || rows.iter().filter_map(|row| Some((&row.name, row.outcome.as_ref().ok()?)));
        let (mut torques, mut own, mut hub) = (Vec::new(), Vec::new(), Vec::new());
        for (_, outcome) in outcomes() {
            torques.extend([outcome.torque.peak.value, outcome.torque.rms, outcome.torque.initial]);
            let (residuals, angle) = (&outcome.residuals[shown], &outcome.residuals[0]);
            own.extend([residuals.nominal, residuals.near, residuals.worst]);
            hub.extend([angle.nominal, angle.worst]);
        }
        // One unit per column, so that commands can be compared.
        let (torque_scale, torque_unit) = units.common(&torques, body.torque_unit());
        let (own_scale, own_unit) = units.common(&own, unit);
        let (hub_scale, hub_unit) = units.common(&hub, "rad");
        let band = format!("±{} %", percent(self.band));
        let (torque, own, hub) = (torque_unit.as_str(), own_unit.as_str(), hub_unit.as_str());
        let head: [[&str; 10]; HEAD] = [
            ["", "time", "peak", "RMS", "at 0+", chosen, "±5 %", &band, "angle", &band],
            ["", "", "", "", "", "left", "worst", "worst", "left", "worst"],
            ["", "s", torque, torque, torque, own, own, own, hub, hub],
        ];
        let mut table: Vec<Vec<String>> = head.map(|line| line.map(str::to_owned).to_vec()).to_vec();
        for (name, outcome) in outcomes() {
            let (residuals, angle) = (&outcome.residuals[shown], &outcome.residuals[0]);
            let mut line = vec![format!("{name:<26}"), format!("{:.4}", outcome.plan.time)];
            let torques = [outcome.torque.peak.value, outcome.torque.rms, outcome.torque.initial];
            line.extend(torques.map(|torque| digits(torque * torque_scale)));
            line.extend(
                [residuals.nominal, residuals.near, residuals.worst]
                    .map(|residual| digits(residual * own_scale)),
            );
            line.extend([angle.nominal, angle.worst].map(|residual| digits(residual * hub_scale)));
            table.push(line);
        }
        table
    }
}
