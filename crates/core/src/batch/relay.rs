//! Batch of relay runs: the flow between switchings runs in lanes; window ends and metrics are processed run by run.

#[cfg(test)]
mod tests;

use super::{Batch, Job};
use crate::estimator::Monitor;
use crate::flight::{
    Crew, CyclePlace, LaneSight, MOST, Searched, Setup, Structure, flies, fly_beside, guards, instant, phase,
    searched, see, setup, structure,
};
use crate::flow::{ForcedInput, Segment};
use crate::guard::Guard;
use crate::lanes::Processor;
use crate::law::Phase;
use crate::metrics::{Gather, Metrics};
use crate::motion::State;
use crate::motion::crossing::locate;
use crate::random::Seed;
use crate::record::{self, Command, Course, Record, Sample, Trigger};
use crate::scenario::Scenario;
use crate::time::{Instant, Span};

/// Number of runs that share the lanes of one call of the kernel, one after the other.
const RUNS: usize = 128;
/// Longest duration of a run in a batch (s): the kernel returns no results before a run's end.
const LONGEST: f64 = 2e5;

/// Batch of relay runs.
pub struct Side;

impl Batch for Side {
    fn lanes(&self, _: Processor) -> usize {
        RUNS
    }

    fn takes(&self, scenario: &Scenario) -> bool {
        scenario.duration.seconds() <= LONGEST && flies(scenario).is_some()
    }

    fn simulate(&self, processor: Processor, jobs: &[Job<'_>]) -> Vec<Option<Metrics>> {
        let Some(first) = jobs.first() else { return Vec::new() };
        let mut runs = Runs::new(structure(first.scenario), jobs);
        fly_beside(processor, runs.structure, &mut runs);
        runs.found
    }
}

/// Runs of a batch, and the state of those in the lanes.
struct Runs<'a> {
    structure: Structure,
    jobs: &'a [Job<'a>],
    next: usize,
    lanes: Vec<Option<Lane<'a>>>,
    found: Vec<Option<Metrics>>,
    /// True if any of the runs needs its switchings (`listens`), or the instants at which the angle leaves the band
    /// (`looks`).
    listens: bool,
    looks: bool,
}

/// Run in a lane.
struct Lane<'a> {
    /// Index of the run's job.
    index: usize,
    scenario: &'a Scenario,
    setup: Setup,
    gather: Gather,
    monitor: Option<Monitor>,
    segment: Segment,
    state: State,
    /// True if the run has to be simulated alone.
    is_alone: bool,
}

impl<'a> Runs<'a> {
    fn new(structure: Structure, jobs: &'a [Job<'a>]) -> Self {
        let lanes = (0..MOST).map(|_| None).collect();
        let found = vec![None; jobs.len()];
        Self { structure, jobs, next: 0, lanes, found, listens: false, looks: false }
    }
}

impl Lane<'_> {
    /// Begins a segment at the state of the lane, with the torque of `place`.
    fn depart(&mut self, place: CyclePlace, from: &LaneSight) {
        see(&mut self.state, from);
        let constant = self.setup.torque(place, from.side);
        self.segment.depart(&self.state, &ForcedInput { constant, waveform: None });
    }
}

impl Crew for Runs<'_> {
    fn listens(&self) -> bool {
        self.listens
    }

    fn looks(&self) -> bool {
        self.looks
    }

    fn next(&mut self, lane: usize) -> Option<&Setup> {
        if let Some(ended) = self.lanes[lane].take() {
            let is_whole = !ended.is_alone && ended.state.is_finite();
            self.found[ended.index] = is_whole.then(|| ended.gather.finish(ended.scenario));
        }
        while let Some(job) = self.jobs.get(self.next) {
            self.next += 1;
            let Some((model, law)) = flies(job.scenario) else { continue };
            if structure(job.scenario) != self.structure {
                continue;
            }
            let mut gather = Gather::of(job.scenario, job.selection);
            let row = record::Law { state: Phase::Start, torque_nm: law.weak.get(), gain: law.k_t.get() };
            self.listens |= gather.switchings();
            self.looks |= gather.course() != Course::None;
            if gather.record(Instant::START, Sample::Begin(&row)).is_err() {
                continue;
            }
            let setup = setup(job.scenario, model, law);
            let begun = self.lanes[lane].insert(Lane {
                index: self.next - 1,
                scenario: job.scenario,
                setup,
                gather,
                monitor: job.scenario.monitor(Seed { scenario: job.scenario.seed, run: job.number }),
                segment: Segment::new(model),
                state: model.start(),
                is_alone: false,
            });
            return Some(&begun.setup);
        }
        None
    }

    fn search(&mut self, lane: usize, place: CyclePlace, from: &LaneSight, found: &mut Searched) -> bool {
        let Some(lane) = self.lanes[lane].as_mut() else { return false };
        lane.depart(place, from);
        let guards = guards(&lane.setup, place, from.side);
        let horizon = (Instant::START + lane.scenario.duration).since(instant(from.at));
        let trip = locate(&lane.segment, &guards, horizon, &mut lane.state, || Ok::<(), ()>(()));
        lane.is_alone |= !lane.state.is_finite();
        let Ok(Some(trip)) = trip else { return false };
        searched(found, trip.after, trip.guard == 0, &lane.state);
        true
    }

    fn give_up(&mut self, lane: usize) {
        if let Some(lane) = &mut self.lanes[lane] {
            lane.is_alone = true;
        }
    }

    fn chatters(&mut self, lane: usize, _: (u64, u64)) {
        // Alone it ends as it does here, with an error.
        self.give_up(lane);
    }

    fn switched(&mut self, lane: usize, to: CyclePlace, now: &LaneSight) {
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
            cause: if to == CyclePlace::Coast { Trigger::Timeout } else { Trigger::Guard },
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

    fn strays(&mut self, lane: usize, place: CyclePlace, from: &LaneSight, until: (u64, u64)) {
        let Some(lane) = self.lanes[lane].as_mut().filter(|lane| lane.gather.course() != Course::None) else {
            return;
        };
        lane.depart(place, from);
        let band = lane.setup.band;
        let span: Span = instant(until).since(instant(from.at));
        let guards = [Guard::at_least(band), Guard::at_most(-band)];
        let stays = lane.segment.stays_within(band, span.seconds())
            || matches!(
                locate(&lane.segment, &guards, span, &mut lane.state.clone(), || Ok::<(), ()>(())),
                Ok(None)
            );
        lane.is_alone |= !stays;
    }
}
