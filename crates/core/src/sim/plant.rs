//! The body on its way: its arc, and what is seen of it now.

use crate::body::{Arc, Planar, Sight, State};
use crate::crossing::locate;
use crate::guard::Guard;
use crate::record::{Attitude, ModeMotion, Modes, Rate};
use crate::time::{Instant, Span};

/// The body, the arc that it is on, and the trip that lies ahead.
#[derive(Clone, Debug)]
pub struct Plant {
    arc: Arc,
    departed: Instant,
    /// State and sight at `seen`.
    state: State,
    sight: Sight,
    seen: Instant,
    /// State, sight and instant of the next trip, found ahead of time.
    ahead: (State, Sight, Instant),
    frequencies: Vec<f64>,
}

impl Plant {
    /// A body at the start, under no torque.
    pub fn new(body: &Planar) -> Self {
        let (mut arc, state) = (Arc::new(body), body.start());
        arc.depart(&state, 0.0);
        Self {
            departed: Instant::START,
            sight: arc.origin(),
            seen: Instant::START,
            ahead: (state.clone(), Sight::default(), Instant::START),
            frequencies: body.modes.iter().map(|mode| mode.frequency.get()).collect(),
            arc,
            state,
        }
    }

    /// The state at the instant seen last.
    pub fn state(&self) -> &State {
        &self.state
    }

    /// What a sensor sees at an instant, to which the body is brought.
    pub fn view(&mut self, now: Instant) -> Sight {
        if self.seen != now {
            self.seen = now;
            let (ahead, sight, at) = &mut self.ahead;
            if *at == now {
                std::mem::swap(&mut self.state, ahead);
                self.sight = *sight;
            } else {
                let h = now.since(self.departed).seconds();
                self.sight = self.arc.at(h, &mut self.state);
            }
        }
        self.sight
    }

    /// Begins a new arc at the instant seen last.
    pub fn depart(&mut self, torque: f64) {
        self.arc.depart(&self.state, torque);
        self.departed = self.seen;
    }

    /// The instant and index of the guard that trips first on this arc, within a span.
    pub fn trip(&mut self, guards: &[Guard], horizon: Span) -> Option<(Instant, usize)> {
        let trip = locate(&self.arc, guards, horizon, &mut self.ahead.0)?;
        let at = self.departed + trip.after;
        (self.ahead.1, self.ahead.2) = (trip.sight, at);
        Some((at, trip.guard))
    }

    /// The motion at the instant seen last, as logged; `measured` is the held measurement of a sampled sensor.
    pub fn motion(&self, measured: Option<f64>) -> (Attitude, Rate, Modes) {
        let Self { state, sight, frequencies, .. } = self;
        let modes = state.modes.iter().zip(frequencies).map(|(phase, w)| ModeMotion {
            displacement_rad: phase.displacement,
            rate_rad_s: w * phase.quadrature,
        });
        (
            Attitude {
                angle_rad: sight.angle,
                rigid_rad: state.rigid_angle,
                measured_rad: measured.unwrap_or(sight.angle),
            },
            Rate { rate_rad_s: sight.rate, rigid_rad_s: state.rigid_rate },
            Modes { elastic_rad: sight.angle - state.rigid_angle, modes: modes.collect() },
        )
    }
}
