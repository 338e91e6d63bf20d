//! `flexsc modes`: a body's elastic modes, whichever way the scenario describes the body.

mod spacecraft;

use std::io::Write;

use flexsc_core::Scenario;
use flexsc_core::analysis::influence::Influences;
use flexsc_core::analysis::modal::ModalColumns;
use flexsc_core::analysis::parts::ModalParts;
use flexsc_core::attitude::AXES;
use flexsc_core::body::{Axes, Drive};
use flexsc_core::count::counted;
use serde_json::{Value as Json, json};

use crate::failure::Failure;
use crate::number::unsigned_zero;
use crate::results::{Results, of_scenario, show};
use crate::say;
use crate::scenario::Args;

/// The largest number of modes for which the weights of outputs are printed beside each other.
const WEIGHTS: usize = 12;

/// The modes of a body with one angle.
struct Planar {
    /// Name of the scenario.
    name: String,
    modal: ModalColumns,
}

/// The modes of a spatial body, and what its actuator does to them.
struct Spatial {
    /// Name of the scenario.
    name: String,
    modes: Influences,
    /// About which axes jets act; about others a torque of 1 N m is told.
    jets: [bool; 3],
}

/// The modes of a scenario's body.
pub fn results(scenario: &Scenario) -> Box<dyn Results> {
    let name = scenario.name.clone();
    if let Some(craft) = scenario.model.craft() {
        let (parts, jets) = (ModalParts::of(scenario, craft), scenario.study.fired);
        return Box::new(spacecraft::Spacecraft { name, parts, jets });
    }
    match scenario.model.axes() {
        Axes::Three(body) => {
            let (modes, jets) = (Influences::of(scenario, body), scenario.study.fired);
            Box::new(Spatial { name, modes, jets })
        }
        Axes::One(body) => Box::new(Planar { name, modal: ModalColumns::of(body) }),
    }
}

pub fn run(args: &Args) -> Result<(), Failure> {
    show(&*results(&args.load()?), None, args.json)
}

/// Prints what the actuator of a body with three axes does to its modes.
fn tell_influences(modes: &Influences, jets: [bool; 3]) {
    let giver = match jets {
        [true, true, true] => "the jets give",
        [false, false, false] => "a torque gives",
        _ => "the jets or a torque give",
    };
    for ((axis, [plus, minus]), jets) in AXES.iter().zip(modes.accelerations_rad_s2).zip(jets) {
        let of = if jets { "jets" } else { "1 N m" };
        say!("  {of}, {axis:<8} {plus:+.4e} {:+.4e} rad/s²", -minus);
    }
    say!("  influence: elastic rate at the gyro for each rigid rate that {giver} about the same axis");
    say!(
        "  {:>5}{:>14}{:>12}{:>12}{:>12}{:>12}{:>12}",
        "mode",
        "rad/s",
        "s",
        "damping",
        AXES[0],
        AXES[1],
        AXES[2]
    );
    for index in 0..modes.dampings.len() {
        let [roll, pitch, yaw] = [0, 1, 2].map(|axis: usize| unsigned_zero(modes.influences[axis][index], 5));
        say!(
            "  {index:>5}{:>14.6}{:>12.4}{:>12.5}{roll:>12}{pitch:>12}{yaw:>12}",
            modes.frequencies_rad_s[index],
            modes.periods_s[index],
            modes.dampings[index],
        );
    }
}

impl Results for Spatial {
    fn json(&self) -> Vec<Json> {
        vec![of_scenario(&self.name, json!(self.modes))]
    }

    fn tell(&self) -> Result<(), Failure> {
        let Self { name, modes, jets } = self;
        say!("{name}   {}", counted(modes.dampings.len(), "mode"));
        tell_influences(modes, *jets);
        Ok(())
    }
}

impl Results for Planar {
    fn json(&self) -> Vec<Json> {
        vec![of_scenario(&self.name, json!(self.modal))]
    }

    fn tell(&self) -> Result<(), Failure> {
        let Self { name, modal } = self;
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
        say!(
            "  {:>5}{:>14}{:>12}{:>12}{:>12}{:>18}{:>10}{:>14}{:>12}",
            "mode",
            "frequency",
            "period",
            "damping",
            "gain",
            "excitability",
            "relative",
            "inertia",
            other.0
        );
        say!(
            "  {:>5}{:>14}{:>12}{:>12}{:>12}{:>18}{:>10}{:>14}{:>12}",
            "",
            "rad/s",
            "s",
            "",
            "",
            "k/w², s²",
            "",
            "J k, kg m²",
            "rad/s"
        );
        for index in 0..modal.gains.len() {
            let frequency =
                other.1.as_ref().map_or_else(|| "none".to_owned(), |w| format!("{:.6}", w[index]));
            say!(
                "  {index:>5}{:>14.6}{:>12.4}{:>12.5}{:>12}{:>18.6e}{:>10.3}{:>14}{frequency:>12}",
                modal.frequencies_rad_s[index],
                modal.periods_s[index],
                modal.dampings[index],
                unsigned_zero(modal.gains[index], 5),
                modal.excitabilities_s2[index],
                modal.excitabilities_s2[index].abs() / strongest,
                unsigned_zero(modal.effective_inertias_kg_m2[index], 6),
            );
        }
        for output in &modal.outputs {
            let shown: Vec<_> =
                output.weights.iter().take(WEIGHTS).map(|weight| unsigned_zero(*weight, 5)).collect();
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
