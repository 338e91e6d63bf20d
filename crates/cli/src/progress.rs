//! Progress of a long run or a campaign.

use std::io::Write;
use std::sync::mpsc::{self, Receiver, RecvTimeoutError, Sender};
use std::sync::{Mutex, PoisonError};
use std::thread;
use std::time::{Duration, Instant as WallInstant};

use flexsc_core::dynamics::MotionPiece;
use flexsc_core::numerics::time::{Instant, Span};
use flexsc_core::record::{Record, RecordError, Sample};
use indicatif::{ProgressBar, ProgressStyle};

use crate::human::seconds;
use crate::say;
use crate::terminal::is_plain;

/// Returns a progress bar of `steps` steps on the terminal; invisible elsewhere, and where escape sequences are
/// unwanted.
pub fn bar(steps: u64, unit: &str) -> ProgressBar {
    bar_from(steps, 0, unit)
}

/// Returns a progress bar of which `done` steps were completed before, with a message below it.
pub fn bar_from(steps: u64, done: u64, unit: &str) -> ProgressBar {
    if is_plain() {
        return ProgressBar::hidden();
    }
    let template =
        format!("{{bar:30}} {{human_pos}}/{{human_len}} {unit}, {{per_sec}}, {{eta}} left\n{{msg}}");
    let style = ProgressStyle::with_template(&template).unwrap_or_else(|_| ProgressStyle::default_bar());
    ProgressBar::new(steps).with_style(style).with_position(done)
}

/// Progress lines on stderr where no bar is visible, such as on a pipe: one every 30 s.
pub struct Lines {
    began: WallInstant,
    steps: u64,
    unit: &'static str,
    /// Number of steps completed before.
    before: u64,
    /// Time since the start (s) at which the next line is due.
    due: f64,
}

impl Lines {
    /// Interval between two lines (s).
    const AGAIN: f64 = 30.0;

    /// Returns the progress lines of `steps` steps, of which `before` were completed before.
    pub fn new(steps: u64, before: u64, unit: &'static str) -> Self {
        Self { began: WallInstant::now(), steps, unit, before, due: Self::AGAIN }
    }

    /// Prints a line if one is due, with `done` completed steps.
    pub fn show(&mut self, done: u64) {
        if let Some(line) = self.line(self.began.elapsed().as_secs_f64(), done) {
            say!("{line}");
        }
    }

    /// Returns the line after `elapsed` seconds, if one is due.
    fn line(&mut self, elapsed: f64, done: u64) -> Option<String> {
        if elapsed < self.due {
            return None;
        }
        self.due = elapsed + Self::AGAIN;
        let Self { steps, unit, before, .. } = self;
        let speed = done.saturating_sub(*before) as f64 / elapsed;
        let remaining = match steps.saturating_sub(done) as f64 / speed {
            remaining if remaining.is_finite() => format!(", about {} left", seconds(remaining)),
            _ => String::new(),
        };
        Some(format!("progress: {done} of {steps} {unit} after {}{remaining}", seconds(elapsed)))
    }
}

/// Stage in which a command is, for its lines of progress.
static STAGE: Mutex<&str> = Mutex::new("");

/// Begins a stage, which lines of progress name from now on.
pub fn begin_stage(name: &'static str) {
    *STAGE.lock().unwrap_or_else(PoisonError::into_inner) = name;
}

/// Lines on stderr of a command that shows no progress of its own: the first after 10 s, then one every 30 s, until it is dropped.
pub struct Heartbeat {
    /// Ends the thread when it is dropped.
    _alive: Option<Sender<()>>,
}

impl Heartbeat {
    /// Time until the first line.
    const FIRST: Duration = Duration::from_secs(10);

    /// Starts the lines of a command of this name.
    pub fn start(verb: &'static str) -> Self {
        let (alive, ended) = mpsc::channel();
        let lines = move || {
            let again = Duration::from_secs_f64(Lines::AGAIN);
            beat(&ended, [Self::FIRST, again], |elapsed| {
                let stage = *STAGE.lock().unwrap_or_else(PoisonError::into_inner);
                let now = if stage.is_empty() { String::new() } else { format!(", now {stage}") };
                say!("progress: {verb} has run for {}{now}", seconds(elapsed));
            });
        };
        // Without a thread there are no lines.
        let started = thread::Builder::new().spawn(lines);
        Self { _alive: started.is_ok().then_some(alive) }
    }
}

/// Calls `show` with the time since the start (s) after the first of two intervals and then after each second one, until the
/// sender is dropped.
fn beat(ended: &Receiver<()>, [first, again]: [Duration; 2], mut show: impl FnMut(f64)) {
    let began = WallInstant::now();
    let mut wait = first;
    while let Err(RecvTimeoutError::Timeout) = ended.recv_timeout(wait) {
        show(began.elapsed().as_secs_f64());
        wait = again;
    }
}

/// Returns a line on the terminal with the current activity; invisible where a bar is.
#[cfg(feature = "papers")]
pub fn spinner() -> ProgressBar {
    if is_plain() { ProgressBar::hidden() } else { ProgressBar::new_spinner() }
}

/// Unit of a single run's progress.
const UNIT: &str = "simulated seconds";

/// Progress of a single run, shown once it takes longer than half a second.
pub struct Progress {
    began: WallInstant,
    length: Span,
    bar: Option<ProgressBar>,
    lines: Lines,
}

impl Progress {
    /// Returns the progress of a run of this length.
    pub fn new(length: Span) -> Self {
        let lines = Lines::new(length.seconds() as u64, 0, UNIT);
        Self { began: WallInstant::now(), length, bar: None, lines }
    }

    /// Shows the progress at a simulated time (s).
    pub fn show(&mut self, now: f64) {
        if self.bar.is_none() && self.began.elapsed() > Duration::from_millis(500) {
            self.bar = Some(bar(self.length.seconds() as u64, UNIT));
        }
        match &self.bar {
            Some(bar) if bar.is_hidden() => self.lines.show(now as u64),
            Some(bar) => bar.set_position(now as u64),
            None => {}
        }
    }

    /// Clears the bar.
    pub fn finish(self) {
        if let Some(bar) = self.bar {
            bar.finish_and_clear();
        }
    }
}

/// Record that gives the simulated time (s) of a run to a function, at one sample in 4096.
pub struct RunClock<F> {
    receiver: F,
    samples: u32,
}

impl<F: FnMut(f64)> RunClock<F> {
    /// Creates the record with the function that takes the time.
    pub fn new(receiver: F) -> Self {
        Self { receiver, samples: 0 }
    }

    fn tick(&mut self, now: f64) {
        self.samples = self.samples.wrapping_add(1);
        // To show a time costs as much as a sample.
        if self.samples.is_multiple_of(4096) {
            (self.receiver)(now);
        }
    }
}

impl<F: FnMut(f64)> Record for RunClock<F> {
    fn record(&mut self, now: Instant, _: Sample<'_>) -> Result<(), RecordError> {
        self.tick(now.seconds());
        Ok(())
    }

    fn piece(&mut self, _: Instant, piece: &MotionPiece) -> Result<(), RecordError> {
        self.tick(piece.from);
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_heartbeat_comes_until_the_command_ends() {
        let (alive, ended) = mpsc::channel::<()>();
        let mut alive = Some(alive);
        let mut times = Vec::new();
        beat(&ended, [Duration::from_millis(40), Duration::from_millis(10)], |elapsed| {
            times.push(elapsed);
            if times.len() == 3 {
                alive = None;
            }
        });
        assert!(times.len() == 3 && times[0] >= 0.04 && times[2] >= 0.06, "{times:?}");
    }

    #[test]
    fn a_pipe_gets_a_line_every_thirty_seconds() {
        let mut lines = Lines::new(200, 0, "runs");
        assert_eq!(lines.line(29.9, 17), None);
        let line = lines.line(30.0, 40).expect("a line");
        assert_eq!(line, "progress: 40 of 200 runs after 30 s, about 2 min left");
        assert_eq!(lines.line(31.0, 41), None);
        // No step is completed yet, so that the remaining time is unknown.
        let mut resumed = Lines::new(200, 50, "runs");
        assert_eq!(resumed.line(60.0, 50).expect("a line"), "progress: 50 of 200 runs after 60 s");
    }
}
