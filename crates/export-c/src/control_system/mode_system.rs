//! Control system with modes of operation: the supervisor, and the laws of each mode. Stages of a law are modes that end at a time.

use std::sync::Arc;

use flexsc_core::Scenario;
use flexsc_core::control::operation::ModeTables;
use flexsc_flight::mode_supervisor::{ModeSupervisor, ModeTest};
use flexsc_flight::supervised_mode::TargetChange;
use flexsc_flight::ticks::Ticks;
use flexsc_flight::vector3::Vector3;
use flexsc_flight_precision::Precision;

use super::actuation::{Actuation, Executing, are_jets, are_magnetorquers, are_wheels};
use super::attitude_unit::{AttitudeUnit, quaternion, vector, vector_words};
use super::b_dot::FieldUnit;
use super::mode_inputs::ModeInputs;
use super::mode_laws::{LawsOfMode, ModeLaws, laws_of_mode};
use super::step_layout::{StepLayout, first_word, words_of};
use super::{CallLayout, Channel, NotExportable, StoredMomentum, WordReader};

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
    /// Rate of change of the field that B-dot laws read.
    pub field: Option<FieldUnit>,
    /// Actuators that give the commands.
    pub actuation: Actuation,
    /// Moment of the magnetorquers (A m²), if laws command it.
    moment: Vector3,
    /// True if magnetorquers execute commands of laws, and do not unload wheels: then they have no moment in other modes.
    pub clears_moment: bool,
    /// Momentum stored in the rotors.
    pub stored: StoredMomentum,
    /// Inputs of the supervisor.
    pub inputs: ModeInputs,
    /// True if each mode has its target: at a change the angles move from one to the other.
    pub moves_angles: bool,
    /// Change of the target at that of the mode.
    change: TargetChange,
    /// Inputs and outputs of a step.
    layout: Arc<StepLayout>,
    precision: Precision,
}

impl ModeSystem {
    /// Returns the control system of a scenario with modes, or with stages of a law.
    pub(super) fn new(scenario: &Scenario) -> Result<Self, NotExportable> {
        let stages = scenario.law.stages();
        let has_modes = !scenario.mode.is_empty();
        let mut tables = if has_modes { scenario.mode_tables() } else { ModeTables::from_stages(stages) };
        let mut modes: Vec<LawsOfMode> = Vec::new();
        let members = scenario.actuator.members();
        let executing = Executing::all(scenario, &members);
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
            let [drives_wheels, fires_jets] = [are_wheels, are_jets].map(|is| executing[index].has(is));
            modes.push(LawsOfMode { name, current: start.clone(), start, drives_wheels, fires_jets });
        }
        let has_b_dot = modes.iter().any(|mode| mode.start.b_dot().is_some());
        let field = has_b_dot.then(|| FieldUnit::new(scenario)).transpose()?;
        let actuation = Actuation::new(scenario);
        let clears_moment = executing.iter().any(|own| own.has(are_magnetorquers));
        let estimator = AttitudeUnit::new(scenario).filter(|_| scenario.study.axes.len() == 3);
        let moves_angles = has_modes && estimator.is_some();
        let stored = StoredMomentum::new(scenario);
        let inputs = ModeInputs::new(scenario, &tables, &stored, moves_angles);
        let supervisor = ModeSupervisor::start(Ticks::default(), &mut tables.modes, &mut tables.exits);
        let layout = Arc::new(StepLayout::new(&modes, estimator.is_some(), &actuation));
        Ok(Self {
            tables,
            supervisor,
            modes,
            estimator,
            field,
            actuation,
            moment: Vector3::ZERO,
            clears_moment,
            stored,
            inputs,
            moves_angles,
            change: TargetChange::NONE,
            layout,
            precision: scenario.flight_precision,
        })
    }

    /// Starts the supervisor and the attitude filter again at a time, as `init` does.
    pub(super) fn start_at(&mut self, now: Ticks) {
        self.supervisor = ModeSupervisor::start(now, &mut self.tables.modes, &mut self.tables.exits);
        if let Some(unit) = &mut self.estimator {
            unit.start_at_identity(now);
        }
    }

    /// Returns the precision in which the laws compute.
    pub(super) fn precision(&self) -> Precision {
        self.precision
    }

    /// Returns the shortest period of the laws (s).
    pub(super) fn period(&self) -> f64 {
        let periods = self.modes.iter().filter_map(|mode| mode.start.period());
        let shortest = periods.fold(f64::INFINITY, f64::min);
        if shortest.is_finite() { shortest } else { 1.0 }
    }

    /// Returns the functions.
    pub(super) fn calls(&self) -> Vec<CallLayout> {
        let mode = || Channel::integer("mode", "Number of the mode", 1, self.modes.len() as u64);
        let enter = CallLayout {
            is_start: true,
            inputs: vec![mode()],
            outputs: vec![mode()],
            ..CallLayout::new("enter", "Enters a mode by command, as if a condition had been met.")
        };
        let time = |name: &str, about: &str| Channel::integer(name, about, 1, 0);
        let supervise = CallLayout {
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
            ..CallLayout::new(
                "supervise",
                "Tests the conditions of the present mode, and changes the mode if one is met; it comes before the step of the same time.",
            )
        };
        let mut outputs = self.layout.outputs.clone();
        outputs.push(mode());
        let step = CallLayout {
            inputs: self.layout.inputs.clone(),
            outputs,
            ..CallLayout::new(
                "step",
                "Decides by the laws of the present mode on the commands of a period; outputs that these laws do not have are 0.",
            )
        };
        let estimator = self.estimator.iter().flat_map(AttitudeUnit::calls);
        let field = self.field.iter().map(|_| FieldUnit::layout());
        let unload = self.actuation.unload_layout(&self.stored, self.estimator.is_some());
        estimator.chain(field).chain([enter, supervise]).chain(unload).chain([step]).collect()
    }

    /// Returns the index of a function; the calls of the attitude filter come first.
    pub fn call_index(&self, name: &str) -> usize {
        self.calls().iter().position(|call| call.name == name).unwrap_or(0)
    }

    /// Calls the function with this index, and returns the words of its outputs.
    pub(super) fn call(&mut self, call: usize, now: Ticks, inputs: &[u64]) -> Vec<u64> {
        let mut own = call;
        if let Some(estimator) = &mut self.estimator {
            match own {
                0 => return estimator.start(now, inputs),
                1 => return estimator.sample(now, inputs),
                _ => own -= 2,
            }
        }
        if let Some(field) = &mut self.field {
            if own == 0 {
                return field.take(now, inputs);
            }
            own -= 1;
        }
        match own {
            0 => self.enter(now, inputs),
            1 => self.supervise(now, inputs),
            2 if self.actuation.unloading.is_some() => self.unload(inputs),
            _ => self.step(now, inputs),
        }
    }

    /// Begins a cycle of the unloading, and returns the words of the outputs.
    fn unload(&mut self, inputs: &[u64]) -> Vec<u64> {
        let is_detumbling =
            self.modes.get(self.supervisor.active).is_some_and(|mode| mode.start.b_dot().is_some());
        let held = is_detumbling.then_some(self.moment);
        let rate = self.estimator.as_ref().map(AttitudeUnit::rate);
        let outputs = self.actuation.unload(inputs, &self.stored, rate, held);
        if self.actuation.unloads_by_magnetorquers() && held.is_none() {
            self.moment = vector(&mut WordReader::new(&outputs));
        }
        outputs
    }

    /// Enters a mode by command, and returns the words of the outputs.
    fn enter(&mut self, now: Ticks, inputs: &[u64]) -> Vec<u64> {
        let mode = inputs.first().map_or(0, |mode| *mode as usize);
        let mode = if mode < self.modes.len() { mode } else { 0 };
        self.supervisor.enter(now, mode, &mut self.tables.modes, &mut self.tables.exits);
        self.start_laws();
        self.change.is_pending = false;
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
        let readings = self.inputs.readings(now, inputs, &self.stored, self.estimator.as_ref());
        let ModeTables { modes, exits, steps, .. } = &mut self.tables;
        let ModeTest { has_changed, is_chattering, .. } =
            self.precision.test_modes(&mut self.supervisor, now, &readings, modes, exits, steps);
        if has_changed {
            self.start_laws();
            if let Some(unit) = self.estimator.as_ref().filter(|_| self.moves_angles) {
                let target = ModeInputs::target(inputs);
                self.change.begin(&target, &unit.angle_from(&target, now));
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
            let angle = self.precision.angle_from(&mut self.change, &target, &unit.attitude(now));
            let rate = unit.rate();
            let words = |values: [f64; 3]| values.map(f64::to_bits);
            motion = Some([words([angle.x, angle.y, angle.z]), words([rate.x, rate.y, rate.z])]);
        }
        let active = self.supervisor.active;
        let mut outputs = vec![0; layout.outputs.iter().map(|channel| channel.count).sum()];
        let mut place = |name: &str, found: &[u64]| {
            let place = first_word(&layout.outputs, name);
            outputs[place..place + found.len()].copy_from_slice(found);
        };
        let Some(mode) = self.modes.get_mut(active) else { return Vec::new() };
        let (mut torque, mut on_times) = (Vector3::ZERO, Vec::new());
        if self.clears_moment {
            self.moment = Vector3::ZERO;
        }
        if let (ModeLaws::BDot(laws), Some(unit)) = (&mode.current, &self.field) {
            self.moment = laws.moment(&unit.field.rate_at(now));
            self.actuation.release();
        }
        if let (ModeLaws::OnEstimates(laws), Some(Some(own))) = (&mut mode.current, layout.laws.get(active)) {
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
                place(&channel.name, words_of(&own.outputs, &decided, &channel.name));
            }
            let command = if laws.commands_changes() { "rate_change" } else { "torque" };
            let command = words_of(&own.outputs, &decided, command);
            if mode.drives_wheels && !laws.commands_changes() {
                torque = vector(&mut WordReader::new(command));
            }
            if mode.fires_jets {
                let command = WordReader::new(command).list(command.len());
                on_times = self.actuation.on_times(&command, laws.commands_changes());
            }
        }
        if self.actuation.wheels.is_some() {
            place("wheel_torque", &self.actuation.drive(torque));
        }
        place("on_time", &on_times);
        if self.field.is_some() {
            place("moment", &vector_words(&self.moment));
        }
        outputs.push(active as u64);
        outputs
    }

    /// Returns the words of the outputs of the laws of the present mode, of those of a step; `None` of an open loop.
    pub fn law_outputs(&self, outputs: &[u64]) -> Option<Vec<u64>> {
        let own = &self.layout.laws.get(self.supervisor.active)?.as_ref()?.outputs;
        Some(own.iter().flat_map(|channel| self.output(outputs, &channel.name)).copied().collect())
    }

    /// Returns the words of an output of a step.
    pub fn output<'a>(&self, outputs: &'a [u64], name: &str) -> &'a [u64] {
        words_of(&self.layout.outputs, outputs, name)
    }

    /// Returns the laws of the present mode.
    pub fn active_laws(&self) -> Option<&ModeLaws> {
        self.modes.get(self.supervisor.active).map(|mode| &mode.start)
    }
}
