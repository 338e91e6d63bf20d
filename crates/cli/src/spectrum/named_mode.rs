//! Free modes with the names of the appendages that they belong to.

use flexsc_core::Scenario;
use flexsc_core::analysis::spacecraft_modes::SpacecraftModes;

/// Difference of clamped frequencies, relative, below which modes of several appendages are one.
const ALIKE: f64 = 0.01;

/// Free mode with a name.
#[derive(Clone)]
pub struct NamedMode {
    /// Natural frequency (rad/s).
    pub frequency_rad_s: f64,
    /// Name of the appendage; what the names of equal appendages have in common; `mode` without one.
    pub name: String,
}

impl NamedMode {
    /// Returns the free modes of a scenario in increasing order. Freeing the roots of appendages raises their frequencies without
    /// changing their order: each free mode has the name of the clamped one in its place.
    pub fn all(scenario: &Scenario) -> Vec<Self> {
        let mut clamped: Vec<(f64, String)> = match scenario.model.spacecraft() {
            Some(craft) => {
                let rows = SpacecraftModes::from_scenario(scenario, craft).clamped;
                rows.into_iter().map(|row| (row.frequency_rad_s, row.appendage)).collect()
            }
            None => Vec::new(),
        };
        clamped.sort_by(|a, b| a.0.total_cmp(&b.0));
        let mut free: Vec<f64> = scenario.model.frequencies().collect();
        free.sort_by(f64::total_cmp);
        let name = |place: usize| match clamped.get(place) {
            Some((frequency, _)) => {
                let is_same = |other: &&(f64, String)| (other.0 / frequency - 1.0).abs() < ALIKE;
                common(clamped.iter().filter(is_same).map(|(_, name)| name.as_str()))
            }
            None => "mode".to_owned(),
        };
        free.into_iter()
            .enumerate()
            .map(|(place, frequency_rad_s)| Self { frequency_rad_s, name: name(place) })
            .collect()
    }
}

/// Returns what several names have in common at their start, without marks at its end.
fn common<'a>(mut names: impl Iterator<Item = &'a str>) -> String {
    let first = names.next().unwrap_or_default();
    let length = names.fold(first.len(), |length, name| {
        let alike = first.char_indices().zip(name.chars()).find(|((_, a), b)| a != b);
        length.min(alike.map_or(name.len(), |((place, _), _)| place))
    });
    let common = first[..length].trim_end_matches([' ', '+', '-', '_']);
    if common.is_empty() { "mode".to_owned() } else { common.to_owned() }
}

#[cfg(test)]
mod tests {
    use super::common;

    #[test]
    fn equal_appendages_have_a_name_in_common() {
        for (names, expected) in [
            (&["wing +y", "wing -y"][..], "wing"),
            (&["telescope"], "telescope"),
            (&["a", "b"], "mode"),
            (&[], "mode"),
        ] {
            assert_eq!(common(names.iter().copied()), expected);
        }
    }
}
