//! Parts of a run at one instant, as the record and the observation read them.

use flexsc_numerics::time::Instant;

use super::controllers::ControlLaws;
use super::estimation::Estimation;
use super::guidance::Guidance;
use super::loads::Loads;
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
}
