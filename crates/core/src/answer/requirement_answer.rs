//! Requirement in the answer: value, limit, margin, and the largest value with its instant, in the unit of the limit.

use flexsc_formats::reader_units::{number, percent};
use flexsc_scenario::RequirementSource;
use serde::Serialize;

use super::largest_sample::LargestSample;
use super::lines::RunData;
use crate::requirement_verdict::{Decision, RequirementVerdict};

/// Margin above which only its bound is shown.
const AMPLE: f64 = 0.99;
/// Largest relative difference of two values that are equal but for rounding.
const ROUNDING: f64 = 1e-9;

/// Requirement of a run, and whether it is met.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct RequirementAnswer {
    /// Identifier: R and the place in the scenario, from 1.
    pub id: String,
    /// Name.
    pub name: String,
    /// Required quantity, with its index and time, in words.
    pub description: String,
    /// SI unit of value, limit and largest value.
    pub unit: &'static str,
    /// Largest accepted value.
    pub limit: f64,
    /// Value that is compared with the limit; absent without one.
    #[serde(skip_serializing_if = "is_none")]
    pub value: f64,
    /// (limit - value)/limit; absent without a value.
    #[serde(skip_serializing_if = "is_none")]
    pub margin: f64,
    /// Whether the requirement is met.
    pub met: bool,
    /// `met`, `missed`, `undecided` (the run ends too early) or `not_exercised` (nothing was to meet it).
    pub decision: Decision,
    /// Largest value in the time that counts, with its instant.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub largest: Option<LargestValue>,
    /// Numbers in the unit of the limit.
    pub text: RequirementText,
}

/// Largest value of a requirement.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct LargestValue {
    /// Value.
    pub value: f64,
    /// Time (s).
    pub at_s: f64,
    /// Name of the mode of operation.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub mode: Option<String>,
}

/// Texts of a requirement, in the unit of its limit.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct RequirementText {
    /// Unit.
    pub unit: String,
    /// Limit as it was written.
    pub limit: String,
    /// Value with its unit, on the value's side of the limit.
    pub value: String,
    /// Margin; absent without a value.
    #[serde(skip_serializing_if = "String::is_empty")]
    pub margin: String,
    /// Largest value with instant and mode, or these alone if it is the value; of a requirement over time the value that decides;
    /// absent without one.
    #[serde(skip_serializing_if = "String::is_empty")]
    pub largest: String,
    /// Word before `largest` on a screen.
    #[serde(skip)]
    pub(super) largest_word: &'static str,
}

#[expect(clippy::trivially_copy_pass_by_ref, reason = "the form that serde calls")]
fn is_none(value: &f64) -> bool {
    !value.is_finite()
}

impl RequirementAnswer {
    /// Returns the answer to a requirement with this place in the scenario.
    pub(super) fn new(
        run: &RunData<'_>,
        (index, verdict): (usize, &RequirementVerdict),
        peak: Option<LargestSample>,
    ) -> Self {
        let RequirementVerdict { requirement, decision, value, .. } = verdict;
        let (limit, value) = (requirement.limit, *value);
        let written = requirement.written_limit.as_deref();
        let unit = run.units.as_written(written, limit, requirement.unit);
        let mode = |index: usize| run.scenario.mode.get(index).map(|mode| mode.name.clone());
        let largest = peak.filter(|peak| peak.value.is_finite());
        let largest =
            largest.map(|peak| LargestValue { value: peak.value, at_s: peak.at, mode: mode(peak.mode) });
        // The value of a requirement over time is that at the instant that decides.
        let is_timed = matches!(requirement.source, RequirementSource::Formula(_));
        let margin = (limit - value) / limit;
        let with_unit = |number: String| match &*unit.name {
            "" => number,
            name => format!("{number} {name}"),
        };
        let is_value = |own: &LargestValue| (own.value - value).abs() <= ROUNDING * value.abs();
        let text = RequirementText {
            unit: unit.name.to_string(),
            limit: unit.limit(limit, written),
            value: match decision {
                _ if value.is_finite() => with_unit(unit.number_against(value, limit)),
                Decision::Undecided => "undecided, the run ends too early".to_owned(),
                Decision::NotExercised => "not exercised".to_owned(),
                Decision::Met | Decision::Missed => "no value".to_owned(),
            },
            margin: margin_text(margin, value / limit),
            largest: largest.as_ref().map_or_else(String::new, |own| {
                let mode = own.mode.as_ref().map_or_else(String::new, |mode| format!(", {mode}"));
                let when = format!("at {} s{mode}", number(own.at_s));
                if is_value(own) { when } else { format!("{} {when}", unit.quantity(own.value)) }
            }),
            largest_word: match (is_timed, largest.as_ref().is_some_and(is_value)) {
                (true, true) => "decided",
                (true, false) => "decided by",
                (false, _) => "largest",
            },
        };
        Self {
            id: requirement_id(index),
            name: requirement.name.clone(),
            description: requirement.description(),
            unit: requirement.unit,
            limit,
            value,
            margin,
            met: *decision == Decision::Met,
            decision: *decision,
            largest,
            text,
        }
    }
}

/// Returns the identifier of the requirement at a place in the scenario.
pub fn requirement_id(index: usize) -> String {
    format!("R{}", index + 1)
}

/// Returns a margin in whole per cent, or how many limits the value is; empty without a number.
pub(super) fn margin_text(margin: f64, multiple: f64) -> String {
    if !margin.is_finite() {
        return String::new();
    }
    if margin > AMPLE {
        return "> 99 %".to_owned();
    }
    if margin < -1.0 {
        return format!("{} × limit", number(multiple));
    }
    if margin < 0.0 { format!("-{}", percent(-margin)) } else { percent(margin) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn margins_are_in_per_cent_or_multiples() {
        let cases = [
            (0.2795, "28 %"),
            (0.995, "> 99 %"),
            (0.0, "0 %"),
            (-0.12, "-12 %"),
            (-18.5, "19.5 × limit"),
            (-1e-4, "-0.01 %"),
            (f64::NAN, ""),
        ];
        for (margin, text) in cases {
            assert_eq!(margin_text(margin, 1.0 - margin), text);
        }
    }
}
