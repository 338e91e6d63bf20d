//! Sampled loop of a scenario and its settling criterion, which `tune` and `map` share.

use flexsc_core::analysis::sampled_loop::{SampledLoop, Scaling, SettlingWindow};
use flexsc_core::control::law::Pd;
use flexsc_core::formats::document::ConfigError;
use flexsc_core::{Scenario, ScenarioError};

use crate::confirm_cost::CostConfirmation;
use crate::error::CliError;
use crate::quantity::in_unit;

/// Criteria of settling, and the modes that follow.
#[derive(clap::Args)]
#[group(skip)]
pub struct SettlingArgs {
    /// Half width of the band in which the angle has settled (rad); left out, 5 % of the angle at the start
    #[arg(long, value_name = "ANGLE", value_parser = in_unit("rad"))]
    band: Option<f64>,
    /// Simulated time of each loop (s)
    #[arg(long, value_name = "TIME", default_value_t = 2000.0, value_parser = in_unit("s"))]
    horizon: f64,
    /// Change only the frequency of the dominant mode [default: scale all modes]
    #[arg(long)]
    dominant_alone: bool,
    #[command(flatten)]
    consent: CostConfirmation,
}

impl SettlingArgs {
    pub fn scaling(&self) -> Scaling {
        if self.dominant_alone { Scaling::First } else { Scaling::All }
    }

    /// Returns an error if simulating `times` loops, with this shortest period (s) and up to this additional delay (s),
    /// is impossible, or too costly without the user's consent.
    pub fn check_cost(
        &self,
        sampled_loop: &SampledLoop,
        times: usize,
        shortest: f64,
        delay: f64,
    ) -> Result<(), CliError> {
        let cost = sampled_loop.simulation_cost(times as f64, self.horizon, shortest, delay);
        self.consent.check(&cost.map_err(|why| CliError::Arguments(format!("--{why}")))?)
    }

    pub fn window(&self, sampled_loop: &SampledLoop, name: &str) -> Result<SettlingWindow, CliError> {
        positive("--horizon", self.horizon)?;
        if let Some(band) = self.band {
            positive("--band", band)?;
        }
        Ok(sampled_loop.settling_window(self.band, self.horizon).map_err(refused(name))?)
    }
}

/// Returns the sampled loop of a scenario, and its law.
pub fn sampled(scenario: &Scenario) -> Result<(SampledLoop, &Pd), CliError> {
    Ok(SampledLoop::from_scenario(scenario).map_err(refused(&scenario.name))?)
}

fn refused(name: &str) -> impl FnOnce(ConfigError) -> ScenarioError + '_ {
    move |ConfigError { key, why, .. }| ScenarioError::Key { origin: name.to_owned(), key, why }
}

/// Returns an error unless a number is positive.
pub fn positive(name: &str, value: f64) -> Result<(), CliError> {
    let fits = value.is_finite() && value > 0.0;
    if fits {
        Ok(())
    } else {
        Err(CliError::Arguments(format!("{name} must be a positive number, got {value}")))
    }
}
