//! The spacecraft of the finite rotation: a hub with two panels of four sections (\[Rotation\], section 4), by its modes.
//!
//! Frequencies, gains J X_n[0]² and weights P_4n/X_n[0] come from the eigenproblem in 40-digit arithmetic.

#![expect(clippy::unreadable_literal, reason = "the digits of references are compared as they stand")]

use flexsc_core::dynamics::axis_model::AxisModel;
use flexsc_core::spacecraft::manoeuvre::{Plan, PlanReport};
use flexsc_core::{Document, Scenario, ScenarioError};

/// Moment of inertia (kg m²).
pub const INERTIA: f64 = 4616.67;
/// Natural frequencies (rad/s).
pub const FREQUENCIES: [f64; 4] =
    [3.330081535753227, 7.398419278191804, 14.16531246931957, 22.34864709558169];
/// Amplitude of the last section's angle for a unit amplitude of each mode at the hub and a unit modal force.
pub const PARTICIPATIONS: [f64; 4] =
    [-0.0043481157958017, 0.00058893779242022, -0.002719332646332, 0.00052334062803443];

const FREE: &str = "
[[body.planar.modes]]
frequency = 3.330081535753227
gain = 9.414365255919522
[[body.planar.modes]]
frequency = 7.398419278191804
gain = 14.36417693021238
[[body.planar.modes]]
frequency = 14.16531246931957
gain = 2.4548090353570724
[[body.planar.modes]]
frequency = 22.34864709558169
gain = 0.27292319317923345
[[body.planar.outputs]]
name = \"phi4\"
modes = [-2.1322537638298835, 0.18928557141439171, -5.1141499267438788, 8.8526407341314741]
";

const CLAMPED: &str = "
[[body.planar.modes]]
frequency = 0.9138573911382853
gain = 0.93814258755383027
[[body.planar.modes]]
frequency = 5.3623318033933908
gain = 0.022931897209876173
[[body.planar.modes]]
frequency = 13.638952997537382
gain = 0.0022873763849151629
[[body.planar.modes]]
frequency = 22.250622889420211
gain = 0.00028279734185240063
[[body.planar.outputs]]
name = \"phi4\"
modes = [-1.6411559991243388, 33.731982488085307, -140.64526515645358, 312.19969139274811]
";

/// The scenario of a manoeuvre, given by the lines of its table; `drive` is `torque` or `motion`.
pub fn text(drive: &str, rate: f64, manoeuvre: &str) -> String {
    let modes = if drive == "motion" { CLAMPED } else { FREE };
    format!(
        "duration = 20.0\n[body.planar]\ninertia = {INERTIA}\nrate = {rate}\ndrive = \"{drive}\"\n{modes}\
         [manoeuvre]\n{manoeuvre}\n"
    )
}

/// A quarter turn in 12 s from rest to rest, with this command.
pub fn quarter_turn(command: &str) -> Scenario {
    scenario(&text(
        "torque",
        0.0,
        &format!("angle = 1.5707963267948966\ntime = 12.0\n[manoeuvre.command]\n{command}"),
    ))
}

/// A scenario of a text.
pub fn scenario(text: &str) -> Scenario {
    Scenario::parse("turn.toml", text).expect("a valid scenario")
}

/// A scenario with some keys set.
pub fn with(text: &str, set: &[(&str, String)]) -> Result<Scenario, ScenarioError> {
    let mut document = Document::parse("turn.toml", text.to_owned()).expect("TOML");
    for (key, value) in set {
        document.set_text(key, value).expect("a key");
    }
    Scenario::from_document(&document)
}

/// The planar body of a scenario.
pub fn body(scenario: &Scenario) -> &AxisModel {
    scenario.one_angle().expect("one angle")
}

/// The plan of a scenario.
pub fn plan(scenario: &Scenario) -> &Plan {
    scenario.plan.as_ref().expect("a plan")
}

/// The report of a scenario's plan, with a band of 10 %.
pub fn report(scenario: &Scenario) -> PlanReport {
    PlanReport::new(plan(scenario), body(scenario), 0.1)
}
