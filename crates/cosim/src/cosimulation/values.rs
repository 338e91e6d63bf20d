//! Values of the variables of a co-simulation.

use flexsc_core::numerics::time::Span;

use super::CoSimulation;
use crate::error::CoSimulationError;
use crate::journal::Counts;
use crate::variable::{Causality, ClockRole, Quantity, ValueKind, VariableStart};

impl CoSimulation {
    /// Returns the value of a floating-point variable.
    ///
    /// # Errors
    /// Fails for a reference of another kind, and if the state is no longer finite.
    pub fn get(&mut self, reference: u32) -> Result<f64, CoSimulationError> {
        let variable = self.table.get(reference).filter(|variable| variable.kind == ValueKind::Float);
        let Some(variable) = variable else { return Err(unknown(reference, "floating-point")) };
        match variable.quantity {
            Quantity::Time => Ok(self.time()),
            Quantity::Observed(index) => self.observe().map(|row| row[index]),
            Quantity::LawInput(index) => self.law_inputs().map(|values| values[index]),
            Quantity::StoredMomentum(axis) => Ok(self.simulation.stored_momentum()[axis]),
            Quantity::Commanded(axis) => Ok(self.simulation.commanded_torque()[axis]),
            Quantity::WindowMean => Ok(self.simulation.window_mean().unwrap_or(f64::NAN)),
            Quantity::Input(index) => Ok(f64::from_bits(self.journal.inputs[index])),
            Quantity::Key(ref key) => {
                let own = self.journal.keys.iter().find(|(own, _)| own == key);
                let start = match variable.start {
                    VariableStart::Float(value) => value,
                    VariableStart::Integer(value) => value as f64,
                };
                Ok(own.map_or(start, |(_, bits)| f64::from_bits(*bits)))
            }
            _ => Err(unknown(reference, "floating-point")),
        }
    }

    /// Returns the value of an integer variable.
    ///
    /// # Errors
    /// Fails for a reference of another kind.
    pub fn get_integer(&self, reference: u32) -> Result<i64, CoSimulationError> {
        let variable = self.table.get(reference).ok_or_else(|| unknown(reference, "integer"))?;
        let (whole, part) = self.simulation.time().parts();
        let Counts { events, switchings, last_event, .. } = self.journal.counts;
        let value = match variable.quantity {
            Quantity::TimeWhole => whole,
            Quantity::TimeFemtoseconds => part,
            Quantity::EventWhole => last_event.0,
            Quantity::EventFemtoseconds => last_event.1,
            Quantity::Events => events,
            Quantity::Switchings => switchings,
            Quantity::Seed => self.journal.seed,
            Quantity::Grid => self.journal.grid_ns,
            _ => return Err(unknown(reference, "integer")),
        };
        Ok(value as i64)
    }

    /// Sets an input, or a parameter before the start.
    ///
    /// # Errors
    /// Fails for a value that is not finite, for a reference of another kind and for a parameter after the start.
    pub fn set(&mut self, reference: u32, value: f64) -> Result<(), CoSimulationError> {
        let Some(variable) = self.table.get(reference) else {
            return Err(unknown(reference, "floating-point"));
        };
        if !value.is_finite() {
            let why = format!("{}: must be a finite number, got {value}", variable.name);
            return Err(CoSimulationError::refused(why));
        }
        match &variable.quantity {
            Quantity::Input(index) => self.journal.inputs[*index] = value.to_bits(),
            Quantity::Key(key) if !self.has_begun => {
                let key = key.clone();
                self.journal.keys.retain(|(own, _)| *own != key);
                self.journal.keys.push((key, value.to_bits()));
            }
            _ => return Err(self.not_settable(reference)),
        }
        Ok(())
    }

    /// Sets an integer parameter before the start.
    ///
    /// # Errors
    /// Fails for a negative value, for a reference of another kind and after the start.
    pub fn set_integer(&mut self, reference: u32, value: i64) -> Result<(), CoSimulationError> {
        let Some(variable) = self.table.get(reference) else { return Err(unknown(reference, "integer")) };
        let Ok(unsigned) = u64::try_from(value) else {
            let why = format!("{}: must not be negative, got {value}", variable.name);
            return Err(CoSimulationError::refused(why));
        };
        match variable.quantity {
            Quantity::Seed if !self.has_begun => self.journal.seed = unsigned,
            Quantity::Grid if !self.has_begun => self.journal.grid_ns = unsigned,
            _ => return Err(self.not_settable(reference)),
        }
        Ok(())
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
            _ => Err(unknown(reference, "clock")),
        }
    }

    /// Returns the interval of a periodic clock.
    ///
    /// # Errors
    /// Fails for a reference that is no periodic clock.
    pub fn interval(&self, reference: u32) -> Result<Span, CoSimulationError> {
        match self.table.get(reference).map(|variable| &variable.quantity) {
            Some(Quantity::Clock(ClockRole::Periodic(interval))) => Ok(*interval),
            _ => Err(unknown(reference, "periodic clock")),
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

    /// Returns the estimates and references that laws read at the current instant.
    fn law_inputs(&mut self) -> Result<&[f64], CoSimulationError> {
        if self.law_inputs.is_none() {
            let layout = self.simulation.telemetry_layout(&self.scenario);
            self.guarded(|simulation| simulation.open(&mut ()))?;
            let telemetry = self.guarded(|simulation| simulation.telemetry(&layout))?;
            self.law_inputs = Some(telemetry.law_inputs);
        }
        Ok(self.law_inputs.as_deref().unwrap_or_default())
    }

    fn not_settable(&self, reference: u32) -> CoSimulationError {
        let Some(variable) = self.table.get(reference) else { return unknown(reference, "settable") };
        let why = match variable.causality {
            Causality::Parameter => "a parameter cannot be set as this type, or after the start",
            _ => "cannot be set: it is not an input",
        };
        CoSimulationError::refused(format!("{}: {why}", variable.name))
    }
}

fn unknown(reference: u32, kind: &str) -> CoSimulationError {
    CoSimulationError::refused(format!("there is no {kind} variable with the value reference {reference}"))
}
