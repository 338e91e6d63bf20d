//! How far a long run or a campaign has come.

use std::time::{Duration, Instant as WallInstant};

use flexsc_core::motion::Stretch;
use flexsc_core::record::{Record, RecordError, Sample};
use flexsc_core::time::{Instant, Span};
use indicatif::{ProgressBar, ProgressStyle};

use crate::terminal::is_plain;

/// A bar on the terminal over so many steps; invisible elsewhere, and where escape sequences are not wanted.
pub fn bar(steps: u64, unit: &str) -> ProgressBar {
    bar_from(steps, 0, unit)
}

/// The same where some of the steps were done before; a message stands below it.
pub fn bar_from(steps: u64, done: u64, unit: &str) -> ProgressBar {
    if is_plain() {
        return ProgressBar::hidden();
    }
    let template =
        format!("{{bar:30}} {{human_pos}}/{{human_len}} {unit}, {{per_sec}}, {{eta}} left\n{{msg}}");
    let style = ProgressStyle::with_template(&template).unwrap_or_else(|_| ProgressStyle::default_bar());
    ProgressBar::new(steps).with_style(style).with_position(done)
}

/// A line on the terminal with the current activity; invisible where a bar is.
#[cfg(feature = "papers")]
pub fn spinner() -> ProgressBar {
    if is_plain() { ProgressBar::hidden() } else { ProgressBar::new_spinner() }
}

/// A record that shows how far a single run has come, once it takes longer than half a second.
pub struct Progress {
    began: WallInstant,
    length: Span,
    samples: u32,
    bar: Option<ProgressBar>,
}

impl Progress {
    /// Progress towards the end of a run of this length.
    pub fn new(length: Span) -> Self {
        Self { began: WallInstant::now(), length, samples: 0, bar: None }
    }

    /// Clears the bar.
    pub fn finish(self) {
        if let Some(bar) = self.bar {
            bar.finish_and_clear();
        }
    }
}

impl Record for Progress {
    fn record(&mut self, now: Instant, _: Sample<'_>) -> Result<(), RecordError> {
        self.see(now.seconds());
        Ok(())
    }

    fn stretch(&mut self, _: Instant, stretch: &Stretch) -> Result<(), RecordError> {
        self.see(stretch.from);
        Ok(())
    }
}

impl Progress {
    /// The run has come to a time (s).
    fn see(&mut self, now: f64) {
        self.samples = self.samples.wrapping_add(1);
        // The wall clock is asked rarely: it costs as much as a sample.
        if self.samples.is_multiple_of(4096) {
            if self.bar.is_none() && self.began.elapsed() > Duration::from_millis(500) {
                self.bar = Some(bar(self.length.seconds() as u64, "simulated seconds"));
            }
            if let Some(bar) = &self.bar {
                bar.set_position(now as u64);
            }
        }
    }
}
