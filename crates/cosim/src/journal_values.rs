//! Values of variables that the journal of a co-simulation holds: inputs, keys of the scenario, seed, grid and counts.

use flexsc_core::numerics::time::Instant;

use crate::error::CoSimulationError;
use crate::journal::{Counts, InputJournal};
use crate::variable::{Causality, Quantity, Variable, VariableStart};

impl InputJournal {
    /// Returns the value of a key of the scenario, which is `start` until it is set.
    pub fn key_value(&self, key: &str, start: &VariableStart) -> f64 {
        let set = self.keys.iter().find(|(own, _)| own == key);
        let start = match start {
            VariableStart::Float(value) => *value,
            VariableStart::Integer(value) => *value as f64,
        };
        set.map_or(start, |(_, bits)| f64::from_bits(*bits))
    }

    /// Returns an integer quantity of a run that is at an instant; `None` for other quantities.
    pub fn integer(&self, quantity: &Quantity, now: Instant) -> Option<i64> {
        let (whole, part) = now.parts();
        let Counts { events, switchings, last_event, .. } = self.counts;
        let value = match quantity {
            Quantity::TimeWhole => whole,
            Quantity::TimeFemtoseconds => part,
            Quantity::EventWhole => last_event.0,
            Quantity::EventFemtoseconds => last_event.1,
            Quantity::Events => events,
            Quantity::Switchings => switchings,
            Quantity::Seed => self.seed,
            Quantity::Grid => self.grid_ns,
            _ => return None,
        };
        Some(value as i64)
    }

    /// Sets the stop time (s) that the importer requests; one that is not finite requests none.
    pub fn set_stop_time(&mut self, stop_time: Option<f64>) {
        self.stop_time = stop_time.filter(|stop| stop.is_finite()).map(f64::to_bits);
    }

    /// Sets an input, or a parameter before the start of the run.
    ///
    /// # Errors
    /// Fails for a value that is not finite, for a variable of another kind and for a parameter after the start.
    pub fn set(&mut self, variable: &Variable, value: f64, has_begun: bool) -> Result<(), CoSimulationError> {
        if !value.is_finite() {
            let why = format!("{}: must be a finite number, got {value}", variable.name);
            return Err(CoSimulationError::refused(why));
        }
        match &variable.quantity {
            Quantity::Input(index) => self.inputs[*index] = value.to_bits(),
            Quantity::Key(key) if !has_begun => {
                self.keys.retain(|(own, _)| own != key);
                self.keys.push((key.clone(), value.to_bits()));
            }
            _ => return Err(not_settable(variable)),
        }
        Ok(())
    }

    /// Sets an integer parameter before the start of the run.
    ///
    /// # Errors
    /// Fails for a negative value, for a variable of another kind and after the start.
    pub fn set_integer(
        &mut self,
        variable: &Variable,
        value: i64,
        has_begun: bool,
    ) -> Result<(), CoSimulationError> {
        let Ok(unsigned) = u64::try_from(value) else {
            let why = format!("{}: must not be negative, got {value}", variable.name);
            return Err(CoSimulationError::refused(why));
        };
        match variable.quantity {
            Quantity::Seed if !has_begun => self.seed = unsigned,
            Quantity::Grid if !has_begun => self.grid_ns = unsigned,
            _ => return Err(not_settable(variable)),
        }
        Ok(())
    }
}

/// Returns the error of setting a variable that cannot be set.
fn not_settable(variable: &Variable) -> CoSimulationError {
    let why = match variable.causality {
        Causality::Parameter => "a parameter cannot be set as this type, or after the start",
        _ => "cannot be set: it is not an input",
    };
    CoSimulationError::refused(format!("{}: {why}", variable.name))
}
