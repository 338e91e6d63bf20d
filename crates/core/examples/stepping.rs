//! Run in steps of one second: the program reads the angle and rate, and commands the torque of the next step.

#![allow(clippy::print_stdout, reason = "it prints the motion")]

use std::error::Error;

use flexsc_core::control::law::Command;
use flexsc_core::control::quantity::total_width;
use flexsc_core::numerics::time::Span;
use flexsc_core::{QuantityField, QuantityGroup, Scenario, Simulation};

/// Flexible body about one axis whose angle and rate are measured each second, with noise.
const SCENARIO: &str = "
    duration = 120.0
    [law.open]
    [body.planar]
    inertia = 100.0
    angle = 0.1
    modes = [{ frequency = 1.3, gain = 0.2, damping = 0.02 }]
    [sensor.sampled]
    period = 1.0
    noise = 1e-5
    rate_noise = 1e-6
";

/// Gains of the program's feedback (N m/rad, N m s/rad), and the limit of its torque (N m).
const GAINS: [f64; 2] = [1.0, 15.0];
const LIMIT: f64 = 0.05;

/// Returns the place of a measurement in the vector of observations.
fn measured(fields: &[QuantityField], name: &str) -> Option<usize> {
    let is_it = |field: &QuantityField| field.group == QuantityGroup::Measured && field.name == name;
    let index = fields.iter().position(is_it)?;
    Some(total_width(&fields[..index]))
}

fn main() -> Result<(), Box<dyn Error>> {
    let scenario = Scenario::parse("stepping.toml", SCENARIO)?;
    let mut simulation = Simulation::new(&scenario, 0);
    let fields = simulation.observation_fields(&scenario);
    let angle = measured(&fields, "angle").ok_or("no measured angle")?;
    let rate = measured(&fields, "rate").ok_or("no measured rate")?;
    let mut observation = vec![0.0; total_width(&fields)];

    // The first sample, at the start.
    simulation.open(&mut ())?;
    while !simulation.is_finished() {
        simulation.observe(&mut observation)?;
        let torque = -GAINS[0] * observation[angle] - GAINS[1] * observation[rate];
        // One command for each axis; a one-axis body takes the first.
        simulation.set_external_command([Command::Torque(torque.clamp(-LIMIT, LIMIT)); 3]);
        simulation.run_up_to(simulation.time() + Span::from_seconds(1.0), &mut ())?;
    }
    let state = simulation.state().ok_or("not a one-axis body")?;
    println!("The angle is {:.2e} rad after {} s.", state.angle(), simulation.time().seconds());
    Ok(())
}

#[test]
fn runs() -> Result<(), Box<dyn Error>> {
    main()
}
