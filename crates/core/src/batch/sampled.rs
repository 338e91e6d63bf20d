//! Batch of sampled loops of a body with a wheel or with drifting frequencies: sensors, estimators and laws are
//! evaluated run by run, and the motions between events, which are most of the work, are computed in lanes.
//!
//! The runs share no clock: in each round every run advances to its own next event.

mod filters;
mod motions;

use flexsc_dynamics::flow::ExternalMotion;
use flexsc_numerics::lanes::{LaneFloat, Mask, Processor, SimdTask};
use flexsc_numerics::time::Instant;
use flexsc_record::{PieceDemand, Record};

use super::{BatchJob, BatchKernel};
use crate::metrics::{LaneManoeuvreMetrics, LanePiece, Metrics, MetricsCollector};
use flexsc_scenario::Scenario;
use flexsc_sim::{AppliedTorque, Simulation};
use motions::LaneMotions;

/// Batch of sampled loops.
pub struct SampledBatch;

impl BatchKernel for SampledBatch {
    fn lanes(&self, processor: Processor) -> usize {
        processor.lanes(1)
    }

    fn accepts(&self, scenario: &Scenario) -> bool {
        (scenario.drift.is_some() || scenario.actuator.flywheel().is_some())
            && scenario.actuator.only_actuator().is_some()
            && scenario.law.pd().is_some()
            && scenario.plan.is_none()
            && scenario.model.outputs().is_empty()
    }

    fn simulate(&self, processor: Processor, jobs: &[BatchJob<'_>]) -> Vec<Option<Metrics>> {
        let mut runs = Vec::with_capacity(jobs.len());
        for job in jobs {
            let Some(run) = BatchedRun::new(job) else { return vec![None; jobs.len()] };
            runs.push(run);
        }
        let mut gathers: Vec<MetricsCollector> = Vec::with_capacity(jobs.len());
        for job in jobs {
            // Runs that differ only in their noise begin with equal metrics.
            let alike = jobs.iter().zip(&gathers).find(|(other, _)| other.scenario == job.scenario);
            let gather = alike.map(|(_, gather)| gather.clone());
            gathers
                .push(gather.unwrap_or_else(|| MetricsCollector::for_selection(job.scenario, job.selection)));
        }
        if gathers.iter_mut().any(|gather| gather.rotation().is_none()) {
            return vec![None; jobs.len()];
        }
        processor.run::<1, _>(BatchLoop { runs: &mut runs, gathers: &mut gathers });
        let whole = runs.iter().map(|run| run.is_whole);
        let finished = gathers.into_iter().zip(jobs).map(|(gather, job)| gather.finish(job.scenario));
        finished.zip(whole).map(|(metrics, whole)| whole.then_some(metrics)).collect()
    }
}

/// Run of a batch.
struct BatchedRun {
    simulation: Simulation,
    motion: ExternalMotion,
    /// Start of the current segment, its reduced moment (rad/s²), and its torques.
    segment_start: Instant,
    moment: f64,
    applied: AppliedTorque,
    /// True while the simulation continues (`continues`), and true if it has ended within the batch (`is_whole`).
    continues: bool,
    is_whole: bool,
}

impl BatchedRun {
    fn new(job: &BatchJob<'_>) -> Option<Self> {
        let mut simulation = Simulation::new(job.scenario, job.number);
        let motion = simulation.take_motion()?;
        Some(Self {
            simulation,
            motion,
            segment_start: Instant::START,
            moment: 0.0,
            applied: AppliedTorque::default(),
            continues: true,
            is_whole: false,
        })
    }

    /// Begins the run and its first segment.
    fn begin(&mut self, gather: &mut MetricsCollector) {
        self.continues = self.simulation.begin_external(gather).is_ok();
        self.begin_segments();
    }

    /// Adopts a new segment of the simulation; returns true if there is one.
    fn begin_segments(&mut self) -> bool {
        let Some((start, moment, applied)) = self.simulation.take_segment_start() else { return false };
        (self.segment_start, self.moment, self.applied) = (start, moment, applied);
        true
    }
}

/// Loop over the events of all runs.
struct BatchLoop<'a> {
    runs: &'a mut [BatchedRun],
    gathers: &'a mut [MetricsCollector],
}

impl SimdTask for BatchLoop<'_> {
    type Output = ();

    #[inline(always)]
    fn run<R: LaneFloat>(self, kind: R) {
        let Self { runs, gathers } = self;
        let Some(mut motions) = LaneMotions::new(kind, runs) else { return };
        let (count, zero) = (motions.count, kind.splat(0.0));
        for (run, gather) in runs.iter_mut().zip(gathers.iter_mut()) {
            run.begin(gather);
        }
        if !filters::same_kind(runs) {
            return;
        }
        let mut filters = filters::from_runs(kind, runs);
        let mut courses = LaneManoeuvreMetrics::new(kind);
        let wants_course = gathers.iter().any(|gather| gather.piece_demand() != PieceDemand::None);
        // State of the bodies: angles and rates of all coordinates.
        let mut states = vec![zero; 2 * count];
        let mut rows = vec![[0.0; 16]; 2 * count];
        let mut fresh = true;
        let (mut spans, mut froms, mut counts) = ([0.0; 16], [0.0; 16], [false; 16]);
        while runs.iter().any(|run| run.continues) {
            if fresh {
                motions.expand(runs, kind);
            }
            let (mut next, mut due) = ([Instant::START; 16], [false; 16]);
            for (lane, run) in runs.iter().enumerate() {
                (next[lane], due[lane]) = run.simulation.next_stop();
                if run.continues {
                    spans[lane] = next[lane].since(run.segment_start).seconds();
                }
            }
            let h = kind.load(&spans);
            let sure = motions.radius(h);
            let reached = R::select(sure, zero.splat(1.0), zero);
            motions.evaluate(&spans, h, &mut states);
            for index in 0..2 * count {
                states[index].store(&mut rows[index]);
            }
            let mut begins_segment = [false; 16];
            let mut before = [(Instant::START, AppliedTorque::default()); 16];
            for (before, run) in before.iter_mut().zip(runs.iter()) {
                *before = (run.segment_start, run.applied);
            }
            for (lane, run) in runs.iter_mut().enumerate() {
                if !sure.all() && reached.lane(lane) == 0.0 {
                    run.continues = false;
                }
                if run.continues {
                    let motion = (0..count).map(|index| [rows[index][lane], rows[count + index][lane]]);
                    run.simulation.set_motion(next[lane], motion);
                }
            }
            if let Some(filters) = &mut filters {
                filters::process_samples(filters, runs, gathers, &due, kind);
            }
            for (lane, run) in runs.iter_mut().enumerate() {
                counts[lane] = false;
                if !run.continues {
                    continue;
                }
                let gather = &mut gathers[lane];
                let done = if due[lane] {
                    run.simulation.process_instant(gather)
                } else {
                    run.simulation.finish_external(gather)
                };
                run.is_whole = done.is_ok() && !due[lane];
                run.continues = done.is_ok() && due[lane];
                begins_segment[lane] = run.begin_segments();
                counts[lane] = (begins_segment[lane] || run.is_whole) && spans[lane] > 0.0;
                froms[lane] = before[lane].0.seconds();
            }
            if wants_course {
                let load = |value_of: &dyn Fn(usize) -> f64| -> R {
                    let mut each = [0.0; 16];
                    for lane in 0..runs.len() {
                        each[lane] = value_of(lane);
                    }
                    kind.load(&each)
                };
                courses.observe(
                    gathers,
                    &LanePiece {
                        from: kind.load(&froms),
                        length: h,
                        series: &motions.series,
                        count,
                        constant: load(&|lane| before[lane].1.constant),
                        back_emf: (load(&|lane| before[lane].1.back_emf.0), before[0].1.back_emf.1),
                        feedback: load(&|lane| before[lane].1.feedback),
                        counts: &counts,
                    },
                );
            }
            // New segments begin at the current state of the bodies.
            fresh = begins_segment.iter().any(|begins_segment| *begins_segment);
            if fresh {
                let begins_segment = zero
                    .lt(kind.load(&begins_segment.map(|begins_segment| f64::from(u8::from(begins_segment)))));
                for index in 0..2 * count {
                    motions.series[index] = R::select(begins_segment, states[index], motions.series[index]);
                }
            }
        }
        courses.hand_over(gathers);
    }
}
