//! Keys that give a scenario a linear loop: at rest, with the sensors that have a linear model.

use flexsc_core::Scenario;

use crate::error::CliError;
use crate::scenario::{self, ScenarioArgs};

/// Returns the kinds of the sensors of attitude and rates, which have a linear model, each once.
pub fn linear_sensors(scenario: &Scenario) -> Vec<&'static str> {
    let mut kinds = Vec::new();
    for own in scenario.sensor.iter().filter(|own| own.measures_motion() && !own.measures_vector()) {
        if !kinds.contains(&own.kind()) {
            kinds.push(own.kind());
        }
    }
    kinds
}

/// Returns the keys that put the scenario at rest with the sensors that have a linear model, in a mode of operation if it has
/// modes; none without a spacecraft or such sensors.
pub fn at_rest(scenario: &Scenario, mode: usize) -> Vec<String> {
    let kinds = linear_sensors(scenario);
    if scenario.spacecraft.is_none() || kinds.is_empty() {
        return Vec::new();
    }
    let mut set = vec!["spacecraft.rate=[0, 0, 0]".to_owned()];
    if !scenario.mode.is_empty() {
        let kinds: Vec<String> = kinds.iter().map(|kind| format!("\"{kind}\"")).collect();
        set.insert(0, format!("mode[{mode}].sensors=[{}]", kinds.join(", ")));
    }
    set
}

/// Returns the failure of a verb on a linear loop, with the command that analyses the scenario at rest if it has no such loop as it
/// is.
pub fn hinted(failure: CliError, verb: &str, args: &ScenarioArgs) -> CliError {
    let text = failure.to_string();
    if !args.set.is_empty() || !text.contains("linear") || text.contains("hint: ") {
        return failure;
    }
    let Ok(scenario) = scenario::load(&args.scenario, &args.set, None) else { return failure };
    let index = scenario.mode.iter().position(|mode| Some(&mode.name) == args.mode.as_ref());
    let set: Vec<String> = match index {
        None if !scenario.mode.is_empty() => Vec::new(),
        index => at_rest(&scenario, index.unwrap_or(0)),
    };
    if set.is_empty() {
        return failure;
    }
    let mode = args.mode.as_ref().map_or_else(String::new, |mode| format!(" --mode {mode}"));
    let set: Vec<String> = set.iter().map(|pair| format!(" --set '{pair}'")).collect();
    CliError::Arguments(format!(
        "{text}\n\nhint: at rest, with the sensors that have a linear model: flexsc {verb} {}{mode}{}",
        args.scenario.display(),
        set.concat()
    ))
}
