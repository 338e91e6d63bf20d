//! Warnings about a run: what, where, how long, how large, and why.

use flexsc_control::actuator::{EndState, Saturation};
use flexsc_formats::reader_units::{number, percent, time};
use flexsc_numerics::time::Span;
use serde::Serialize;

use super::lines::RunData;
use super::requirement_answer::RequirementAnswer;
use crate::metrics::MetricValue;

/// Share of a run with a wheel at its largest momentum or speed above which a warning says so.
const FULL: f64 = 0.05;
/// Largest number of losses of the target at one limit that are written one by one.
const MOST_LISTED: usize = 5;
/// Angle error about one axis from which on a motion diverges: ten revolutions (rad).
const DIVERGED: f64 = 20.0 * std::f64::consts::PI;
/// Multiple of its limit beyond which the largest value of a met requirement is worth a warning.
const HIDDEN: f64 = 10.0;
/// NEES per state from which on a filter is overconfident.
const OVERCONFIDENT: f64 = 2.0;

/// Kind of a warning, the gravest first.
#[derive(Copy, Clone, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum WarningKind {
    /// The motion diverges: its numbers are of no use.
    Diverges,
    /// The sampled loop is unstable.
    Unstable,
    /// A target is lost while an actuator is at a limit.
    TargetLost,
    /// The run ends in an oscillation that does not decay.
    Oscillation,
    /// The run ends with an actuator at its limit.
    SaturatedEnd,
    /// A wheel is full for a good part of the run.
    Saturation,
    /// A filter has diverged or is overconfident.
    Filter,
    /// The level of a requirement that is met hides values far beyond its limit.
    LevelHides,
}

/// Warning about a run.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Warning {
    /// Kind.
    pub kind: WarningKind,
    /// Name of the mode of operation that it is about.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub mode: Option<String>,
    /// Words, without the kind.
    pub text: String,
    /// Number by which the gravest of several warnings of this kind is found.
    #[serde(skip)]
    pub(super) severity: f64,
}

impl WarningKind {
    /// Returns what a verdict says of a warning of this kind; `None` if the run is as good as its requirements.
    pub(super) fn reason(self, warning: &Warning) -> Option<String> {
        Some(match (self, &warning.mode) {
            (Self::TargetLost, Some(mode)) => format!("mode {mode} loses its target"),
            (Self::TargetLost, None) => "the target is lost".to_owned(),
            (Self::Unstable, _) => "the loop is unstable".to_owned(),
            (Self::Oscillation, _) => "an oscillation does not decay".to_owned(),
            (Self::Filter, _) => "the filter is overconfident".to_owned(),
            _ => return None,
        })
    }
}

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

/// Returns the warnings about a run, the gravest first.
pub(super) fn warnings(run: &RunData<'_>, requirements: &[RequirementAnswer]) -> Vec<Warning> {
    let mut warnings = run.target_losses();
    let mut add = |kind: WarningKind, severity: f64, text: String| {
        warnings.push(Warning { kind, mode: None, text, severity });
    };
    let peak = run.number("angle_error_peak_rad");
    if peak > DIVERGED {
        add(
            WarningKind::Diverges,
            peak,
            "results: of no use from the time at which the error exceeds ten revolutions".to_owned(),
        );
    }
    if let Some(radius) = run.known("spectral_radius").filter(|radius| *radius >= 1.0) {
        add(WarningKind::Unstable, radius, unstable(run, radius));
    }
    if let Some(share) = run.known("wheel_momentum_limit_share").filter(|share| *share > FULL) {
        let text = format!(
            "wheels: at the limit of momentum or speed for {} of the run, where a wheel gives no torque one way",
            percent(share)
        );
        add(WarningKind::Saturation, share, text);
    }
    if let (Some(word), Some(share)) =
        (run.metrics.word("actuator_end"), run.metrics.number("actuator_limit_late_share"))
        && let Some(text) =
            EndState::warning(word, share, Saturation::late_seconds(run.scenario.duration.seconds()))
    {
        let cycles = word == EndState::Cycling.word();
        add(if cycles { WarningKind::Oscillation } else { WarningKind::SaturatedEnd }, share, text);
    }
    if let Some(text) = filter(run) {
        add(WarningKind::Filter, run.number("nees_mean"), text);
    }
    let hidden = |own: &&RequirementAnswer| {
        own.met && own.largest.as_ref().is_some_and(|largest| largest.value > HIDDEN * own.limit)
    };
    // A target that is lost says it already.
    let is_told = |own: &&RequirementAnswer| {
        let mode = own.largest.as_ref().and_then(|largest| largest.mode.as_ref());
        warnings
            .iter()
            .any(|warning| warning.kind == WarningKind::TargetLost && warning.mode.as_ref() == mode)
    };
    let hides = requirements.iter().filter(hidden).filter(|own| !is_told(own)).map(|own| Warning {
        kind: WarningKind::LevelHides,
        mode: None,
        text: format!("{}: met by its level; largest {}", own.name, own.text.largest),
        severity: -own.margin,
    });
    let hides: Vec<Warning> = hides.collect();
    warnings.extend(hides);
    warnings.sort_by_key(|warning| warning.kind);
    warnings
}

/// Returns the words on a loop that is unstable.
fn unstable(run: &RunData<'_>, radius: f64) -> String {
    let growth = match run.scenario.law.period().map(Span::seconds) {
        Some(period) if radius > 1.0 => format!(
            "; it grows by {} with each sample of {}, tenfold every {}",
            percent(radius - 1.0),
            time(period),
            time(period * libm::log(10.0) / libm::log(radius))
        ),
        _ => String::new(),
    };
    format!("loop: unstable, spectral radius {radius:.4}{growth}")
}

/// Returns the words on a filter that has diverged, or whose covariance is too small.
fn filter(run: &RunData<'_>) -> Option<String> {
    let [nees, nis] = ["nees_mean", "nis_mean"].map(|name| run.number(name));
    if let Some(lost) = run.known("lock_lost_at_s") {
        // With innovations as expected, the filter has lost an unobservable state.
        let hint =
            if nis > 2.0 { ": the innovations exceed its `moment_noise` and sensor noise" } else { "" };
        return Some(format!("filter: diverged at {}{hint}", time(lost)));
    }
    (nees > OVERCONFIDENT)
        .then(|| format!("filter: overconfident, NEES {} per state (1 if consistent)", number(nees)))
}

impl RunData<'_> {
    /// Returns a warning about each mode of operation whose target is lost while an actuator is at a limit, or about the run
    /// without modes.
    fn target_losses(&self) -> Vec<Warning> {
        let limits = self.metrics.get("target_loss_limits").map_or(&[][..], MetricValue::words);
        let [modes, starts, times, before, errors] = [
            "target_loss_modes",
            "target_loss_starts_s",
            "target_loss_times_s",
            "target_loss_errors_before_rad",
            "target_loss_errors_rad",
        ]
        .map(|name| self.list(name));
        let at = |list: &[f64], index: usize| list.get(index).copied().unwrap_or(f64::NAN);
        let losses = limits.iter().enumerate().map(|(index, limit)| ListedLoss {
            mode: at(&modes, index) as usize,
            limit,
            start: at(&starts, index),
            time: at(&times, index),
            before: at(&before, index),
            error: at(&errors, index),
        });
        let losses: Vec<ListedLoss<'_>> = losses.collect();
        let visits = self.list("mode_visits");
        let about = |mode: usize| {
            let own: Vec<&ListedLoss<'_>> = losses.iter().filter(|loss| loss.mode == mode).collect();
            let named = self.scenario.mode.get(mode);
            let head = match named {
                _ if own.is_empty() => return None,
                Some(named) => {
                    let all = number(at(&visits, mode));
                    format!("{}: target lost in {} of {all} visits", named.name, own.len())
                }
                None if own.len() == 1 => "the target is lost".to_owned(),
                None => format!("the target is lost {} times", own.len()),
            };
            let mode = named.map(|named| named.name.clone());
            Some(Warning {
                kind: WarningKind::TargetLost,
                mode,
                text: format!("{head}, {}", self.causes(&own)),
                severity: own.iter().map(|loss| loss.error).fold(0.0, f64::max),
            })
        };
        (0..self.scenario.mode.len().max(1)).filter_map(about).collect()
    }

    /// Returns the errors, and the limits at which a target is lost, each with its times.
    fn causes(&self, losses: &[&ListedLoss<'_>]) -> String {
        let mut limits: Vec<&str> = Vec::new();
        for loss in losses {
            if !limits.contains(&loss.limit) {
                limits.push(loss.limit);
            }
        }
        let largest = |of: &[&ListedLoss<'_>], value: fn(&ListedLoss<'_>) -> f64| {
            of.iter().map(|loss| value(loss)).fold(0.0, f64::max)
        };
        let unit = self.units.fitting(largest(losses, |loss| loss.error), "rad");
        let errors: Vec<f64> = losses.iter().map(|loss| loss.error).collect();
        let errors = if losses.len() > MOST_LISTED {
            unit.quantity(largest(losses, |loss| loss.error))
        } else {
            unit.list(&errors, ", ")
        };
        let before = unit.number(largest(losses, |loss| loss.before));
        let cause = |limit: &&str| {
            let own: Vec<&ListedLoss<'_>> =
                losses.iter().copied().filter(|loss| loss.limit == *limit).collect();
            let times = if own.len() > MOST_LISTED {
                format!("up to {}", number(largest(&own, |loss| loss.time)))
            } else {
                own.iter().map(|loss| number(loss.time)).collect::<Vec<_>>().join(", ")
            };
            format!("{limit} for {times} s, first at {}", time(own[0].start))
        };
        let causes: Vec<String> = limits.iter().map(cause).collect();
        format!("error up to {errors}, before it {before}; {}", causes.join("; "))
    }
}
