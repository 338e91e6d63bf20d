//! Topics of three-axis bodies.

use crate::row::rows;
use crate::states::{Latch, Light, Onset, ReadingOutcome, Sliding, Trust, Use, Watch};
use crate::topics::one_angle::{Estimate, Torque};

rows! {
    package "flexsc.v1";

    /// The rates about one axis.
    AxisRate {
        /// Rate at the gyro, elastic part included (rad/s).
        rate_rad_s: f64,
        /// Rigid rate (rad/s).
        rigid_rad_s: f64,
        /// Elastic part at the gyro (rad/s).
        elastic_rad_s: f64,
        /// Rate measured by the gyro at the last cycle (rad/s).
        measured_rad_s: f64,
        /// Rigid rate that the law read at the last cycle (rad/s).
        believed_rad_s: f64,
    }
    /// Rates of a spatial body, in its own axes.
    Rates = "/rates" at Period {
        /// About x, y and z.
        axes: Vec<AxisRate>,
    }
    /// Torques on a spatial body with actuators other than jets, or with an environment.
    Torques = "/torques" at Period {
        /// About x, y and z.
        axes: Vec<Torque>,
    }
    /// Kalman filters about each of three axes, after a sample.
    Estimates = "/estimators" at Sample {
        /// About x, y and z; angles are measured from the target.
        axes: Vec<Estimate>,
    }
    /// An attitude filter about one axis of the body, after a sample.
    AxisEstimate {
        /// Estimated angle minus the true one (rad).
        angle_error_rad: f64,
        /// Standard deviation of the angle (rad).
        angle_sd_rad: f64,
        /// Estimated bias of the gyro (rad/s).
        bias_rad_s: f64,
        /// Estimated bias minus the true one (rad/s).
        bias_error_rad_s: f64,
        /// Standard deviation of the bias (rad/s).
        bias_sd_rad_s: f64,
        /// Measured angle minus the predicted one at the time of measurement (rad); 0 without a measurement.
        innovation_rad: f64,
    }
    /// An attitude filter, after a sample.
    AttitudeEstimate = "/attitude_filter" at Sample {
        /// Real part of the estimated quaternion that turns vectors of the body into inertial ones.
        q_w: f64,
        /// The x component of that quaternion.
        q_x: f64,
        /// The y component of that quaternion.
        q_y: f64,
        /// The z component of that quaternion.
        q_z: f64,
        /// About x, y and z.
        axes: Vec<AxisEstimate>,
        /// Normalised estimation error squared, over its dimension, 6: about 1 for a consistent filter.
        nees: f64,
        /// Normalised innovation squared, over its dimension, 3: about 1 for a consistent filter; 0 without a measurement.
        nis: f64,
        /// Whether an attitude was measured.
        measured: Use,
        /// Dimension of the measurement: 2 for a direction, otherwise 3.
        numbers: u64,
    }
    /// A reading that an attitude filter has refused, or accepted after refusals.
    RefusedReading {
        /// Index of the sensor in the scenario, from 0.
        sensor: u64,
        /// Outcome of the reading.
        outcome: ReadingOutcome,
        /// Normalised innovation squared, over its dimension, 3; NaN of a gyro, and of an unsound or untimely reading.
        nis: f64,
    }
    /// Readings that an attitude filter has refused at a sample, or accepted after refusals.
    Refusals = "/refusals" at Sample {
        /// Each reading, the gyro first.
        readings: Vec<RefusedReading>,
    }
    /// A mode in an attitude filter, after a sample.
    ElasticEstimate {
        /// Estimated displacement (m sqrt(kg)).
        displacement: f64,
        /// Estimated rate over the estimated natural frequency (m sqrt(kg)).
        rate_over_frequency: f64,
        /// Natural frequency in the filter, identified or taken as known (rad/s).
        frequency_rad_s: f64,
        /// Standard deviation of the frequency (rad/s); 0 if it is taken as known.
        frequency_sd_rad_s: f64,
        /// True value, with drives that at the start (rad/s).
        true_frequency_rad_s: f64,
    }
    /// The modes in an attitude filter, after a sample.
    ElasticEstimates = "/attitude_filter_modes" at Sample {
        /// Each mode, in the order of the scenario.
        modes: Vec<ElasticEstimate>,
    }
    /// Wheels of a spatial body.
    Wheels = "/wheels" at Period panels ["wheels": "Speeds of the wheels (rad/s)", "wheel" speed_rad_s] {
        /// Each wheel, in the order of the scenario.
        wheels: Vec<Wheel>,
    }
    /// A wheel about an axis of its own.
    Wheel {
        /// Speed relative to the body (rad/s).
        speed_rad_s: f64,
        /// Absolute angular momentum about its axis (N m s).
        momentum_nm_s: f64,
        /// Torque of its motor (N m).
        torque_nm: f64,
    }
    /// A control moment gyro.
    ControlMomentGyro {
        /// Gimbal angle (rad).
        angle_rad: f64,
        /// Gimbal rate (rad/s).
        rate_rad_s: f64,
    }
    /// Control moment gyros of a spacecraft.
    ControlMomentGyros = "/control_moment_gyros" at Period panels [
        "gimbals": "Angles of the gimbals (rad)", "gimbal" angle_rad;
        "singularity": "Singularity measure of the gimbals", "measure" singularity
    ] {
        /// Each, in the order of the scenario.
        gyros: Vec<ControlMomentGyro>,
        /// Angular momentum of their rotors along the body's x (N m s).
        momentum_x_nm_s: f64,
        /// Angular momentum of their rotors along the body's y (N m s).
        momentum_y_nm_s: f64,
        /// Angular momentum of their rotors along the body's z (N m s).
        momentum_z_nm_s: f64,
        /// Singularity measure: 0 where the gimbals give no torque in some direction.
        singularity: f64,
    }
    /// Sample of an accelerometer along one of its axes.
    Acceleration {
        /// Reading (m/s²).
        measured_m_s2: f64,
        /// True value at the time of the sample (m/s²).
        true_m_s2: f64,
        /// Bias of the sample (m/s²).
        bias_m_s2: f64,
    }
    /// An accelerometer outputs a sample.
    Accelerations = "/accelerations" at Sample {
        /// Index of the sensor in the scenario, from 0.
        sensor: u64,
        /// Along each of its axes.
        axes: Vec<Acceleration>,
    }
    /// A magnetorquer.
    Magnetorquer {
        /// Magnetic moment that it holds (A m²).
        moment_am2: f64,
    }
    /// Magnetorquers of a spatial body.
    Magnetorquers = "/magnetorquers" at Period {
        /// Along x, y and z.
        axes: Vec<Magnetorquer>,
    }
    /// Orbital position, magnetic field and Sun of a spatial body, along one axis.
    OrbitAxis {
        /// Position from the planet's centre, in inertial axes (m).
        position_m: f64,
        /// Velocity, in inertial axes (m/s).
        velocity_m_s: f64,
        /// Direction to the planet's centre, in the body's axes.
        nadir: f64,
        /// Magnetic field, in the body's axes (T); NaN without one.
        field_t: f64,
        /// Direction to the Sun, in the body's axes, in sunlight or shadow; NaN without a Sun.
        sun: f64,
    }
    /// Orbital position, magnetic field and Sun of a spatial body.
    Orbit = "/orbit" at Period {
        /// Along x, y and z.
        axes: Vec<OrbitAxis>,
        /// Whether the body is in sunlight.
        light: Light,
        /// Part of the Sun's disc that the planet leaves in view, from 0 to 1.
        sunlight: f64,
    }
    /// A drive that turns an appendage.
    DriveMotion {
        /// Angle (rad).
        angle_rad: f64,
        /// Rate (rad/s).
        rate_rad_s: f64,
    }
    /// A free mode of a spacecraft whose appendages turn.
    DrivenMode {
        /// Natural frequency (rad/s).
        frequency_rad_s: f64,
    }
    /// Drives of a spacecraft's appendages, and the natural frequencies, which change with the drive angles.
    DrivesMotion = "/drives" at Period {
        /// Each drive, in the order of the appendages.
        drives: Vec<DriveMotion>,
        /// Each mode, in the order at the start.
        modes: Vec<DrivenMode>,
    }
    /// A hinge on which an appendage swings.
    HingeMotion {
        /// Angle (rad), 0 where its spring is relaxed.
        angle_rad: f64,
        /// Rate (rad/s).
        rate_rad_s: f64,
    }
    /// Hinges of a spacecraft's appendages.
    Hinges = "/hinges" at Period panels ["hinges": "Angles of the hinges (rad)", "hinge" angle_rad] {
        /// Each hinge, in the order of the appendages.
        hinges: Vec<HingeMotion>,
    }
    /// Bearings of the wheels of a spatial body with friction, imbalance or a tachometer.
    Bearings = "/bearings" at Period {
        /// The bearing of each wheel, in the order of the scenario.
        wheels: Vec<BearingMotion>,
    }
    /// A wheel in its bearing.
    BearingMotion {
        /// Whether the wheel turns, and which way.
        sliding: Sliding,
        /// Friction torque (N m), which is subtracted from the torque of the motor.
        friction_nm: f64,
        /// Friction heat since the start (J).
        heat_j: f64,
        /// Speed that the drive uses (rad/s): from a tachometer, if there is one.
        known_rad_s: f64,
    }
    /// A wheel passes through zero speed, sticks, or slips again.
    WheelEvent = "/wheel_events" {
        /// Time since the start, rounded to a double (s).
        time_s: f64,
        /// Whole seconds of the exact time.
        time_whole_s: u64,
        /// Femtoseconds of the exact time past the whole second.
        time_fs: u64,
        /// Index of the wheel, from 0.
        wheel: u64,
        /// State before.
        before: Sliding,
        /// State from now on.
        after: Sliding,
        /// Torque of its motor (N m).
        torque_nm: f64,
    }
    /// A bright body begins or ceases to blind a star tracker.
    BlindingEvent = "/blinding" {
        /// Time since the start, rounded to a double (s).
        time_s: f64,
        /// Whole seconds of the exact time.
        time_whole_s: u64,
        /// Femtoseconds of the exact time past the whole second.
        time_fs: u64,
        /// Index of the star tracker among the sensors of the scenario, from 0.
        sensor: u64,
        /// The body: `sun`, `moon` or `limb`.
        body: String,
        /// Start or end of the blinding.
        onset: Onset,
    }
    /// Attitude of a spatial body.
    Pointing = "/pointing" at Period {
        /// Real part of the quaternion that turns vectors of the body into inertial ones.
        q_w: f64,
        /// The x component of the quaternion.
        q_x: f64,
        /// The y component of the quaternion.
        q_y: f64,
        /// The z component of the quaternion.
        q_z: f64,
        /// Roll, the third of the successive rotations about z, y and x to the attitude (rad).
        roll_rad: f64,
        /// Pitch, the second rotation (rad).
        pitch_rad: f64,
        /// Yaw, the first rotation (rad).
        yaw_rad: f64,
        /// Pointing error about the body's x axis: this component of the rotation vector from the target (rad).
        roll_error_rad: f64,
        /// Pointing error about the body's y axis: this component of the rotation vector from the target (rad).
        pitch_error_rad: f64,
        /// Pointing error about the body's z axis: this component of the rotation vector from the target (rad).
        yaw_error_rad: f64,
    }
    /// One mass-normalised elastic mode.
    Vibration {
        /// Displacement (m sqrt(kg)).
        displacement: f64,
        /// Rate (m sqrt(kg)/s).
        rate: f64,
        /// Kinetic and potential energy (J).
        energy_j: f64,
    }
    /// The elastic modes of a spatial body, in the order of the scenario.
    Vibrations = "/vibrations" at Period {
        /// Each mode.
        modes: Vec<Vibration>,
    }
    /// Energies of a spatial body.
    Energy = "/energy" at Period {
        /// Rotational energy (J).
        rotational_j: f64,
        /// Elastic energy of all modes, kinetic and potential (J).
        elastic_j: f64,
        /// Elastic energy of the modes visible to the gyro: those that rotate it at least a tenth as much as the most visible one (J).
        visible_j: f64,
        /// Absolute value of the angular momentum (N m s).
        momentum_nm_s: f64,
    }
    /// Displacement of the first point of a spacecraft at which jets or forces act, from its start, in inertial axes.
    Position = "/position" at Period {
        /// Along x (m).
        x_m: f64,
        /// Along y (m).
        y_m: f64,
        /// Along z (m).
        z_m: f64,
        /// Velocity along x (m/s).
        x_m_s: f64,
        /// Velocity along y (m/s).
        y_m_s: f64,
        /// Velocity along z (m/s).
        z_m_s: f64,
    }
    /// A cycle in which jets fire: on-times from the start of the cycle, with the sign of the torque.
    Jets = "/jets" {
        /// About x (s).
        roll_on_s: f64,
        /// About y (s).
        pitch_on_s: f64,
        /// About z (s).
        yaw_on_s: f64,
        /// Propellant used from the start of the run to the end of these pulses (kg).
        fuel_kg: f64,
    }
    /// The pulse of a thruster.
    ThrusterPulse {
        /// On-time (s); 0 for no pulse.
        on_s: f64,
    }
    /// A cycle in which individually commanded jets fire (`least_propellant`): `/jets` then holds, about each axis, the time in
    /// which the largest torque gives the same impulse.
    Thrusters = "/thrusters" {
        /// The pulse of each thruster, from the start of the cycle on, in the order of the scenario.
        thrusters: Vec<ThrusterPulse>,
    }
    /// The estimate of an adaptive observer about one axis, and the active damping based on it.
    ChannelState {
        /// Estimated elastic rate, sum of all tracked modes (rad/s).
        elastic_rad_s: f64,
        /// True elastic rate, sum of all modes (rad/s).
        true_elastic_rad_s: f64,
        /// Moving root mean square of the innovation, the measured rate minus the predicted one (rad/s).
        innovation_rms_rad_s: f64,
        /// Moving root mean square of the estimated elastic rate (rad/s).
        elastic_rms_rad_s: f64,
        /// Whether the innovations are small enough for active damping to use the estimate.
        trusted: Trust,
        /// Predicted elastic rate that active damping acts on, from the modes that it may damp (rad/s).
        acted_on_rad_s: f64,
        /// Threshold of active damping (rad/s).
        threshold_rad_s: f64,
        /// Whether that rate exceeded the threshold and has not yet fallen below the release level.
        latched: Latch,
        /// Whether the watchdog pauses active damping.
        resting: Watch,
        /// Signed length of the pulse that active damping commands in this cycle (s).
        damping_on_s: f64,
    }
    /// A mode that an adaptive observer tracks, with the true values.
    TrackedMode {
        /// The axis: 0, 1 or 2.
        axis: u64,
        /// Natural frequency (rad/s).
        frequency_rad_s: f64,
        /// True value (rad/s).
        true_frequency_rad_s: f64,
        /// Influence of the axis' own jets.
        influence: f64,
        /// True value.
        true_influence: f64,
        /// Elastic rate at the gyro (rad/s).
        rate_rad_s: f64,
        /// True value (rad/s).
        true_rate_rad_s: f64,
        /// Amplitude of the estimated elastic rate (rad/s).
        amplitude_rad_s: f64,
    }
    /// Estimates of the adaptive observers of a spatial body.
    Tracking = "/tracking" at Sample {
        /// About x, y and z.
        channels: Vec<ChannelState>,
        /// The tracked modes, by axis and then by frequency.
        trackers: Vec<TrackedMode>,
    }
}
