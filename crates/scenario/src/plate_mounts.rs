//! Appendages on which the plates of the environment are mounted.

use flexsc_dynamics::three_axis::ArticulatedBody;
use flexsc_formats::document::ConfigError;
use flexsc_numerics::attitude::vector;
use flexsc_spacecraft::body::craft::Appendage;
use flexsc_spacecraft::environment::{PlateMount, PlateMounts};

use super::ScenarioSpec;

/// Finds the appendages of all plates of a scenario, whose body has these appendages that turn; returns a key within the environment
/// and the reason, if there is none of that name.
pub fn mounts(
    written: &ScenarioSpec,
    articulated: Option<&ArticulatedBody>,
) -> Result<PlateMounts, ConfigError> {
    let Some(environment) = &written.environment else { return Ok(PlateMounts::default()) };
    let find = |kind: &str, names: Vec<Option<&String>>| -> Result<Vec<Option<PlateMount>>, ConfigError> {
        let found = names.into_iter().enumerate().map(|(index, name)| {
            let Some(name) = name else { return Ok(None) };
            mount(&written.appendage, name)
                .map(Some)
                .map_err(|why| ConfigError::new(format!("{kind}.plates[{index}].appendage"), why))
        });
        found.collect()
    };
    let lit = environment.solar_pressure.iter().flat_map(|pressure| &pressure.plates);
    let braked = environment.drag.iter().flat_map(|drag| &drag.plates);
    let lit = find("solar_pressure", lit.map(|plate| plate.appendage.as_ref()).collect())?;
    let braked = find("drag", braked.map(|plate| plate.appendage.as_ref()).collect())?;
    let on_appendages = lit.iter().chain(&braked).any(Option::is_some);
    let turn = articulated.is_some_and(|body| on_appendages || body.moves_centre());
    let farthest = |body: &ArticulatedBody| {
        let moments = body.panels.iter().map(|panel| panel.mass * panel.centre.norm());
        2.0 * moments.sum::<f64>() / body.mass()
    };
    let centre_shift = articulated.filter(|_| turn).map_or(0.0, farthest);
    Ok(PlateMounts { lit, braked, turn, centre_shift })
}

/// Returns the appendage of a name.
fn mount(appendages: &[Appendage], name: &str) -> Result<PlateMount, String> {
    let Some(panel) = appendages.iter().position(|appendage| appendage.name == name) else {
        let names: Vec<String> =
            appendages.iter().map(|appendage| format!("\"{}\"", appendage.name)).collect();
        let known = if names.is_empty() {
            "there is none".to_owned()
        } else {
            format!("one of {}", names.join(", "))
        };
        return Err(format!("must be the name of an `[[appendage]]`, {known}, got \"{name}\""));
    };
    let appendage = &appendages[panel];
    Ok(PlateMount { panel, root: vector(&appendage.at), axes: appendage.turned.matrix() })
}
