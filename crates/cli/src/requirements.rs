//! Verdicts on requirements: as text, as JSON, as a table, and as the exit code of the command.

use std::path::Path;

use flexsc_core::answer::Answer;
use flexsc_core::formats::count::counted;
use flexsc_core::formats::reader_units::{ReaderUnits, percent, percent_beside};
use flexsc_core::formats::text_columns::columns;
use flexsc_core::requirement_verdict::{Decision, RequirementVerdict};
use flexsc_core::statistics::Statistics;
use serde_json::Value as Json;

use crate::error::CliError;
use crate::files;

/// Index of the median and of the 95 % quantile among the quantiles.
const MEDIAN_AND_P95: [usize; 2] = [2, 4];
/// Their columns in the table.
const MEDIAN_AND_P95_COLUMNS: std::ops::Range<usize> = 3..5;

/// Returns the table of the verdicts as lines: with the distribution over the runs, if there are statistics of them, and the
/// level or the share of each that has one.
pub fn lines(verdicts: &[RequirementVerdict], statistics: &[Statistics], units: ReaderUnits) -> Vec<String> {
    if verdicts.is_empty() {
        return Vec::new();
    }
    let heads = ["", "requirement", "limit", "median", "95 %", "worst", "met"].map(str::to_owned);
    let mut rows = vec![heads.to_vec()];
    for (index, verdict) in verdicts.iter().enumerate() {
        let RequirementVerdict { requirement, decision, runs, runs_met, worst: (run, worst), .. } = verdict;
        let written = requirement.written_limit.as_deref();
        let unit = units.as_written(written, requirement.limit, requirement.unit);
        let own = statistics.iter().find(|s| s.name == format!("requirement_values[{index}]"));
        let [median, p95] =
            MEDIAN_AND_P95.map(|place| own.map_or_else(String::new, |own| unit.number(own.quantiles[place])));
        let mark = match decision {
            Decision::Met => "✓",
            Decision::Undecided => "?",
            Decision::Missed => "✗",
        };
        let worst =
            if worst.is_nan() { "no value".to_owned() } else { unit.beside(*worst, requirement.limit) };
        rows.push(vec![
            mark.to_owned(),
            requirement.name.clone(),
            format!("at most {}", unit.limit(requirement.limit, written)),
            median,
            p95,
            format!("{worst}, run {run}"),
            format!("{runs_met} of {runs}"),
        ]);
    }
    if statistics.is_empty() {
        for row in &mut rows {
            row.drain(MEDIAN_AND_P95_COLUMNS);
        }
    }
    let mut lines = columns(&rows, |_| true);
    lines.extend(verdicts.iter().filter_map(level_note));
    lines
}

/// Returns a line on the level of the ensemble or on the share of all values, if the requirement has one.
fn level_note(verdict: &RequirementVerdict) -> Option<String> {
    let RequirementVerdict { requirement, decision, value, share, confidence, .. } = verdict;
    let name = &requirement.name;
    let least = percent(requirement.level);
    if !value.is_finite() && share.is_finite() {
        return Some(format!(
            "{name}: within its limit for {} of all values, at least {least}",
            percent_beside(*share, requirement.level)
        ));
    }
    let shown = confidence.as_ref()?;
    let mut text = format!(
        "{name}: {} at {least} of the runs; confidence {}",
        decision.word(),
        percent_beside(shown.reached, shown.wanted.unwrap_or(1.0))
    );
    if let (Some(wanted), Some(needed)) = (shown.wanted, shown.runs_needed) {
        let wanted_part = percent(wanted);
        let more = if shown.reached >= wanted {
            format!(", at least {wanted_part}")
        } else if *decision == Decision::Missed {
            // More runs are no remedy.
            format!(", below {wanted_part}")
        } else {
            format!(", {} needed for {wanted_part}", counted(needed, "run"))
        };
        text.push_str(&more);
    }
    Some(text)
}

/// Returns the verdicts as JSON.
pub fn json(verdicts: &[RequirementVerdict]) -> Json {
    verdicts.iter().map(RequirementVerdict::to_json).collect()
}

/// Names of the columns of the table of verdicts, which are those of the objects as well.
const COLUMNS: [&str; 15] = [
    "name",
    "verdict",
    "value",
    "limit",
    "unit",
    "level",
    "interpretation",
    "share",
    "runs",
    "runs_met",
    "interval",
    "confidence",
    "confidence_wanted",
    "runs_needed",
    "description",
];

/// Writes the verdicts as a table.
pub fn write_table(path: &Path, verdicts: &[RequirementVerdict]) -> Result<(), CliError> {
    let cell = |value: &Json| match value {
        Json::Null => String::new(),
        Json::String(text) => text.clone(),
        Json::Number(number) => number
            .as_f64()
            .filter(|_| number.is_f64())
            .map_or_else(|| number.to_string(), |n| format!("{n:e}")),
        other => other.to_string(),
    };
    let table = || -> Result<Vec<u8>, csv::Error> {
        let mut writer = csv::Writer::from_writer(Vec::new());
        let names = |name: &str| match name {
            "interval" => vec!["interval_low".to_owned(), "interval_high".to_owned()],
            name => vec![name.to_owned()],
        };
        writer.write_record(COLUMNS.into_iter().flat_map(names))?;
        for verdict in verdicts {
            let object = verdict.to_json();
            let cells = COLUMNS.into_iter().flat_map(|name| match &object[name] {
                Json::Array(ends) => ends.iter().map(cell).collect(),
                value => vec![cell(value)],
            });
            writer.write_record(cells)?;
        }
        Ok(writer.into_inner().map_err(csv::IntoInnerError::into_error)?)
    };
    let bytes = table().map_err(|error| CliError::write(path)(error.into()))?;
    files::write_within(&[(path.to_owned(), bytes)])
}

/// Fails if the answer of any scenario misses a requirement.
pub fn validate_answers(answers: &[(String, Answer)]) -> Result<(), CliError> {
    let all = answers.iter().map(|(_, answer)| answer.requirements.len()).sum();
    let missed = |(scenario, answer): &(String, Answer)| -> Vec<String> {
        let missed = answer.requirements.iter().filter(|own| !own.met);
        missed.map(|own| format!("{scenario}: {} is missed", own.name)).collect()
    };
    unmet(&answers.iter().flat_map(missed).collect::<Vec<_>>(), all)
}

/// Fails if a requirement of any scenario is not met.
pub fn validate<'a>(
    scenarios: impl IntoIterator<Item = (&'a str, &'a [RequirementVerdict])>,
) -> Result<(), CliError> {
    let mut all = 0;
    let mut unmet = Vec::new();
    for (scenario, verdicts) in scenarios {
        all += verdicts.len();
        let open = verdicts.iter().filter(|verdict| verdict.decision != Decision::Met);
        unmet.extend(open.map(|verdict| {
            format!("{scenario}: {} is {}", verdict.requirement.name, verdict.decision.word())
        }));
    }
    self::unmet(&unmet, all)
}

/// Fails with the requirements that are not met, if there are any.
fn unmet(unmet: &[String], all: usize) -> Result<(), CliError> {
    if unmet.is_empty() {
        return Ok(());
    }
    let (count, all) = (unmet.len(), counted(all, "requirement"));
    Err(CliError::Requirements(format!("{count} of {all} not met; {}", unmet.join("; "))))
}
