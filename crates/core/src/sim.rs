//! The event loop.
//!
//! At one instant, in this order: the body arrives, the sensor samples, the estimator closes its window, the
//! adaptation learns, the law decides once, the record is told. Between events the input is constant and the
//! body's flow exact. `docs/events.md` states the rules.

use thiserror::Error;

use crate::adaptation::{Adaptation, Search};
use crate::belief::Belief;
use crate::body::{Arc, Sight, State};
use crate::estimator::{Estimator, Observer};
use crate::guard::locate;
use crate::law::{Cause, Guards, Hold, Law};
use crate::random::{Seed, Stream};
use crate::record::{self, Command, Motion, Record, RecordError, Sample, Trigger, WindowMean};
use crate::scenario::Scenario;
use crate::sensor::Sensor;
use crate::time::{Instant, Span};

/// More decisions than this at one instant are chatter: no scenario's law needs more than a few.
const MOST_DECISIONS: u32 = 32;

/// A simulation that cannot go on.
#[derive(Debug, Error)]
pub enum SimulationError {
    /// The state of the body is no longer a finite number.
    #[error("the state is no longer finite at t = {at} s")]
    NonFinite {
        /// When.
        at: Instant,
    },
    /// The law switches without end at one instant.
    #[error("chatter: the law decided {count} times at t = {at} s")]
    Chatter {
        /// When.
        at: Instant,
        /// How often.
        count: u32,
    },
    /// The record could not be kept.
    #[error(transparent)]
    Record(#[from] RecordError),
}

/// All that moves in a run.
#[derive(Clone, Debug)]
pub struct Simulation {
    now: Instant,
    end: Instant,
    body: Plant,
    sensor: Sensor,
    noise: Stream,
    watch: Option<Watch>,
    law: Law,
    /// What the law reads. The adaptation writes its gain.
    pub belief: Belief,
    hold: Hold,
    /// The instant and index of the guard that trips next, as long as the hold lasts.
    trip: Option<(Instant, usize)>,
    next_sample: Option<Instant>,
    log_period: Span,
    next_dense: Option<Instant>,
    next_law: Instant,
    decisions: u32,
    begun: bool,
}

/// The body on its way.
#[derive(Clone, Debug)]
struct Plant {
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

/// The envelope observer with its windows, and the adaptation that learns from them.
#[derive(Clone, Debug)]
struct Watch {
    observer: Observer,
    window: Span,
    opened: Instant,
    closes: Instant,
    index: u64,
    /// Mean of the window closed last.
    mean: f64,
    search: Option<(Search, Stream)>,
}

impl Simulation {
    /// A run of a scenario, before its start.
    pub fn new(scenario: &Scenario, run: u64) -> Self {
        let seed = Seed { scenario: scenario.seed, run };
        let gain = scenario.law.gain();
        let state = scenario.body.start();
        let watch = scenario.estimator.as_ref().map(|Estimator::Envelope(spec)| Watch {
            observer: Observer::new(spec, scenario.body.modes(), scenario.body.inertia()),
            window: spec.window,
            opened: Instant::START,
            closes: Instant::START + spec.window,
            index: 0,
            mean: f64::NAN,
            search: scenario.adaptation.clone().map(|Adaptation::RandomSearch(constants)| {
                (Search::new(constants, gain), seed.stream("adaptation"))
            }),
        });
        Self {
            now: Instant::START,
            end: Instant::START + scenario.duration,
            body: Plant {
                arc: scenario.body.arc(),
                departed: Instant::START,
                sight: Sight::default(),
                seen: Instant::START,
                ahead: (state.clone(), Sight::default(), Instant::START),
                frequencies: scenario.body.modes().iter().map(|m| m.frequency.get()).collect(),
                state,
            },
            sensor: scenario.sensor.clone(),
            noise: seed.stream("sensor"),
            watch,
            law: scenario.law.clone(),
            belief: Belief { angle: 0.0, gain },
            hold: Hold { torque: 0.0, until: None, guards: Guards::NONE },
            trip: None,
            next_sample: scenario.sensor.period().map(|period| Instant::START + period),
            log_period: scenario.log.period,
            next_dense: None,
            next_law: Instant::START,
            decisions: 0,
            begun: false,
        }
    }

    /// Runs to the end of the scenario.
    pub fn run(&mut self, record: &mut impl Record) -> Result<(), SimulationError> {
        self.run_until(self.end, record)
    }

    /// Runs to an instant, everything that is due at it included.
    pub fn run_until(&mut self, until: Instant, record: &mut impl Record) -> Result<(), SimulationError> {
        if !self.begun {
            self.begin(record)?;
        }
        loop {
            let next = self.next();
            if next > until {
                self.now = until;
                self.body.view(until);
                return self.body.check(until);
            }
            if next > self.now {
                self.now = next;
                self.decisions = 0;
            }
            self.serve(record)?;
        }
    }

    /// The mean of the total envelope over the window that was closed last (rad).
    pub fn window_mean(&self) -> Option<f64> {
        self.watch.as_ref().map(|watch| watch.mean)
    }

    /// The state of the body now.
    pub fn state(&self) -> &State {
        &self.body.state
    }

    fn begin(&mut self, record: &mut impl Record) -> Result<(), SimulationError> {
        self.begun = true;
        self.body.arc.depart(&self.body.state, 0.0);
        self.body.sight = self.body.arc.origin();
        self.body.check(self.now)?;
        self.belief.angle = self.sensor.measure(self.body.sight.angle, &mut self.noise);
        let hold = self.law.decide(self.now, Cause::Start, &self.belief);
        self.take(hold);
        record.record(self.now, Sample::Begin(&self.law_row()))?;
        if record.dense() {
            self.next_dense = Some(self.now);
            self.next_law = self.now + Span::from_seconds(1.0);
        }
        Ok(())
    }

    /// The next instant at which anything is due.
    fn next(&self) -> Instant {
        let trip = self.trip.map(|(at, _)| at);
        let closes = self.watch.as_ref().map(|watch| watch.closes);
        let due = [trip, self.hold.until, self.next_sample, closes, self.next_dense];
        due.into_iter().fold(self.end + Span::TICK, |next, due| due.map_or(next, |due| next.min(due)))
    }

    /// Does what is due now.
    fn serve(&mut self, record: &mut impl Record) -> Result<(), SimulationError> {
        let now = self.now;
        let mut cause = None;
        if self.next_sample == Some(now) {
            self.body.view(now);
            self.belief.angle = self.sensor.measure(self.body.sight.angle, &mut self.noise);
            self.next_sample = self.sensor.period().map(|period| now + period);
            cause = self.hold.guards.iter().position(|guard| guard.holds(self.belief.angle));
        }
        if self.watch.as_ref().is_some_and(|watch| watch.closes == now) {
            self.close_window(record)?;
        }
        if let Some((at, guard)) = self.trip
            && at == now
        {
            cause = Some(guard);
        }
        let timeout = self.hold.until.filter(|until| *until == now).map(|_| Cause::Timeout);
        if let Some(cause) = cause.map(Cause::Guard).or(timeout) {
            self.decide(cause, record)?;
        }
        if self.next_dense == Some(now) {
            self.body.view(now);
            record.record(now, Sample::Motion(&self.motion()))?;
            self.next_dense = Some(now + self.log_period);
            if now >= self.next_law {
                record.record(now, Sample::Law(&self.law_row()))?;
                self.next_law += Span::from_seconds(1.0);
            }
        }
        Ok(())
    }

    fn close_window(&mut self, record: &mut impl Record) -> Result<(), SimulationError> {
        let now = self.now;
        self.body.view(now);
        let Some(watch) = &mut self.watch else { return Ok(()) };
        watch.observer.advance(now, &self.body.state);
        let mean = watch.observer.close_window() / watch.window.seconds();
        let row = WindowMean {
            window: watch.index,
            from_s: watch.opened.seconds(),
            to_s: now.seconds(),
            mean_rad: mean,
            gain: self.belief.gain,
        };
        watch.mean = mean;
        watch.opened = now;
        watch.closes = now + watch.window;
        watch.index += 1;
        record.record(now, Sample::Window(&row))?;
        let Some((search, stream)) = &mut watch.search else { return Ok(()) };
        let Some(step) = search.learn(now, mean, stream.uniform()) else { return Ok(()) };
        self.belief.gain = step.gain;
        let row = record::Adaptation {
            window: row.window,
            decision: step.decision,
            change: step.change,
            draw: step.draw,
            gain: step.gain,
            settled: u64::from(step.settled),
        };
        record.record(now, Sample::Adaptation(&row))?;
        Ok(())
    }

    fn decide(&mut self, cause: Cause, record: &mut impl Record) -> Result<(), SimulationError> {
        let now = self.now;
        self.decisions += 1;
        if self.decisions > MOST_DECISIONS {
            return Err(SimulationError::Chatter { at: now, count: self.decisions });
        }
        self.body.view(now);
        self.body.check(now)?;
        let sight = self.body.sight;
        if self.next_sample.is_none() {
            self.belief.angle = sight.angle;
        }
        let before = (self.law.state(), self.hold.torque);
        let hold = self.law.decide(now, cause, &self.belief);
        self.take(hold);
        if before == (self.law.state(), self.hold.torque) {
            return Ok(());
        }
        let (time_s, time_whole_s, time_fs) = Command::times(now);
        let command = Command {
            time_s,
            time_whole_s,
            time_fs,
            state: self.law.state(),
            cause: if cause == Cause::Timeout { Trigger::Timeout } else { Trigger::Guard },
            torque_nm: self.hold.torque,
            angle_rad: sight.angle,
            rate_rad_s: sight.rate,
            gain: self.belief.gain,
        };
        record.record(now, Sample::Switching(&command, &self.body.state))?;
        if record.dense() {
            record.record(now, Sample::Motion(&self.motion()))?;
        }
        Ok(())
    }

    /// Begins a hold: the body departs anew, and the next trip is found.
    fn take(&mut self, hold: Hold) {
        if let Some(watch) = &mut self.watch {
            watch.observer.advance(self.now, &self.body.state);
            watch.observer.command(hold.torque);
        }
        self.hold = hold;
        self.body.depart(self.now, hold.torque);
        self.trip = None;
        // A sampled sensor trips its guards at samples.
        if self.next_sample.is_none() && !hold.guards.is_empty() {
            let horizon = hold.until.map_or(self.end, |until| until.min(self.end)).since(self.now);
            let trip = locate(&self.body.arc, &hold.guards, horizon, &mut self.body.ahead.0);
            if let Some(trip) = trip {
                let at = self.now + trip.after;
                (self.body.ahead.1, self.body.ahead.2) = (trip.sight, at);
                self.trip = Some((at, trip.guard));
            }
        }
    }

    fn law_row(&self) -> record::Law {
        record::Law { state: self.law.state(), torque_nm: self.hold.torque, gain: self.belief.gain }
    }

    /// The motion now, for a dense record.
    fn motion(&self) -> Motion {
        let Plant { state, sight, frequencies, .. } = &self.body;
        let continuous = self.next_sample.is_none();
        let modes = state.modes.iter().zip(frequencies).map(|(phase, w)| record::ModeMotion {
            displacement_rad: phase.displacement,
            rate_rad_s: w * phase.quadrature,
        });
        let envelope = self.watch.as_ref().map(|watch| {
            let modes: Vec<_> = watch
                .observer
                .at(self.now)
                .map(|envelope_rad| record::ModeEnvelope { envelope_rad })
                .collect();
            let envelope_rad = modes.iter().map(|mode| mode.envelope_rad).sum();
            record::Envelope { envelope_rad, modes }
        });
        Motion {
            attitude: record::Attitude {
                angle_rad: sight.angle,
                rigid_rad: state.rigid_angle,
                measured_rad: if continuous { sight.angle } else { self.belief.angle },
                angle_deg: sight.angle.to_degrees(),
            },
            rate: record::Rate { rate_rad_s: sight.rate, rigid_rad_s: state.rigid_rate },
            modes: record::Modes { elastic_rad: sight.angle - state.rigid_angle, modes: modes.collect() },
            envelope,
        }
    }
}

impl Plant {
    /// Brings state and sight to an instant.
    fn view(&mut self, now: Instant) {
        if self.seen == now {
            return;
        }
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

    /// Begins a new arc here and now.
    fn depart(&mut self, now: Instant, torque: f64) {
        self.arc.depart(&self.state, torque);
        self.departed = now;
    }

    fn check(&self, now: Instant) -> Result<(), SimulationError> {
        let Sight { angle, rate, .. } = self.sight;
        if angle.is_finite() && rate.is_finite() {
            Ok(())
        } else {
            Err(SimulationError::NonFinite { at: now })
        }
    }
}
