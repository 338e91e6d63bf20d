//! Requirements and offers of the actuators of a scenario.

use flexsc_numerics::quantity::Time;

use super::{ActuatorKind, AssignedActuator, Ideal, Jets, Wheels};
use crate::offers::{ActuatorMember, ActuatorOffers, ActuatorPlace, Offers};
use crate::one_or_many::OneOrMany;
use crate::requirement::Requirements;

impl ActuatorKind {
    /// Returns the offers of the actuator to the other parts of a scenario.
    pub fn offers(&self) -> ActuatorOffers {
        ActuatorOffers { period: self.period(), ..(**self).offers() }
    }

    /// Adds the requirements of the actuator on the other parts of a scenario.
    fn add_requirements(&self, place: &ActuatorPlace<'_>, offers: &Offers, needs: &mut Requirements) {
        self.require_phase(place, offers, needs);
        self.requires(place, offers, needs);
    }

    /// Adds the requirements on the phase of the periods, so that no first period is missed.
    fn require_phase(&self, place: &ActuatorPlace<'_>, offers: &Offers, needs: &mut Requirements) {
        let Some(phase) = self.phase() else { return };
        needs.require(
            self.period().is_some(),
            "phase",
            "applies only to jets with a `period` of their own: without one they act with the law",
        );
        let is_late = phase != Time::ZERO;
        needs.require(
            !is_late || !offers.body.has_manoeuvre,
            "phase",
            "must be 0 with a `[manoeuvre]`, whose begin it would miss",
        );
        let is_planned = offers.laws.iter().any(|law| law.offers.plans_pulses);
        needs.require(
            !is_late || !is_planned || !place.shares.iter().any(|share| *share > 0.0),
            "phase",
            "must be 0 with a law `phase_plane`, whose pulses begin with the law's periods",
        );
    }

    /// Returns true if commands are executed exactly, without failures.
    pub fn is_ideal(&self) -> bool {
        matches!(self, Self::Ideal(ideal) if ideal.faults.is_empty())
    }

    /// Returns the jets, if the actuator consists of them.
    pub fn jets(&self) -> Option<&Jets> {
        if let Self::Jets(jets) = self { Some(jets) } else { None }
    }

    /// Returns the wheels if they are unbalanced.
    pub fn unbalanced_wheels(&self) -> Option<&Wheels> {
        if let Self::Wheels(wheels) = self {
            Some(wheels).filter(|wheels| wheels.imbalance.is_some())
        } else {
            None
        }
    }
}

impl Default for ActuatorKind {
    fn default() -> Self {
        Self::Ideal(Ideal::default())
    }
}

impl OneOrMany<AssignedActuator> {
    /// Returns the offers of each actuator.
    pub fn offers(&self) -> Vec<ActuatorMember> {
        let members = self.members().into_iter();
        let offers = members.map(|member| ActuatorMember {
            offers: member.kind.offers(),
            shares: [0, 1, 2].map(|axis| member.share(axis)),
            is_listed: !member.is_nested(),
            executes: member.executes(),
            kind: member.kind.kind(),
            key: member.key,
        });
        offers.collect()
    }

    /// Adds the requirements of all actuators.
    pub fn add_requirements(&self, offers: &Offers, needs: &mut Requirements) {
        for (index, member) in self.members().iter().enumerate() {
            let own = &offers.actuators[index];
            let twins = || offers.actuators[..index].iter().filter(|other| other.kind == own.kind);
            let meets = |other: &ActuatorMember| {
                (0..offers.body.axes).any(|axis| other.shares[axis] * own.shares[axis] > 0.0)
            };
            let place = ActuatorPlace {
                members: offers.actuators.len(),
                twin: twins().next().map(|other| other.key.as_str()),
                meets_twin: twins().any(meets),
                shares: own.shares,
                executes: own.executes,
            };
            needs.set_part(own.key.clone());
            let own = if own.executes { &*offers.driving_actuator(own.kind) } else { offers };
            member.kind.add_requirements(&place, own, needs);
        }
    }
}
