//! Results of tuning: the region of the gains or the robust ones, and the resulting schedule.

use flexsc_core::analysis::sampled_loop::{Region, Robust, midpoints};
use flexsc_figure::Named;
use serde_json::{Value as Json, json};

use super::tuning::Tuning;
use super::{figures, table};
use crate::failure::Failure;
use crate::results::Results;

/// Admissible gains.
pub enum Found {
    /// Region of the gains at each frequency.
    Regions(Vec<Region>),
    /// Gains that are admissible with a model error of up to `off`, relative.
    Robust { off: f64, rows: Vec<Robust> },
}

/// Results of tuning.
pub struct Tuned {
    pub tuning: Tuning,
    pub found: Found,
}

impl Tuned {
    /// Returns the frequencies (rad/s) and gains of the schedule, where there is a gain.
    fn schedule(&self) -> Vec<(f64, f64)> {
        match &self.found {
            Found::Regions(regions) => midpoints(regions),
            Found::Robust { rows, .. } => {
                rows.iter().filter_map(|row| Some((row.frequency_rad_s, row.gain?))).collect()
            }
        }
    }

    /// Returns the schedule as `[law.pd.extra]` of a scenario.
    pub fn extra(&self) -> Result<String, Failure> {
        let point = |(w, gain): &(f64, f64)| format!("    {{ frequency = {w:.6}, gain = {gain:.4} }},\n");
        let points: String = self.schedule().iter().map(point).collect();
        if points.is_empty() {
            let name = &self.tuning.name;
            return Err(Failure::Arguments(format!(
                "{name}: no gain is suitable at any of these frequencies"
            )));
        }
        Ok(format!("[law.pd.extra]\nschedule = [\n{points}]\n"))
    }
}

impl Results for Tuned {
    fn json(&self) -> Vec<Json> {
        let rows = match &self.found {
            Found::Regions(regions) => json!(regions),
            Found::Robust { rows, .. } => json!(rows),
        };
        let point = |(frequency, gain)| json!({"frequency": frequency, "gain": gain});
        let schedule: Vec<Json> = self.schedule().into_iter().map(point).collect();
        vec![json!({"scenario": self.tuning.name, "rows": rows, "schedule": schedule})]
    }

    fn figures(&self) -> Vec<Named> {
        match &self.found {
            Found::Regions(regions) => figures::all(&self.tuning, regions, None),
            Found::Robust { off, rows } => {
                figures::all(&self.tuning, &self.tuning.regions(), Some((rows, *off)))
            }
        }
    }

    fn tell(&self) -> Result<(), Failure> {
        let Tuning { name, limit, gains, .. } = &self.tuning;
        match &self.found {
            Found::Regions(regions) => table::tell(name, *limit, *gains, regions),
            Found::Robust { off, rows } => table::tell_robust(name, *off, rows),
        }
        Ok(())
    }
}
