//! Block of the spacecraft: its drawing beside lines of data, and its animated model.

use flexsc_core::Scenario;
use flexsc_core::analysis::mode_influence::ModeInfluences;
use flexsc_core::analysis::one_axis_modes::OneAxisModes;
use flexsc_core::analysis::spacecraft_modes::SpacecraftModes;
use flexsc_core::formats::reader_units::{ReaderUnits, number};
use flexsc_core::spacecraft::body::BodyAxes;
use flexsc_view::drawing::{spacecraft_svg, wheel_limits};

use super::html::{HtmlRow, HtmlTable, cell, command, head, number_head, picture};
use super::model_block;
use super::study::{Study, StudyRun};

/// Largest number of frequencies in a line.
const MOST: usize = 4;

/// Returns the block, with the animated model of a run if there is one.
pub fn block(study: &Study, run: Option<&StudyRun>) -> String {
    let scenario = &study.scenario;
    let mut lines = body_lines(scenario);
    lines.extend(part_lines(scenario));
    let row =
        |(name, text): &(String, String)| HtmlRow { cells: vec![cell(name), cell(text)], is_missed: false };
    let table = HtmlTable {
        heads: vec![head(""), number_head("")],
        rows: lines.iter().map(row).collect(),
        is_cards: false,
    };
    let table = table.html();
    let drawn = spacecraft_svg(scenario).map(|svg| {
        let caption =
            "Drawn from the scenario. It gives no sizes: each part is the box of its mass and inertia.";
        picture(&svg, caption).replacen("figscroll", "craft", 1)
    });
    let body = match drawn {
        Some(figure) => format!("<div class=\"cols\">{figure}{table}</div>\n"),
        None => format!(
            "{table}<p>Not drawn: the body is given by its inertia and its modes, without shapes.</p>\n"
        ),
    };
    let model = run.and_then(|run| model_block::block(study, &run.log)).unwrap_or_default();
    body + &model + &command(&study.command("modes", ""))
}

/// Returns lines on the body and its modes.
fn body_lines(scenario: &Scenario) -> Vec<(String, String)> {
    let units = ReaderUnits::default();
    let mut lines: Vec<(String, String)> = Vec::new();
    let mut add = |name: &str, text: String| lines.push((name.to_owned(), text));
    if let Some(craft) = scenario.model.spacecraft() {
        let modes = SpacecraftModes::from_scenario(scenario, craft);
        add("mass", units.quantity(modes.mass_kg, "kg"));
        // Rounding leaves less than a micrometre.
        let centre = modes.centre_m.map(|place| if place.abs() < 1e-6 { 0.0 } else { place });
        add("centre of mass", units.list(&centre, ", ", "m"));
        let inertia = modes.inertia_kg_m2;
        add("inertia", format!("{} kg m²", [0, 1, 2].map(|axis| number(inertia[axis][axis])).join(", ")));
        let clamped: Vec<f64> = modes.clamped.iter().map(|own| own.frequency_rad_s).collect();
        add("modes, clamped", frequencies(&clamped));
        add("modes, free", frequencies(&modes.free.frequencies_rad_s));
        return lines;
    }
    match scenario.model.axes() {
        BodyAxes::Three(body) => {
            let modes = ModeInfluences::from_scenario(scenario, body);
            let inertia = [0, 1, 2].map(|axis| number(body.inertia[(axis, axis)]));
            add("inertia", format!("{} kg m²", inertia.join(", ")));
            add("modes", frequencies(&modes.frequencies_rad_s));
        }
        BodyAxes::One(body) => {
            let modes = OneAxisModes::from_body(body);
            add("inertia", format!("{} kg m²", number(modes.inertia_kg_m2)));
            add("modes", frequencies(&modes.frequencies_rad_s));
        }
    }
    lines
}

/// Returns frequencies (rad/s) as a text, the lowest first.
fn frequencies(all: &[f64]) -> String {
    let mut sorted = all.to_vec();
    sorted.sort_by(f64::total_cmp);
    let unit = ReaderUnits::default().frequency();
    match sorted.len() {
        0 => "none, rigid".to_owned(),
        count if count <= MOST => unit.list(&sorted, ", "),
        count => format!(
            "{}, ... {} ({count})",
            unit.list(&sorted[..MOST - 1], ", "),
            unit.quantity(sorted[count - 1])
        ),
    }
}

/// Returns lines on actuators, sensors and the orbit.
fn part_lines(scenario: &Scenario) -> Vec<(String, String)> {
    let units = ReaderUnits::default();
    let mut lines: Vec<(String, String)> = Vec::new();
    let mut add = |name: &str, text: String| lines.push((name.to_owned(), text));
    if let Some((wheels, _)) = scenario.actuator.wheels() {
        add("wheels", format!("{} × {}", wheels.count(), wheel_limits(wheels)));
    }
    if let Some((torquers, _)) = scenario.actuator.magnetorquers() {
        let moments = [0, 1, 2].map(|axis| torquers.moment.about(axis).get());
        let each = units.fitting(moments.into_iter().fold(0.0, f64::max), "A m²");
        let text = if moments.iter().all(|moment| *moment == moments[0]) {
            format!("3 × {}", each.quantity(moments[0]))
        } else {
            each.list(&moments, ", ")
        };
        add("magnetic torquers", text);
    }
    if let Some((jets, _)) = scenario.actuator.jets() {
        add("thrusters", jets.thrusters.len().to_string());
    }
    for sensor in scenario.sensor.iter() {
        if sensor.is_continuous() {
            continue;
        }
        let own = sensor.period(scenario.study.law_period);
        let rate = own.map_or_else(String::new, |period| format!("{} Hz", number(1.0 / period.seconds())));
        add(&sensor.kind().replace('_', " "), rate);
    }
    if let Some(orbit) = scenario.orbit_environment().orbit() {
        let altitude = orbit.at(0.0).position.norm() - orbit.planet_radius();
        add("orbit", format!("altitude {} km at the start", number(1e-3 * altitude)));
    }
    lines
}
