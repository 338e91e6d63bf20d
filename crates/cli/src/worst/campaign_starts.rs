//! Worst runs of a campaign, from which a search starts.

use flexsc_core::Scenario;
use flexsc_core::campaign::Directory;
use flexsc_core::worst_case::{RunQuantity, uncertain_box};

use crate::campaign::part_files;
use crate::error::CliError;

/// Number of runs from which a search starts, of which the noise is another one than in the search.
const RUNS: usize = 16;

/// Returns the values of the uncertain keys in the runs of a campaign with the worst values of a quantity.
///
/// # Errors
/// A directory that cannot be read, or that does not have the quantity.
pub fn worst_runs(
    directory: &Directory,
    scenario: &Scenario,
    quantity: &RunQuantity,
    is_least: bool,
) -> Result<Vec<Vec<f64>>, CliError> {
    let name = match quantity {
        RunQuantity::Metric(name) => name.clone(),
        RunQuantity::Requirement(name) => {
            let place = scenario.study.requirements.iter().position(|own| own.name == *name);
            format!("requirement_values[{}]", place.unwrap_or_default())
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
    let badness = |run: &usize| if is_least { -values[*run] } else { values[*run] };
    let mut runs: Vec<usize> = (0..values.len()).filter(|run| !values[*run].is_nan()).collect();
    runs.sort_by(|a, b| badness(b).total_cmp(&badness(a)).then(a.cmp(b)));
    runs.truncate(RUNS);
    Ok(runs.into_iter().map(|run| keys.iter().map(|key| key[run]).collect()).collect())
}
