//! Placement of a design's points: random numbers, Latin hypercubes and Sobol sequences, each point by its number
//! alone.

use std::sync::OnceLock;

use flexsc_numerics::random::{Seed, fnv1a};
use serde::{Deserialize, Serialize};
use sobol::Sobol;
use sobol::params::JoeKuoD6;

/// Largest number of dimensions of a Sobol sequence.
pub const MOST_DIMENSIONS: usize = 100;
/// Largest double below 1.
const BELOW_ONE: f64 = 1.0 - f64::EPSILON / 2.0;

/// How points are spread over the ranges of several keys, or over their distributions.
#[derive(Copy, Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Sampling {
    /// Independent random numbers.
    #[default]
    Random,
    /// A Latin hypercube: as many intervals of each key as there are points, and one point in each \[McKay79\].
    LatinHypercube,
    /// A Sobol sequence, with the direction numbers of \[JoeKuo08\], scrambled by the seed \[Owen95\].
    Sobol,
}

/// Dimension of a sample: one key, which is independent of the others.
#[derive(Copy, Clone, Debug)]
pub struct Dimension<'a> {
    /// Seed of the scenario.
    pub seed: u64,
    /// Name of the stream of its numbers.
    pub name: &'a str,
    /// Index of the key.
    pub place: usize,
}

impl Sampling {
    /// All samplings, with their names.
    pub const ALL: [(&'static str, Self); 3] =
        [("random", Self::Random), ("latin-hypercube", Self::LatinHypercube), ("sobol", Self::Sobol)];

    /// Returns the number in (0, 1) of a point out of `count`.
    pub fn number(self, dimension: Dimension<'_>, point: u64, count: u64) -> f64 {
        let random = || Seed { scenario: dimension.seed, run: point }.stream(dimension.name).uniform();
        let number = match self {
            Self::Random => random(),
            Self::LatinHypercube => {
                let cell = permuted(point.min(count.max(1) - 1), count.max(1), key(dimension));
                (cell as f64 + random()) / count.max(1) as f64
            }
            // Half a step is added: this centres the lattice of 2^-53.
            Self::Sobol => {
                (scrambled(sobol(point, dimension.place), key(dimension)) >> 11) as f64 * (f64::EPSILON / 2.0)
            }
        };
        number.clamp(f64::EPSILON / 4.0, BELOW_ONE)
    }
}

/// Returns the key that makes the numbers of a dimension differ from those of others.
fn key(dimension: Dimension<'_>) -> u64 {
    mixed(dimension.seed ^ fnv1a(dimension.name))
}

/// Mixes all bits of a number (the finaliser of SplitMix64).
fn mixed(number: u64) -> u64 {
    let number = (number ^ (number >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    let number = (number ^ (number >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    number ^ (number >> 31)
}

/// Returns an element of a permutation of `0..count`, by a Feistel network over the next power of four, iterated until
/// it is in range.
fn permuted(index: u64, count: u64, key: u64) -> u64 {
    let bits = (64 - (count - 1).leading_zeros()).max(2).div_ceil(2);
    let mask = (1_u64 << bits) - 1;
    let mut index = index;
    loop {
        let (mut high_half, mut low_half) = (index >> bits, index & mask);
        for round in 0..6_u64 {
            let mixed_half = mixed(key ^ mixed(low_half.wrapping_add(round << 56))) & mask;
            (high_half, low_half) = (low_half, high_half ^ mixed_half);
        }
        index = high_half << bits | low_half;
        if index < count {
            return index;
        }
    }
}

/// Returns a point of a Sobol sequence in one dimension, as a binary fraction.
fn sobol(point: u64, dimension: usize) -> u64 {
    static DIRECTIONS: OnceLock<Vec<Vec<u64>>> = OnceLock::new();
    let directions = DIRECTIONS
        .get_or_init(|| Sobol::<f64>::init_direction_vals(MOST_DIMENSIONS, 64, &JoeKuoD6::minimal()));
    let Some(directions) = directions.get(dimension) else { return 0 };
    // In the order of Gray's code the points of every power of two are the same.
    let code = point ^ (point >> 1);
    (0..64).filter(|bit| code >> bit & 1 == 1).fold(0, |sum, bit| sum ^ directions[bit])
}

/// Applies Owen's nested scrambling: each bit is flipped by a hash of those above it.
fn scrambled(fraction: u64, key: u64) -> u64 {
    (0..53).fold(fraction, |scrambled, bit| {
        // The bits above, with a mark for their number.
        let above = fraction.checked_shr(64 - bit).unwrap_or(0) | 1_u64 << bit;
        scrambled ^ (mixed(key ^ mixed(above)) >> 63) << (63 - bit)
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    const KEY: Dimension<'_> = Dimension { seed: 7, name: "law.relay.k_t", place: 0 };

    #[test]
    fn a_permutation_takes_every_number_once() {
        for count in [1, 2, 3, 5, 64, 1000] {
            let mut all: Vec<u64> = (0..count).map(|index| permuted(index, count, 42)).collect();
            assert!(count < 64 || !all.is_sorted());
            all.sort_unstable();
            assert_eq!(all, (0..count).collect::<Vec<_>>());
        }
    }

    #[test]
    fn a_latin_hypercube_has_a_point_in_each_interval() {
        let count = 100;
        for place in 0..3 {
            let dimension = Dimension { place, name: ["a", "b", "c"][place], ..KEY };
            let mut cells: Vec<u64> = (0..count)
                .map(|point| (Sampling::LatinHypercube.number(dimension, point, count) * 100.0) as u64)
                .collect();
            cells.sort_unstable();
            assert_eq!(cells, (0..count).collect::<Vec<_>>());
        }
    }

    /// Reference: SciPy 1.16, `scipy.stats.qmc.Sobol(d=5, scramble=False).random(8)`.
    #[test]
    fn the_sequence_is_that_of_joe_and_kuo() {
        let exact = [
            [0.0, 0.0, 0.0, 0.0, 0.0],
            [0.5, 0.5, 0.5, 0.5, 0.5],
            [0.75, 0.25, 0.25, 0.25, 0.75],
            [0.25, 0.75, 0.75, 0.75, 0.25],
            [0.375, 0.375, 0.625, 0.875, 0.375],
            [0.875, 0.875, 0.125, 0.375, 0.875],
            [0.625, 0.125, 0.875, 0.625, 0.625],
            [0.125, 0.625, 0.375, 0.125, 0.125],
        ];
        for (point, exact) in exact.iter().enumerate() {
            for (dimension, exact) in exact.iter().enumerate() {
                let found = sobol(point as u64, dimension) as f64 / 18_446_744_073_709_551_616.0;
                assert_eq!(found, *exact, "point {point}, dimension {dimension}");
            }
        }
    }

    /// Checks that 64 scrambled points are one in each cell of every partition of two keys into 64 like boxes.
    #[test]
    fn scrambled_points_are_a_net() {
        let number = |point, place| {
            let dimension = Dimension { place, name: ["a", "b"][place], ..KEY };
            Sampling::Sobol.number(dimension, point, 0)
        };
        for wide in [1_u64, 2, 4, 8, 16, 32, 64] {
            let high = 64 / wide;
            let mut boxes: Vec<u64> = (0..64)
                .map(|point| {
                    let column = (number(point, 0) * wide as f64) as u64;
                    column * high + (number(point, 1) * high as f64) as u64
                })
                .collect();
            boxes.sort_unstable();
            assert_eq!(boxes, (0..64).collect::<Vec<_>>(), "{wide} x {high}");
        }
        assert_ne!(number(0, 0), number(0, 1));
    }

    #[test]
    fn the_mean_of_a_smooth_function_converges_faster() {
        // The integral of (x + y)^2 over the unit square is 7/6.
        let error = |sampling: Sampling| {
            let count = 1024;
            let dimension_at = |place| Dimension { place, name: ["a", "b"][place], ..KEY };
            let sum: f64 = (0..count)
                .map(|point| {
                    let x = sampling.number(dimension_at(0), point, count)
                        + sampling.number(dimension_at(1), point, count);
                    x * x
                })
                .sum();
            (sum / count as f64 - 7.0 / 6.0).abs()
        };
        let [random, hypercube, sobol] = Sampling::ALL.map(|(_, sampling)| error(sampling));
        assert!(hypercube < random && sobol < 0.05 * random, "{random:e} {hypercube:e} {sobol:e}");
    }
}
