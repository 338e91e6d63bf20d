//! Loads on the body: the actuator, which executes the laws and the manoeuvre, disturbances, and the environment.

use flexsc_control::actuator::{Actuator, ActuatorEvent, AxisEffort};
use flexsc_control::law::{Command, TorqueDistribution};
use flexsc_control::sensor::Truth;
use flexsc_control::state_estimate::{StateEstimate, estimated_rates};
use flexsc_dynamics::frequency_drift::FrequencyDrift;
use flexsc_dynamics::wrench::Wrench;
use flexsc_numerics::attitude::Vector;
use flexsc_numerics::random::Seed;
use flexsc_numerics::time::{Instant, Span, earlier};
use flexsc_spacecraft::disturbance::{Disturbance, DisturbanceState};
use flexsc_spacecraft::environment::SurroundingsState;

use super::own_disturbance::OwnDisturbance;
use super::plant::{AppliedTorque, Plant};
use flexsc_scenario::Scenario;

/// Everything that acts on the body.
#[derive(Clone, Debug)]
pub struct Loads {
    /// Run-time state of the actuator.
    pub actuator: Box<dyn Actuator>,
    distribution: TorqueDistribution,
    disturbances: Vec<DisturbanceState>,
    /// Disturbances of a program.
    pub own: Vec<OwnDisturbance>,
    /// Instants, latest first, at which the waveform has a break, a disturbance or the environment changes, the
    /// frequency drift has a kink, or the appendage drives reach the angles at which the modes are replaced.
    scheduled_changes: Vec<Instant>,
    /// Key of measured paths, with which there is no run.
    measured_path: Option<String>,
    /// Next instant of `scheduled_changes`, or of a random change of a disturbance.
    next_change: Option<Instant>,
    /// Next instant at which a load changes without a command.
    pub due: Option<Instant>,
    wrench: Wrench,
    /// External torque about each axis (N m).
    external_torque: [f64; 3],
    /// Torques during the current motion segment of a one-axis body.
    pub applied: AppliedTorque,
    /// Reduced moment about the first axis in the current motion segment (rad/s²).
    pub first_moment: f64,
}

impl Loads {
    /// Creates the loads of a scenario, before its start.
    pub fn new(scenario: &Scenario, seed: Seed) -> Self {
        let at = |t: f64| Instant::START + Span::from_seconds(t);
        let breaks = scenario.plan.iter().flat_map(|plan| plan.waveform.breaks()).map(at);
        let kinks = scenario.study.drift.iter().flat_map(FrequencyDrift::kinks).map(at);
        let disturbed = scenario.disturbance.iter().flat_map(Disturbance::change_times);
        let around = scenario.study.surroundings.iter().flat_map(SurroundingsState::change_times);
        let turned = scenario.study.drives.iter().flat_map(|drives| &drives.courses.changes);
        let turned = turned.map(|(at, _)| *at).filter(|at| *at > Instant::START);
        let mut edges: Vec<Instant> =
            breaks.chain(disturbed).chain(kinks).chain(around).chain(turned).collect();
        edges.sort_by(|a, b| b.cmp(a));
        edges.dedup();
        let stream = |index: usize| seed.stream(&format!("disturbance {index}"));
        let disturbances = scenario.disturbance.iter().enumerate();
        let mut loads = Self {
            actuator: scenario.study.actuator(scenario, seed),
            distribution: scenario.study.distribution(scenario),
            disturbances: disturbances
                .map(|(index, of)| DisturbanceState::new(of, scenario.model.three_axis(), stream(index)))
                .collect(),
            own: scenario
                .own_disturbances
                .iter()
                .map(|(_, spec)| OwnDisturbance::new(&**spec, scenario, seed))
                .collect(),
            scheduled_changes: edges,
            measured_path: scenario.measured_path(),
            next_change: None,
            due: None,
            wrench: Wrench::default(),
            external_torque: [0.0; 3],
            applied: AppliedTorque::default(),
            first_moment: 0.0,
        };
        loads.find_next_change();
        loads
    }

    /// Returns the key of measured paths, with which there is no run.
    pub fn measured_path(&self) -> Option<&String> {
        self.measured_path.as_ref()
    }

    /// Sets the external torque about each axis (N m), which acts from `now` on.
    pub fn set_external_torque(&mut self, now: Instant, torque: [f64; 3]) {
        self.external_torque = torque;
        self.due = Some(now);
    }

    /// Finds the next instant at which a load changes without a command.
    fn find_next_change(&mut self) {
        let drawn = self.disturbances.iter().filter_map(DisturbanceState::due).min();
        let own = self.own.iter().filter_map(|own| own.run.due()).min();
        self.next_change = earlier(earlier(self.scheduled_changes.last().copied(), drawn), own);
        self.due = earlier(self.next_change, self.actuator.due());
    }

    /// Applies the commands of the laws from `now` on, given the state estimates and the rigid rates (rad/s).
    pub fn command(
        &mut self,
        now: Instant,
        commands: [Command; 3],
        state_estimates: &[StateEstimate],
        rigid: [f64; 3],
    ) {
        let actuator = &mut self.actuator;
        let demands = self.distribution.demands(commands, state_estimates, |rate| {
            actuator.capabilities().known_momentum(now, rigid, rate)
        });
        actuator.command(now, &demands, rigid);
        self.due = earlier(self.next_change, actuator.due());
    }

    /// Applies the changes of loads that are due at `now`, after the laws have decided, given the true state and the estimates.
    pub fn apply_due_changes(&mut self, now: Instant, truth: &Truth, estimates: &[StateEstimate]) {
        while self.scheduled_changes.last().is_some_and(|edge| *edge <= now) {
            self.scheduled_changes.pop();
        }
        self.disturbances.iter_mut().for_each(|disturbance| disturbance.update(now));
        self.own.iter_mut().for_each(|own| own.update(now, truth));
        self.actuator.update(now, ActuatorEvent::EstimatedRate(estimated_rates(estimates)));
        self.actuator.update(now, ActuatorEvent::Due(truth.rigid_rate));
        self.find_next_change();
    }

    /// Returns the speeds of reaction wheels relative to a body with this rate (rad/s), as available to the drives.
    pub fn wheel_speeds(&self, now: Instant, rate: [f64; 3]) -> Vec<f64> {
        self.actuator.capabilities().wheel_speeds(now, rate)
    }

    /// Returns the momentum stored in the rotors (N m s, body axes) as the control system knows it, of a body with this rate (rad/s).
    pub fn known_momentum(&self, now: Instant, rate: [f64; 3], estimates: &[StateEstimate]) -> [f64; 3] {
        self.actuator.capabilities().known_momentum(now, rate, estimated_rates(estimates))
    }

    /// Sets the magnetic field in body axes (T) in the actuator, if there is one.
    #[inline]
    pub fn set_magnetic_field(&mut self, now: Instant, field: Option<Vector>) {
        if let Some(field) = field {
            self.actuator.update(now, ActuatorEvent::MagneticField(field));
        }
    }

    /// Copies the speeds and momenta of wheels in bearings from the motion into the actuator.
    #[inline]
    pub fn update_rotor_states(&mut self, now: Instant, plant: &Plant) {
        let rotors = plant.rotor_observations();
        if !rotors.is_empty() {
            self.actuator.update(now, ActuatorEvent::Rotors(&rotors));
        }
    }

    /// Sets the reduced moment about the first axis, and the torques on a one-axis body, in the motion segment that begins.
    pub fn set_applied_torque(&mut self) {
        let AxisEffort { held: constant, demanded: feedback, reduced_moment, .. } = self.actuator.effort(0);
        self.first_moment = reduced_moment;
        let back_emf = self.actuator.capabilities().back_emf;
        self.applied = AppliedTorque { constant, feedback, back_emf };
    }

    /// Returns the wrench of all loads from `now` on.
    #[inline]
    pub fn wrench(&mut self, now: Instant) -> &Wrench {
        self.wrench.clear();
        self.actuator.apply(now, &mut self.wrench);
        for (hub, external) in self.wrench.hub.iter_mut().zip(self.external_torque) {
            // Without an external torque the sum keeps its bits, the sign of zero included.
            if external != 0.0 {
                *hub += external;
            }
        }
        if !self.disturbances.is_empty() {
            for axis in 0..3 {
                self.wrench.hub[axis] +=
                    self.sum_disturbances(|disturbance| disturbance.torque_on_hub(now, axis));
            }
            for disturbance in &self.disturbances {
                disturbance.force_effect(now, &mut self.wrench);
            }
        }
        self.own.iter().for_each(|own| own.apply(&mut self.wrench));
        &self.wrench
    }

    /// Returns a bound of the torque (N m) that the wrench of the current segment exerts on the body, without the moment of
    /// torquers.
    pub fn torque_bound(&self) -> f64 {
        let Wrench { hub, torque, rotors, gimbals, sines, .. } = &self.wrench;
        let rotors: f64 = rotors.iter().map(|rotor| rotor.torque.abs()).sum();
        let gimbals: f64 = gimbals.iter().map(|gimbal| (gimbal.momentum * gimbal.rate).abs()).sum();
        let sines: f64 = sines.iter().map(|(axis, sine)| axis.norm() * sine.amplitude.abs()).sum();
        Vector::from(*hub).norm() + torque.norm() + rotors + gimbals + sines
    }

    /// Returns a bound of the modal forces (N/sqrt(kg)) of jets and of forces at points in the current segment.
    pub fn modal_force_bound(&self) -> f64 {
        self.wrench.forces.iter().map(|force| force * force).sum::<f64>().sqrt()
    }

    /// Returns true if the loads have no part that changes by itself: neither sines nor turning gimbals.
    pub fn is_constant(&self) -> bool {
        self.wrench.sines.is_empty() && self.wrench.gimbals.is_empty()
    }

    /// Returns the wrench of the actuator alone from `now` on.
    pub fn actuator_wrench(&self, now: Instant) -> Wrench {
        let mut wrench = Wrench::default();
        self.actuator.apply(now, &mut wrench);
        wrench
    }

    /// Returns the torque of all disturbances about an axis (N m), the external one included.
    pub fn disturbance(&self, now: Instant, axis: usize) -> f64 {
        let own = self.sum_disturbances(|disturbance| disturbance.torque(now, axis));
        let own = self.own.iter().fold(own, |sum, disturbance| sum + disturbance.torque(axis));
        if self.external_torque[axis] == 0.0 { own } else { own + self.external_torque[axis] }
    }

    fn sum_disturbances(&self, of: impl Fn(&DisturbanceState) -> f64) -> f64 {
        self.disturbances.iter().map(of).sum()
    }
}
