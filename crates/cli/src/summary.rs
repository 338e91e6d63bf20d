//! Summary of a run for people.

mod one_axis;
mod operation;
mod three_axes;

use std::fmt::Write as _;
use std::io::Write;

use flexsc_core::Scenario;
use flexsc_core::control::estimator::EstimatorKind;
use flexsc_core::formats::count::counted;
use flexsc_core::metrics::{MetricValue, Metrics};
use flexsc_core::requirement_verdict::{self, Decision, RequirementVerdict};

use crate::human::{Units, digits};
use crate::{requirements, run_warnings, say};

/// Data of a summary and its units.
struct Summary<'a> {
    scenario: &'a Scenario,
    metrics: &'a Metrics,
    requirements: Vec<RequirementVerdict>,
    units: Units,
}

/// Prints the result of a run, which took `took` seconds of real time.
pub fn print_summary(scenario: &Scenario, metrics: &Metrics, took: f64, units: Units) {
    let (duration, modes) = (scenario.duration.seconds(), scenario.mode_count());
    let head = format!("{}   {duration} s, {}", scenario.name, counted(modes, "mode"));
    let took = format!("{:.1} ms", took * 1e3);
    let requirements = requirement_verdict::run_verdicts(scenario, metrics);
    let summary = Summary { scenario, metrics, requirements, units };
    if scenario.axis_count() == 3 {
        say!("{head}, {took}");
        summary.three_axes();
        summary.adaptation();
    } else if scenario.law.is_switching() {
        say!("{head}, {}, {took}", counted(summary.number("switchings"), "switching"));
        summary.switchings();
        summary.goal(&[]);
    } else {
        say!("{head}, {took}");
        summary.rotation();
        summary.adaptation();
    }
    summary.operation();
    requirements::print(&summary.requirements, units);
    for warning in run_warnings::warnings(scenario, metrics, units) {
        say!("  warning        {warning}");
    }
}

impl Summary<'_> {
    /// Returns a metric, or NaN without one.
    fn number(&self, name: &str) -> f64 {
        self.metrics.number(name).unwrap_or(f64::NAN)
    }

    /// Returns a metric with its unit.
    fn quantity(&self, name: &str, unit: &str) -> String {
        self.units.quantity(self.number(name), unit)
    }

    /// Prints the goal; `bands` are those about each of three axes (rad), if there are several.
    fn goal(&self, bands: &[f64]) {
        let Some(MetricValue::Word(word)) = self.metrics.get("goal").filter(|_| self.scenario.has_goal())
        else {
            return;
        };
        let unmet = self.requirements.iter().filter(|verdict| verdict.decision != Decision::Met).count();
        let all = counted(self.requirements.len(), "requirement");
        let others = match unmet {
            0 => String::new(),
            1 => format!(" (but 1 of {all} is not)"),
            _ => format!(" (but {unmet} of {all} are not)"),
        };
        let (band, outside) = (self.number("goal_band_rad"), self.number("time_outside_s"));
        if !band.is_finite() {
            let why = if *word == "none" {
                ": law and targets promise no error; `reference.band` sets one"
            } else {
                ""
            };
            say!("  goal           {word}{why}");
            return;
        }
        let differ = bands.iter().any(|other| *other != band && other.is_finite());
        let within = match bands {
            [] => format!("within ±{}", self.units.quantity(band, "rad")),
            _ if differ => format!("each axis within its band, ±{}", self.units.list(bands, ", ±", "rad")),
            _ => format!("each axis within ±{}", self.units.quantity(band, "rad")),
        };
        let outside = digits(outside);
        match *word {
            "met" if outside == "0" => say!("  goal           met{others}: {within} all the time"),
            "met" => {
                say!(
                    "  goal           met{others}: {within} for the last tenth of the time or longer; outside for {outside} s before"
                );
            }
            _ => say!(
                "  goal           {word}: not {within} for the last tenth of the time; outside for {outside} s"
            ),
        }
    }

    /// Prints the envelope, the adaptation and the limit cycle of a relay law.
    fn switchings(&self) {
        if let Some(MetricValue::Numbers(means)) = self.metrics.get("envelope_window_means_rad")
            && let (Some(first), Some(last)) = (means.first(), means.last())
            && *first > 0.0
        {
            let change = 100.0 * (last / first - 1.0);
            let both = self.units.list(&[*first, *last], " -> ", "rad");
            say!("  envelope       {both}  (window means, {change:+.0} %)");
        }
        self.adaptation();
        if let Some(MetricValue::Word(kind)) = self.metrics.get("cycle_kind") {
            let (period, largest) = (self.number("cycle_period_s"), self.number("cycle_multiplier_max"));
            if period.is_finite() {
                let multiplier = if largest.is_finite() {
                    format!(", multiplier {}", digits(largest))
                } else {
                    String::new()
                };
                say!("  cycle          {kind}, period {} s{multiplier}", digits(period));
            } else {
                say!("  cycle          {kind}: the run is not periodic at its end");
            }
        }
    }

    /// Prints the tuned parameter of an adaptation, and its objective if it is not the envelope.
    fn adaptation(&self) {
        let Some(adaptation) = &self.scenario.adaptation else { return };
        if self.number("objective_final").is_finite() {
            let objective = adaptation.objective();
            let unit = objective.unit(self.scenario.torque_unit());
            let both = [self.number("objective_initial"), self.number("objective_final")];
            say!("  objective      {}: {}", objective.key(), self.units.list(&both, " -> ", unit));
        }
        let frozen = self.number("gain_frozen_at_s");
        let end = if frozen.is_finite() {
            format!("frozen at {} s", digits(frozen))
        } else {
            "not frozen".to_owned()
        };
        let [first, last] = ["gain_initial", "gain_final"].map(|name| digits(self.number(name)));
        say!("  {:<14} {first} -> {last}, {end}", adaptation.tunes());
    }

    /// Returns the consistency of a filter: NEES and NIS over the assessed time.
    fn consistency(&self) -> String {
        let Some(filter) = &self.scenario.estimator else { return String::new() };
        let [from, to] = filter.assess();
        let to = to.min(self.scenario.duration.seconds());
        let states = filter.states(self.scenario.mode_count());
        let mut text = format!(
            "NEES {:.2} per state, NIS {:.2} per measurement, from {} to {} s (1 if consistent",
            self.number("nees_mean"),
            self.number("nis_mean"),
            digits(from),
            digits(to)
        );
        if states > 0 {
            let [low, high] = EstimatorKind::inside(states);
            let _ = write!(text, "; 95 % of the samples within NEES {low:.2} to {high:.2}");
        }
        text + ")"
    }
}
