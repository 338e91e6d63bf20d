//! The envelope monitor: its observer, its windows, and the adaptation that reads their means.

use flexsc_dynamics::AxisState;
use flexsc_dynamics::axis_model::AxisModel;
use flexsc_dynamics::three_axis_model::ThreeAxisMode;
use flexsc_numerics::time::{Instant, Span};
use flexsc_record::{self, ModeEnvelope, WindowMean};

use super::{AdaptationRun, Envelope, EnvelopeMonitor};

/// Run-time state of the envelope monitor: observer and windows.
#[derive(Clone, Debug)]
pub struct WindowedEnvelope {
    observer: EnvelopeMonitor,
    window: Span,
    opened: Instant,
    /// Time at which the current window closes.
    pub closes: Instant,
    index: u64,
    /// Mean envelope over the window closed last (rad); NaN before the first.
    pub mean: f64,
    search: Option<AdaptationRun>,
}

/// Results of a window that has ended.
#[derive(Clone, Debug)]
pub struct EnvelopeWindow {
    /// Mean of the envelope over the window.
    pub mean: WindowMean,
    /// Step of the adaptation, with the parameter before it; `None` without a step.
    pub step: Option<(flexsc_record::Adaptation, f64)>,
}

impl WindowedEnvelope {
    /// Creates the monitor of a one-axis body, with the adaptation that reads its means.
    pub fn new(spec: &Envelope, model: &AxisModel, search: Option<AdaptationRun>) -> Self {
        Self::with_observer(spec, EnvelopeMonitor::new(spec, &model.modes, model.inertia.get()), search)
    }

    /// Creates the monitor of a three-axis body: each free mode with its rotation at the sensor.
    pub fn for_three_axes(
        spec: &Envelope,
        modes: &[(ThreeAxisMode, f64)],
        search: Option<AdaptationRun>,
    ) -> Self {
        Self::with_observer(spec, EnvelopeMonitor::for_three_axes(spec, modes), search)
    }

    fn with_observer(spec: &Envelope, observer: EnvelopeMonitor, search: Option<AdaptationRun>) -> Self {
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

    /// Sets the torque (N m) that is commanded from `now` on.
    pub fn command(&mut self, now: Instant, state: &AxisState, torque: f64) {
        self.observer.advance(now, state);
        self.observer.command(torque);
    }

    /// Sets the modal forces (N/sqrt(kg)) that act on the modes of a three-axis body from `now` on.
    pub fn push(&mut self, now: Instant, state: &AxisState, forces: &[f64]) {
        self.observer.advance(now, state);
        self.observer.set_modal_forces(forces);
    }

    /// Advances the observer to `now` if it uses the true state.
    pub fn observe(&mut self, now: Instant, state: impl FnOnce() -> AxisState) {
        if self.observer.uses_true_state() {
            self.observer.advance(now, &state());
        }
    }

    /// Loads the state that a batch has computed up to `now`: see [`EnvelopeMonitor::load`].
    pub fn take_over(&mut self, now: Instant, integral: f64, tracks: &[[f64; 7]]) {
        self.observer.load(now, integral, tracks);
    }

    /// Closes the window that ends at `now` and updates the adaptation; `gain`: the law's tuned parameter in the
    /// window.
    pub fn close(&mut self, now: Instant, state: &AxisState, gain: f64) -> EnvelopeWindow {
        self.observer.advance(now, state);
        let integral = self.observer.close_window();
        self.close_with(now, integral, gain)
    }

    /// Closes the window that ends at `now` with the given integral of the envelope over it (rad s).
    pub fn close_with(&mut self, now: Instant, integral: f64, gain: f64) -> EnvelopeWindow {
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
        EnvelopeWindow { mean, step }
    }

    /// Returns the adaptation that reads the window means.
    pub fn search(&self) -> Option<&AdaptationRun> {
        self.search.as_ref()
    }

    /// Returns the log row of the envelope at `now`.
    pub fn envelope(&self, now: Instant) -> flexsc_record::Envelope {
        let modes: Vec<_> = self.observer.at(now).map(|envelope_rad| ModeEnvelope { envelope_rad }).collect();
        flexsc_record::Envelope { envelope_rad: modes.iter().map(|mode| mode.envelope_rad).sum(), modes }
    }
}
