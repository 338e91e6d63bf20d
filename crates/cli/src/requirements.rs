//! Verdicts on requirements: as text, as JSON, as a table, and as the exit code of the command.

use std::path::Path;

use flexsc_core::answer::Answer;
use flexsc_core::formats::count::counted;
use flexsc_core::formats::reader_units::ReaderUnits;
use flexsc_core::formats::text_columns::columns;
use flexsc_core::requirement_verdict::RequirementVerdict;
use serde_json::Value as Json;

use crate::error::CliError;
use crate::files;

/// Returns the table of the verdicts as lines, and the level or the share of each that has one.
pub fn lines(verdicts: &[RequirementVerdict], units: ReaderUnits) -> Vec<String> {
    if verdicts.is_empty() {
        return Vec::new();
    }
    let mut rows = vec![["", "requirement", "limit", "worst", "met"].map(str::to_owned).to_vec()];
    for verdict in verdicts {
        let RequirementVerdict { requirement, decision, worst: (run, worst), .. } = verdict;
        let written = requirement.written_limit.as_deref();
        let unit = units.as_written(written, requirement.limit, requirement.unit);
        let worst = if worst.is_nan() {
            "no value".to_owned()
        } else {
            unit.number_against(*worst, requirement.limit)
        };
        rows.push(vec![
            decision.mark().to_owned(),
            requirement.name.clone(),
            format!("at most {}", unit.limit(requirement.limit, written)),
            format!("{worst}, run {run}"),
            verdict.runs_met_text(),
        ]);
    }
    let mut lines = columns(&rows, |_| true);
    lines.extend(verdicts.iter().filter_map(RequirementVerdict::note));
    lines
}

/// Returns the verdicts as JSON.
pub fn json(verdicts: &[RequirementVerdict]) -> Json {
    verdicts.iter().map(RequirementVerdict::to_json).collect()
}

/// Names of the columns of the table of verdicts, which are those of the objects as well.
const COLUMNS: [&str; 17] = [
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
    "runs_undecided",
    "runs_not_exercised",
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
        let missed = answer.requirements.iter().filter(|own| own.decision.fails());
        missed.map(|own| format!("{scenario}: {} is {}", own.name, own.decision.word())).collect()
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
        let open = verdicts.iter().filter(|verdict| verdict.decision.fails());
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
