//! The body on its way: its motion since the last event, and what is seen of it now.

use crate::body::{Arc, Coupling, Flight, Input, Output, Sight, State};
use crate::crossing::locate;
use crate::guard::Guard;
use crate::record::{Attitude, ModeMotion, Modes, OutputMotion, Outputs, Rate, Record, RecordError};
use crate::scenario::Scenario;
use crate::time::{Instant, Span};

/// The body, the motion that it is in, and the trip that lies ahead.
#[derive(Clone, Debug)]
pub struct Plant {
    motion: Motion,
    departed: Instant,
    /// State and sight at `seen`.
    state: State,
    sight: Sight,
    seen: Instant,
    /// State, sight and instant of the next trip, found ahead of time.
    ahead: (State, Sight, Instant),
    frequencies: Vec<f64>,
    outputs: Vec<Output>,
}

/// A motion under one input.
#[derive(Clone, Debug)]
enum Motion {
    /// In closed form.
    Planar(Arc),
    /// Integrated.
    Chain(Box<Flight>),
    /// Of coupled or drifting modes.
    Coupled(Box<Coupling>),
}

impl Plant {
    /// The body of a scenario at the start, under no input.
    pub fn new(scenario: &Scenario) -> Self {
        let (model, state) = (&scenario.model, scenario.model.start());
        let mut arc = Arc::new(model);
        arc.depart(&state, &Input::default());
        let sight = arc.origin();
        let motion = match (&scenario.chain, scenario.coupling()) {
            (Some(chain), _) => Motion::Chain(Box::new(Flight::new(chain, sight.angle, sight.rate))),
            (None, Some(coupling)) => Motion::Coupled(Box::new(coupling)),
            (None, None) => Motion::Planar(arc),
        };
        Self {
            motion,
            departed: Instant::START,
            sight,
            seen: Instant::START,
            ahead: (state.clone(), Sight::default(), Instant::START),
            frequencies: model.modes.iter().map(|mode| mode.frequency.get()).collect(),
            outputs: model.outputs.clone(),
            state,
        }
    }

    /// The state at the instant seen last.
    pub fn state(&self) -> &State {
        &self.state
    }

    /// Integrates up to an instant what has no closed form, as long as the record lets it: seeing the body there is then soon
    /// done.
    pub fn approach(&mut self, now: Instant, record: &mut impl Record) -> Result<(), RecordError> {
        record.poll()?;
        let h = now.since(self.departed).seconds();
        loop {
            let is_there = match &mut self.motion {
                Motion::Planar(_) => true,
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
    pub fn view(&mut self, now: Instant) -> Sight {
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
                };
            }
        }
        self.sight
    }

    /// Begins a new motion at the instant seen last.
    pub fn depart(&mut self, input: &Input) {
        match &mut self.motion {
            Motion::Planar(arc) => arc.depart(&self.state, input),
            Motion::Chain(flight) => flight.depart(input),
            Motion::Coupled(coupling) => coupling.depart(self.seen.seconds(), input.constant),
        }
        self.departed = self.seen;
    }

    /// The instant and index of the guard that trips first on this motion, within a span.
    pub fn trip(
        &mut self,
        guards: &[Guard],
        horizon: Span,
        record: &mut impl Record,
    ) -> Result<Option<(Instant, usize)>, RecordError> {
        // No law with guards acts on a body without a closed form.
        let Motion::Planar(arc) = &self.motion else { return Ok(None) };
        let trip = locate(arc, guards, horizon, &mut self.ahead.0, record)?;
        Ok(trip.map(|trip| {
            let at = self.departed + trip.after;
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
            Motion::Planar(_) | Motion::Coupled(_) => {
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
