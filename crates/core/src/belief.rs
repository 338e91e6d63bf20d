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

/// What is believed of a spatial body, about its three axes: written by gyro and estimator, read by the law.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct AxesBelief {
    /// How far the attitude is beyond the goal (rad). The law knows it exactly: seed paper 4 has no error of it.
    pub angle: [f64; 3],
    /// Rigid rates (rad/s): the gyro's, or what an estimator makes of them.
    pub rate: [f64; 3],
    /// Changes of the rigid rates that are commanded, and not yet measured (rad/s).
    pub queued: [f64; 3],
    /// The elastic modes about each axis, at the time that the law wants to know them for.
    pub elastic: [Vec<ElasticRate>; 3],
    /// Whether they may be acted on.
    pub trusted: [bool; 3],
}

/// What is believed of an elastic mode about one axis.
#[derive(Copy, Clone, Debug, Default, PartialEq)]
pub struct ElasticRate {
    /// Elastic rate (rad/s).
    pub rate: f64,
    /// Natural frequency (rad/s).
    pub frequency: f64,
    /// Jump of the elastic rate for each jump of the rigid rate that the jets of the axis give.
    pub influence: f64,
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
