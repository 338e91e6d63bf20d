//! What the control system believes of the motion about one axis: the only thing that a law reads, and what it asks for.

/// Written by sensor and estimator, read by the law of the axis.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Belief {
    /// Angle (rad): of a body with one angle the angle itself, of one with three axes this component of the rotation vector from the target.
    pub angle: f64,
    /// Length of that vector, the angle between target and attitude (rad); 0 of a body with one angle.
    pub whole: f64,
    /// Rate (rad/s): of a sampled sensor without a gyro, the difference of its last two samples over the period.
    pub rate: f64,
    /// How fast the magnetic field along the axis changes (T/s): the difference of a magnetometer's last two readings over the
    /// time between.
    pub field_rate: f64,
    /// The dominant mode, as an estimator gives it.
    pub dominant: Dominant,
    /// Change of the rigid rate that is commanded, and not yet executed (rad/s).
    pub queued: f64,
    /// The elastic modes, at the time that the law wants to know them for.
    pub elastic: Vec<ElasticRate>,
    /// Whether they may be acted on.
    pub trusted: bool,
}

/// What is believed of an elastic mode about one axis.
#[derive(Copy, Clone, Debug, Default, PartialEq)]
pub struct ElasticRate {
    /// Elastic rate (rad/s).
    pub rate: f64,
    /// Natural frequency (rad/s).
    pub frequency: f64,
    /// Jump of the elastic rate for each jump of the rigid rate that the actuator of the axis gives.
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

/// What a law reads of an estimator.
#[derive(Copy, Clone, Debug, PartialEq, Eq)]
pub enum Reads {
    /// Nothing.
    Nothing,
    /// How fast the magnetic field changes.
    Field,
    /// Angle and rate.
    Motion,
    /// Angle and rate as measured, and the dominant mode.
    DominantMode,
    /// Rates, and all elastic modes.
    ElasticRates,
}

/// What active damping does about an axis.
#[derive(Copy, Clone, Debug, Default, PartialEq)]
pub struct Damped {
    /// Elastic rate on which it acts (rad/s).
    pub rate: f64,
    /// Threshold (rad/s).
    pub threshold: f64,
    /// Whether the elastic rate has been beyond the threshold and is not yet back.
    pub latched: bool,
    /// Whether the watchdog keeps it quiet.
    pub resting: bool,
    /// Signed on-time of its pulse (s).
    pub on: f64,
    /// Change of the rigid rate that the pulse makes (rad/s).
    pub change: f64,
}
