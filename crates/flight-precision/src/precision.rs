//! Functions of flight code in the precision of the flight computer.

use flexsc_flight::attitude_estimator::{AttitudeEstimator, EstimatorOutput};
use flexsc_flight::attitude_filter::{AttitudeBiasFilter, GyroNoise};
use flexsc_flight::attitude_gate::AttitudeGate;
use flexsc_flight::attitude_history::AttitudeHistoryEntry;
use flexsc_flight::attitude_law::AttitudeFeedback;
use flexsc_flight::axis_motion::{AxisMotion, AxisReference, total_angle};
use flexsc_flight::b_dot::{self, FieldRate, opposing_moment};
use flexsc_flight::biquad::BiquadFilter;
use flexsc_flight::magnetorquers::{moment_of_torque, torque_of_moment};
use flexsc_flight::matrix3::Matrix3;
use flexsc_flight::mode_condition::ConditionStep;
use flexsc_flight::mode_readings;
use flexsc_flight::mode_supervisor::{ModeSupervisor, ModeTest, SupervisedExit};
use flexsc_flight::momentum_unloading::MomentumUnloading;
use flexsc_flight::quaternion::Quaternion;
use flexsc_flight::supervised_mode::{SupervisedMode, TargetChange};
use flexsc_flight::ticks::Ticks;
use flexsc_flight::torque_distribution;
use flexsc_flight::vector3::Vector3;
use flexsc_flight::wheel_allocation::{AllocatedWheel, drive};
use flexsc_flight::wheel_momentum;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::twin::{Twin, changed, changed_list, list};

/// Precision in which the flight computer computes.
#[derive(Copy, Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Precision {
    /// Doubles, of 64 bits.
    #[default]
    Double,
    /// Floats, of 32 bits.
    Single,
}

impl Precision {
    /// Returns true for double precision, the default.
    pub fn is_double(&self) -> bool {
        *self == Self::Double
    }

    /// Returns a number as the flight computer holds it.
    pub fn rounded(self, x: f64) -> f64 {
        match self {
            Self::Double => x,
            Self::Single => f64::from(x as f32),
        }
    }

    /// Returns a vector as the flight computer holds it.
    pub fn rounded_vector(self, v: &Vector3) -> Vector3 {
        Vector3 { x: self.rounded(v.x), y: self.rounded(v.y), z: self.rounded(v.z) }
    }

    /// Returns the difference of two vectors.
    pub fn difference(self, of: &Vector3, from: &Vector3) -> Vector3 {
        match self {
            Self::Double => of.minus(from),
            Self::Single => Vector3::double(&of.single().minus(&from.single())),
        }
    }

    /// Returns the span in seconds, as the flight computer has it.
    pub fn seconds(self, span: Ticks) -> f64 {
        match self {
            Self::Double => span.seconds(),
            Self::Single => f64::double(&span.single().seconds()),
        }
    }

    /// Returns the acceleration (rad/s²) of an attitude law.
    #[inline]
    pub fn feedback(
        self,
        law: &mut AttitudeFeedback,
        motion: &AxisMotion,
        reference: &AxisReference,
        filters: &mut [BiquadFilter],
    ) -> f64 {
        match self {
            Self::Double => law.step(motion, reference, filters),
            Self::Single => f64::double(&changed(law, |law| {
                changed_list(filters, |filters| law.step(&motion.single(), &reference.single(), filters))
            })),
        }
    }

    /// Returns the length of the rotation vector of these angles (rad).
    #[inline]
    pub fn total_angle(self, [roll, pitch, yaw]: [f64; 3]) -> f64 {
        match self {
            Self::Double => total_angle(roll, pitch, yaw),
            Self::Single => {
                f64::double(&crate::axis_motion::total_angle(roll.single(), pitch.single(), yaw.single()))
            }
        }
    }

    /// Returns the torque (N m) that gives a body an acceleration.
    pub fn torque(
        self,
        inertia: &Matrix3,
        acceleration: &Vector3,
        rate: &Vector3,
        stored: &Vector3,
    ) -> Vector3 {
        match self {
            Self::Double => torque_distribution::torque(inertia, acceleration, rate, stored),
            Self::Single => Vector3::double(&crate::torque_distribution::torque(
                &inertia.single(),
                &acceleration.single(),
                &rate.single(),
                &stored.single(),
            )),
        }
    }

    /// Gives wheels the torques that sum up to `counter` without a demanded torque (N m), within a limit (N m).
    pub fn drive(
        self,
        wheels: &mut [AllocatedWheel],
        demanded: &Vector3,
        counter: &Vector3,
        is_least_largest: bool,
        limit: f64,
    ) {
        match self {
            Self::Double => drive(wheels, demanded, counter, is_least_largest, limit),
            Self::Single => changed_list(wheels, |wheels| {
                let (demanded, counter) = (demanded.single(), counter.single());
                crate::wheel_allocation::drive(wheels, &demanded, &counter, is_least_largest, limit.single());
            }),
        }
    }

    /// Returns the rotation vector (rad) from an attitude to another.
    pub fn rotation(self, from: &Quaternion, to: &Quaternion) -> Vector3 {
        match self {
            Self::Double => from.rotation_to(to),
            Self::Single => Vector3::double(&from.single().rotation_to(&to.single())),
        }
    }

    /// Returns the angle (rad) of an attitude from a target, and ends a change to it.
    pub fn angle_from(
        self,
        change: &mut TargetChange,
        target: &Quaternion,
        attitude: &Quaternion,
    ) -> Vector3 {
        match self {
            Self::Double => change.angle_from(target, attitude),
            Self::Single => Vector3::double(&changed(change, |change| {
                change.angle_from(&target.single(), &attitude.single())
            })),
        }
    }

    /// Returns an attitude filter with these standard deviations of attitude (rad) and bias (rad/s).
    pub fn filter(self, attitude: Quaternion, bias: Vector3, [angle, rate]: [f64; 2]) -> AttitudeBiasFilter {
        match self {
            Self::Double => AttitudeBiasFilter::new(attitude, bias, angle, rate),
            Self::Single => AttitudeBiasFilter::double(&crate::attitude_filter::AttitudeBiasFilter::new(
                attitude.single(),
                bias.single(),
                angle.single(),
                rate.single(),
            )),
        }
    }

    /// Returns the attitude of a filter a span after its time, with the gyro's rate (rad/s).
    pub fn attitude_after(self, filter: &AttitudeBiasFilter, reading: &Vector3, span: Ticks) -> Quaternion {
        match self {
            Self::Double => filter.attitude_after(reading, span.seconds()),
            Self::Single => Quaternion::double(
                &filter.single().attitude_after(&reading.single(), span.single().seconds()),
            ),
        }
    }

    /// Starts an attitude estimator.
    pub fn start_estimator(
        self,
        now: Ticks,
        filter: AttitudeBiasFilter,
        noise: GyroNoise,
        reach: Ticks,
        gate: AttitudeGate,
        entries: &mut [AttitudeHistoryEntry],
    ) -> AttitudeEstimator {
        match self {
            Self::Double => AttitudeEstimator::start(now, filter, noise, reach, gate, entries),
            Self::Single => AttitudeEstimator::double(&changed_list(entries, |entries| {
                crate::attitude_estimator::AttitudeEstimator::start(
                    now.single(),
                    filter.single(),
                    noise.single(),
                    reach.single(),
                    gate.single(),
                    entries,
                )
            })),
        }
    }

    /// Returns the attitude of an estimator.
    pub fn attitude(
        self,
        estimator: &AttitudeEstimator,
        now: Ticks,
        entries: &[AttitudeHistoryEntry],
    ) -> Quaternion {
        match self {
            Self::Double => estimator.attitude(now, entries),
            Self::Single => {
                let (estimator, entry) = latest(estimator, entries);
                Quaternion::double(&estimator.attitude(now.single(), &entry))
            }
        }
    }

    /// Returns the rate of an estimator (rad/s).
    pub fn rate(self, estimator: &AttitudeEstimator, entries: &[AttitudeHistoryEntry]) -> Vector3 {
        match self {
            Self::Double => estimator.rate(entries),
            Self::Single => {
                let (estimator, entry) = latest(estimator, entries);
                Vector3::double(&estimator.rate(&entry))
            }
        }
    }

    /// Returns the estimate of an estimator with its uncertainty.
    pub fn output(
        self,
        estimator: &AttitudeEstimator,
        now: Ticks,
        entries: &[AttitudeHistoryEntry],
    ) -> EstimatorOutput {
        match self {
            Self::Double => estimator.output(now, entries),
            Self::Single => {
                let (estimator, entry) = latest(estimator, entries);
                EstimatorOutput::double(&estimator.output(now.single(), &entry))
            }
        }
    }

    /// Returns the size of the innovation of the last correction of an estimator (rad).
    pub fn innovation_size(self, innovation: &Vector3) -> f64 {
        match self {
            Self::Double => innovation.norm(),
            Self::Single => f64::double(&innovation.single().norm()),
        }
    }

    /// Returns the standard deviation of the attitude about all axes together (rad), by the covariance of a filter.
    pub fn deviation_size(self, filter: &AttitudeBiasFilter) -> f64 {
        let variances = [0, 1, 2].map(|axis: usize| filter.covariance.rows[axis][axis]);
        match self {
            Self::Double => {
                let [x, y, z] = variances.map(flexsc_flight::square_root::sqrt);
                Vector3 { x, y, z }.norm()
            }
            Self::Single => {
                let [x, y, z] = variances.single().map(crate::square_root::sqrt);
                f64::double(&crate::vector3::Vector3 { x, y, z }.norm())
            }
        }
    }

    /// Takes a sample of the magnetic field (T).
    pub fn take_field(self, rate: &mut FieldRate, now: Ticks, field: &Vector3) {
        match self {
            Self::Double => rate.take(now, field),
            Self::Single => changed(rate, |rate| rate.take(now.single(), &field.single())),
        }
    }

    /// Returns the momentum (N m s) of wheels with this inertia (kg m²), by their speeds and the estimated rate (rad/s).
    pub fn stored_momentum(self, axes: &[Vector3], inertia: f64, speeds: &[f64], rate: &Vector3) -> Vector3 {
        match self {
            Self::Double => wheel_momentum::stored(axes, inertia, speeds, rate),
            Self::Single => Vector3::double(&crate::wheel_momentum::stored(
                &list(axes),
                inertia.single(),
                &list(speeds),
                &rate.single(),
            )),
        }
    }

    /// Returns the moment (A m²) of a B-dot law for a rate of change of the field (T/s).
    pub fn opposing_moment(self, gain: f64, field_rate: f64) -> f64 {
        match self {
            Self::Double => opposing_moment(gain, field_rate),
            Self::Single => f64::double(&crate::b_dot::opposing_moment(gain.single(), field_rate.single())),
        }
    }

    /// Returns the moments (A m²) of B-dot laws within limits, for gains and a rate of change of the field (T/s).
    pub fn moments(self, field_rate: &Vector3, gains: &Vector3, limits: &Vector3) -> Vector3 {
        match self {
            Self::Double => b_dot::moments(field_rate, gains, limits),
            Self::Single => Vector3::double(&crate::b_dot::moments(
                &field_rate.single(),
                &gains.single(),
                &limits.single(),
            )),
        }
    }

    /// Returns the torque (N m) of a cycle in which wheels with this momentum (N m s) are unloaded.
    pub fn unloading_torque(self, law: &mut MomentumUnloading, stored: &Vector3) -> Vector3 {
        match self {
            Self::Double => law.torque(stored),
            Self::Single => Vector3::double(&changed(law, |law| law.torque(&stored.single()))),
        }
    }

    /// Begins a cycle in which magnetorquers unload wheels: writes their moment (A m²), and returns the torque (N m) that the wheels
    /// counteract.
    pub fn begin_magnetic(
        self,
        law: &mut MomentumUnloading,
        stored: &Vector3,
        [field, limits]: [&Vector3; 2],
        moment: &mut Vector3,
    ) -> Vector3 {
        match self {
            Self::Double => law.begin_magnetic(stored, field, limits, moment),
            Self::Single => Vector3::double(&changed(law, |law| {
                changed(moment, |moment| {
                    law.begin_magnetic(&stored.single(), &field.single(), &limits.single(), moment)
                })
            })),
        }
    }

    /// Returns the moment (A m²) within limits whose torque in a field (T) is the part of a torque (N m) across it.
    pub fn moment_of_torque(self, torque: &Vector3, field: &Vector3, limits: &Vector3) -> Vector3 {
        match self {
            Self::Double => moment_of_torque(torque, field, limits),
            Self::Single => Vector3::double(&crate::magnetorquers::moment_of_torque(
                &torque.single(),
                &field.single(),
                &limits.single(),
            )),
        }
    }

    /// Returns the torque (N m) of a moment (A m²) in a field (T).
    pub fn torque_of_moment(self, moment: &Vector3, field: &Vector3) -> Vector3 {
        match self {
            Self::Double => torque_of_moment(moment, field),
            Self::Single => {
                Vector3::double(&crate::magnetorquers::torque_of_moment(&moment.single(), &field.single()))
            }
        }
    }

    /// Returns the norm of numbers.
    pub fn norm(self, values: &[f64]) -> f64 {
        match self {
            Self::Double => mode_readings::norm(values),
            Self::Single => f64::double(&crate::mode_readings::norm(&list(values))),
        }
    }

    /// Returns the norm of the differences of numbers.
    pub fn distance(self, values: &[f64], others: &[f64]) -> f64 {
        match self {
            Self::Double => mode_readings::distance(values, others),
            Self::Single => f64::double(&crate::mode_readings::distance(&list(values), &list(others))),
        }
    }

    /// Tests the conditions of a mode.
    pub fn test_modes(
        self,
        supervisor: &mut ModeSupervisor,
        now: Ticks,
        readings: &[f64],
        modes: &mut [SupervisedMode],
        exits: &mut [SupervisedExit],
        steps: &[ConditionStep],
    ) -> ModeTest {
        match self {
            Self::Double => supervisor.test(now, readings, modes, exits, steps),
            Self::Single => ModeTest::double(&changed(supervisor, |supervisor| {
                changed_list(modes, |modes| {
                    changed_list(exits, |exits| {
                        supervisor.test(now.single(), &list(readings), modes, exits, &list(steps))
                    })
                })
            })),
        }
    }
}

/// Returns the twin of an estimator whose history is its latest entry.
fn latest(
    estimator: &AttitudeEstimator,
    entries: &[AttitudeHistoryEntry],
) -> (crate::attitude_estimator::AttitudeEstimator, [crate::attitude_history::AttitudeHistoryEntry; 1]) {
    let entry = entries[estimator.history.latest()].single();
    let mut twin = estimator.single();
    (twin.history.first, twin.history.entries) = (0, 1);
    (twin, [entry])
}
