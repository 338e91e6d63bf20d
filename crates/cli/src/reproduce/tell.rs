//! What the commands of a page tell for machines.

use flexsc_core::analysis::influence::Influences;
use flexsc_core::analysis::modal::Modal;
use flexsc_core::analysis::rigid_cycle::{cycles, resonances};
use flexsc_core::analysis::sampled_loop::midpoints;
use flexsc_core::campaign::{Campaign, Grid, Run};
use flexsc_core::law::Law;
use flexsc_core::manoeuvre::{Common, Report, Row, compare};
use flexsc_core::metrics::Metrics;
use serde_json::{Map, Value as Json, json};

use super::command::Command;
use crate::failure::Failure;
use crate::stop::Stop;

impl Command {
    /// What the command tells: an object with its own text as `command`. Of a campaign or a sweep each metric is the list
    /// of its values over the runs.
    pub fn tell(&self) -> Result<Json, Failure> {
        let mut told = match self.verb.as_str() {
            "simulate" if self.is_given("runs") => self.campaign(None)?,
            "simulate" => self.single()?,
            "sweep" => self.campaign(self.one::<Grid>("vary"))?,
            "modes" => self.modes()?,
            "cycle" => self.cycle()?,
            "plan" => self.plan()?,
            "tune" => self.tune()?,
            "map" => self.map()?,
            "damping" => self.damping()?,
            "observer" => {
                let (of, kappas) = self.observer()?;
                let areas: Vec<f64> = kappas.iter().map(|kappa| of.area(*kappa)).collect();
                json!({"areas": areas, "turning": of.margin()})
            }
            _ => return Err(self.failure("no verb of a page")),
        };
        told["command"] = json!(self.text);
        Ok(told)
    }

    fn single(&self) -> Result<Json, Failure> {
        let scenario = self.scenario()?;
        let name = scenario.name.clone();
        // As `flexsc simulate` does: the scenario itself, nothing drawn.
        let run = Run {
            number: 0,
            scenario: Campaign::new(scenario, "", None)?.scenario().clone(),
            drawn: Vec::new(),
        };
        let metrics = Campaign::simulate(&run, Stop).map_err(|source| Failure::Run { name, source })?;
        Ok(metrics.to_json())
    }

    fn campaign(&self, grid: Option<Grid>) -> Result<Json, Failure> {
        let runs = match &grid {
            Some(grid) => grid.values.len() as u64,
            None => self.raw("runs").parse().map_err(|_| self.failure("--runs"))?,
        };
        let values = grid.clone();
        let study = Campaign::new(self.scenario()?, "", grid)?;
        let mut all: Vec<Metrics> = Vec::new();
        study.each(
            0..runs,
            |run| Ok(Campaign::simulate(run, Stop)?),
            |outcome| {
                let number = outcome.number;
                all.push(outcome.metrics.map_err(|why| Failure::Runs {
                    failed: 1,
                    runs,
                    number,
                    why: why.to_string(),
                })?);
                Ok::<(), Failure>(())
            },
        )?;
        let mut columns = Map::new();
        let first = all.first().map(|first| first.0.clone()).unwrap_or_default();
        for (index, (meaning, _)) in first.iter().enumerate() {
            let column: Vec<Json> = all.iter().map(|metrics| metrics.0[index].1.to_json()).collect();
            columns.insert(meaning.name.to_owned(), json!(column));
        }
        columns.insert("runs".to_owned(), json!(runs));
        if let Some(grid) = values {
            columns.insert("values".to_owned(), json!(grid.values));
        }
        Ok(Json::Object(columns))
    }

    fn modes(&self) -> Result<Json, Failure> {
        let scenario = self.scenario()?;
        Ok(match &scenario.spatial {
            Some(of) => json!(Influences::of(of)),
            None => json!(Modal::of(&scenario.model)),
        })
    }

    fn cycle(&self) -> Result<Json, Failure> {
        let scenario = self.scenario()?;
        let Law::Relay(law) = &scenario.law else { return Err(self.failure("no relay")) };
        let body = scenario.one_angle()?;
        Ok(json!({"cycles": cycles(law, body, law.k_t.get()), "resonances": resonances(law, body)}))
    }

    fn plan(&self) -> Result<Json, Failure> {
        let scenario = self.scenario()?;
        let (manoeuvre, plan) = self.planned(&scenario)?;
        let band: f64 = self.one("band").unwrap_or(0.1);
        if self.is_given("compare") {
            let common = Common::of(manoeuvre, self.peak()?, &plan);
            let rows = compare(manoeuvre, common, scenario.planned_for(), band);
            let by_name = |row: &Row| (row.name.clone(), row.to_json());
            return Ok(Json::Object(rows.iter().map(by_name).collect()));
        }
        let body = scenario.one_angle()?;
        Ok(Report::new(&plan, body, band).to_json(&plan, body))
    }

    fn tune(&self) -> Result<Json, Failure> {
        let scenario = self.scenario()?;
        let tuned = self.tuned(&scenario)?;
        let schedule = match &tuned.robust {
            Some(robust) => robust.iter().filter_map(|r| Some((r.frequency_rad_s, r.gain?))).collect(),
            None => midpoints(&tuned.regions),
        };
        Ok(json!({"regions": tuned.regions, "robust": tuned.robust, "schedule": schedule}))
    }

    fn map(&self) -> Result<Json, Failure> {
        let scenario = self.scenario()?;
        Ok(json!({"rows": self.cells(&scenario)?}))
    }

    fn damping(&self) -> Result<Json, Failure> {
        let (study, frequencies) = self.relay()?;
        let limit = study.relay.frequency_limit();
        Ok(json!({"frequency_limit_rad_s": limit, "rows": study.table(&frequencies)}))
    }
}
