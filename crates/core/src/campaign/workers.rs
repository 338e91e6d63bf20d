//! Worker threads of a campaign, whose runs are reported in order.

use std::collections::BTreeMap;
use std::ops::Range;
use std::sync::mpsc::{Receiver, RecvTimeoutError, Sender, channel};
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError};
use std::thread;
use std::time::{Duration, Instant};

use super::{Campaign, CampaignRun, RunError, RunOutcome};
use crate::batch::{self, BatchJob};
use crate::metrics::{Metrics, Selection};

/// Largest number of runs by which a run may be ahead of the one reported next: the runs between wait in memory.
const AHEAD: u64 = 4096;
/// Longest time without a report.
const REPORT_INTERVAL: Duration = Duration::from_millis(20);
/// Number of runs that a thread begins at once if they are simulated in a batch.
const BATCH_SIZE: u64 = 64;
/// Time for which a stopped campaign waits for the current runs, which are stopped too.
const STOP_TIMEOUT: Duration = Duration::from_millis(500);

/// State shared by the threads: the run that begins next, and the run that is reported next.
struct WorkerPool {
    state: Mutex<PoolState>,
    progressed: Condvar,
}

struct PoolState {
    next: u64,
    due: u64,
    end: u64,
}

impl WorkerPool {
    fn state(&self) -> MutexGuard<'_, PoolState> {
        // The numbers are valid even if a thread panicked.
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Reserves the next `most` runs at most, waiting until they may begin; returns an empty range at the end.
    fn merge_from(&self, most: u64) -> Range<u64> {
        let mut state = self.state();
        while state.next < state.end && state.next - state.due >= AHEAD {
            state = self.progressed.wait(state).unwrap_or_else(PoisonError::into_inner);
        }
        let first = state.next.min(state.end);
        state.next = state.end.min(first + most);
        first..state.next
    }

    fn report(&self, due: u64) {
        self.state().due = due;
        self.progressed.notify_all();
    }

    /// Prevents any further run from beginning.
    fn close(&self) {
        self.state().end = 0;
        self.progressed.notify_all();
    }
}

/// Guard of a worker thread: if the thread panics, no thread begins another run.
struct Worker(Arc<WorkerPool>);

impl Drop for Worker {
    fn drop(&mut self) {
        if thread::panicking() {
            self.0.close();
        }
    }
}

impl Campaign {
    /// Simulates runs on `threads` threads, or with 0 on one for each core, and reports each, in the order of their
    /// numbers.
    ///
    /// `work` simulates one run, on any thread. `report` may stop the campaign with an error; it is called regularly
    /// without an outcome while no run ends. A run that does not stop then is abandoned.
    ///
    /// # Panics
    /// If a run panics.
    pub fn for_each_run<E>(
        self: &Arc<Self>,
        runs: Range<u64>,
        threads: usize,
        work: impl Fn(&CampaignRun) -> Result<Metrics, RunError> + Send + Sync + 'static,
        report: impl FnMut(Option<RunOutcome>) -> Result<(), E>,
    ) -> Result<(), E> {
        self.run_pool(runs, threads, (1, Selection::ALL), work, report)
    }

    /// Simulates runs like [`Campaign::for_each_run`], for the selected metrics, if `work` only simulates: runs of one
    /// structure are then simulated in batches where possible, with equal results.
    pub fn for_each_run_in_batches<E>(
        self: &Arc<Self>,
        runs: Range<u64>,
        threads: usize,
        selection: &Selection,
        work: impl Fn(&CampaignRun) -> Result<Metrics, RunError> + Send + Sync + 'static,
        report: impl FnMut(Option<RunOutcome>) -> Result<(), E>,
    ) -> Result<(), E> {
        // Values that are not numbers may give runs of several structures.
        let is_one = self.design().is_numeric() && batch::accepts(self.scenario());
        let most = if is_one { BATCH_SIZE } else { 1 };
        self.run_pool(runs, threads, (most, selection.clone()), work, report)
    }

    fn run_pool<E>(
        self: &Arc<Self>,
        runs: Range<u64>,
        threads: usize,
        (most, selection): (u64, Selection),
        work: impl Fn(&CampaignRun) -> Result<Metrics, RunError> + Send + Sync + 'static,
        mut report: impl FnMut(Option<RunOutcome>) -> Result<(), E>,
    ) -> Result<(), E> {
        let state = PoolState { next: runs.start, due: runs.start, end: runs.end };
        let pool = Arc::new(WorkerPool { state: Mutex::new(state), progressed: Condvar::new() });
        let (outcomes, ended) = channel();
        let work = Arc::new(work);
        let count = runs.end.saturating_sub(runs.start);
        let cores = || thread::available_parallelism().map_or(1, usize::from);
        let threads = if threads == 0 { cores() } else { threads };
        // Batches are small enough to leave work for every thread.
        let most = most.min(count / threads as u64).max(1);
        let mut started = 0;
        for _ in 0..threads.min(usize::try_from(count).unwrap_or(usize::MAX)) {
            let (campaign, worker, outcomes) = (self.clone(), Worker(pool.clone()), outcomes.clone());
            let (work, selection) = (work.clone(), selection.clone());
            let through = move || while campaign.work_on(&worker, (most, &selection), &outcomes, &*work) {};
            started += usize::from(thread::Builder::new().spawn(through).is_ok());
        }
        // Where the system has no thread left, this one does the work between the reports.
        let (here, outcomes) = (Worker(pool.clone()), (started == 0).then_some(outcomes));
        let mut work_here = || {
            if let Some(outcomes) = &outcomes {
                self.work_on(&here, (most, &selection), outcomes, &*work);
            }
        };
        let described = report_in_order(&pool, runs, &ended, &mut work_here, &mut report);
        if described.is_err() {
            pool.close();
            let began = Instant::now();
            while let Some(remaining) = STOP_TIMEOUT.checked_sub(began.elapsed()) {
                if ended.recv_timeout(remaining).is_err() {
                    break;
                }
            }
        }
        described
    }

    /// Simulates the next `most` runs at most, and returns true if there may be more.
    fn work_on(
        &self,
        worker: &Worker,
        (most, selection): (u64, &Selection),
        outcomes: &Sender<Vec<RunOutcome>>,
        work: &impl Fn(&CampaignRun) -> Result<Metrics, RunError>,
    ) -> bool {
        let numbers = worker.0.merge_from(most);
        if numbers.is_empty() {
            return false;
        }
        let mut notify = |some| outcomes.send(some).is_ok();
        if numbers.end - numbers.start > 1 {
            self.run_batch(numbers, selection, work, &mut notify)
        } else {
            notify(vec![self.run_outcome(numbers.start, selection, work)])
        }
    }

    /// Simulates runs in a batch where possible, and reports them as soon as they end; `work` simulates the others.
    /// Returns true if `report` accepts more.
    fn run_batch(
        &self,
        numbers: Range<u64>,
        selection: &Selection,
        work: &impl Fn(&CampaignRun) -> Result<Metrics, RunError>,
        report: &mut impl FnMut(Vec<RunOutcome>) -> bool,
    ) -> bool {
        let began = Instant::now();
        let runs: Vec<_> = numbers.map(|number| (number, self.run_for(number, selection))).collect();
        let whole = || runs.iter().filter_map(|(_, run)| run.as_ref().ok());
        let jobs: Vec<BatchJob<'_>> = whole()
            .map(|run| BatchJob { number: run.noise_run, scenario: &run.scenario, selection })
            .collect();
        let mut found = batch::simulate(&jobs).into_iter();
        // The time of the batch is divided equally among its runs.
        let seconds = began.elapsed().as_secs_f64() / runs.len().max(1) as f64;
        let (mut known, mut single) = (Vec::with_capacity(runs.len()), Vec::new());
        for (number, run) in runs {
            let (drawn, metrics) = match run {
                Ok(run) => {
                    let Some(metrics) = found.next().flatten() else {
                        single.push((number, run));
                        continue;
                    };
                    (run.drawn, Ok(selection.select(metrics)))
                }
                Err(error) => (self.draw(number), Err(RunError::from(error))),
            };
            known.push(RunOutcome { number, drawn, metrics, seconds });
        }
        report(known)
            && single.into_iter().all(|(number, run)| {
                let began = Instant::now();
                let metrics = work(&run);
                let seconds = began.elapsed().as_secs_f64();
                report(vec![RunOutcome { number, metrics, drawn: run.drawn, seconds }])
            })
    }
}

fn report_in_order<E>(
    pool: &WorkerPool,
    runs: Range<u64>,
    ended: &Receiver<Vec<RunOutcome>>,
    work_here: &mut impl FnMut(),
    report: &mut impl FnMut(Option<RunOutcome>) -> Result<(), E>,
) -> Result<(), E> {
    let mut early = BTreeMap::new();
    let mut due = runs.start;
    while due < runs.end {
        work_here();
        match ended.recv_timeout(REPORT_INTERVAL) {
            Ok(some) => early.extend(some.into_iter().map(|outcome| (outcome.number, outcome))),
            Err(RecvTimeoutError::Timeout) => {}
            Err(RecvTimeoutError::Disconnected) => panic!("run {due} panicked"),
        }
        if !early.contains_key(&due) {
            report(None)?;
            continue;
        }
        while let Some(outcome) = early.remove(&due) {
            report(Some(outcome))?;
            due += 1;
        }
        pool.report(due);
    }
    Ok(())
}
