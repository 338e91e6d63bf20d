//! Analyses of each mode of operation, at rest with the sensors that have a linear model where it has none as it is.

use flexsc_core::Scenario;

use super::html::{escaped, paragraph};
use super::study::Study;
use crate::at_rest::{at_rest, linear_sensors};
use crate::error::CliError;
use crate::{Verb, stop};

/// Analysis of a mode of operation that succeeded.
pub struct Analysed<T> {
    /// Name of the mode; empty without modes.
    pub mode: String,
    /// Keys that put it at rest with the sensors that have a linear model; none where it is analysed as it is.
    pub at_rest: Vec<String>,
    pub results: T,
}

impl<T> Analysed<T> {
    /// Returns the options of a command that has some of its own.
    pub fn options(&self, own: &str) -> String {
        let mode = Some(&self.mode).filter(|mode| !mode.is_empty()).map(|mode| format!("--mode {mode}"));
        let set = self.at_rest.iter().map(|pair| format!("--set '{pair}'"));
        let own = Some(own.to_owned()).filter(|own| !own.is_empty());
        own.into_iter().chain(mode).chain(set).collect::<Vec<_>>().join(" ")
    }
}

/// Mode of operation without a linear loop, and the reason.
pub struct Refused {
    pub mode: String,
    why: String,
}

/// Analyses each mode of operation, or the scenario without modes: as it is, or else at rest with the sensors that have a linear model.
pub fn each_mode<T>(
    study: &Study,
    words: &[&str],
    analyse: impl Fn(Verb, Scenario) -> Result<T, CliError>,
) -> Result<(Vec<Analysed<T>>, Vec<Refused>), CliError> {
    let scenario = &study.scenario;
    let modes: Vec<Option<String>> = if scenario.mode.is_empty() {
        vec![None]
    } else {
        scenario.mode.iter().map(|mode| Some(mode.name.clone())).collect()
    };
    let (mut found, mut refused) = (Vec::new(), Vec::new());
    for (index, mode) in modes.into_iter().enumerate() {
        if stop::stop_requested() {
            return Err(CliError::Interrupted(String::new()));
        }
        let name = mode.clone().unwrap_or_default();
        let mut words = words.to_vec();
        words.extend(mode.iter().flat_map(|name| ["--mode", name]));
        let attempt = |set: &[String]| {
            let (verb, scenario) = study.analysis(&words, set)?;
            analyse(verb, scenario)
        };
        let at_rest = at_rest(scenario, index);
        let done = attempt(&[]).map(|results| (Vec::new(), results)).or_else(|first| {
            if at_rest.is_empty() {
                return Err(first);
            }
            attempt(&at_rest).map(|results| (at_rest, results)).map_err(|_| first)
        });
        match done {
            Ok((at_rest, results)) => found.push(Analysed { mode: name, at_rest, results }),
            Err(CliError::Interrupted(text)) => return Err(CliError::Interrupted(text)),
            Err(failure) => refused.push(Refused { mode: name, why: short_reason(&failure.to_string()) }),
        }
    }
    Ok((found, refused))
}

/// Returns the reason of an error in one line, without the file and the hint.
fn short_reason(text: &str) -> String {
    let first = text.lines().find(|line| !line.trim().is_empty()).unwrap_or_default();
    first.split_once(": ").map_or(first, |(_, rest)| rest).trim().to_owned()
}

/// Returns the reasons for which modes have no numbers, as paragraphs.
pub fn reasons(refused: &[Refused], what: &str) -> String {
    let one = |own: &Refused| {
        let name = if own.mode.is_empty() { what.to_owned() } else { format!("mode {}", own.mode) };
        format!(
            "<p class=\"refused\">No numbers for {}: {}.</p>\n",
            escaped(&name),
            escaped(own.why.trim_end_matches('.'))
        )
    };
    refused.iter().map(one).collect()
}

/// Returns the sentence on sensors that were replaced, if any were.
pub fn replaced<T>(study: &Study, found: &[Analysed<T>]) -> String {
    let names: Vec<&str> =
        found.iter().filter(|own| !own.at_rest.is_empty()).map(|own| own.mode.as_str()).collect();
    match &names[..] {
        [] => String::new(),
        [""] => paragraph("At rest: the motion at the start has no linear model."),
        names => paragraph(&format!(
            "At rest, with {} alone: another sensor of {} has no linear model.",
            linear_sensors(&study.scenario).join(" and ").replace('_', " "),
            names.join(", ")
        )),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_reason_is_one_line_without_its_file() {
        let text = "cubesat-day: `law`: is not linear\n\nhint: take another";
        assert_eq!(short_reason(text), "`law`: is not linear");
    }
}
