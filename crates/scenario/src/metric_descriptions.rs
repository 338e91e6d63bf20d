//! Metrics: names, units and meanings, in the order in which they are reported.

use flexsc_record::metrics::MetricDescription;
use flexsc_spacecraft::body::BodyModel;

/// Declares the metrics: a constant for each, and the list of all.
macro_rules! metrics {
    ($($constant:ident = $name:literal, $unit:literal, $doc:literal;)+) => {
        $(#[doc = concat!("Description of the metric `", $name, "`.")]
        pub const $constant: MetricDescription = MetricDescription { name: $name, unit: $unit, doc: $doc };)+

        /// All metrics, in the order in which they are reported.
        pub const ALL: &[MetricDescription] = &[$($constant),+];
    };
}

metrics! {
    SWITCHINGS = "switchings", "", "Number of switchings of the law";
    PUSHES_RIGHT = "pushes_right", "", "Number of strong pushes back from the right boundary of the dead zone";
    PUSHES_LEFT = "pushes_left", "", "Number of strong pushes back from the left boundary of the dead zone";
    DUTY = "duty", "", "Fraction of the run under strong torque";
    IMPULSE = "torque_impulse_per_hour_nm_s", "N m s",
        "Integral of the absolute torque per hour of the run; in rad/s on a body without inertia";
    WINDOW_MEANS = "envelope_window_means_rad", "rad",
        "Mean of the total envelope over each whole window of the observer";
    ENVELOPE_MEAN = "envelope_mean_rad", "rad", "Mean of the total envelope over all whole windows";
    ENVELOPE_LATE = "envelope_late_mean_rad", "rad",
        "Mean of the total envelope over the windows that begin in the second half of the run; null if there is none";
    ENVELOPE_FINAL = "envelope_final_rad", "rad", "Mean of the total envelope over the last whole window";
    REDUCTION = "envelope_reduction", "",
        "Ratio of reference.envelope, or of the mean of the first window, to envelope_final_rad";
    GAIN_INITIAL = "gain_initial", "", "Tunable gain of the law at the start (k_t of the relay law)";
    GAIN_FINAL = "gain_final", "", "Tunable gain of the law at the end";
    GAIN_FROZEN_AT = "gain_frozen_at_s", "s", "Time at which the adaptation froze the gain; null if it did not";
    GAIN_FROZEN = "gain_frozen", "", "The frozen gain; null if the adaptation did not freeze it";
    ENVELOPE_FROZEN = "envelope_frozen_rad", "rad",
        "Mean of the total envelope over the whole windows after the freeze (the last one, if it came at the end); null without a freeze";
    FROZEN_REDUCTION = "envelope_frozen_reduction", "",
        "Ratio of the reference of envelope_reduction to envelope_frozen_rad; null without a freeze";
    OBJECTIVE_WINDOWS = "objective_windows", "", "Objective of the adaptation over each window, in the unit of the objective";
    OBJECTIVE_INITIAL = "objective_initial", "", "Objective of the adaptation over the first window, in the unit of the objective";
    OBJECTIVE_LATE = "objective_late_mean", "",
        "Mean of the objective over the windows that begin in the second half of the run, in the unit of the objective";
    OBJECTIVE_FINAL = "objective_final", "", "Objective of the adaptation over the last whole window, in the unit of the objective";
    CYCLE_KIND = "cycle_kind", "",
        "The limit cycle at the end of the run: two-sided, one-sided, mixed, or none if the run is not periodic";
    CYCLE_PERIOD = "cycle_period_s", "s", "Period of the limit cycle; null without one";
    CYCLE_ORDER = "cycle_order", "", "Number of pushes from one boundary in each period; null without a cycle";
    CYCLE_SYMMETRIC = "cycle_symmetric", "",
        "1 if the cycle's second half mirrors its first, else 0; null without a cycle";
    CYCLE_DUTY = "cycle_duty", "", "Fraction of the cycle under strong torque; null without a cycle";
    CYCLE_IMPULSE = "cycle_impulse_per_hour_nm_s", "N m s",
        "Integral of the absolute torque per hour of the limit cycle; in rad/s on a body without inertia; null without one";
    CYCLE_MULTIPLIERS = "cycle_multipliers", "",
        "Absolute values of the cycle's Floquet multipliers, largest first; empty without a cycle, and where modes are coupled";
    CYCLE_MULTIPLIER_ARGUMENTS = "cycle_multiplier_arguments_rad", "rad",
        "Arguments of the cycle's Floquet multipliers, in the order of cycle_multipliers";
    CYCLE_MULTIPLIER_MAX = "cycle_multiplier_max", "",
        "Largest absolute value among the multipliers: below 1 the cycle is stable; null without a cycle";
    MODE_TIMES = "mode_times_s", "s", "Time in each mode of operation, in the order of the scenario";
    MODE_STARTS = "mode_starts_s", "s",
        "First time at which each mode of operation begins, in the order of the scenario; null for a mode that never does";
    MODE_VISITS = "mode_visits", "", "Number of times that each mode of operation begins, in the order of the scenario";
    MODE_CHANGES = "mode_changes", "", "Number of changes of the mode of operation";
    ARRIVAL_ANGLE = "arrival_angle_error_rad", "rad", "Error of the hub angle at the end of the manoeuvre";
    ARRIVAL_RATE = "arrival_rate_error_rad_s", "rad/s", "Error of the hub rate at the end of the manoeuvre";
    ANGLE_RESIDUAL = "angle_residual_rad", "rad",
        "Residual vibration of the hub angle: the sum of the modal amplitudes at the end of the manoeuvre";
    OUTPUT_RESIDUALS = "output_residuals", "",
        "Residual vibration of each observed coordinate, in its own unit: the sum of the modal amplitudes at the end of the manoeuvre";
    RESIDUAL_ENERGY = "residual_energy_j", "J",
        "Residual elastic energy, kinetic and potential, after the manoeuvre; per kg m² for a body without inertia";
    PEAK_TORQUE = "peak_torque_nm", "N m",
        "Largest torque of the actuator, to rounding; in rad/s² on a body without inertia, or where the hub's motion is commanded";
    PEAK_FEEDBACK = "peak_feedback_torque_nm", "N m", "Largest torque commanded by the law (for a wheel: its gain times the command); in rad/s² where peak_torque_nm is";
    PEAK_OUTPUTS = "output_peaks", "",
        "Largest absolute value of each observed coordinate, in its own unit, to rounding";
    ANGLE_ERROR_PEAK = "angle_error_peak_rad", "rad",
        "Largest distance of the hub's angle from the goal after the manoeuvre, to rounding; null if the run ends before";
    SETTLING_TIME = "settling_time_s", "s",
        "Last time at which the hub angle is further from the goal than reference.band, or the band specified by the law or the manoeuvre, to rounding; the start of the goal if it never is; null if it still is at the end of the run, or without a band";
    SPECTRAL_RADIUS = "spectral_radius", "",
        "Spectral radius of the sampled loop at constant frequencies, with the dominant mode known and the command fully executed; with a drift, the largest over its frequencies; below 1 the loop is stable; null without a sampled PD loop";
    ITAE = "itae", "rad s²", "Integral of time times the distance from the goal, since the start of the goal, to rounding";
    ANGLE_ERROR_LATE = "angle_error_late_rad", "rad",
        "Largest distance of the hub's angle from the goal over the last 5 s of the run, to rounding";
    OUTPUT_SWINGS = "output_swings", "",
        "Half the peak-to-peak value of each observed coordinate after the manoeuvre";
    OUTPUT_SWINGS_LATE = "output_swings_late", "",
        "Half the peak-to-peak value of each observed coordinate over the last 5 s of the run";
    GOAL = "goal", "",
        "Whether the run meets its goal: met if the angle stays within goal_band_rad of it for at least the last tenth of the time since the goal began, else missed; none without a goal or a band, and in a scenario with a [[requirement]] and without reference.band";
    GOAL_BAND = "goal_band_rad", "rad",
        "Half width of the band about the goal: reference.band, or the one specified by the law or the manoeuvre; null without a goal";
    TIME_OUTSIDE = "time_outside_s", "s", "Time outside goal_band_rad since the start of the goal; null without a goal";
    RATE_END = "rate_end_rad_s", "rad/s",
        "Rigid rate of a body with magnetorquers at the end of the run";
    MOMENTUM_PEAK = "wheel_momentum_peak_nm_s", "N m s", "Largest total momentum of the wheels, at the control cycles";
    MOMENTUM_END = "wheel_momentum_end_nm_s", "N m s", "Total momentum of the wheels at the last cycle";
    WHEEL_SPEED = "wheel_speed_peak_rad_s", "rad/s",
        "Largest speed of any wheel relative to the body, at the control cycles";
    WHEEL_MOMENTUM = "one_wheel_momentum_peak_nm_s", "N m s", "Largest momentum of any single wheel, at the control cycles";
    TORQUE_SHARE = "wheel_torque_limit_share", "",
        "Fraction of the control cycles that begin with the motor of any wheel at its torque limit";
    MOMENTUM_SHARE = "wheel_momentum_limit_share", "",
        "Fraction of the control cycles that begin with any wheel at its limit of momentum or speed";
    MOMENT_SHARE = "moment_limit_share", "",
        "Fraction of the control cycles that begin with any magnetorquer at its largest magnetic moment";
    ACTUATOR_END = "actuator_end", "",
        "Wheels and magnetorquers in the last tenth of the run: cycling if a wheel alternates between its torque limits at least four times, is at each in over 2.5 % of the cycles, and in the second half over half as often as in the first; saturated if one is at the same limit in over half of the cycles; else free";
    LATE_SHARE = "actuator_limit_late_share", "",
        "Fraction of the control cycles in the last tenth of the run with any wheel or magnetorquer at a limit; null if no cycle begins there";
    TORQUE_LIMIT_STARTS = "wheel_torque_limit_starts_s", "s",
        "First control cycle that begins with the motor of any wheel at its torque limit, in each mode of operation in the order of the scenario, or once without modes; null without such a cycle";
    TORQUE_LIMIT_TIMES = "wheel_torque_limit_times_s", "s",
        "Time with the motor of any wheel at its torque limit, in each mode of operation in the order of the scenario, or once without modes";
    MOMENTUM_LIMIT_STARTS = "wheel_momentum_limit_starts_s", "s",
        "First control cycle that begins with any wheel at its limit of momentum or speed, in each mode of operation in the order of the scenario, or once without modes; null without such a cycle";
    MOMENTUM_LIMIT_TIMES = "wheel_momentum_limit_times_s", "s",
        "Time with any wheel at its limit of momentum or speed, in each mode of operation in the order of the scenario, or once without modes";
    MOMENT_LIMIT_STARTS = "moment_limit_starts_s", "s",
        "First control cycle that begins with any magnetorquer at its largest magnetic moment, in each mode of operation in the order of the scenario, or once without modes; null without such a cycle";
    MOMENT_LIMIT_TIMES = "moment_limit_times_s", "s",
        "Time with any magnetorquer at its largest magnetic moment, in each mode of operation in the order of the scenario, or once without modes";
    JET_LIMIT_STARTS = "jet_limit_starts_s", "s",
        "First control cycle that begins with jets that are on for their whole period, in each mode of operation in the order of the scenario, or once without modes; null without such a cycle";
    JET_LIMIT_TIMES = "jet_limit_times_s", "s",
        "Time with jets that are on for their whole period, in each mode of operation in the order of the scenario, or once without modes";
    GIMBAL_LIMIT_STARTS = "gimbal_rate_limit_starts_s", "s",
        "First control cycle that begins with any gimbal of the control moment gyros at its rate limit, in each mode of operation in the order of the scenario, or once without modes; null without such a cycle";
    GIMBAL_LIMIT_TIMES = "gimbal_rate_limit_times_s", "s",
        "Time with any gimbal of the control moment gyros at its rate limit, in each mode of operation in the order of the scenario, or once without modes";
    TARGET_LOSSES = "target_losses", "",
        "Number of stays in a mode of operation, or at a target, in which an actuator is at a limit and the error grows meanwhile beyond three times the largest one shortly before; those in acquisition do not count";
    LOSS_MODES = "target_loss_modes", "",
        "Mode of operation of each such loss of the target, as its index in the scenario, in the order of time, at most 100; 0 without modes";
    LOSS_LIMITS = "target_loss_limits", "", "Actuator and limit of each loss: those that were reached for the longest time";
    LOSS_STARTS = "target_loss_starts_s", "s", "First time at this limit, of each loss";
    LOSS_TIMES = "target_loss_times_s", "s", "Time at this limit, of each loss";
    LOSS_BEFORE = "target_loss_errors_before_rad", "rad",
        "Largest pointing error (norm over three axes) shortly before each loss";
    LOSS_ERRORS = "target_loss_errors_rad", "rad", "Largest pointing error (norm over three axes) of each loss";
    GIMBAL_RATE = "gimbal_rate_peak_rad_s", "rad/s", "Largest rate of a gimbal of the control moment gyros";
    SINGULARITY = "singularity_min", "",
        "Smallest singularity measure of the control moment gyros at their commands: 0 where they give no torque in some direction";
    TORQUE_ERROR = "torque_error_peak_nm", "N m",
        "Largest difference between the demanded torque and that of the control moment gyros, at their commands";
    GYRO_MOMENTUM_PEAK = "gyro_momentum_peak_nm_s", "N m s", "Largest total momentum of the control moment gyros";
    GYRO_MOMENTUM_END = "gyro_momentum_end_nm_s", "N m s",
        "Total momentum of the control moment gyros at the end of the run";
    NEES_MEAN = "nees_mean", "",
        "Mean over the assessed samples of the filter's normalised estimation error squared, divided by the number of states: 1 if the covariance is consistent";
    NIS_MEAN = "nis_mean", "",
        "Mean over the assessed samples of the filter's normalised innovation squared, divided by the number of measurements in a sample: 1 if consistent";
    NIS_INSIDE = "nis_inside_95", "",
        "Fraction of the assessed samples whose NIS lies within the two-sided 95 % bounds of chi-square";
    FREQUENCY_ERROR_RMS = "frequency_error_rms_rad_s", "rad/s",
        "Root mean square error of the dominant mode's frequency used by the law, over the assessed samples";
    FREQUENCY_ERROR_MAX = "frequency_error_max_rad_s", "rad/s", "Largest error of the dominant mode's frequency used by the law, over the assessed samples";
    ATTITUDE_ERROR = "attitude_estimate_error_rms_rad", "rad",
        "Root mean square attitude error of the filter (norm over three axes), over the assessed samples";
    BIAS_ERROR = "bias_estimate_error_rms_rad_s", "rad/s",
        "Root mean square error of the estimated gyro bias (norm over three axes), over the assessed samples";
    LOCK_LOST = "lock_lost", "", "1 if the filter has lost lock at the end of the run, else 0";
    LOCK_LOST_AT = "lock_lost_at_s", "s", "Time at which the filter lost lock for good; null if it has lock at the end of the run";
    FUEL = "fuel_kg", "kg", "Propellant used by the jets";
    FUEL_AXES = "fuel_axes_kg", "kg",
        "Propellant used by the jets about x, y and z, if groups fire them and none can fail";
    FUEL_THRUSTERS = "fuel_thrusters_kg", "kg",
        "Propellant used by each thruster, in the order of the scenario, if each is commanded individually or can fail";
    BURN_IMPULSE = "burn_impulse_n_s", "N s", "Impulse of the jets in the cycles of burns, along the commanded force";
    FIRINGS = "firings", "", "Number of jet pulses on all axes";
    FIRING_CYCLES = "firing_cycles", "", "Number of control cycles in which any jet fires";
    ZERO_CROSSINGS = "wheel_zero_crossings", "", "Number of zero crossings of the speed of wheels with friction, including reversals after sticking";
    WHEEL_STOPS = "wheel_stops", "", "Number of times a wheel stuck in its bearings";
    FRICTION_HEAT = "friction_heat_j", "J", "Friction heat of all wheels up to the last cycle";
    ELASTIC_PEAK = "elastic_energy_peak_j", "J",
        "Largest elastic energy, kinetic and potential, at the starts of the control cycles";
    ELASTIC_END = "elastic_energy_end_j", "J", "Elastic energy, kinetic and potential, at the last cycle";
    VISIBLE_PEAK = "visible_energy_peak_j", "J",
        "Largest elastic energy of the modes visible to the gyro: those that rotate it at least a tenth as much as the most visible one";
    VISIBLE_END = "visible_energy_end_j", "J", "Elastic energy of the modes visible to the gyro, at the last cycle";
    BELOW_10 = "energy_below_10pct_at_s", "s",
        "First cycle at which the elastic energy is below a tenth of that at the start; null if there is none";
    BELOW_1 = "energy_below_1pct_at_s", "s",
        "First cycle at which the elastic energy is below a hundredth of that at the start; null if there is none";
    ELASTIC_RATE = "elastic_rate_rms_rad_s", "rad/s",
        "Root mean square elastic rate at the gyro (norm over three axes), over the cycles of the last 200 s";
    POINTING_END = "pointing_error_end_rad", "rad",
        "Pointing error (norm over three axes) at the last cycle";
    SLEW_PEAK = "slew_error_peak_rad", "rad",
        "Largest pointing error (norm over three axes) at the control cycles of slews: while a target moves from one attitude to another; null without such cycles";
    SLEW_RMS = "slew_error_rms_rad", "rad",
        "Root mean square pointing error (norm over three axes) over the control cycles of slews; null without such cycles";
    POINTING_RMS = "pointing_rms_rad", "rad",
        "Root mean square pointing error over the control cycles in reference.pointing.window";
    REQUIREMENT = "requirement", "",
        "Whether the run meets every requirement, the [[requirement]] tables and reference.pointing.rms: met or missed; one without a value is missed";
    REQUIREMENT_VALUES = "requirement_values", "",
        "Value of each requirement, in its own unit: reference.pointing.rms first, then the [[requirement]] tables; null without values";
    REQUIREMENT_SHARES = "requirement_shares", "",
        "Fraction of the values of each requirement within its limit, in the order of requirement_values; null without values, and 1 for a requirement without a value that nothing in the run was to meet";
    REQUIREMENT_TIMES = "requirement_times_s", "s",
        "Time of the value that decides on each requirement over time, in the order of requirement_values; null for others";
    ACCELERATION = "acceleration_rms_m_s2", "m/s²",
        "Root mean square reading of each accelerometer (norm over its axes)";
    TRACKER_BLINDED = "tracker_blinded_s", "s",
        "Time for which Sun, Moon or limb blind each star tracker with an exclusion, to rounding";
    SIGHT_RMS = "line_of_sight_rms_rad", "rad",
        "Root mean square angle between each line of sight and its target direction, over the samples in its window; null without samples";
    SIGHT_PEAK = "line_of_sight_peak_rad", "rad",
        "Largest angle between each line of sight and its target direction, over the samples in its window; null without samples";
    SIGHT_JITTER = "line_of_sight_jitter_rms_rad", "rad",
        "Root mean square deviation of each line of sight from its mean over each jitter_window, over the whole windows; null without one";
    POINT_DISPLACEMENT = "point_displacement_peak_m", "m",
        "Largest displacement of the point of each line of sight by vibration, relative to the hub, over the samples in its window; null without samples";
    MIRROR_PEAK = "fine_mirror_peak_rad", "rad",
        "Largest rotation of each line of sight by its fine mirror, over the samples in its window; null without a mirror";
    MIRROR_LIMITED = "fine_mirror_limited_s", "s",
        "Time for which stroke or rate limit the command of the fine mirror of each line of sight, between the first and the last sample in its window; null without a mirror";
    FREQUENCY_ESTIMATES = "frequency_estimates_hz", "Hz",
        "Estimated natural frequency of each mode, at the last cycle: those tracked by an adaptive observer, ordered by axis, then by frequency, or those that an attitude filter identifies";
    FREQUENCY_ERRORS = "frequency_estimate_errors", "",
        "Relative errors of frequency_estimates_hz";
    INFLUENCE_ESTIMATES = "influence_estimates", "",
        "Estimated influence of the axis' own jets on each tracked mode, at the last cycle";
    INFLUENCE_ERRORS = "influence_estimate_errors", "",
        "Relative errors of influence_estimates";
    TRACKING_ERROR = "elastic_rate_error_rms_rad_s", "rad/s",
        "Root mean square error of the estimated elastic rates (norm over three axes), over the cycles of the run; null if there are none";
    DAMPING_CYCLES = "damping_cycles", "", "Number of cycles in which active damping commands a pulse on any axis";
    DAMPING_PAUSES = "damping_pauses", "", "Number of times the watchdog paused active damping";
}

/// Returns the description with the unit of a body without inertia, or of a commanded hub motion.
const fn reduced(meaning: MetricDescription, unit: &'static str) -> MetricDescription {
    MetricDescription { unit, ..meaning }
}
/// Largest absolute angular acceleration commanded on a body without inertia.
pub const PEAK_ACCELERATION: MetricDescription = reduced(PEAK_TORQUE, "rad/s²");
/// Largest absolute angular acceleration of the feedback on a body without inertia.
pub const PEAK_FEEDBACK_ACCELERATION: MetricDescription = reduced(PEAK_FEEDBACK, "rad/s²");
/// Residual energy of a body without inertia.
pub const RESIDUAL_ENERGY_UNIT_INERTIA: MetricDescription = reduced(RESIDUAL_ENERGY, "J/(kg m²)");
/// Integral of the absolute angular acceleration per hour on a body without inertia.
pub const REDUCED_IMPULSE: MetricDescription = reduced(IMPULSE, "rad/s");
/// Integral of the absolute angular acceleration per hour in the limit cycle of a body without inertia.
pub const CYCLE_REDUCED_IMPULSE: MetricDescription = reduced(CYCLE_IMPULSE, "rad/s");

/// Metrics that are words or lists of words, and no numbers.
const WORDS: [&str; 5] = [GOAL.name, REQUIREMENT.name, CYCLE_KIND.name, ACTUATOR_END.name, LOSS_LIMITS.name];

/// Returns the name of a list and the index in it of a name `NAME[i]`.
pub fn list_element(name: &str) -> Option<(&str, usize)> {
    let (list, index) = name.strip_suffix(']')?.rsplit_once('[')?;
    Some((list, index.parse().ok()?))
}

/// Returns true if the value of a metric is a word.
pub fn is_word(name: &str) -> bool {
    WORDS.contains(&name)
}

/// Checks that a requirement may limit a metric.
///
/// # Errors
/// A metric that is a word, and those of the requirements themselves.
pub fn validate_limited(name: &str) -> Result<(), String> {
    if is_word(name) || name.starts_with("requirement") {
        return Err(format!("must be a number to have a limit, and `{name}` is none"));
    }
    Ok(())
}

/// Metrics of the goal of a run.
pub const OF_GOAL: &[MetricDescription] = &[GOAL, GOAL_BAND, TIME_OUTSIDE];

/// Returns true if a metric is of the goal of a run.
pub fn is_of_goal(name: &str) -> bool {
    OF_GOAL.iter().any(|meaning| meaning.name == name)
}

/// Returns true if the value of a metric depends on the band of the goal.
pub fn needs_goal(name: &str) -> bool {
    is_of_goal(name) || name == SETTLING_TIME.name
}

/// Metrics that list events of a run.
const EVENT_LISTS: [&str; 5] =
    [LOSS_MODES.name, LOSS_STARTS.name, LOSS_TIMES.name, LOSS_BEFORE.name, LOSS_ERRORS.name];

/// Returns true if a metric is a list of events, which differ in number from run to run.
pub fn is_event_list(name: &str) -> bool {
    EVENT_LISTS.contains(&name)
}

/// Returns the description of a metric by its name, with the units of a body if one is given; objectives of adaptations
/// have no unit here.
pub fn meaning(name: &str, model: Option<&BodyModel>) -> Option<&'static MetricDescription> {
    const ACCELERATIONS: &[MetricDescription] =
        &[PEAK_ACCELERATION, PEAK_FEEDBACK_ACCELERATION, REDUCED_IMPULSE, CYCLE_REDUCED_IMPULSE];
    const UNIT_INERTIA: &[MetricDescription] = &[RESIDUAL_ENERGY_UNIT_INERTIA];
    let find_in = |some: &'static [MetricDescription]| some.iter().find(|meaning| meaning.name == name);
    let accelerations =
        model.filter(|model| model.commands_acceleration()).and_then(|_| find_in(ACCELERATIONS));
    let unit_inertia = model.filter(|model| model.has_unit_inertia()).and_then(|_| find_in(UNIT_INERTIA));
    accelerations.or(unit_inertia).or_else(|| find_in(ALL))
}
