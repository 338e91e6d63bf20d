//! Campaigns that a directory keeps as parts, read column by column.

use std::path::{Path, PathBuf};

use flexsc_core::campaign::{
    ColumnCells, ColumnHeading, ColumnKind, Directory, ERROR, MAIN_METRICS, RUN, RowMaker,
};
use flexsc_core::metrics::{self, goal, list_element};

use super::metric_column::{MetricColumn, elements, requirement_label};
use super::table::{CampaignKey, CampaignRuns, ScenarioSource};
use super::text_cells::TextCells;
use crate::campaign::part_files;
use crate::error::CliError;

/// Largest number of values in memory; beyond it only the main and the named metrics are read.
const HELD: usize = 40_000_000;

/// Reads the campaign of a directory, and those of its subdirectories.
pub fn read(directory: &Path, files: &[String], named: &[String]) -> Result<Vec<CampaignRuns>, CliError> {
    let within = files.iter().map(|file| directory.join(file));
    let all: Vec<PathBuf> = [directory.to_owned()]
        .into_iter()
        .chain(within)
        .filter(|path| Directory::is_campaign_directory(path))
        .collect();
    all.iter().map(|path| runs(path, named)).collect()
}

fn runs(path: &Path, named: &[String]) -> Result<CampaignRuns, CliError> {
    let directory = Directory::open(path).map_err(part_files::failure)?;
    campaign_runs(
        directory.work(),
        |names| directory.columns(names).map_err(part_files::failure),
        path,
        named,
    )
}

/// Returns the runs of a campaign, whose columns are read by their names; `path` is the campaign's directory.
pub fn campaign_runs(
    work: &RowMaker,
    read: impl Fn(&[&str]) -> Result<Vec<Option<ColumnCells>>, CliError>,
    path: &Path,
    named: &[String],
) -> Result<CampaignRuns, CliError> {
    let (campaign, scenario) = (&work.campaign, work.campaign.scenario());
    let mut columns = read(&[RUN, ERROR])?.into_iter();
    let (Some(Some(ColumnCells::Integers(numbers))), Some(Some(ColumnCells::Text(errors)))) =
        (columns.next(), columns.next())
    else {
        return Err(CliError::Arguments(format!("{}: has no runs", path.display())));
    };
    if numbers.is_empty() {
        return Err(CliError::Arguments(format!("{}: contains no runs yet", path.display())));
    }
    let keys: Vec<&str> = campaign.keys().collect();
    let is_number = |field: &&ColumnHeading| match field.kind {
        ColumnKind::Integers | ColumnKind::Numbers => true,
        ColumnKind::Text => goal::NAMES.contains(&field.name.as_str()),
        ColumnKind::Lists => false,
    };
    let is_metric = |field: &&ColumnHeading| !keys.contains(&field.name.as_str()) && is_number(field);
    let all = work.fields().iter().filter(is_metric).collect::<Vec<_>>();
    let few = all.len() * numbers.len() <= HELD;
    let wanted = |name: &str| few || MAIN_METRICS.contains(&name) || named.iter().any(|named| named == name);
    // Words and lists have no place on an axis.
    let numeric = |key: &&str| work.fields().iter().any(|field| field.name == *key && is_number(&field));
    let drawn: Vec<&str> = keys.iter().copied().filter(numeric).collect();
    let element = |name: String| {
        let (list, _) = list_element(&name)?;
        let is_list = |field: &&ColumnHeading| field.name == list && field.kind == ColumnKind::Lists;
        work.fields().iter().find(is_list)?;
        let meaning = metrics::meaning(list, Some(scenario))?;
        Some((name, meaning))
    };
    let fields: Vec<(String, _)> = all
        .into_iter()
        .filter(|field| wanted(&field.name))
        .filter_map(|field| Some((field.name.clone(), metrics::meaning(&field.name, Some(scenario))?)))
        .chain(elements(Some(scenario), named).into_iter().filter_map(element))
        .collect();
    let names: Vec<&str> =
        drawn.iter().copied().chain(fields.iter().map(|(name, _)| name.as_str())).collect();
    let mut columns = read(&names)?.into_iter().map(|column| {
        let texts = match &column {
            Some(ColumnCells::Integers(_)) => TextCells::Integers,
            Some(ColumnCells::Text(_)) => TextCells::Goals,
            _ => TextCells::Numbers,
        };
        (texts, column.map_or_else(Vec::new, |column| column.numbers()))
    });
    let varied = campaign.design().keys();
    let key = |(name, (texts, values)): (&&str, (TextCells, Vec<f64>))| CampaignKey {
        name: (*name).to_owned(),
        texts,
        values,
        swept: varied.contains(name),
    };
    let keys = drawn.iter().zip(columns.by_ref()).map(key).collect();
    let metric = |((name, meaning), (texts, values)): ((String, _), _)| {
        let requirement = requirement_label(scenario, &name);
        MetricColumn { meaning, name, requirement, texts, values }
    };
    let metrics = fields.into_iter().zip(columns).map(metric).collect();
    Ok(CampaignRuns {
        has_same_noise: campaign.design().noise_run.is_some(),
        name: scenario.name.clone(),
        scenario: Some((scenario.clone(), ScenarioSource::Directory(path.to_owned()))),
        numbers: numbers.into_iter().map(|number| number.unwrap_or_default().cast_unsigned()).collect(),
        keys,
        metrics,
        errors: errors.into_iter().map(Option::unwrap_or_default).collect(),
    })
}
