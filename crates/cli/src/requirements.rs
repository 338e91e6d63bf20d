//! Verdicts on requirements: as text, as JSON, as a table, and as the exit code of the command.

use std::fmt::Write as _;
use std::io::Write;
use std::path::Path;

use flexsc_core::answer::Answer;
use flexsc_core::formats::count::counted;
use flexsc_core::requirement_verdict::{Decision, RequirementVerdict};
use serde_json::Value as Json;

use crate::error::CliError;
use crate::human::{Units, digits};
use crate::success_rate::success_rate;
use crate::{files, say};

/// Prints each verdict.
pub fn print(verdicts: &[RequirementVerdict], units: Units) {
    for verdict in verdicts {
        say!("  requirement    {}", text(verdict, units));
    }
}

/// Returns the verdict in words.
fn text(verdict: &RequirementVerdict, units: Units) -> String {
    let RequirementVerdict { requirement, decision, value, share, runs, runs_met, confidence, .. } = verdict;
    let limit = units.quantity(requirement.limit, requirement.unit);
    let name = &requirement.name;
    let found = if value.is_finite() {
        format!("{name} {}, at most {limit}", units.quantity(*value, requirement.unit))
    } else if share.is_finite() && *runs > 1 {
        let least = digits(100.0 * requirement.level);
        format!("{name} within {limit} for {} % of all values, at least {least} %", digits(100.0 * share))
    } else {
        format!("{name} has no value, at most {limit}")
    };
    let mut text = format!("{}: {found} ({})", decision.word(), requirement.description());
    if *runs > 1 {
        let _ = write!(text, "; {}", success_rate(*runs, *runs_met as f64 / *runs as f64));
    }
    if let Some(shown) = confidence.filter(|_| *runs > 1 || *decision == Decision::Undecided) {
        let _ = write!(text, "; confidence {} %", digits(100.0 * shown.reached));
        if let (Some(wanted), Some(needed)) = (shown.wanted, shown.runs_needed) {
            let needed = counted(needed, "run");
            let wanted_part = digits(100.0 * wanted);
            let _ = if shown.reached >= wanted {
                write!(text, ", at least {wanted_part} %")
            } else if *decision == Decision::Missed {
                // More runs are no remedy.
                write!(text, ", below {wanted_part} %")
            } else {
                write!(text, ", {needed} needed for {wanted_part} %")
            };
        }
    }
    text
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
