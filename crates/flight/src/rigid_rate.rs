//! Filter of the rigid rate about an axis: predicted by the pulses of the actuator and a steady torque, corrected slightly by the
//! measured rate, so that its elastic part is mostly left out.

/// Filter of a rigid rate.
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct RigidRateFilter {
    /// Fraction of the innovation by which a sample corrects the rate.
    pub correction: f64,
    /// Estimated rate (rad/s).
    pub rate: f64,
    /// Change of the rate from one sample to the next by a steady torque (rad/s).
    pub drift: f64,
}

impl RigidRateFilter {
    /// Takes a sample: the measured rate (rad/s), if there is a measurement, and the change of the rate by the pulses since the
    /// sample before (rad/s). Numbers that are not finite are left out.
    #[inline]
    pub fn take(&mut self, is_measured: bool, measured: f64, pushed: f64) {
        let change: f64 = if pushed.is_finite() { pushed } else { 0.0 };
        let predicted: f64 = self.rate + change + self.drift;
        let innovation: f64 = if is_measured && measured.is_finite() { measured - predicted } else { 0.0 };
        self.rate = predicted + self.correction * innovation;
        self.drift += 0.25 * self.correction * self.correction * innovation;
    }
}
