//! Statistics of an error over control cycles: rms, median, 95 % level, largest value and its instant, with bounded memory.

use flexsc_numerics::time::Instant;

/// Leading bits of the mantissa that select the cell of a double, beside its exponent: a cell is at most 0.4 % wide.
const BITS: u32 = 8;
const SHIFT: u32 = 52 - BITS;
/// Exponents of the smallest and the largest error that have cells of their own: 2^-34 and 2^2 rad.
const EXPONENTS: [u64; 2] = [1023 - 34, 1023 + 2];
const FIRST: u64 = EXPONENTS[0] << BITS;
const CELLS: usize = ((EXPONENTS[1] - EXPONENTS[0]) << BITS) as usize;

/// Statistics of a magnitude that holds from one control cycle to the next.
#[derive(Clone, Debug, Default)]
pub struct ErrorStatistics {
    /// Time in each cell (s); empty before the first error.
    cells: Vec<f64>,
    time: f64,
    square: f64,
    largest: f64,
    at: f64,
}

/// Statistics at the end of a run.
#[derive(Copy, Clone, Debug, PartialEq, serde::Serialize)]
pub struct ErrorSummary {
    /// Root mean square over time (rad).
    pub rms: f64,
    /// Median over time (rad).
    pub median: f64,
    /// Error that is not exceeded for 95 % of the time (rad).
    pub p95: f64,
    /// Largest error (rad).
    pub largest: f64,
    /// Time of the largest error (s).
    pub at_s: f64,
}

impl ErrorStatistics {
    /// Adds an error (rad) from an instant on that lasts for a time (s).
    pub fn add(&mut self, at: Instant, error: f64, time: f64) {
        if self.cells.is_empty() {
            self.cells = vec![0.0; CELLS];
        }
        let cell = (error.to_bits() >> SHIFT).saturating_sub(FIRST) as usize;
        self.cells[cell.min(CELLS - 1)] += time;
        self.time += time;
        self.square += error * error * time;
        if error > self.largest || self.at == 0.0 && self.largest == 0.0 {
            (self.largest, self.at) = (error, at.seconds());
        }
    }

    /// Returns the statistics; `None` without an error that lasted.
    pub fn finish(&self) -> Option<ErrorSummary> {
        (self.time > 0.0).then(|| ErrorSummary {
            rms: (self.square / self.time).sqrt(),
            median: self.quantile(0.5),
            p95: self.quantile(0.95),
            largest: self.largest,
            at_s: self.at,
        })
    }

    /// Returns the error that is not exceeded for a part of the time, within the width of a cell.
    fn quantile(&self, part: f64) -> f64 {
        let mut before = 0.0;
        for (cell, time) in self.cells.iter().enumerate() {
            if before + time >= part * self.time && *time > 0.0 {
                let edge = |cell: usize| f64::from_bits((FIRST + cell as u64) << SHIFT);
                let within = ((part * self.time - before) / time).clamp(0.0, 1.0);
                let low = if cell == 0 { 0.0 } else { edge(cell) };
                return (low + within * (edge(cell + 1) - low)).min(self.largest);
            }
            before += time;
        }
        self.largest
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use flexsc_numerics::time::Span;

    #[test]
    fn statistics_are_those_of_an_even_distribution() {
        let mut errors = ErrorStatistics::default();
        for index in 0..1000_u32 {
            let at = Instant::START + Span::from_seconds(f64::from(index));
            errors.add(at, 1e-4 * f64::from(index + 1), 1.0);
        }
        let found = errors.finish().expect("errors");
        // The rms of 1 to n is sqrt((n + 1)(2 n + 1)/6).
        assert!((found.rms / (1e-4 * f64::sqrt(1001.0 * 2001.0 / 6.0)) - 1.0).abs() < 1e-12, "{found:?}");
        assert!(
            (found.median / 0.05 - 1.0).abs() < 4e-3 && (found.p95 / 0.095 - 1.0).abs() < 4e-3,
            "{found:?}"
        );
        assert_eq!((found.largest, found.at_s), (0.1, 999.0));
        assert_eq!(ErrorStatistics::default().finish(), None);
    }

    #[test]
    fn errors_without_a_cell_are_counted() {
        let mut errors = ErrorStatistics::default();
        for error in [0.0, 1e-300, 1e9] {
            errors.add(Instant::START, error, 1.0);
        }
        let found = errors.finish().expect("errors");
        assert!(found.median < 1e-10 && found.largest == 1e9, "{found:?}");
    }
}
