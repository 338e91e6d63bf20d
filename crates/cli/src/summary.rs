//! The summary of a run for people.

use std::io::Write;

use flexsc_core::Scenario;
use flexsc_core::count::counted;
use flexsc_core::estimator::Estimator;
use flexsc_core::metrics::{Metrics, Value};

use crate::say;

/// Prints the result of a run, which took so many seconds of real time.
pub fn tell(scenario: &Scenario, metrics: &Metrics, took: f64) {
    let (duration, modes) = (scenario.duration.seconds(), scenario.mode_count());
    let head = format!("{}   {duration} s, {}", scenario.name, counted(modes, "mode"));
    let number = |name: &str| metrics.number(name).unwrap_or(f64::NAN);
    if scenario.axis_count() == 3 {
        say!("{head}, {:.1} ms", took * 1e3);
        spatial(metrics, modes > 0);
        adaptation(scenario, metrics);
    } else if scenario.law.switches() {
        say!("{head}, {}, {:.1} ms", counted(number("switchings"), "switching"), took * 1e3);
        switchings(scenario, metrics);
        goal(metrics, within);
    } else {
        say!("{head}, {:.1} ms", took * 1e3);
        rotation(scenario, metrics);
        adaptation(scenario, metrics);
    }
}

/// Propellant, wheels, gimbals, elastic energy and pointing of a spatial body.
fn spatial(metrics: &Metrics, bends: bool) {
    let number = |name: &str| metrics.number(name).unwrap_or(f64::NAN);
    // Other actuators use none.
    let fuel = number("fuel_kg");
    if fuel.is_finite() {
        let fuel = if 0.0 < fuel && fuel < 0.1 { format!("{fuel:.2e}") } else { format!("{fuel:.3}") };
        say!(
            "  jets           {fuel} kg of propellant, {} in {}",
            counted(number("firings"), "pulse"),
            counted(number("firing_cycles"), "cycle"),
        );
    }
    if number("friction_heat_j").is_finite() {
        say!(
            "  wheels         {}, {}, {:.1} J of friction heat",
            counted(number("wheel_zero_crossings"), "zero crossing"),
            counted(number("wheel_stops"), "stop"),
            number("friction_heat_j"),
        );
    }
    if number("singularity_min").is_finite() {
        say!(
            "  gimbals        at most {:.3e} rad/s; singularity measure at least {:.3}; torque within {:.3e} N m of the demand",
            number("gimbal_rate_peak_rad_s"),
            number("singularity_min"),
            number("torque_error_peak_nm"),
        );
    }
    let below = |name: &str, part: &str| match number(name) {
        time if time.is_finite() => format!(", below {part} of the first at {time:.1} s"),
        _ => String::new(),
    };
    if bends {
        say!(
            "  elastic        at most {:.3e} J{}{}, {:.3e} J at the end ({:.3e} J in modes visible to the gyro)",
            number("elastic_energy_peak_j"),
            below("energy_below_10pct_at_s", "10 %"),
            below("energy_below_1pct_at_s", "1 %"),
            number("elastic_energy_end_j"),
            number("visible_energy_end_j"),
        );
        say!(
            "  elastic rate   {:.3e} rad/s rms at the gyro over the last 200 s",
            number("elastic_rate_rms_rad_s")
        );
    }
    if number("attitude_estimate_error_rms_rad").is_finite() {
        say!(
            "  filter         error {:.3e} rad rms; NEES {:.2}, NIS {:.2} (1 if consistent)",
            number("attitude_estimate_error_rms_rad"),
            number("nees_mean"),
            number("nis_mean"),
        );
    }
    let error = number("pointing_error_end_rad");
    say!("  pointing       {error:.3e} rad error at the end (root sum of squares of the axes)");
    if let (rms, Some(Value::Word(word))) = (number("pointing_rms_rad"), metrics.get("requirement")) {
        say!("  requirement    {word}: {rms:.3e} rad rms in its window");
    }
    // Each axis has a band of its own: their root sum of squares may be more.
    goal(metrics, |band| format!("each axis in its band (at most ±{band:.3e} rad)"));
    if let Some(Value::Numbers(frequencies)) = metrics.get("frequency_estimates_hz") {
        let found: Vec<String> = frequencies.iter().map(|frequency| format!("{frequency:.4}")).collect();
        let damped = metrics.get("damping_cycles").map(|_| {
            let [cycles, pauses] = ["damping_cycles", "damping_pauses"].map(number);
            format!("; damped in {}, paused {}", counted(cycles, "cycle"), counted(pauses, "time"))
        });
        say!("  modes          {} Hz as estimated{}", found.join(", "), damped.unwrap_or_default());
    }
}

/// The band about the goal.
fn within(band: f64) -> String {
    format!("within ±{band:.3e} rad")
}

/// Whether the run meets its goal; `within` says what has to be within a band.
fn goal(metrics: &Metrics, within: impl FnOnce(f64) -> String) {
    let number = |name: &str| metrics.number(name).unwrap_or(f64::NAN);
    let Some(Value::Word(word)) = metrics.get("goal") else { return };
    let band = number("goal_band_rad");
    if band.is_finite() {
        let outside = number("time_outside_s");
        let but = if outside > 0.0 { format!(", but for {outside:.6} s") } else { String::new() };
        say!("  goal           {word}: {}{but}", within(band));
    } else {
        say!("  goal           {word}");
    }
}

/// Envelope, adaptation and limit cycle of a relay law.
fn switchings(scenario: &Scenario, metrics: &Metrics) {
    let number = |name: &str| metrics.number(name).unwrap_or(f64::NAN);
    if let Some(Value::Numbers(means)) = metrics.get("envelope_window_means_rad")
        && let (Some(first), Some(last)) = (means.first(), means.last())
    {
        let change = 100.0 * (last / first - 1.0);
        say!("  envelope       {first:.3e} -> {last:.3e} rad  (window means, {change:+.0} %)");
    }
    adaptation(scenario, metrics);
    if let Some(Value::Word(kind)) = metrics.get("cycle_kind") {
        let (period, largest) = (number("cycle_period_s"), number("cycle_multiplier_max"));
        if period.is_finite() {
            let multiplier =
                if largest.is_finite() { format!(", multiplier {largest:.3}") } else { String::new() };
            say!("  cycle          {kind}, period {period:.6} s{multiplier}");
        } else {
            say!("  cycle          {kind}: the run is not periodic at its end");
        }
    }
}

/// The number that an adaptation tunes, and its objective if that is not the envelope.
fn adaptation(scenario: &Scenario, metrics: &Metrics) {
    let Some(adaptation) = &scenario.adaptation else { return };
    let number = |name: &str| metrics.number(name).unwrap_or(f64::NAN);
    if number("objective_final").is_finite() {
        let objective = adaptation.objective();
        let unit = objective.unit(scenario.torque_unit());
        let (first, last) = (number("objective_initial"), number("objective_final"));
        say!("  objective      {}: {first:.3e} -> {last:.3e} {unit}", objective.word());
    }
    let frozen = number("gain_frozen_at_s");
    let end = if frozen.is_finite() { format!("frozen at {frozen} s") } else { "not frozen".to_owned() };
    let (tunes, first, last) = (adaptation.tunes(), number("gain_initial"), number("gain_final"));
    if first.abs() < 1e-3 {
        say!("  {tunes:<14} {first:.4e} -> {last:.4e}, {end}");
    } else {
        say!("  {tunes:<14} {first:.4} -> {last:.4}, {end}");
    }
}

/// The manoeuvre's end, torques and observed coordinates.
fn rotation(scenario: &Scenario, metrics: &Metrics) {
    let number = |name: &str| metrics.number(name).unwrap_or(f64::NAN);
    if let Some(plan) = &scenario.plan {
        say!("  manoeuvre      {} rad in {} s", plan.angle, plan.time);
        say!(
            "  at its end     {:+.3e} rad, {:+.3e} rad/s from the goal; {:.3e} rad of vibration, {:.3e} {}",
            number("arrival_angle_error_rad"),
            number("arrival_rate_error_rad_s"),
            number("angle_residual_rad"),
            number("residual_energy_j"),
            if scenario.model.has_unit_inertia() { "J/(kg m²)" } else { "J" },
        );
    }
    let (name, unit) = scenario.model.commanded();
    let feedback = number("peak_feedback_torque_nm");
    let of_it = if feedback == 0.0 { String::new() } else { format!(", of the law {feedback:.4e} {unit}") };
    say!("  {name:<14} at most {:.4e} {unit}{of_it}", number("peak_torque_nm"));
    say!(
        "  angle          at most {:.3e} rad off the goal after the manoeuvre, {:.3e} rad over the last 5 s",
        number("angle_error_peak_rad"),
        number("angle_error_late_rad"),
    );
    goal(metrics, within);
    let settling = number("settling_time_s");
    if settling.is_finite() {
        say!("  settling time  {settling} s");
    } else if number("goal_band_rad").is_finite() {
        say!("  settling time  not settled after {} s", scenario.duration.seconds());
    }
    let radius = number("spectral_radius");
    if radius.is_finite() {
        let verdict = if radius < 1.0 { "stable" } else { "unstable" };
        say!("  sampled loop   spectral radius {radius:.7}: {verdict}");
    }
    if metrics.number("lock_lost").is_some() {
        if scenario.estimator.as_ref().is_some_and(Estimator::watches_only) {
            say!("  filter         not used by the law");
        }
        filter(metrics);
    }
    let of = |name: &str, index: usize| match metrics.get(name) {
        Some(value) => value.numbers().get(index).copied().unwrap_or(f64::NAN),
        None => f64::NAN,
    };
    for (index, output) in scenario.model.outputs().iter().enumerate() {
        say!(
            "  {:<14} at most {:.4e} {}; swings by {:.3e} after it, by {:.3e} over the last 5 s",
            output.name,
            of("output_peaks", index),
            output.unit,
            of("output_swings", index),
            of("output_swings_late", index),
        );
    }
}

/// What a Kalman filter came to.
fn filter(metrics: &Metrics) {
    let number = |name: &str| metrics.number(name).unwrap_or(f64::NAN);
    if !number("nees_mean").is_finite() {
        say!("  filter         not assessed: the run ends before `assess`");
        return;
    }
    say!(
        "  filter         frequency error {:.4e} rad/s rms, at most {:.4e}; NEES {:.2}, NIS {:.2} (1 if consistent)",
        number("frequency_error_rms_rad_s"),
        number("frequency_error_max_rad_s"),
        number("nees_mean"),
        number("nis_mean"),
    );
    let lost = number("lock_lost_at_s");
    if lost.is_finite() {
        // Of innovations that are as expected it lost what it cannot see.
        let hint = if number("nis_mean") > 2.0 {
            ": the innovations exceed its `moment_noise` and sensor noise"
        } else {
            ""
        };
        say!("  filter         diverged at {lost} s{hint}");
    }
}
