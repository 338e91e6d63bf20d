//! Statistics of the inputs of a surface.

use std::collections::BTreeMap;
use std::time::Duration;

use crate::findings::Findings;
use crate::surface::Surface;
use crate::watch::News;

/// Counts and extremes.
#[derive(Default)]
pub struct Tally {
    inputs: u64,
    /// Counts by exit code; inputs that were stopped have none.
    codes: BTreeMap<Option<u8>, u64>,
    /// Largest memory (kB), and its input.
    memory: (u64, u64),
    /// Longest time, and its input.
    time: (Duration, u64),
}

impl Tally {
    /// Counts the result of an input; returns its number and its fault.
    pub fn take(&mut self, news: News) -> (u64, Option<String>) {
        self.inputs += 1;
        match news {
            News::Done { number, code, memory, time, wrong } => {
                *self.codes.entry(Some(code)).or_default() += 1;
                self.memory = self.memory.max((memory, number));
                // A stopped command takes as long as it is given.
                if code != 130 {
                    self.time = self.time.max((time, number));
                }
                (number, wrong)
            }
            News::Ended { number } => {
                *self.codes.entry(None).or_default() += 1;
                (number, None)
            }
            News::Broken { number, why } => (number, Some(why)),
        }
    }

    /// Returns the statistics as text.
    pub fn summary(&self, surface: Surface, seed: u64, took: Duration, findings: &Findings) -> String {
        let code = |(code, count): (&Option<u8>, &u64)| match code {
            Some(code) => format!("{count} exit {code}"),
            None => format!("{count} ended"),
        };
        let codes: Vec<String> = self.codes.iter().map(code).collect();
        format!(
            "{:<10} seed {seed}: {} inputs in {:.0} s ({:.0}/s); {}; largest memory {} MB (case {}); slowest {:.2} s (case {}); {findings}",
            crate::name(surface),
            self.inputs,
            took.as_secs_f64(),
            self.inputs as f64 / took.as_secs_f64(),
            codes.join(", "),
            self.memory.0 / 1000,
            self.memory.1,
            self.time.0.as_secs_f64(),
            self.time.1,
        )
    }
}
