//! Lines on a run of a three-axis body.

use std::f64::consts::TAU;

use flexsc_formats::count::counted;
use flexsc_formats::reader_units::{ReaderUnit, number, percent, time};
use flexsc_numerics::attitude::AXES;
use flexsc_numerics::quantity::{Positive, Time};

use super::error_statistics::ErrorSummary;
use super::lines::{AnswerLines, RunData};

/// Length of the run's end over which elastic rates are assessed (s), as defined by the metrics.
const LATE: f64 = 200.0;
/// Largest number of thrusters in the list.
const THRUSTERS: usize = 12;
/// Part of a run from which on blinding is shown on the first screen.
const MUCH: f64 = 0.1;
/// Part of its largest speed up to which a wheel stands still.
const STILL: f64 = 1e-3;
/// Error of an identified frequency up to which it is not named.
const CLOSE: f64 = 0.02;

impl RunData<'_> {
    pub(super) fn three_axis_lines(&self, lines: &mut AnswerLines) {
        self.lines_of_sight(lines);
        self.pointing(lines);
        self.wheels(lines);
        self.jets(lines);
        self.gimbals(lines);
        self.damping(lines);
        self.elastic(lines);
        if let Some(text) = self.consistency() {
            lines.other("filter", text);
        }
        for blinded in self.list("tracker_blinded_s") {
            let share = blinded / self.scenario.duration.seconds();
            let text = format!("blinded for {}, {} of the time", time(blinded), percent(share));
            if share > MUCH { lines.main("star tracker", text) } else { lines.other("star tracker", text) }
        }
        if let Some(share) = self.known("moment_limit_share").filter(|share| *share > 0.0) {
            let text = format!("of a magnetorquer for {} of the time", percent(share));
            lines.other("largest moment", text);
        }
        if self.known("friction_heat_j").is_some() {
            let text = format!(
                "{} of heat, {}, {}",
                self.quantity("friction_heat_j", "J"),
                counted(self.number("wheel_zero_crossings"), "zero crossing"),
                counted(self.number("wheel_stops"), "stop")
            );
            lines.other("friction", text);
        }
    }

    /// Adds the error and the jitter of each line of sight.
    fn lines_of_sight(&self, lines: &mut AnswerLines) {
        for (index, line) in self.scenario.line_of_sight.iter().enumerate() {
            let value = |name: &str| {
                let values = self.list(&format!("line_of_sight_{name}_rad"));
                values.get(index).copied().unwrap_or(f64::NAN)
            };
            let [rms, peak, jitter] = ["rms", "peak", "jitter_rms"].map(value);
            if !rms.is_finite() {
                continue;
            }
            let jitter = match line.jitter_window {
                Some(window) if jitter.is_finite() => {
                    format!(
                        "; jitter {} rms within {}",
                        self.units.quantity(jitter, "rad"),
                        time(window.get())
                    )
                }
                _ => String::new(),
            };
            let [rms, peak] = [rms, peak].map(|value| self.units.quantity(value, "rad"));
            let behind = if line.mirror.is_some() { " behind its mirror" } else { "" };
            lines.main("line of sight", format!("{}{behind}: {rms} rms, largest {peak}{jitter}", line.point));
            if line.mirror.is_some() {
                let of_mirror = |name: &str| self.list(name).get(index).copied().unwrap_or(f64::NAN);
                let angle = self.units.quantity(of_mirror("fine_mirror_peak_rad"), "rad");
                let limited = of_mirror("fine_mirror_limited_s");
                let limits = if limited > 0.0 {
                    format!("; stroke or rate limits it for {}", time(limited))
                } else {
                    String::new()
                };
                lines.main("mirror", format!("{}: turns at most {angle}{limits}", line.point));
            }
        }
        for own in &self.scenario.study.contrasts {
            lines.main("contrast", format!("{}: not of a run; `flexsc spectrum` judges it", own.name));
        }
    }

    /// Adds the pointing error: while the target moves, afterwards, and at the end.
    fn pointing(&self, lines: &mut AnswerLines) {
        let has_modes = !self.scenario.mode.is_empty();
        let statistics = |errors: &ErrorSummary| {
            let unit = self.units.fitting(errors.p95, "rad");
            let rms = unit.quantity(errors.rms);
            let [p95, largest] = [errors.p95, errors.largest].map(|value| unit.number(value));
            let goal = self.scenario.reference.band.and_then(|_| self.known("goal_band_rad"));
            // The goal is about each axis.
            let norm = if goal.is_some_and(|band| errors.rms > band) { " of the norm" } else { "" };
            format!("error {rms} rms{norm}, 95 % {p95}, largest {largest} at {}", time(errors.at_s))
        };
        let knowledge = self.known("attitude_estimate_error_rms_rad").map_or_else(String::new, |error| {
            let end = self.scenario.duration.seconds();
            let [from, to] = self.scenario.estimator.as_ref().map_or([0.0, end], |filter| filter.assess());
            let span = format!("{} to {}", number(from), time(to.min(end)));
            format!("; knowledge {} rms, {span}", self.units.quantity(error, "rad"))
        });
        let mut add = |head: &str, text: String| {
            if has_modes { lines.other(head, text) } else { lines.main(head, text) }
        };
        let Some(observed) = self.observed else {
            let end = self.quantity("pointing_error_end_rad", "rad");
            return add("pointing", format!("error {end} at the end{knowledge}"));
        };
        if let (Some(slews), Some([from, to])) = (&observed.slews, observed.slewing) {
            let head = if observed.slew_count > 1 { "slews" } else { "slew" };
            let count = if observed.slew_count > 1 {
                format!("{} from ", observed.slew_count)
            } else {
                String::new()
            };
            add(head, format!("{count}{} to {}: {}", number(from), time(to), statistics(slews)));
        }
        if let (Some(settled), Some([_, to])) = (&observed.settled, observed.slewing)
            && observed.late.as_ref().is_some_and(|late| settled.largest > late.largest)
            && settled.at_s > to
        {
            let largest = self.units.quantity(settled.largest, "rad");
            let after = if observed.slew_count == 1 {
                format!(", {} after the slew", time(settled.at_s - to))
            } else {
                String::new()
            };
            add("settling", format!("largest error {largest} at {}{after}", time(settled.at_s)));
        }
        if let Some(late) = observed.late.as_ref().filter(|late| late.largest > 0.0) {
            let from = number(super::run_observer::LATE * self.scenario.duration.seconds());
            let to = time(self.scenario.duration.seconds());
            add("pointing", format!("{from} to {to}: {}{knowledge}", statistics(late)));
        }
        if let Some(pointing) = &self.scenario.reference.pointing {
            let [start, end] = pointing.window.map(Time::get);
            let rms = self.quantity("pointing_rms_rad", "rad");
            lines.other("pointing", format!("{rms} rms from {} to {}", number(start), time(end)));
        }
    }

    fn wheels(&self, lines: &mut AnswerLines) {
        let Some((wheels, _)) = self.scenario.actuator.wheels() else { return };
        let (Some(peak), Some(one)) =
            (self.known("wheel_speed_peak_rad_s"), self.known("one_wheel_momentum_peak_nm_s"))
        else {
            return;
        };
        // A largest value, and its limit if there is one.
        let of_limit = |unit: &ReaderUnit, peak: f64, limit: Option<f64>| match limit {
            Some(limit) => format!("{} of {}", unit.number_against(peak, limit), unit.quantity(limit)),
            None => unit.quantity(peak),
        };
        let unit = self.units.rotor_speed();
        let least = self
            .observed
            .map(|observed| observed.modes.iter().map(|mode| mode.wheel_speed[0]).fold(f64::NAN, f64::min));
        let from = match least.filter(|least| *least > STILL * peak) {
            Some(least) => format!("{} to", unit.number(least)),
            None => "up to".to_owned(),
        };
        let speeds = format!("{from} {}", of_limit(&unit, peak, wheels.speed_limit.map(Positive::get)));
        let limit = wheels.momentum.map(Positive::get);
        let momentum = of_limit(&self.units.fitting(limit.unwrap_or(one), "N m s"), one, limit);
        let limits = [
            ("wheel_torque_limit_share", "limit of torque"),
            ("wheel_momentum_limit_share", "limit of momentum or speed"),
        ];
        let at_limit = |(name, limit): &(&str, &str)| {
            let share = self.known(name).filter(|share| *share > 0.0)?;
            Some(format!("; at the {limit} for {} of the time", percent(share)))
        };
        let text = format!(
            "{speeds}, {momentum} in one wheel, {} in all{}",
            self.quantity("wheel_momentum_peak_nm_s", "N m s"),
            limits.iter().filter_map(at_limit).collect::<String>()
        );
        if self.scenario.mode.is_empty() { lines.main("wheels", text) } else { lines.other("wheels", text) }
    }

    fn jets(&self, lines: &mut AnswerLines) {
        // Other actuators use no propellant.
        let Some(fuel) = self.known("fuel_kg").filter(|fuel| *fuel > 0.0) else { return };
        let unit = self.units.fitting(fuel, "kg");
        let parts = |name: &str, names: &[String]| {
            let parts = self.list(name);
            if parts.len() > THRUSTERS || parts.len() != names.len() || parts.is_empty() {
                return String::new();
            }
            let used: Vec<(&String, &f64)> =
                names.iter().zip(&parts).filter(|(_, part)| **part > 0.0).collect();
            if let [(only, _)] = used[..] {
                return format!(", all {only}");
            }
            let each = used.iter().map(|(name, part)| format!("{name} {}", unit.number(**part)));
            format!(": {}", each.collect::<Vec<_>>().join(", "))
        };
        let thrusters = self.scenario.actuator.jets().map_or_else(Vec::new, |(jets, _)| jets.names());
        // A cycle may have several pulses.
        let [pulses, cycles] = ["firings", "firing_cycles"].map(|name| self.number(name));
        let within =
            if pulses == cycles { String::new() } else { format!(" in {}", counted(cycles, "cycle")) };
        let text = format!(
            "{}{}{}; {}{within}",
            unit.quantity(fuel),
            parts("fuel_axes_kg", &AXES.map(str::to_owned)),
            parts("fuel_thrusters_kg", &thrusters),
            counted(pulses, "pulse"),
        );
        lines.main("propellant", text);
    }

    fn gimbals(&self, lines: &mut AnswerLines) {
        if self.known("singularity_min").is_some() {
            let text = format!(
                "rate at most {}; singularity measure at least {}; torque within {} of the demand",
                self.quantity("gimbal_rate_peak_rad_s", "rad/s"),
                number(self.number("singularity_min")),
                self.quantity("torque_error_peak_nm", "N m")
            );
            lines.main("gimbals", text);
        }
    }

    /// Adds the frequencies that a filter or an observer has identified, and active damping.
    fn damping(&self, lines: &mut AnswerLines) {
        let found = self.list("frequency_estimates_hz");
        if found.is_empty() {
            return;
        }
        let errors = self.list("frequency_estimate_errors");
        let unit = self.units.frequency();
        let real = |(found, error): (&f64, &f64)| TAU * found / (1.0 + error);
        let far: Vec<String> = found
            .iter()
            .zip(&errors)
            .filter(|(_, error)| error.abs() > CLOSE)
            .map(|own| {
                let side = if *own.1 > 0.0 { "high" } else { "low" };
                format!("{} found {} too {side}", unit.quantity(real(own)), percent(own.1.abs()))
            })
            .collect();
        let close = errors.iter().filter(|error| error.abs() <= CLOSE);
        let largest = close.clone().fold(0.0, |most: f64, error| most.max(error.abs()));
        let close = match close.count() {
            0 => String::new(),
            count => format!(", {count} within {}", percent(largest)),
        };
        let far = if far.is_empty() { String::new() } else { format!("; {}", far.join(", ")) };
        lines.main("frequencies", format!("{} identified{close}{far}", errors.len()));
        let each = |own: (&f64, &f64)| format!("{} / {}", unit.number(TAU * own.0), unit.number(real(own)));
        let each: Vec<String> = found.iter().zip(&errors).map(each).collect();
        lines.other("", format!("{} {} (identified / true)", each.join(", "), unit.name));
        if self.metrics.get("damping_cycles").is_some() {
            let [cycles, pauses] = ["damping_cycles", "damping_pauses"].map(|name| self.number(name));
            let paused = match pauses {
                0.0 => String::new(),
                pauses => format!(", paused {}", counted(pauses, "time")),
            };
            let text = if cycles == 0.0 {
                "never on".to_owned()
            } else {
                format!("on in {}", counted(cycles, "cycle"))
            };
            lines.main("active damping", format!("{text}{paused}"));
        }
    }

    fn elastic(&self, lines: &mut AnswerLines) {
        if self.scenario.mode_count() == 0 {
            return;
        }
        let below = |name: &str, part: &str| {
            self.known(name)
                .map_or_else(String::new, |at| format!(", below {part} of the first at {}", time(at)))
        };
        let energies = ["elastic_energy_peak_j", "elastic_energy_end_j"].map(|name| self.quantity(name, "J"));
        let text = format!(
            "largest energy {}{}{}, {} at the end",
            energies[0],
            below("energy_below_10pct_at_s", "10 %"),
            below("energy_below_1pct_at_s", "1 %"),
            energies[1]
        );
        let is_damped = self.metrics.get("damping_cycles").is_some();
        let damps = is_damped || self.number("pointing_error_end_rad") == 0.0;
        if damps {
            lines.main("vibration", text);
        } else {
            lines.other("vibration", text);
        }
        let duration = self.scenario.duration.seconds();
        let over =
            if duration > LATE { format!("the last {}", time(LATE)) } else { "the whole run".to_owned() };
        let rate = self.quantity("elastic_rate_rms_rad_s", "rad/s");
        lines.other("", format!("elastic rate {rate} rms at the gyro over {over}"));
    }
}
