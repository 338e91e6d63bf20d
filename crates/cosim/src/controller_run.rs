//! Run of the laws of a scenario alone: flight code that decides at its period on the inputs of an importer.
//!
//! At the instant of a decision the run waits, as a plant does for commands: the inputs that are set at the end of the event, or at
//! the start of the next step, are those on which the laws decide.

use flexsc_core::Scenario;
use flexsc_core::numerics::time::{Instant, Span};
use flexsc_export_c::control_system::{CallLayout, ControlSystem, NumberKind};

use crate::communication_point::{CommunicationPoint, step_end};
use crate::content::FmuContent;
use crate::cosimulation::StepResult;
use crate::error::CoSimulationError;
use crate::flight_laws::laws_alone;
use crate::journal::InputJournal;
use crate::moment::Moment;
use crate::variable::{ClockRole, Quantity, ValueKind};
use crate::variable_table::VariableTable;

/// Index of the decision among the functions of laws without an estimator.
const STEP: usize = 0;

/// Run of the laws alone. A clone is a snapshot.
#[derive(Clone, Debug)]
pub struct ControllerRun {
    content: FmuContent,
    scenario: Scenario,
    table: VariableTable,
    layout: CallLayout,
    laws: ControlSystem,
    period: Span,
    journal: InputJournal,
    now: Instant,
    /// Instant of the next decision: the current one while it is pending.
    next: Instant,
    has_begun: bool,
    outputs: Vec<u64>,
}

impl ControllerRun {
    /// Creates the run, before its start.
    ///
    /// # Errors
    /// Fails for an invalid scenario, and for laws that cannot run alone.
    pub fn new(content: FmuContent) -> Result<Self, CoSimulationError> {
        let scenario = content.scenario()?;
        let (laws, period) = laws_alone(&scenario)?;
        let layout = laws.calls().swap_remove(STEP);
        let table = VariableTable::for_laws(&scenario, &layout, period);
        let journal = InputJournal::new(&content, scenario.seed, table.input_count());
        let outputs = vec![0; layout.output_words()];
        let (now, next) = (Instant::START, Instant::START);
        Ok(Self {
            content,
            scenario,
            table,
            layout,
            laws,
            period,
            journal,
            now,
            next,
            has_begun: false,
            outputs,
        })
    }

    /// Returns the variables.
    pub fn table(&self) -> &VariableTable {
        &self.table
    }

    /// Returns the scenario, with the parameters that were set before the start.
    pub fn scenario(&self) -> &Scenario {
        &self.scenario
    }

    /// Returns the current time (s), rounded to a double.
    pub fn time(&self) -> f64 {
        self.now.seconds()
    }

    /// Returns true from the start on.
    pub fn has_begun(&self) -> bool {
        self.has_begun
    }

    /// Begins the run with the parameters that are set; the first decision is pending. The run ends at `stop_time` (s), if that is
    /// later than the scenario's end.
    ///
    /// # Errors
    /// Fails for invalid parameters.
    pub fn begin(&mut self, stop_time: Option<f64>) -> Result<(), CoSimulationError> {
        self.journal.set_stop_time(stop_time);
        self.start()
    }

    /// Starts the laws with the parameters of the journal.
    fn start(&mut self) -> Result<(), CoSimulationError> {
        self.scenario = self.journal.scenario(&self.content)?;
        (self.laws, self.period) = laws_alone(&self.scenario)?;
        self.has_begun = true;
        Ok(())
    }

    /// Returns the end of the run.
    fn end(&self) -> Instant {
        Instant::START + self.scenario.duration
    }

    /// Advances the run from a communication point (s) by `size` seconds; stops at the first decision on the way if
    /// `stop_at_events`. A decision that is pending is made on the inputs of now.
    ///
    /// # Errors
    /// Fails if the run is not at `from`, for a size that is no time, and for a step beyond the end of the run.
    pub fn step(
        &mut self,
        from: f64,
        size: f64,
        stop_at_events: bool,
    ) -> Result<StepResult, CoSimulationError> {
        let (now, grid) = (self.time(), self.journal.grid_ns);
        let target = step_end(from, size, now, self.end(), grid)?;
        let point = CommunicationPoint::new(target, grid).until(self.end());
        self.decide_pending();
        let mut is_event = false;
        while self.next <= point.latest {
            self.now = self.next;
            let counts = &mut self.journal.counts;
            counts.events += 1;
            counts.last_event = self.now.parts();
            let is_end = self.now >= point.at || (grid == 0 && self.now.seconds() == target);
            if stop_at_events || is_end {
                is_event = stop_at_events;
                break;
            }
            self.decide_pending();
        }
        if self.next > self.now {
            self.now = self.now.max(point.at);
        }
        let is_early = is_event && self.now < point.at && self.time() < target;
        Ok(StepResult { reached: if is_early { self.time() } else { target }, is_event, is_early })
    }

    /// Ends an event: a decision that is pending is made on the inputs of now.
    pub fn end_event(&mut self) {
        self.decide_pending();
    }

    /// Makes the decision that is due now, if it was not made.
    fn decide_pending(&mut self) {
        if self.next == self.now {
            let InputJournal { inputs, applied, .. } = &mut self.journal;
            if applied.last() != Some(inputs) {
                applied.add(Moment::new(self.now, true), inputs);
            }
            let inputs = self.journal.inputs.clone();
            self.decide(&inputs);
        }
    }

    /// Lets the laws decide now on these inputs.
    fn decide(&mut self, bits: &[u64]) {
        let kinds =
            self.layout.inputs.iter().flat_map(|channel| std::iter::repeat_n(channel.kind, channel.count));
        let word = |(kind, bits): (NumberKind, &u64)| match kind {
            NumberKind::Real => *bits,
            NumberKind::Flag => u64::from(f64::from_bits(*bits) != 0.0),
            NumberKind::Integer(_) => f64::from_bits(*bits) as u64,
        };
        let words: Vec<u64> = kinds.zip(bits).map(word).collect();
        self.outputs = self.laws.call(STEP, self.now.ticks(), &words);
        self.next = self.now + self.period;
    }

    /// Returns the value of a floating-point variable.
    ///
    /// # Errors
    /// Fails for a reference of another kind.
    pub fn get(&self, reference: u32) -> Result<f64, CoSimulationError> {
        let variable = self.table.get(reference).filter(|variable| variable.kind == ValueKind::Float);
        match variable.map(|variable| (&variable.quantity, variable.start)) {
            Some((Quantity::Time, _)) => Ok(self.time()),
            Some((Quantity::Input(index), _)) => Ok(f64::from_bits(self.journal.inputs[*index])),
            Some((Quantity::LawOutput(index), _)) => Ok(f64::from_bits(self.outputs[*index])),
            Some((Quantity::Key(key), start)) => Ok(self.journal.key_value(key, &start)),
            _ => Err(CoSimulationError::no_variable(reference, "floating-point")),
        }
    }

    /// Returns the value of an integer variable.
    ///
    /// # Errors
    /// Fails for a reference of another kind.
    pub fn get_integer(&self, reference: u32) -> Result<i64, CoSimulationError> {
        let variable = self.table.get(reference);
        let value = variable.and_then(|variable| self.journal.integer(&variable.quantity, self.now));
        value.ok_or_else(|| CoSimulationError::no_variable(reference, "integer"))
    }

    /// Sets an input, or a parameter before the start.
    ///
    /// # Errors
    /// Fails for a value that is not finite, for a reference of another kind and for a parameter after the start.
    pub fn set(&mut self, reference: u32, value: f64) -> Result<(), CoSimulationError> {
        let Some(variable) = self.table.get(reference) else {
            return Err(CoSimulationError::no_variable(reference, "floating-point"));
        };
        self.journal.set(variable, value, self.has_begun)
    }

    /// Sets the grid of communication points before the start.
    ///
    /// # Errors
    /// Fails for a negative value, for a reference of another kind and after the start.
    pub fn set_integer(&mut self, reference: u32, value: i64) -> Result<(), CoSimulationError> {
        let Some(variable) = self.table.get(reference) else {
            return Err(CoSimulationError::no_variable(reference, "integer"));
        };
        self.journal.set_integer(variable, value, self.has_begun)
    }

    /// Returns the interval of a periodic clock.
    ///
    /// # Errors
    /// Fails for a reference that is no periodic clock.
    pub fn interval(&self, reference: u32) -> Result<Span, CoSimulationError> {
        match self.table.get(reference).map(|variable| &variable.quantity) {
            Some(Quantity::Clock(ClockRole::Periodic(interval))) => Ok(*interval),
            _ => Err(CoSimulationError::no_variable(reference, "periodic clock")),
        }
    }

    /// Returns the state as bytes: everything that the importer has set, from which the run can be repeated.
    pub fn to_bytes(&self) -> Vec<u8> {
        let reached = Moment::new(self.now, self.next != self.now);
        InputJournal { reached: self.has_begun.then_some(reached), ..self.journal.clone() }.to_bytes()
    }

    /// Restores the state of [`Self::to_bytes`] by repeating the decisions.
    ///
    /// # Errors
    /// Fails for damaged bytes and those of another FMU.
    pub fn restored(&self, bytes: &[u8]) -> Result<Self, CoSimulationError> {
        let mut run = Self::new(self.content.clone())?;
        run.journal = InputJournal::from_bytes(bytes, &self.journal.token, self.table.input_count())?;
        let Some(reached) = run.journal.reached else { return Ok(run) };
        run.start()?;
        if reached.at() > run.end() {
            return Err(CoSimulationError::after_end());
        }
        let applied = run.journal.applied.clone();
        let mut changes = applied.changes().peekable();
        let mut inputs = vec![0; run.table.input_count()];
        while Moment::new(run.next, true) <= reached {
            while let Some(change) = changes.next_if(|change| change.from.at() <= run.next) {
                change.apply(&mut inputs);
            }
            run.now = run.next;
            run.decide(&inputs);
        }
        run.now = reached.at();
        Ok(run)
    }
}
