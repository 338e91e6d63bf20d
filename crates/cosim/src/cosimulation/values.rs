//! Values of the variables of a co-simulation.

use flexsc_core::Telemetry;
use flexsc_core::numerics::time::{Instant, Span};

use super::CoSimulation;
use crate::error::CoSimulationError;
use crate::variable::{ClockRole, Quantity, ValueKind};

impl CoSimulation {
    /// Returns the value of a floating-point variable.
    ///
    /// # Errors
    /// Fails for a reference of another kind, and if the state is no longer finite.
    pub fn get(&mut self, reference: u32) -> Result<f64, CoSimulationError> {
        let variable = self.table.get(reference).filter(|variable| variable.kind == ValueKind::Float);
        let Some(variable) = variable else {
            return Err(CoSimulationError::no_variable(reference, "floating-point"));
        };
        match variable.quantity {
            Quantity::Time => Ok(self.time()),
            Quantity::Observed(index) => self.observe().map(|row| row[index]),
            Quantity::LawInput(index) => self.telemetry().map(|telemetry| telemetry.law_inputs[index]),
            Quantity::Reading(sensor, index) => {
                self.telemetry().map(|telemetry| telemetry.sensors[sensor].values[index])
            }
            Quantity::StoredMomentum(axis) => Ok(self.simulation.stored_momentum()[axis]),
            Quantity::Commanded(axis) => Ok(self.simulation.commanded_torque()[axis]),
            Quantity::WindowMean => Ok(self.simulation.window_mean().unwrap_or(f64::NAN)),
            Quantity::Input(index) => Ok(f64::from_bits(self.journal.inputs[index])),
            Quantity::Key(ref key) => Ok(self.journal.key_value(key, &variable.start)),
            _ => Err(CoSimulationError::no_variable(reference, "floating-point")),
        }
    }

    /// Returns the value of an integer variable.
    ///
    /// # Errors
    /// Fails for a reference of another kind.
    pub fn get_integer(&mut self, reference: u32) -> Result<i64, CoSimulationError> {
        let variable =
            self.table.get(reference).ok_or_else(|| CoSimulationError::no_variable(reference, "integer"))?;
        let (sensor, is_whole) = match variable.quantity {
            Quantity::ReadingWhole(sensor) => (sensor, true),
            Quantity::ReadingFemtoseconds(sensor) => (sensor, false),
            _ => {
                let value = self.journal.integer(&variable.quantity, self.simulation.time());
                return value.ok_or_else(|| CoSimulationError::no_variable(reference, "integer"));
            }
        };
        let at = self.telemetry()?.sensors[sensor].at.map(Instant::parts);
        Ok(at.map_or(
            if is_whole { -1 } else { 0 },
            |(whole, part)| if is_whole { whole } else { part } as i64,
        ))
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

    /// Sets an integer parameter before the start.
    ///
    /// # Errors
    /// Fails for a negative value, for a reference of another kind and after the start.
    pub fn set_integer(&mut self, reference: u32, value: i64) -> Result<(), CoSimulationError> {
        let Some(variable) = self.table.get(reference) else {
            return Err(CoSimulationError::no_variable(reference, "integer"));
        };
        self.journal.set_integer(variable, value, self.has_begun)
    }

    /// Returns true if an output clock ticks at the current event.
    ///
    /// # Errors
    /// Fails for a reference that is no clock.
    pub fn clock(&self, reference: u32) -> Result<bool, CoSimulationError> {
        match self.table.get(reference).map(|variable| &variable.quantity) {
            Some(Quantity::Clock(ClockRole::Sampled)) => Ok(self.journal.counts.has_sampled),
            Some(Quantity::Clock(ClockRole::Switched)) => Ok(self.journal.counts.has_switched),
            Some(Quantity::Clock(ClockRole::Periodic(_))) => Ok(false),
            _ => Err(CoSimulationError::no_variable(reference, "clock")),
        }
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

    /// Returns the observation at the current instant.
    fn observe(&mut self) -> Result<&[f64], CoSimulationError> {
        if self.observed.is_none() {
            let mut row = vec![0.0; self.table.observed];
            self.guarded(|simulation| simulation.open(&mut ()))?;
            self.guarded(|simulation| simulation.observe(&mut row))?;
            self.observed = Some(row);
        }
        Ok(self.observed.as_deref().unwrap_or_default())
    }

    /// Returns readings, and the estimates and references that laws read at the current instant.
    fn telemetry(&mut self) -> Result<&Telemetry, CoSimulationError> {
        if self.telemetry.is_none() {
            let layout = self.simulation.telemetry_layout(&self.scenario);
            self.guarded(|simulation| simulation.open(&mut ()))?;
            let telemetry = self.guarded(|simulation| simulation.telemetry(&layout))?;
            return Ok(self.telemetry.insert(telemetry));
        }
        Ok(self.telemetry.get_or_insert_default())
    }
}
