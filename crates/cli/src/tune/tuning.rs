//! Input of `flexsc tune`.

use flexsc_core::analysis::sampled_loop::{GainRegion, Gains, SampledLoop, Scaling, SettlingWindow, regions};
use flexsc_core::control::law::Extra;

/// Loop to tune, with the tested gains and the criterion.
pub struct TuneSetup {
    /// Name of the scenario.
    pub name: String,
    /// Extra loop of the scenario, if it has one.
    pub own: Option<Extra>,
    /// Sampled loop of the scenario.
    pub sampled_loop: SampledLoop,
    /// Frequencies of the dominant mode (rad/s).
    pub frequencies: Vec<f64>,
    /// Selection of the modes that are scaled with the dominant one.
    pub scaling: Scaling,
    /// Gains to test.
    pub gains: Gains,
    /// Criterion of settling.
    pub window: SettlingWindow,
    /// Longest admissible settling time (s).
    pub limit: f64,
}

impl TuneSetup {
    /// Computes the region of the gains at each frequency.
    pub fn regions(&self) -> Vec<GainRegion> {
        regions(&self.sampled_loop, &self.frequencies, self.scaling, self.gains, self.window, self.limit)
    }
}
