//! Summary of a run of a three-axis body.

use std::io::Write;

use flexsc_core::formats::count::counted;
use flexsc_core::metrics::MetricValue;
use flexsc_core::numerics::attitude::AXES;
use flexsc_core::numerics::quantity::Time;

use super::Summary;
use crate::human::digits;
use crate::say;

/// Length of the run's end over which elastic rates are assessed (s), as defined by the metrics.
const LATE: f64 = 200.0;
/// Largest number of thrusters in the list.
const THRUSTERS: usize = 12;

impl Summary<'_> {
    /// Prints propellant, wheels, gimbals, elastic energy and pointing.
    pub(super) fn three_axes(&self) {
        self.jets();
        self.wheels();
        if self.number("singularity_min").is_finite() {
            say!(
                "  gimbals        rate at most {}; singularity measure at least {}; torque within {} of the demand",
                self.quantity("gimbal_rate_peak_rad_s", "rad/s"),
                digits(self.number("singularity_min")),
                self.quantity("torque_error_peak_nm", "N m"),
            );
        }
        self.elastic();
        if self.number("attitude_estimate_error_rms_rad").is_finite() {
            say!(
                "  filter         attitude error {} rms (norm of three axes)",
                self.quantity("attitude_estimate_error_rms_rad", "rad")
            );
            say!("  consistency    {}", self.consistency());
        }
        if let Some(MetricValue::Numbers(times)) = self.metrics.get("tracker_blinded_s") {
            for time in times {
                let percent = digits(100.0 * time / self.scenario.duration.seconds());
                say!("  star tracker   blinded for {} s, {percent} % of the time", digits(*time));
            }
        }
        say!(
            "  pointing       error {} at the end (norm of three axes)",
            self.quantity("pointing_error_end_rad", "rad")
        );
        if self.number("slew_error_peak_rad").is_finite() {
            say!(
                "  slews          error at most {}, {} rms, while the target moves",
                self.quantity("slew_error_peak_rad", "rad"),
                self.quantity("slew_error_rms_rad", "rad"),
            );
        }
        self.lines_of_sight();
        if let Some(pointing) = &self.scenario.reference.pointing {
            let [start, end] = pointing.window.map(Time::get);
            say!("  pointing       {} rms from {start} to {end} s", self.quantity("pointing_rms_rad", "rad"));
        }
        let own = self.scenario.study.expected_bands.iter().map(|band| band.unwrap_or(f64::NAN));
        let bands: Vec<f64> = match self.scenario.reference.band {
            Some(band) => vec![band.get(); 3],
            // The band of modes with targets is that of the mode that has the goal.
            None if self.scenario.has_mode_targets() => vec![self.number("goal_band_rad"); 3],
            None => own.collect(),
        };
        self.goal(&bands);
        self.frequencies();
    }

    /// Prints the error and the jitter of each line of sight.
    fn lines_of_sight(&self) {
        let values = |name: &str, index: usize| match self.metrics.get(name) {
            Some(MetricValue::Numbers(values)) => values.get(index).copied().unwrap_or(f64::NAN),
            _ => f64::NAN,
        };
        for (index, line) in self.scenario.line_of_sight.iter().enumerate() {
            let [rms, peak, jitter] =
                ["rms", "peak", "jitter_rms"].map(|name| values(&format!("line_of_sight_{name}_rad"), index));
            if !rms.is_finite() {
                continue;
            }
            let [rms, peak] = [rms, peak].map(|value| self.units.quantity(value, "rad"));
            let jitter = match line.jitter_window {
                Some(window) if jitter.is_finite() => {
                    let jitter = self.units.quantity(jitter, "rad");
                    format!("; jitter {jitter} rms within {} s", digits(window.get()))
                }
                _ => String::new(),
            };
            say!("  line of sight  {}: error {rms} rms, at most {peak}{jitter}", line.point);
        }
    }

    fn jets(&self) {
        // Other actuators use no propellant.
        if !self.number("fuel_kg").is_finite() {
            return;
        }
        let parts = |name: &str, names: &[String]| match self.metrics.get(name) {
            Some(MetricValue::Numbers(parts)) if parts.len() <= THRUSTERS && parts.len() == names.len() => {
                let part =
                    |(name, part): (&String, &f64)| format!("{name} {}", self.units.quantity(*part, "kg"));
                format!(" ({})", names.iter().zip(parts).map(part).collect::<Vec<_>>().join(", "))
            }
            _ => String::new(),
        };
        let thrusters = self.scenario.actuator.jets().map_or_else(Vec::new, |(jets, _)| jets.names());
        let axes = AXES.map(str::to_owned);
        say!(
            "  jets           {} of propellant{}{}, {} in {}",
            self.quantity("fuel_kg", "kg"),
            parts("fuel_axes_kg", &axes),
            parts("fuel_thrusters_kg", &thrusters),
            counted(self.number("firings"), "pulse"),
            counted(self.number("firing_cycles"), "cycle"),
        );
    }

    fn wheels(&self) {
        let limits = [
            ("wheel_torque_limit_share", "torque limit"),
            ("wheel_momentum_limit_share", "limit of momentum or speed"),
        ];
        let share = |(name, limit): &(&str, &str)| {
            let share = self.number(name);
            share.is_finite().then(|| format!("; at the {limit} {} % of the time", digits(100.0 * share)))
        };
        if self.number("wheel_speed_peak_rad_s").is_finite() {
            say!(
                "  wheels         at most {} and {} in one wheel, {} in all{}",
                self.units.speed(self.number("wheel_speed_peak_rad_s")),
                self.quantity("one_wheel_momentum_peak_nm_s", "N m s"),
                self.quantity("wheel_momentum_peak_nm_s", "N m s"),
                limits.iter().filter_map(share).collect::<String>(),
            );
        }
        if self.number("friction_heat_j").is_finite() {
            say!(
                "  friction       {} of heat, {}, {}",
                self.quantity("friction_heat_j", "J"),
                counted(self.number("wheel_zero_crossings"), "zero crossing"),
                counted(self.number("wheel_stops"), "stop"),
            );
        }
        let moment = self.number("moment_limit_share");
        if moment.is_finite() {
            say!("  magnetorquers  at the largest moment {} % of the time", digits(100.0 * moment));
        }
    }

    fn elastic(&self) {
        if self.scenario.mode_count() == 0 {
            return;
        }
        let below = |name: &str, part: &str| match self.number(name) {
            time if time.is_finite() => format!(", below {part} of the first at {} s", digits(time)),
            _ => String::new(),
        };
        let all = self.quantity("elastic_energy_end_j", "J");
        let visible = self.quantity("visible_energy_end_j", "J");
        let visible = if visible == all {
            String::new()
        } else {
            format!(" (of it {visible} in modes that the gyro measures)")
        };
        say!(
            "  elastic energy at most {}{}{}, {all} at the end{visible}",
            self.quantity("elastic_energy_peak_j", "J"),
            below("energy_below_10pct_at_s", "10 %"),
            below("energy_below_1pct_at_s", "1 %"),
        );
        let duration = self.scenario.duration.seconds();
        let over = if duration > LATE { format!("the last {LATE} s") } else { "the whole run".to_owned() };
        say!(
            "  elastic rate   {} rms at the gyro over {over}",
            self.quantity("elastic_rate_rms_rad_s", "rad/s")
        );
    }

    /// Prints the frequencies that a filter or an observer has identified, with the true ones, and active damping.
    fn frequencies(&self) {
        let Some(MetricValue::Numbers(found)) = self.metrics.get("frequency_estimates_hz") else { return };
        let errors =
            self.metrics.get("frequency_estimate_errors").map_or_else(Vec::new, MetricValue::numbers);
        let unit = self.units.frequency();
        let factor = std::f64::consts::TAU * unit.0;
        let both = |(found, error): (&f64, &f64)| {
            format!("{} / {}", digits(found * factor), digits(found * factor / (1.0 + error)))
        };
        let both: Vec<String> = found.iter().zip(&errors).map(both).collect();
        say!("  frequencies    {} {} (estimated / true)", both.join(", "), unit.1);
        if self.metrics.get("damping_cycles").is_some() {
            let [cycles, pauses] = ["damping_cycles", "damping_pauses"].map(|name| self.number(name));
            say!("  active damping in {}, paused {}", counted(cycles, "cycle"), counted(pauses, "time"));
        }
    }
}
