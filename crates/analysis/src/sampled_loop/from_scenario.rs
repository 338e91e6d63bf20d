//! Construction of the sampled loop that a scenario describes.

use flexsc_control::actuator::{LinearDrive, Wheel};
use flexsc_control::law::Pd;
use flexsc_dynamics::axis_model::CommandedQuantity;
use flexsc_formats::document::ConfigError;
use flexsc_numerics::quantity::Positive;

use super::{CommandPath, SampledLoop, SettlingWindow};
use flexsc_scenario::Cost;
use flexsc_scenario::Scenario;

/// Largest delay (periods): a longer one makes the loop's matrix too large.
const MOST_LATE: f64 = 200.0;
/// Largest number of samples over which a loop is simulated.
const MOST_SAMPLES: f64 = 1e7;

impl SampledLoop {
    /// Returns the loop of a scenario whose angle is measured exactly and without delay, and the law that closes it.
    ///
    /// # Errors
    /// A key that such a loop does not support, and the reason.
    pub fn from_scenario(scenario: &Scenario) -> Result<(Self, &Pd), ConfigError> {
        let refused = |key: &str, why: &str| Err(ConfigError::new(key, why));
        let Some(body) = scenario.model.one_axis() else {
            return refused(
                &scenario.body_key(),
                "turns about three axes: only loops with one angle are analysed",
            );
        };
        let Some(law) = scenario.law.pd() else {
            return refused("law", "must be `pd`: only sampled loops are analysed");
        };
        if let Some(fault) = scenario.validate_for_loop_analysis() {
            return Err(fault);
        }
        if body.modes.is_empty() {
            return refused("body", "must have a mode whose frequency changes");
        }
        if body.drive != CommandedQuantity::Torque {
            return refused("body", "must be turned by a torque, not by a given motion of the hub");
        }
        if scenario.manoeuvre.is_some() {
            return refused(
                "manoeuvre",
                "cannot be part of the analysis of a loop that brings the angle to 0",
            );
        }
        let inertia = body.inertia.get();
        let drive = match scenario.actuator.only_actuator().map(|kind| kind.linear_drive()) {
            Some(Some(drive)) => drive,
            None => {
                return refused("actuator", "must be one, `wheel` or `ideal`, for the analysis of the loop");
            }
            Some(None) => {
                return refused("actuator", "must be `wheel` or `ideal` for the analysis of the loop");
            }
        };
        let LinearDrive { gain, back_emf, opposes_body_rate, delay, wheel } = drive;
        let late = delay / law.period.seconds();
        if late > MOST_LATE {
            let why = format!(
                "is {late:.3e} periods of the law: a loop that is analysed waits for at most {MOST_LATE}"
            );
            return refused("actuator.wheel.delay", &why);
        }
        let shapes = |wheel: &&Wheel| {
            wheel.limit.is_some() || wheel.quantum.get() > 0.0 || wheel.dead_zone.get() > 0.0
        };
        let shaping = wheel.filter(shapes);
        let shape = (law.limit.is_some() || shaping.is_some()).then(|| CommandPath {
            limit: law.limit.map_or(f64::INFINITY, Positive::get),
            wheel: shaping.cloned(),
        });
        let sampled = Self {
            back_emf: back_emf / inertia,
            total: opposes_body_rate,
            authority: gain / inertia,
            k_p: law.k_p.get(),
            k_d: law.k_d.get(),
            differentiation: law.differentiation,
            dominant: Self::dominant_mode(&body.modes),
            period: law.period.seconds(),
            delay,
            shape,
            body: body.clone(),
        };
        Ok((sampled, law))
    }

    /// Returns the cost of closing the loop `times` times with sampling periods from `shortest` (s) on and up to
    /// `delay` (s) of additional delay, and of simulating each over `horizon` (s).
    ///
    /// # Errors
    /// More samples, or a longer delay, than a simulation of a loop supports.
    pub fn simulation_cost(
        &self,
        times: f64,
        horizon: f64,
        shortest: f64,
        delay: f64,
    ) -> Result<Cost, String> {
        let (samples, late) = (horizon / shortest, (self.delay + delay) / self.period);
        if samples > MOST_SAMPLES {
            return Err(format!(
                "horizon must be at most 1e7 samples, got {samples:e} with a period of {shortest} s"
            ));
        }
        if late > MOST_LATE {
            return Err(format!(
                "delay must leave at most {MOST_LATE} periods of the law in all, got {late:.3e}"
            ));
        }
        let order = 3.0 + 2.0 * self.body.modes.len() as f64 + late;
        // In a block of 32 samples, the state costs as much as the angles.
        let watched = samples * order * (1.0 + order / 32.0);
        Ok(Cost::from_work("the grid", times, (watched + 50.0 * order * order * order) * 1e-9))
    }

    /// Returns the measured angle at the start (rad).
    pub fn initial_angle(&self) -> f64 {
        self.body.initial_state().angle()
    }

    /// Returns the settling window, by default with a band of 5 % of the angle at the start, as in the papers.
    ///
    /// # Errors
    /// The body starts at angle 0.
    pub fn settling_window(&self, band: Option<f64>, horizon: f64) -> Result<SettlingWindow, ConfigError> {
        match band.unwrap_or(0.05 * self.initial_angle().abs()) {
            band if band > 0.0 => Ok(SettlingWindow { band, horizon }),
            _ => Err(ConfigError::new("body", "must start at an angle other than 0, or the band be given")),
        }
    }
}
