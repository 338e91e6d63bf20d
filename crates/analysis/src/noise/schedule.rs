//! Times of a loop with noise: its period, the instants at which something happens, and the draws of each source.

use std::collections::BTreeSet;

use flexsc_formats::document::ConfigError;

use super::source::NoiseSource;
use crate::open_loop::LoopParts;
use crate::open_loop::attitude_rows::{AttitudeRows, seconds, ticks};
use crate::open_loop::multi_rate::common_multiple;
use crate::open_loop::repeated_instants::repeated;

/// Largest number of samples of the law in a period.
const MOST_SAMPLES: i64 = 100;
/// Largest number of draws of a source in a period.
const MOST_DRAWS: i64 = 2000;

/// Largest number of periods of a fine mirror in a period.
const MOST_EXPOSURES: i64 = 500;

/// Times of a period (fs).
pub struct Schedule {
    /// Period of the law.
    pub step: i64,
    /// Delay of the actuators.
    pub delay: i64,
    /// Period after which the loop repeats.
    pub period: i64,
    /// Periods of fine mirrors.
    mirrors: Vec<i64>,
}

/// First column of the draws of each source, and the source.
pub struct Draws<'a> {
    first: Vec<usize>,
    /// Sources of noise.
    pub sources: &'a [NoiseSource],
}

impl Schedule {
    /// Returns the times of a loop.
    ///
    /// # Errors
    /// Periods without a common multiple that is short enough: a key, and the reason.
    pub fn new(
        parts: &LoopParts<'_>,
        filter: Option<&AttitudeRows>,
        sources: &[NoiseSource],
    ) -> Result<Self, ConfigError> {
        let step = parts.law.period.leading_femtoseconds();
        let mut period = step;
        let sensors = filter.map_or_else(Vec::new, |filter| filter.periods().to_vec());
        let own = sensors.into_iter().map(|own| (own, "law"));
        let draws = sources.iter().map(|source| (source.period, source.key.as_str()));
        for (own, key) in own.chain(draws) {
            let whole = common_multiple(period, own).filter(|whole| whole / step <= MOST_SAMPLES);
            let why = || {
                format!(
                    "has a period of {} s: the loop repeats only after more than {MOST_SAMPLES} samples of the law",
                    seconds(own)
                )
            };
            period = whole.ok_or_else(|| ConfigError::new(key, why()))?;
        }
        for own in &parts.mirrors {
            let key = format!("line_of_sight[{}].mirror.period", own.line);
            let short = |whole: &i64| whole / step <= MOST_SAMPLES && whole / own.period <= MOST_EXPOSURES;
            let why = || {
                format!(
                    "is {} s: the loop of the law and the mirror repeats only after more than {MOST_SAMPLES} samples of the law or \
                     {MOST_EXPOSURES} exposures",
                    seconds(own.period)
                )
            };
            let whole = common_multiple(period, own.period).filter(short);
            period = whole.ok_or_else(|| ConfigError::new(key, why()))?;
        }
        let count = |source: &NoiseSource| source.entry.draws() as i64 * (period / source.period);
        if let Some(source) = sources.iter().find(|source| count(source) > MOST_DRAWS) {
            let why = format!("has {} draws in a period of the loop, at most {MOST_DRAWS}", count(source));
            return Err(ConfigError::new(&source.key, why));
        }
        let mirrors = parts.mirrors.iter().map(|own| own.period).collect();
        Ok(Self { step, delay: ticks(parts.actuators.delay), period, mirrors })
    }

    /// Returns the instants at which something happens, from 0 to the end of the period.
    pub fn instants(&self, filter: Option<&AttitudeRows>, sources: &[NoiseSource]) -> Vec<i64> {
        let every = |first: i64, step: i64| repeated(first, step, self.period);
        let mut all: BTreeSet<i64> = filter.map_or_else(BTreeSet::new, |filter| filter.events(self.period));
        all.extend(every(0, self.step).chain(every(self.delay % self.step, self.step)).chain([self.period]));
        for source in sources {
            all.extend(every(source.phase, source.period));
        }
        self.mirrors.iter().for_each(|period| all.extend(every(0, *period)));
        all.into_iter().filter(|instant| (0..=self.period).contains(instant)).collect()
    }
}

impl<'a> Draws<'a> {
    /// Numbers the draws of a period (fs).
    pub fn new(sources: &'a [NoiseSource], period: i64) -> Self {
        let mut next = 0;
        let first = sources.iter().map(|source| {
            let own = next;
            next += Self::total(source, period);
            own
        });
        Self { first: first.collect(), sources }
    }

    fn total(source: &NoiseSource, period: i64) -> usize {
        source.entry.draws() * usize::try_from(period / source.period).unwrap_or(1)
    }

    /// Returns the number of draws in a period (fs).
    pub fn count(&self, period: i64) -> usize {
        self.sources.iter().map(|source| Self::total(source, period)).sum()
    }

    /// Returns the index of the source of each draw.
    pub fn drawn_by(&self, period: i64) -> Vec<usize> {
        let each = self.sources.iter().enumerate();
        each.flat_map(|(index, source)| std::iter::repeat_n(index, Self::total(source, period))).collect()
    }

    /// Returns the column of the first draw of a source at a time (fs); none if it does not draw then.
    pub fn column(&self, source: usize, now: i64) -> Option<usize> {
        let NoiseSource { entry, period, phase, .. } = &self.sources[source];
        let since = now - phase;
        (since >= 0 && since % period == 0)
            .then(|| self.first[source] + entry.draws() * usize::try_from(since / period).unwrap_or(0))
    }
}
