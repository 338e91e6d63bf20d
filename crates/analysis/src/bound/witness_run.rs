//! Scenario of a witness: the body from the state at the start of the witness, under its inputs as disturbances.

use flexsc_control::quantity::total_width;
use flexsc_formats::document::Document;
use flexsc_numerics::attitude::AXES;
use flexsc_numerics::quantity::Finite;
use flexsc_numerics::time::Instant;
use flexsc_spacecraft::body::{Body, Drive};
use toml::{Table, Value};

use super::witness::{InputHistory, Witness};
use crate::linear_model::LinearModel;
use flexsc_scenario::{Scenario, ScenarioSpec};
use flexsc_sim::Simulation;

/// Parts of a scenario that a witness keeps.
const KEPT: [&str; 7] = ["name", "about", "seed", "body", "spacecraft", "appendage", "epoch"];

/// Largest number of disturbances of a witness.
const MOST_PIECES: usize = 10_000;

/// Returns the scenario of a witness; `None` if its inputs are no torques, or its modes no keys of a scenario.
pub fn scenario(own: &Scenario, model: &LinearModel, witness: &Witness) -> Option<Scenario> {
    // The rotors of wheels belong to the body; other actuators do not take a law without commands.
    let parts = [&KEPT[..], &[&KEPT[..], &["actuator"]].concat()].map(<[&str]>::to_vec);
    parts.iter().find_map(|kept| with_parts(own, model, witness, kept))
}

/// Returns the scenario of a witness with these parts of the scenario; `None` if it has another linear model.
fn with_parts(own: &Scenario, model: &LinearModel, witness: &Witness, kept: &[&str]) -> Option<Scenario> {
    let pieces: usize = witness.inputs.iter().map(|input| input.values.len()).sum();
    if !is_driven_by_torques(own) || pieces > MOST_PIECES {
        return None;
    }
    let written: ScenarioSpec = own.self_contained();
    let mut table: Table =
        written.to_table().into_iter().filter(|(key, _)| kept.contains(&key.as_str())).collect();
    let name = format!("{}-witness", own.name);
    table.insert("name".to_owned(), name.clone().into());
    table.insert("duration".to_owned(), witness.time_s.into());
    table.insert("law".to_owned(), Table::from_iter([("open".to_owned(), Table::new().into())]).into());
    let disturbances: Vec<Value> = witness.inputs.iter().flat_map(disturbances).collect();
    if !disturbances.is_empty() {
        table.insert("disturbance".to_owned(), disturbances.into());
    }
    let started = Start { witness, model };
    match &written.body {
        Some(Body::Planar(_)) => started.set_planar(body(&mut table, "planar")?)?,
        Some(Body::Spatial(_)) => started.set_spatial(body(&mut table, "spatial")?)?,
        None if witness.frequency_factor == 1.0 && witness.damping_factor == 1.0 => {
            started.set_rigid(table.get_mut("spacecraft")?.as_table_mut()?)?;
        }
        _ => return None,
    }
    let mut scenario = Scenario::from_document(&Document::from_table(&name, table)).ok()?;
    if written.body.is_none() {
        // No key of a spacecraft names its free modes.
        let modes = &mut scenario.model.three_axis_mut()?.modes;
        for (index, mode) in modes.iter_mut().enumerate() {
            mode.displacement = Finite::new(started.state(&format!("mode{index}_displacement"))?)?;
            mode.rate = Finite::new(started.state(&format!("mode{index}_rate"))?)?;
        }
    }
    // The disturbances act as the inputs of the model do, unless these are jets.
    let same = LinearModel::for_runs(&scenario).ok()?;
    (witness.frequency_factor != 1.0
        || witness.damping_factor != 1.0
        || same.a == model.a && same.b == model.b)
        .then_some(scenario)
}

/// Returns true if the keys of a scenario give its state at the start: those of a spacecraft do not name its modes.
pub fn is_written(scenario: &Scenario) -> bool {
    let at_rest = || {
        let modes = scenario.model.three_axis().map(|body| body.modes.as_slice()).unwrap_or_default();
        modes.iter().all(|mode| mode.displacement.get() == 0.0 && mode.rate.get() == 0.0)
    };
    scenario.body.is_some() || at_rest()
}

/// Returns the state of the linear model at the end of a run of a witness; `None` if the run fails.
pub fn final_state(scenario: &Scenario, model: &LinearModel) -> Option<Vec<f64>> {
    let mut simulation = Simulation::new(scenario, 0);
    let end = Instant::START + scenario.duration;
    simulation.run_up_to(end, &mut ()).ok()?;
    let fields = simulation.observation_fields(scenario);
    let mut row = vec![0.0; total_width(&fields)];
    simulation.observe(&mut row).ok()?;
    let mut place = 0;
    let mut values = |name: &str| -> Option<Vec<f64>> {
        place = 0;
        for field in &fields {
            if field.name == name {
                return Some(row[place..place + field.width()].to_vec());
            }
            place += field.width();
        }
        None
    };
    let (displacements, rates) = (values("modes")?, values("mode_rates")?);
    let rigid_rates = values("rigid_rate")?;
    let angles = match values("rigid_angle") {
        Some(angle) => angle,
        None => hub_angles(scenario, &displacements, &values("error")?),
    };
    let axes: Vec<String> = if angles.len() == 1 {
        vec!["rigid_angle".to_owned()]
    } else {
        AXES.iter().map(|axis| format!("rigid_{axis}")).collect()
    };
    let state = |signal: &str| -> Option<f64> {
        if let Some(axis) = axes.iter().position(|name| name == signal) {
            return angles.get(axis).copied();
        }
        if signal == "rigid_rate" {
            return rigid_rates.first().copied();
        }
        if let Some(axis) = axes.iter().position(|name| format!("{name}_rate") == signal) {
            return rigid_rates.get(axis).copied();
        }
        let (mode, part) = signal.strip_prefix("mode")?.split_once('_')?;
        let mode: usize = mode.parse().ok()?;
        if part == "rate" { rates.get(mode).copied() } else { displacements.get(mode).copied() }
    };
    model.states.iter().map(|signal| state(&signal.name)).collect()
}

/// Returns the angles of the rigid rotation: the error of the hub without its rotation by the modes.
fn hub_angles(scenario: &Scenario, displacements: &[f64], error: &[f64]) -> Vec<f64> {
    let coupling = scenario.model.three_axis().and_then(|body| body.coupling.as_ref());
    let rotation = |axis: usize| -> f64 {
        let rotations = coupling.iter().flat_map(|coupling| &coupling.rotations);
        rotations.zip(displacements).map(|(rotation, displacement)| rotation[axis] * displacement).sum()
    };
    error.iter().enumerate().map(|(axis, angle)| angle - rotation(axis)).collect()
}

/// Returns true if the inputs of the model are torques, and not a given motion of the hub.
fn is_driven_by_torques(scenario: &Scenario) -> bool {
    scenario.model.one_axis().is_none_or(|body| Drive::from(body.drive) == Drive::Torque)
}

/// Returns the disturbances of an input: each from one switching to the next.
fn disturbances(input: &InputHistory) -> Vec<Value> {
    let pieces = input.times_s.iter().zip(&input.values).enumerate();
    let pieces = pieces.filter(|(_, (_, value))| **value != 0.0).map(|(index, (from, value))| {
        let mut piece = Table::new();
        if let Some(axis) = input.name.strip_prefix("torque_") {
            piece.insert("about".to_owned(), axis.into());
        }
        piece.insert("torque".to_owned(), (*value).into());
        piece.insert("from".to_owned(), (*from).into());
        if let Some(to) = input.times_s.get(index + 1) {
            piece.insert("to".to_owned(), (*to).into());
        }
        piece.into()
    });
    pieces.collect()
}

/// Returns the table of a body.
fn body<'a>(table: &'a mut Table, kind: &str) -> Option<&'a mut Table> {
    table.get_mut("body")?.as_table_mut()?.get_mut(kind)?.as_table_mut()
}

/// State at the start of a witness, to be written in a scenario.
struct Start<'a> {
    witness: &'a Witness,
    model: &'a LinearModel,
}

impl Start<'_> {
    fn state(&self, name: &str) -> Option<f64> {
        let index = self.model.states.iter().position(|signal| signal.name == name)?;
        self.witness.start.get(index).copied()
    }

    fn set_planar(&self, body: &mut Table) -> Option<()> {
        body.insert("angle".to_owned(), self.state("rigid_angle")?.into());
        body.insert("rate".to_owned(), self.state("rigid_rate")?.into());
        self.set_modes(body)
    }

    fn set_spatial(&self, body: &mut Table) -> Option<()> {
        self.set_rigid(body)?;
        self.set_modes(body)
    }

    fn set_rigid(&self, body: &mut Table) -> Option<()> {
        let all = |suffix: &str| -> Option<Vec<Value>> {
            AXES.iter().map(|axis| Some(self.state(&format!("rigid_{axis}{suffix}"))?.into())).collect()
        };
        for key in ["rate_error", "attitude", "small_angles", "disturbance"] {
            body.remove(key);
        }
        body.insert("attitude_error".to_owned(), all("")?.into());
        body.insert("rate".to_owned(), all("_rate")?.into());
        Some(())
    }

    fn set_modes(&self, body: &mut Table) -> Option<()> {
        let Some(modes) = body.get_mut("modes").and_then(Value::as_array_mut) else { return Some(()) };
        for (index, mode) in modes.iter_mut().enumerate() {
            let mode = mode.as_table_mut()?;
            mode.insert("displacement".to_owned(), self.state(&format!("mode{index}_displacement"))?.into());
            mode.insert("rate".to_owned(), self.state(&format!("mode{index}_rate"))?.into());
            for (key, factor) in
                [("frequency", self.witness.frequency_factor), ("damping", self.witness.damping_factor)]
            {
                let value = mode.get(key).and_then(Value::as_float).unwrap_or(0.0);
                mode.insert(key.to_owned(), (value * factor).into());
            }
        }
        Some(())
    }
}
