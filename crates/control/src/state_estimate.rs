//! State estimate of the motion about one axis, the only input of a law, and the estimates that laws need.

pub use flexsc_flight::active_damping::{DampingStatus, ElasticRateEstimate};
use flexsc_flight::axis_motion::AxisMotion;

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

impl StateEstimate {
    /// Returns the estimated motion as flight code has it.
    #[inline]
    pub fn flight_motion(&self) -> AxisMotion {
        AxisMotion {
            angle: self.angle,
            total_angle: self.total_angle,
            rate: self.rate,
            queued_rate: self.queued_rate,
            displacement: self.dominant.displacement,
            displacement_rate: self.dominant.rate,
            frequency: self.dominant.frequency,
        }
    }
}

/// Returns the estimated rate about each axis (rad/s); 0 about axes without an estimate.
#[inline]
pub fn estimated_rates(estimates: &[StateEstimate]) -> [f64; 3] {
    [0, 1, 2].map(|axis| estimates.get(axis).map_or(0.0, |estimate| estimate.rate))
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
