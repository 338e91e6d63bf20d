//! The runs of a campaign on several threads, reported in order.

use std::collections::BTreeMap;
use std::ops::Range;
use std::sync::mpsc::{Receiver, RecvTimeoutError, Sender, channel};
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError};
use std::thread;
use std::time::{Duration, Instant};

use super::{Campaign, CampaignRun, RunError, RunOutcome};
use crate::batch::{self, Job};
use crate::metrics::{Metrics, Selection};

/// No run begins that is so many runs ahead of the one reported next: those between wait in memory.
const AHEAD: u64 = 4096;
/// The longest time without a report.
const LOOK: Duration = Duration::from_millis(20);
/// So many runs are begun at once where they go side by side.
const BESIDE: u64 = 64;
/// How long a campaign that was stopped waits for the runs under way, which are stopped too.
const PATIENCE: Duration = Duration::from_millis(500);

/// What the threads share: which run is next, and which one is reported next.
struct Crew {
    state: Mutex<State>,
    told: Condvar,
}

struct State {
    next: u64,
    due: u64,
    end: u64,
}

impl Crew {
    fn state(&self) -> MutexGuard<'_, State> {
        // A number is whole, whatever its thread did then.
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// The numbers of the next runs, at most so many, which are waited for; none at the end.
    fn take(&self, most: u64) -> Range<u64> {
        let mut state = self.state();
        while state.next < state.end && state.next - state.due >= AHEAD {
            state = self.told.wait(state).unwrap_or_else(PoisonError::into_inner);
        }
        let first = state.next.min(state.end);
        state.next = state.end.min(first + most);
        first..state.next
    }

    fn tell(&self, due: u64) {
        self.state().due = due;
        self.told.notify_all();
    }

    /// No more runs begin.
    fn close(&self) {
        self.state().end = 0;
        self.told.notify_all();
    }
}

/// A thread at work: where it panics, no thread begins another run.
struct Worker(Arc<Crew>);

impl Drop for Worker {
    fn drop(&mut self) {
        if thread::panicking() {
            self.0.close();
        }
    }
}

impl Campaign {
    /// Makes runs on so many threads, or with 0 on one for each core, and reports each, in order of their numbers.
    ///
    /// `work` simulates one run, on any thread. `tell` may stop the campaign with an error; it is called without an outcome
    /// now and then while no run ends. A run that does not stop then is left behind.
    ///
    /// # Panics
    /// Where a run does.
    pub fn each<E>(
        self: &Arc<Self>,
        runs: Range<u64>,
        threads: usize,
        work: impl Fn(&CampaignRun) -> Result<Metrics, RunError> + Send + Sync + 'static,
        tell: impl FnMut(Option<RunOutcome>) -> Result<(), E>,
    ) -> Result<(), E> {
        self.go(runs, threads, (1, Selection::ALL), work, tell)
    }

    /// The same where `work` does nothing but simulate, for the selected metrics: runs of one structure then go side by side where
    /// they can, and come to the same.
    pub fn each_beside<E>(
        self: &Arc<Self>,
        runs: Range<u64>,
        threads: usize,
        selection: &Selection,
        work: impl Fn(&CampaignRun) -> Result<Metrics, RunError> + Send + Sync + 'static,
        tell: impl FnMut(Option<RunOutcome>) -> Result<(), E>,
    ) -> Result<(), E> {
        let most = if batch::takes(self.scenario()) { BESIDE } else { 1 };
        self.go(runs, threads, (most, selection.clone()), work, tell)
    }

    fn go<E>(
        self: &Arc<Self>,
        runs: Range<u64>,
        threads: usize,
        (most, selection): (u64, Selection),
        work: impl Fn(&CampaignRun) -> Result<Metrics, RunError> + Send + Sync + 'static,
        mut tell: impl FnMut(Option<RunOutcome>) -> Result<(), E>,
    ) -> Result<(), E> {
        let state = State { next: runs.start, due: runs.start, end: runs.end };
        let crew = Arc::new(Crew { state: Mutex::new(state), told: Condvar::new() });
        let (outcomes, ended) = channel();
        let work = Arc::new(work);
        let count = runs.end.saturating_sub(runs.start);
        let cores = || thread::available_parallelism().map_or(1, usize::from);
        let threads = if threads == 0 { cores() } else { threads };
        // No thread is left without work for the sake of another's neighbours.
        let most = most.min(count / threads as u64).max(1);
        for _ in 0..threads.min(usize::try_from(count).unwrap_or(usize::MAX)) {
            let (study, worker, outcomes) = (self.clone(), Worker(crew.clone()), outcomes.clone());
            let (work, selection) = (work.clone(), selection.clone());
            thread::spawn(move || study.work_through(&worker, (most, &selection), &outcomes, &*work));
        }
        drop(outcomes);
        let told = tell_in_order(&crew, runs, &ended, &mut tell);
        if told.is_err() {
            crew.close();
            let began = Instant::now();
            while let Some(left) = PATIENCE.checked_sub(began.elapsed()) {
                if ended.recv_timeout(left).is_err() {
                    break;
                }
            }
        }
        told
    }

    fn work_through(
        &self,
        worker: &Worker,
        (most, selection): (u64, &Selection),
        outcomes: &Sender<Vec<RunOutcome>>,
        work: &impl Fn(&CampaignRun) -> Result<Metrics, RunError>,
    ) {
        loop {
            let numbers = worker.0.take(most);
            if numbers.is_empty() {
                return;
            }
            let mut tell = |some| outcomes.send(some).is_ok();
            let goes_on = if numbers.end - numbers.start > 1 {
                self.beside(numbers, selection, work, &mut tell)
            } else {
                tell(vec![self.outcome(numbers.start, selection, work)])
            };
            if !goes_on {
                return;
            }
        }
    }

    /// What runs come to, side by side where they can go so, as soon as it is known; `work` simulates the others. Tells whether
    /// `tell` wants more.
    fn beside(
        &self,
        numbers: Range<u64>,
        selection: &Selection,
        work: &impl Fn(&CampaignRun) -> Result<Metrics, RunError>,
        tell: &mut impl FnMut(Vec<RunOutcome>) -> bool,
    ) -> bool {
        let began = Instant::now();
        let runs: Vec<_> = numbers.map(|number| (number, self.run_for(number, selection))).collect();
        let whole = || runs.iter().filter_map(|(_, run)| run.as_ref().ok());
        let jobs: Vec<Job<'_>> =
            whole().map(|run| Job { number: run.number, scenario: &run.scenario, selection }).collect();
        let mut found = batch::simulate(&jobs).into_iter();
        // What they took together is told of each alike.
        let seconds = began.elapsed().as_secs_f64() / runs.len().max(1) as f64;
        let (mut known, mut alone) = (Vec::with_capacity(runs.len()), Vec::new());
        for (number, run) in runs {
            let (drawn, metrics) = match run {
                Ok(run) => {
                    let Some(metrics) = found.next().flatten() else {
                        alone.push(run);
                        continue;
                    };
                    (run.drawn, Ok(selection.of_run(metrics)))
                }
                Err(error) => (self.draw(number), Err(RunError::from(error))),
            };
            known.push(RunOutcome { number, drawn, metrics, seconds });
        }
        tell(known)
            && alone.into_iter().all(|run| {
                let began = Instant::now();
                let metrics = work(&run);
                let seconds = began.elapsed().as_secs_f64();
                tell(vec![RunOutcome { number: run.number, metrics, drawn: run.drawn, seconds }])
            })
    }
}

fn tell_in_order<E>(
    crew: &Crew,
    runs: Range<u64>,
    ended: &Receiver<Vec<RunOutcome>>,
    tell: &mut impl FnMut(Option<RunOutcome>) -> Result<(), E>,
) -> Result<(), E> {
    let mut early = BTreeMap::new();
    let mut due = runs.start;
    while due < runs.end {
        match ended.recv_timeout(LOOK) {
            Ok(some) => early.extend(some.into_iter().map(|outcome| (outcome.number, outcome))),
            Err(RecvTimeoutError::Timeout) => {}
            Err(RecvTimeoutError::Disconnected) => panic!("run {due} panicked"),
        }
        if !early.contains_key(&due) {
            tell(None)?;
            continue;
        }
        while let Some(outcome) = early.remove(&due) {
            tell(Some(outcome))?;
            due += 1;
        }
        crew.tell(due);
    }
    Ok(())
}
