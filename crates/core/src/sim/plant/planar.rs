//! A body with one angle on its way: its motion since the last event, and what is seen of it now.

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

/// The body, the motion that it is in, and the trip that lies ahead.
#[derive(Clone, Debug)]
pub struct PlanarPlant {
    motion: Motion,
    departed: Instant,
    /// State and sight at `seen`.
    state: State,
    sight: Sensed,
    seen: Instant,
    /// What there is to measure, once it was asked for.
    truth: Truth,
    /// State, sight and instant of the next trip, found ahead of time.
    ahead: (State, Sensed, Instant),
    frequencies: Vec<f64>,
    outputs: Vec<Output>,
}

/// A motion under one input.
#[derive(Clone, Debug)]
enum Motion {
    /// In closed form.
    Planar(Segment),
    /// Integrated.
    Chain(Box<ChainMotion>),
    /// Of coupled or drifting modes.
    Coupled(Box<Coupling>),
    /// Of drifting modes, computed elsewhere.
    Lent(Elsewhere),
}

/// The torques of one motion, as metrics take them.
#[derive(Copy, Clone, Debug, Default)]
pub struct Exerted {
    /// Of the actuator, beside the waveform of the command and the back-EMF (N m).
    pub constant: f64,
    /// What the law asks for (N m).
    pub feedback: f64,
    /// Back-EMF for each unit of the rate (N m s), and whether it is that of the elastic body.
    pub back_emf: (f64, bool),
}

impl PlanarPlant {
    /// The body of a scenario at the start, under no input.
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

    /// The state at the instant seen last.
    pub fn state(&self) -> &State {
        &self.state
    }

    /// Rates of the modes at the instant seen last (rad/s).
    pub fn mode_rates(&self) -> impl Iterator<Item = f64> {
        self.frequencies.iter().zip(&self.state.modes).map(|(w, phase)| w * phase.quadrature)
    }

    /// Integrates up to an instant what has no closed form, as long as the record lets it: seeing the body there is then soon
    /// done.
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

    /// What a sensor sees at an instant, to which the body is brought.
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
                    // Whoever computes it has brought the body here.
                    Motion::Lent(_) => self.sight,
                };
            }
        }
        self.sight
    }

    /// What there is to measure at an instant, to which the body is brought; none if the motion is no longer finite.
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

    /// What there was to measure when that was asked last.
    pub fn viewed(&self) -> &Truth {
        &self.truth
    }

    /// Lets someone else compute the motion from now on; none but that of coupled or drifting modes between departures.
    pub fn lend(&mut self) -> Option<Lent> {
        let Motion::Coupled(coupling) = &self.motion else { return None };
        let (motion, mobility) = coupling.lent()?;
        self.motion = Motion::Lent(Elsewhere::new(mobility));
        Some(motion)
    }

    /// Brings the body, whose motion is computed elsewhere, to an instant: angle and rate of each coordinate.
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

    /// When a motion that is computed elsewhere began anew, and its reduced moment (rad/s²); none since this was asked last.
    pub fn departed(&mut self) -> Option<(Instant, f64)> {
        if let Motion::Lent(lent) = &mut self.motion { lent.departed() } else { None }
    }

    /// Begins a new motion at the instant seen last.
    pub fn depart(&mut self, wrench: &Wrench) {
        let input = ForcedInput { constant: wrench.hub[0], waveform: wrench.waveform.clone() };
        self.begin(&input);
    }

    /// The same under a constant torque alone (N m).
    pub fn depart_under(&mut self, constant: f64) {
        self.begin(&ForcedInput { constant, waveform: None });
    }

    /// Puts the body into a state at an instant.
    pub fn put(&mut self, now: Instant, change: impl FnOnce(&mut State)) {
        change(&mut self.state);
        let rate = self.mode_rates().fold(self.state.rigid_rate, |sum, rate| sum + rate);
        (self.seen, self.sight) = (now, Sensed { angle: self.state.angle(), rate, acceleration: 0.0 });
        // What was found ahead was found on another motion.
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

    /// The instant and index of the guard that trips first on this motion, within a span.
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
            // No law with guards acts on a body without a closed form.
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

    /// The motion at the instant seen last, as logged; `measured` is the held measurement of a sampled sensor.
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

    /// The observed coordinates at the instant seen last, as logged; none if the body has none.
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
