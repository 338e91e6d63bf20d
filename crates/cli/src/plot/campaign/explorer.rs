//! Explorer of a campaign or a sweep: one page, without references to others, on which any metric is seen over any key.

use std::path::Path;

use flexsc_core::formats::reader_units::{ReaderUnit, ReaderUnits};
use serde_json::{Value as Json, json};

use super::metric_column::MetricColumn;
use super::table::CampaignRuns;
use super::worst;
use crate::error::CliError;

/// Page, into which the data are put.
const PAGE: &str = include_str!("explorer.html");
/// Largest number of runs on a page.
const MOST_RUNS: usize = 50_000;

/// Returns the page of the runs in a directory.
///
/// # Errors
/// Too many runs for a page, or no metric.
pub fn page(runs: &CampaignRuns, directory: &Path) -> Result<String, CliError> {
    let wrong = |why: String| CliError::Arguments(format!("{}: {why}", directory.display()));
    let count = runs.numbers.len();
    if count > MOST_RUNS {
        return Err(wrong(format!("an explorer has at most {MOST_RUNS} runs, got {count}")));
    }
    // Keys are in the units of the scenario.
    let plain = ReaderUnits::Si.fitting(1.0, "");
    let keys = runs.keys.iter().map(|key| column(&key.name, (&key.name, &plain), &key.values, None));
    let varying = |metric: &&MetricColumn| metric.varies() || metric.requirement.is_some();
    let metrics: Vec<Json> =
        runs.metrics.iter().filter(varying).map(|metric| metric_column(runs, metric)).collect();
    if metrics.is_empty() {
        return Err(wrong("no metric varies from run to run".to_owned()));
    }
    let mut columns: Vec<Json> = keys.collect();
    for column in &mut columns {
        column["isKey"] = json!(true);
    }
    columns.extend(metrics);
    let run = |index: usize| {
        json!({
            "number": runs.numbers[index], "error": runs.errors[index],
            "command": worst::repeating_command(runs, directory, index),
        })
    };
    let data = json!({ "columns": columns, "runs": (0..count).map(run).collect::<Vec<_>>() });
    // A script ends at the first `</script`, also within a string.
    let data = data.to_string().replace("</", "<\\/");
    Ok(PAGE.replace("NAME", &escaped(&runs.name)).replacen("DATA", &data, 1))
}

fn escaped(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;")
}

fn column(name: &str, (label, unit): (&str, &ReaderUnit), values: &[f64], limit: Option<f64>) -> Json {
    let shown: Vec<Json> = values.iter().map(|value| json!(unit.value(*value))).collect();
    json!({ "name": name, "label": label, "unit": unit.name, "values": shown, "limit": limit, "isKey": false })
}

/// Returns a metric in the unit of its limit, or else in that of readers, with the order of its values from good to bad.
fn metric_column(runs: &CampaignRuns, metric: &MetricColumn) -> Json {
    let (label, si) = metric.label();
    let required = runs.required(metric);
    let largest =
        metric.values.iter().filter(|value| value.is_finite()).fold(0.0, |a: f64, b| a.max(b.abs()));
    let unit = match &required {
        Some(own) if !own.unit.name.is_empty() => own.unit.clone(),
        _ => ReaderUnits::Engineering.fitting(largest, si),
    };
    let limit = required.map(|own| unit.value(own.limit));
    let mut made = column(&metric.name, (&label, &unit), &metric.values, limit);
    let order: Vec<Json> = (0..metric.values.len())
        .map(|index| json!(worst::badness(metric, index).map_or(-1.0, |bad| bad.min(1e300))))
        .collect();
    made["order"] = json!(order);
    made
}
