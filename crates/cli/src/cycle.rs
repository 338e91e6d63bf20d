//! `flexsc cycle`: limit cycles of a relay on a rigid body in closed form and by the describing function, and their
//! resonances with the modes; those of a linear law with pulses by the describing function.

use std::io::Write;

use flexsc_core::analysis::describing_function::{DescribedCycle, RelayDescribingFunction};
use flexsc_core::analysis::pulse_describing_function::PulsedLoop;
use flexsc_core::analysis::rigid_cycle::{Resonance, RigidCycle, cycles, resonances};
use flexsc_core::control::law::RelaySides;
use flexsc_core::{Scenario, ScenarioError};
use serde_json::{Value as Json, json};

use crate::error::CliError;
use crate::human::{Units, UnitsArgs, digits};
use crate::results::{Results, show};
use crate::{say, scenario};

/// Number of resonances that are printed for each mode.
const NEAREST: usize = 3;

#[derive(clap::Args)]
pub struct CycleArgs {
    #[command(flatten)]
    pub scenario: scenario::ScenarioArgs,
    #[command(flatten)]
    units: UnitsArgs,
}

/// Limit cycles of a scenario's relay law, and their resonances.
pub struct RelayCycles {
    /// Name of the scenario.
    name: String,
    k_t: f64,
    /// Unit of an impulse.
    unit: &'static str,
    cycles: Vec<RigidCycle>,
    /// Cycles that the describing function predicts; none for a law with one side.
    described: Option<Vec<DescribedCycle>>,
    /// Sides of the law, whose cycle the resonances are of.
    sides: RelaySides,
    resonances: Vec<Resonance>,
    units: Units,
}

/// Computes the limit cycles of a scenario's relay law on a rigid body.
pub fn results(scenario: &Scenario, args: &CycleArgs) -> Result<RelayCycles, CliError> {
    let body = scenario.one_angle()?;
    let Some(law) = scenario.law.relay() else {
        return Err(CliError::Arguments(format!(
            "{}: limit cycles are computed for a law `relay`, and for a linear law with `[actuator.thrusters]`",
            scenario.name
        )));
    };
    if scenario.actuator.flywheel().is_some() {
        return Err(CliError::Arguments(format!(
            "{}: limit cycles are computed for an ideal torque, not for a wheel",
            scenario.name
        )));
    }
    let (name, k_t) = (scenario.name.clone(), law.k_t.get());
    let unit = if body.has_unit_inertia() { "rad/s" } else { "N m s" };
    let (cycles, resonances) = (cycles(law, body, k_t), resonances(law, body));
    let described = RelayDescribingFunction::new(law, body, k_t).map(|function| function.cycles());
    Ok(RelayCycles {
        name,
        k_t,
        unit,
        cycles,
        described,
        sides: law.sides,
        resonances,
        units: args.units.units,
    })
}

pub fn run(args: &CycleArgs) -> Result<(), CliError> {
    let scenario = args.scenario.load()?;
    if scenario.law.relay().is_none() && scenario.actuator.thrusters().is_some() {
        return show(&pulsed(&scenario, args)?, None, args.scenario.json);
    }
    show(&results(&scenario, args)?, None, args.scenario.json)
}

/// Limit cycles of a scenario with pulses.
struct PulsedCycles {
    name: String,
    pulsed: PulsedLoop,
    units: Units,
}

/// Predicts the limit cycles of a scenario's linear law with thrusters.
fn pulsed(scenario: &Scenario, args: &CycleArgs) -> Result<PulsedCycles, CliError> {
    scenario.one_angle()?;
    let name = scenario.name.clone();
    let pulsed = PulsedLoop::from_scenario(scenario).map_err(|fault| ScenarioError::Key {
        origin: name.clone(),
        key: fault.key,
        why: fault.why,
    })?;
    Ok(PulsedCycles { name, pulsed, units: args.units.units })
}

impl Results for PulsedCycles {
    fn json(&self) -> Vec<Json> {
        vec![json!({
            "scenario": self.name,
            "crossings": self.pulsed.crossings,
            "described": self.pulsed.cycles,
        })]
    }

    fn print(&self) -> Result<(), CliError> {
        let Self { name, pulsed, units } = self;
        say!("{name}   pulses of a sampled linear law, with the modes");
        let (factor, unit) = units.frequency();
        for crossing in &pulsed.crossings {
            let (frequency, gain) = (digits(crossing.frequency_rad_s * factor), digits(crossing.factor));
            say!("  limit of stability at {frequency} {unit} with {gain} times the gain of held torques");
        }
        for cycle in &pulsed.cycles {
            let stability = if cycle.stable { "stable" } else { "unstable" };
            say!("  the describing function predicts a cycle, {stability}");
            say!("    period         {} s", digits(cycle.period_s));
            say!("    demand         amplitude of {}", units.quantity(cycle.torque_amplitude_nm, "N m"));
        }
        if pulsed.cycles.is_empty() {
            say!("  the describing function predicts no cycle");
        }
        Ok(())
    }
}

impl Results for RelayCycles {
    fn json(&self) -> Vec<Json> {
        let Self { name, k_t, cycles, described, resonances, .. } = self;
        vec![json!({
            "scenario": name,
            "k_t": k_t,
            "cycles": cycles,
            "described": described,
            "resonances": resonances,
        })]
    }

    fn print(&self) -> Result<(), CliError> {
        let Self { name, k_t, unit, cycles, described, sides, resonances, units } = self;
        say!("{name}   k_t = {k_t}, modes left out");
        if cycles.is_empty() {
            say!("  no limit cycle exists");
        }
        let time = |of: f64| format!("{} s", digits(of));
        for cycle in cycles {
            let kind = described_sides(cycle.sides);
            let stability = if cycle.stable { "stable" } else { "unstable" };
            say!("  {kind} cycle, {stability}: multiplier {:.4}", cycle.multiplier);
            say!("    period         {}", time(cycle.period_s));
            say!("    push           {}", time(cycle.push_s));
            say!("    brake          {}", time(cycle.brake_s));
            say!("    coast          {}", time(cycle.coast_s));
            say!("    entry rate     {}", units.quantity(cycle.entry_rate_rad_s, "rad/s"));
            let ends = [cycle.angle_min_rad, cycle.angle_max_rad];
            say!("    angle          {}", units.list(&ends, " to ", "rad"));
            say!("    duty           {:.4} under strong torque", cycle.duty);
            say!("    impulse        {} per hour", units.quantity(cycle.impulse_per_hour_nm_s, unit));
        }
        for cycle in described.iter().flatten() {
            let stability = if cycle.stable { "stable" } else { "unstable" };
            say!("  the describing function predicts a cycle, {stability}");
            say!("    period         {}", time(cycle.period_s));
            say!("    amplitude      {}", units.quantity(cycle.amplitude_rad, "rad"));
        }
        if described.as_ref().is_some_and(Vec::is_empty) {
            say!("  the describing function predicts no cycle");
        }
        if !resonances.is_empty() {
            say!(
                "  resonances of the {} cycle, the {NEAREST} nearest of each mode (all with --json):",
                described_sides(*sides)
            );
        }
        for r in nearest(resonances, *k_t) {
            say!(
                "    mode {}, harmonic {:>2}: period {} s at k_t = {:.6}",
                r.mode,
                r.harmonic,
                digits(r.period_s),
                r.k_t
            );
        }
        Ok(())
    }
}

/// Returns the adjective for a cycle with these sides.
fn described_sides(sides: RelaySides) -> &'static str {
    match sides {
        RelaySides::Two => "two-sided",
        RelaySides::One => "one-sided",
    }
}

/// Returns the resonances of each mode that are nearest to the gain `k_t`, in the order of the gains.
fn nearest(resonances: &[Resonance], k_t: f64) -> Vec<Resonance> {
    let modes = resonances.iter().map(|r| r.mode + 1).max().unwrap_or(0);
    let values_of_mode = |mode| {
        let mut own: Vec<Resonance> = resonances.iter().filter(|r| r.mode == mode).copied().collect();
        own.sort_by(|a, b| (a.k_t - k_t).abs().total_cmp(&(b.k_t - k_t).abs()));
        own.truncate(NEAREST);
        own.sort_by(|a, b| a.k_t.total_cmp(&b.k_t));
        own
    };
    (0..modes).flat_map(values_of_mode).collect()
}
