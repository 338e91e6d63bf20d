//! `flexsc modes`: the elastic modes of a body, for every kind of body in a scenario.

mod spacecraft;

use std::io::Write;

use flexsc_core::analysis::body_poles::WhirlPoles;
use flexsc_core::analysis::mode_influence::ModeInfluences;
use flexsc_core::analysis::one_axis_modes::OneAxisModes;
use flexsc_core::analysis::spacecraft_modes::SpacecraftModes;
use flexsc_core::formats::count::counted;
use flexsc_core::numerics::attitude::AXES;
use flexsc_core::spacecraft::body::{BodyAxes, Drive};
use flexsc_core::{Scenario, ScenarioError};
use serde_json::{Value as Json, json};

use crate::error::CliError;
use crate::human::{Units, UnitsArgs, digits};
use crate::number::unsigned_zero;
use crate::quantity::in_unit;
use crate::results::{Results, show, with_scenario_name};
use crate::row_table::print_table;
use crate::{say, scenario};

/// Largest number of modes for which the weights of outputs are printed side by side.
const WEIGHTS: usize = 12;

#[derive(clap::Args)]
pub struct ModesArgs {
    #[command(flatten)]
    pub scenario: scenario::ScenarioArgs,
    /// Print every influence, also those below 1e-3 of the largest
    #[arg(long)]
    all: bool,
    /// Speed of the wheels that points of the structure carry (rad/s), for the poles with whirl [default: each at its speed at the start]
    #[arg(long, value_name = "SPEED", value_parser = in_unit("rad/s"))]
    speed: Option<f64>,
    #[command(flatten)]
    units: UnitsArgs,
}

/// Influences below this fraction of the largest are not printed.
const SMALL: f64 = 1e-3;

/// Style in which modes are printed.
#[derive(Copy, Clone)]
struct Style {
    units: Units,
    /// True if small influences are printed too.
    all: bool,
}

/// Modes of a single-axis body.
struct OneAxisTable {
    /// Name of the scenario.
    name: String,
    modal: OneAxisModes,
    style: Style,
}

/// Modes of a three-axis body, and the influence of its actuator on them.
struct ThreeAxisTable {
    /// Name of the scenario.
    name: String,
    modes: ModeInfluences,
    /// True for each axis with jets; for the other axes the influence of a torque of 1 N m is printed.
    jets: [bool; 3],
    style: Style,
}

/// Computes the modes of a scenario's body.
pub fn results(scenario: &Scenario, args: &ModesArgs) -> Result<Box<dyn Results>, CliError> {
    let name = scenario.name.clone();
    let whirl = WhirlPoles::from_scenario(scenario, args.speed).map_err(|fault| ScenarioError::Key {
        origin: name.clone(),
        key: fault.key,
        why: fault.why,
    })?;
    if args.speed.is_some() && whirl.is_none() {
        let why =
            format!("--speed: {name} has no `actuator.wheels.points` on a part that moves against the hub");
        return Err(CliError::Arguments(why));
    }
    let style = Style { units: args.units.units, all: args.all };
    if let Some(craft) = scenario.model.spacecraft() {
        let (parts, jets) = (SpacecraftModes::from_scenario(scenario, craft), scenario.study.jet_only_axes);
        return Ok(Box::new(spacecraft::Spacecraft { name, parts, whirl, jets, style }));
    }
    Ok(match scenario.model.axes() {
        BodyAxes::Three(body) => {
            let (modes, jets) = (ModeInfluences::from_scenario(scenario, body), scenario.study.jet_only_axes);
            Box::new(ThreeAxisTable { name, modes, jets, style })
        }
        BodyAxes::One(body) => Box::new(OneAxisTable { name, modal: OneAxisModes::from_body(body), style }),
    })
}

pub fn run(args: &ModesArgs) -> Result<(), CliError> {
    show(&*results(&args.scenario.load()?, args)?, None, args.scenario.json)
}

fn texts(words: &[&str]) -> Vec<String> {
    words.iter().map(|word| (*word).to_owned()).collect()
}

/// Returns the columns of a mode's frequency, period and damping.
fn frequency(units: Units, frequency: f64, damping: f64) -> [String; 3] {
    [digits(frequency * units.frequency().0), digits(std::f64::consts::TAU / frequency), digits(damping)]
}

/// Prints the influence of a three-axis body's actuator on its modes.
fn print_influences(modes: &ModeInfluences, jets: [bool; 3], style: Style) {
    let actuator = match jets {
        [true, true, true] => "the jets give",
        [false, false, false] => "a torque gives",
        _ => "the jets or a torque give",
    };
    let largest =
        modes.accelerations_rad_s2.as_flattened().iter().fold(0.0, |most: f64, own| most.max(own.abs()));
    let unit = style.units.0.fitting(largest, "rad/s²");
    let mut rows = vec![texts(&["acceleration of the hub", "positive", "negative", &unit.name])];
    for ((axis, [plus, minus]), jets) in AXES.iter().zip(modes.accelerations_rad_s2).zip(jets) {
        let by = if jets { "by the jets" } else { "by a torque of 1 N m" };
        rows.push(vec![format!("{axis}, {by}"), unit.number(plus), unit.number(-minus), String::new()]);
    }
    print_table(&rows, 0);
    if modes.dampings.is_empty() {
        return;
    }
    say!("  influence: elastic rate at the gyro for each rigid rate that {actuator} about the same axis");
    let mut rows = vec![texts(&["mode", &style.units.frequency().1, "period, s", "damping"])];
    rows[0].extend(AXES.map(str::to_owned));
    for index in 0..modes.dampings.len() {
        let mut row = vec![index.to_string()];
        row.extend(frequency(style.units, modes.frequencies_rad_s[index], modes.dampings[index]));
        row.extend([0, 1, 2].map(|axis: usize| unsigned_zero(modes.influences[axis][index], 5)));
        rows.push(row);
    }
    print_table(&rows, 0);
}

impl Results for ThreeAxisTable {
    fn json(&self) -> Vec<Json> {
        vec![with_scenario_name(&self.name, json!(self.modes))]
    }

    fn print(&self) -> Result<(), CliError> {
        let Self { name, modes, jets, style } = self;
        say!("{name}   {}", counted(modes.dampings.len(), "mode"));
        print_influences(modes, *jets, *style);
        Ok(())
    }
}

impl Results for OneAxisTable {
    fn json(&self) -> Vec<Json> {
        vec![with_scenario_name(&self.name, json!(self.modal))]
    }

    fn print(&self) -> Result<(), CliError> {
        let Self { name, modal, style } = self;
        let hub = match modal.drive {
            Drive::Torque => "free",
            Drive::Motion => "held",
        };
        say!("{name}   {}, hub {hub}", counted(modal.gains.len(), "mode"));
        let strongest = modal.excitabilities_s2.iter().fold(0.0, |most: f64, e| most.max(e.abs()));
        let other = match modal.drive {
            Drive::Torque => ("hub held", &modal.clamped_frequencies_rad_s),
            Drive::Motion => ("hub free", &modal.free_frequencies_rad_s),
        };
        let (factor, unit) = style.units.frequency();
        // The gains may be those of a load; the effective inertias are those of a torque on the hub.
        let mut gains = modal.gains.iter().zip(&modal.effective_inertias_kg_m2);
        let is_elsewhere = gains.any(|(gain, effective)| modal.inertia_kg_m2 * gain != *effective);
        let effective = if is_elsewhere { "at hub, kg m²" } else { "J k, kg m²" };
        let mut rows = vec![
            texts(&[
                "mode",
                "frequency",
                "period",
                "damping",
                "gain",
                "excitability",
                "relative",
                "inertia",
                other.0,
            ]),
            texts(&["", &unit, "s", "", "", "k/w², s²", "", effective, &unit]),
        ];
        for index in 0..modal.gains.len() {
            let mut row = vec![index.to_string()];
            row.extend(frequency(style.units, modal.frequencies_rad_s[index], modal.dampings[index]));
            let excitability = modal.excitabilities_s2[index];
            let numbers = [
                modal.gains[index],
                excitability,
                excitability.abs() / strongest,
                modal.effective_inertias_kg_m2[index],
            ];
            row.extend(numbers.map(digits));
            row.push(other.1.as_ref().map_or_else(|| "none".to_owned(), |w| digits(w[index] * factor)));
            rows.push(row);
        }
        print_table(&rows, 0);
        for output in &modal.outputs {
            let shown: Vec<_> = output.weights.iter().take(WEIGHTS).map(|weight| digits(*weight)).collect();
            let more = if output.weights.len() > WEIGHTS { " ..." } else { "" };
            let (name, unit, rigid) = (&output.name, &output.unit, output.rigid);
            say!(
                "  output {name}, {unit}: {rigid} of the rigid angle, of the modes {}{more}",
                shown.join(" ")
            );
        }
        Ok(())
    }
}
