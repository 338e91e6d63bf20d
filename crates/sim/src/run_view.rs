//! Parts of a run at one instant, as the record and the observation read them.

use flexsc_control::flight_quantity::FlightQuantity;
use flexsc_control::operation::ModeSequence;
use flexsc_control::sensor::Orientation;
use flexsc_numerics::attitude::Vector;
use flexsc_numerics::time::Instant;

use super::controllers::ControlLaws;
use super::estimation::Estimation;
use super::fine_mirrors::FineMirrors;
use super::guidance::Guidance;
use super::loads::Loads;
use super::mode_sky::ModeSky;
use super::mode_test::TestedConditions;
use super::plant::Plant;
use super::sensors::Sensors;

/// Read access to the parts of a run at the current instant.
#[derive(Copy, Clone, Debug)]
pub struct RunView<'a> {
    pub now: Instant,
    /// Body, evaluated at `now`.
    pub plant: &'a Plant,
    pub sensors: &'a Sensors,
    pub estimation: &'a Estimation,
    pub guidance: &'a Guidance,
    pub laws: &'a ControlLaws,
    pub loads: &'a Loads,
    pub mirrors: &'a FineMirrors,
    /// Sequence of the modes of operation; `None` without modes.
    pub modes: Option<&'a ModeSequence>,
    /// Sunlight and elevations that conditions read.
    pub sky: &'a ModeSky,
    /// Last test of the conditions before a decision from outside.
    pub tested: Option<&'a TestedConditions>,
}

/// Returns the true rate (rad/s) about the body's axes; of a body with one angle, with its elastic part.
pub fn true_rate(plant: &Plant) -> [f64; 3] {
    let truth = plant.truth();
    if plant.quantities().one_axis().is_some() { truth.rate } else { truth.rigid_rate }
}

/// Returns the error of the attitude (rad), or of the rate (rad/s) if `is_rate`, about the body's axes.
pub fn motion_error(plant: &Plant, guidance: &Guidance, now: Instant, is_rate: bool) -> [f64; 3] {
    let truth = plant.truth();
    if plant.quantities().one_axis().is_some() {
        let (angle, rate) = guidance.manoeuvre_state(now);
        let of_angle = || truth.orientation.error_from(&Orientation::Angle(angle));
        return if is_rate { [true_rate(plant)[0] - rate, 0.0, 0.0] } else { of_angle() };
    }
    let error = truth.orientation.error_from(&guidance.origin(now));
    if !is_rate {
        return error;
    }
    let reference = guidance.reference_rate(now, &Vector::from(error));
    (Vector::from(true_rate(plant)) - reference).into()
}

impl RunView<'_> {
    /// Returns a quantity that the conditions of a mode compare: at their test, else now.
    fn compared(&self, tested: fn(&TestedConditions) -> &Vec<f64>, now: FlightQuantity) -> Vec<f64> {
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
        let count = self.modes.map_or(0, ModeSequence::reading_count);
        let test = self.tested.filter(|test| test.at == self.now);
        test.map_or_else(|| vec![f64::NAN; count], |test| test.readings.clone())
    }
}
