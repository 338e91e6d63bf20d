//! Sequence of laws, each from a given time on.

use flexsc_formats::document::ConfigError;
use flexsc_numerics::attitude::AXES;
use flexsc_numerics::quantity::Time;
use flexsc_numerics::time::{Instant, Span};
use flexsc_record::Report;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::{
    Authority, ControlOutput, DecisionCause, ErrorBand, EstimateNeeds, Law, LawKind, LawSpec, LawState,
    ReferenceNeeds, Setpoint, StateSpace, TorqueConditions, Tunable,
};
use crate::actuator::ActuatorName;
use crate::custom::PartError;
use crate::offers::LawOffers;
use crate::part::{Part, ReportContext};
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
    /// Start time (s), later than that of the stage before; 0 for the first stage.
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

    /// Returns the key prefix of the law's numbers in a list, in which the stage has this index: `[0].law.pd.` and the like.
    pub fn key_prefix(&self, index: usize) -> String {
        format!("[{index}].law.{}.", self.law.kind())
    }

    /// Returns the kinds of the actuators that execute the commands of the law; `None` for all.
    pub fn actuator_kinds(&self) -> Option<Vec<String>> {
        let names = self.actuators.as_ref()?;
        Some(names.iter().map(|name| name.as_str().to_owned()).collect())
    }

    /// Returns true if actuators of a kind execute the commands of the law.
    pub fn selects(&self, kind: &str) -> bool {
        self.actuators.as_ref().is_none_or(|names| names.iter().any(|name| name.as_str() == kind))
    }
}

impl Stages {
    /// Creates the laws of modes of operation, whose start times do not count.
    pub fn for_modes(mut list: Vec<Stage>) -> Self {
        StateSpace::share_topic(list.iter_mut().map(|mode| &mut mode.law));
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

    /// Returns the law of a stage, to be replaced.
    pub(super) fn law_mut(&mut self, index: usize) -> Option<&mut LawKind> {
        self.list.get_mut(index).map(|stage| &mut stage.law)
    }

    /// Creates the run-time state of the laws about an axis, each with the authority of the actuators of its stage.
    pub fn start_with(&self, authorities: &[Authority]) -> Box<dyn Law> {
        let laws = self.list.iter().zip(authorities);
        let stages = laws.map(|(stage, authority)| (stage.begins(), stage.law.start(authority))).collect();
        let places = self.list.iter().enumerate().map(|(index, stage)| stage.key_prefix(index)).collect();
        Box::new(StagesState { stages, active: 0, places, tuned: None })
    }

    /// Iterates over the laws.
    pub fn laws(&self) -> impl Iterator<Item = &LawKind> {
        self.list.iter().map(|stage| &stage.law)
    }

    /// Returns the start time of the last stage.
    pub fn last_start(&self) -> Instant {
        self.list.last().map_or(Instant::START, Stage::begins)
    }
}

impl LawKind {
    /// Returns why the law cannot be that of a stage, with a key within it.
    fn unfit_for_stage(&self) -> Option<ConfigError> {
        match self {
            law if law.offers().is_three_axis => Some(ConfigError::new(
                "",
                "acts about three axes together: a stage has a law about each axis",
            )),
            Self::BDot(_)
            | Self::Pd(_)
            | Self::Attitude(_)
            | Self::StateSpace(_)
            | Self::Open(_)
            | Self::Own(_) => None,
            Self::Relay(_) | Self::PhasePlane(_) | Self::PerAxis(_) | Self::Stages(_) => {
                let why = "must be one of `attitude`, `b_dot`, `pd`, `state_space` and `open`: others act in a `[[mode]]`";
                Some(ConfigError::new("", why))
            }
        }
    }

    /// Returns why the law cannot be that of a mode of operation, with a key within it.
    fn unfit_for_mode(&self) -> Option<ConfigError> {
        let in_sequence = |law: &Self| matches!(law, Self::Stages(_));
        let why = "acts from given times of the run on, and a mode may come at any time: write each stage as a `[[mode]]`";
        match self {
            law if in_sequence(law) => Some(ConfigError::new("", why)),
            Self::PerAxis(_) => {
                let axis = (0..3).find(|axis| in_sequence(self.about(*axis)))?;
                Some(ConfigError::new(format!("{}.stages", AXES[axis]), why))
            }
            law if !law.own_targets().is_empty() => {
                let why = "are those of a whole run: write the `target` of the mode";
                Some(ConfigError::new("targets", why))
            }
            _ => None,
        }
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
        let needs = EstimateNeeds::most(self.laws().map(|law| law.needs()));
        let has = |is: fn(&LawOffers) -> bool| self.laws().any(|law| is(&law.offers()));
        LawOffers {
            finds_crossings: has(|offers| offers.finds_crossings),
            has_states: has(|offers| offers.has_states),
            ..LawOffers::new(period, needs)
        }
    }

    /// Returns the error band of the last law.
    fn expected_band(&self) -> ErrorBand {
        self.list.last().map_or(ErrorBand::None, |stage| stage.law.expected_band())
    }

    fn tunable(&self) -> Vec<Tunable> {
        let stage_name = |(index, stage): (usize, &Stage)| {
            let place = stage.key_prefix(index);
            stage.law.tunable().into_iter().map(move |number| number.nested(&place))
        };
        self.list.iter().enumerate().flat_map(stage_name).collect()
    }

    fn validate(&self) -> Option<ConfigError> {
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
            if stage.law.inertia().is_some_and(|own| Some(own) != inertia) {
                let why = "must be that of the laws before";
                return Some(ConfigError::new(format!("{key}.inertia"), why));
            }
            let fault = if self.of_modes { stage.law.unfit_for_mode() } else { stage.law.unfit_for_stage() };
            fault.map(|fault| fault.within(&key))
        })
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
        let due = self.stages.iter().rposition(|(begins, _)| *begins <= now).unwrap_or(0);
        let cause = if due == self.active { cause } else { DecisionCause::Start };
        self.active = due;
        let hold = self.stages[due].1.decide(now, cause, goal, state_estimate);
        let next = self.stages.get(due + 1).map(|(begins, _)| *begins);
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

    fn copy(&self) -> Box<dyn Law> {
        Box::new(self.clone())
    }

    fn tune(&mut self, key: &str, value: f64) {
        let own = |(index, place): (usize, &String)| Some((index, key.strip_prefix(place.as_str())?));
        if let Some((index, key)) = self.places.iter().enumerate().find_map(own) {
            self.stages[index].1.tune(key, value);
            self.tuned = Some(index);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::actuator::PulseWidth;
    use crate::law::Command;
    use flexsc_flight_precision::Precision;

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
        assert_eq!(laws.validate(), None);
        assert_eq!(laws.offers().period, Some(Span::from_seconds(1.0)));
        let authority = Authority {
            axis: 0,
            accelerations: [f64::INFINITY; 2],
            width: PulseWidth::default(),
            delay: 0.0,
            threshold: 0.0,
            precision: Precision::Double,
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
        let fault = |text: &str| stages(text).validate().unwrap().to_string();
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
