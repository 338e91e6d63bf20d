//! Plant of a one-axis body: its motion segment since the last event, and the current state.

mod course;

use super::UNSEEN;
use super::lent::Elsewhere;
use crate::body::{Output, Planar};
use crate::flow::{ChainMotion, Coupling, ForcedInput, Lent, Segment};
use crate::guard::Guard;
use crate::motion::crossing::locate;
use crate::motion::{Sensed, State};
use crate::record::{Attitude, ModeMotion, Modes, OutputMotion, Outputs, Rate, Record, RecordError};
use crate::scenario::Scenario;
use crate::sensor::{Orientation, Truth};
use crate::time::{Instant, Span};
use crate::wrench::Wrench;

/// One-axis body with its motion segment and the next guard crossing.
#[derive(Clone, Debug)]
pub struct PlanarPlant {
    motion: Motion,
    departed: Instant,
    /// State and sensed angle and rate at `seen`.
    state: State,
    sight: Sensed,
    seen: Instant,
    /// True state at the last evaluation.
    truth: Truth,
    /// State, sensed motion and instant of the next guard crossing, computed in advance.
    ahead: (State, Sensed, Instant),
    frequencies: Vec<f64>,
    outputs: Vec<Output>,
}

/// Motion under one input.
#[derive(Clone, Debug)]
enum Motion {
    /// Uncoupled modes, in closed form.
    Planar(Segment),
    /// Chain of panels, integrated numerically.
    Chain(Box<ChainMotion>),
    /// Coupled or drifting modes.
    Coupled(Box<Coupling>),
    /// Drifting modes whose motion a batch computes.
    Lent(Elsewhere),
}

/// Torques of one motion segment, for the metrics.
#[derive(Copy, Clone, Debug, Default)]
pub struct Exerted {
    /// Constant part of the actuator's torque, without the waveform of the command and the back-EMF (N m).
    pub constant: f64,
    /// Torque that the law commands (N m).
    pub feedback: f64,
    /// Back-EMF torque per unit of the rate (N m s), and whether the rate is that of the elastic body.
    pub back_emf: (f64, bool),
}

impl PlanarPlant {
    /// Creates the plant of a scenario at the start, without input.
    pub fn new(scenario: &Scenario, body: &Planar) -> Self {
        let state = body.start();
        let mut arc = Segment::new(body);
        arc.depart(&state, &ForcedInput::default());
        let sight = arc.origin();
        let motion = match (scenario.model.chain(), scenario.coupling(body)) {
            (Some(chain), _) => Motion::Chain(Box::new(ChainMotion::new(chain, sight.angle, sight.rate))),
            (None, Some(coupling)) => Motion::Coupled(Box::new(coupling)),
            (None, None) => Motion::Planar(arc),
        };
        Self {
            motion,
            departed: Instant::START,
            sight,
            seen: Instant::START,
            truth: UNSEEN,
            ahead: (state.clone(), Sensed::default(), Instant::START),
            frequencies: body.modes.iter().map(|mode| mode.frequency.get()).collect(),
            outputs: body.outputs.clone(),
            state,
        }
    }

    /// Returns the state at the current instant.
    pub fn state(&self) -> &State {
        &self.state
    }

    /// Returns the rates of the modes at the current instant (rad/s).
    pub fn mode_rates(&self) -> impl Iterator<Item = f64> {
        self.frequencies.iter().zip(&self.state.modes).map(|(w, phase)| w * phase.quadrature)
    }

    /// Integrates motions without a closed form up to `now`, unless the record fails, so that evaluating the body there
    /// is cheap.
    pub fn approach(&mut self, now: Instant, record: &mut dyn Record) -> Result<(), RecordError> {
        record.poll()?;
        if matches!(self.motion, Motion::Planar(_) | Motion::Lent(_)) {
            return Ok(());
        }
        let h = now.since(self.departed).seconds();
        loop {
            let is_there = match &mut self.motion {
                Motion::Planar(_) | Motion::Lent(_) => true,
                Motion::Chain(flight) => flight.approach(h),
                Motion::Coupled(coupling) => coupling.approach(h),
            };
            if is_there {
                return Ok(());
            }
            record.poll()?;
        }
    }

    /// Advances the body to `now` and returns the sensed angle and rate.
    pub fn view(&mut self, now: Instant) -> Sensed {
        if self.seen != now {
            self.seen = now;
            let (ahead, sight, at) = &mut self.ahead;
            if *at == now {
                std::mem::swap(&mut self.state, ahead);
                self.sight = *sight;
            } else {
                let h = now.since(self.departed).seconds();
                self.sight = match &mut self.motion {
                    Motion::Planar(arc) => arc.at(h, &mut self.state),
                    Motion::Chain(flight) => flight.at(h, &mut self.state),
                    Motion::Coupled(coupling) => coupling.at(h, &mut self.state),
                    // The batch that computes the motion has already set the state at `now`.
                    Motion::Lent(_) => self.sight,
                };
            }
        }
        self.sight
    }

    /// Advances the body to `now` and returns its true state; `None` if the motion is no longer finite.
    pub fn measurable(&mut self, now: Instant) -> Option<&Truth> {
        let Sensed { angle, rate, .. } = self.view(now);
        if !(angle.is_finite() && rate.is_finite()) {
            return None;
        }
        let truth = &mut self.truth;
        truth.orientation = Orientation::Angle(angle);
        (truth.rate[0], truth.rigid[0], truth.turned[0]) = (rate, self.state.rigid_rate, angle);
        Some(truth)
    }

    /// Returns the true state of the last evaluation.
    pub fn viewed(&self) -> &Truth {
        &self.truth
    }

    /// Hands the motion to a batch from now on; `None` unless the modes are coupled or drift, between segment starts.
    pub fn lend(&mut self) -> Option<Lent> {
        let Motion::Coupled(coupling) = &self.motion else { return None };
        let (motion, mobility) = coupling.lent()?;
        self.motion = Motion::Lent(Elsewhere::new(mobility));
        Some(motion)
    }

    /// Sets the motion that a batch has computed at `now`: angle and rate of each coordinate.
    pub fn bring(&mut self, now: Instant, motion: impl Iterator<Item = [f64; 2]>) {
        (self.seen, self.sight) = (now, Sensed::default());
        for (index, [angle, rate]) in motion.enumerate() {
            if index == 0 {
                (self.state.rigid_angle, self.state.rigid_rate) = (angle, rate);
            } else {
                let mode = &mut self.state.modes[index - 1];
                (mode.displacement, mode.quadrature) = (angle, rate / self.frequencies[index - 1]);
            }
            self.sight.angle += angle;
            self.sight.rate += rate;
        }
    }

    /// Returns the start of the last segment of a motion that a batch computes, and its reduced moment (rad/s²), once
    /// per segment.
    pub fn departed(&mut self) -> Option<(Instant, f64)> {
        if let Motion::Lent(lent) = &mut self.motion { lent.departed() } else { None }
    }

    /// Begins a motion segment at the current instant, under the wrench from now on.
    pub fn depart(&mut self, wrench: &Wrench) {
        let input = ForcedInput { constant: wrench.hub[0], waveform: wrench.waveform.clone() };
        self.begin(&input);
    }

    /// Begins a motion segment at the current instant, under a constant torque alone (N m).
    pub fn depart_under(&mut self, constant: f64) {
        self.begin(&ForcedInput { constant, waveform: None });
    }

    /// Sets the state at `now` by `change`.
    pub fn put(&mut self, now: Instant, change: impl FnOnce(&mut State)) {
        change(&mut self.state);
        let rate = self.mode_rates().fold(self.state.rigid_rate, |sum, rate| sum + rate);
        (self.seen, self.sight) = (now, Sensed { angle: self.state.angle(), rate, acceleration: 0.0 });
        // A crossing that was found in advance belongs to the previous motion.
        self.ahead.2 = Instant::START;
    }

    fn begin(&mut self, input: &ForcedInput) {
        match &mut self.motion {
            Motion::Planar(arc) => arc.depart(&self.state, input),
            Motion::Chain(flight) => flight.depart(input),
            Motion::Coupled(coupling) => coupling.depart(self.seen.seconds(), input.constant),
            Motion::Lent(lent) => lent.depart(self.seen, input.constant),
        }
        self.departed = self.seen;
    }

    /// Returns the instant and index of the first guard crossing of this segment within `horizon`.
    #[inline]
    pub fn trip(
        &mut self,
        guards: &[Guard],
        horizon: Span,
        record: &mut dyn Record,
    ) -> Result<Option<(Instant, usize)>, RecordError> {
        let departed = self.departed;
        let arc = match &mut self.motion {
            Motion::Planar(arc) => arc,
            Motion::Coupled(coupling) => {
                let trip = coupling.trip(guards, horizon, || record.poll())?;
                return Ok(trip.map(|trip| (departed + trip.after, trip.guard)));
            }
            // No law with guards acts on these bodies.
            Motion::Chain(_) | Motion::Lent(_) => return Ok(None),
        };
        let trip = match arc.guess(guards, horizon, &mut self.ahead.0) {
            Some(trip) => trip,
            None => locate(arc, guards, horizon, &mut self.ahead.0, || record.poll())?,
        };
        Ok(trip.map(|trip| {
            let at = departed + trip.after;
            (self.ahead.1, self.ahead.2) = (trip.sight, at);
            (at, trip.guard)
        }))
    }

    /// Returns the rows of the motion at the current instant; `measured` is the held measurement of a sampled sensor
    /// (rad).
    pub fn motion(&self, measured: Option<f64>) -> (Attitude, Rate, Modes) {
        let Self { state, sight, frequencies, .. } = self;
        let modes: Vec<_> = state
            .modes
            .iter()
            .zip(frequencies)
            .map(|(phase, w)| ModeMotion {
                displacement_rad: phase.displacement,
                rate_rad_s: w * phase.quadrature,
            })
            .collect();
        (
            Attitude {
                angle_rad: sight.angle,
                rigid_rad: state.rigid_angle,
                measured_rad: measured.unwrap_or(sight.angle),
            },
            Rate { rate_rad_s: sight.rate, rigid_rad_s: state.rigid_rate },
            Modes { elastic_rad: modes.iter().map(|mode| mode.displacement_rad).sum(), modes },
        )
    }

    /// Returns the row of the observed coordinates at the current instant; `None` if the body has none.
    pub fn outputs(&self) -> Option<Outputs> {
        let motion = |(value, rate)| OutputMotion { value, rate };
        let outputs: Vec<_> = match &self.motion {
            Motion::Planar(_) | Motion::Coupled(_) | Motion::Lent(_) => {
                let of = |output: &Output| {
                    (output.of(&self.state), output.rate_of(&self.state, &self.frequencies))
                };
                self.outputs.iter().map(of).map(motion).collect()
            }
            Motion::Chain(flight) => flight.outputs().map(motion).collect(),
        };
        (!outputs.is_empty()).then_some(Outputs { outputs })
    }
}
