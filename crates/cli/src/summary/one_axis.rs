//! Summary of a run of a single-axis body.

use std::io::Write;

use flexsc_core::control::estimator::EstimatorKind;

use super::Summary;
use crate::human::digits;
use crate::say;

/// Length of the late part at the end of a run (s), as defined by the metrics.
const LATE: f64 = 5.0;

impl Summary<'_> {
    /// Prints the manoeuvre's end, torques and observed coordinates.
    pub(super) fn rotation(&self) {
        let (scenario, units) = (self.scenario, self.units);
        if let Some(plan) = &scenario.plan {
            say!("  manoeuvre      {} in {} s", units.quantity(plan.angle, "rad"), digits(plan.time));
            let energy = if scenario.model.has_unit_inertia() { "J/(kg m²)" } else { "J" };
            say!(
                "  at its end     {} and {} off the goal; {} of vibration, {}",
                self.quantity("arrival_angle_error_rad", "rad"),
                self.quantity("arrival_rate_error_rad_s", "rad/s"),
                self.quantity("angle_residual_rad", "rad"),
                self.quantity("residual_energy_j", energy),
            );
        }
        let (name, unit) = scenario.model.commanded_quantity();
        let (peak, feedback_peak) = (self.number("peak_torque_nm"), self.number("peak_feedback_torque_nm"));
        let law_part = if feedback_peak == 0.0 {
            String::new()
        } else {
            format!("; at most {} demanded by the law", units.quantity(feedback_peak, unit))
        };
        say!("  {name:<14} at most {} given{law_part}", units.quantity(peak, unit));
        let after = if scenario.plan.is_some() { " after the manoeuvre" } else { "" };
        let late = scenario.duration.seconds() > LATE;
        let late_error = |unit: &str| {
            let error = self.quantity("angle_error_late_rad", unit);
            if late { format!(", {error} over the last {LATE} s") } else { String::new() }
        };
        say!(
            "  error          at most {}{after}{}",
            self.quantity("angle_error_peak_rad", "rad"),
            late_error("rad")
        );
        self.goal(&[]);
        let settling = self.number("settling_time_s");
        if settling.is_finite() {
            say!("  settling time  {} s", digits(settling));
        } else if self.number("goal_band_rad").is_finite() {
            say!("  settling time  not settled after {} s", scenario.duration.seconds());
        }
        let radius = self.number("spectral_radius");
        if radius.is_finite() {
            let verdict = if radius < 1.0 { "stable" } else { "unstable" };
            say!("  sampled loop   spectral radius {radius:.7}: {verdict}");
        }
        if self.metrics.number("lock_lost").is_some() {
            if scenario.estimator.as_ref().is_some_and(EstimatorKind::is_assessed_only) {
                say!("  filter         not used by the law");
            }
            self.filter();
        }
        self.outputs(after, late);
    }

    /// Prints the observed coordinates.
    fn outputs(&self, after: &str, late: bool) {
        let number = |name: &str, index: usize| match self.metrics.get(name) {
            Some(value) => value.numbers().get(index).copied().unwrap_or(f64::NAN),
            None => f64::NAN,
        };
        for (index, output) in self.scenario.model.outputs().iter().enumerate() {
            let quantity = |name: &str| self.units.quantity(number(name, index), &output.unit);
            let at_end = if late {
                format!(", ±{} over the last {LATE} s", quantity("output_swings_late"))
            } else {
                String::new()
            };
            say!(
                "  {:<14} at most {}; swings by ±{}{after}{at_end}",
                output.name,
                quantity("output_peaks"),
                quantity("output_swings"),
            );
        }
    }

    /// Prints the results of a Kalman filter.
    fn filter(&self) {
        if !self.number("nees_mean").is_finite() {
            say!("  filter         not assessed: the run ends before `assess`");
            return;
        }
        let largest = self.number("frequency_error_max_rad_s");
        // Known frequencies have no error.
        if largest > 0.0 {
            let unit = self.units.frequency();
            let [rms, largest] =
                [self.number("frequency_error_rms_rad_s"), largest].map(|error| digits(error * unit.0));
            say!("  filter         frequency error {rms} {} rms, at most {largest} {}", unit.1, unit.1);
        }
        say!("  consistency    {}", self.consistency());
        let lost = self.number("lock_lost_at_s");
        if lost.is_finite() {
            // With innovations as expected, the filter has lost an unobservable state.
            let hint = if self.number("nis_mean") > 2.0 {
                ": the innovations exceed its `moment_noise` and sensor noise"
            } else {
                ""
            };
            say!("  filter         diverged at {} s{hint}", digits(lost));
        }
    }
}
