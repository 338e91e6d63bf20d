//! Communication points: the instants that a time in seconds, a double, stands for.

use flexsc_core::numerics::time::{Instant, Span};

use crate::error::CoSimulationError;

const FEMTOSECONDS: u64 = 1_000_000_000_000_000;

/// Instants that a time in seconds stands for.
#[derive(Copy, Clone, Debug, PartialEq, Eq)]
pub struct CommunicationPoint {
    /// Nearest instant, or the multiple of the grid nearest to the time.
    pub at: Instant,
    /// Last instant whose time in seconds is at most that of the point.
    pub latest: Instant,
}

impl CommunicationPoint {
    /// Creates the point of a time (s), rounded to a multiple of `grid_ns` nanoseconds unless that is 0.
    pub fn new(seconds: f64, grid_ns: u64) -> Self {
        let nearest = Instant::START + Span::from_seconds(seconds.max(0.0));
        if grid_ns > 0 {
            let at = multiple(nearest, grid_ns);
            return Self { at, latest: at };
        }
        // Seconds grow with the instants: the last one is between the nearest and the next double, by bisection.
        let after = |femtoseconds: i64| nearest + Span::from_femtoseconds(femtoseconds);
        let next = Span::from_seconds(seconds.next_up() - seconds).leading_femtoseconds();
        let (mut last, mut beyond) = (0, 2 * next + 2048);
        while beyond - last > 1 {
            let middle = last + (beyond - last) / 2;
            if after(middle).seconds() <= seconds {
                last = middle;
            } else {
                beyond = middle;
            }
        }
        Self { at: nearest, latest: after(last) }
    }

    /// Returns the point, at most at the end of a run.
    #[must_use]
    pub fn until(self, end: Instant) -> Self {
        Self { at: self.at.min(end), latest: self.latest.min(end) }
    }
}

/// Returns the end (s) of a step of `size` seconds from a communication point (s), for a run that is at `now` (s) and ends at
/// `run_end`.
///
/// # Errors
/// Fails if the run is not at `from`, for a size that is no time, and for a step beyond the end of the run.
pub fn step_end(
    from: f64,
    size: f64,
    now: f64,
    run_end: Instant,
    grid_ns: u64,
) -> Result<f64, CoSimulationError> {
    if !is_same_time(from, now, grid_ns) {
        let why = format!("the step begins at {from:?} s, and the run is at {now:?} s");
        return Err(CoSimulationError::refused(why));
    }
    if size.is_nan() || size < 0.0 || size.is_infinite() {
        return Err(CoSimulationError::refused(format!("the size of a step must be a time, got {size:?} s")));
    }
    let target = from + size;
    if target > run_end.seconds() && !is_same_time(target, run_end.seconds(), grid_ns.max(1)) {
        let why = format!(
            "{target:?} s is after the end of the run, {run_end} s\n\nhint: state a later stop time before the start"
        );
        return Err(CoSimulationError::refused(why));
    }
    Ok(target)
}

/// Returns the multiple of a grid (ns) that is nearest to an instant.
fn multiple(nearest: Instant, grid_ns: u64) -> Instant {
    let (whole, part) = nearest.parts();
    let all = u128::from(whole) * u128::from(FEMTOSECONDS) + u128::from(part);
    let grid = u128::from(grid_ns) * 1_000_000;
    let rounded = (all + grid / 2) / grid * grid;
    let (whole, part) = (rounded / u128::from(FEMTOSECONDS), rounded % u128::from(FEMTOSECONDS));
    Instant::from_parts(whole as u64, part as u64)
}

/// True if two times (s) are equal but for the rounding of a few sums, or lie on the same point of the grid.
pub fn is_same_time(one: f64, other: f64, grid_ns: u64) -> bool {
    let rounding = 8.0 * (one.abs().next_up() - one.abs());
    (one - other).abs() <= rounding.max(grid_ns as f64 * 0.5e-9)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_point_covers_all_instants_that_round_to_it() {
        for seconds in [0.0, 1e-15, 0.1, 0.37, 1.0 / 3.0, 8.3, 123.456, 8999.1, 9001.7, 1e6 + 0.1, 3.2e8] {
            let point = CommunicationPoint::new(seconds, 0);
            assert!(point.at <= point.latest && point.latest.seconds() <= seconds, "{seconds}");
            assert!((point.latest + Span::TICK).seconds() > seconds || point.latest == point.at, "{seconds}");
            // Below 4 s, a double is finer than a femtosecond.
            let rounding = (seconds * f64::EPSILON).max(0.5e-15 * (1.0 + 1e-9));
            assert!((point.at.seconds() - seconds).abs() <= rounding, "{seconds}");
        }
        // At 1e6 s, a double stands for more than 1e5 femtoseconds.
        let point = CommunicationPoint::new(1e6 + 0.1, 0);
        assert!(point.latest.since(point.at).leading_femtoseconds() > 50_000);
    }

    #[test]
    fn a_grid_heals_the_rounding_of_products() {
        let exact = |k: u64| Instant::from_parts(k / 10, k % 10 * (FEMTOSECONDS / 10));
        let off = |grid| {
            (0..100_000).filter(|k| CommunicationPoint::new(*k as f64 * 0.1, grid).at != exact(*k)).count()
        };
        assert_eq!((off(1), off(1000)), (0, 0));
        assert!(off(0) > 30_000, "{}", off(0));
    }

    #[test]
    fn times_are_equal_but_for_rounding() {
        assert!(is_same_time(0.1 + 0.2, 0.3, 0) && is_same_time(0.0, 0.0, 0));
        assert!(!is_same_time(0.3, 0.300_000_1, 0) && !is_same_time(0.0, 1e-15, 0));
        assert!(is_same_time(0.3, 0.300_000_000_4, 1) && !is_same_time(0.3, 0.300_000_000_6, 1));
    }
}
