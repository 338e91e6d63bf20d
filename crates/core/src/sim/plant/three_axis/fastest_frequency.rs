//! Bound on the frequencies in the motion of a three-axis body, for means over parts of it.

use flexsc_dynamics::three_axis::Surroundings;
use flexsc_spacecraft::body::spatial::PeriodicTorque;

use super::ThreeAxisPlant;

impl ThreeAxisPlant {
    /// Returns an upper bound on the frequencies in the motion at the current instant (rad/s): the sum of the fastest
    /// mode and of all rates that rotate or drive the body, so that their products are included.
    pub fn fastest(&self) -> f64 {
        if let Some(two_way) = self.coupled.as_deref() {
            return two_way.fastest();
        }
        let t = self.evaluated_at.seconds();
        let drifted = self.drifting.as_ref().map_or(1.0, |drifting| drifting.ratio(t).max(1.0));
        let own = self.disturbance.as_ref().map_or(0.0, PeriodicTorque::frequency);
        let around = self.surroundings.as_ref().map_or(0.0, Surroundings::frequency);
        let stored = self.rotors(self.evaluated_at).map_or(0.0, |(rotors, _)| rotors.norm());
        drifted * self.elastic.fastest() + own + around + self.rigid.fastest(&self.state.turn, stored)
    }
}
