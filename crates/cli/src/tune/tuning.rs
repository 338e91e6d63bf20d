//! What `flexsc tune` works on.

use flexsc_core::analysis::sampled_loop::{Gains, Loop, Region, Scaling, SettlingWindow, regions};
use flexsc_core::law::Extra;

/// What is tuned.
pub struct Tuning {
    /// Name of the scenario.
    pub name: String,
    /// Its extra loop, if it has one.
    pub own: Option<Extra>,
    /// Its loop.
    pub of: Loop,
    /// Frequencies of the dominant mode (rad/s).
    pub frequencies: Vec<f64>,
    /// Which modes follow it.
    pub scaling: Scaling,
    /// The gains that are tried.
    pub gains: Gains,
    /// What counts as settled.
    pub window: SettlingWindow,
    /// The longest settling time of the region (s).
    pub limit: f64,
}

impl Tuning {
    /// The region of the gains at each frequency.
    pub fn regions(&self) -> Vec<Region> {
        regions(&self.of, &self.frequencies, self.scaling, self.gains, self.window, self.limit)
    }
}
