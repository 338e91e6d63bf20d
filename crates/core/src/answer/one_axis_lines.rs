//! Lines on a run of a single-axis body.

use std::f64::consts::TAU;

use flexsc_formats::reader_units::{number, percent, time};

use super::lines::{AnswerLines, RunData};

/// Length of the late part at the end of a run (s), as defined by the metrics.
const LATE: f64 = 5.0;
/// Largest number of observed coordinates on a first screen.
const MOST_OUTPUTS: usize = 2;

/// True if a text of a quantity is 0 in all its digits.
fn is_nothing(text: &str) -> bool {
    text.starts_with("0 ")
}

impl RunData<'_> {
    pub(super) fn one_axis_lines(&self, lines: &mut AnswerLines) {
        if self.scenario.law.is_switching() {
            self.vibration(lines);
            self.jets_about_one_axis(lines);
            self.limit_cycle(lines);
        } else {
            self.rotation(lines);
            self.filter(lines);
            self.outputs(lines);
        }
    }

    fn vibration(&self, lines: &mut AnswerLines) {
        let means = self.list("envelope_window_means_rad");
        if let (Some(first), Some(last)) = (means.first(), means.last())
            && *first > 0.0
        {
            let change = 100.0 * (last / first - 1.0);
            let both = self.units.list(&[*first, *last], " -> ", "rad");
            lines.main("vibration", format!("envelope {both} ({change:+.0} %, means of windows)"));
        }
    }

    fn jets_about_one_axis(&self, lines: &mut AnswerLines) {
        let [switchings, right, left, duty] =
            ["switchings", "pushes_right", "pushes_left", "duty"].map(|name| self.number(name));
        let on = if duty.is_finite() {
            format!(", strong torque for {} of the time", percent(duty))
        } else {
            String::new()
        };
        let pushes = if right == left {
            format!("{} pushes each way", number(right))
        } else {
            format!("{} and {} pushes", number(right), number(left))
        };
        lines.main("law", format!("{} switchings, {pushes}{on}", number(switchings)));
    }

    fn limit_cycle(&self, lines: &mut AnswerLines) {
        let Some(kind) = self.metrics.word("cycle_kind") else { return };
        let Some(period) = self.known("cycle_period_s") else {
            return lines.main("limit cycle", format!("{kind}: the run is not periodic at its end"));
        };
        let multiplier = self.known("cycle_multiplier_max").map_or_else(String::new, |largest| {
            let stability =
                if largest < 1.0 { "stable: deviations shrink" } else { "unstable: deviations grow" };
            format!(", {stability} to {} in a period", number(largest))
        });
        lines.main("limit cycle", format!("{kind}, period {}{multiplier}", time(period)));
    }

    /// Adds the manoeuvre's end, torques and errors.
    fn rotation(&self, lines: &mut AnswerLines) {
        let (scenario, units) = (self.scenario, self.units);
        if let Some(plan) = &scenario.plan {
            let ends = [
                ("arrival_angle_error_rad", "rad", ""),
                ("arrival_rate_error_rad_s", "rad/s", ""),
                ("angle_residual_rad", "rad", " of vibration"),
            ];
            let off = ends.map(|(name, unit, of)| format!("{}{of}", self.quantity(name, unit)));
            // A motion that is given arrives to rounding.
            let off = off.into_iter().filter(|text| !is_nothing(text)).collect::<Vec<_>>().join(", ");
            let off = if off.is_empty() { off } else { format!("; off at its end by {off}") };
            let angle = units.quantity(plan.angle, "rad");
            lines.main("manoeuvre", format!("{angle} in {}{off}", time(plan.time)));
            let energy = if scenario.model.has_unit_inertia() { "J/(kg m²)" } else { "J" };
            lines.other("", format!("residual energy {}", self.quantity("residual_energy_j", energy)));
        }
        let after = if scenario.plan.is_some() { " after the manoeuvre" } else { "" };
        let [peak, late] = ["angle_error_peak_rad", "angle_error_late_rad"].map(|name| self.number(name));
        if !is_nothing(&units.quantity(peak, "rad")) {
            let end = match units.quantity(late, "rad") {
                _ if scenario.duration.seconds() <= LATE => String::new(),
                _ if late == peak => format!(", also over the last {}", time(LATE)),
                late => format!(", {late} over the last {}", time(LATE)),
            };
            let at = self.observed.and_then(|observed| observed.largest_angle);
            let at = at.map_or_else(String::new, |largest| match largest.at {
                0.0 => " at the start".to_owned(),
                at => format!(" at {}", time(at)),
            });
            lines.main("error", format!("at most {}{at}{after}{end}", units.quantity(peak, "rad")));
        }
        let (name, unit) = scenario.model.commanded_quantity();
        let [torque, law] = ["peak_torque_nm", "peak_feedback_torque_nm"].map(|name| self.number(name));
        let law = match law {
            law if law > torque => format!("; the law asks for up to {}", units.quantity(law, unit)),
            law if law > 0.0 && law < torque => format!(", {} of the law", units.quantity(law, unit)),
            _ => String::new(),
        };
        lines.main(name, format!("at most {}{law}", units.quantity(torque, unit)));
        if let Some(settling) = self.known("settling_time_s") {
            lines.other(
                "settling",
                format!("{} to the band of {}", time(settling), self.quantity("goal_band_rad", "rad")),
            );
        }
        // A loop that is unstable has a warning.
        if let Some(radius) = self.known("spectral_radius").filter(|radius| *radius < 1.0) {
            let decay = scenario.law.period().filter(|_| radius > 0.0).map_or_else(String::new, |period| {
                let constant = -period.seconds() / libm::log(radius);
                format!(", time constant of the slowest pole {}", time(constant))
            });
            lines.main("loop", format!("stable{decay}"));
        }
    }

    /// Adds the observed coordinates.
    fn outputs(&self, lines: &mut AnswerLines) {
        let after = if self.scenario.plan.is_some() { " after the manoeuvre" } else { "" };
        for (index, output) in self.scenario.model.outputs().iter().enumerate() {
            let quantity = |name: &str| {
                let value = self.list(name).get(index).copied().unwrap_or(f64::NAN);
                self.units.quantity(value, &output.unit)
            };
            let late = if self.scenario.duration.seconds() > LATE {
                format!(", ±{} over the last {}", quantity("output_swings_late"), time(LATE))
            } else {
                String::new()
            };
            let text = format!(
                "at most {}; swings by ±{}{after}{late}",
                quantity("output_peaks"),
                quantity("output_swings")
            );
            if index < MOST_OUTPUTS {
                lines.main(&output.name, text);
            } else {
                lines.other(&output.name, text);
            }
        }
    }

    /// Adds the results of a Kalman filter.
    fn filter(&self, lines: &mut AnswerLines) {
        if self.metrics.number("lock_lost").is_none() {
            return;
        }
        if self.scenario.estimator.as_ref().is_some_and(|estimator| estimator.is_assessed_only()) {
            lines.other("filter", "not used by the law");
        }
        let Some(consistency) = self.consistency() else {
            return lines.main("filter", "not assessed: the run ends before `assess`");
        };
        let largest = self.number("frequency_error_max_rad_s");
        // Known frequencies have no error.
        if largest > 0.0 {
            let [rms, largest] = [self.number("frequency_error_rms_rad_s"), largest].map(|error| error / TAU);
            let unit = self.units.fitting(largest, "Hz");
            let text =
                format!("estimate off by {} rms, at most {}", unit.quantity(rms), unit.number(largest));
            lines.main("frequency", text);
        }
        lines.other("filter", consistency);
    }
}
