//! The envelope monitor: its observer, its windows, and the adaptation that learns from their means.

use super::{Envelope, EnvelopeMonitor, Searching};
use crate::body::Planar;
use crate::body::spatial::SpatialMode;
use crate::motion::State;
use crate::record::{self, ModeEnvelope, WindowMean};
use crate::time::{Instant, Span};

/// The observer at work, window by window.
#[derive(Clone, Debug)]
pub struct Monitor {
    observer: EnvelopeMonitor,
    window: Span,
    opened: Instant,
    /// When the window closes.
    pub closes: Instant,
    index: u64,
    /// Mean of the window that was closed last (rad).
    pub mean: f64,
    search: Option<Searching>,
}

/// What a window that ends brings.
#[derive(Clone, Debug)]
pub struct WindowEnd {
    /// Its mean.
    pub mean: WindowMean,
    /// The step of the adaptation, with the value before it.
    pub step: Option<(record::Adaptation, f64)>,
}

impl Monitor {
    /// The monitor of a body, with the adaptation that learns from it.
    pub fn new(spec: &Envelope, model: &Planar, search: Option<Searching>) -> Self {
        Self::of(spec, EnvelopeMonitor::new(spec, &model.modes, model.inertia.get()), search)
    }

    /// The same of three axes: each free mode with its rotation at the sensor.
    pub fn of_three_axes(spec: &Envelope, modes: &[(SpatialMode, f64)], search: Option<Searching>) -> Self {
        Self::of(spec, EnvelopeMonitor::of_three_axes(spec, modes), search)
    }

    fn of(spec: &Envelope, observer: EnvelopeMonitor, search: Option<Searching>) -> Self {
        Self {
            observer,
            window: spec.window,
            opened: Instant::START,
            closes: Instant::START + spec.window,
            index: 0,
            mean: f64::NAN,
            search,
        }
    }

    /// Takes over a torque that is commanded from now on.
    pub fn command(&mut self, now: Instant, state: &State, torque: f64) {
        self.observer.advance(now, state);
        self.observer.command(torque);
    }

    /// The same of modal forces of three axes (N/sqrt(kg)).
    pub fn push(&mut self, now: Instant, state: &State, forces: &[f64]) {
        self.observer.advance(now, state);
        self.observer.push(forces);
    }

    /// Follows the true state, if that is what it reads.
    pub fn see(&mut self, now: Instant, state: impl FnOnce() -> State) {
        if self.observer.is_true() {
            self.observer.advance(now, &state());
        }
    }

    /// Takes over what was followed elsewhere until an instant: see [`EnvelopeMonitor::take_over`].
    pub fn take_over(&mut self, now: Instant, integral: f64, tracks: &[[f64; 7]]) {
        self.observer.take_over(now, integral, tracks);
    }

    /// Closes the window that ends now, while the law had this tunable number, and lets the adaptation learn.
    pub fn close(&mut self, now: Instant, state: &State, gain: f64) -> WindowEnd {
        self.observer.advance(now, state);
        let integral = self.observer.close_window();
        self.conclude(now, integral, gain)
    }

    /// The same with the integral of the envelope over the window (rad s).
    pub fn conclude(&mut self, now: Instant, integral: f64, gain: f64) -> WindowEnd {
        self.mean = integral / self.window.seconds();
        let mean = WindowMean {
            window: self.index,
            from_s: self.opened.seconds(),
            to_s: now.seconds(),
            mean_rad: self.mean,
            gain,
        };
        self.opened = now;
        self.closes = now + self.window;
        self.index += 1;
        let step = self.search.as_mut().and_then(|search| search.learn(now, mean.window, mean.mean_rad));
        WindowEnd { mean, step }
    }

    /// The adaptation that learns from it.
    pub fn search(&self) -> Option<&Searching> {
        self.search.as_ref()
    }

    /// The envelope now, as logged.
    pub fn envelope(&self, now: Instant) -> record::Envelope {
        let modes: Vec<_> = self.observer.at(now).map(|envelope_rad| ModeEnvelope { envelope_rad }).collect();
        record::Envelope { envelope_rad: modes.iter().map(|mode| mode.envelope_rad).sum(), modes }
    }
}
