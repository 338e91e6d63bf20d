//! Loads on the body: the actuator, which executes the laws and the manoeuvre, disturbances, and the environment.

use crate::actuator::Actuate;
use crate::belief::Belief;
use crate::body::Drift;
use crate::disturbance::{Disturbance, Disturbing};
use crate::environment::Around;
use crate::law::{Command, TorqueDistribution};
use crate::random::Seed;
use crate::scenario::Scenario;
use crate::time::{Instant, Span};
use crate::wrench::Wrench;

/// Everything that acts on the body.
#[derive(Clone, Debug)]
pub struct Loads {
    /// Run-time state of the actuator.
    pub actuator: Box<dyn Actuate>,
    distribution: TorqueDistribution,
    disturbances: Vec<Disturbing>,
    /// Instants, latest first, at which the waveform has a break, a disturbance or the environment changes, the
    /// frequency drift has a kink, or the appendage drives reach the angles at which the modes are replaced.
    edges: Vec<Instant>,
    /// Next instant of `edges`, or of the random changes of disturbances.
    edge: Option<Instant>,
    /// Next instant at which a load changes without a command.
    pub due: Option<Instant>,
    wrench: Wrench,
}

impl Loads {
    /// Creates the loads of a scenario, before its start.
    pub fn new(scenario: &Scenario, seed: Seed) -> Self {
        let at = |t: f64| Instant::START + Span::from_seconds(t);
        let breaks = scenario.plan.iter().flat_map(|plan| plan.waveform.breaks()).map(at);
        let kinks = scenario.drift.iter().flat_map(Drift::kinks).map(at);
        let disturbed = scenario.disturbance.iter().flat_map(Disturbance::edges);
        let around = scenario.study.around.iter().flat_map(Around::edges);
        let turned = scenario.study.drives.iter().flat_map(|drives| &drives.courses.changes);
        let turned = turned.map(|(at, _)| *at).filter(|at| *at > Instant::START);
        let mut edges: Vec<Instant> =
            breaks.chain(disturbed).chain(kinks).chain(around).chain(turned).collect();
        edges.sort_by(|a, b| b.cmp(a));
        edges.dedup();
        let stream = |index: usize| seed.stream(&format!("disturbance {index}"));
        let disturbances = scenario.disturbance.iter().enumerate();
        let mut drive = Self {
            actuator: scenario.study.actuator(scenario, seed),
            distribution: scenario.study.distribution(scenario),
            disturbances: disturbances
                .map(|(index, of)| Disturbing::new(of, scenario.model.spatial(), stream(index)))
                .collect(),
            edges,
            edge: None,
            due: None,
            wrench: Wrench::default(),
        };
        drive.look_ahead();
        drive
    }

    /// Finds the next instant at which a load changes.
    fn look_ahead(&mut self) {
        let drawn = self.disturbances.iter().filter_map(Disturbing::due).min();
        self.edge = self.edges.last().copied().into_iter().chain(drawn).min();
        self.due = self.edge.into_iter().chain(self.actuator.due()).min();
    }

    /// Applies the commands of the laws from `now` on, given the state estimates and the rigid rates (rad/s).
    pub fn command(&mut self, now: Instant, commands: [Command; 3], beliefs: &[Belief], rigid: [f64; 3]) {
        let actuator = &mut self.actuator;
        let demands = self.distribution.demands(commands, beliefs, || actuator.stored(now));
        actuator.command(now, &demands, rigid);
        self.due = self.edge.into_iter().chain(actuator.due()).min();
    }

    /// Applies the changes of loads that are due at `now`, after the laws have decided, given the rigid rates (rad/s).
    pub fn serve(&mut self, now: Instant, rigid: [f64; 3]) {
        while self.edges.last().is_some_and(|edge| *edge <= now) {
            self.edges.pop();
        }
        self.disturbances.iter_mut().for_each(|disturbance| disturbance.serve(now));
        self.actuator.serve(now, rigid);
        self.look_ahead();
    }

    /// Returns the wrench of all loads from `now` on.
    pub fn wrench(&mut self, now: Instant) -> &Wrench {
        self.wrench.clear();
        self.actuator.exert(now, &mut self.wrench);
        if !self.disturbances.is_empty() {
            for axis in 0..3 {
                self.wrench.hub[axis] += self.sum(|disturbance| disturbance.on_hub(now, axis));
            }
            for disturbance in &self.disturbances {
                disturbance.push(now, &mut self.wrench);
            }
        }
        &self.wrench
    }

    /// Returns the wrench of the actuator alone from `now` on.
    pub fn commanded(&self, now: Instant) -> Wrench {
        let mut wrench = Wrench::default();
        self.actuator.exert(now, &mut wrench);
        wrench
    }

    /// Returns the torque of all disturbances about an axis (N m).
    pub fn disturbance(&self, now: Instant, axis: usize) -> f64 {
        self.sum(|disturbance| disturbance.torque(now, axis))
    }

    fn sum(&self, of: impl Fn(&Disturbing) -> f64) -> f64 {
        self.disturbances.iter().map(of).sum()
    }
}
