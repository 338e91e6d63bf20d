//! The run loop, for one-axis and three-axis bodies.
//!
//! Order at one instant: the body is advanced, the sensors measure, the estimator processes the sample, the monitor
//! closes its window and the adaptation learns, the laws decide once, the actuator acts, the record gets its rows.
//! Between events every input is constant or a waveform, and the motion is exact. `docs/events.md` states the rules.

mod accelerometers;
mod arrival;
mod believing;
mod beside;
mod deciding;
mod departing;
mod drive;
mod ends;
mod error;
mod events;
mod exposing;
mod failing;
mod flying;
mod instants;
mod journal;
mod metering;
mod own;
mod plant;
mod reference;
mod sensing;
mod showing;
mod sight;
mod slipping;
mod stepping;
mod telling;

use crate::belief::Belief;
use crate::estimator::{self, Estimate, Meter, Monitor};
use crate::flight::{self, Setup};
use crate::law::{Controls, Event};
use crate::random::Seed;
use crate::record::Record;
use crate::scenario::Scenario;
use crate::sensor::Orientation;
use crate::time::{Instant, Span};

use drive::Loads;
pub use error::SimulationError;
use exposing::Exposures;
pub(crate) use plant::Exerted;
pub use sight::{LookField, LookGroup};
pub use stepping::Occasion;

use plant::Plant;
use reference::Reference;
use sensing::Sensing;
use telling::Telling;

/// Largest number of decisions at one instant; more are chatter, because no scenario's law needs more than a few.
const MOST_DECISIONS: u32 = 32;

/// State of one run.
#[derive(Clone, Debug)]
#[expect(clippy::struct_excessive_bools, reason = "each is a fact of its own")]
pub struct Simulation {
    now: Instant,
    end: Instant,
    plant: Plant,
    sensing: Sensing,
    exposures: Exposures,
    estimator: Box<dyn Estimate>,
    /// True if the scenario has an estimator.
    estimates: bool,
    /// Instant up to which the estimator knows the impulse of the waveform.
    given: Instant,
    monitor: Option<Monitor>,
    /// Meter of the adaptation's objective, unless the objective is the envelope.
    meter: Option<Meter>,
    reference: Reference,
    /// Attitude or angle from which the angles are counted, and (`next_target`) the instant at which it changes next.
    origin: Orientation,
    next_target: Option<Instant>,
    beliefs: Vec<Belief>,
    laws: Controls,
    drive: Loads,
    /// Torques during the current motion segment.
    exerted: Exerted,
    /// Instant and index of the next guard crossing, as long as the inputs do not change before.
    trip: Option<(Instant, usize)>,
    decisions: u32,
    /// How often the law has switched since the last window of switchings ended, and when that was; how long one lasts (s) at least.
    switchings: (u64, Instant),
    shortest_window: f64,
    /// True if a wheel in bearings has stuck or let go at the current instant; `slips`: number of such events within a
    /// nanosecond, and the first's instant.
    met: bool,
    slips: (u32, Instant),
    telling: Telling,
    /// True if the sample that was read ahead for the current instant has a measurement; `None` if none was read ahead.
    read: Option<bool>,
    /// Event at the current instant to which the laws have not responded yet, because the run was stopped before.
    unanswered: Option<Event>,
    /// True if there are external commands that the actuator does not have yet.
    steered: bool,
    /// True if the scenario has custom parts.
    own: bool,
    /// Initial setup for the relay kernel, if it can simulate this run.
    flight: Option<Box<Setup>>,
}

impl Simulation {
    /// Creates the run number `run` of a scenario, before its start.
    pub fn new(scenario: &Scenario, run: u64) -> Self {
        let seed = Seed { scenario: scenario.seed, run };
        let (study, reference) = (&scenario.study, Reference::new(scenario));
        let axes = study.axes.len();
        Self {
            now: Instant::START,
            end: Instant::START + scenario.duration,
            plant: Plant::new(scenario),
            sensing: Sensing::new(scenario, seed),
            exposures: Exposures::new(scenario),
            estimator: estimator::start(&scenario.known(), seed),
            estimates: scenario.estimator.is_some(),
            given: Instant::START,
            monitor: scenario.monitor(seed),
            meter: scenario.meter(seed),
            origin: reference.origin(Instant::START),
            next_target: reference.next_target(Instant::START),
            beliefs: vec![Belief::default(); axes],
            laws: Controls::new(&scenario.law, &study.authorities),
            drive: Loads::new(scenario, seed),
            exerted: Exerted::default(),
            trip: None,
            decisions: 0,
            switchings: (0, Instant::START),
            shortest_window: flight::shortest_window(scenario.model.frequencies().fold(0.0, f64::max)),
            met: false,
            slips: (0, Instant::START),
            read: None,
            unanswered: None,
            steered: false,
            own: scenario.has_own_parts(),
            flight: flight::alone(scenario).map(Box::new),
            telling: Telling::new(scenario, &reference, run),
            reference,
        }
    }

    /// Runs to the end of the scenario.
    pub fn run(&mut self, record: &mut dyn Record) -> Result<(), SimulationError> {
        self.run_until(Instant::END, record)
    }

    /// Runs to `until`, or to the end of the scenario if that is earlier, including everything that is due at that
    /// instant.
    pub fn run_until(&mut self, until: Instant, record: &mut dyn Record) -> Result<(), SimulationError> {
        let until = until.min(self.end);
        self.open(record)?;
        self.resume(None, record)?;
        self.fly(until, record)?;
        while self.arrive(until, record)? {
            self.serve(record)?;
        }
        self.finish(record)
    }

    /// Advances the body to the next instant at which anything is due, at most to `until`; returns true if anything is
    /// due there.
    fn arrive(&mut self, until: Instant, record: &mut dyn Record) -> Result<bool, SimulationError> {
        let mut next = self.next();
        self.exposures.copy_body(self.now, &self.plant);
        if let Some(at) = self.plant.approach(next.min(until), record)? {
            next = at;
            self.slips(at)?;
        }
        let now = next.min(until);
        self.turned(now);
        if now > self.now {
            self.now = now;
            self.decisions = 0;
        }
        if next > until {
            self.plant.view(until)?;
        }
        Ok(next <= until)
    }

    /// Returns the next instant at which anything is due.
    #[inline]
    fn next(&self) -> Instant {
        let trip = self.trip.map(|(at, _)| at);
        let closes = self.monitor.as_ref().map(|monitor| monitor.closes);
        let measured = self.meter.as_ref().map(|meter| meter.closes);
        let due = [
            trip,
            self.laws.until(),
            self.drive.due,
            self.sensing.next,
            self.exposures.due(),
            closes,
            measured,
            self.telling.due(),
        ];
        due.into_iter().fold(self.end + Span::TICK, |next, due| due.map_or(next, |due| next.min(due)))
    }

    /// Processes everything that is due at the current instant.
    fn serve(&mut self, record: &mut dyn Record) -> Result<(), SimulationError> {
        let event = self.event();
        self.perceive(record)?;
        self.answer(event, record)
    }

    /// Returns the event at the current instant for the laws.
    fn event(&self) -> Event {
        match self.trip {
            _ if self.samples() || self.read.is_some() => Event::Due { sampled: true },
            Some((at, guard)) if at == self.now => Event::Guard(guard),
            _ => Event::Due { sampled: false },
        }
    }

    /// Reads the sensors and updates the estimates, windows and objectives that are due at the current instant.
    fn perceive(&mut self, record: &mut dyn Record) -> Result<(), SimulationError> {
        self.expose(record)?;
        let now = self.now;
        if self.samples() || self.read.is_some() {
            self.sense(record)?;
        }
        if self.monitor.as_ref().is_some_and(|monitor| monitor.closes == now) {
            self.close_window(record)?;
        }
        self.close_objective(record)?;
        self.tell_arrival(record)
    }

    /// Lets the laws decide on `event`, applies their commands and changes of the loads, and records the instant.
    fn answer(&mut self, event: Event, record: &mut dyn Record) -> Result<(), SimulationError> {
        let now = self.now;
        if self.steered || self.concerns(event) {
            self.decide(event, record)?;
        }
        let met = std::mem::take(&mut self.met);
        if met || self.drive.due == Some(now) {
            self.plant.view(now)?;
            self.feel();
            self.drive.serve(now, self.plant.viewed().rigid);
            self.depart(record)?;
        }
        self.check_own_parts()?;
        self.tell_slips(record)?;
        self.tell_failures(record)?;
        self.tell_accelerations(record)?;
        self.tell(record)?;
        self.show(record)
    }
}
