//! Root locus: poles of the closed loop as the gain of one of its loops changes, and where they become unstable.

use std::f64::consts::TAU;

use nalgebra::{Complex, DMatrix, DVector};
use rayon::prelude::*;

use super::frequency_response::modulus;
use super::sample_components::LoopSamples;
use crate::eigenvalues::eigenvalues;
use crate::open_loop::{OpenLoop, TransferMatrices};

/// Magnitude below which a pole is a state of one sample, without a frequency.
const SHORT: f64 = 1e-12;
/// Halvings of the step in which a pole crosses the imaginary axis.
const HALVINGS: usize = 40;
/// Motion of a pole, relative to its magnitude, below which the gain does not move it.
const STILL: f64 = 0.01;

/// Poles of the closed loop over the gain of one of its loops.
#[derive(Clone, Debug, PartialEq)]
pub struct RootLocus {
    /// Factors on the gain, in increasing order.
    pub factors: Vec<f64>,
    /// Poles s = ln(z)/T (rad/s) that the gain moves, each at each factor.
    pub branches: Vec<Vec<Complex<f64>>>,
    /// Poles (rad/s) without the loop, of those that the gain moves.
    pub open: Vec<Complex<f64>>,
    /// All poles (rad/s) at the gain as designed.
    pub designed: Vec<Complex<f64>>,
    /// Crossings of the imaginary axis at the gains next to that as designed: below it and above it.
    pub crossings: Vec<LocusCrossing>,
}

/// Crossing of the imaginary axis by a pole, where the loop becomes unstable.
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct LocusCrossing {
    /// Factor on the gain.
    pub factor: f64,
    /// Frequency (rad/s).
    pub frequency_rad_s: f64,
}

impl RootLocus {
    /// Follows the poles of a closed loop over factors on the gain of one of its signals, in increasing order with 1 among them;
    /// `None` if there are no poles at one of them.
    pub fn new(opened: &OpenLoop, signal: usize, factors: &[f64]) -> Option<Self> {
        let gain = VariedGain { opened, signal };
        let all: Vec<Vec<Complex<f64>>> =
            factors.par_iter().map(|factor| gain.logarithms(*factor)).collect::<Option<_>>()?;
        let own = factors.iter().position(|factor| *factor == 1.0)?;
        let mut branches: Vec<Vec<Complex<f64>>> = all[own].iter().map(|pole| vec![*pole]).collect();
        // Each is followed to both sides, so that the poles as designed are in one order.
        for poles in &all[own + 1..] {
            follow(&mut branches, poles);
        }
        for branch in &mut branches {
            branch.reverse();
        }
        for poles in all[..own].iter().rev() {
            follow(&mut branches, poles);
        }
        for branch in &mut branches {
            branch.reverse();
        }
        let turns: Vec<f64> = gain.turns(branches.iter().map(|branch| branch[own]));
        for (branch, turn) in branches.iter_mut().zip(turns) {
            for pole in branch.iter_mut() {
                *pole = (*pole + Complex::new(0.0, turn)) / opened.period;
            }
        }
        let designed = branches.iter().map(|branch| branch[own]).collect();
        let moves = |branch: &Vec<Complex<f64>>| {
            let farthest = branch.iter().map(|pole| modulus(pole - branch[own])).fold(0.0, f64::max);
            farthest > STILL * modulus(branch[own])
        };
        branches.retain(moves);
        let without = gain.logarithms(0.0)?;
        let mut ends: Vec<Vec<Complex<f64>>> =
            branches.iter().map(|branch| vec![branch[0] * Complex::from(opened.period)]).collect();
        follow(&mut ends, &without);
        let open = ends.into_iter().filter_map(|end| Some(*end.last()? / opened.period)).collect();
        let crossings = gain.crossings(factors, &branches, own);
        Some(Self { factors: factors.to_vec(), branches, open, designed, crossings })
    }
}

/// Appends to each branch the pole that continues it: the nearest pairs first. A branch whose pole has no logarithm any more stays.
fn follow(branches: &mut [Vec<Complex<f64>>], poles: &[Complex<f64>]) {
    let ends: Vec<Complex<f64>> = branches.iter().filter_map(|branch| branch.last().copied()).collect();
    let mut pairs: Vec<(f64, usize, usize)> = Vec::with_capacity(ends.len() * poles.len());
    for (branch, end) in ends.iter().enumerate() {
        pairs.extend(
            poles.iter().enumerate().map(|(pole, other)| (modulus(apart(*end, *other)), branch, pole)),
        );
    }
    pairs.sort_by(|a, b| a.0.total_cmp(&b.0).then((a.1, a.2).cmp(&(b.1, b.2))));
    let (mut next, mut is_taken) = (ends.clone(), (vec![false; ends.len()], vec![false; poles.len()]));
    for (_, branch, pole) in pairs {
        if !is_taken.0[branch] && !is_taken.1[pole] {
            (is_taken.0[branch], is_taken.1[pole]) = (true, true);
            next[branch] = ends[branch] + apart(ends[branch], poles[pole]);
        }
    }
    branches.iter_mut().zip(next).for_each(|(branch, pole)| branch.push(pole));
}

/// Returns the way from a logarithm of a pole to that of another, the shorter way round.
fn apart(from: Complex<f64>, to: Complex<f64>) -> Complex<f64> {
    let way = to - from;
    Complex::new(way.re, way.im - TAU * (way.im / TAU).round())
}

/// Loop with a factor on the gain of one of its signals.
struct VariedGain<'a> {
    opened: &'a OpenLoop,
    signal: usize,
}

impl VariedGain<'_> {
    /// Returns the transfer with a factor on the gain, closed.
    fn closed(&self, factor: f64) -> Option<TransferMatrices> {
        let mut transfer = self.opened.transfer.clone();
        for row in (self.signal..transfer.c.nrows()).step_by(self.opened.signals.len()) {
            transfer.c.row_mut(row).scale_mut(factor);
            transfer.d.row_mut(row).scale_mut(factor);
        }
        transfer.sensitivity()
    }

    /// Returns the logarithms of the poles at a factor.
    fn logarithms(&self, factor: f64) -> Option<Vec<Complex<f64>>> {
        let poles = eigenvalues(&self.closed(factor)?.a)?;
        let log =
            |pole: &Complex<f64>| Complex::new(libm::log(modulus(*pole)), libm::atan2(pole.im, pole.re));
        Some(poles.iter().filter(|pole| modulus(**pole) > SHORT).map(log).collect())
    }

    /// Returns the whole turns in a period of each pole as designed, as an angle: 0 with one sample in a period, where they cannot
    /// be known.
    fn turns(&self, poles: impl ExactSizeIterator<Item = Complex<f64>>) -> Vec<f64> {
        let samples = LoopSamples { period: self.opened.period, count: self.opened.samples };
        let closed = self.closed(1.0).filter(|_| samples.count > 1);
        let turn = |log: Complex<f64>| -> f64 {
            let motion = closed.as_ref().and_then(|closed| motion(closed, log));
            let Some(motion) = motion else { return 0.0 };
            let (frequency, is_mirrored) = samples.frequency(log.im, motion.as_slice());
            let angle = frequency * samples.period * if is_mirrored { -1.0 } else { 1.0 };
            TAU * ((angle - log.im) / TAU).round()
        };
        poles.map(turn).collect()
    }

    /// Returns the crossings of the imaginary axis next to the gain as designed, at the place `own`.
    fn crossings(&self, factors: &[f64], branches: &[Vec<Complex<f64>>], own: usize) -> Vec<LocusCrossing> {
        let leaves = |inner: usize, outer: usize| {
            let leaves = |branch: &&Vec<Complex<f64>>| branch[inner].re < 0.0 && branch[outer].re >= 0.0;
            let leaving = branches.iter().filter(leaves);
            let found = leaving.filter_map(|branch| {
                self.crossing([factors[inner], factors[outer]], [branch[inner], branch[outer]])
            });
            let from_own = |crossing: &LocusCrossing| libm::log(crossing.factor).abs();
            found.min_by(|a, b| from_own(a).total_cmp(&from_own(b)))
        };
        let below = (1..=own).rev().find_map(|inner| leaves(inner, inner - 1));
        let above = (own..factors.len() - 1).find_map(|inner| leaves(inner, inner + 1));
        below.into_iter().chain(above).collect()
    }

    /// Returns the crossing between two factors, at which a pole is stable and unstable.
    fn crossing(&self, factors: [f64; 2], poles: [Complex<f64>; 2]) -> Option<LocusCrossing> {
        let period = Complex::from(self.opened.period);
        let ([mut stable, mut unstable], [mut inner, mut outer]) = (factors, poles.map(|pole| pole * period));
        for _ in 0..HALVINGS {
            let factor = f64::sqrt(stable * unstable);
            let expected = (inner + outer) / Complex::from(2.0);
            let all = self.logarithms(factor)?;
            let ways = all.iter().map(|pole| apart(expected, *pole));
            let pole = expected + ways.min_by(|a, b| modulus(*a).total_cmp(&modulus(*b)))?;
            if pole.re < 0.0 { (stable, inner) = (factor, pole) } else { (unstable, outer) = (factor, pole) }
        }
        let frequency_rad_s = outer.im.abs() / self.opened.period;
        Some(LocusCrossing { factor: unstable, frequency_rad_s })
    }
}

/// Returns the motion of the outputs of a closed loop in the eigenvector of a pole, by inverse iteration.
fn motion(closed: &TransferMatrices, log: Complex<f64>) -> Option<DVector<Complex<f64>>> {
    let pole = Complex::new(libm::cos(log.im), libm::sin(log.im)) * Complex::from(libm::exp(log.re));
    // A shift beside the pole keeps the matrix regular.
    let shift = pole * Complex::new(1.0 + 1e-9, 1e-9);
    let a: DMatrix<Complex<f64>> = closed.a.map(Complex::from);
    let factors = (a - DMatrix::from_diagonal_element(closed.a.nrows(), closed.a.nrows(), shift)).lu();
    let mut vector = DVector::from_element(closed.a.nrows(), Complex::from(1.0));
    for _ in 0..3 {
        vector = factors.solve(&vector)?;
        let size = vector.norm();
        vector /= Complex::from(size);
    }
    let outputs = closed.c.map(Complex::from) * vector;
    outputs.iter().all(|value| value.re.is_finite() && value.im.is_finite()).then_some(outputs)
}

#[cfg(test)]
mod tests {
    use nalgebra::dmatrix;

    use super::*;
    use crate::linear_model::Signal;
    use crate::open_loop::LoopBreak;

    fn opened(transfer: TransferMatrices) -> OpenLoop {
        let signal = |name: &str| Signal { name: name.to_owned(), unit: String::new() };
        OpenLoop {
            opened: LoopBreak::Command,
            period: 0.5,
            samples: 1,
            states: vec![signal("angle"); transfer.a.nrows()],
            signals: (0..transfer.b.ncols()).map(|_| signal("command")).collect(),
            transfer,
        }
    }

    /// An integrator with a gain g of the sample of 0.5 s: z = 1 - k g.
    #[test]
    fn the_pole_of_an_integrator() {
        let transfer =
            TransferMatrices { a: dmatrix![1.0], b: dmatrix![0.2], c: dmatrix![1.0], d: dmatrix![0.0] };
        let found = RootLocus::new(&opened(transfer), 0, &[0.5, 1.0, 4.0]).expect("poles");
        for (pole, left) in found.branches[0].iter().zip([0.9, 0.8, 0.2]) {
            assert!((pole.re - libm::log(left) / 0.5).abs() < 1e-14 && pole.im == 0.0, "{pole}");
        }
        assert_eq!(found.open, [Complex::ZERO]);
        assert_eq!((found.designed.len(), found.crossings.len()), (1, 0));
    }

    /// A delayed integrator, z² - z + k g = 0: the poles are on the unit circle at k g = 1, where z is exp(i pi/3). A second
    /// loop, which the gain of the first does not move, is no branch.
    #[test]
    fn a_delayed_integrator_becomes_unstable_at_a_sixth_of_its_samples() {
        let transfer = TransferMatrices {
            a: dmatrix![1.0, 0.2, 0.0; 0.0, 0.0, 0.0; 0.0, 0.0, 1.0],
            b: dmatrix![0.0, 0.0; 1.0, 0.0; 0.0, 0.3],
            c: dmatrix![1.0, 0.0, 0.0; 0.0, 0.0, 1.0],
            d: dmatrix![0.0, 0.0; 0.0, 0.0],
        };
        let factors: Vec<f64> = (-10..=30).map(|step| libm::pow(10.0, f64::from(step) / 20.0)).collect();
        let found = RootLocus::new(&opened(transfer), 0, &factors).expect("poles");
        assert_eq!((found.branches.len(), found.designed.len()), (2, 3));
        let crossing = found.crossings[0];
        assert!((crossing.factor - 5.0).abs() < 1e-9, "{crossing:?}");
        assert!((crossing.frequency_rad_s - TAU / 6.0 / 0.5).abs() < 1e-9, "{crossing:?}");
        assert_eq!(found.crossings.len(), 1);
    }
}
