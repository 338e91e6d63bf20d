//! How a commanded torque is executed: as it is, through a zero-order hold, or by pulses of thrusters.

mod jets;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::quantity::{Finite, NonNegative, Positive, Time};
use crate::time::{Instant, Span};

pub use jets::{Group, Groups, Jets, Pair, Thruster};

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
    /// A flywheel on a motor with back-EMF.
    Wheel(Wheel),
    /// Thrusters of a spatial body.
    Jets(Jets),
}

/// A flywheel on a motor with back-EMF: the body's torque is gain u - `back_emf` times a rate of the body.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Wheel {
    /// Torque for each unit of the law's command (N m; k'_u of seed papers 3 and 5 times the body's inertia).
    pub gain: Positive,
    /// Torque for each unit of the rate (N m s; k'_omega times the body's inertia).
    #[serde(default)]
    pub back_emf: NonNegative,
    /// The rate that the back-EMF opposes.
    #[serde(default)]
    pub opposes: Opposes,
    /// The wheel.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub rotor: Option<Rotor>,
    /// Commands of less than this are not executed.
    #[serde(default)]
    pub dead_zone: NonNegative,
    /// Quantum of the command; 0 for none.
    #[serde(default)]
    pub quantum: NonNegative,
    /// Largest command; left out, there is no limit.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub limit: Option<Positive>,
    /// Time from a sample to the command that is computed from it (s).
    #[serde(default)]
    pub delay: Time,
}

/// The rate that the back-EMF opposes.
#[derive(Copy, Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Opposes {
    /// The measured rate, elastic part included: so in the papers, which overstates the damping of the modes.
    #[default]
    BodyRate,
    /// The rigid rate: the momentum of the wheel is that which the body's torque gave it, exactly.
    RigidRate,
}

/// A wheel that stores momentum.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Rotor {
    /// Moment of inertia (kg m²).
    pub inertia: Positive,
    /// Speed at the start (rad/s).
    #[serde(default)]
    pub speed: Finite,
    /// Largest speed (rad/s), at which no torque drives it further; left out, there is no limit.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub speed_limit: Option<Positive>,
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
            Self::Ideal | Self::Wheel(_) | Self::Jets(_) => None,
            Self::Hold(hold) => Some(hold.period),
            Self::Thrusters(thrusters) => Some(thrusters.period),
        }
    }
}

impl Wheel {
    /// What is executed of a command: limited, quantised, nothing of a small one.
    pub fn shaped(&self, command: f64) -> f64 {
        let limit = self.limit.map_or(f64::INFINITY, Positive::get);
        let (dead_zone, quantum) = (self.dead_zone.get(), self.quantum.get());
        let command = command.clamp(-limit, limit);
        if command.abs() < dead_zone {
            0.0
        } else if quantum > 0.0 {
            libm::round(command / quantum) * quantum
        } else {
            command
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
