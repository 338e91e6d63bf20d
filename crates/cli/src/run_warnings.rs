//! Warnings about a run, from its metrics: saturation, targets that are lost there, and unstable loops.

use flexsc_core::Scenario;
use flexsc_core::control::actuator::{EndState, Saturation};
use flexsc_core::metrics::{MetricValue, Metrics};

use crate::human::{Units, digits};

/// Share of a run with a wheel at its largest momentum or speed above which a warning says so.
const FULL: f64 = 0.05;
/// Largest number of losses of the target at one limit that are written one by one.
const MOST_LISTED: usize = 5;

/// Loss of the target in a stay in a mode of operation.
struct ListedLoss<'a> {
    mode: usize,
    limit: &'a str,
    /// First time at the limit, and time there (s).
    start: f64,
    time: f64,
    /// Largest errors before and after (rad).
    before: f64,
    error: f64,
}

/// Returns warnings about a run, with angles in these units.
pub fn warnings(scenario: &Scenario, metrics: &Metrics, units: Units) -> Vec<String> {
    let mut warnings = target_losses(scenario, metrics, units);
    if let Some(share) = metrics.number("wheel_momentum_limit_share").filter(|share| *share > FULL) {
        warnings.push(format!(
            "a wheel is at its limit of momentum or speed in {:.0} % of the run, where it gives no torque one way",
            100.0 * share
        ));
    }
    if let (Some(MetricValue::Word(word)), Some(share)) =
        (metrics.get("actuator_end"), metrics.number("actuator_limit_late_share"))
    {
        let seconds = Saturation::late_seconds(scenario.duration.seconds());
        warnings.extend(EndState::warning(word, share, seconds));
    }
    if metrics.number("spectral_radius").is_some_and(|radius| radius >= 1.0) {
        warnings.push("the sampled loop is unstable: its spectral radius is not below 1".to_owned());
    }
    warnings
}

/// Returns a warning about each mode of operation whose target is lost while an actuator is at a limit, or about the run
/// without modes.
fn target_losses(scenario: &Scenario, metrics: &Metrics, units: Units) -> Vec<String> {
    let list = |name: &str| metrics.get(name).map_or_else(Vec::new, MetricValue::numbers);
    let limits = metrics.get("target_loss_limits").map_or(&[][..], MetricValue::words);
    let [modes, starts, times, before, errors] = [
        "target_loss_modes",
        "target_loss_starts_s",
        "target_loss_times_s",
        "target_loss_errors_before_rad",
        "target_loss_errors_rad",
    ]
    .map(list);
    let number = |list: &[f64], index: usize| list.get(index).copied().unwrap_or(f64::NAN);
    let losses = limits.iter().enumerate().map(|(index, limit)| ListedLoss {
        mode: number(&modes, index) as usize,
        limit,
        start: number(&starts, index),
        time: number(&times, index),
        before: number(&before, index),
        error: number(&errors, index),
    });
    let losses: Vec<ListedLoss<'_>> = losses.collect();
    let visits = list("mode_visits");
    let about = |mode: usize| {
        let own: Vec<&ListedLoss<'_>> = losses.iter().filter(|loss| loss.mode == mode).collect();
        let head = match scenario.mode.get(mode) {
            _ if own.is_empty() => return None,
            Some(named) => {
                let all = digits(number(&visits, mode));
                format!("mode {} loses its target in {} of {all} visits", named.name, own.len())
            }
            None if own.len() == 1 => "the target is lost".to_owned(),
            None => format!("the target is lost {} times", own.len()),
        };
        Some(format!("{head}: {}", causes(&own, units)))
    };
    (0..scenario.mode.len().max(1)).filter_map(about).collect()
}

/// Returns the limits at which a target is lost, each with times and errors.
fn causes(losses: &[&ListedLoss<'_>], units: Units) -> String {
    let mut limits: Vec<&str> = Vec::new();
    for loss in losses {
        if !limits.contains(&loss.limit) {
            limits.push(loss.limit);
        }
    }
    let cause = |limit: &&str| {
        let own: Vec<&&ListedLoss<'_>> = losses.iter().filter(|loss| loss.limit == *limit).collect();
        let largest =
            |number: fn(&ListedLoss<'_>) -> f64| own.iter().map(|loss| number(loss)).fold(0.0, f64::max);
        let list = |number: fn(&ListedLoss<'_>) -> f64| {
            own.iter().map(|loss| digits(number(loss))).collect::<Vec<_>>().join(", ")
        };
        let before = units.quantity(largest(|loss| loss.before), "rad");
        if own.len() > MOST_LISTED {
            let (first, time) = (digits(own[0].start), digits(largest(|loss| loss.time)));
            let error = units.quantity(largest(|loss| loss.error), "rad");
            return format!(
                "{limit} for up to {time} s, first from {first} s on, error up to {error}, before {before}"
            );
        }
        let errors: Vec<f64> = own.iter().map(|loss| loss.error).collect();
        format!(
            "{limit} for {} s from {} s on, error up to {}, before {before}",
            list(|loss| loss.time),
            list(|loss| loss.start),
            units.list(&errors, ", ", "rad"),
        )
    };
    limits.iter().map(cause).collect::<Vec<_>>().join("; ")
}
