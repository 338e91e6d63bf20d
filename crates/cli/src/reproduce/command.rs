//! The commands that a page names, executed within this process: what each tells for machines, and the figures that it draws.

use std::io::Cursor;
use std::path::{Path, PathBuf};

use clap::{ArgMatches, CommandFactory};
use flexsc_core::analysis::damping::{Relay, Study};
use flexsc_core::analysis::modal::Modal;
use flexsc_core::analysis::rigid_cycle::{cycles, resonances};
use flexsc_core::analysis::sampled_loop::{Doubt, Window};
use flexsc_core::analysis::sampled_loop::{
    Goal, Loop, Region, Scaling, Search, map, midpoints, regions, robust,
};
use flexsc_core::campaign::{Campaign, Grid, Run};
use flexsc_core::law::{Law, Pd};
use flexsc_core::manoeuvre::{Common, Manoeuvre, Plan, Report, compare};
use flexsc_core::metrics::Metrics;
use flexsc_core::quantity::Positive;
use flexsc_core::record::{Detail, Log, McapLog, RunEnd};
use flexsc_core::{Scenario, SimulationError};
use serde_json::{Map, Value as Json, json};

use super::shipped;
use crate::failure::Failure;
use crate::figure::Figure;
use crate::grid::{Even, Stepped};
use crate::stop::Stop;
use crate::{Cli, damping, map as maps, plan, plot, tune};

/// A figure with its name.
type Named = (String, Figure);

/// A command as a page names it, without the program's name: every option is one that the program knows.
pub struct Command {
    text: String,
    verb: String,
    matches: ArgMatches,
}

impl Command {
    /// Reads a command.
    pub fn parse(text: &str) -> Result<Self, Failure> {
        let words = std::iter::once("flexsc".to_owned()).chain(words(text));
        let unknown = |why: String| Failure::Arguments(format!("flexsc {text}: {why}"));
        let mut all =
            Cli::command().try_get_matches_from(words).map_err(|error| unknown(error.to_string()))?;
        let (verb, matches) = all.remove_subcommand().ok_or_else(|| unknown("no verb".to_owned()))?;
        Ok(Self { text: text.to_owned(), verb, matches })
    }

    /// What the command tells: an object with its own text as `command`. Of a campaign or a sweep each metric is the list
    /// of its values over the runs.
    pub fn tell(&self) -> Result<Json, Failure> {
        let mut told = match self.verb.as_str() {
            "simulate" if self.is_given("runs") => self.campaign(None)?,
            "simulate" => self.single()?,
            "sweep" => self.campaign(self.one::<Grid>("vary"))?,
            "modes" => json!(Modal::of(&self.scenario()?.model)),
            "cycle" => self.cycle()?,
            "plan" => self.plan()?,
            "tune" => self.tune()?,
            "map" => self.map()?,
            "damping" => self.damping()?,
            _ => return Err(self.failure("no verb of a page")),
        };
        told["command"] = json!(self.text);
        Ok(told)
    }

    /// The figures that the command draws: of a simulation those of its full log.
    pub fn draw(&self, what: &str) -> Result<Figure, Failure> {
        let drawn = match self.verb.as_str() {
            "simulate" => return plot::figure_of(&self.log()?, &self.path("scenarios"), what),
            "plan" => self.plan_figures()?,
            "tune" => self.tune_figures()?,
            "map" => self.map_figure()?,
            "damping" => self.damping_figure()?,
            _ => return Err(self.failure("no verb that draws")),
        };
        let ends = |(name, _): &Named| name.ends_with(&format!("-{what}")) || name == what;
        drawn.into_iter().find(ends).map(|(_, figure)| figure).ok_or_else(|| self.failure(what))
    }

    /// A run's full log.
    pub fn log(&self) -> Result<Log, Failure> {
        let run = Campaign::new(self.scenario()?, "", None)?.run(0)?;
        let failed = |source| Failure::Run { name: run.scenario.name.clone(), source };
        let logged = || -> Result<Vec<u8>, SimulationError> {
            let provenance = Campaign::provenance(&run);
            let mut log = McapLog::new(Cursor::new(Vec::new()), &provenance, Detail::Full)?;
            let metrics = Campaign::simulate(&run, (&mut log, Stop))?;
            Ok(log.finish(&metrics.to_row(), RunEnd::Complete)?.into_inner())
        };
        Ok(Log::read(&self.path("scenarios"), logged().map_err(failed)?)?)
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
            let by_name = |row: &flexsc_core::manoeuvre::Row| (row.name.clone(), row.to_json());
            return Ok(Json::Object(rows.iter().map(by_name).collect()));
        }
        let body = scenario.one_angle()?;
        Ok(Report::new(&plan, body, band).to_json(&plan, body))
    }

    fn plan_figures(&self) -> Result<Vec<Named>, Failure> {
        let scenario = self.scenario()?;
        let (manoeuvre, plan) = self.planned(&scenario)?;
        let (body, shown) = (scenario.one_angle()?, scenario.model.outputs.len());
        let family = plan::Family::new(&scenario.name, body, &plan, manoeuvre, scenario.planned_for(), shown);
        Ok(plan::figures(&family, self.one("band").unwrap_or(0.1)))
    }

    fn planned<'a>(&self, scenario: &'a Scenario) -> Result<(&'a Manoeuvre, Plan), Failure> {
        let (Some(manoeuvre), Some(plan)) = (&scenario.manoeuvre, &scenario.plan) else {
            return Err(self.failure("no manoeuvre"));
        };
        let plan = match self.peak()? {
            None => plan.clone(),
            peak => Manoeuvre { time: None, peak_torque: peak, ..manoeuvre.clone() }
                .plan(scenario.planned_for())
                .map_err(|(key, why)| self.failure(&format!("{key} {why}")))?,
        };
        Ok((manoeuvre, plan))
    }

    fn peak(&self) -> Result<Option<Positive>, Failure> {
        let peak = self.one::<f64>("peak_torque");
        peak.map(|peak| Positive::new(peak).ok_or_else(|| self.failure("--peak-torque"))).transpose()
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

    fn tuned(&self, scenario: &Scenario) -> Result<Tuned, Failure> {
        let (of, _) = tune::sampled(scenario)?;
        let window = self.window(&of, scenario)?;
        let own = Even::new(of.frequency() / 6.0, of.frequency() * 4.0 / 3.0, 36);
        let Even(frequencies) = self.one("frequency").unwrap_or(own);
        let Stepped(gains) = self.one("gain").ok_or_else(|| self.failure("--gain"))?;
        let limit = self.one("limit").unwrap_or(200.0);
        let found = regions(&of, &frequencies, self.scaling(), gains, window, limit);
        let robust = self.one::<f64>("robust").map(|off| {
            let search = Search {
                gains,
                scaling: self.scaling(),
                window,
                doubt: Doubt {
                    frequency: off,
                    modal_gain: off,
                    authority: off,
                    delay: self.one("delay").unwrap_or(0.0),
                },
                goal: Goal::Settling,
                quantile: self.one("quantile").unwrap_or(1.0),
                margin: self.one("margin").unwrap_or(0.0),
            };
            robust(&of, &frequencies, search)
        });
        Ok(Tuned { gains, limit, regions: found, robust })
    }

    fn tune_figures(&self) -> Result<Vec<Named>, Failure> {
        let scenario = self.scenario()?;
        let Tuned { gains, limit, regions, robust } = self.tuned(&scenario)?;
        let (_, law) = tune::sampled(&scenario)?;
        let off = self.one("robust").unwrap_or(0.0);
        let robust = robust.as_deref().map(|robust| (robust, off));
        let (name, own) = (&scenario.name, law.extra.as_ref());
        Ok(tune::figures(&tune::Tuned { name, own, gains, limit, regions: &regions, robust }))
    }

    fn map(&self) -> Result<Json, Failure> {
        let scenario = self.scenario()?;
        Ok(json!({"rows": self.cells(&scenario)?}))
    }

    fn cells(&self, scenario: &Scenario) -> Result<Vec<flexsc_core::analysis::sampled_loop::Cell>, Failure> {
        let (of, law): (Loop, &Pd) = tune::sampled(scenario)?;
        let window = self.window(&of, scenario)?;
        let missing = || self.failure("--frequency and --period");
        let Even(frequencies) = self.one("frequency").ok_or_else(missing)?;
        let Even(periods) = self.one("period").ok_or_else(missing)?;
        let gain = |frequency: f64| self.one("gain").unwrap_or_else(|| law.extra_gain(frequency));
        Ok(map(&of, &frequencies, &periods, self.scaling(), gain, window))
    }

    fn map_figure(&self) -> Result<Vec<Named>, Failure> {
        let scenario = self.scenario()?;
        let (of, _) = tune::sampled(&scenario)?;
        let figure = maps::figure(&scenario.name, &self.cells(&scenario)?, (of.frequency(), of.period));
        Ok(vec![("map".to_owned(), figure)])
    }

    fn scaling(&self) -> Scaling {
        if self.is_given("dominant_alone") { Scaling::First } else { Scaling::All }
    }

    fn window(&self, of: &Loop, scenario: &Scenario) -> Result<Window, Failure> {
        let window = of.window(self.one("band"), self.one("horizon").unwrap_or(2000.0));
        window.map_err(|(key, why)| self.failure(&format!("{}: {key} {why}", scenario.name)))
    }

    fn damping(&self) -> Result<Json, Failure> {
        let (study, frequencies) = self.relay()?;
        let limit = study.relay.frequency_limit();
        Ok(json!({"frequency_limit_rad_s": limit, "rows": study.table(&frequencies)}))
    }

    fn damping_figure(&self) -> Result<Vec<Named>, Failure> {
        let (study, frequencies) = self.relay()?;
        let figure = damping::figure(&study.table(&frequencies), study.relay.frequency_limit());
        Ok(vec![("damping".to_owned(), figure)])
    }

    fn relay(&self) -> Result<(Study, Vec<f64>), Failure> {
        let number = |name: &str| self.one::<f64>(name).unwrap_or(0.0);
        let period = number("period");
        let on_time = self.one("on_time").unwrap_or(period);
        let study = Study {
            relay: Relay { period, delay: number("delay"), on_time },
            damping: number("damping"),
            acceleration: number("acceleration"),
            amplitude: number("amplitude"),
            threshold: number("threshold"),
        };
        if let Some((name, why)) = study.inconsistency() {
            return Err(self.failure(&format!("--{name} {why}")));
        }
        let Even(frequencies) = self.one("frequency").ok_or_else(|| self.failure("--frequency"))?;
        Ok((study, frequencies))
    }

    /// The scenario with the keys that the command sets.
    fn scenario(&self) -> Result<Scenario, Failure> {
        let name = if self.verb == "simulate" { "scenarios" } else { "scenario" };
        let set: Vec<String> =
            self.matches.get_many("set").map(|set| set.cloned().collect()).unwrap_or_default();
        let seed = if matches!(self.verb.as_str(), "simulate" | "sweep") { self.one("seed") } else { None };
        shipped::load(&self.path(name).to_string_lossy(), &set, seed)
    }

    fn path(&self, name: &str) -> PathBuf {
        let given = self.matches.get_one::<PathBuf>(name);
        given.map_or_else(|| Path::new("").to_owned(), PathBuf::clone)
    }

    /// The value of an option that the verb may have.
    fn one<T: Clone + Send + Sync + 'static>(&self, name: &str) -> Option<T> {
        self.matches.try_get_one::<T>(name).ok().flatten().cloned()
    }

    fn is_given(&self, name: &str) -> bool {
        matches!(self.matches.value_source(name), Some(clap::parser::ValueSource::CommandLine))
    }

    fn raw(&self, name: &str) -> String {
        let given = self.matches.get_raw(name).and_then(|mut given| given.next());
        given.map_or_else(String::new, |given| given.to_string_lossy().into_owned())
    }

    fn failure(&self, why: &str) -> Failure {
        Failure::Arguments(format!("flexsc {}: {why}", self.text))
    }
}

/// What `flexsc tune` finds.
struct Tuned {
    gains: flexsc_core::analysis::sampled_loop::Gains,
    limit: f64,
    regions: Vec<Region>,
    robust: Option<Vec<flexsc_core::analysis::sampled_loop::Robust>>,
}

/// The words of a command as a shell reads them: parted by blanks, but for those between apostrophes.
fn words(text: &str) -> Vec<String> {
    let mut words = vec![String::new()];
    for (index, part) in text.split('\'').enumerate() {
        let quoted = index % 2 == 1;
        for (blank, piece) in part.split(|c: char| !quoted && c.is_whitespace()).enumerate() {
            if blank > 0 {
                words.push(String::new());
            }
            if let Some(word) = words.last_mut() {
                word.push_str(piece);
            }
        }
    }
    words.retain(|word| !word.is_empty());
    words
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn words_are_those_of_a_shell() {
        let text = "simulate a.toml\n    --set 'x={y = 1}' --set z=2 --set k='a b'c";
        let expected = ["simulate", "a.toml", "--set", "x={y = 1}", "--set", "z=2", "--set", "k=a bc"];
        assert_eq!(words(text), expected);
    }
}
