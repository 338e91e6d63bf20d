//! Topics of one-axis bodies, of laws and of adaptation.

use flexsc_numerics::time::Instant;

use crate::enum_label::labels;
use crate::row::{label_cells, rows};
use crate::states::{Gate, Lock, Phase, Use};

labels! {
    /// Why the law decides.
    Trigger {
        /// A guard of the measured angle tripped.
        Guard = "guard",
        /// The hold ended at its end time.
        Timeout = "timeout",
    }
}

labels! {
    /// Decision of the search at the end of a window.
    Decision {
        /// The first window: any direction.
        Begin = "begin",
        /// The mean fell: the direction is kept.
        Keep = "keep",
        /// The mean rose once after several falls: the direction is kept.
        Ignore = "ignore",
        /// The mean rose: the direction is reversed.
        Turn = "turn",
        /// The mean has settled: the gain stays fixed.
        Freeze = "freeze",
    }
}

label_cells!(Trigger, Decision);

rows! {
    package "flexsc.v1";

    /// A switching: the law changes its state and commands this torque from this instant on.
    Command = "/command" {
        /// Time since the start, rounded to a double (s).
        time_s: f64,
        /// Whole seconds of the exact time.
        time_whole_s: u64,
        /// Femtoseconds of the exact time past the whole second.
        time_fs: u64,
        /// New state of the law.
        state: Phase,
        /// Cause of the decision.
        cause: Trigger,
        /// Torque that the law commands from now on (N m; rad/s² on a body without inertia); for a wheel: its gain times the law's
        /// command.
        torque_nm: f64,
        /// Angle, elastic part included (rad).
        angle_rad: f64,
        /// Rate, elastic part included (rad/s).
        rate_rad_s: f64,
        /// The law's tunable parameter (k_t of the relay law).
        gain: f64,
    }
    /// State and command of the law: at the start, and once a second in a full log.
    Law = "/law" at Sample {
        /// State of the law.
        state: Phase,
        /// Torque that the law commands (N m; rad/s² on a body without inertia); for a wheel: its gain times the law's command.
        torque_nm: f64,
        /// The law's tunable parameter (k_t of the relay law).
        gain: f64,
    }
    /// Angles.
    Attitude = "/attitude" at Period {
        /// Angle, elastic part included (rad).
        angle_rad: f64,
        /// Rigid angle (rad).
        rigid_rad: f64,
        /// Measured angle (rad).
        measured_rad: f64,
    }
    /// Rates.
    Rate = "/rate" at Period {
        /// Rate, elastic part included (rad/s).
        rate_rad_s: f64,
        /// Rigid rate (rad/s).
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
    Modes = "/modes" at Period {
        /// Sum of all displacements (rad).
        elastic_rad: f64,
        /// Each mode.
        modes: Vec<ModeMotion>,
    }
    /// One observed coordinate.
    OutputMotion {
        /// Value, in the unit given in `/params`.
        value: f64,
        /// Time derivative of the value.
        rate: f64,
    }
    /// The observed coordinates, in the order of `/params`.
    Outputs = "/outputs" at Period {
        /// Each coordinate.
        outputs: Vec<OutputMotion>,
    }
    /// The torques on the body; all are rad/s² on a body without inertia, or where the hub's motion is commanded.
    Torque = "/torque" at Period {
        /// Torque commanded by the manoeuvre (N m).
        feedforward_nm: f64,
        /// Torque commanded by the law (N m); for a wheel: its gain times the law's command.
        feedback_nm: f64,
        /// Torque applied by the actuator (N m).
        applied_nm: f64,
        /// Disturbance torque (N m).
        disturbance_nm: f64,
    }
    /// The flywheel.
    WheelMotion = "/wheel" at Period {
        /// Speed (rad/s).
        speed_rad_s: f64,
        /// Momentum (N m s; rad/s on a body without inertia).
        momentum_nm_s: f64,
    }
    /// The goal: during a manoeuvre, the motion that a rigid body would have.
    GoalMotion = "/goal" at Period {
        /// Angle (rad).
        angle_rad: f64,
        /// Rate (rad/s).
        rate_rad_s: f64,
    }
    /// Residual vibration of one observed coordinate.
    Residual {
        /// Sum of the modal amplitudes, in this unit.
        amplitude: f64,
        /// Unit.
        unit: String,
    }
    /// Errors and residual vibration at the end of the manoeuvre, logged once.
    Arrival = "/arrival" {
        /// Angle minus the goal (rad).
        angle_error_rad: f64,
        /// Rate minus the goal (rad/s).
        rate_error_rad_s: f64,
        /// Residual vibration of the hub's angle: sum of the modal amplitudes (rad).
        angle_residual_rad: f64,
        /// Residual elastic energy, kinetic and potential (J; J/(kg m²) on a body without inertia).
        elastic_energy_j: f64,
        /// Residual vibration of each observed coordinate.
        outputs: Vec<Residual>,
    }
    /// The envelope of one elastic mode.
    ModeEnvelope {
        /// Envelope (rad).
        envelope_rad: f64,
    }
    /// Envelope of the elastic modes, as estimated by the monitor.
    Envelope = "/envelope" at Period {
        /// Total envelope: the sum over the modes (rad).
        envelope_rad: f64,
        /// The envelope of each mode.
        modes: Vec<ModeEnvelope>,
    }
    /// Mean envelope over the last window.
    WindowMean = "/envelope_mean" {
        /// Number of the window, from 0.
        window: u64,
        /// Start of the window (s).
        from_s: f64,
        /// End of the window (s).
        to_s: f64,
        /// Mean of the total envelope over the window (rad).
        mean_rad: f64,
        /// The law's tunable parameter during the window (k_t of the relay law).
        gain: f64,
    }
    /// The objective of the adaptation over the last window, unless that is the mean envelope.
    Objective = "/objective" {
        /// Number of the window, from 0.
        window: u64,
        /// Start of the window (s).
        from_s: f64,
        /// End of the window (s).
        to_s: f64,
        /// Value over the window, in the unit of the objective.
        value: f64,
        /// Tuned parameter during the window.
        gain: f64,
    }
    /// A step of the adaptation, taken at the end of a window.
    Adaptation = "/adaptation" {
        /// Number of the window that ended, from 0.
        window: u64,
        /// Decision.
        decision: Decision,
        /// Change of the objective relative to the previous window.
        change: f64,
        /// Random part of the largest move, in [-1, 1].
        draw: f64,
        /// Gain from now on.
        gain: f64,
        /// Number of consecutive settled windows.
        settled: u64,
    }
    /// One elastic mode as estimated by a filter.
    ModeEstimate {
        /// Displacement (rad).
        displacement_rad: f64,
        /// Rate (rad/s).
        rate_rad_s: f64,
        /// Natural frequency (rad/s).
        frequency_rad_s: f64,
        /// Amplitude, sqrt(x² + (x'/w)²) (rad).
        amplitude_rad: f64,
        /// Standard deviation of the amplitude (rad).
        amplitude_sd_rad: f64,
    }
    /// A Kalman filter, after a sample.
    Estimate = "/estimator" at Sample {
        /// Index of the dominant mode.
        dominant: u64,
        /// Natural frequency of the dominant mode as read by the law (rad/s).
        frequency_rad_s: f64,
        /// Standard deviation of the estimated frequency (rad/s); 0 for a filter with known frequencies.
        frequency_sd_rad_s: f64,
        /// True value of that frequency (rad/s).
        true_frequency_rad_s: f64,
        /// Displacement of the dominant mode as read by the law (rad).
        displacement_rad: f64,
        /// Estimated frequency divided by its initial value.
        ratio: f64,
        /// Standard deviation of the ratio.
        ratio_sd: f64,
        /// Rate of the ratio (1/s).
        ratio_rate_1_s: f64,
        /// Standard deviation of that rate (1/s).
        ratio_rate_sd_1_s: f64,
        /// Each mode.
        modes: Vec<ModeEstimate>,
        /// Measured angle minus the predicted one (rad); 0 if the sample was dropped.
        innovation_rad: f64,
        /// Normalised innovation squared, over the number of measurements: about 1 for a consistent filter; 0 if the sample was dropped.
        nis: f64,
        /// Use of the sample.
        measured: Use,
        /// Normalised estimation error squared, from the true state, over the number of states: about 1 for a consistent filter.
        nees: f64,
        /// Whether the amplitude of the dominant mode is large enough to update its frequency.
        gated: Gate,
        /// Whether the filter has lock.
        lock: Lock,
    }
}

impl Command {
    /// Returns the three time fields of an instant.
    pub fn times(now: Instant) -> (f64, u64, u64) {
        let (whole, femtoseconds) = now.parts();
        (now.seconds(), whole, femtoseconds)
    }
}
