//! `flexsc check`: validation of scenario files.

use std::io::Write;
use std::path::{Path, PathBuf};

use flexsc_core::analysis::pulse_describing_function::PulsedLoop;
use flexsc_core::campaign::Campaign;
use flexsc_core::formats::count::counted;
use flexsc_core::formats::document::ConfigError;
use flexsc_core::{Scenario, ScenarioError};
use serde_json::{Value as Json, json};

use crate::error::CliError;
use crate::human::{digits, seconds};
use crate::{print, say, scenario};

#[derive(clap::Args)]
pub struct CheckArgs {
    /// Scenario files
    #[arg(required = true, value_name = "SCENARIO")]
    scenarios: Vec<PathBuf>,
    /// Set a key of each scenario, such as law.relay.k_t=0.34
    #[arg(long, value_name = "KEY=VALUE")]
    set: Vec<String>,
    /// Print one JSON object for each scenario on stdout, with the mistakes of one that is not accepted
    #[arg(long)]
    json: bool,
}

pub fn run(args: &CheckArgs) -> Result<(), CliError> {
    let mut all = true;
    for path in &args.scenarios {
        match scenario::load(path, &args.set, None) {
            Ok(scenario) if args.json => print_object(&accepted_object(path, &scenario))?,
            Ok(scenario) => print_accepted(path, &scenario),
            Err(CliError::Scenario(error)) => {
                if args.json {
                    print_object(&refused_object(path, &error))?;
                } else {
                    CliError::Scenario(error).print();
                }
                all = false;
            }
            Err(other) => return Err(other),
        }
    }
    if all { Ok(()) } else { Err(CliError::Told) }
}

fn print_object(object: &Json) -> Result<(), CliError> {
    print(format!("{object}\n").as_bytes())
}

/// Number of runs of a campaign whose draws are checked.
const DRAWS: u64 = 16;

/// Returns the remark that the draws of `[uncertain]` give scenarios that are not accepted.
fn refused_draws(path: &Path, scenario: &Scenario) -> Option<ConfigError> {
    if scenario.uncertain.is_empty() && scenario.correlated.is_empty() {
        return None;
    }
    let why = match Campaign::new(scenario.clone(), &path.display().to_string(), []) {
        Ok(campaign) => {
            let failed = |run: u64| campaign.run(run).err().map(|error| (run, error));
            let refused: Vec<(u64, ScenarioError)> = (0..DRAWS).filter_map(failed).collect();
            let (run, error) = refused.first()?;
            format!(
                "{} of the first {DRAWS} runs of a campaign are not accepted; run {run}: {error}",
                refused.len()
            )
        }
        Err(error) => format!("has no campaign: {error}"),
    };
    Some(ConfigError::new("uncertain", why))
}

/// Share of the time of a run that is worth a remark.
const COSTLY: f64 = 0.5;

/// Returns the remark that the imbalance of wheels takes most of the time of a run.
fn costly_imbalance(scenario: &Scenario) -> Option<ConfigError> {
    let (wheels, key) = scenario.actuator.wheels()?;
    wheels.imbalance.as_ref()?;
    let balanced = scenario.clone().with(|written| written.actuator.balance_wheels());
    let [whole, rest] = [scenario.cost(None, false).seconds, balanced.ok()?.cost(None, false).seconds];
    (whole - rest > COSTLY * whole).then(|| {
        let why = format!(
            "multiplies the time of a run by {}, to about {}, since steps resolve each turn of the wheels: leave it out unless you study \
             vibration",
            digits((whole / rest).round()),
            seconds(whole)
        );
        ConfigError::new(format!("{key}.imbalance"), why)
    })
}

/// Returns the remark that the loads of unbalanced wheels cancel, because their rotors start at the same angle and turn
/// against each other.
fn cancelling_imbalance(scenario: &Scenario) -> Option<ConfigError> {
    let (wheels, key) = scenario.actuator.wheels()?;
    let imbalance = wheels.imbalance.as_ref()?;
    let speeds = wheels.speeds(wheels.count());
    let mut pairs = (0..speeds.len()).flat_map(|one| (0..one).map(move |other| (one, other)));
    let cancels = |(one, other): (usize, usize)| {
        speeds[one] != 0.0 && speeds[one] == -speeds[other] && imbalance.is_in_step(one, other)
    };
    pairs.any(cancels).then(|| {
        let why = "starts equal wheels of opposite speeds at the same angle: their loads cancel in part until noise drives them \
                   apart; give `angle` for each wheel, or draw it in `[uncertain]`";
        ConfigError::new(format!("{key}.imbalance"), why)
    })
}

/// Returns the remark that the describing function of pulses predicts a limit cycle.
fn predicted_cycle(scenario: &Scenario) -> Option<ConfigError> {
    let (_, key) = scenario.actuator.thrusters()?;
    let cycles = PulsedLoop::from_scenario(scenario).ok()?.cycles;
    let cycle = cycles.iter().find(|cycle| cycle.stable).or(cycles.first())?;
    let (period, demand) = (digits(cycle.period_s), digits(cycle.torque_amplitude_nm));
    let effect = if cycle.stable {
        format!("predicts a limit cycle of {period} s, with a demand of {demand} N m")
    } else {
        format!("predicts swings of {period} s that grow from a demand of {demand} N m on")
    };
    let why = format!("has pulses whose describing function {effect}: see `flexsc cycle`");
    Some(ConfigError::new(key, why))
}

/// Returns the remarks on an accepted scenario.
fn remarks(path: &Path, scenario: &Scenario) -> Vec<ConfigError> {
    scenario
        .remarks()
        .into_iter()
        .chain(scenario.aliased_modes())
        .chain(costly_imbalance(scenario))
        .chain(cancelling_imbalance(scenario))
        .chain(predicted_cycle(scenario))
        .chain(refused_draws(path, scenario))
        .collect()
}

/// Returns an accepted scenario as `--json` prints it, with its remarks.
pub fn accepted_object(path: &Path, scenario: &Scenario) -> Json {
    let cost = scenario.cost(None, false);
    let remark = |of: &ConfigError| json!({"key": of.key, "message": of.to_string()});
    json!({
        "file": path.display().to_string(), "scenario": scenario.name, "duration_s": scenario.duration.seconds(),
        "modes": scenario.mode_count(), "accepted": true, "estimate_s": cost.seconds,
        "needs_yes": cost.limit_exceeded().is_some(),
        "remarks": remarks(path, scenario).iter().map(remark).collect::<Vec<_>>(),
    })
}

fn print_accepted(path: &Path, scenario: &Scenario) {
    let (modes, duration) = (scenario.mode_count(), scenario.duration.seconds());
    let cost = scenario.cost(None, false);
    let running_time = seconds(cost.seconds);
    say!(
        "{}: accepted: {duration} s, {}; a run takes about {running_time} on one core",
        path.display(),
        counted(modes, "mode")
    );
    if let Some(why) = cost.limit_exceeded() {
        say!("  {why}");
    }
    for remark in remarks(path, scenario) {
        say!("  remark: {remark}");
    }
}

/// Returns the errors of a scenario that is not accepted, each with its position, as `--json` prints them.
pub fn refused_object(path: &Path, error: &ScenarioError) -> Json {
    let mistakes = error.mistakes().into_iter().map(|mistake| {
        json!({
            "line": mistake.place.as_ref().map(|place| place.line),
            "column": mistake.place.as_ref().map(|place| place.column),
            "key": mistake.key,
            "message": mistake.message,
            "suggestion": mistake.suggestion,
        })
    });
    let mistakes: Vec<_> = mistakes.collect();
    json!({"file": path.display().to_string(), "accepted": false, "mistakes": mistakes})
}
