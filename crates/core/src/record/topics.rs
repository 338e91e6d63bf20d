//! The topics of a log: what each row holds, with its units.

use super::foxglove::{self, Level, Plumes};
use super::row::{Topic, TopicRow, label_cells, rows};
use super::states::{Gate, Latch, Light, Lock, Phase, Trust, Use, Watch};
use crate::adaptation::Decision;
use crate::label::{Labels, labels};
use crate::motion::turning::Slip;
use crate::time::Instant;

labels! {
    /// Why the law was asked.
    Trigger {
        /// A guard of the measured angle tripped.
        Guard = "guard",
        /// The time of the hold had come.
        Timeout = "timeout",
    }
}

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

label_cells!(Trigger, Decision, Sliding);

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

    /// A switching: the law changed its state, and from this instant on commands this torque.
    Command = "/command" {
        /// Time since the start, rounded to a double (s).
        time_s: f64,
        /// Whole seconds of the exact time.
        time_whole_s: u64,
        /// Femtoseconds of the exact time past the whole second.
        time_fs: u64,
        /// State of the law that begins.
        state: Phase,
        /// What made the law decide.
        cause: Trigger,
        /// Torque that the law asks for from now on (N m; rad/s² on a body without inertia); of a wheel, its gain times the
        /// law's command.
        torque_nm: f64,
        /// Angle, elastic part included (rad).
        angle_rad: f64,
        /// Rate, elastic part included (rad/s).
        rate_rad_s: f64,
        /// The law's tunable parameter (k_t of the relay law).
        gain: f64,
    }
    /// What the law does: at the start, and once a second in a full log.
    Law = "/law" {
        /// State of the law.
        state: Phase,
        /// Torque that the law asks for (N m; rad/s² on a body without inertia); of a wheel, its gain times the law's command.
        torque_nm: f64,
        /// The law's tunable parameter (k_t of the relay law).
        gain: f64,
    }
    /// Angles.
    Attitude = "/attitude" {
        /// Angle, elastic part included (rad).
        angle_rad: f64,
        /// Angle of the body as if it were rigid (rad).
        rigid_rad: f64,
        /// Angle as the sensor gives it (rad).
        measured_rad: f64,
    }
    /// Rates.
    Rate = "/rate" {
        /// Rate, elastic part included (rad/s).
        rate_rad_s: f64,
        /// Rate of the body as if it were rigid (rad/s).
        rigid_rad_s: f64,
    }
    /// One elastic mode.
    ModeMotion {
        /// Displacement (rad).
        displacement_rad: f64,
        /// Rate (rad/s).
        rate_rad_s: f64,
    }
    /// The elastic modes, in the order of the scenario.
    Modes = "/modes" {
        /// Sum of all displacements (rad).
        elastic_rad: f64,
        /// Each mode.
        modes: Vec<ModeMotion>,
    }
    /// One observed coordinate.
    OutputMotion {
        /// Value, in the unit that `/params` names.
        value: f64,
        /// Its derivative with time.
        rate: f64,
    }
    /// The observed coordinates, in the order of `/params`.
    Outputs = "/outputs" {
        /// Each coordinate.
        outputs: Vec<OutputMotion>,
    }
    /// The torques on the body; all are rad/s² on a body without inertia, or where the hub's motion is commanded.
    Torque = "/torque" {
        /// What the manoeuvre commands (N m).
        feedforward_nm: f64,
        /// What the law asks for (N m); of a wheel, its gain times the law's command.
        feedback_nm: f64,
        /// What the actuator makes of both (N m).
        applied_nm: f64,
        /// Disturbances (N m).
        disturbance_nm: f64,
    }
    /// The flywheel.
    WheelMotion = "/wheel" {
        /// Speed (rad/s).
        speed_rad_s: f64,
        /// Momentum (N m s; rad/s on a body without inertia).
        momentum_nm_s: f64,
    }
    /// Where the body shall be: on the manoeuvre, where it would be if it were rigid.
    GoalMotion = "/goal" {
        /// Angle (rad).
        angle_rad: f64,
        /// Rate (rad/s).
        rate_rad_s: f64,
    }
    /// The vibration that is left of one observed coordinate.
    Residual {
        /// Sum of the modes' amplitudes, in this unit.
        amplitude: f64,
        /// Unit.
        unit: String,
    }
    /// How the manoeuvre ended, once at its end.
    Arrival = "/arrival" {
        /// Angle beyond the goal (rad).
        angle_error_rad: f64,
        /// Rate beyond the goal (rad/s).
        rate_error_rad_s: f64,
        /// Vibration that is left of the hub's angle: the sum of the modes' amplitudes (rad).
        angle_residual_rad: f64,
        /// Elastic energy that is left, of motion and deformation (J; J/(kg m²) on a body without inertia).
        elastic_energy_j: f64,
        /// Vibration that is left of each observed coordinate.
        outputs: Vec<Residual>,
    }
    /// The envelope of one elastic mode.
    ModeEnvelope {
        /// Envelope (rad).
        envelope_rad: f64,
    }
    /// The envelope of the elastic modes, as the observer gives it.
    Envelope = "/envelope" {
        /// Total envelope: the sum over the modes (rad).
        envelope_rad: f64,
        /// Each mode's.
        modes: Vec<ModeEnvelope>,
    }
    /// The mean envelope over the window that ended.
    WindowMean = "/envelope_mean" {
        /// Number of the window, from 0.
        window: u64,
        /// When the window began (s).
        from_s: f64,
        /// When it ended (s).
        to_s: f64,
        /// Mean of the total envelope over the window (rad).
        mean_rad: f64,
        /// The law's tunable parameter during the window (k_t of the relay law).
        gain: f64,
    }
    /// A step of the adaptation, taken at the end of a window.
    Adaptation = "/adaptation" {
        /// Number of the window that ended, from 0.
        window: u64,
        /// What was decided.
        decision: Decision,
        /// Relative change of the mean envelope since the window before.
        change: f64,
        /// Random part of the largest move, in [-1, 1].
        draw: f64,
        /// The gain from now on.
        gain: f64,
        /// Consecutive settled windows.
        settled: u64,
    }
    /// One elastic mode as a filter sees it.
    ModeEstimate {
        /// Displacement (rad).
        displacement_rad: f64,
        /// Rate (rad/s).
        rate_rad_s: f64,
        /// Natural frequency (rad/s).
        frequency_rad_s: f64,
        /// Amplitude, sqrt(x² + (x'/w)²) (rad).
        amplitude_rad: f64,
        /// Its standard deviation (rad).
        amplitude_sd_rad: f64,
    }
    /// What a Kalman filter makes of a sample.
    Estimate = "/estimator" {
        /// The dominant mode's index.
        dominant: u64,
        /// Its natural frequency as the law reads it (rad/s).
        frequency_rad_s: f64,
        /// Standard deviation of the estimated frequency (rad/s); 0 of a filter that takes it for known.
        frequency_sd_rad_s: f64,
        /// What that frequency really is (rad/s).
        true_frequency_rad_s: f64,
        /// The dominant mode's displacement as the law reads it (rad).
        displacement_rad: f64,
        /// Estimated frequency over the one at the start.
        ratio: f64,
        /// Its standard deviation.
        ratio_sd: f64,
        /// Its rate (1/s).
        ratio_rate_1_s: f64,
        /// Standard deviation of that rate (1/s).
        ratio_rate_sd_1_s: f64,
        /// Each mode.
        modes: Vec<ModeEstimate>,
        /// Measured angle less the predicted one (rad); 0 if the sample was dropped.
        innovation_rad: f64,
        /// Normalised innovation squared, summed over the measurements; 0 if the sample was dropped.
        nis: f64,
        /// What became of the sample.
        measured: Use,
        /// Normalised estimation error squared against the true state: of an honest filter about the number of states.
        nees: f64,
        /// Whether the dominant mode moves enough for its frequency to be learnt.
        gated: Gate,
        /// Whether the filter follows the body.
        lock: Lock,
    }
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
    /// One metric, or one element of it.
    Metric {
        /// Name, as `flexsc schema --metrics` explains it.
        name: String,
        /// Unit.
        unit: String,
        /// Position in a metric that is a list, else 0.
        index: u64,
        /// Value; NaN where there is none.
        value: f64,
        /// Value of a metric that is a word.
        text: String,
    }
    /// The metrics of the run, once at its end.
    Metrics = "/metrics" {
        /// Each metric.
        metrics: Vec<Metric>,
    }
    /// One metric in words.
    MetricLine {
        /// Name, as `flexsc schema --metrics` explains it.
        name: String,
        /// Value, or the values of a list.
        value: String,
        /// Unit.
        unit: String,
    }
    /// Some metrics.
    MetricPage {
        /// Each metric.
        metrics: Vec<MetricLine>,
    }
    /// The metrics of the run once more, for people: in pages, since tables of viewers show ten rows.
    Summary = "/summary" {
        /// Each page.
        pages: Vec<MetricPage>,
    }
    /// The name of an observed coordinate.
    OutputName {
        /// Name.
        name: String,
        /// Unit.
        unit: String,
    }
    /// What was simulated, once at the start.
    Params = "/params" {
        /// Name of the scenario.
        scenario: String,
        /// Seed of the scenario.
        seed: u64,
        /// Number of the run.
        run: u64,
        /// The scenario with all defaults, as TOML.
        toml: String,
        /// The observed coordinates, in the order of `/outputs`.
        outputs: Vec<OutputName>,
    }
}

const COUNT: usize = DECLARED.len() + foxglove::DECLARED.len() + 1;

/// All topics.
pub const TOPICS: &[Topic] = {
    const ALL: [Topic; COUNT] = {
        let mut all = [Plumes::TOPIC; COUNT];
        let mut index = 0;
        while index + 1 < COUNT {
            let other = index >= DECLARED.len();
            all[index] = if other { foxglove::DECLARED[index - DECLARED.len()] } else { DECLARED[index] };
            index += 1;
        }
        all
    };
    &ALL
};

/// The position of a topic in [`TOPICS`], found when the program is compiled.
pub const fn index_of(name: &str) -> usize {
    let mut index = 0;
    while !same(TOPICS[index].name.as_bytes(), name.as_bytes()) {
        index += 1;
    }
    index
}

const fn same(a: &[u8], b: &[u8]) -> bool {
    let mut i = 0;
    while i < a.len() && i < b.len() && a[i] == b[i] {
        i += 1;
    }
    i == a.len() && i == b.len()
}

impl Command {
    /// The three time fields of an instant.
    pub fn times(now: Instant) -> (f64, u64, u64) {
        let (whole, femtoseconds) = now.parts();
        (now.seconds(), whole, femtoseconds)
    }
}

/// The label of an enumeration's value, by its identifier in the schema of a log.
pub fn label_of(identifier: &str) -> String {
    let states = [
        &Lock::LABELS,
        &Gate::LABELS,
        &Use::LABELS,
        &Trust::LABELS,
        &Latch::LABELS,
        &Watch::LABELS,
        &Light::LABELS,
    ];
    let others = [&Phase::LABELS, &Trigger::LABELS, &Decision::LABELS, &Level::LABELS];
    let mut labels = others.iter().chain(&states).flat_map(|of| of.values);
    let label = labels.find(|label| Labels::identifier(label) == identifier);
    label.map_or_else(|| identifier.to_owned(), |&label| label.to_owned())
}
