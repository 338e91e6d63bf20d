//! Explorer of a campaign or a sweep: one page, without references to others, on which any metric is seen over any key.

use std::path::Path;

use flexsc_core::Scenario;
use flexsc_core::formats::reader_units::{ReaderUnit, ReaderUnits};
use serde_json::{Value as Json, json};

use super::metric_column::MetricColumn;
use super::table::{CampaignKey, CampaignRuns};
use super::worst;
use crate::error::CliError;

/// Page with the places `NAME`, for the name of the campaign, and `DATA`.
const PAGE: &str = include_str!("explorer.html");
/// Largest number of runs on a page.
const MOST_RUNS: usize = 50_000;

/// Returns the page of the runs in a directory.
///
/// # Errors
/// Too many runs for a page, or no metric.
pub fn page(runs: &CampaignRuns, directory: &Path, units: ReaderUnits) -> Result<String, CliError> {
    let wrong = |why: String| CliError::Arguments(format!("{}: {why}", directory.display()));
    let count = runs.numbers.len();
    if count > MOST_RUNS {
        return Err(wrong(format!("an explorer has at most {MOST_RUNS} runs, got {count}")));
    }
    let varying = |metric: &&MetricColumn| metric.varies() || metric.requirement.is_some();
    let metrics: Vec<Json> =
        runs.metrics.iter().filter(varying).map(|metric| metric_json(runs, metric, units)).collect();
    if metrics.is_empty() {
        return Err(wrong("no metric varies from run to run".to_owned()));
    }
    let columns: Vec<Json> = runs.keys.iter().map(|key| key_json(runs, key, units)).chain(metrics).collect();
    let run = |index: usize| {
        json!({
            "number": runs.numbers[index], "error": runs.errors[index],
            "command": worst::repeating_command(runs, directory, index),
        })
    };
    let data = json!({ "columns": columns, "runs": (0..count).map(run).collect::<Vec<_>>() });
    // A script ends at the first `</script`, also within a string.
    let data = data.to_string().replace("</", "<\\/");
    // The name may be `DATA`.
    let (before, after) = PAGE.split_once("DATA").unwrap_or((PAGE, ""));
    Ok(before.replace("NAME", &escaped(&runs.name)) + &data + after)
}

fn escaped(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;")
}

/// Returns the largest size of a finite value.
fn largest(values: &[f64]) -> f64 {
    values.iter().filter(|value| value.is_finite()).fold(0.0, |most: f64, value| most.max(value.abs()))
}

/// Returns a column of the page: name, label, and values in a unit.
fn column_json(name: &str, label: &str, unit: &ReaderUnit, values: &[f64]) -> Json {
    let shown: Vec<Json> = values.iter().map(|value| json!(unit.value(*value))).collect();
    json!({ "name": name, "label": label, "unit": unit.name, "values": shown, "limit": null, "isKey": false })
}

/// Returns a key in the unit of readers.
fn key_json(runs: &CampaignRuns, key: &CampaignKey, units: ReaderUnits) -> Json {
    let most = largest(&key.values);
    let of_key = |(scenario, _): &(Scenario, _)| scenario.reader_unit(&key.name, most, units);
    let unit = runs.scenario.as_ref().map_or_else(|| units.fitting(most, ""), of_key);
    let mut data = column_json(&key.name, &key.name, &unit, &key.values);
    data["isKey"] = json!(true);
    data
}

/// Returns a metric in the unit of its limit, or else in that of readers, with the order of its values from good to bad.
fn metric_json(runs: &CampaignRuns, metric: &MetricColumn, units: ReaderUnits) -> Json {
    let (label, si) = metric.label();
    let required = runs.required(metric);
    let unit = match &required {
        Some(own) if !own.unit.name.is_empty() => {
            units.in_place_of(&own.unit, si).unwrap_or_else(|| own.unit.clone())
        }
        _ => units.for_metric(&metric.name, largest(&metric.values), si),
    };
    let mut data = column_json(&metric.name, &label, &unit, &metric.values);
    data["limit"] = json!(required.map(|own| unit.value(own.limit)));
    let order: Vec<Json> = (0..metric.values.len())
        .map(|index| json!(worst::badness(metric, index).map_or(-1.0, |bad| bad.min(1e300))))
        .collect();
    data["order"] = json!(order);
    data
}
