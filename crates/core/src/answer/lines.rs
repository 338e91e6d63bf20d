//! Lines of text on a run: what else is known, apart from requirements and modes of operation.

use flexsc_control::estimator::EstimatorKind;
use flexsc_formats::reader_units::{ReaderUnits, number, time};
use flexsc_scenario::Scenario;
use serde::Serialize;

use super::event::{EventKind, RunEvent};
use super::run_observer::Observed;
use crate::metrics::{MetricValue, Metrics};

/// Line of text on a run.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Line {
    /// Subject, in one or two words.
    pub head: String,
    /// Text.
    pub text: String,
    /// True for the few lines that a first screen shows.
    pub is_main: bool,
}

/// A run that has ended, from which an answer is made.
#[derive(Copy, Clone)]
pub(super) struct RunData<'a> {
    pub scenario: &'a Scenario,
    pub metrics: &'a Metrics,
    pub observed: Option<&'a Observed>,
    pub units: ReaderUnits,
}

/// Lines of an answer, in their order.
#[derive(Default)]
pub(super) struct AnswerLines(Vec<Line>);

impl AnswerLines {
    /// Adds a line that a first screen shows.
    pub fn main(&mut self, head: &str, text: impl Into<String>) {
        self.0.push(Line { head: head.to_owned(), text: text.into(), is_main: true });
    }

    /// Adds a line that is shown on demand.
    pub fn other(&mut self, head: &str, text: impl Into<String>) {
        self.0.push(Line { head: head.to_owned(), text: text.into(), is_main: false });
    }
}

impl RunData<'_> {
    /// Returns a metric, or NaN without one.
    pub fn number(&self, name: &str) -> f64 {
        self.metrics.number(name).unwrap_or(f64::NAN)
    }

    /// Returns a metric if it is a finite number.
    pub fn known(&self, name: &str) -> Option<f64> {
        self.metrics.number(name).filter(|number| number.is_finite())
    }

    /// Returns a list of numbers among the metrics; empty without one.
    pub fn list(&self, name: &str) -> Vec<f64> {
        self.metrics.get(name).map_or_else(Vec::new, MetricValue::numbers)
    }

    /// Returns a metric of an SI unit as text.
    pub fn quantity(&self, name: &str, unit: &str) -> String {
        self.units.quantity(self.number(name), unit)
    }

    /// Returns the losses of the target as events.
    pub fn losses(&self) -> Vec<RunEvent> {
        let [modes, starts, times] =
            ["target_loss_modes", "target_loss_starts_s", "target_loss_times_s"].map(|name| self.list(name));
        let limits = self.metrics.get("target_loss_limits").map_or(&[][..], MetricValue::words);
        let event = |(index, limit): (usize, &String)| {
            let from = starts.get(index).copied()?;
            let mode = self.scenario.mode.get(modes.get(index).copied()? as usize);
            Some(RunEvent {
                kind: EventKind::TargetLoss,
                part: limit.clone(),
                cause: String::new(),
                mode: mode.map(|mode| mode.name.clone()),
                from_s: from,
                to_s: from + times.get(index)?,
            })
        };
        limits.iter().enumerate().filter_map(event).collect()
    }

    /// Returns what else is known of the run.
    pub fn lines(&self) -> Vec<Line> {
        let mut lines = AnswerLines::default();
        self.supplied_parts(&mut lines);
        if self.scenario.axis_count() == 3 {
            self.three_axis_lines(&mut lines);
        } else {
            self.one_axis_lines(&mut lines);
        }
        self.adaptation(&mut lines);
        lines.0
    }

    /// Adds the roles of parts that a program supplied.
    fn supplied_parts(&self, lines: &mut AnswerLines) {
        let parts = self.scenario.custom_parts().each();
        if parts.is_empty() {
            return;
        }
        let is_continuous = self.scenario.axis_count() == 1
            && self.scenario.law.has_custom()
            && !self.scenario.law.is_switching();
        let judged = if is_continuous { "; a continuous law: it does not say that it switches" } else { "" };
        lines.main("own parts", format!("{}{judged}", parts.join(", ")));
    }

    /// Adds the tuned parameter of an adaptation, and its objective if it is not the envelope.
    fn adaptation(&self, lines: &mut AnswerLines) {
        let Some(adaptation) = &self.scenario.adaptation else { return };
        if self.known("objective_final").is_some() {
            let objective = adaptation.objective();
            let unit = objective.unit(self.scenario.torque_unit());
            let both = [self.number("objective_initial"), self.number("objective_final")];
            lines.main(
                "objective",
                format!("{} {}", objective.key().replace('_', " "), self.units.list(&both, " -> ", unit)),
            );
        }
        let end = match self.known("gain_frozen_at_s") {
            Some(frozen) => format!("frozen at {}", time(frozen)),
            None => "not frozen".to_owned(),
        };
        let both = ["gain_initial", "gain_final"].map(|name| self.number(name));
        let key = self.scenario.tuned_key().unwrap_or_default();
        let unit = self.scenario.reader_unit(&key, both[0].abs().max(both[1].abs()), self.units);
        lines.main(adaptation.tunes(), format!("{}, {end}", unit.list(&both, " -> ")));
    }

    /// Returns the consistency of a filter: NEES and NIS over the assessed time; `None` without a filter that is assessed.
    pub fn consistency(&self) -> Option<String> {
        let filter = self.scenario.estimator.as_ref()?;
        let nees = self.known("nees_mean")?;
        let [from, to] = filter.assess();
        let to = to.min(self.scenario.duration.seconds());
        let nis = number(self.number("nis_mean"));
        let states = filter.states(self.scenario.mode_count());
        let inside = if states == 0 {
            String::new()
        } else {
            let [low, high] = EstimatorKind::inside(states).map(number);
            format!(", 95 % of NEES within {low} to {high}")
        };
        Some(format!(
            "NEES {} per state, NIS {nis} per measurement from {} to {} (1 if consistent{inside})",
            number(nees),
            number(from),
            time(to)
        ))
    }
}
