//! Objective of an adaptation: the inputs of its meter, which are the motion, the torques, the cycles and the switchings.

use flexsc_control::adaptation::Objective;
use flexsc_control::estimator::{AdaptationRun, MotionSample, ObjectiveMeter, ObjectiveWindow};
use flexsc_control::sensor::Orientation;
use flexsc_control::state_estimate::StateEstimate;
use flexsc_numerics::attitude::Vector;
use flexsc_numerics::random::Seed;
use flexsc_numerics::time::Instant;

use super::guidance::Guidance;
use super::loads::Loads;
use super::plant::Plant;
use flexsc_scenario::Scenario;

/// Meter of the adaptation's objective; `None` without an adaptation, or if the objective is the envelope.
#[derive(Clone, Debug)]
pub struct AdaptationObjective(Option<ObjectiveMeter>);

impl AdaptationObjective {
    /// Creates the objective of a scenario, before its start.
    pub fn new(scenario: &Scenario, seed: Seed) -> Self {
        Self(scenario.objective_meter(seed))
    }

    /// Returns true if nothing is measured.
    #[inline]
    pub fn is_none(&self) -> bool {
        self.0.is_none()
    }

    /// Returns the instant at which the current window closes.
    #[inline]
    pub fn closes(&self) -> Option<Instant> {
        self.0.as_ref().map(|meter| meter.closes)
    }

    /// Returns the adaptation that reads the meter.
    pub fn search(&self) -> Option<&AdaptationRun> {
        self.0.as_ref().map(ObjectiveMeter::search)
    }

    /// Adds the motion up to `now`, if it consists of pieces, as that of one axis does.
    #[inline]
    pub fn add_motion(&mut self, now: Instant, plant: &Plant, loads: &Loads) {
        if self.0.is_some() {
            self.integrate_motion(now, plant, loads);
        }
    }

    /// Adds the pieces of the motion up to `now` to the meter.
    fn integrate_motion(&mut self, now: Instant, plant: &Plant, loads: &Loads) {
        let Some(meter) = &mut self.0 else { return };
        if !meter.integrates() || now <= meter.measured {
            return;
        }
        let speed = |rate: f64| {
            let rotor = loads.actuator.response(now, 0, [rate; 2]).rotor;
            rotor.map(|wheel| wheel.speed_rad_s)
        };
        let slope = || speed(0.0).zip(speed(1.0)).map(|(rest, one)| [rest, one - rest]);
        let mut wheel = None;
        plant.expand([meter.measured, now], &loads.applied, &mut |piece, rigid| {
            let wheel = *wheel.get_or_insert_with(slope);
            meter.add_piece(piece, &MotionSample { rigid: *rigid, wheel });
        });
        meter.measured = now;
    }

    /// Adds the torques that act from `now` on about the first `axes` axes.
    #[inline]
    pub fn add_torque(&mut self, now: Instant, axes: usize, loads: &Loads) {
        if self.0.is_some() {
            self.set_torque(now, axes, loads);
        }
    }

    /// Sets the torques, or adds the pulses, that the meter measures from `now` on.
    fn set_torque(&mut self, now: Instant, axes: usize, loads: &Loads) {
        let Some(meter) = &mut self.0 else { return };
        let applied = || {
            let mut torques = [0.0; 3];
            for (axis, torque) in torques.iter_mut().enumerate().take(axes) {
                *torque = loads.actuator.effort(axis).held;
            }
            torques
        };
        match meter.objective {
            Objective::TorqueMean if axes > 1 => meter.set_value(now, Vector::from(applied()).norm()),
            Objective::Firings => {
                let jets = loads.actuator.capabilities().pulses;
                meter.add_pulses(now, jets.map(|jets| jets.cycle().pulses), applied());
            }
            _ => {}
        }
    }

    /// Adds the three-axis motion at the start of a cycle, with the origin of the angles and the state estimates.
    pub fn add_cycle(
        &mut self,
        now: Instant,
        plant: &Plant,
        origin: &Orientation,
        estimates: &[StateEstimate],
        guidance: &Guidance,
        loads: &Loads,
    ) {
        let Some(meter) = &mut self.0 else { return };
        let truth = plant.truth();
        let error = || truth.orientation.error_from(origin);
        let norm = |v: [f64; 3]| Vector::from(v).norm();
        let value = match meter.objective {
            Objective::PointingErrorMean | Objective::PointingErrorRms | Objective::PointingErrorPeak => {
                norm(error())
            }
            Objective::RateErrorRms => {
                let goal = guidance.reference_motion(now, estimates);
                let goal = goal.map_or([0.0; 3], |goals| goals.map(|goal| goal.rate));
                norm([0, 1, 2].map(|axis| truth.rate[axis] - goal[axis]))
            }
            Objective::ElasticRms => norm(truth.elastic),
            Objective::WheelPowerMean => {
                let all = loads.actuator.capabilities().wheels(now, truth.rate);
                let wheels = all.iter().map(|wheel| wheel.torque_nm * wheel.speed_rad_s);
                let about = |axis: usize| {
                    let rates = [truth.rate[axis], truth.rigid_rate[axis]];
                    let wheel = loads.actuator.response(now, axis, rates).rotor?;
                    Some(loads.actuator.effort(axis).held * wheel.speed_rad_s)
                };
                let alone = if all.is_empty() { 0..3 } else { 0..0 };
                wheels.chain(alone.filter_map(about)).map(f64::abs).sum()
            }
            Objective::EnvelopeMean | Objective::TorqueMean | Objective::Switchings | Objective::Firings => {
                return;
            }
        };
        meter.add_sample(value);
    }

    /// Returns true if the objective is the number of switchings.
    #[inline]
    pub fn counts_switchings(&self) -> bool {
        self.0.as_ref().is_some_and(|meter| meter.objective == Objective::Switchings)
    }

    /// Adds a number of switchings.
    pub fn count_switchings(&mut self, now: Instant, count: usize) {
        if let Some(meter) = &mut self.0 {
            meter.switched(now, u32::try_from(count).unwrap_or(u32::MAX));
        }
    }

    /// Closes the window, if it ends now.
    #[inline]
    pub fn close_window(&mut self, now: Instant, plant: &Plant, loads: &Loads) -> Option<ObjectiveWindow> {
        if self.closes() == Some(now) { self.close(now, plant, loads) } else { None }
    }

    /// Closes the window that ends now.
    fn close(&mut self, now: Instant, plant: &Plant, loads: &Loads) -> Option<ObjectiveWindow> {
        self.add_motion(now, plant, loads);
        self.0.as_mut().map(|meter| meter.close_window(now))
    }
}
