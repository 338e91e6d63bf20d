//! Topics of bodies with one angle, of laws and of what learns.

use crate::adaptation::Decision;
use crate::label::labels;
use crate::record::row::{label_cells, rows};
use crate::record::states::{Gate, Lock, Phase, Use};
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

label_cells!(Trigger, Decision);

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
}

impl Command {
    /// The three time fields of an instant.
    pub fn times(now: Instant) -> (f64, u64, u64) {
        let (whole, femtoseconds) = now.parts();
        (now.seconds(), whole, femtoseconds)
    }
}
