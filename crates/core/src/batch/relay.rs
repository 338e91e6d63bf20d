//! Batch of relay runs: the flow between switchings runs in lanes; window ends and metrics are processed run by run.

#[cfg(test)]
mod tests;

use flexsc_control::estimator::WindowedEnvelope;
use flexsc_control::law::Phase;
use flexsc_dynamics::AxisState;
use flexsc_dynamics::crossing::first_crossing;
use flexsc_dynamics::flow::{SegmentInput, UncoupledSegment};
use flexsc_dynamics::guard::Guard;
use flexsc_numerics::lanes::Processor;
use flexsc_numerics::random::Seed;
use flexsc_numerics::time::{Instant, Span};
use flexsc_record::{self, Command, PieceDemand, Record, Sample, Trigger};

use super::{BatchJob, BatchKernel};
use crate::metrics::{Metrics, MetricsCollector};
use flexsc_scenario::Scenario;
use flexsc_sim::relay_setup::{
    CyclePhase, FoundCrossing, LaneHost, LaneShape, LaneState, MOST, RunSetup, apply_crossing, apply_state,
    guards, instant, is_supported, lane_setup, lane_shape, law_state, run_lanes,
};

/// Number of runs that share the lanes of one call of the kernel, one after the other.
const RUNS: usize = 128;
/// Longest duration of a run in a batch (s): the kernel returns no results before a run's end.
const LONGEST: f64 = 2e5;

/// Batch of relay runs.
pub struct RelayBatch;

impl BatchKernel for RelayBatch {
    fn lanes(&self, _: Processor) -> usize {
        RUNS
    }

    fn accepts(&self, scenario: &Scenario) -> bool {
        scenario.duration.seconds() <= LONGEST && is_supported(scenario).is_some()
    }

    fn simulate(&self, processor: Processor, jobs: &[BatchJob<'_>]) -> Vec<Option<Metrics>> {
        let Some(first) = jobs.first() else { return Vec::new() };
        let mut runs = LaneRuns::new(lane_shape(first.scenario), jobs);
        run_lanes(processor, runs.structure, &mut runs);
        runs.found
    }
}

/// Runs of a batch, and the state of those in the lanes.
struct LaneRuns<'a> {
    structure: LaneShape,
    jobs: &'a [BatchJob<'a>],
    next: usize,
    lanes: Vec<Option<LaneRun<'a>>>,
    found: Vec<Option<Metrics>>,
    /// True if any of the runs needs its switchings (`wants_switchings`), or the instants at which the angle leaves the band
    /// (`wants_band_exits`).
    wants_switchings: bool,
    wants_band_exits: bool,
}

/// Run in a lane.
struct LaneRun<'a> {
    /// Index of the run's job.
    index: usize,
    scenario: &'a Scenario,
    setup: RunSetup,
    gather: MetricsCollector,
    monitor: Option<WindowedEnvelope>,
    segment: UncoupledSegment,
    state: AxisState,
    /// True if the run has to be simulated alone.
    is_single: bool,
}

impl<'a> LaneRuns<'a> {
    fn new(structure: LaneShape, jobs: &'a [BatchJob<'a>]) -> Self {
        let lanes = (0..MOST).map(|_| None).collect();
        let found = vec![None; jobs.len()];
        Self { structure, jobs, next: 0, lanes, found, wants_switchings: false, wants_band_exits: false }
    }
}

impl LaneRun<'_> {
    /// Begins a segment at the state of the lane, with the torque of `phase`.
    fn begin(&mut self, phase: CyclePhase, from: &LaneState) {
        apply_state(&mut self.state, from);
        let constant = self.setup.torque(phase, from.side);
        self.segment.depart(&self.state, &SegmentInput { constant, waveform: None });
    }
}

impl LaneHost for LaneRuns<'_> {
    fn wants_switchings(&self) -> bool {
        self.wants_switchings
    }

    fn wants_band_exits(&self) -> bool {
        self.wants_band_exits
    }

    fn next_run(&mut self, lane: usize) -> Option<&RunSetup> {
        if let Some(ended) = self.lanes[lane].take() {
            let is_whole = !ended.is_single && ended.state.is_bounded();
            self.found[ended.index] = is_whole.then(|| ended.gather.finish(ended.scenario));
        }
        while let Some(job) = self.jobs.get(self.next) {
            self.next += 1;
            let Some((model, law)) = is_supported(job.scenario) else { continue };
            if lane_shape(job.scenario) != self.structure {
                continue;
            }
            let mut gather = MetricsCollector::for_selection(job.scenario, job.selection);
            let row =
                flexsc_record::Law { state: Phase::Start, torque_nm: law.weak.get(), gain: law.k_t.get() };
            self.wants_switchings |= gather.wants_switchings();
            self.wants_band_exits |= gather.piece_demand() != PieceDemand::None;
            if gather.record(Instant::START, Sample::Begin(&row)).is_err() {
                continue;
            }
            let setup = lane_setup(job.scenario, model, law);
            let started = self.lanes[lane].insert(LaneRun {
                index: self.next - 1,
                scenario: job.scenario,
                setup,
                gather,
                monitor: job.scenario.monitor(Seed { scenario: job.scenario.seed, run: job.number }),
                segment: UncoupledSegment::new(model),
                state: model.initial_state(),
                is_single: false,
            });
            return Some(&started.setup);
        }
        None
    }

    fn find_crossing(
        &mut self,
        lane: usize,
        phase: CyclePhase,
        from: &LaneState,
        found: &mut FoundCrossing,
    ) -> bool {
        let Some(lane) = self.lanes[lane].as_mut() else { return false };
        lane.begin(phase, from);
        let guards = guards(&lane.setup, phase, from.side);
        let horizon = (Instant::START + lane.scenario.duration).since(instant(from.time));
        let trip = first_crossing(&lane.segment, &guards, horizon, &mut lane.state, || Ok::<(), ()>(()));
        lane.is_single |= !lane.state.is_bounded();
        let Ok(Some(trip)) = trip else { return false };
        apply_crossing(found, trip.after, trip.guard == 0, &lane.state);
        true
    }

    fn reject(&mut self, lane: usize) {
        if let Some(lane) = &mut self.lanes[lane] {
            lane.is_single = true;
        }
    }

    fn chatters(&mut self, lane: usize, _: (u64, u64)) {
        // Alone it ends as it does here, with an error.
        self.reject(lane);
    }

    fn on_switching(&mut self, lane: usize, next: CyclePhase, now: &LaneState) {
        let Some(lane) = &mut self.lanes[lane] else { return };
        let state = law_state(next, now.side);
        apply_state(&mut lane.state, now);
        let time = instant(now.time);
        let (time_s, time_whole_s, time_fs) = Command::times(time);
        let command = Command {
            time_s,
            time_whole_s,
            time_fs,
            state,
            cause: if next == CyclePhase::Coast { Trigger::Timeout } else { Trigger::Guard },
            torque_nm: lane.setup.torque(next, now.side),
            angle_rad: lane.state.angle(),
            rate_rad_s: now.rate,
            gain: now.gain,
        };
        lane.is_single |= lane.gather.record(time, Sample::Switching(&command, &lane.state)).is_err();
    }

    fn on_window(&mut self, lane: usize, time: (u64, u64), integral: f64, gain: f64) -> f64 {
        let Some(lane) = &mut self.lanes[lane] else { return gain };
        let Some(monitor) = &mut lane.monitor else { return gain };
        let now = instant(time);
        let closed = monitor.close_with(now, integral, gain);
        lane.is_single |= lane.gather.record(now, Sample::Row(&closed.mean)).is_err();
        let Some((row, _)) = &closed.step else { return gain };
        lane.is_single |= lane.gather.record(now, Sample::Row(row)).is_err();
        row.gain
    }

    fn on_possible_band_exit(&mut self, lane: usize, phase: CyclePhase, from: &LaneState, until: (u64, u64)) {
        let Some(lane) =
            self.lanes[lane].as_mut().filter(|lane| lane.gather.piece_demand() != PieceDemand::None)
        else {
            return;
        };
        lane.begin(phase, from);
        let band = lane.setup.band;
        let span: Span = instant(until).since(instant(from.time));
        let guards = [Guard::at_least(band), Guard::at_most(-band)];
        let stays = lane.segment.stays_within(band, span.seconds())
            || matches!(
                first_crossing(&lane.segment, &guards, span, &mut lane.state.clone(), || Ok::<(), ()>(())),
                Ok(None)
            );
        lane.is_single |= !stays;
    }
}
