//! Test of the conditions of a mode before a decision from outside: the program that decides sees the target of the mode that follows, and
//! what the conditions of the mode before compared.

use flexsc_control::flight_quantity::FlightQuantity;
use flexsc_numerics::time::Instant;
use flexsc_record::Record;

use super::{Simulation, SimulationError};

/// Values that conditions compared at an instant, before the mode changed.
#[derive(Clone, Debug)]
pub struct TestedConditions {
    /// Instant of the test.
    pub at: Instant,
    /// Target attitude (w, x, y, z); empty for one axis.
    pub attitude: Vec<f64>,
    /// Rate of the reference about each axis (rad/s).
    pub rate: Vec<f64>,
    /// Readings of all conditions; NaN of those that were not compared.
    pub readings: Vec<f64>,
}

impl Simulation {
    /// Tests the conditions of the mode that are due now, and enters the mode that follows, before commands from outside are set at
    /// this instant. Without this, the test comes with the decision.
    ///
    /// # Errors
    /// Fails if the state is no longer finite, for modes that change endlessly, and if the record cannot be written.
    pub fn test_modes(&mut self, record: &mut dyn Record) -> Result<(), SimulationError> {
        let now = self.clock.now();
        if self.operation.due() != Some(now) {
            return Ok(());
        }
        self.plant.evaluate(now)?;
        self.end_requirement_segment();
        self.estimation.update_angle_origin(now, &mut self.guidance);
        self.estimation.predict(now, &self.plant, &self.sensors);
        let [attitude, rate] = [FlightQuantity::TargetAttitude, FlightQuantity::ReferenceRate]
            .map(|own| self.read_view().known(own));
        self.operation.tested = Some(TestedConditions { at: now, attitude, rate, readings: Vec::new() });
        self.update_mode(record)
    }
}
