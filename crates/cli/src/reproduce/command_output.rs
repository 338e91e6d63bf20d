//! Results of the commands of a page: their output with `--json`.

use std::ops::Range;
use std::sync::Arc;

use flexsc_core::campaign::{Campaign, RunOutcome};
use flexsc_core::metrics::Selection;
use serde_json::{Map, Value as Json, json};

use super::command::{PageCommand, analysed};
use super::shipped_scenarios;
use crate::error::CliError;
use crate::results::Results;
use crate::stop::stop_flag;
use crate::{Verb, bound, budget, campaign, cycle, margins, modes, simulate, spectrum};

impl PageCommand {
    /// Returns the object that the command prints, with its own text as `command_line`. For a run it has the run's
    /// metrics; for several runs each metric is the list of its values, `drawn` has such a list for each key that
    /// varies, and `runs` is their number. Other objects, one per line, are the list `rows`.
    pub fn output_of(&self) -> Result<Json, CliError> {
        let mut reported = match &self.verb {
            Verb::Simulate(args) => {
                let (scenario, path) = self.simulated(args)?;
                let campaign = Campaign::new(scenario, &path.to_string_lossy(), None)?;
                match &args.runs {
                    None => single(&campaign)?,
                    Some(runs) => columns(&several(&Arc::new(campaign), runs.range.clone())?),
                }
            }
            Verb::Sweep(args) => {
                let scenario = shipped_scenarios::load(&args.scenario, &args.set, args.seed)?;
                let (campaign, range) = args.campaign(scenario, &args.scenario.to_string_lossy())?;
                columns(&several(&Arc::new(campaign), range)?)
            }
            _ => {
                let mut lines = self.results()?.json();
                if lines.len() == 1 { lines.remove(0) } else { json!({ "rows": lines }) }
            }
        };
        reported["command_line"] = json!(self.text);
        Ok(reported)
    }

    /// Computes the results of the command's analysis.
    pub fn results(&self) -> Result<Box<dyn Results>, CliError> {
        Ok(match &self.verb {
            Verb::Modes(args) => modes::results(&analysed(&args.scenario)?, args)?,
            Verb::Cycle(args) => Box::new(cycle::results(&analysed(&args.scenario)?, args)?),
            Verb::Plan(args) => args.results(analysed(&args.scenario)?)?,
            Verb::Tune(args) => Box::new(args.results(&analysed(&args.scenario)?)?),
            Verb::Map(args) => Box::new(args.results(&analysed(&args.scenario)?)?),
            Verb::Margins(args) => Box::new(margins::results(&analysed(&args.scenario)?, args)?),
            Verb::Spectrum(args) => Box::new(spectrum::results(&analysed(&args.scenario)?, args)?),
            Verb::Budget(args) => Box::new(budget::results(analysed(&args.scenario)?, args)?),
            Verb::Bound(args) => Box::new(bound::results(&analysed(&args.scenario)?, args)?),
            Verb::Damping(args) => Box::new(args.results()?),
            Verb::Identify(args) => Box::new(args.results()?),
            Verb::Observer(args) => Box::new(args.results()?),
            _ => return Err(self.failure("no analysis")),
        })
    }
}

/// Returns the metrics of the scenario itself.
fn single(campaign: &Campaign) -> Result<Json, CliError> {
    let run = simulate::scenario_run(campaign);
    let failed = |source| CliError::run(&run.scenario.name, source);
    let metrics = Campaign::simulate(&run, stop_flag()).map_err(failed)?;
    Ok(campaign::object(campaign, run.number, &run.drawn, Ok(&metrics))["metrics"].take())
}

/// Returns the objects of some runs, all of which must succeed.
fn several(campaign: &Arc<Campaign>, range: Range<u64>) -> Result<Vec<Json>, CliError> {
    let runs = range.end - range.start;
    let mut objects = Vec::new();
    campaign.for_each_run_in_batches(
        range,
        0,
        &Selection::ALL,
        |run| Ok(Campaign::simulate(run, stop_flag())?),
        |outcome| {
            let Some(RunOutcome { number, drawn, metrics, .. }) = outcome else { return Ok(()) };
            let failed = |why| CliError::Runs { failed: 1, runs, number, why };
            let metrics = metrics.map_err(|error| failed(error.to_string()))?;
            objects.push(campaign::object(campaign, number, &drawn, Ok(&metrics)));
            Ok::<(), CliError>(())
        },
    )?;
    Ok(objects)
}

/// Returns the objects of runs as columns.
fn columns(objects: &[Json]) -> Json {
    let section = |part: &str| -> Map<String, Json> {
        let names = objects.first().and_then(|first| first[part].as_object()).into_iter().flat_map(Map::keys);
        let column = |name: &str| objects.iter().map(|object| object[part][name].clone()).collect();
        names.map(|name| (name.clone(), column(name))).collect()
    };
    let mut reported = section("metrics");
    reported.insert("drawn".to_owned(), Json::Object(section("drawn")));
    reported.insert("runs".to_owned(), json!(objects.len()));
    Json::Object(reported)
}
