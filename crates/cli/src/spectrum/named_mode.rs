//! Free modes with the names of the appendages that they belong to.

use std::f64::consts::TAU;

use flexsc_core::Scenario;
use flexsc_core::analysis::body_poles::WhirlPoles;
use flexsc_core::analysis::spacecraft_modes::SpacecraftModes;
use flexsc_figure::Point;

/// Difference of clamped frequencies, relative, below which modes of several appendages are one.
const ALIKE: f64 = 0.01;
/// Number of steps of the speed.
const STEPS: u32 = 24;
/// Change of a frequency over the speed from which a mode whirls.
const WHIRL: f64 = 1.02;

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

/// Modes of a figure over the speed of the wheels.
pub struct ShownModes {
    /// Modes that do not depend on the speed.
    pub named: Vec<NamedMode>,
    /// Frequencies (Hz) over the speed (rad/s) of modes that whirl.
    pub whirling: Vec<Vec<Point>>,
}

impl ShownModes {
    /// Returns the modes of a scenario up to a speed of its wheels (rad/s).
    pub fn new(scenario: &Scenario, fastest: f64) -> Self {
        let named = NamedMode::all(scenario);
        let poles = |step: u32| -> Option<(f64, Vec<f64>)> {
            let speed = fastest * f64::from(step) / f64::from(STEPS);
            let found = WhirlPoles::from_scenario(scenario, Some(speed)).ok()??;
            Some((speed, found.poles.iter().map(|pole| pole.frequency_rad_s / TAU).collect()))
        };
        let all: Vec<(f64, Vec<f64>)> = (0..=STEPS).filter_map(poles).collect();
        let most = all.iter().map(|(_, hertz)| hertz.len()).max().unwrap_or(0);
        // Slow motions of the rigid body have fewer poles at rest: modes are counted from the highest.
        let curve = |down: usize| -> Vec<Point> {
            let at = |(speed, hertz): &(f64, Vec<f64>)| {
                Some((*speed, *hertz.get(hertz.len().checked_sub(down + 1)?)?))
            };
            all.iter().filter_map(at).collect()
        };
        let whirls = |curve: &Vec<Point>| {
            let hertz = curve.iter().map(|point| point.1);
            hertz.clone().fold(0.0, f64::max) > WHIRL * hertz.fold(f64::INFINITY, f64::min)
        };
        let is_mode = |down: &usize| *down < named.len();
        let whirling = (0..most).filter(is_mode).map(curve).filter(whirls).collect();
        Self { named, whirling }
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
