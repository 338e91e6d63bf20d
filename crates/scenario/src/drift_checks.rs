//! Checks of a drift: its profiles, and their number.

use flexsc_formats::count::counted;
use flexsc_formats::document::ConfigError;
use flexsc_spacecraft::body::{Drift, DriftProfile};

use super::Scenario;

impl Scenario {
    pub(super) fn validate_drift(&self) -> Option<ConfigError> {
        let at = |key: &str, why: String| Some(ConfigError::new(key, why));
        let drift = self.drift.as_ref()?;
        let modes = self.mode_count();
        let profiles: Vec<(String, &DriftProfile)> = match drift {
            Drift::Common(profile) => vec![("drift.common".to_owned(), profile)],
            Drift::Each(profiles) if profiles.len() != modes => {
                return at(
                    "drift.each",
                    format!(
                        "must have a profile for each of {}, got {}",
                        counted(modes, "mode"),
                        profiles.len()
                    ),
                );
            }
            Drift::Each(profiles) => {
                let key = |(index, profile)| (format!("drift.each[{index}]"), profile);
                profiles.iter().enumerate().map(key).collect()
            }
        };
        for (key, profile) in profiles {
            match profile {
                DriftProfile::Sinusoid(sinusoid) if sinusoid.amplitude.get() >= 0.5 => {
                    let why = format!(
                        "must be below 0.5, so that no frequency vanishes, got {}",
                        sinusoid.amplitude.get()
                    );
                    return at(&format!("{key}.sinusoid.amplitude"), why);
                }
                DriftProfile::Table(points) if points.len() < 2 => {
                    return at(
                        &format!("{key}.table"),
                        format!("must have at least two points, got {}", points.len()),
                    );
                }
                DriftProfile::Table(points) => {
                    if let Some(index) = points.windows(2).position(|pair| pair[0].time >= pair[1].time) {
                        let (index, time) = (index + 1, points[index + 1].time.get());
                        return at(
                            &format!("{key}.table[{index}].time"),
                            format!("must be later than the one before, got {time}"),
                        );
                    }
                }
                _ => {}
            }
        }
        None
    }
}
