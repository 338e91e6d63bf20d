//! Seeded random numbers: one independent stream for each (scenario seed, run, consumer).

use rand::rngs::ChaCha8Rng;
use rand::{Rng, SeedableRng};

/// Seed of one run: the scenario's seed and the number of the run.
#[derive(Copy, Clone, Debug, PartialEq, Eq)]
pub struct Seed {
    /// Seed of the scenario.
    pub scenario: u64,
    /// Number of the run, from 0.
    pub run: u64,
}

impl Seed {
    /// Returns the stream of one named consumer. Adding a consumer does not change other streams.
    pub fn stream(self, consumer: &str) -> Stream {
        let mut key = [0_u8; 32];
        key[..8].copy_from_slice(&self.scenario.to_le_bytes());
        key[8..16].copy_from_slice(&self.run.to_le_bytes());
        key[16..24].copy_from_slice(&fnv1a(consumer).to_le_bytes());
        Stream { source: ChaCha8Rng::from_seed(key), spare: None }
    }
}

/// Computes FNV-1a, a published hash with fixed constants that is the same on all platforms.
pub fn fnv1a(text: &str) -> u64 {
    fnv1a_of(&[text.as_bytes()])
}

/// FNV-1a of bytes in several pieces. Two texts of one length that differ in a single byte never have the same one.
pub fn fnv1a_of(pieces: &[&[u8]]) -> u64 {
    pieces.iter().copied().flatten().fold(0xcbf2_9ce4_8422_2325, |hash, byte| {
        (hash ^ u64::from(*byte)).wrapping_mul(0x0000_0100_0000_01b3)
    })
}

/// Stream of random numbers, the same on every machine.
#[derive(Debug)]
pub struct Stream {
    source: ChaCha8Rng,
    spare: Option<f64>,
}

/// The generator cannot be cloned: a clone has the same seed and position, and draws the same numbers.
impl Clone for Stream {
    fn clone(&self) -> Self {
        let mut source = ChaCha8Rng::from_seed(self.source.get_seed());
        source.set_word_pos(self.source.get_word_pos());
        Stream { source, spare: self.spare }
    }
}

impl Stream {
    /// Draws a uniform number on [0, 1), a multiple of 2^-53.
    pub fn uniform(&mut self) -> f64 {
        (self.source.next_u64() >> 11) as f64 * (1.0 / 9_007_199_254_740_992.0)
    }

    /// Draws a uniform index in `0..count`.
    pub fn index(&mut self, count: usize) -> usize {
        ((self.uniform() * count as f64) as usize).min(count - 1)
    }

    /// Draws a normal number with mean 0 and standard deviation 1 (Box-Muller).
    pub fn normal(&mut self) -> f64 {
        if let Some(spare) = self.spare.take() {
            return spare;
        }
        let radius = f64::sqrt(-2.0 * libm::log(1.0 - self.uniform()));
        let (sin, cos) = libm::sincos(2.0 * std::f64::consts::PI * self.uniform());
        self.spare = Some(radius * sin);
        radius * cos
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn streams_are_independent_of_each_other() {
        let seed = Seed { scenario: 7, run: 57 };
        let single: Vec<f64> = {
            let mut stream = seed.stream("sensor");
            (0..4).map(|_| stream.uniform()).collect()
        };
        let mut other = seed.stream("adaptation");
        let mut stream = seed.stream("sensor");
        let interleaved: Vec<f64> = (0..4).map(|_| (other.uniform(), stream.uniform()).1).collect();
        assert_eq!(single, interleaved);
        assert_ne!(other.uniform(), stream.uniform());
        let next_run = Seed { run: 58, ..seed }.stream("sensor").uniform();
        assert_ne!(single[0], next_run);
    }

    #[test]
    fn a_clone_draws_what_the_stream_draws() {
        let mut stream = Seed { scenario: 7, run: 3 }.stream("sensor");
        // Covers more draws than the generator buffers, at and between block boundaries, with and without a spare
        // normal number.
        for _ in 0..300 {
            stream.normal();
            let (mut first_copy, mut second_copy) = (stream.clone(), stream.clone());
            first_copy.uniform();
            second_copy.uniform();
            for _ in 0..40 {
                assert_eq!(first_copy.normal(), second_copy.normal());
            }
            let mut single = stream.clone();
            assert_eq!(single.normal(), stream.normal());
            assert_eq!(single.uniform(), stream.uniform());
        }
    }

    #[test]
    fn normal_has_the_moments_of_a_normal() {
        let mut stream = Seed { scenario: 1, run: 0 }.stream("normal");
        let n = 100_000;
        let draws: Vec<f64> = (0..n).map(|_| stream.normal()).collect();
        let mean = draws.iter().sum::<f64>() / f64::from(n);
        let variance = draws.iter().map(|z| (z - mean) * (z - mean)).sum::<f64>() / f64::from(n);
        let kurtosis = draws.iter().map(|z| libm::pow(z - mean, 4.0)).sum::<f64>() / f64::from(n);
        // Bounds of about three standard errors: 1/sqrt(n), sqrt(2/n), sqrt(24/n) for variance one.
        assert!(mean.abs() < 0.0095, "{mean}");
        assert!((variance - 1.0).abs() < 0.0135, "{variance}");
        assert!((kurtosis / (variance * variance) - 3.0).abs() < 0.05, "{kurtosis}");
    }
}
