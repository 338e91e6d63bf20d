//! Frequency of a motion that is known at the samples of a period alone.
//!
//! With several samples in a period, an angle of the transfer leaves open which of as many frequencies it is: the motion has
//! a component at each, and the strongest one counts.

use std::f64::consts::{PI, TAU};

use nalgebra::{Complex, DMatrix};

use super::frequency_response::unit_circle;
use super::loci::{LociValues, eigenvector};

/// Samples of a loop in a period.
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct LoopSamples {
    /// Period (s).
    pub period: f64,
    /// Number of samples in it.
    pub count: usize,
}

impl LoopSamples {
    /// Returns the frequency (rad/s) of the strongest component of a motion at an angle, and true if the phase of that
    /// component is the negative one. The motion is that of some signals, sample after sample.
    pub fn frequency(self, angle: f64, motion: &[Complex<f64>]) -> (f64, bool) {
        let sizes = self.sizes(angle, motion);
        let strongest = (0..self.count).max_by(|a, b| sizes[*a].total_cmp(&sizes[*b]));
        self.component(angle, strongest.unwrap_or(0))
    }

    /// Returns the frequency (rad/s) of a component of a motion at an angle, and true if its phase is the negative one.
    pub fn component(self, angle: f64, component: usize) -> (f64, bool) {
        let (turn, rate) = (self.turn(angle, component), self.count as f64 / self.period);
        if turn > PI { ((TAU - turn) * rate, true) } else { (turn * rate, false) }
    }

    /// Returns the sizes of all components of a motion at an angle.
    pub fn sizes(self, angle: f64, motion: &[Complex<f64>]) -> Vec<f64> {
        let signals = motion.len() / self.count;
        let size = |component: usize| {
            let turn = self.turn(angle, component);
            let of_signal = |signal: usize| {
                let samples = motion.iter().skip(signal).step_by(signals.max(1)).enumerate();
                let turned = samples.map(|(sample, part)| part * unit_circle(-turn * sample as f64));
                turned.sum::<Complex<f64>>().norm_sqr()
            };
            (0..signals).map(of_signal).sum::<f64>()
        };
        (0..self.count).map(size).collect()
    }

    /// Returns the transfer over frequency (rad/s): each locus at the component that is strongest in its motion, and at
    /// each component one locus.
    pub fn over_frequency(
        self,
        transfers: &[(f64, DMatrix<Complex<f64>>)],
        all: &[LociValues],
    ) -> Vec<(f64, Complex<f64>)> {
        let mut found = Vec::new();
        // The loci have the same angles, in the same order, but for those at poles.
        let mut transfers = transfers.iter();
        for LociValues { angle, values } in all {
            let Some((_, matrix)) = transfers.find(|(other, _)| other == angle) else { continue };
            let mut choices = Vec::new();
            for (locus, value) in values.iter().enumerate().filter(|(_, value)| **value != Complex::ZERO) {
                let vector = if values.len() == 1 { None } else { eigenvector(matrix.clone(), *value) };
                let sizes = vector.map_or_else(|| vec![1.0], |own| self.sizes(*angle, own.as_slice()));
                choices
                    .extend(sizes.into_iter().enumerate().map(|(component, size)| (size, locus, component)));
            }
            choices.sort_by(|a, b| b.0.total_cmp(&a.0));
            while let Some((_, locus, component)) = choices.first().copied() {
                let (frequency, is_mirrored) = self.component(*angle, component);
                let value = values[locus];
                found.push((frequency, if is_mirrored { value.conj() } else { value }));
                choices.retain(|choice| choice.1 != locus && choice.2 != component);
            }
        }
        found.sort_by(|a, b| a.0.total_cmp(&b.0));
        found
    }

    /// Returns the angle between two samples of a component.
    fn turn(self, angle: f64, component: usize) -> f64 {
        (angle + TAU * component as f64) / self.count as f64
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Two signals at 5 rad/s, sampled five times in 1 s, and the mirrored motion.
    #[test]
    fn a_motion_has_its_own_frequency() {
        let samples = LoopSamples { period: 1.0, count: 5 };
        let motion = |frequency: f64| -> Vec<Complex<f64>> {
            let turn = |sample: i32| unit_circle(frequency * 0.2 * f64::from(sample));
            (0..5).flat_map(|sample| [turn(sample), turn(sample) * Complex::new(0.0, 0.5)]).collect()
        };
        for (frequency, is_mirrored) in [(5.0, false), (-5.0, true), (14.0, false)] {
            let angle = frequency - TAU * (frequency / TAU).floor();
            let (found, mirrored) = samples.frequency(angle, &motion(frequency));
            assert!((found - frequency.abs()).abs() < 1e-12, "{found}");
            assert_eq!(mirrored, is_mirrored);
        }
        assert_eq!(LoopSamples { period: 0.5, count: 1 }.frequency(1.0, &motion(1.0)[..1]), (2.0, false));
    }

    /// A loop of one rate, taken over three of its samples, has its own transfer over all its frequencies.
    #[test]
    fn loci_of_several_samples_are_the_transfer_over_frequency() {
        let transfer = |turn: f64| (unit_circle(turn) - Complex::new(0.5, 0.0)).inv();
        let samples = LoopSamples { period: 3.0, count: 3 };
        let lifted = |angle: f64| {
            let mut matrix = DMatrix::<Complex<f64>>::zeros(3, 3);
            for turn in (0..3).map(|component| samples.turn(angle, component)) {
                let motion = DMatrix::from_fn(3, 1, |sample, _| unit_circle(turn * sample as f64));
                matrix += &motion * motion.adjoint() * (transfer(turn) / 3.0);
            }
            (angle, matrix)
        };
        let transfers: Vec<_> = (1..40).map(|step| lifted(PI * f64::from(step) / 40.0)).collect();
        let all = super::super::loci::loci(transfers.iter().cloned());
        let found = samples.over_frequency(&transfers, &all);
        assert_eq!(found.len(), 3 * 39);
        for (frequency, value) in found {
            assert!((value - transfer(frequency)).norm() < 1e-9, "{frequency}: {value}");
        }
    }
}
