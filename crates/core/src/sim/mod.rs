//! The loop of all runs.
//!
//! At one instant, in this order: the body arrives, the sensor measures, the estimator takes the sample, the monitor closes its
//! window and the adaptation learns, the laws decide once, the actuator acts, the record gets its rows. Between events all that
//! acts is constant, or a waveform, and the motion exact. `docs/events.md` states the rules.

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

/// More decisions than this at one instant are chatter: no scenario's law needs more than a few.
const MOST_DECISIONS: u32 = 32;

/// All that moves in a run.
#[derive(Clone, Debug)]
#[expect(clippy::struct_excessive_bools, reason = "each is a fact of its own")]
pub struct Simulation {
    now: Instant,
    end: Instant,
    plant: Plant,
    sensing: Sensing,
    exposures: Exposures,
    estimator: Box<dyn Estimate>,
    /// Whether there is one.
    estimates: bool,
    /// Until when the estimator knows what a waveform gave.
    given: Instant,
    monitor: Option<Monitor>,
    /// The meter of the adaptation's objective, unless that is the envelope.
    meter: Option<Meter>,
    reference: Reference,
    /// From where angles count, and until when.
    origin: Orientation,
    next_target: Option<Instant>,
    beliefs: Vec<Belief>,
    laws: Controls,
    drive: Loads,
    /// The torques of the present motion.
    exerted: Exerted,
    /// The instant and index of the guard that trips next, as long as the hold lasts.
    trip: Option<(Instant, usize)>,
    decisions: u32,
    /// How often the law has switched since the last window of switchings ended, and when that was; how long one lasts (s) at least.
    switchings: (u64, Instant),
    shortest_window: f64,
    /// Whether a wheel has come to rest or let go now, how often in the last nanosecond, and since when.
    met: bool,
    slips: (u32, Instant),
    telling: Telling,
    /// Whether anything was measured now, if that was read ahead.
    read: Option<bool>,
    /// What came up at this instant and is not yet answered, where the run was stopped between.
    unanswered: Option<Event>,
    /// Whether there are commands from outside that the actuator does not have yet.
    steered: bool,
    /// Whether parts of it are a program's own.
    own: bool,
    /// The start of a flight of its own, if it can make one.
    flight: Option<Box<Setup>>,
}

impl Simulation {
    /// A run of a scenario, before its start.
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

    /// Runs to an instant, or to the end of the scenario if that is earlier, everything that is due then included.
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

    /// Brings the body to the next instant at which anything is due, until an instant; tells whether anything is.
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

    /// The next instant at which anything is due.
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

    /// Does what is due now.
    fn serve(&mut self, record: &mut dyn Record) -> Result<(), SimulationError> {
        let event = self.event();
        self.perceive(record)?;
        self.answer(event, record)
    }

    /// What comes up for laws now.
    fn event(&self) -> Event {
        match self.trip {
            _ if self.samples() || self.read.is_some() => Event::Due { sampled: true },
            Some((at, guard)) if at == self.now => Event::Guard(guard),
            _ => Event::Due { sampled: false },
        }
    }

    /// Measures and estimates what is due now.
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

    /// Laws decide on what has come up, and the actuator acts.
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
