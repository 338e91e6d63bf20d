//! Disturbance of a program during a run: its loads at points, as their effect on the body.

use flexsc_control::disturbance::{DisturbanceRun, DisturbanceSpec, PointLoad};
use flexsc_control::sensor::Truth;
use flexsc_dynamics::three_axis_model::ThreeAxisModel;
use flexsc_dynamics::wrench::{ForceEffect, Wrench};
use flexsc_numerics::random::Seed;
use flexsc_numerics::time::Instant;

use flexsc_scenario::Scenario;

/// Disturbance of a program, with the effect of its present loads.
#[derive(Clone, Debug)]
pub struct OwnDisturbance {
    pub run: Box<dyn DisturbanceRun>,
    loads: Vec<PointLoad>,
    /// Effects of unit torques and forces along the axes at each of its points. Empty for one axis.
    units: Vec<PointEffects>,
    /// Torque on the hub (N m), of a disturbance without points.
    hub: [f64; 3],
    /// Effect of the loads at points, unless it is nothing.
    push: Option<ForceEffect>,
}

/// Effects of unit loads at a point.
#[derive(Clone, Debug)]
struct PointEffects {
    /// Effects of torques (1 N m); empty if the torque acts on the hub.
    torques: Vec<ForceEffect>,
    /// Effects of forces (1 N).
    forces: Vec<ForceEffect>,
}

impl PointEffects {
    /// Returns the effects at a point of a body.
    fn new(body: &ThreeAxisModel, point: &str, has_torque: bool) -> Self {
        let unit = |part| ForceEffect::unit(body, point, part);
        let torques = if has_torque { (3..6).map(unit).collect() } else { Vec::new() };
        Self { torques, forces: (0..3).map(unit).collect() }
    }
}

impl OwnDisturbance {
    /// Creates the disturbance before its start.
    pub fn new(spec: &dyn DisturbanceSpec, scenario: &Scenario, seed: Seed) -> Self {
        let names = spec.points();
        let body = scenario.model.three_axis();
        let units = body.map_or_else(Vec::new, |body| {
            let first = || body.points.first().map_or("", |point| &point.name);
            if names.is_empty() {
                return vec![PointEffects::new(body, first(), false)];
            }
            names.iter().map(|point| PointEffects::new(body, point, true)).collect()
        });
        Self {
            run: spec.start(scenario.axis_count(), seed),
            loads: vec![PointLoad::default(); names.len().max(1)],
            units,
            hub: [0.0; 3],
            push: None,
        }
    }

    /// Acts at the start of the run, and where it is due.
    pub fn update(&mut self, now: Instant, truth: &Truth) {
        let due = self.run.due();
        if (now > Instant::START && due != Some(now)) || due.is_some_and(|due| due > now) {
            return;
        }
        self.run.act(now, truth, &mut self.loads);
        self.hub = [0.0; 3];
        let mut push: Option<ForceEffect> = None;
        let mut add = |effects: &[ForceEffect], load: [f64; 3]| {
            for (effect, size) in effects.iter().zip(load).filter(|(_, size)| *size != 0.0) {
                push.get_or_insert_default().add_scaled(effect, size);
            }
        };
        for (index, load) in self.loads.iter().enumerate() {
            let Some(PointEffects { torques, forces }) = self.units.get(index) else {
                self.hub = load.torque;
                continue;
            };
            if torques.is_empty() {
                self.hub = load.torque;
            }
            add(torques, load.torque);
            add(forces, load.force);
        }
        self.push = push;
    }

    /// Returns the torque about an axis (N m), that of forces about the centre of mass.
    pub fn torque(&self, axis: usize) -> f64 {
        self.hub[axis] + self.push.as_ref().map_or(0.0, |push| push.torque[axis])
    }

    /// Adds the loads to a wrench.
    pub fn apply(&self, onto: &mut Wrench) {
        for (hub, own) in onto.hub.iter_mut().zip(self.hub) {
            *hub += own;
        }
        if let Some(push) = &self.push {
            onto.add_force_effect(push);
        }
    }
}
