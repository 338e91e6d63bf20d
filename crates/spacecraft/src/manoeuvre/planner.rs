//! Planner of a manoeuvre for a given time.

use flexsc_dynamics::axis_model::AxisModel;
use flexsc_formats::document::ConfigError;

use super::Manoeuvre;
use super::command::ManoeuvreCommand;
use super::plan::Plan;
use super::shaper::{ShaperImpulse, convolve};
use super::suppression::Zero;
use super::task::RestToRestTask;

/// Validated manoeuvre of a body, to be planned for any time.
pub struct ManoeuvrePlanner<'a> {
    /// Body that the manoeuvre turns.
    pub body: &'a AxisModel,
    command: &'a ManoeuvreCommand,
    zeros: Vec<Zero>,
    impulses: Vec<ShaperImpulse>,
    inertia: f64,
    angle: f64,
    start_rate: f64,
    end_rate: f64,
}

impl<'a> ManoeuvrePlanner<'a> {
    /// Creates a planner, or returns the fault if the manoeuvre does not fit the body.
    pub fn new(manoeuvre: &'a Manoeuvre, body: &'a AxisModel) -> Result<Self, ConfigError> {
        let (angle, start_rate, end_rate) =
            (manoeuvre.angle.get(), manoeuvre.start_rate.get(), manoeuvre.end_rate.get());
        if angle == 0.0 && start_rate == end_rate {
            let why = "must not be 0 where the rates before and after are the same, got 0";
            return Err(ConfigError::new("angle", why));
        }
        let zeros = manoeuvre.command.zeros(&body.modes)?;
        let impulses = match &manoeuvre.shaper {
            Some(shaper) => shaper.impulses(&body.modes)?,
            None => vec![ShaperImpulse { delay: 0.0, area: 1.0 }],
        };
        let inertia = body.commanded_inertia();
        let command = &manoeuvre.command;
        Ok(Self { body, command, zeros, impulses, inertia, angle, start_rate, end_rate })
    }

    /// Returns the duration of the shaper (s): the command itself has the rest of the time.
    pub fn shaper(&self) -> f64 {
        self.impulses.iter().map(|impulse| impulse.delay).fold(0.0, f64::max)
    }

    /// Plans the manoeuvre for a time (s).
    pub fn plan(&self, time: f64) -> Result<Plan, ConfigError> {
        let shaper = self.shaper();
        if shaper >= time {
            let why = format!("must be longer than the shaper, which takes {shaper} s, got {time} s");
            return Err(ConfigError::new("time", why));
        }
        let impulse = self.inertia * (self.end_rate - self.start_rate);
        let travel = self.inertia * (self.angle - self.start_rate * time);
        // The rate gained by the command acts for a shorter time after each delayed impulse of the shaper.
        let mean: f64 = self.impulses.iter().map(|impulse| impulse.area * impulse.delay).sum();
        let task =
            RestToRestTask { time: time - shaper, impulse, travel: travel - impulse * (shaper - mean) };
        let (own, coefficients) = self.command.waveform(&task, &self.zeros)?;
        let (waveform, coefficients) = match self.impulses.as_slice() {
            [_] => (own, coefficients),
            impulses => (convolve(&own, impulses), None),
        };
        let plan = Plan {
            waveform,
            time,
            angle: self.angle,
            start_rate: self.start_rate,
            end_rate: self.end_rate,
            coefficients,
        };
        if plan.waveform.is_finite() {
            return Ok(plan);
        }
        Err(ConfigError::new("time", format!("must be one for which the command is finite, got {time} s")))
    }

    /// Returns the time (s) below which no command of the peak torque `peak` (N m) turns the rigid body.
    pub fn rigid_bound(&self, peak: f64) -> f64 {
        // Solve A² T² - 4 |E| A - P² = 0 with E = J (angle - mean rate T), which the bang-bang command satisfies.
        let a = peak / self.body.inertia.get();
        let (gained, mean) = (self.end_rate - self.start_rate, 0.5 * (self.end_rate + self.start_rate));
        let mut first = f64::INFINITY;
        for side in [1.0, -1.0] {
            let half = 2.0 * side * mean / a;
            let product = (4.0 * side * a * self.angle + gained * gained) / (a * a);
            let discriminant = half * half + product;
            if discriminant < 0.0 {
                continue;
            }
            let root = f64::sqrt(discriminant);
            for time in [root - half, -root - half] {
                let excess = side * (self.angle - mean * time);
                if time > 0.0 && excess >= -1e-9 * self.angle.abs() {
                    first = first.min(time);
                }
            }
        }
        first
    }
}
