//! Worst runs of a campaign, from which a search starts.

use flexsc_core::Scenario;
use flexsc_core::campaign::Directory;
use flexsc_core::metrics::is_not_exercised;
use flexsc_core::scenario::metric_descriptions::{REQUIREMENT_SHARES, REQUIREMENT_VALUES};
use flexsc_core::worst_case::{RunQuantity, uncertain_box};

use crate::campaign::part_files;
use crate::error::CliError;

/// Number of runs from which a search starts: several, because its runs have another noise.
const RUNS: usize = 16;

/// Returns the values of the uncertain keys in the runs of a campaign with the worst values of a quantity.
///
/// # Errors
/// A directory that cannot be read, or whose runs do not have the metric.
pub fn worst_runs(
    directory: &Directory,
    scenario: &Scenario,
    quantity: &RunQuantity,
    is_least: bool,
) -> Result<Vec<Vec<f64>>, CliError> {
    let (name, share) = match quantity {
        RunQuantity::Metric(name) => (name.clone(), None),
        RunQuantity::Requirement(name) => {
            let place = scenario.study.requirements.iter().position(|own| own.name == *name);
            let element = |list: &str| format!("{list}[{}]", place.unwrap_or_default());
            (element(REQUIREMENT_VALUES.name), Some(element(REQUIREMENT_SHARES.name)))
        }
    };
    let ranges =
        uncertain_box(scenario).map_err(|error| CliError::worst_case(&scenario.name, error.into()))?;
    let keys = ranges.keys.iter().map(|own| own.key.as_str());
    let names: Vec<&str> = std::iter::once(name.as_str()).chain(keys).collect();
    let columns = directory.columns(&names).map_err(part_files::failure)?;
    let numbers: Option<Vec<Vec<f64>>> = columns.into_iter().map(|cells| Some(cells?.numbers())).collect();
    let Some([values, keys @ ..]) = numbers.as_deref() else {
        let why = format!("has no column `{name}`, from which the search would start");
        return Err(CliError::Arguments(format!("{}: {why}", directory.path().display())));
    };
    let shares = match share {
        Some(name) => directory.column(&name).map_err(part_files::failure)?.map(|cells| cells.numbers()),
        None => None,
    };
    let badness = |run: usize| match &shares {
        // A requirement is missed without a value, unless nothing in the run was to meet it.
        Some(shares) if values[run].is_nan() && !is_not_exercised(values[run], shares[run]) => f64::INFINITY,
        _ if is_least => -values[run],
        _ => values[run],
    };
    let mut runs: Vec<usize> = (0..values.len()).filter(|run| !badness(*run).is_nan()).collect();
    runs.sort_by(|a, b| badness(*b).total_cmp(&badness(*a)).then(a.cmp(b)));
    // A requirement that no run exercises is searched from points spread over the ranges.
    if runs.is_empty() && shares.is_none() {
        let why = format!("no run has a number as `{name}`, from which the search would start");
        return Err(CliError::Arguments(format!("{}: {why}", directory.path().display())));
    }
    runs.truncate(RUNS);
    Ok(runs.into_iter().map(|run| keys.iter().map(|key| key[run]).collect()).collect())
}
