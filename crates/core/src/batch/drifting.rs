//! Sampled loops about a body with drifting frequencies: each run senses, estimates and decides on its own, and the motions
//! between their events, which are most of the work, are computed side by side.
//!
//! The runs share no clock: in each round every run goes to its own next event, whatever it is.

use super::{Batch, Job};
use crate::body::{Drifting, Ratio, SERIES, Springs};
use crate::estimator::Estimator;
use crate::lanes::{Mask, Processor, Real, Work};
use crate::law::Law;
use crate::metrics::{Courses, Gather, Metrics, Passed};
use crate::scenario::Scenario;
use crate::sim::{Exerted, Simulation};
use crate::time::Instant;

/// The batch.
pub struct Side;

impl Batch for Side {
    fn lanes(&self, processor: Processor) -> usize {
        processor.lanes(1)
    }

    fn takes(&self, scenario: &Scenario) -> bool {
        scenario.drift.is_some()
            && matches!(scenario.law, Law::Pd(_))
            && scenario.plan.is_none()
            && scenario.model.outputs.is_empty()
            && scenario.estimator.as_ref().is_none_or(|estimator| !matches!(estimator, Estimator::Own(_)))
    }

    fn simulate(&self, processor: Processor, jobs: &[Job<'_>]) -> Vec<Option<Metrics>> {
        let mut runs = Vec::with_capacity(jobs.len());
        for job in jobs {
            let Some(run) = Run::new(job) else { return vec![None; jobs.len()] };
            runs.push(run);
        }
        let mut gathers: Vec<Gather> = jobs.iter().map(|job| Gather::new(job.scenario)).collect();
        if gathers.iter_mut().any(|gather| gather.rotation().is_none()) {
            return vec![None; jobs.len()];
        }
        processor.run::<1, _>(Rounds { runs: &mut runs, gathers: &mut gathers });
        let whole = runs.iter().map(|run| run.is_whole);
        let finished = gathers.into_iter().zip(jobs).map(|(gather, job)| gather.finish(job.scenario));
        finished.zip(whole).map(|(metrics, whole)| whole.then_some(metrics)).collect()
    }
}

/// A run among others.
struct Run {
    simulation: Simulation,
    motion: Drifting,
    /// When its motion began, its reduced moment (rad/s²), and its torques.
    departed: Instant,
    moment: f64,
    exerted: Exerted,
    /// Whether the simulation goes on, and whether it has come to its end side by side.
    goes_on: bool,
    is_whole: bool,
}

impl Run {
    fn new(job: &Job<'_>) -> Option<Self> {
        let mut simulation = Simulation::new(job.scenario, job.number);
        let motion = simulation.lend()?;
        Some(Self {
            simulation,
            motion,
            departed: Instant::START,
            moment: 0.0,
            exerted: Exerted::default(),
            goes_on: true,
            is_whole: false,
        })
    }

    /// Begins: what it departs under.
    fn begin(&mut self, gather: &mut Gather) {
        self.goes_on = self.simulation.begin_lent(gather).is_ok();
        self.depart();
    }

    /// Whether a new motion began, which it goes on with.
    fn depart(&mut self) -> bool {
        let Some((at, moment, exerted)) = self.simulation.departed() else { return false };
        (self.departed, self.moment, self.exerted) = (at, moment, exerted);
        true
    }
}

/// The work of all runs.
struct Rounds<'a> {
    runs: &'a mut [Run],
    gathers: &'a mut [Gather],
}

impl Work for Rounds<'_> {
    type Output = ();

    #[inline(always)]
    fn run<R: Real>(self, kind: R) {
        let Self { runs, gathers } = self;
        let springs: Vec<&Springs<f64>> = runs.iter().map(|run| run.motion.springs()).collect();
        let (Some(springs), ratios) = (Springs::beside(kind, &springs), runs[0].motion.ratios()) else {
            return;
        };
        let count = springs.count();
        if runs.iter().any(|run| run.motion.ratios() != ratios || run.motion.springs().count() != count) {
            return;
        }
        let zero = kind.of(0.0);
        let (mut series, mut each) = (vec![zero; SERIES * count], [0.0; 16]);
        for index in 0..2 * count {
            for (lane, run) in runs.iter().enumerate() {
                each[lane] = run.motion.start()[index];
            }
            series[index] = kind.load(&each);
        }
        for (run, gather) in runs.iter_mut().zip(gathers.iter_mut()) {
            run.begin(gather);
        }
        let mut alone = vec![vec![Ratio::new(0.0); ratios]; runs.len()];
        let mut beside = vec![Ratio::new(kind); ratios];
        let mut courses = Courses::new(kind);
        // Where the bodies are: angles and rates of all coordinates.
        let mut here = [vec![zero; count], vec![zero; count]];
        let mut rows = vec![[0.0; 16]; 2 * count];
        let mut fresh = true;
        let (mut spans, mut froms, mut counts) = ([0.0; 16], [0.0; 16], [false; 16]);
        while runs.iter().any(|run| run.goes_on) {
            if fresh {
                fill(&springs, runs, &mut alone, &mut beside, kind, &mut series);
            }
            let mut next = [Instant::START; 16];
            let mut due = [false; 16];
            for (lane, run) in runs.iter().enumerate() {
                (next[lane], due[lane]) = run.simulation.following();
                spans[lane] = if run.goes_on { next[lane].since(run.departed).seconds() } else { 0.0 };
            }
            let h = kind.load(&spans);
            let sure = springs.surely_reach(&series, h);
            let reached = R::select(sure, zero.of(1.0), zero);
            for index in 0..count {
                let [angle, rate, _] = springs.at(&series, index, h);
                (here[0][index], here[1][index]) = (angle, rate);
                angle.store(&mut rows[2 * index]);
                rate.store(&mut rows[2 * index + 1]);
            }
            let mut departs = [false; 16];
            let before: [(Instant, Exerted); 16] = {
                let mut before = [(Instant::START, Exerted::default()); 16];
                for (lane, run) in runs.iter().enumerate() {
                    before[lane] = (run.departed, run.exerted);
                }
                before
            };
            for (lane, run) in runs.iter_mut().enumerate() {
                counts[lane] = false;
                if !run.goes_on {
                    continue;
                }
                if !sure.all() && reached.lane(lane) == 0.0 {
                    run.goes_on = false;
                    continue;
                }
                let motion = (0..count).map(|index| [rows[2 * index][lane], rows[2 * index + 1][lane]]);
                run.simulation.bring(next[lane], motion);
                let gather = &mut gathers[lane];
                let done = if due[lane] { run.simulation.act(gather) } else { run.simulation.end(gather) };
                run.is_whole = done.is_ok() && !due[lane];
                run.goes_on = done.is_ok() && due[lane];
                departs[lane] = run.depart();
                counts[lane] = (departs[lane] || run.is_whole) && spans[lane] > 0.0;
                froms[lane] = before[lane].0.seconds();
            }
            let load = |of: &dyn Fn(usize) -> f64| -> R {
                let mut each = [0.0; 16];
                for lane in 0..runs.len() {
                    each[lane] = of(lane);
                }
                kind.load(&each)
            };
            courses.see(
                gathers,
                &Passed {
                    from: kind.load(&froms),
                    length: h,
                    series: &series,
                    count,
                    constant: load(&|lane| before[lane].1.constant),
                    back_emf: (load(&|lane| before[lane].1.back_emf.0), before[0].1.back_emf.1),
                    feedback: load(&|lane| before[lane].1.feedback),
                    counts: &counts,
                },
            );
            // Those that depart do so from where they are.
            fresh = departs.iter().any(|departs| *departs);
            if fresh {
                for (lane, departs) in departs.iter().enumerate() {
                    each[lane] = f64::from(u8::from(*departs));
                }
                let departs = zero.lt(kind.load(&each));
                for index in 0..count {
                    series[index] = R::select(departs, here[0][index], series[index]);
                    series[count + index] = R::select(departs, here[1][index], series[count + index]);
                }
            }
        }
        courses.finish(gathers);
    }
}

/// Fills the series of all motions from their first two terms.
#[inline(always)]
fn fill<R: Real>(
    springs: &Springs<R>,
    runs: &[Run],
    alone: &mut [Vec<Ratio<f64>>],
    beside: &mut [Ratio<R>],
    kind: R,
    series: &mut [R],
) {
    let mut moments = [0.0; 16];
    for (lane, run) in runs.iter().enumerate() {
        moments[lane] = run.moment;
        run.motion.expand_ratios(run.departed.seconds(), &mut alone[lane]);
    }
    for (index, ratio) in beside.iter_mut().enumerate() {
        ratio.put(alone, index);
    }
    springs.fill(beside, kind.load(&moments), series);
}
