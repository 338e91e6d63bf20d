//! Worst runs of a campaign, and the command that repeats each with its log.

use std::fmt::Write;
use std::path::{Path, PathBuf};

use flexsc_core::campaign::Design;
use flexsc_core::formats::count::counted;
use flexsc_core::formats::reader_units::ReaderUnits;
use flexsc_core::metrics::goal;
use serde_json::json;

use super::metric_column::MetricColumn;
use super::table::{CampaignRuns, ScenarioSource};

/// Metrics whose larger values are better.
const MORE: [&str; 4] =
    ["envelope_reduction", "envelope_frozen_reduction", "nis_inside_95", "lock_lost_at_s"];
/// Metrics whose ideal value is 1.
const ONE: [&str; 2] = ["nees_mean", "nis_mean"];
/// Metrics without a value if the expected event never happened.
const NEVER: [&str; 3] = ["settling_time_s", "energy_below_10pct_at_s", "energy_below_1pct_at_s"];

/// Returns a measure of how bad a value is; `None` if the metric is neutral or has no value.
pub fn badness(metric: &MetricColumn, index: usize) -> Option<f64> {
    let (name, value) = (metric.name.as_str(), metric.values[index]);
    let neutral = ["gain_", "cycle_", "pushes_"].iter().any(|start| name.starts_with(start));
    let bad = match name {
        // A goal is 1 if it is met.
        _ if goal::NAMES.contains(&name) && value > 0.0 => f64::NAN,
        _ if neutral => f64::NAN,
        _ if MORE.contains(&name) => -value,
        _ if ONE.contains(&name) => value.ln().abs(),
        _ if (NEVER.contains(&name) || metric.requirement.is_some()) && value.is_nan() => f64::INFINITY,
        _ => value.abs(),
    };
    (!bad.is_nan()).then_some(bad)
}

/// Bad run that is worth repeating.
struct WorstRun<'a> {
    /// Name of the metric, or `error`.
    what: &'a str,
    /// Name of the metric in words, and unit of its value.
    label: (String, &'static str),
    run: u64,
    /// Value of the metric, or the error of the run.
    value: String,
    command: Option<String>,
}

fn worst<'a>(
    runs: &'a CampaignRuns,
    directory: &Path,
    metrics: &[&'a MetricColumn],
    most: usize,
) -> Vec<WorstRun<'a>> {
    let ran = |index: &usize| runs.errors[*index].is_empty();
    let reported = |what, label, index: usize, value| {
        let command = repeating_command(runs, directory, index);
        WorstRun { what, label, run: runs.numbers[index], value, command }
    };
    let all = 0..runs.numbers.len();
    let failed = all.clone().filter(|index| !ran(index)).take(most);
    let mut worst: Vec<WorstRun<'a>> = failed
        .map(|index| reported("error", Default::default(), index, runs.errors[index].clone()))
        .collect();
    for metric in metrics {
        let bad = all.clone().filter(ran).filter_map(|index| Some((badness(metric, index)?, index)));
        let mut bad: Vec<(f64, usize)> = bad.collect();
        bad.sort_by(|a, b| b.0.total_cmp(&a.0).then(a.1.cmp(&b.1)));
        for (_, index) in bad.into_iter().take(most) {
            let text = metric.text(index);
            let value = if text.is_empty() { "never".to_owned() } else { text };
            worst.push(reported(metric.title(), metric.label(), index, value));
        }
    }
    worst
}

/// Returns the command that repeats a run with its log; `None` without the scenario.
pub fn repeating_command(runs: &CampaignRuns, directory: &Path, index: usize) -> Option<String> {
    let (_, source) = runs.scenario.as_ref()?;
    Some(match source {
        ScenarioSource::File(path) => command(runs, directory, path, index),
        ScenarioSource::Directory(path) => command_from(path, runs.numbers[index]),
    })
}

/// Returns the command that repeats a run, with its log and a table of its own.
fn command(runs: &CampaignRuns, directory: &Path, scenario: &Path, index: usize) -> String {
    let number = runs.numbers[index];
    let description = std::fs::read_to_string(scenario).unwrap_or_default();
    let noise_run = Design::described_noise_run(&description, number);
    let mut command = format!("flexsc simulate {}", quoted(&scenario.display().to_string()));
    for key in runs.swept() {
        let _ = write!(command, " --set {}", quoted(&format!("{}={}", key.name, key.text(index))));
    }
    let own: PathBuf = directory.join(format!("run-{number}"));
    let _ = write!(
        command,
        " --runs {noise_run}:{} --log full --table csv -o {}",
        noise_run + 1,
        quoted(&own.display().to_string())
    );
    command
}

/// Returns the command that repeats a run of a directory of parts.
fn command_from(directory: &Path, number: u64) -> String {
    let own = directory.join(format!("run-{number}"));
    let [directory, own] = [directory, &own].map(|path| quoted(&path.display().to_string()));
    format!("flexsc simulate --from {directory} --row {number} -o {own}")
}

/// Quotes a word for a shell.
fn quoted(word: &str) -> String {
    let plain = |c: char| c.is_ascii_alphanumeric() || "-_./=:+,@%".contains(c);
    if !word.is_empty() && word.chars().all(plain) {
        word.to_owned()
    } else {
        format!("'{}'", word.replace('\'', "'\\''"))
    }
}

/// Returns the table for people.
pub fn table(runs: &CampaignRuns, directory: &Path, metrics: &[&MetricColumn], most: usize) -> String {
    let worst = worst(runs, directory, metrics, most);
    if worst.is_empty() {
        return String::new();
    }
    let mut text = format!("{}: the worst of {}\n", runs.name, counted(runs.numbers.len(), "run"));
    let mut before = "";
    for found in &worst {
        if found.what != before {
            let _ = writeln!(text, "  {}", if found.what == "error" { "failed" } else { &found.label.0 });
            before = found.what;
        }
        let why = match found.value.parse() {
            // Counts are printed unchanged.
            Ok(number) if found.value.contains(['.', 'e']) => {
                ReaderUnits::Engineering.quantity(number, found.label.1)
            }
            _ => found.value.lines().next().unwrap_or_default().to_owned(),
        };
        let _ = writeln!(text, "    run {:<8}{why}", found.run);
        if let Some(command) = &found.command {
            let _ = writeln!(text, "      {command}");
        }
    }
    text
}

/// Returns a JSON line for each of the worst runs.
pub fn lines(runs: &CampaignRuns, directory: &Path, metrics: &[&MetricColumn], most: usize) -> String {
    let line = |found: WorstRun<'_>| {
        // Numbers have the digits of the table.
        let value = found.value.parse::<f64>().map_or_else(|_| json!(found.value), |value| json!(value));
        let worst = json!({
            "scenario": runs.name, "metric": found.what, "run": found.run, "value": value, "command": found.command,
        });
        format!("{}\n", json!({ "worst": worst }))
    };
    worst(runs, directory, metrics, most).into_iter().map(line).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn words_are_quoted_for_shells() {
        assert_eq!(quoted("out/scenario.toml"), "out/scenario.toml");
        assert_eq!(quoted("body.planar.modes[0].gain=1e-3"), "'body.planar.modes[0].gain=1e-3'");
        assert_eq!(quoted("it's"), "'it'\\''s'");
    }
}
