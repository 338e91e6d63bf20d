//! Functions of time as polynomials of degree 16 on arcs: built where they are first asked for, four of them kept.
//!
//! An arc interpolates at the Chebyshev nodes of the first kind; its polynomial is in powers of the time from its middle over
//! half of its length. Arcs depend on what they describe and on the time alone, so their values are the same in any order of
//! calls.

use std::f64::consts::PI;
use std::sync::{LazyLock, Mutex, MutexGuard, PoisonError};

/// Degree of the polynomials.
pub const DEGREE: usize = 16;

/// Number of nodes, and of coefficients.
const NODES: usize = DEGREE + 1;

/// Number of arcs that are kept: a step of the integration may lie in two.
const KEPT: usize = 4;

/// Shortest half (s) of an arc that is halved.
const SHORTEST: f64 = 2.0;

/// Time since the start as the sum of two parts (s), so that instants of an arc late in a run are not rounded.
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct SplitTime {
    /// Time of the middle of the arc, which may be large.
    pub middle: f64,
    /// Time from there.
    pub offset: f64,
}

impl From<f64> for SplitTime {
    /// Converts a time since the start (s).
    fn from(t: f64) -> Self {
        Self { middle: t, offset: 0.0 }
    }
}

impl SplitTime {
    /// Returns the time from another to this one (s).
    pub fn since(self, t: f64) -> f64 {
        (self.middle - t) + self.offset
    }
}

/// Arcs of one function that were asked for last.
#[derive(Debug, Default)]
pub struct TimeArcs<const COLUMNS: usize>(Mutex<Ring<COLUMNS>>);

/// Arcs that are kept.
#[derive(Clone, Debug, Default)]
struct Ring<const COLUMNS: usize> {
    arcs: Vec<TimeArc<COLUMNS>>,
    /// Place of the next arc.
    next: usize,
}

/// Function of time on an interval.
#[derive(Clone, Debug)]
pub struct TimeArc<const COLUMNS: usize> {
    /// Start and end (s).
    span: [f64; 2],
    middle: f64,
    /// Inverse of half of the length (1/s).
    scale: f64,
    /// Coefficients of the powers.
    powers: [[f64; COLUMNS]; NODES],
}

/// Interpolation at the nodes.
struct Transform {
    nodes: [f64; NODES],
    /// Coefficients of Chebyshev polynomials by values at the nodes.
    chebyshev: [[f64; NODES]; NODES],
    /// Coefficients of powers in each Chebyshev polynomial.
    powers: [[f64; NODES]; NODES],
}

static TRANSFORM: LazyLock<Transform> = LazyLock::new(|| {
    let count = NODES as f64;
    let cosine = |degree: usize, node: usize| {
        // Parts of a turn; a quarter of one gives 0, not its rounding.
        let parts = degree * (2 * node + 1) % (4 * NODES);
        if parts % (2 * NODES) == NODES { 0.0 } else { libm::cos(0.5 * PI * parts as f64 / count) }
    };
    let mut powers = [[0.0; NODES]; NODES];
    (powers[0][0], powers[1][1]) = (1.0, 1.0);
    for degree in 2..NODES {
        for power in 0..NODES {
            let up = if power > 0 { 2.0 * powers[degree - 1][power - 1] } else { 0.0 };
            powers[degree][power] = up - powers[degree - 2][power];
        }
    }
    Transform {
        nodes: std::array::from_fn(|node| cosine(1, node)),
        chebyshev: std::array::from_fn(|degree| {
            let factor = if degree == 0 { 1.0 } else { 2.0 } / count;
            std::array::from_fn(|node| factor * cosine(degree, node))
        }),
        powers,
    }
});

impl<const COLUMNS: usize> Clone for TimeArcs<COLUMNS> {
    /// Copies the arcs: a copy of a motion goes on from where it is.
    fn clone(&self) -> Self {
        Self(Mutex::new(self.ring().clone()))
    }
}

impl<const COLUMNS: usize> PartialEq for TimeArcs<COLUMNS> {
    /// Returns true: the function is compared in its place.
    fn eq(&self, _: &Self) -> bool {
        true
    }
}

impl<const COLUMNS: usize> TimeArcs<COLUMNS> {
    fn ring(&self) -> MutexGuard<'_, Ring<COLUMNS>> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Returns the result of `read` on the arc about a time since the start (s). An arc that is not kept is built from the values
    /// `row` of the function: on the interval `span`, halved until `resolved` accepts the arc with the sizes of its last two
    /// Chebyshev coefficients.
    #[inline]
    pub fn read<T>(
        &self,
        t: f64,
        span: impl FnOnce() -> [f64; 2],
        row: impl Fn(SplitTime) -> [f64; COLUMNS],
        resolved: impl Fn(&TimeArc<COLUMNS>, &[f64; COLUMNS]) -> bool,
        read: impl FnOnce(&TimeArc<COLUMNS>) -> T,
    ) -> T {
        let mut ring = self.ring();
        if let Some(arc) = ring.arcs.iter().find(|arc| arc.span[0] <= t && t < arc.span[1]) {
            return read(arc);
        }
        let mut span = span();
        let arc = loop {
            let (arc, tail) = TimeArc::new(span, &row);
            if resolved(&arc, &tail) || span[1] - span[0] < 2.0 * SHORTEST {
                break arc;
            }
            span = if t < arc.middle { [span[0], arc.middle] } else { [arc.middle, span[1]] };
        };
        let value = read(&arc);
        let place = ring.next;
        if place < ring.arcs.len() {
            ring.arcs[place] = arc;
        } else {
            ring.arcs.push(arc);
        }
        ring.next = (place + 1) % KEPT;
        value
    }
}

impl<const COLUMNS: usize> TimeArc<COLUMNS> {
    /// Creates the arc on an interval (s) from the values `row` of the function; returns with it, for each column, the sum of the
    /// sizes of the last two Chebyshev coefficients.
    pub fn new(span: [f64; 2], row: impl Fn(SplitTime) -> [f64; COLUMNS]) -> (Self, [f64; COLUMNS]) {
        let [middle, half] = [0.5 * (span[0] + span[1]), 0.5 * (span[1] - span[0])];
        let Transform { nodes, chebyshev, powers: table } = &*TRANSFORM;
        let mut values = nodes.map(|node| row(SplitTime { middle, offset: half * node }));
        // Sums of differences from the value in the middle round less.
        let origin = values[NODES / 2];
        for value in &mut values {
            (0..COLUMNS).for_each(|column| value[column] -= origin[column]);
        }
        let mut powers = [[0.0; COLUMNS]; NODES];
        powers[0] = origin;
        let mut tail = [0.0; COLUMNS];
        for degree in 0..NODES {
            let mut coefficient = [0.0; COLUMNS];
            for (value, factor) in values.iter().zip(&chebyshev[degree]) {
                (0..COLUMNS).for_each(|column| coefficient[column] += factor * value[column]);
            }
            for (power, factor) in powers.iter_mut().zip(&table[degree]).filter(|(_, factor)| **factor != 0.0)
            {
                (0..COLUMNS).for_each(|column| power[column] += factor * coefficient[column]);
            }
            if degree + 2 >= NODES {
                (0..COLUMNS).for_each(|column| tail[column] += f64::abs(coefficient[column]));
            }
        }
        (Self { span, middle, scale: 1.0 / half, powers }, tail)
    }

    /// Returns the values at a time since the start (s).
    #[inline]
    pub fn at(&self, t: f64) -> [f64; COLUMNS] {
        let x = (t - self.middle) * self.scale;
        let mut sum = self.powers[NODES - 1];
        for power in self.powers[..NODES - 1].iter().rev() {
            for column in 0..COLUMNS {
                sum[column] = sum[column] * x + power[column];
            }
        }
        sum
    }

    /// Returns the values in the middle.
    pub fn in_middle(&self) -> &[f64; COLUMNS] {
        &self.powers[0]
    }
}

#[cfg(test)]
mod tests {
    use std::cell::Cell;

    use super::*;

    #[test]
    fn arcs_are_built_once_and_copied() {
        let (arcs, count) = (TimeArcs::<1>::default(), Cell::new(0));
        let sine = |arcs: &TimeArcs<1>, t: f64| {
            let span = || [8.0 * libm::floor(t / 8.0), 8.0 * libm::floor(t / 8.0) + 8.0];
            let row = |t: SplitTime| {
                count.set(count.get() + 1);
                [libm::sin(0.25 * t.middle + 0.25 * t.offset)]
            };
            arcs.read(t, span, row, |_, _| true, |arc| arc.at(t))[0]
        };
        for t in (0..320).map(|k| 0.1 * f64::from(k)) {
            assert!((sine(&arcs, t) - libm::sin(0.25 * t)).abs() < 1e-15, "{t}");
        }
        assert_eq!(count.get(), 4 * NODES);
        let copy = arcs.clone();
        assert_eq!(sine(&copy, 31.0).to_bits(), sine(&arcs, 31.0).to_bits());
        assert_eq!(count.get(), 4 * NODES);
        // A fifth arc takes the place of the first.
        assert!(sine(&arcs, 33.0) == sine(&TimeArcs::default(), 33.0));
        assert!(sine(&arcs, 1.0) == sine(&copy, 1.0));
        assert_eq!(count.get(), 7 * NODES);
    }

    #[test]
    fn arcs_are_halved_about_a_kink() {
        let arcs = TimeArcs::<1>::default();
        let kink = |t: f64| {
            let row = |t: SplitTime| [(t.middle + t.offset - 20.0).abs()];
            let resolved = |_: &TimeArc<1>, tail: &[f64; 1]| tail[0] < 1e-12;
            arcs.read(t, || [0.0, 64.0], row, resolved, |arc| (arc.at(t)[0], arc.span))
        };
        for (t, span) in
            [(5.0, [0.0, 16.0]), (19.0, [16.0, 20.0]), (21.0, [20.0, 24.0]), (40.0, [32.0, 64.0])]
        {
            let (value, found) = kink(t);
            assert!((value - f64::abs(t - 20.0)).abs() < 1e-13, "{t}: {value}");
            assert!(found[0] <= t && t < found[1], "{t}: {found:?}");
            assert!(found[1] - found[0] <= span[1] - span[0], "{t}: {found:?}");
        }
    }
}
