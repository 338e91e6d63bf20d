//! `flexsc modes`: frequencies, damping and excitability of a body's elastic modes.

use std::io::Write;

use serde_json::json;

use crate::failure::Failure;
use crate::scenario::Args;
use crate::{print, say};

pub fn run(args: &Args) -> Result<(), Failure> {
    let scenario = args.load()?;
    let modes = &scenario.model.modes;
    let strongest = modes.iter().map(|mode| mode.excitability().abs()).fold(0.0, f64::max);
    if args.json {
        let column = |value: &dyn Fn(&flexsc_core::body::Mode) -> f64| -> Vec<f64> {
            modes.iter().map(value).collect()
        };
        let object = json!({
            "scenario": scenario.name,
            "inertia_kg_m2": scenario.model.inertia.get(),
            "frequencies_rad_s": column(&|mode| mode.frequency.get()),
            "periods_s": column(&|mode| std::f64::consts::TAU / mode.frequency.get()),
            "dampings": column(&|mode| mode.damping.get()),
            "gains": column(&|mode| mode.gain.get()),
            "excitabilities_s2": column(&flexsc_core::body::Mode::excitability),
        });
        return print(format!("{object}\n").as_bytes());
    }
    say!("{}   {} modes", scenario.name, modes.len());
    say!(
        "  {:>5}{:>14}{:>12}{:>12}{:>12}{:>18}{:>10}",
        "mode",
        "frequency",
        "period",
        "damping",
        "gain",
        "excitability",
        "relative"
    );
    say!("  {:>5}{:>14}{:>12}{:>12}{:>12}{:>18}{:>10}", "", "rad/s", "s", "", "", "k/w², s²", "");
    for (index, mode) in modes.iter().enumerate() {
        let (w, excitability) = (mode.frequency.get(), mode.excitability());
        say!(
            "  {index:>5}{w:>14.6}{:>12.4}{:>12.5}{:>12.5}{excitability:>18.6e}{:>10.3}",
            std::f64::consts::TAU / w,
            mode.damping.get(),
            mode.gain.get(),
            excitability.abs() / strongest,
        );
    }
    Ok(())
}
