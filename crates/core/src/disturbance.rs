//! Disturbance torques from one time to another: constant, and random.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::axes::Axis;
use crate::quantity::{Finite, NonNegative, Time};
use crate::random::Stream;
use crate::time::{Instant, Span};

/// A disturbance torque.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Disturbance {
    /// The axis about which it acts, of a body with three.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub about: Option<Axis>,
    /// Torque (N m).
    #[serde(default)]
    pub torque: Finite,
    /// Spectral density of a white noise in the torque beside it ((N m)² s): each draw is held for `period`.
    #[serde(default)]
    pub noise: NonNegative,
    /// How long a draw of the noise is held (s).
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub period: Option<Span>,
    /// When it begins (s).
    #[serde(default)]
    pub from: Time,
    /// When it ends (s); left out, with the run.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub to: Option<Time>,
}

impl Disturbance {
    /// The instants at which it changes.
    pub fn edges(&self) -> impl Iterator<Item = Instant> {
        [Some(self.from), self.to].into_iter().flatten().map(at)
    }

    /// Whether it acts at an instant.
    fn acts(&self, now: Instant) -> bool {
        at(self.from) <= now && self.to.is_none_or(|to| now < at(to))
    }
}

/// A disturbance at work.
#[derive(Clone, Debug)]
pub struct Disturbing {
    what: Disturbance,
    draws: Stream,
    /// The draw that is held (N m), and when the next is due.
    drawn: f64,
    next: Option<Instant>,
}

impl Disturbing {
    /// A disturbance before its start, with its own stream of draws.
    pub fn new(disturbance: &Disturbance, draws: Stream) -> Self {
        let noisy = disturbance.noise.get() > 0.0 && disturbance.period.is_some();
        Self { next: noisy.then(|| at(disturbance.from)), what: disturbance.clone(), draws, drawn: 0.0 }
    }

    /// The axis about which it acts: the first of a body with one angle.
    pub fn axis(&self) -> usize {
        self.what.about.map_or(0, Axis::index)
    }

    /// When the next draw is due.
    pub fn due(&self) -> Option<Instant> {
        self.next
    }

    /// Draws the noise anew if that is due.
    pub fn serve(&mut self, now: Instant) {
        let Some(period) = self.what.period else { return };
        while let Some(next) = self.next.filter(|next| *next <= now) {
            // Of the power of white noise, a draw that is held has what falls into its period.
            self.drawn = libm::sqrt(self.what.noise.get() / period.seconds()) * self.draws.normal();
            let next = next + period;
            self.next = self.what.to.is_none_or(|to| next < at(to)).then_some(next);
        }
    }

    /// The torque at an instant (N m), right-continuous.
    pub fn torque(&self, now: Instant) -> f64 {
        if self.what.acts(now) { self.what.torque.get() + self.drawn } else { 0.0 }
    }
}

fn at(time: Time) -> Instant {
    Instant::START + Span::from_seconds(time.get())
}
