//! What the control system believes: the only thing that a law reads.

/// Written by the sensor and by the adaptation, read by the law.
#[derive(Copy, Clone, Debug, Default, PartialEq)]
pub struct Belief {
    /// Measured angle (rad).
    pub angle: f64,
    /// Measured rate (rad/s): of a sampled sensor, the difference of its last two samples over the period.
    pub rate: f64,
    /// The law's tunable parameter as adapted so far; for the relay law the braking gain `k_t`.
    pub gain: f64,
    /// The dominant mode, as an estimator gives it.
    pub dominant: Dominant,
}

/// The mode that a step of the torque excites most.
#[derive(Copy, Clone, Debug, Default, PartialEq)]
pub struct Dominant {
    /// Estimated displacement (rad).
    pub displacement: f64,
    /// Its derivative with time (rad/s).
    pub rate: f64,
    /// Estimated natural frequency (rad/s).
    pub frequency: f64,
}
