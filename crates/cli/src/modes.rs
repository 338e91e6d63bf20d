//! `flexsc modes`: a body's elastic modes, whichever way the scenario describes the body.

use std::io::Write;

use flexsc_core::analysis::modal::Modal;
use flexsc_core::body::Drive;
use serde_json::json;

use crate::failure::Failure;
use crate::scenario::Args;
use crate::{print, say};

/// The largest number of modes for which the weights of outputs are printed beside each other.
const WEIGHTS: usize = 12;

pub fn run(args: &Args) -> Result<(), Failure> {
    let scenario = args.load()?;
    let modal = Modal::of(&scenario.model);
    if args.json {
        let mut object = json!({ "scenario": scenario.name });
        if let (Some(object), Ok(serde_json::Value::Object(table))) =
            (object.as_object_mut(), serde_json::to_value(&modal))
        {
            object.extend(table);
        }
        return print(format!("{object}\n").as_bytes());
    }
    let hub = match modal.drive {
        Drive::Torque => "free",
        Drive::Motion => "held",
    };
    say!("{}   {} modes, hub {hub}", scenario.name, modal.gains.len());
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
        let frequency = other.1.as_ref().map_or_else(|| "none".to_owned(), |w| format!("{:.6}", w[index]));
        say!(
            "  {index:>5}{:>14.6}{:>12.4}{:>12.5}{:>12.5}{:>18.6e}{:>10.3}{:>14.6}{frequency:>12}",
            modal.frequencies_rad_s[index],
            modal.periods_s[index],
            modal.dampings[index],
            modal.gains[index],
            modal.excitabilities_s2[index],
            modal.excitabilities_s2[index].abs() / strongest,
            modal.effective_inertias_kg_m2[index],
        );
    }
    for output in &modal.outputs {
        let shown: Vec<_> =
            output.weights.iter().take(WEIGHTS).map(|weight| format!("{weight:.5}")).collect();
        let more = if output.weights.len() > WEIGHTS { " ..." } else { "" };
        let (name, unit, rigid) = (&output.name, &output.unit, output.rigid);
        say!("  output {name}, {unit}: {rigid} of the rigid angle, of the modes {}{more}", shown.join(" "));
    }
    Ok(())
}
