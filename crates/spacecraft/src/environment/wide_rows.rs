//! Rows of an ephemeris that are too far apart for their positions alone: rows between them by Hermite polynomials, whose
//! derivatives are the velocities of the file.

use flexsc_numerics::attitude::Vector;

use super::sampled_orbit::{ROWS, STEP};

/// Angle from row to row (rad) above which positions alone are too few: three minutes in a low orbit.
const WIDE: f64 = 0.2;

/// Number of rows of the polynomial with which one of [`ROWS`] rows is compared.
const FEWER: usize = 6;

/// Rows of an ephemeris with velocities, at least [`ROWS`].
pub(super) struct WideRows<'a> {
    /// Times (s), increasing.
    pub times: &'a [f64],
    /// Positions (m).
    pub positions: &'a [Vector],
    /// Velocities (m/s).
    pub velocities: &'a [Vector],
}

/// Uncertainty between two rows.
#[derive(Copy, Clone, Debug, PartialEq)]
pub(super) struct Gap {
    /// Index of the row before it.
    pub row: usize,
    /// Time to the next row (s).
    pub length: f64,
    /// Distance (m) to which the position between them is known.
    pub distance: f64,
}

impl WideRows<'_> {
    /// Returns true if some rows are too far apart.
    pub fn is_wide(&self) -> bool {
        (1..self.times.len()).any(|row| self.angle(row) > WIDE)
    }

    /// Returns the angle from a row's predecessor to it (rad).
    fn angle(&self, row: usize) -> f64 {
        let rate = |row: usize| self.velocities[row].norm() / self.positions[row].norm();
        (self.times[row] - self.times[row - 1]) * rate(row).max(rate(row - 1))
    }

    /// Returns the rows with others between those that are too far apart: times and positions; `None` if they are more than `most`.
    pub fn filled(&self, most: usize) -> Option<(Vec<f64>, Vec<Vector>)> {
        let (mut times, mut positions) = (vec![self.times[0]], vec![self.positions[0]]);
        for row in 1..self.times.len() {
            let [from, to] = [self.times[row - 1], self.times[row]];
            let parts = if self.angle(row) > WIDE { libm::ceil(self.angle(row) / STEP) } else { 1.0 };
            if parts > most.saturating_sub(times.len()) as f64 {
                return None;
            }
            for part in 1..parts as usize {
                let t = from + (to - from) * part as f64 / parts;
                times.push(t);
                positions.push(self.at(row, ROWS, t));
            }
            times.push(to);
            positions.push(self.positions[row]);
        }
        Some((times, positions))
    }

    /// Returns the gap between two times (s) in which the position is known least.
    pub fn least_known(&self, [from, to]: [f64; 2]) -> Option<Gap> {
        let gap = |row: usize| {
            let [before, after] = [self.times[row - 1], self.times[row]];
            if after <= from || before >= to || self.angle(row) <= WIDE {
                return None;
            }
            let middle = 0.5 * (before + after);
            let distance = (self.at(row, ROWS, middle) - self.at(row, FEWER, middle)).norm();
            Some(Gap { row: row - 1, length: after - before, distance })
        };
        (1..self.times.len()).filter_map(gap).max_by(|a, b| a.distance.total_cmp(&b.distance))
    }

    /// Returns the position at a time before a row, by the polynomial through `count` rows about it.
    fn at(&self, row: usize, count: usize, t: f64) -> Vector {
        let first = row.saturating_sub(count / 2).min(self.times.len() - count);
        let unit = self.times[row] - self.times[row - 1];
        // Every row twice; differences of both are velocities, in the unit of time of the gap.
        let node = |index: usize| (self.times[first + index / 2] - t) / unit;
        let count = 2 * count;
        let mut divided: Vec<Vector> = (0..count).map(|index| self.positions[first + index / 2]).collect();
        for order in 1..count {
            for index in (order..count).rev() {
                divided[index] = if order == 1 && index % 2 == 1 {
                    self.velocities[first + index / 2] * unit
                } else {
                    (divided[index] - divided[index - 1]) / (node(index) - node(index - order))
                };
            }
        }
        (0..count - 1).rev().fold(divided[count - 1], |value, index| divided[index] - value * node(index))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::environment::Kepler;

    fn rows(step: f64) -> (Vec<f64>, Vec<Vector>, Vec<Vector>) {
        let times: Vec<f64> = (0..40).map(|row| step * f64::from(row)).collect();
        let (positions, velocities) =
            times.iter().map(|t| (kepler().motion(*t)[0], kepler().motion(*t)[1])).unzip();
        (times, positions, velocities)
    }

    fn kepler() -> Kepler {
        flexsc_formats::document::from_text("semi_major_axis = 7e6\neccentricity = 0.002\ninclination = 1.1")
            .unwrap()
    }

    /// Errors that a computation of the same polynomials in another language has: 0.04 km in the middle of rows of 15 minutes.
    #[test]
    fn velocities_give_the_orbit_between_rows() {
        for (step, inside, known) in [
            (60.0, None, 0.0),
            (300.0, Some(1e-3), 1.0),
            (900.0, Some(60.0), 2e4),
            (1500.0, Some(1e6), f64::INFINITY),
        ] {
            let (times, positions, velocities) = rows(step);
            let wide = WideRows { times: &times, positions: &positions, velocities: &velocities };
            assert_eq!(wide.is_wide(), inside.is_some(), "{step}");
            let (filled, places) = wide.filled(100_000).expect("few");
            let off = |(t, place): (&f64, &Vector)| (place - kepler().motion(*t)[0]).norm();
            let middle = |t: &f64| (4.0 * step..35.0 * step).contains(t);
            let worst = filled.iter().zip(&places).filter(|(t, _)| middle(t)).map(off).fold(0.0, f64::max);
            assert!(worst <= inside.unwrap_or(0.0), "{step}: {worst}");
            let least = wide.least_known([0.0, 39.0 * step]).map_or(0.0, |gap| gap.distance);
            assert!(
                least > 1e3 || least >= filled.iter().zip(&places).map(off).fold(0.0, f64::max),
                "{step}: {least}"
            );
            assert!(least <= known, "{step}: {least}");
            assert_eq!(wide.filled(40), (step < 100.0).then(|| (times.clone(), positions.clone())));
        }
    }
}
