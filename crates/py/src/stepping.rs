//! A run that Python steps.

use std::time::Instant as WallInstant;

use flexsc_core::campaign::CommandLog;
use flexsc_core::control::law::Command;
use flexsc_core::control::quantity::total_width;
use flexsc_core::numerics::time::{Instant, Span};
use flexsc_core::record::{Record, RecordError, Sample};
use flexsc_core::{QuantityField, QuantityGroup, Simulation, SimulationError, StopAt};
use numpy::{IntoPyArray, PyArray1, PyReadonlyArray1};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;

use crate::Scenario;
use crate::aside::SIGNAL_PERIOD;
use crate::commands::Commands;
use crate::error::simulation_error;

/// A field as Python takes it: its group, its name, its unit, and how many numbers it has.
pub type FieldRow = (&'static str, &'static str, &'static str, Option<usize>);

/// The fields of a simulation's row.
pub fn fields(fields: &[QuantityField]) -> Vec<FieldRow> {
    let group = |group: QuantityGroup| match group {
        QuantityGroup::Estimated => "believed",
        other => other.name(),
    };
    fields.iter().map(|field| (group(field.group), field.name, field.unit, field.shape.count())).collect()
}

/// The unit of commands to a scenario.
pub fn command_unit(scenario: &flexsc_core::Scenario) -> &'static str {
    let is_torque = scenario.actuator.only_actuator().and_then(|kind| kind.command_gain()).is_none();
    if is_torque { scenario.model.commanded_quantity().1 } else { "" }
}

/// The largest command about each axis that the actuator of a scenario can execute; infinite without a limit.
pub fn command_limit(scenario: &flexsc_core::Scenario) -> Vec<f64> {
    let gain = scenario.actuator.only_actuator().and_then(|kind| kind.command_gain()).unwrap_or(1.0);
    let axes = scenario.study.axes.iter().zip(&scenario.study.authorities);
    axes.map(|(axis, can)| can.accelerations[0].min(can.accelerations[1]) * axis.commanded_inertia() / gain)
        .collect()
}

/// Commands about each axis, and 0 about those that a scenario does not have.
pub fn about_axes(values: &[f64]) -> [f64; 3] {
    [0, 1, 2].map(|axis| values.get(axis).copied().unwrap_or(0.0))
}

/// Gives a simulation commands, and keeps them where they are kept.
pub fn steer(simulation: &mut Simulation, commands: Option<&mut CommandLog>, values: &[f64]) {
    let given = about_axes(values).map(Command::Torque);
    if let Some(commands) = commands.filter(|_| !simulation.is_finished()) {
        commands.push(simulation.time(), given);
    }
    simulation.set_external_command(given);
}

/// A length of time that Python gave.
pub fn span(dt: f64) -> PyResult<Span> {
    let span = Span::from_seconds(if dt.is_finite() { dt } else { 0.0 });
    if span > Span::ZERO && dt <= 1e13 {
        return Ok(span);
    }
    Err(PyValueError::new_err(format!("dt must be a time of 1e-15 s to 1e13 s, got {dt}")))
}

/// A record that asks Python for signals, and ends its run where they raise.
struct Signals {
    since: WallInstant,
    polls: u32,
    raised: Option<PyErr>,
}

impl Record for Signals {
    fn record(&mut self, _: Instant, _: Sample<'_>) -> Result<(), RecordError> {
        Ok(())
    }

    fn poll(&mut self) -> Result<(), RecordError> {
        self.polls += 1;
        if self.polls.is_multiple_of(64) && self.since.elapsed() > SIGNAL_PERIOD {
            self.since = WallInstant::now();
            self.raised = Python::attach(|py| py.check_signals().err());
        }
        if self.raised.is_some() { Err(RecordError::Interrupted) } else { Ok(()) }
    }
}

#[pyclass(module = "flexsc._native")]
pub struct Simulator {
    simulation: Simulation,
    name: String,
    axes: usize,
    unit: &'static str,
    limit: Vec<f64>,
    fields: Vec<QuantityField>,
    /// Commands of the run, if they were kept.
    commands: Option<CommandLog>,
    /// Why it cannot go on.
    failed: Option<String>,
}

impl Simulator {
    pub fn from_simulation(
        simulation: Simulation,
        scenario: &flexsc_core::Scenario,
        commands: Option<CommandLog>,
    ) -> Self {
        Self {
            fields: simulation.observation_fields(scenario),
            simulation,
            name: scenario.name.clone(),
            axes: scenario.axis_count(),
            unit: command_unit(scenario),
            limit: command_limit(scenario),
            commands,
            failed: None,
        }
    }

    /// The simulation.
    pub const fn simulation(&self) -> &Simulation {
        &self.simulation
    }

    /// The commands of the run; `None` if they were not kept.
    pub const fn command_log(&self) -> Option<&CommandLog> {
        self.commands.as_ref()
    }

    /// Advances the simulation until Python's signals stop it.
    fn advance<T: Send>(
        &mut self,
        py: Python<'_>,
        on: impl FnOnce(&mut Simulation, &mut Signals) -> Result<T, SimulationError> + Send,
    ) -> PyResult<T> {
        if let Some(why) = &self.failed {
            return Err(crate::error::SimulationError::new_err(why.clone()));
        }
        let mut signals = Signals { since: WallInstant::now(), polls: 0, raised: None };
        let simulation = &mut self.simulation;
        let result = py.detach(|| on(simulation, &mut signals));
        result.map_err(|error| {
            let interrupted = signals.raised.is_some();
            let why = if interrupted { "was interrupted".to_owned() } else { error.to_string() };
            self.failed = Some(format!("{}: {why}; restore a snapshot, or start again", self.name));
            signals.raised.unwrap_or_else(|| simulation_error(&self.name, error))
        })
    }
}

#[pymethods]
impl Simulator {
    #[new]
    fn new(py: Python<'_>, scenario: &Scenario, run: u64) -> PyResult<Self> {
        let mut simulator = Self::from_simulation(
            Simulation::new(&scenario.inner, run),
            &scenario.inner,
            Some(CommandLog::default()),
        );
        simulator.advance(py, |simulation, record| simulation.open(record))?;
        Ok(simulator)
    }

    #[getter]
    fn time(&self) -> f64 {
        self.simulation.time().seconds()
    }

    #[getter]
    fn done(&self) -> bool {
        self.simulation.is_finished()
    }

    /// Why it cannot go on, if it cannot.
    #[getter]
    pub fn failed(&self) -> Option<&str> {
        self.failed.as_deref()
    }

    #[getter]
    fn axes(&self) -> usize {
        self.axes
    }

    #[getter]
    fn command_unit(&self) -> &'static str {
        self.unit
    }

    #[getter]
    fn command_limit(&self) -> Vec<f64> {
        self.limit.clone()
    }

    #[getter]
    fn fields(&self) -> Vec<FieldRow> {
        fields(&self.fields)
    }

    fn look<'py>(&mut self, py: Python<'py>) -> PyResult<Bound<'py, PyArray1<f64>>> {
        let mut row = vec![0.0; total_width(&self.fields)];
        self.simulation.observe(&mut row).map_err(|error| simulation_error(&self.name, error))?;
        Ok(row.into_pyarray(py))
    }

    /// Returns the attitude (w, x, y, z) by the last estimate; `None` for one axis.
    fn estimated_attitude(&mut self) -> PyResult<Option<[f64; 4]>> {
        self.simulation.estimated_attitude().map_err(|error| simulation_error(&self.name, error))
    }

    /// Commands from now on; `values` are as many as there are axes, and finite.
    fn steer(&mut self, values: PyReadonlyArray1<'_, f64>) {
        let values: Vec<f64> = values.as_array().iter().copied().collect();
        steer(&mut self.simulation, self.commands.as_mut(), &values);
    }

    /// Returns the commands of the run and the instant that it has reached; `None` if the commands were not kept.
    fn commands(&self) -> Option<Commands> {
        let until = if self.simulation.is_finished() { Instant::END } else { self.simulation.time() };
        Some(Commands { commands: self.commands.clone()?, until })
    }

    fn step(&mut self, py: Python<'_>, dt: f64) -> PyResult<()> {
        let until = self.simulation.time() + span(dt)?;
        self.advance(py, |simulation, record| simulation.run_up_to(until, record))
    }

    fn run_until(&mut self, py: Python<'_>, time: f64) -> PyResult<()> {
        let until = Instant::START + Span::from_seconds(time);
        self.advance(py, |simulation, record| simulation.run_up_to(until, record))
    }

    fn run_to_next(&mut self, py: Python<'_>, occasion: &str, time: f64) -> PyResult<bool> {
        let occasion = match occasion {
            "sample" => StopAt::Sample,
            "decision" => StopAt::Decision,
            "switching" => StopAt::Switching,
            "window" => StopAt::Window,
            _ => {
                let why = "an event is 'sample', 'decision', 'switching' or 'window'";
                return Err(PyValueError::new_err(format!("{why}, got {occasion:?}")));
            }
        };
        let until = if time.is_finite() { Instant::START + Span::from_seconds(time) } else { Instant::END };
        self.advance(py, |simulation, record| simulation.run_to_next(occasion, until, record))
    }

    fn copy(&self) -> Self {
        Self {
            simulation: self.simulation.clone(),
            name: self.name.clone(),
            limit: self.limit.clone(),
            fields: self.fields.clone(),
            commands: self.commands.clone(),
            failed: self.failed.clone(),
            ..*self
        }
    }
}
