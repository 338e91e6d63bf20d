//! Runs of the relay law about a body of undamped modes: motions, crossings and envelopes in lanes, windows' ends and metrics one by
//! one.

mod clock;
pub mod crew;
pub mod flight;
mod track;

#[cfg(test)]
mod tests;

use super::{Batch, Job};
use crate::adaptation::Adaptation;
use crate::body::{Drive, Input, Mode, Planar, Segment};
use crate::estimator::{Estimator, Form, Monitor};
use crate::guard::Guard;
use crate::lanes::{Processor, Real, Work};
use crate::law::{Law, Phase, Relay, Sides};
use crate::metrics::{Gather, Metrics};
use crate::motion::crossing::locate;
use crate::motion::{self, State};
use crate::numerics::trig::FARTHEST;
use crate::random::Seed;
use crate::record::{self, Command, Course, Record, Sample, Trigger};
use crate::scenario::Scenario;
use crate::sensor::Sensor;
use crate::time::{Instant, Span};

use crew::{Crew, Place, Searched, Setup, Sight};
use flight::Flight;

/// Runs that share the lanes of one flight, one after the other.
const RUNS: usize = 64;
/// Longer runs (s) go alone: nothing is told of a flight before its end.
const LONGEST: f64 = 2e5;

/// The batch.
pub struct Side;

impl Batch for Side {
    fn lanes(&self, _: Processor) -> usize {
        RUNS
    }

    fn takes(&self, scenario: &Scenario) -> bool {
        scenario.duration.seconds() <= LONGEST && law(scenario).is_some_and(|law| suits(scenario, law))
    }

    fn simulate(&self, processor: Processor, jobs: &[Job<'_>]) -> Vec<Option<Metrics>> {
        let mut runs = Runs::new(jobs);
        processor.run::<1, _>(&mut runs);
        runs.found
    }
}

fn law(scenario: &Scenario) -> Option<&Relay> {
    if let Law::Relay(law) = &scenario.law { Some(law) } else { None }
}

/// The modes of the envelope's model; none without one.
fn watched(scenario: &Scenario) -> &[Mode] {
    let envelope = scenario.estimator.as_ref().and_then(Estimator::envelope);
    envelope.map_or(&[], |envelope| envelope.modes.as_deref().unwrap_or(&scenario.model.modes))
}

/// Whether nothing but the law moves the body, in closed form, and nothing but the envelope is estimated.
fn suits(scenario: &Scenario, law: &Relay) -> bool {
    let model = &scenario.model;
    let is_simple = scenario.axis_count() == 1
        && model.drive == Drive::Torque
        && scenario.linear.is_none()
        && scenario.chain.is_none()
        && scenario.drift.is_none()
        && scenario.plan.is_none()
        && scenario.disturbance.is_empty()
        && scenario.environment.is_none()
        && scenario.study.sampling.is_none()
        && scenario.actuator.is_ideal()
        && scenario.sensor.iter().all(|sensor| matches!(sensor, Sensor::Continuous));
    let observes = scenario
        .estimator
        .as_ref()
        .is_none_or(|estimator| estimator.envelope().is_some_and(|envelope| envelope.form == Form::Dynamic));
    let learns = scenario.adaptation.as_ref().is_none_or(
        |adaptation| matches!(adaptation, Adaptation::RandomSearch(search) if search.tunes == "k_t" && search.objective.is_default()),
    );
    let duration = scenario.duration.seconds();
    let modes = model.modes.iter().chain(watched(scenario));
    let are_exact =
        modes.clone().all(|mode| mode.damping.get() == 0.0 && mode.frequency.get() * duration < FARTHEST);
    let begins = model.start().angle().abs() < law.dead_zone.get();
    let has_band = scenario.promise().band(f64::NAN) > 0.0;
    is_simple && observes && learns && are_exact && begins && has_band && law.sides == Sides::Two
}

/// Some runs, and what is known of those in the lanes.
struct Runs<'a> {
    jobs: &'a [Job<'a>],
    next: usize,
    lanes: Vec<Option<Lane<'a>>>,
    found: Vec<Option<Metrics>>,
    /// Whether any of them wants switchings, and to know where the angle leaves the band.
    listens: bool,
    looks: bool,
}

/// A run in a lane.
struct Lane<'a> {
    /// The place of its job.
    index: usize,
    scenario: &'a Scenario,
    setup: Setup,
    gather: Gather,
    monitor: Option<Monitor>,
    segment: Segment,
    state: State,
    /// Whether it has to be simulated alone.
    is_alone: bool,
}

impl<'a> Runs<'a> {
    fn new(jobs: &'a [Job<'a>]) -> Self {
        let lanes = (0..flight::MOST).map(|_| None).collect();
        let found = vec![None; jobs.len()];
        Self { jobs, next: 0, lanes, found, listens: false, looks: false }
    }

    /// How many modes bodies and envelopes have.
    fn structure(scenario: &Scenario) -> (usize, usize) {
        (scenario.model.modes.len(), watched(scenario).len())
    }
}

impl Work for &mut Runs<'_> {
    type Output = ();

    #[allow(clippy::inline_always, reason = "a function of its own would lack the processor's instructions")]
    #[inline(always)]
    fn run<R: Real>(self, kind: R) {
        let Some(first) = self.jobs.first() else { return };
        let (modes, tracks) = Runs::structure(first.scenario);
        Flight::fly(kind, modes, tracks, self);
    }
}

/// The state of the law at a place of the cycle.
pub fn phase(place: Place, side: f64) -> Phase {
    match (place, side > 0.0) {
        (Place::Coast, true) => Phase::WeakRight,
        (Place::Coast, false) => Phase::WeakLeft,
        (Place::Push, true) => Phase::RightPush,
        (Place::Push, false) => Phase::LeftPush,
        (Place::Brake, true) => Phase::RightBrake,
        (Place::Brake, false) => Phase::LeftBrake,
    }
}

impl Lane<'_> {
    /// Departs from what was seen, on the motion of a place.
    fn depart(&mut self, place: Place, from: &Sight) {
        see(&mut self.state, from);
        let constant = self.setup.torque(place, from.side);
        self.segment.depart(&self.state, &Input { constant, waveform: None });
    }
}

/// Takes a sight over.
pub fn see(state: &mut State, sight: &Sight) {
    (state.rigid_angle, state.rigid_rate) = (sight.angle, sight.rate);
    for (phase, [displacement, quadrature]) in state.modes.iter_mut().zip(&sight.modes) {
        *phase = motion::Phase { displacement: *displacement, quadrature: *quadrature };
    }
}

fn instant((whole, part): (u64, u64)) -> Instant {
    Instant::of_parts(whole, part)
}

impl Crew for Runs<'_> {
    fn listens(&self) -> bool {
        self.listens
    }

    fn looks(&self) -> bool {
        self.looks
    }

    fn next(&mut self, lane: usize) -> Option<Setup> {
        if let Some(ended) = self.lanes[lane].take() {
            let is_whole = !ended.is_alone && ended.state.is_finite();
            self.found[ended.index] = is_whole.then(|| ended.gather.finish(ended.scenario));
        }
        while let Some(job) = self.jobs.get(self.next) {
            self.next += 1;
            let Some(law) = law(job.scenario) else { continue };
            if Self::structure(job.scenario) != Self::structure(self.jobs[0].scenario) {
                continue;
            }
            let mut gather = Gather::of(job.scenario, job.selection);
            let row = record::Law { state: Phase::Start, torque_nm: law.weak.get(), gain: law.k_t.get() };
            self.listens |= gather.switchings();
            self.looks |= gather.course() != Course::None;
            if gather.record(Instant::START, Sample::Begin(&row)).is_err() {
                continue;
            }
            let model = &job.scenario.model;
            let setup = setup(job.scenario, model, law);
            self.lanes[lane] = Some(Lane {
                index: self.next - 1,
                scenario: job.scenario,
                setup: setup.clone(),
                gather,
                monitor: job.scenario.monitor(Seed { scenario: job.scenario.seed, run: job.number }),
                segment: Segment::new(model),
                state: model.start(),
                is_alone: false,
            });
            return Some(setup);
        }
        None
    }

    fn search(&mut self, lane: usize, place: Place, from: &Sight) -> Option<Searched> {
        let lane = self.lanes[lane].as_mut()?;
        lane.depart(place, from);
        let guards = lane.setup.guards(place, from.side);
        let horizon = (Instant::START + lane.scenario.duration).since(instant(from.at));
        let trip = locate(&lane.segment, &guards, horizon, &mut lane.state, || Ok::<(), ()>(()));
        lane.is_alone |= !lane.state.is_finite();
        let trip = trip.ok().flatten()?;
        let modes = lane.state.modes.iter().map(|phase| [phase.displacement, phase.quadrature]);
        Some(Searched {
            after: ((Instant::START + trip.after).parts(), trip.after.seconds()),
            right: trip.guard == 0,
            modes: modes.collect(),
        })
    }

    fn give_up(&mut self, lane: usize) {
        if let Some(lane) = &mut self.lanes[lane] {
            lane.is_alone = true;
        }
    }

    fn switched(&mut self, lane: usize, to: Place, now: &Sight) {
        let Some(lane) = &mut self.lanes[lane] else { return };
        let state = phase(to, now.side);
        see(&mut lane.state, now);
        let at = instant(now.at);
        let (time_s, time_whole_s, time_fs) = Command::times(at);
        let command = Command {
            time_s,
            time_whole_s,
            time_fs,
            state,
            cause: if to == Place::Coast { Trigger::Timeout } else { Trigger::Guard },
            torque_nm: lane.setup.torque(to, now.side),
            angle_rad: lane.state.angle(),
            rate_rad_s: now.rate,
            gain: now.gain,
        };
        lane.is_alone |= lane.gather.record(at, Sample::Switching(&command, &lane.state)).is_err();
    }

    fn closed(&mut self, lane: usize, at: (u64, u64), integral: f64, gain: f64) -> f64 {
        let Some(lane) = &mut self.lanes[lane] else { return gain };
        let Some(monitor) = &mut lane.monitor else { return gain };
        let now = instant(at);
        let closed = monitor.conclude(now, integral, gain);
        lane.is_alone |= lane.gather.record(now, Sample::Window(&closed.mean)).is_err();
        let Some((row, _)) = &closed.step else { return gain };
        lane.is_alone |= lane.gather.record(now, Sample::Adaptation(row)).is_err();
        row.gain
    }

    fn strays(&mut self, lane: usize, place: Place, from: &Sight, until: (u64, u64)) {
        let Some(lane) = self.lanes[lane].as_mut().filter(|lane| lane.gather.course() != Course::None) else {
            return;
        };
        lane.depart(place, from);
        let band = lane.scenario.promise().band(f64::NAN);
        let span: Span = instant(until).since(instant(from.at));
        let guards = [Guard::at_least(band), Guard::at_most(-band)];
        let stays = lane.segment.stays_within(band, span.seconds())
            || matches!(
                locate(&lane.segment, &guards, span, &mut lane.state.clone(), || Ok::<(), ()>(())),
                Ok(None)
            );
        lane.is_alone |= !stays;
    }

    fn band(&self, lane: usize) -> f64 {
        self.lanes[lane].as_ref().map_or(1.0, |lane| lane.scenario.promise().band(1.0))
    }
}

/// A run at its start, for a flight of its own; none of a run that has to be simulated otherwise.
pub fn alone(scenario: &Scenario) -> Option<Setup> {
    let law = law(scenario).filter(|law| suits(scenario, law))?;
    // A mode that nothing excites may come out of the mirror with zeros of another sign.
    let mut modes = scenario.model.modes.iter().chain(watched(scenario));
    modes.all(|mode| mode.gain.get() != 0.0).then(|| setup(scenario, &scenario.model, law))
}

/// A run at its start.
fn setup(scenario: &Scenario, model: &Planar, law: &Relay) -> Setup {
    let mobility = 1.0 / model.commanded_inertia();
    let of = |mode: &Mode| {
        let phase = mode.start();
        [mode.frequency.get(), mode.excitability(), phase.displacement, phase.quadrature]
    };
    let envelope = scenario.estimator.as_ref().and_then(Estimator::envelope);
    Setup {
        angle: model.angle.get(),
        rate: model.rate.get(),
        modes: model.modes.iter().map(of).collect(),
        tracks: watched(scenario).iter().map(of).collect(),
        edge: law.dead_zone.get(),
        back: law.dead_zone.get() - law.hysteresis.get(),
        torques: [law.strong.get(), law.weak.get()],
        strong: law.strong.get() * mobility,
        weak: law.weak.get() * mobility,
        k_t: law.k_t.get(),
        end: (Instant::START + scenario.duration).parts(),
        window: envelope.map(|envelope| (Instant::START + envelope.window).parts()),
    }
}
