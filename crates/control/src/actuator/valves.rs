//! Valves of jets: which thrusters are open, their failures, and the propellant flow.

use flexsc_dynamics::wrench::{ForceEffect, Wrench};
use flexsc_numerics::attitude::Vector;
use flexsc_numerics::quantity::Finite;
use flexsc_numerics::time::Instant;

use super::failure::{ActiveFailures, Added, Failure, FailureScope};
use super::{Jets, Thruster, ThrusterEffect};

/// Thrusters of a body, each with its failures.
#[derive(Clone, Debug)]
pub(super) struct Valves {
    nozzles: Vec<ThrusterEffect>,
    failing: Vec<Option<ActiveFailures>>,
    /// Commanded opening of each thruster: 1, or the number of groups that open it.
    open: Vec<f64>,
    /// Propellant used (kg) until the time `since`, and the flow from then on (kg/s).
    fuel: f64,
    since: Instant,
    flow: f64,
    /// Propellant used by each thruster (kg), and its flow (kg/s).
    fuels: Vec<f64>,
    flows: Vec<f64>,
    /// Direction of the force that is commanded, zero for none, and the impulse along it until `since` (N s).
    commanded: Vector,
    impulse: f64,
}

impl Valves {
    /// Creates the closed valves of jets with these nozzles.
    pub fn new(jets: &Jets, nozzles: &[ThrusterEffect]) -> Self {
        let failing = |(nozzle, thruster): (&ThrusterEffect, &Thruster)| {
            let own = |scope: &FailureScope<'_>| scope.thruster.is_none_or(|name| name == thruster.name);
            // An added thrust is converted to a fraction of the thrust.
            let part = |failure: &Failure| match failure {
                Failure::Added(added) => {
                    let constant = Finite::new(added.constant.get() / nozzle.thrust).unwrap_or_default();
                    Failure::Added(Added { constant, ..added.clone() })
                }
                other => other.clone(),
            };
            ActiveFailures::new(&jets.faults.iter().map(part).collect::<Vec<_>>(), own)
        };
        Self {
            failing: nozzles.iter().zip(&jets.thrusters).map(failing).collect(),
            open: vec![0.0; nozzles.len()],
            nozzles: nozzles.to_vec(),
            fuel: 0.0,
            since: Instant::START,
            flow: 0.0,
            fuels: vec![0.0; nozzles.len()],
            flows: vec![0.0; nozzles.len()],
            commanded: Vector::zeros(),
            impulse: 0.0,
        }
    }

    /// Returns true if any thruster has failures.
    pub fn have_failures(&self) -> bool {
        self.failing.iter().any(Option::is_some)
    }

    /// Returns the next time at which a failure begins or ends.
    pub fn due(&self) -> Option<Instant> {
        self.failing.iter().flatten().filter_map(ActiveFailures::due).min()
    }

    /// Returns the time of the last change.
    pub fn last_change(&self) -> Instant {
        self.since
    }

    /// Returns each thruster with the fraction of its thrust.
    fn parts(&self) -> impl Iterator<Item = (&ThrusterEffect, f64)> {
        let force_of = |((nozzle, failing), open): ((_, &Option<ActiveFailures>), &f64)| {
            (nozzle, failing.as_ref().map_or(*open, |failing| failing.output(*open)))
        };
        self.nozzles.iter().zip(&self.failing).zip(&self.open).map(force_of)
    }

    /// Sets the opening of each valve from `now` on, and starts and ends failures.
    pub fn set_open(&mut self, now: Instant, open: impl Fn(usize) -> f64) {
        let seconds = now.since(self.since).seconds();
        self.fuel += self.flow * seconds;
        self.fuels.iter_mut().zip(&self.flows).for_each(|(fuel, flow)| *fuel += flow * seconds);
        self.impulse += self.along_command(|_| seconds);
        self.since = now;
        for (index, (own, failing)) in self.open.iter_mut().zip(&mut self.failing).enumerate() {
            *own = open(index);
            if let Some(failing) = failing {
                failing.update(now, *own);
            }
        }
        self.flows = self.parts().map(|(nozzle, part)| nozzle.flow * part).collect();
        self.flow = self.flows.iter().sum();
    }

    /// Returns the propellant used (kg) until `remaining` (s) after the last change, by thruster, without further
    /// changes.
    pub fn propellant(&self, remaining: impl Fn(usize) -> f64) -> f64 {
        let until =
            self.parts().enumerate().map(|(index, (nozzle, part))| nozzle.flow * part * remaining(index));
        self.fuel + until.sum::<f64>()
    }

    /// Returns the propellant used by each thruster (kg).
    pub fn fuels(&self, remaining: impl Fn(usize) -> f64) -> Vec<f64> {
        let consumed = |(index, (fuel, flow)): (usize, (&f64, &f64))| fuel + flow * remaining(index);
        self.fuels.iter().zip(&self.flows).enumerate().map(consumed).collect()
    }

    /// Sets the direction of the force that is commanded from the next change on; zero for none.
    pub fn set_commanded(&mut self, direction: Vector) {
        self.commanded = direction;
    }

    /// Returns the impulse of thrusters that stay open for these times (s), along the commanded force (N s).
    fn along_command(&self, seconds: impl Fn(usize) -> f64) -> f64 {
        if self.commanded == Vector::zeros() {
            return 0.0;
        }
        let along = |(index, (nozzle, part)): (usize, (&ThrusterEffect, f64))| {
            nozzle.push.force.dot(&self.commanded) * part * seconds(index)
        };
        self.parts().enumerate().map(along).sum()
    }

    /// Returns the impulse along the forces that were commanded (N s) until `remaining` (s) after the last change,
    /// without further changes.
    pub fn burn_impulse(&self, remaining: impl Fn(usize) -> f64) -> f64 {
        self.impulse + self.along_command(remaining)
    }

    /// Returns the current fraction of the thrust of each thruster.
    pub fn open_fractions(&self) -> Vec<f64> {
        self.parts().map(|(_, part)| part).collect()
    }

    /// Returns the torque about an axis (N m).
    pub fn torque(&self, axis: usize) -> f64 {
        self.parts().map(|(nozzle, part)| nozzle.push.torque[axis] * part).sum()
    }

    /// Adds the effect of the open thrusters to `onto`.
    pub fn exert(&self, onto: &mut Wrench) {
        for (nozzle, part) in self.parts().filter(|(_, part)| *part != 0.0) {
            onto.add_force_effect(&scaled(&nozzle.push, part));
        }
    }
}

/// Returns a push multiplied by a factor.
pub(super) fn scaled(effect: &ForceEffect, part: f64) -> ForceEffect {
    ForceEffect {
        torque: effect.torque * part,
        forces: effect.forces.iter().map(|force| force * part).collect(),
        force: effect.force * part,
        levers: effect.levers.iter().map(|lever| lever * part).collect(),
    }
}
