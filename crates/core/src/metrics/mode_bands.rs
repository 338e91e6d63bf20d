//! Bands about the targets of modes of operation.

use flexsc_control::law::ErrorBand;
use flexsc_numerics::attitude::rotation_vector;
use flexsc_numerics::time::Instant;
use flexsc_record::ModeTargetStart;

use flexsc_scenario::Scenario;

/// Bands of the modes of a scenario; none with a band of the scenario.
#[derive(Clone, Debug, Default)]
pub struct ModeBands {
    bands: Vec<Vec<ErrorBand>>,
    /// Bands from the start of a run on (rad), if modes have targets.
    first: Option<[f64; 3]>,
}

impl ModeBands {
    /// Creates the bands of a scenario.
    pub fn new(scenario: &Scenario) -> Self {
        if scenario.reference.band.is_some() || !scenario.has_mode_targets() {
            return Self::default();
        }
        let mut bands = Self { bands: scenario.study.mode_bands.clone(), first: None };
        let has_target = scenario.mode.first().is_some_and(|mode| mode.target.is_some());
        let attitude = scenario.model.three_axis().map(|body| body.attitude.get());
        let first = attitude.filter(|_| has_target).and_then(|attitude| {
            let goal = scenario.study.profile.target(Instant::START);
            bands.bands(ModeTargetStart { mode: 0, distance: rotation_vector(&goal, &attitude).norm() })
        });
        bands.first = Some(first.unwrap_or([f64::NAN; 3]));
        bands
    }

    /// Returns the bands from the start of a run on (rad), NaN without a target there; `None` where modes have no targets.
    pub fn first(&self) -> Option<[f64; 3]> {
        self.first
    }

    /// Returns the bands of a mode that starts (rad); `None` if they are not those of its law.
    pub fn bands(&self, start: ModeTargetStart) -> Option<[f64; 3]> {
        let own = self.bands.get(start.mode)?;
        Some(std::array::from_fn(|axis| own.get(axis).map_or(f64::NAN, |band| band.band(start.distance))))
    }
}
