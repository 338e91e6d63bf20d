//! Test of the conditions of a mode before a decision from outside: the program that decides sees the target of the mode that follows, and
//! what the conditions of the mode before compared.

use flexsc_control::flight_quantity::FlightQuantity;
use flexsc_numerics::time::Instant;
use flexsc_record::Record;

use super::run_view::RunView;
use super::{Simulation, SimulationError};

/// What conditions compared at an instant, before the mode changed.
#[derive(Clone, Debug)]
pub struct ModeTest {
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
        self.operation.tested = Some(ModeTest { at: now, attitude, rate, readings: Vec::new() });
        self.update_mode(record)
    }
}

impl RunView<'_> {
    /// Returns a quantity that the conditions of a mode compare: at their test, else now.
    fn compared(&self, tested: fn(&ModeTest) -> &Vec<f64>, now: FlightQuantity) -> Vec<f64> {
        match self.tested.filter(|test| test.at == self.now) {
            Some(test) => tested(test).clone(),
            None => self.known(now),
        }
    }

    /// Returns the target attitude of the mode whose conditions are tested.
    pub fn compared_attitude(&self) -> Vec<f64> {
        self.compared(|test| &test.attitude, FlightQuantity::TargetAttitude)
    }

    /// Returns the rate of the reference of that mode (rad/s).
    pub fn compared_rate(&self) -> Vec<f64> {
        self.compared(|test| &test.rate, FlightQuantity::ReferenceRate)
    }

    /// Returns the readings of all conditions; NaN without a test at this instant.
    pub fn compared_readings(&self) -> Vec<f64> {
        let count = self.modes.map_or(0, |sequence| sequence.reading_count());
        let test = self.tested.filter(|test| test.at == self.now);
        test.map_or_else(|| vec![f64::NAN; count], |test| test.readings.clone())
    }
}
