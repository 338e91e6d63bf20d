//! Sampled loop of a scenario and its settling criterion, which `tune` and `map` share.

use flexsc_core::analysis::sampled_loop::{Loop, Scaling, SettlingWindow};
use flexsc_core::document::Fault;
use flexsc_core::law::Pd;
use flexsc_core::{Scenario, ScenarioError};

use crate::consent::Consent;
use crate::failure::Failure;

/// Criteria of settling, and the modes that follow.
#[derive(clap::Args)]
#[group(skip)]
pub struct Settled {
    /// Half width of the band in which the angle has settled (rad); left out, 5 % of the angle at the start
    #[arg(long, value_name = "ANGLE")]
    band: Option<f64>,
    /// Simulated time of each loop (s)
    #[arg(long, value_name = "TIME", default_value_t = 2000.0)]
    horizon: f64,
    /// Change only the frequency of the dominant mode [default: scale all modes]
    #[arg(long)]
    dominant_alone: bool,
    #[command(flatten)]
    consent: Consent,
}

impl Settled {
    pub fn scaling(&self) -> Scaling {
        if self.dominant_alone { Scaling::First } else { Scaling::All }
    }

    /// Returns an error if simulating `times` loops, with this shortest period (s) and up to this additional delay (s),
    /// is impossible, or too costly without the user's consent.
    pub fn allow(&self, of: &Loop, times: usize, shortest: f64, delay: f64) -> Result<(), Failure> {
        let cost = of.watched(times as f64, self.horizon, shortest, delay);
        self.consent.to(&cost.map_err(|why| Failure::Arguments(format!("--{why}")))?)
    }

    pub fn window(&self, of: &Loop, name: &str) -> Result<SettlingWindow, Failure> {
        positive("--horizon", self.horizon)?;
        if let Some(band) = self.band {
            positive("--band", band)?;
        }
        Ok(of.window(self.band, self.horizon).map_err(refused(name))?)
    }
}

/// Returns the sampled loop of a scenario, and its law.
pub fn sampled(scenario: &Scenario) -> Result<(Loop, &Pd), Failure> {
    Ok(Loop::of(scenario).map_err(refused(&scenario.name))?)
}

fn refused(name: &str) -> impl FnOnce(Fault) -> ScenarioError + '_ {
    move |Fault { key, why }| ScenarioError::Key { origin: name.to_owned(), key, why }
}

/// Returns an error unless a number is positive.
pub fn positive(name: &str, value: f64) -> Result<(), Failure> {
    let fits = value.is_finite() && value > 0.0;
    if fits {
        Ok(())
    } else {
        Err(Failure::Arguments(format!("{name} must be a positive number, got {value}")))
    }
}
