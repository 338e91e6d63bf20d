//! Many runs that Python steps together, on several threads.

use std::sync::Arc;
use std::sync::mpsc::{RecvTimeoutError, channel};

use flexsc_core::campaign::{Campaign, CommandLog, RunError};
use flexsc_core::control::quantity::total_width;
use flexsc_core::record::{Record, StopFlag};
use flexsc_core::{QuantityField, Simulation};
use numpy::{IntoPyArray, PyArray1, PyArray2, PyArrayMethods, PyReadonlyArray1, PyReadonlyArray2};
use pyo3::exceptions::PyRuntimeError;
use pyo3::prelude::*;
use rayon::prelude::*;
use rayon::{ThreadPool, ThreadPoolBuilder};

use crate::Scenario;
use crate::aside::SIGNAL_PERIOD;
use crate::error::scenario_error;
use crate::stepping::{FieldRow, Simulator, command_limit, command_unit, fields, span, steer};

/// Least number of copies that are given to a thread at once.
const TOGETHER: usize = 8;

/// A run, and why it cannot go on.
#[derive(Clone)]
struct Flight {
    number: u64,
    simulation: Option<Simulation>,
    /// Commands of the run from its start; `None` if they were not kept.
    commands: Option<CommandLog>,
    failed: Option<String>,
}

impl Flight {
    /// A run before its start.
    fn new(campaign: &Campaign, number: u64, record: &mut impl Record) -> Self {
        let started = if campaign.keys().next().is_none() {
            Ok(Simulation::new(campaign.scenario(), number))
        } else {
            campaign.run(number).map(|run| Simulation::new(&run.scenario, number)).map_err(RunError::from)
        };
        let opened = started.and_then(|mut simulation| {
            simulation.open(record)?;
            Ok(simulation)
        });
        match opened {
            Ok(simulation) => Self {
                number,
                simulation: Some(simulation),
                commands: Some(CommandLog::default()),
                failed: None,
            },
            Err(error) => Self { number, simulation: None, commands: None, failed: Some(error.to_string()) },
        }
    }

    /// A run in the state of a simulator. Commands are kept if they are to be, or if there are none yet.
    fn restored(simulator: &Simulator, number: u64, keeps: bool) -> Self {
        let commands = simulator.command_log().filter(|commands| keeps || commands.is_empty());
        Self {
            number,
            simulation: Some(simulator.simulation().clone()),
            commands: commands.cloned(),
            failed: simulator.failed().map(ToOwned::to_owned),
        }
    }

    /// Advances the simulation, and writes its state into a row.
    fn advance(
        &mut self,
        row: &mut [f64],
        on: impl FnOnce(&mut Simulation, &mut Option<CommandLog>) -> Result<(), RunError>,
    ) {
        let Self { simulation, commands, failed, .. } = self;
        let Some(simulation) = simulation.as_mut().filter(|_| failed.is_none()) else {
            return row.fill(f64::NAN);
        };
        if let Err(error) = on(simulation, commands).and_then(|()| Ok(simulation.observe(row)?)) {
            *failed = Some(error.to_string());
            row.fill(f64::NAN);
        }
    }
}

#[pyclass(module = "flexsc._native")]
pub struct Simulators {
    campaign: Arc<Campaign>,
    flights: Vec<Flight>,
    fields: Vec<QuantityField>,
    width: usize,
    pool: Arc<ThreadPool>,
    keeps: bool,
}

impl Simulators {
    /// Applies a function to each simulation and its row, on all threads, until Python's signals stop it.
    fn each(
        &mut self,
        py: Python<'_>,
        on: impl Fn(usize, &mut Flight, &mut [f64], &mut StopFlag) + Send + Sync,
    ) -> PyResult<Vec<f64>> {
        let (flights, width, pool) = (&mut self.flights, self.width, &self.pool);
        let mut rows = vec![0.0; flights.len() * width];
        let raised = py.detach(|| {
            let (stop, (done, wait)) = (StopFlag::default(), channel());
            let (stop_flag, mut raised) = (stop.clone(), None);
            let rows = &mut rows;
            pool.in_place_scope(|scope| {
                scope.spawn(move |_| {
                    let each = flights.par_iter_mut().zip(rows.par_chunks_exact_mut(width));
                    each.with_min_len(TOGETHER).enumerate().for_each_with(
                        stop_flag,
                        |stop_flag, (index, (flight, row))| {
                            on(index, flight, row, stop_flag);
                        },
                    );
                    // The receiver is gone if Python raised.
                    let _ = done.send(());
                });
                while let Err(RecvTimeoutError::Timeout) = wait.recv_timeout(SIGNAL_PERIOD) {
                    if raised.is_none() {
                        raised = Python::attach(|py| py.check_signals().err());
                        if raised.is_some() {
                            stop.request();
                        }
                    }
                }
            });
            raised
        });
        raised.map_or(Ok(rows), Err)
    }
}

#[pymethods]
impl Simulators {
    /// Copies at the start of runs, or before it if they are not to be `started`: `restore` sets their states.
    #[new]
    fn new(
        py: Python<'_>,
        scenario: &Scenario,
        runs: Vec<u64>,
        threads: usize,
        keeps: bool,
        started: bool,
    ) -> PyResult<Self> {
        let name = &scenario.inner.name;
        let campaign = Campaign::new(scenario.inner.clone(), name, []).map_err(scenario_error)?;
        let pool = ThreadPoolBuilder::new().num_threads(threads).build();
        let pool = pool.map_err(|error| PyRuntimeError::new_err(error.to_string()))?;
        let fields = Simulation::new(&scenario.inner, 0).observation_fields(&scenario.inner);
        let flight = |number| Flight { number, simulation: None, commands: None, failed: None };
        let mut simulators = Self {
            campaign: Arc::new(campaign),
            flights: runs.into_iter().map(flight).collect(),
            width: total_width(&fields),
            fields,
            pool: Arc::new(pool),
            keeps,
        };
        if started {
            simulators.reset(py, None, None)?;
        }
        Ok(simulators)
    }

    #[getter]
    fn axes(&self) -> usize {
        self.campaign.scenario().axis_count()
    }

    #[getter]
    fn command_unit(&self) -> &'static str {
        command_unit(self.campaign.scenario())
    }

    #[getter]
    fn command_limit(&self) -> Vec<f64> {
        command_limit(self.campaign.scenario())
    }

    fn __len__(&self) -> usize {
        self.flights.len()
    }

    #[getter]
    fn fields(&self) -> Vec<FieldRow> {
        fields(&self.fields)
    }

    #[getter]
    fn runs<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<u64>> {
        self.flights.iter().map(|flight| flight.number).collect::<Vec<_>>().into_pyarray(py)
    }

    #[getter]
    fn time<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        let time = |flight: &Flight| {
            flight.simulation.as_ref().map_or(f64::NAN, |simulation| simulation.time().seconds())
        };
        self.flights.iter().map(time).collect::<Vec<_>>().into_pyarray(py)
    }

    #[getter]
    fn done<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<bool>> {
        let done = |flight: &Flight| flight.simulation.as_ref().is_some_and(Simulation::is_finished);
        self.flights.iter().map(done).collect::<Vec<_>>().into_pyarray(py)
    }

    /// Index, number and reason of each copy that cannot go on.
    #[getter]
    fn failed(&self) -> Vec<(usize, u64, String)> {
        let failed = |(index, flight): (usize, &Flight)| {
            flight.failed.as_ref().map(|why| (index, flight.number, why.clone()))
        };
        self.flights.iter().enumerate().filter_map(failed).collect()
    }

    fn reset<'py>(
        &mut self,
        py: Python<'py>,
        mask: Option<PyReadonlyArray1<'py, bool>>,
        runs: Option<PyReadonlyArray1<'py, u64>>,
    ) -> PyResult<Bound<'py, PyArray2<f64>>> {
        let mask: Option<Vec<bool>> = mask.map(|mask| mask.as_array().iter().copied().collect());
        let runs: Option<Vec<u64>> = runs.map(|runs| runs.as_array().iter().copied().collect());
        let campaign = self.campaign.clone();
        let rows = self.each(py, |index, flight, row, stop| {
            if mask.as_ref().is_none_or(|mask| mask[index]) {
                let number = runs.as_ref().map_or(flight.number, |runs| runs[index]);
                *flight = Flight::new(&campaign, number, stop);
            }
            flight.advance(row, |_, _| Ok(()));
        })?;
        rows.into_pyarray(py).reshape([self.flights.len(), self.width])
    }

    /// Commands, one row a copy, the length of the step (s), and which copies take it.
    fn step<'py>(
        &mut self,
        py: Python<'py>,
        values: Option<PyReadonlyArray2<'py, f64>>,
        dt: f64,
        mask: Option<PyReadonlyArray1<'py, bool>>,
    ) -> PyResult<Bound<'py, PyArray2<f64>>> {
        let (span, axes, keeps) = (span(dt)?, self.axes(), self.keeps);
        let values: Option<Vec<f64>> = values.map(|values| values.as_array().iter().copied().collect());
        let mask: Option<Vec<bool>> = mask.map(|mask| mask.as_array().iter().copied().collect());
        let rows = self.each(py, |index, flight, row, stop| {
            flight.advance(row, |simulation, commands| {
                if mask.as_ref().is_some_and(|mask| !mask[index]) {
                    return Ok(());
                }
                if let Some(values) = &values {
                    let values = &values[index * axes..(index + 1) * axes];
                    *commands = commands.take().filter(|_| keeps);
                    steer(simulation, commands.as_mut(), values);
                }
                Ok(simulation.run_up_to(simulation.time() + span, stop)?)
            });
        })?;
        rows.into_pyarray(py).reshape([self.flights.len(), self.width])
    }

    fn look<'py>(&mut self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<f64>>> {
        let rows = self.each(py, |_, flight, row, _| flight.advance(row, |_, _| Ok(())))?;
        rows.into_pyarray(py).reshape([self.flights.len(), self.width])
    }

    /// Sets each copy to the state of a simulator, as a run number.
    fn restore<'py>(
        &mut self,
        py: Python<'py>,
        simulators: Vec<PyRef<'py, Simulator>>,
        runs: Vec<u64>,
        mask: Option<PyReadonlyArray1<'py, bool>>,
    ) -> PyResult<Bound<'py, PyArray2<f64>>> {
        let mask: Option<Vec<bool>> = mask.map(|mask| mask.as_array().iter().copied().collect());
        let sources: Vec<&Simulator> = simulators.iter().map(|simulator| &**simulator).collect();
        let keeps = self.keeps;
        let rows = self.each(py, |index, flight, row, _| {
            if mask.as_ref().is_none_or(|mask| mask[index]) {
                *flight = Flight::restored(sources[index], runs[index], keeps);
            }
            flight.advance(row, |_, _| Ok(()));
        })?;
        rows.into_pyarray(py).reshape([self.flights.len(), self.width])
    }

    /// A copy of one of them.
    fn one(&self, index: usize) -> PyResult<Simulator> {
        let flight = &self.flights[index];
        match (&flight.simulation, &flight.failed) {
            (Some(simulation), None) => Ok(Simulator::from_simulation(
                simulation.clone(),
                self.campaign.scenario(),
                flight.commands.clone(),
            )),
            (_, why) => {
                let why = why.clone().unwrap_or_default();
                Err(crate::error::SimulationError::new_err(format!(
                    "copy {index}, run {}: {why}",
                    flight.number
                )))
            }
        }
    }
}
