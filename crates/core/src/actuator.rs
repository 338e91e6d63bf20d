//! How a commanded torque is executed: as it is, through a zero-order hold, or by pulses of thrusters.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::quantity::{NonNegative, Positive};
use crate::time::{Instant, Span};

/// The kinds of actuator.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Actuator {
    /// The command itself, at every instant.
    #[default]
    Ideal,
    /// In each period the mean of what the manoeuvre commands over it, and the feedback at its start.
    Hold(Hold),
    /// In each period one pulse of full torque, centred in it, with the impulse that a hold would have.
    Thrusters(Thrusters),
}

/// A zero-order hold.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Hold {
    /// Period (s).
    pub period: Span,
}

/// A pair of thrusters for each direction, modulated by the width of its pulses.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Thrusters {
    /// Torque of a pulse (N m).
    pub torque: Positive,
    /// Period of the pulses (s).
    pub period: Span,
    /// Shortest pulse (s).
    #[serde(default)]
    pub minimum_on: NonNegative,
    /// Quantum of a pulse's length (s); 0 for none.
    #[serde(default)]
    pub quantum: NonNegative,
}

impl Actuator {
    /// The period in which the command is executed; none for an ideal actuator.
    pub fn period(&self) -> Option<Span> {
        match self {
            Self::Ideal => None,
            Self::Hold(hold) => Some(hold.period),
            Self::Thrusters(thrusters) => Some(thrusters.period),
        }
    }
}

/// A pulse: this torque from one instant to another.
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct Pulse {
    /// Torque (N m).
    pub torque: f64,
    /// When it begins.
    pub from: Instant,
    /// When it ends.
    pub to: Instant,
}

impl Thrusters {
    /// The pulse of a period that begins now and shall give this impulse (N m s), and what it leaves undone (N m s).
    /// The rest is asked of the next period; it is at most what one period can give.
    pub fn pulse(&self, now: Instant, impulse: f64) -> (Pulse, f64) {
        let (torque, period, quantum) = (self.torque.get(), self.period.seconds(), self.quantum.get());
        let mut on = (impulse.abs() / torque).min(period);
        if quantum > 0.0 {
            on = libm::round(on / quantum) * quantum;
        }
        if on < self.minimum_on.get() || on > period {
            on = if on > period { period } else { 0.0 };
        }
        let torque = torque.copysign(impulse);
        let most = self.torque.get() * period;
        let from = now + Span::from_seconds(0.5 * (period - on));
        let pulse = Pulse { torque, from, to: from + Span::from_seconds(on) };
        (pulse, (impulse - torque * on).clamp(-most, most))
    }
}
