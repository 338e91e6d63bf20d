//! The B-dot law: magnetic moments against the change of the field, which reduce the rotation (\[Wertz78\]).
//!
//! In a body that rotates at w the field changes by B x w, more than along the orbit. A moment -k dB/dt has the torque
//! -k (dB/dt) x B, which is -k B² times the part of w perpendicular to the field. Each axis needs only its own
//! component of the field, as a magnetometer measures it.

use flexsc_flight_precision::Precision;
use flexsc_numerics::quantity::Positive;
use flexsc_numerics::time::{Instant, Span};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::{
    Authority, Command, ControlOutput, DecisionCause, EstimateNeeds, Guards, Law, LawSpec, LawState, Phase,
    Setpoint, TorqueConditions, Tunable,
};
use crate::offers::{LawOffers, LawPlace, Offers};
use crate::part::Part;
use crate::requirement::Requirements;
use crate::state_estimate::StateEstimate;

/// The B-dot law.
#[derive(Copy, Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct BDot {
    /// Period of its commands (s).
    pub period: Span,
    /// Magnetic moment per unit rate of change of the field (A m² s/T).
    pub gain: Positive,
}

impl LawSpec for BDot {
    fn expected_torque(&self, conditions: &TorqueConditions) -> f64 {
        conditions.magnetorquers
    }

    fn start(&self, authority: &Authority) -> Box<dyn Law> {
        let precision = authority.precision;
        Box::new(BDotState { law: *self, gain: self.gain.get(), precision, tuned: f64::NAN })
    }

    fn offers(&self) -> LawOffers {
        let offers = LawOffers::new(Some(self.period), EstimateNeeds::Field);
        LawOffers { commands_moments: true, has_single_precision: true, ..offers }
    }

    fn requires(&self, _: &LawPlace, offers: &Offers, needs: &mut Requirements) {
        offers.require_three_axes(needs, "", "");
        needs.require(
            offers.sensors.magnetic_field,
            "",
            "reads the field of a `[sensor.magnetometer]`, and there is none",
        );
        needs.require(
            offers.has_actuator(|actuator| actuator.turns_with_field),
            "",
            "commands magnetic moments: it needs `[actuator.magnetorquers]`, or wheels that are unloaded by them",
        );
    }

    fn tunable(&self) -> Vec<Tunable> {
        vec![Tunable::positive("gain", self.gain)]
    }
}

/// Run-time state of the law along an axis.
#[derive(Copy, Clone, Debug)]
struct BDotState {
    law: BDot,
    gain: f64,
    precision: Precision,
    /// Value of the parameter tuned last.
    tuned: f64,
}

impl Part for BDotState {}

impl Law for BDotState {
    fn decide(
        &mut self,
        now: Instant,
        _: DecisionCause,
        _: &Setpoint,
        state_estimate: &StateEstimate,
    ) -> ControlOutput {
        ControlOutput {
            command: Command::Moment(self.precision.opposing_moment(self.gain, state_estimate.field_rate)),
            until: Some(now + self.law.period),
            guards: Guards::NONE,
        }
    }

    fn state(&self) -> LawState<'_> {
        LawState::with_tuned(Phase::Detumbling, self.tuned)
    }

    fn copy(&self) -> Box<dyn Law> {
        Box::new(*self)
    }

    fn tune(&mut self, key: &str, value: f64) {
        if key == "gain" {
            (self.gain, self.tuned) = (value, value);
        }
    }
}
