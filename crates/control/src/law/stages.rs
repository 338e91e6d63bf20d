//! Sequence of laws, each from a given time on.

use flexsc_formats::document::ConfigError;
use flexsc_numerics::quantity::Time;
use flexsc_numerics::time::{Instant, Span};
use flexsc_record::Report;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::b_dot::require_field;
use super::{
    Authority, ControlOutput, DecisionCause, ErrorBand, EstimateNeeds, Law, LawKind, LawSpec, LawState,
    ReferenceNeeds, Setpoint, TorqueConditions, Tunable,
};
use crate::actuator::ActuatorName;
use crate::custom::PartError;
use crate::offers::{LawOffers, LawPlace, Offers};
use crate::part::{Part, ReportContext};
use crate::requirement::Requirements;
use crate::state_estimate::StateEstimate;

/// Laws that act one after another, or in modes of operation.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(transparent)]
pub struct Stages {
    list: Vec<Stage>,
    /// True for the laws of modes, which a sequence of modes selects.
    #[serde(skip)]
    of_modes: bool,
}

/// A law that acts from a given time on.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Stage {
    /// Start time (s); 0 for the first stage.
    #[serde(default)]
    pub from: Time,
    /// The law.
    pub law: LawKind,
    /// Kinds of the `[[actuator]]` entries that execute the commands of the law, such as `["wheels"]`; default: all.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub actuators: Option<Vec<ActuatorName>>,
}

impl Stage {
    /// Returns the start time.
    pub fn begins(&self) -> Instant {
        Instant::START + Span::from_seconds(self.from.get())
    }

    /// Returns true if actuators of a kind execute the commands of the law.
    pub fn selects(&self, kind: &str) -> bool {
        self.actuators.as_ref().is_none_or(|names| names.iter().any(|name| name.as_str() == kind))
    }
}

impl Stages {
    /// Creates the laws of modes of operation, whose start times do not count.
    pub fn for_modes(list: Vec<Stage>) -> Self {
        Self { list, of_modes: true }
    }

    /// Returns true for the laws of modes.
    pub fn are_modes(&self) -> bool {
        self.of_modes
    }

    /// Returns the stages in the order of their start times, or of the modes.
    pub fn as_slice(&self) -> &[Stage] {
        &self.list
    }

    /// Creates the run-time state of the laws about an axis, each with the authority of the actuators of its stage.
    pub fn start_with(&self, authorities: &[Authority]) -> Box<dyn Law> {
        let laws = self.list.iter().zip(authorities);
        let stages = laws.map(|(stage, authority)| (stage.begins(), stage.law.start(authority)));
        let stages: Vec<_> = stages.collect();
        let places = (0..self.list.len()).map(|index| self.place(index)).collect();
        let unused = stages.iter().filter(|_| self.of_modes).map(|(_, law)| law.clone()).collect();
        let mode = self.of_modes.then_some(0);
        Box::new(StagesState { stages, active: 0, places, tuned: None, unused, mode, restarts: false })
    }

    /// Iterates over the laws.
    pub fn laws(&self) -> impl Iterator<Item = &LawKind> {
        self.list.iter().map(|stage| &stage.law)
    }

    /// Returns the key prefix of the law of a stage: `[0].law.pd.` and the like.
    fn place(&self, index: usize) -> String {
        format!("[{index}].law.{}.", self.list[index].law.kind())
    }

    /// Returns the start time of the last stage.
    pub fn last_start(&self) -> Instant {
        self.list.last().map_or(Instant::START, Stage::begins)
    }

    /// Checks the stages; returns a key within them and the reason.
    pub fn inconsistency(&self) -> Option<ConfigError> {
        let Some(first) = self.list.first() else {
            return Some(ConfigError::new("", "must have one law or more, got none"));
        };
        if !self.of_modes && first.from != Time::ZERO {
            let why = format!("must be 0, or left out, for the first, got {}", first.from.get());
            return Some(ConfigError::new("[0].from", why));
        }
        let late = self.list.windows(2).position(|pair| pair[0].from >= pair[1].from);
        if let Some(late) = late.filter(|_| !self.of_modes) {
            let why = format!("must be later than the one before, got {}", self.list[late + 1].from.get());
            return Some(ConfigError::new(format!("[{}].from", late + 1), why));
        }
        let inertia = self.laws().find_map(LawKind::inertia);
        self.list.iter().enumerate().find_map(|(index, stage)| {
            let key = format!("[{index}].law.{}", stage.law.kind());
            match &stage.law {
                law if law.inertia().is_some_and(|own| Some(own) != inertia) => {
                    Some(ConfigError::new(format!("{key}.inertia"), "must be that of the laws before"))
                }
                law if law.offers().is_three_axis => {
                    let why = if self.of_modes {
                        "acts about three axes together: a mode has a law about each axis"
                    } else {
                        "acts about three axes together: a stage has a law about each axis"
                    };
                    Some(ConfigError::new(key, why))
                }
                law @ (LawKind::BDot(_)
                | LawKind::Pd(_)
                | LawKind::Attitude(_)
                | LawKind::StateSpace(_)
                | LawKind::Open(_)
                | LawKind::Own(_)) => law.inconsistency().map(|fault| fault.within(&key)),
                LawKind::Relay(_) | LawKind::PhasePlane(_) | LawKind::PerAxis(_) | LawKind::Stages(_) => {
                    let why =
                        "must be one of `attitude`, `b_dot`, `pd`, `state_space` and `open`: other laws control a whole run";
                    Some(ConfigError::new(key, why))
                }
            }
        })
    }
}

impl LawSpec for Stages {
    fn expected_torque(&self, conditions: &TorqueConditions) -> f64 {
        let laws = self.laws().filter(|_| conditions.detailed);
        laws.map(|law| law.expected_torque(conditions)).fold(0.0, f64::max)
    }

    fn start(&self, authority: &Authority) -> Box<dyn Law> {
        self.start_with(&vec![*authority; self.list.len()])
    }

    /// Returns the shortest period of the laws, and the most that one of them reads.
    fn offers(&self) -> LawOffers {
        let period = self.laws().filter_map(|law| law.period()).min();
        LawOffers::new(period, EstimateNeeds::most(self.laws().map(|law| law.needs())))
    }

    fn requires(&self, _: &LawPlace, offers: &Offers, needs: &mut Requirements) {
        if let Some(index) = self.laws().position(|law| law.offers().commands_moments) {
            require_field(&format!("[{index}].law.{}", self.list[index].law.kind()), offers, needs);
        }
    }

    /// Returns the error band of the last law.
    fn expected_band(&self) -> ErrorBand {
        self.list.last().map_or(ErrorBand::None, |stage| stage.law.expected_band())
    }

    fn tunable(&self) -> Vec<Tunable> {
        let stage_name = |(index, law): (usize, &LawKind)| {
            let place = self.place(index);
            law.tunable().into_iter().map(move |number| number.nested(&place))
        };
        self.laws().enumerate().flat_map(stage_name).collect()
    }
}

/// Run-time state of the laws about an axis.
#[derive(Clone, Debug)]
struct StagesState {
    stages: Vec<(Instant, Box<dyn Law>)>,
    /// Index of the active stage.
    active: usize,
    /// Key prefix of each law among the stages, and index of the one tuned last.
    places: Vec<String>,
    tuned: Option<usize>,
    /// Laws of modes as they start, without a past; empty for stages.
    unused: Vec<Box<dyn Law>>,
    /// Index of the mode, if the stages are those of modes.
    mode: Option<usize>,
    /// True from the start of a mode until its first decision.
    restarts: bool,
}

impl Part for StagesState {
    fn report(&self, at: &ReportContext<'_>, report: &mut Report) {
        self.stages[self.active].1.report(at, report);
    }

    fn failure(&self) -> Option<PartError> {
        self.stages.iter().find_map(|(_, law)| law.failure())
    }
}

impl Law for StagesState {
    fn decide(
        &mut self,
        now: Instant,
        cause: DecisionCause,
        goal: &Setpoint,
        state_estimate: &StateEstimate,
    ) -> ControlOutput {
        let by_time = || self.stages.iter().rposition(|(begins, _)| *begins <= now).unwrap_or(0);
        let due = self.mode.unwrap_or_else(by_time);
        let is_new = due != self.active || std::mem::take(&mut self.restarts);
        let cause = if is_new { DecisionCause::Start } else { cause };
        self.active = due;
        let hold = self.stages[due].1.decide(now, cause, goal, state_estimate);
        let next = self.stages.get(due + 1).filter(|_| self.mode.is_none()).map(|(begins, _)| *begins);
        ControlOutput { until: [hold.until, next].into_iter().flatten().min(), ..hold }
    }

    fn state(&self) -> LawState<'_> {
        let tuned = self.tuned.map_or(f64::NAN, |stage| self.stages[stage].1.state().tuned);
        LawState::with_tuned(self.stages[self.active].1.state().phase, tuned)
    }

    fn reference_needs(&self) -> ReferenceNeeds {
        let tracks_manoeuvre = self.stages[self.active].1.reference_needs().tracks_manoeuvre;
        ReferenceNeeds { tracks_manoeuvre, ..ReferenceNeeds::default() }
    }

    fn enter_mode(&mut self, mode: usize) {
        if let Some(unused) = self.unused.get(mode) {
            self.stages[mode].1 = unused.clone();
            (self.mode, self.restarts) = (Some(mode), true);
        }
    }

    fn copy(&self) -> Box<dyn Law> {
        Box::new(self.clone())
    }

    fn tune(&mut self, key: &str, value: f64) {
        let own = |(index, place): (usize, &String)| Some((index, key.strip_prefix(place.as_str())?));
        if let Some((index, key)) = self.places.iter().enumerate().find_map(own) {
            self.stages[index].1.tune(key, value);
            if let Some(unused) = self.unused.get_mut(index) {
                unused.tune(key, value);
            }
            self.tuned = Some(index);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::actuator::PulseWidth;
    use crate::law::Command;

    fn stages(text: &str) -> Stages {
        #[derive(serde::Deserialize)]
        struct Of {
            stages: Stages,
        }
        flexsc_formats::document::from_text::<Of>(text).unwrap().stages
    }

    #[test]
    fn each_law_acts_from_its_time_on() {
        let laws = stages(
            "[[stages]]\nlaw.b_dot = { period = 2.0, gain = 1e4 }\n\
             [[stages]]\nfrom = 5.0\nlaw.attitude = { period = 1.0, bandwidth = 0.1 }",
        );
        assert_eq!(laws.inconsistency(), None);
        assert_eq!(laws.offers().period, Some(Span::from_seconds(1.0)));
        let authority = Authority {
            axis: 0,
            accelerations: [f64::INFINITY; 2],
            width: PulseWidth::default(),
            delay: 0.0,
            threshold: 0.0,
        };
        let mut law = laws.start(&authority);
        let estimate = StateEstimate { angle: 0.2, field_rate: -3e-7, ..StateEstimate::default() };
        let (mut now, mut decisions) = (Instant::START, Vec::new());
        while now.seconds() < 7.0 {
            let hold = law.decide(now, DecisionCause::Timeout, &Setpoint::default(), &estimate);
            decisions.push((now.seconds(), hold.command));
            now = hold.until.unwrap();
        }
        let (moment, turn) = (Command::Moment(3e-3), Command::Acceleration(-2e-3));
        let times: Vec<f64> = decisions.iter().map(|(t, _)| *t).collect();
        assert_eq!(times, [0.0, 2.0, 4.0, 5.0, 6.0]);
        assert!(decisions[..3].iter().all(|(_, command)| *command == moment), "{decisions:?}");
        let Command::Acceleration(found) = decisions[4].1 else { panic!("{decisions:?}") };
        let Command::Acceleration(exact) = turn else { panic!() };
        assert!((found - exact).abs() < 1e-15);
    }

    #[test]
    fn what_are_no_stages_is_refused() {
        let fault = |text: &str| stages(text).inconsistency().unwrap().to_string();
        let b_dot = "law.b_dot = { period = 2.0, gain = 1e4 }";
        assert!(fault("stages = []").contains("one law or more"));
        assert!(fault(&format!("[[stages]]\nfrom = 1.0\n{b_dot}")).starts_with("`[0].from` must be 0"));
        assert!(
            fault(&format!("[[stages]]\n{b_dot}\n[[stages]]\n{b_dot}"))
                .starts_with("`[1].from` must be later")
        );
        let relay =
            "law.relay = { dead_zone = 1e-3, hysteresis = 1e-4, strong = 1.0, weak = 0.1, k_t = 0.3 }";
        assert!(fault(&format!("[[stages]]\n{relay}")).starts_with("`[0].law.relay` must be one of"));
    }
}
