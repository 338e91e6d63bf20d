//! Summary of the modes of operation of a run.

use std::io::Write;

use flexsc_core::formats::count::counted;
use flexsc_core::metrics::MetricValue;

use super::Summary;
use crate::human::digits;
use crate::say;

impl Summary<'_> {
    /// Prints the time in each mode of operation, and when it first began.
    pub(super) fn operation(&self) {
        let numbers = |name: &str| match self.metrics.get(name) {
            Some(MetricValue::Numbers(values)) => values.clone(),
            _ => Vec::new(),
        };
        let (times, starts) = (numbers("mode_times_s"), numbers("mode_starts_s"));
        let each = self.scenario.mode.iter().zip(times.iter().zip(&starts));
        let each = each.map(|(mode, (time, start))| {
            if start.is_nan() {
                format!("{} never", mode.name)
            } else {
                format!("{} {} s, first at {} s", mode.name, digits(*time), digits(*start))
            }
        });
        let each: Vec<String> = each.collect();
        if !each.is_empty() {
            let changes = counted(self.number("mode_changes"), "change");
            say!("  modes          {}; {changes}", each.join("; "));
        }
    }
}
