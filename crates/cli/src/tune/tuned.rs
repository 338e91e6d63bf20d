//! Results of tuning: the region of the gains or the robust ones, and the resulting schedule.

use flexsc_core::analysis::sampled_loop::{GainRegion, RobustGain, midpoints};
use flexsc_figure::Named;
use serde_json::{Value as Json, json};

use super::tuning::TuneSetup;
use super::{figures, table};
use crate::error::CliError;
use crate::human::Units;
use crate::results::Results;

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
        let TuneSetup { name, limit, gains, .. } = &self.tuning;
        match &self.found {
            TuneMethodResults::Regions(regions) => {
                table::print(name, *limit, *gains, regions, self.units);
            }
            TuneMethodResults::Robust { off, rows } => {
                table::print_robust(name, *off, rows, self.units);
            }
        }
        Ok(())
    }
}
