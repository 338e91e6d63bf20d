//! Topics of bodies with three axes.

use crate::label::labels;
use crate::motion::turning::Slip;
use crate::record::row::{label_cells, rows};
use crate::record::states::{Latch, Light, Trust, Use, Watch};
use crate::record::topics::one_angle::{Estimate, Torque};

labels! {
    /// Whether a wheel turns in its bearing, and which way.
    Sliding {
        /// To negative speeds.
        Backward = "backward",
        /// It is at rest in the body.
        Stuck = "stuck",
        /// To positive speeds.
        Forward = "forward",
    }
}

label_cells!(Sliding);

impl From<Slip> for Sliding {
    fn from(slip: Slip) -> Self {
        match slip {
            Slip::Backward => Self::Backward,
            Slip::Stuck => Self::Stuck,
            Slip::Forward => Self::Forward,
        }
    }
}

rows! {
    package "flexsc.v1";

    /// The rates about one axis.
    AxisRate {
        /// Rate at the gyro, elastic part included (rad/s).
        rate_rad_s: f64,
        /// Rate of the body as if it were rigid (rad/s).
        rigid_rad_s: f64,
        /// Elastic part at the gyro (rad/s).
        elastic_rad_s: f64,
        /// What the gyro gave at the last cycle (rad/s).
        measured_rad_s: f64,
        /// Rigid rate that the law read at the last cycle (rad/s).
        believed_rad_s: f64,
    }
    /// The rates of a spatial body, in its own axes.
    Rates = "/rates" {
        /// About x, y and z.
        axes: Vec<AxisRate>,
    }
    /// The torques on a spatial body whose actuators are no jets, or that something is around.
    Torques = "/torques" {
        /// About x, y and z.
        axes: Vec<Torque>,
    }
    /// What Kalman filters make of a sample about each of three axes.
    Estimates = "/estimators" {
        /// About x, y and z: angles count from the target.
        axes: Vec<Estimate>,
    }
    /// What an attitude filter makes of a sample about one axis of the body.
    AxisEstimate {
        /// Estimated angle beyond the true one (rad).
        angle_error_rad: f64,
        /// Standard deviation of the angle (rad).
        angle_sd_rad: f64,
        /// Estimated bias of the gyro (rad/s).
        bias_rad_s: f64,
        /// What it exceeds the true one by (rad/s).
        bias_error_rad_s: f64,
        /// Standard deviation of the bias (rad/s).
        bias_sd_rad_s: f64,
        /// The measured angle beyond the predicted one, when it was taken (rad); 0 without a measurement.
        innovation_rad: f64,
    }
    /// What an attitude filter makes of a sample.
    AttitudeEstimate = "/attitude_filter" {
        /// Real part of the quaternion that is estimated to turn vectors of the body into inertial ones.
        q_w: f64,
        /// Its part along x.
        q_x: f64,
        /// Its part along y.
        q_y: f64,
        /// Its part along z.
        q_z: f64,
        /// About x, y and z.
        axes: Vec<AxisEstimate>,
        /// Normalised estimation error squared, over 6 numbers.
        nees: f64,
        /// Normalised innovation squared, over 3 numbers; 0 without a measurement.
        nis: f64,
        /// Whether an attitude was measured.
        measured: Use,
        /// How many numbers were measured: 2 of a direction, whose NIS is scaled as if there were 3.
        numbers: u64,
    }
    /// The wheels of a spatial body.
    Wheels = "/wheels" {
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
    /// What an accelerometer measures along one of its axes.
    Acceleration {
        /// As it is told (m/s²).
        measured_m_s2: f64,
        /// As it was when it was sampled (m/s²).
        true_m_s2: f64,
        /// The bias of the sample (m/s²).
        bias_m_s2: f64,
    }
    /// An accelerometer tells a sample.
    Accelerations = "/accelerations" {
        /// Its place among the sensors of the scenario, from 0.
        sensor: u64,
        /// Along each of its axes.
        axes: Vec<Acceleration>,
    }
    /// A magnetorquer.
    Magnetorquer {
        /// The magnetic moment that it holds (A m²).
        moment_am2: f64,
    }
    /// The magnetorquers of a spatial body.
    Magnetorquers = "/magnetorquers" {
        /// Along x, y and z.
        axes: Vec<Magnetorquer>,
    }
    /// Where a spatial body is on its orbit, and what there is of the sky, along one axis.
    OrbitAxis {
        /// Position from the planet's centre, in inertial axes (m).
        position_m: f64,
        /// Velocity, in inertial axes (m/s).
        velocity_m_s: f64,
        /// Direction to the planet's centre, in the body's axes.
        nadir: f64,
        /// Magnetic field, in the body's axes (T); NaN without one.
        field_t: f64,
        /// Direction to the Sun, in the body's axes, in the light or not; NaN without a Sun.
        sun: f64,
    }
    /// Where a spatial body is on its orbit, and what there is of the sky.
    Orbit = "/orbit" {
        /// Along x, y and z.
        axes: Vec<OrbitAxis>,
        /// Whether the Sun shines on the body.
        light: Light,
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
    /// The drives of a spacecraft's appendages, and the natural frequencies that change with their angles.
    DrivesMotion = "/drives" {
        /// Each drive, in the order of the appendages.
        drives: Vec<DriveMotion>,
        /// Each mode, in the order of the start.
        modes: Vec<DrivenMode>,
    }
    /// The bearings of the wheels of a spatial body, with friction, imbalance or a tachometer.
    Bearings = "/bearings" {
        /// That of each wheel, in the order of the scenario.
        wheels: Vec<BearingMotion>,
    }
    /// A wheel in its bearing.
    BearingMotion {
        /// Whether the wheel turns, and which way.
        sliding: Sliding,
        /// Friction (N m), which takes from the torque of the motor.
        friction_nm: f64,
        /// Heat of the friction since the start (J).
        heat_j: f64,
        /// Speed as the drive knows it (rad/s): by a tachometer, if there is one.
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
        /// The wheel, from 0.
        wheel: u64,
        /// How it was.
        before: Sliding,
        /// How it is from now on.
        after: Sliding,
        /// Torque of its motor (N m).
        torque_nm: f64,
    }
    /// The attitude of a spatial body.
    Pointing = "/pointing" {
        /// Real part of the quaternion that turns vectors of the body into inertial ones.
        q_w: f64,
        /// Its part along x.
        q_x: f64,
        /// Its part along y.
        q_y: f64,
        /// Its part along z.
        q_z: f64,
        /// Roll, the last of the rotations about z, y and x that make the attitude (rad).
        roll_rad: f64,
        /// Pitch, the second (rad).
        pitch_rad: f64,
        /// Yaw, the first (rad).
        yaw_rad: f64,
        /// Angle about the body's x beyond the target (rad).
        roll_error_rad: f64,
        /// Angle about the body's y beyond the target (rad).
        pitch_error_rad: f64,
        /// Angle about the body's z beyond the target (rad).
        yaw_error_rad: f64,
    }
    /// One mass-normalised elastic mode.
    Vibration {
        /// Displacement (m sqrt(kg)).
        displacement: f64,
        /// Rate (m sqrt(kg)/s).
        rate: f64,
        /// Energy of motion and deformation (J).
        energy_j: f64,
    }
    /// The elastic modes of a spatial body, in the order of the scenario.
    Vibrations = "/vibrations" {
        /// Each mode.
        modes: Vec<Vibration>,
    }
    /// The energies of a spatial body.
    Energy = "/energy" {
        /// Of the rotation (J).
        rotational_j: f64,
        /// Of the elastic modes, of motion and deformation (J).
        elastic_j: f64,
        /// The same of the modes that the gyro sees: those that turn it at least a tenth as much as the one that does most (J).
        visible_j: f64,
        /// Absolute value of the angular momentum (N m s).
        momentum_nm_s: f64,
    }
    /// Where the first point of a spacecraft is that jets or forces push, in inertial axes from where it was at the start.
    Position = "/position" {
        /// Along x (m).
        x_m: f64,
        /// Along y (m).
        y_m: f64,
        /// Along z (m).
        z_m: f64,
        /// Its velocity along x (m/s).
        x_m_s: f64,
        /// Its velocity along y (m/s).
        y_m_s: f64,
        /// Its velocity along z (m/s).
        z_m_s: f64,
    }
    /// A cycle in which jets fire: from its start on for these times, with the sign of the rate that they push to.
    Jets = "/jets" {
        /// About x (s).
        roll_on_s: f64,
        /// About y (s).
        pitch_on_s: f64,
        /// About z (s).
        yaw_on_s: f64,
        /// Propellant used until the end of these pulses, since the start of the run (kg).
        fuel_kg: f64,
    }
    /// The pulse of a thruster.
    ThrusterPulse {
        /// How long it lasts (s); 0 for none.
        on_s: f64,
    }
    /// A cycle in which jets fire that act by themselves, `least_propellant`: `/jets` then has, about each axis, the time in which the largest
    /// torque gives as much.
    Thrusters = "/thrusters" {
        /// The pulse of each thruster, from the start of the cycle on, in the order of the scenario.
        thrusters: Vec<ThrusterPulse>,
    }
    /// What an adaptive observer knows of the elastic motion about one axis, and what active damping does with it.
    ChannelState {
        /// Estimated elastic rate, all tracked modes together (rad/s).
        elastic_rad_s: f64,
        /// What it really is, all modes together (rad/s).
        true_elastic_rad_s: f64,
        /// Moving root mean square of the innovation, the measured rate less the predicted one (rad/s).
        innovation_rms_rad_s: f64,
        /// The same of the estimated elastic rate (rad/s).
        elastic_rms_rad_s: f64,
        /// Whether the innovations are small enough for the estimate to be acted on.
        trusted: Trust,
        /// Elastic rate that active damping acts on: predicted, of the modes that it may act on (rad/s).
        acted_on_rad_s: f64,
        /// Its threshold (rad/s).
        threshold_rad_s: f64,
        /// Whether that rate was beyond the threshold, and is not yet back.
        latched: Latch,
        /// Whether the watchdog keeps active damping quiet.
        resting: Watch,
        /// Signed length of the pulse that active damping commands in this cycle (s).
        damping_on_s: f64,
    }
    /// A mode that an adaptive observer tracks, with what is true of it.
    TrackedMode {
        /// The axis: 0, 1 or 2.
        axis: u64,
        /// Natural frequency (rad/s).
        frequency_rad_s: f64,
        /// What it really is (rad/s).
        true_frequency_rad_s: f64,
        /// Influence of the axis' own jets.
        influence: f64,
        /// What it really is.
        true_influence: f64,
        /// Elastic rate at the gyro (rad/s).
        rate_rad_s: f64,
        /// What it really is (rad/s).
        true_rate_rad_s: f64,
        /// Amplitude of the estimated elastic rate (rad/s).
        amplitude_rad_s: f64,
    }
    /// What the adaptive observers of a spatial body know.
    Tracking = "/tracking" {
        /// About x, y and z.
        channels: Vec<ChannelState>,
        /// The modes that they track, axis by axis and by frequency.
        trackers: Vec<TrackedMode>,
    }
}
