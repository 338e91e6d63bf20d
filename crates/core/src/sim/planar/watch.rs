//! The watch over the envelope: its observer, its windows, and the adaptation that learns from them.

use crate::adaptation::{Adaptation, Search};
use crate::body::State;
use crate::estimator::{Estimator, Observer};
use crate::random::{Seed, Stream};
use crate::record::foxglove::Level;
use crate::record::{self, ModeEnvelope, Record, RecordError, Sample, WindowMean};
use crate::scenario::Scenario;
use crate::sim::journal::{Journal, adapted};
use crate::time::{Instant, Span};

/// The observer at work, window by window.
#[derive(Clone, Debug)]
pub struct Watch {
    observer: Observer,
    window: Span,
    opened: Instant,
    /// When the window closes.
    pub closes: Instant,
    index: u64,
    /// Mean of the window that was closed last (rad).
    pub mean: f64,
    search: Option<(Search, Stream)>,
    journal: Journal,
}

impl Watch {
    /// The watch that a scenario asks for, if any.
    pub fn new(scenario: &Scenario, seed: Seed) -> Option<Self> {
        let spec = scenario.estimator.as_ref().and_then(Estimator::envelope)?;
        let search = scenario.adaptation.clone().map(|Adaptation::RandomSearch(constants)| {
            (Search::new(constants, scenario.law.gain()), seed.stream("adaptation"))
        });
        Some(Self {
            observer: Observer::new(spec, &scenario.model.modes, scenario.model.inertia.get()),
            window: spec.window,
            opened: Instant::START,
            closes: Instant::START + spec.window,
            index: 0,
            mean: f64::NAN,
            search,
            journal: Journal::new(scenario),
        })
    }

    /// Takes over a torque that is commanded from now on.
    pub fn command(&mut self, now: Instant, state: &State, torque: f64) {
        self.observer.advance(now, state);
        self.observer.command(torque);
    }

    /// Closes the window that ends now, and lets the adaptation learn: it may move the gain.
    pub fn close(
        &mut self,
        now: Instant,
        state: &State,
        gain: &mut f64,
        record: &mut impl Record,
    ) -> Result<(), RecordError> {
        self.observer.advance(now, state);
        self.mean = self.observer.close_window() / self.window.seconds();
        let row = WindowMean {
            window: self.index,
            from_s: self.opened.seconds(),
            to_s: now.seconds(),
            mean_rad: self.mean,
            gain: *gain,
        };
        self.opened = now;
        self.closes = now + self.window;
        self.index += 1;
        record.record(now, Sample::Window(&row))?;
        let Some((search, stream)) = &mut self.search else { return Ok(()) };
        let Some(step) = search.learn(now, self.mean, stream.uniform()) else { return Ok(()) };
        let before = std::mem::replace(gain, step.gain);
        let row = record::Adaptation {
            window: row.window,
            decision: step.decision,
            change: step.change,
            draw: step.draw,
            gain: step.gain,
            settled: u64::from(step.settled),
        };
        record.record(now, Sample::Adaptation(&row))?;
        let line = adapted(row.window, row.decision, before, row.gain);
        self.journal.tell(now, (Level::Info, "adaptation"), line, record)
    }

    /// The envelope now, as logged.
    pub fn envelope(&self, now: Instant) -> record::Envelope {
        let modes: Vec<_> = self.observer.at(now).map(|envelope_rad| ModeEnvelope { envelope_rad }).collect();
        record::Envelope { envelope_rad: modes.iter().map(|mode| mode.envelope_rad).sum(), modes }
    }
}
