//! Bound on the frequencies in the motion of a three-axis body, for means over parts of it.

use super::SpatialPlant;
use crate::body::spatial::Periodic;
use crate::motion::turning::Surroundings;

impl SpatialPlant {
    /// Returns an upper bound on the frequencies in the motion at the current instant (rad/s): the sum of the fastest
    /// mode and of all rates that rotate or drive the body, so that their products are included.
    pub fn fastest(&self) -> f64 {
        if let Some(two_way) = self.two_way.as_deref() {
            return two_way.fastest();
        }
        let t = self.seen.seconds();
        let drifted = self.drifting.as_ref().map_or(1.0, |drifting| drifting.ratio(t).max(1.0));
        let own = self.disturbance.as_ref().map_or(0.0, Periodic::frequency);
        let around = self.around.as_ref().map_or(0.0, Surroundings::frequency);
        let stored = self.rotors(self.seen).map_or(0.0, |(rotors, _)| rotors.norm());
        drifted * self.elastic.fastest() + own + around + self.rigid.fastest(&self.state.turn, stored)
    }
}
