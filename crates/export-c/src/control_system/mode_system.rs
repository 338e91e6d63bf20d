//! Control system with modes of operation: the supervisor, and the laws of each mode. Stages of a law are modes that end at a time.

use std::sync::Arc;

use flexsc_core::control::estimator::EstimatorKind;
use flexsc_core::control::flight_quantity::FlightQuantity;
use flexsc_core::control::law::LawKind;
use flexsc_core::control::operation::ModeTables;
use flexsc_core::{Scenario, ScenarioError};
use flexsc_flight::mode_supervisor::{ModeSupervisor, ModeTest};
use flexsc_flight::quaternion::Quaternion;
use flexsc_flight::ticks::Ticks;
use flexsc_flight::vector3::Vector3;

use super::attitude_unit::{AttitudeUnit, quaternion};
use super::mode_inputs::ModeInputs;
use super::{CallLayout, Channel, NotExportable, SampledLaws, WordReader};

/// Laws of a mode.
#[derive(Clone, Debug)]
pub struct LawsOfMode {
    /// Name of the mode in C.
    pub name: String,
    /// Laws as they start; `None` of an open loop.
    pub start: Option<SampledLaws>,
    /// Laws in the run.
    current: Option<SampledLaws>,
}

/// Inputs and outputs of a step: every call looks words up by their names.
#[derive(Debug)]
struct StepLayout {
    /// Inputs of the laws of all modes, with the target attitude in place of estimates that the attitude filter gives.
    inputs: Vec<Channel>,
    /// Outputs of the laws of all modes.
    outputs: Vec<Channel>,
    /// Function of the laws of each mode; `None` of an open loop.
    laws: Vec<Option<CallLayout>>,
}

impl StepLayout {
    fn new(modes: &[LawsOfMode], has_estimator: bool) -> Self {
        let laws: Vec<Option<CallLayout>> =
            modes.iter().map(|mode| mode.start.as_ref().map(SampledLaws::layout)).collect();
        let mut inputs = each_once(laws.iter().flatten().flat_map(|layout| &layout.inputs));
        if has_estimator {
            let estimates = [FlightQuantity::Angle, FlightQuantity::Rate];
            inputs.retain(|channel| !channel.quantity.is_some_and(|own| estimates.contains(&own)));
            inputs.insert(0, Channel::from_quantity(FlightQuantity::TargetAttitude, 4, 1.0));
        }
        let outputs = each_once(laws.iter().flatten().flat_map(|layout| &layout.outputs));
        Self { inputs, outputs, laws }
    }
}

/// Returns the first channel of each name.
fn each_once<'a>(channels: impl Iterator<Item = &'a Channel>) -> Vec<Channel> {
    let mut all: Vec<Channel> = Vec::new();
    for channel in channels {
        if !all.iter().any(|known| known.name == channel.name) {
            all.push(channel.clone());
        }
    }
    all
}

/// Control system with modes of operation.
#[derive(Clone, Debug)]
pub struct ModeSystem {
    /// Lists of the supervisor.
    pub tables: ModeTables,
    /// Supervisor.
    pub supervisor: ModeSupervisor,
    /// Laws of each mode.
    pub modes: Vec<LawsOfMode>,
    /// Attitude filter that the laws read; without one the estimates are inputs.
    pub estimator: Option<AttitudeUnit>,
    /// Inputs of the supervisor.
    pub inputs: ModeInputs,
    /// Angle from the target of the mode before, and that target, from a change on to the next step.
    moved: Option<(Vector3, Quaternion)>,
    /// Inputs and outputs of a step.
    layout: Arc<StepLayout>,
}

impl ModeSystem {
    /// Returns the control system of a scenario with modes, or with stages of a law.
    pub(super) fn new(scenario: &Scenario) -> Result<Self, NotExportable> {
        let stages = scenario.law.stages();
        let has_modes = !scenario.mode.is_empty();
        let mut tables = if has_modes { scenario.mode_tables() } else { ModeTables::from_stages(stages) };
        let mut modes: Vec<LawsOfMode> = Vec::new();
        for (index, written) in tables.names.iter().enumerate() {
            let (place, what) = if has_modes {
                (format!("mode[{index}]"), format!("the mode `{written}`"))
            } else {
                (format!("law.stages[{index}]"), "a stage".to_owned())
            };
            let start = laws_of_mode(scenario, index, has_modes).map_err(|fault| {
                NotExportable::new(format!("{place}.{}", fault.key), format!("{} (in {what})", fault.reason))
            })?;
            let mut name: String = written
                .chars()
                .map(|letter| if letter.is_ascii_alphanumeric() { letter.to_ascii_lowercase() } else { '_' })
                .collect();
            if modes.iter().any(|mode| mode.name == name) {
                name = format!("{name}_{index}");
            }
            modes.push(LawsOfMode { name, current: start.clone(), start });
        }
        let estimator = AttitudeUnit::new(scenario).filter(|_| scenario.study.axes.len() == 3);
        let inputs = ModeInputs::new(scenario, &tables, estimator.is_some());
        let supervisor = ModeSupervisor::start(Ticks::default(), &mut tables.modes, &mut tables.exits);
        let layout = Arc::new(StepLayout::new(&modes, estimator.is_some()));
        Ok(Self { tables, supervisor, modes, estimator, inputs, moved: None, layout })
    }

    /// Starts the supervisor and the attitude filter again at a time, as `init` does.
    pub(super) fn start_at(&mut self, now: Ticks) {
        self.supervisor = ModeSupervisor::start(now, &mut self.tables.modes, &mut self.tables.exits);
        if let Some(unit) = &mut self.estimator {
            unit.start_at_identity(now);
        }
    }

    /// Returns the shortest period of the laws (s).
    pub(super) fn period(&self) -> f64 {
        let periods = self.modes.iter().filter_map(|mode| mode.start.as_ref()).map(|laws| laws.period);
        let shortest = periods.fold(f64::INFINITY, f64::min);
        if shortest.is_finite() { shortest } else { 1.0 }
    }

    /// Returns the functions.
    pub(super) fn calls(&self) -> Vec<CallLayout> {
        let mode = || Channel::integer("mode", "Number of the mode", 1, self.modes.len() as u64);
        let enter = CallLayout {
            name: "enter",
            about: "Enters a mode by command, as if a condition had been met.",
            is_start: true,
            inputs: vec![mode()],
            outputs: vec![mode()],
        };
        let time = |name: &str, about: &str| Channel::integer(name, about, 1, 0);
        let supervise = CallLayout {
            name: "supervise",
            about: "Tests the conditions of the present mode, and changes the mode if one is met; it comes before the step of the same time.",
            is_start: false,
            inputs: self.inputs.channels.clone(),
            outputs: vec![
                mode(),
                Channel::flag("has_changed", "True if the mode has changed: its law decides at this time", 1),
                Channel::flag(
                    "is_chattering",
                    "True if an end was met and the mode stays: it has changed too often in the last second",
                    1,
                ),
                Channel::flag("has_next", "True if conditions are tested again at the time `next`", 1),
                time("next_whole", "Time of the next test: whole seconds"),
                time("next_part", "Time of the next test: femtoseconds past them"),
                time("period_whole", "Period of the mode: whole seconds"),
                time("period_part", "Period of the mode: femtoseconds past them"),
            ],
        };
        let mut outputs = self.layout.outputs.clone();
        outputs.push(mode());
        let step = CallLayout {
            name: "step",
            about: "Decides by the laws of the present mode on the commands of a period; outputs that these laws do not have are 0.",
            is_start: false,
            inputs: self.layout.inputs.clone(),
            outputs,
        };
        let estimator = self.estimator.iter().flat_map(AttitudeUnit::calls);
        estimator.chain([enter, supervise, step]).collect()
    }

    /// Returns the index of a function; the calls of the attitude filter come first.
    pub fn call_index(&self, name: &str) -> usize {
        self.calls().iter().position(|call| call.name == name).unwrap_or(0)
    }

    /// Calls the function with this index, and returns the words of its outputs.
    pub(super) fn call(&mut self, call: usize, now: Ticks, inputs: &[u64]) -> Vec<u64> {
        let estimator_calls = if self.estimator.is_some() { 2 } else { 0 };
        match (call.checked_sub(estimator_calls), &mut self.estimator) {
            (None, Some(estimator)) if call == 0 => estimator.start(now, inputs),
            (None, Some(estimator)) => estimator.sample(now, inputs),
            (Some(0), _) => self.enter(now, inputs),
            (Some(1), _) => self.supervise(now, inputs),
            _ => self.step(now, inputs),
        }
    }

    /// Enters a mode by command, and returns the words of the outputs.
    fn enter(&mut self, now: Ticks, inputs: &[u64]) -> Vec<u64> {
        let mode = inputs.first().map_or(0, |mode| *mode as usize);
        let mode = if mode < self.modes.len() { mode } else { 0 };
        self.supervisor.enter(now, mode, &mut self.tables.modes, &mut self.tables.exits);
        self.start_laws();
        self.moved = None;
        vec![mode as u64]
    }

    /// Starts the laws of the present mode without a past.
    fn start_laws(&mut self) {
        if let Some(mode) = self.modes.get_mut(self.supervisor.active) {
            mode.current.clone_from(&mode.start);
        }
    }

    /// Tests the conditions of the present mode, and returns the words of the outputs.
    fn supervise(&mut self, now: Ticks, inputs: &[u64]) -> Vec<u64> {
        let readings = self.inputs.readings(now, inputs, self.estimator.as_ref());
        let ModeTables { modes, exits, steps, .. } = &mut self.tables;
        let ModeTest { has_changed, is_chattering, .. } =
            self.supervisor.test(now, &readings, modes, exits, steps);
        if has_changed {
            self.start_laws();
            if let Some(unit) = &self.estimator {
                let target = ModeInputs::target(inputs);
                let angle = target.rotation_to(&unit.estimator.attitude(now, &unit.entries));
                self.moved = Some((angle, target));
            }
        }
        let active = self.supervisor.active;
        let due = self.supervisor.due(&self.tables.modes, &self.tables.exits);
        let period = self.tables.modes[active].period;
        vec![
            active as u64,
            u64::from(has_changed),
            u64::from(is_chattering),
            u64::from(due.has_time),
            due.time.whole as u64,
            due.time.part as u64,
            period.whole as u64,
            period.part as u64,
        ]
    }

    /// Decides by the laws of the present mode, and returns the words of the outputs.
    fn step(&mut self, now: Ticks, inputs: &[u64]) -> Vec<u64> {
        let layout = &*self.layout;
        let given = |name: &str| words_of(&layout.inputs, inputs, name);
        let mut motion = None;
        if let Some(unit) = &self.estimator {
            let target = quaternion(&mut WordReader::new(inputs));
            let mut angle = target.rotation_to(&unit.estimator.attitude(now, &unit.entries));
            // At a change the engine moves the angles from one target to the other.
            if let Some((before, from)) = self.moved.take() {
                angle = before.plus(&target.rotation_to(&from));
            }
            let rate = unit.estimator.rate(&unit.entries);
            let words = |values: [f64; 3]| values.map(f64::to_bits);
            motion = Some([words([angle.x, angle.y, angle.z]), words([rate.x, rate.y, rate.z])]);
        }
        let active = self.supervisor.active;
        let mut outputs = vec![0; layout.outputs.iter().map(|channel| channel.count).sum()];
        let laws = self.modes.get_mut(active).and_then(|mode| mode.current.as_mut());
        if let (Some(laws), Some(Some(own))) = (laws, layout.laws.get(active)) {
            let mut words = Vec::new();
            for channel in &own.inputs {
                match (&motion, channel.name.as_str()) {
                    (Some([angle, _]), "angle") => words.extend(angle),
                    (Some([_, rate]), "rate") => words.extend(rate),
                    (_, name) => words.extend(given(name)),
                }
            }
            let decided = laws.call(laws.step_index(), now, &words);
            for channel in &own.outputs {
                let place = first_word(&layout.outputs, &channel.name);
                let found = words_of(&own.outputs, &decided, &channel.name);
                outputs[place..place + found.len()].copy_from_slice(found);
            }
        }
        outputs.push(active as u64);
        outputs
    }

    /// Returns the words of the outputs of the laws of the present mode, of those of a step; `None` of an open loop.
    pub fn law_outputs(&self, outputs: &[u64]) -> Option<Vec<u64>> {
        let own = &self.layout.laws.get(self.supervisor.active)?.as_ref()?.outputs;
        let words = |channel: &Channel| words_of(&self.layout.outputs, outputs, &channel.name);
        Some(own.iter().flat_map(words).copied().collect())
    }
}

/// Returns the laws of a mode or stage; `None` of an open loop.
fn laws_of_mode(
    scenario: &Scenario,
    index: usize,
    has_modes: bool,
) -> Result<Option<SampledLaws>, NotExportable> {
    let written = if has_modes {
        scenario.mode.get(index).map(|mode| &mode.law)
    } else {
        scenario.law.stages().get(index).map(|stage| &stage.law)
    };
    match written {
        None | Some(LawKind::Open(_)) => return Ok(None),
        Some(LawKind::Relay(_)) => {
            let reason = "decides at events, and laws of modes in flight code decide at their period: `--mode NAME` exports it alone";
            return Err(NotExportable::new("law.relay", reason));
        }
        Some(LawKind::BDot(_)) => {
            let reason = "reads the change of the magnetic field, and laws of modes in flight code read estimates: `--mode NAME` exports it alone";
            return Err(NotExportable::new("law.b_dot", reason));
        }
        Some(_) => {}
    }
    let reads_motion = written.is_some_and(|law| law.offers().reads_motion());
    let alone = alone(scenario, index, has_modes, reads_motion);
    let alone = alone.map_err(|error| NotExportable::new("law", format!("cannot act alone: {error}")))?;
    let laws: Vec<&LawKind> = (0..alone.study.axes.len()).map(|axis| alone.law.about(axis)).collect();
    let mut laws = SampledLaws::new(&alone, &laws)?;
    // One filter serves the laws of all modes.
    laws.read_estimates();
    Ok(Some(laws))
}

/// Returns the scenario in which a mode or stage acts throughout. A filter that its law does not read goes on unread.
fn alone(
    scenario: &Scenario,
    index: usize,
    has_modes: bool,
    reads_motion: bool,
) -> Result<Scenario, ScenarioError> {
    let mut whole = scenario.clone();
    if !reads_motion && matches!(scenario.estimator, Some(EstimatorKind::Attitude(_))) {
        whole = whole.with(|written| {
            if let Some(EstimatorKind::Attitude(filter)) = &mut written.estimator {
                filter.watch_only = true;
            }
        })?;
    }
    match scenario.mode.get(index).filter(|_| has_modes) {
        Some(mode) => whole.in_mode(&mode.name),
        None => whole.in_stage(index),
    }
}

/// Returns the index of the first word of a channel.
fn first_word(channels: &[Channel], name: &str) -> usize {
    channels.iter().take_while(|channel| channel.name != name).map(|channel| channel.count).sum()
}

/// Returns the words of a channel.
fn words_of<'a>(channels: &[Channel], words: &'a [u64], name: &str) -> &'a [u64] {
    let count = channels.iter().find(|channel| channel.name == name).map_or(0, |channel| channel.count);
    let from = first_word(channels, name);
    words.get(from..from + count).unwrap_or_default()
}
