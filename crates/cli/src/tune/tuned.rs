//! Results of tuning: the region of the gains or the robust ones, and the resulting schedule.

use std::io::Write;

use flexsc_core::analysis::sampled_loop::{GainRegion, Gains, RobustGain, midpoints};
use flexsc_figure::Named;
use serde_json::{Value as Json, json};

use super::figures;
use super::tuning::TuneSetup;
use crate::error::CliError;
use crate::human::Units;
use crate::results::Results;
use crate::row_table::{Column, column, print_rows};
use crate::say;

/// Columns of a region of gains.
const REGIONS: [Column<'_>; 7] = [
    column("frequency_rad_s", "frequency"),
    column("gain.0", "lowest"),
    column("gain.1", "highest"),
    column("midpoint", "middle"),
    column("settling_s", "settling"),
    column("spectral_radius", "radius").decimals(7),
    column("settling_without_s", "without"),
];

/// Columns of robust gains.
const ROBUST_GAINS: [Column<'_>; 6] = [
    column("frequency_rad_s", "frequency"),
    column("gain", "gain"),
    column("settling_s", "settling"),
    column("settling_quantile_s", "perturbed"),
    column("spectral_radius", "radius").decimals(7),
    column("settling_without_s", "without"),
];

/// Admissible gains.
pub enum TuneMethodResults {
    /// Region of the gains at each frequency.
    Regions(Vec<GainRegion>),
    /// Gains that are admissible with a model error of up to `off`, relative.
    Robust { off: f64, rows: Vec<RobustGain> },
}

/// Results of tuning.
pub struct TuneResults {
    pub tuning: TuneSetup,
    pub found: TuneMethodResults,
    /// Units of the text.
    pub units: Units,
}

impl TuneResults {
    /// Returns the frequencies (rad/s) and gains of the schedule, where there is a gain.
    fn schedule(&self) -> Vec<(f64, f64)> {
        match &self.found {
            TuneMethodResults::Regions(regions) => midpoints(regions),
            TuneMethodResults::Robust { rows, .. } => {
                rows.iter().filter_map(|row| Some((row.frequency_rad_s, row.gain?))).collect()
            }
        }
    }

    /// Returns the schedule as `[law.pd.extra]` of a scenario.
    pub fn extra(&self) -> Result<String, CliError> {
        let point = |(w, gain): &(f64, f64)| format!("    {{ frequency = {w:.6}, gain = {gain:.4} }},\n");
        let points: String = self.schedule().iter().map(point).collect();
        if points.is_empty() {
            let name = &self.tuning.name;
            return Err(CliError::Arguments(format!(
                "{name}: no gain is suitable at any of these frequencies"
            )));
        }
        Ok(format!("[law.pd.extra]\nschedule = [\n{points}]\n"))
    }
}

impl Results for TuneResults {
    fn json(&self) -> Vec<Json> {
        let rows = match &self.found {
            TuneMethodResults::Regions(regions) => json!(regions),
            TuneMethodResults::Robust { rows, .. } => json!(rows),
        };
        let point = |(frequency, gain)| json!({"frequency": frequency, "gain": gain});
        let schedule: Vec<Json> = self.schedule().into_iter().map(point).collect();
        vec![json!({"scenario": self.tuning.name, "rows": rows, "schedule": schedule})]
    }

    fn figures(&self) -> Vec<Named> {
        match &self.found {
            TuneMethodResults::Regions(regions) => figures::all(&self.tuning, regions, None),
            TuneMethodResults::Robust { off, rows } => {
                figures::all(&self.tuning, &self.tuning.regions(), Some((rows, *off)))
            }
        }
    }

    fn print(&self) -> Result<(), CliError> {
        let TuneSetup { name, limit, gains: Gains { low, high, step }, .. } = &self.tuning;
        match &self.found {
            TuneMethodResults::Regions(regions) => {
                say!(
                    "{name}   gains of the extra loop that are stable and settle in {limit} s, of {low} to {high} by {step}"
                );
                print_rows(regions, &REGIONS, self.units);
            }
            TuneMethodResults::Robust { off, rows } => {
                let off = off * 100.0;
                say!("{name}   gains of the extra loop that settle soonest with the model off by {off} %");
                print_rows(rows, &ROBUST_GAINS, self.units);
            }
        }
        Ok(())
    }
}
