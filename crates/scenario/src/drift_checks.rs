//! Checks of a drift: its profiles, and their number.

use flexsc_formats::count::counted;
use flexsc_formats::document::ConfigError;
use flexsc_spacecraft::body::{BodyModel, Drift, DriftProfile};

use super::ScenarioSpec;
use super::consistency::errors_in;

impl ScenarioSpec {
    pub(super) fn validate_drift(&self, model: &BodyModel, errors: &mut Vec<ConfigError>) {
        let Some(drift) = &self.drift else { return };
        if self.spacecraft.is_some() {
            let why = "is for modes that are given: those of a `[spacecraft]` follow from its appendages, which a `drive` can turn";
            errors.push(ConfigError::new("drift", why));
            return;
        }
        match drift {
            Drift::Common(profile) => {
                errors.extend(validate_profile(profile).map(|error| error.within("drift.common")));
            }
            Drift::Each(profiles) => {
                let (modes, count) = (model.mode_count(), profiles.len());
                if count != modes {
                    let why =
                        format!("must have a profile for each of {}, got {count}", counted(modes, "mode"));
                    errors.push(ConfigError::new("drift.each", why));
                }
                errors.extend(errors_in("drift.each", profiles, validate_profile));
            }
        }
    }
}

/// Checks a profile; returns the inconsistent key and the reason.
fn validate_profile(profile: &DriftProfile) -> Option<ConfigError> {
    match profile {
        DriftProfile::Sinusoid(sinusoid) if sinusoid.amplitude.get() >= 0.5 => {
            let why =
                format!("must be below 0.5, so that no frequency vanishes, got {}", sinusoid.amplitude.get());
            Some(ConfigError::new("sinusoid.amplitude", why))
        }
        DriftProfile::Table(points) if points.len() < 2 => {
            let why = format!("must have at least two points, got {}", points.len());
            Some(ConfigError::new("table", why))
        }
        DriftProfile::Table(points) => {
            let late = 1 + points.windows(2).position(|pair| pair[0].time >= pair[1].time)?;
            let why = format!("must be later than the one before, got {}", points[late].time.get());
            Some(ConfigError::new(format!("table[{late}].time"), why))
        }
        DriftProfile::Sinusoid(_) | DriftProfile::Ramp(_) => None,
    }
}
