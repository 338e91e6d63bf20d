//! State estimate of the motion about one axis, the only input of a law, and the estimates that laws need.

/// State estimate about one axis, written by sensor and estimator, and read by the law of the axis.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct StateEstimate {
    /// Angle (rad): of a body with one angle the angle itself, of one with three axes this component of the rotation vector from the target.
    pub angle: f64,
    /// Length of that vector, the angle between target and attitude (rad); 0 of a body with one angle.
    pub total_angle: f64,
    /// Rate (rad/s); of a sampled sensor without a gyro, the difference of the last two samples divided by the period.
    pub rate: f64,
    /// Rate of change of the magnetic field along the axis (T/s): the difference of a magnetometer's last two readings
    /// divided by the time between them.
    pub field_rate: f64,
    /// Dominant mode.
    pub dominant: DominantMode,
    /// Commanded change of the rigid rate that is not yet executed (rad/s).
    pub queued_rate: f64,
    /// Elastic modes, with rates predicted for the law's lead time.
    pub elastic: Vec<ElasticRateEstimate>,
    /// True if laws may act on the elastic modes.
    pub elastic_is_trusted: bool,
}

/// Estimate of an elastic mode about one axis.
#[derive(Copy, Clone, Debug, Default, PartialEq)]
pub struct ElasticRateEstimate {
    /// Elastic rate (rad/s).
    pub rate: f64,
    /// Natural frequency (rad/s).
    pub frequency: f64,
    /// Jump of the elastic rate per unit jump of the rigid rate by the actuator of the axis.
    pub influence: f64,
}

/// Mode that a step of the torque excites most, by an estimate.
#[derive(Copy, Clone, Debug, Default, PartialEq)]
pub struct DominantMode {
    /// Estimated displacement (rad).
    pub displacement: f64,
    /// Time derivative of the displacement (rad/s).
    pub rate: f64,
    /// Estimated natural frequency (rad/s).
    pub frequency: f64,
}

/// Estimates that a law reads, from the fewest to the most.
#[derive(Copy, Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum EstimateNeeds {
    /// No estimates.
    Nothing,
    /// Rate of change of the magnetic field.
    Field,
    /// Angle and rate.
    Motion,
    /// Angle and rate as measured, and the dominant mode.
    DominantMode,
    /// Rates, and all elastic modes.
    ElasticRates,
}

impl EstimateNeeds {
    /// Returns the needs of several laws together: the most that one of them reads.
    pub fn most(laws: impl Iterator<Item = Self>) -> Self {
        laws.max().unwrap_or(Self::Nothing)
    }
}

/// Status of active damping about an axis.
#[derive(Copy, Clone, Debug, Default, PartialEq)]
pub struct DampingStatus {
    /// Elastic rate on which damping acts (rad/s).
    pub rate: f64,
    /// Threshold (rad/s).
    pub threshold: f64,
    /// True if the elastic rate has exceeded the threshold and has not fallen below the release level.
    pub latched: bool,
    /// True if the watchdog has paused damping.
    pub resting: bool,
    /// Signed on-time of the pulse (s).
    pub on: f64,
    /// Change of the rigid rate by the pulse (rad/s).
    pub change: f64,
}
