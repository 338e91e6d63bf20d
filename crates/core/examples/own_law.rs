//! Custom control law: a sampled PID law, which removes the error that a steady disturbance leaves under a PD law.

#![allow(clippy::print_stdout, reason = "it prints an angle")]

use std::error::Error;
use std::sync::Arc;

use flexsc_core::control::custom::Custom;
use flexsc_core::control::law::{
    Authority, Command, ControlOutput, DecisionCause, Guards, Law, LawKind, LawSpec, LawState, Phase,
    Setpoint,
};
use flexsc_core::control::offers::LawOffers;
use flexsc_core::control::part::Part;
use flexsc_core::control::state_estimate::{EstimateNeeds, StateEstimate};
use flexsc_core::numerics::time::{Instant, Span};
use flexsc_core::prelude::*;

/// Flexible body about one axis under a steady torque (N m); the program replaces its law.
const SCENARIO: &str = "duration = 200.0\n[law.open]\n[body.planar]\ninertia = 100.0\nangle = 2e-3\n\
                        modes = [{ frequency = 1.3, gain = 0.2, damping = 0.02 }]\n[[disturbance]]\ntorque = 1e-3";

/// Gains k_p, k_i and k_d (N m/rad, N m/(rad s), N m s/rad), and the sampling period (s).
#[derive(Copy, Clone, Debug)]
struct Pid([f64; 3], f64);

/// Run-time state of the law about one axis, with the integral of the error (rad s).
#[derive(Copy, Clone, Debug)]
struct PidState(Pid, f64);

impl LawSpec for Pid {
    fn start(&self, _: &Authority) -> Box<dyn Law> {
        Box::new(PidState(*self, 0.0))
    }

    fn offers(&self) -> LawOffers {
        LawOffers::new(Some(Span::from_seconds(self.1)), EstimateNeeds::Motion)
    }
}

impl Part for PidState {}

impl Law for PidState {
    fn decide(
        &mut self,
        now: Instant,
        _: DecisionCause,
        goal: &Setpoint,
        state_estimate: &StateEstimate,
    ) -> ControlOutput {
        let Self(Pid([k_p, k_i, k_d], period), integral) = self;
        let (angle, rate) = goal.at(now);
        let error = state_estimate.angle - angle;
        *integral += error * *period;
        let torque = -*k_p * error - *k_i * *integral - *k_d * (state_estimate.rate - rate);
        // The actuator holds the torque until the next decision.
        let until = Some(now + Span::from_seconds(*period));
        ControlOutput { command: Command::Torque(torque), until, guards: Guards::NONE }
    }

    fn state(&self) -> LawState<'_> {
        LawState::new(Phase::Feedback)
    }

    fn copy(&self) -> Box<dyn Law> {
        Box::new(*self)
    }
}

fn main() -> Result<(), Box<dyn Error>> {
    for k_i in [0.0, 0.15] {
        let law = LawKind::Own(Custom::new(Arc::new(Pid([4.0, k_i, 30.0], 0.25))));
        let scenario = Scenario::parse("own-law.toml", SCENARIO)?.with(|scenario| scenario.law = law)?;
        let mut simulation = Simulation::new(&scenario, 0);
        simulation.run(&mut ())?;
        let angle = simulation.state().ok_or("not a one-axis body")?.angle();
        println!("k_i = {k_i}: the angle is {angle:.1e} rad after 200 s.");
    }
    Ok(())
}

#[test]
fn runs() -> Result<(), Box<dyn Error>> {
    main()
}
