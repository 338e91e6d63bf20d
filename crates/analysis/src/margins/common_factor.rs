//! Margins of several signals of a loop that are off together, by one factor or one phase.

use std::f64::consts::PI;
use std::fmt;

use flexsc_numerics::inverse::inverse;
use nalgebra::{Complex, DMatrix};

use super::Sensitivity;
use super::crossings::{Crossings, SampledTransfer};
use super::frequency_response::{FrequencyResponse, modulus};
use super::loci::loci;
use super::poles::{STEADY_RATE, UnstableLoop, require_stable};
use super::sample_components::LoopSamples;
use crate::eigenvalues::eigenvalues;
use crate::linear_model::Signal;
use crate::open_loop::{LoopBreak, OpenLoop, TransferMatrices};

/// Half a period of the bilinear map, relative to the time in which the loop moves: no pole of a plant in round numbers is on it.
const HALF_PERIOD: f64 = 0.317_23;

/// Margins of signals that are off together: how far, before the closed loop is at the limit of stability.
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct CommonMargins {
    /// Largest factor below 1 at which the loop is at the limit of stability; 0 if there is none.
    pub gain_below: f64,
    /// Smallest factor above 1 at which it is; none if there is none.
    pub gain_above: Option<f64>,
    /// Smallest phase, of either sign, at which it is (rad); pi if there is none.
    pub phase_rad: f64,
}

/// Reason why a loop has no margins.
#[derive(Clone, Debug, PartialEq)]
pub enum NoMargins {
    /// Pole of the closed loop that grows from sample to sample.
    Sampled(UnstableLoop),
    /// Pole of the closed loop in continuous time that grows (1/s).
    Continuous(Complex<f64>),
}

impl fmt::Display for NoMargins {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Sampled(unstable) => write!(f, "{unstable}"),
            Self::Continuous(pole) => write!(
                f,
                "the closed loop is not stable and has no margins: it has a pole at {:.5} {:+.5}i rad/s",
                pole.re, pole.im
            ),
        }
    }
}

impl std::error::Error for NoMargins {}

impl CommonMargins {
    /// Computes the margins of some channels of a loop, by their places; the loops of the others stay closed.
    ///
    /// # Errors
    /// The closed loop is not stable.
    pub fn new(opened: &OpenLoop, own: &[usize]) -> Result<Self, UnstableLoop> {
        let failed =
            || UnstableLoop::with_unknown_poles(opened.signals.first().map_or("", |signal| &signal.name));
        let sensitivity = opened.transfer.sensitivity().ok_or_else(failed)?;
        let closed = eigenvalues(&sensitivity.a).ok_or_else(failed)?;
        require_stable(opened, &sensitivity.a, &closed)?;
        let transfer = opened.transfer.with_others_closed(own).ok_or_else(failed)?;
        let mut others = eigenvalues(&opened.transfer.a).ok_or_else(failed)?;
        others.extend(eigenvalues(&transfer.a).ok_or_else(failed)?);
        let samples = LoopSamples { period: opened.period, count: opened.samples };
        let sensitivity = Sensitivity::new(&sensitivity, (&closed, &others), samples);
        let response = FrequencyResponse::new(&transfer);
        let transfer =
            SampledTransfer { response: &response, period: opened.period, samples: opened.samples };
        Ok(Self::from_crossings(&Crossings::find(&transfer, &loci(sensitivity.loop_transfers(own)))))
    }

    /// Computes the margins of some channels of a loop in continuous time, or of one that repeats after a period (s), whose
    /// channels are these signals, at each sample in the period.
    ///
    /// # Errors
    /// The closed loop is not stable.
    pub fn from_transfer(
        transfer: TransferMatrices,
        period: Option<f64>,
        signals: Vec<String>,
        own: &[usize],
    ) -> Result<Self, NoMargins> {
        let unknown = || NoMargins::Sampled(UnstableLoop::with_unknown_poles(&signals[0]));
        let (transfer, period) = match period {
            Some(period) => (transfer, period),
            None => bilinear(&transfer)?.ok_or_else(unknown)?,
        };
        let samples = transfer.b.ncols() / signals.len();
        let signal = |name: String| Signal { name, unit: String::new() };
        let opened = OpenLoop {
            transfer,
            states: Vec::new(),
            signals: signals.into_iter().map(signal).collect(),
            opened: LoopBreak::Command,
            period,
            samples,
        };
        Self::new(&opened, own).map_err(NoMargins::Sampled)
    }

    /// Returns the margins of a loop with these crossings.
    pub(super) fn from_crossings(crossings: &Crossings) -> Self {
        let factors = || crossings.phase.iter().map(|crossing| crossing.factor);
        let phases = crossings.gain.iter().map(|crossing| crossing.phase_rad.abs());
        Self {
            gain_below: factors().filter(|factor| *factor < 1.0).fold(0.0, f64::max),
            gain_above: factors().filter(|factor| *factor >= 1.0).min_by(f64::total_cmp),
            phase_rad: phases.fold(PI, f64::min),
        }
    }
}

/// Maps a loop in continuous time to samples by s = (z - 1)/(h (z + 1)), which keeps gains and phases; `None` if it has no
/// image.
fn bilinear(transfer: &TransferMatrices) -> Result<Option<(TransferMatrices, f64)>, NoMargins> {
    let Some(closed) = transfer.sensitivity().and_then(|sensitivity| eigenvalues(&sensitivity.a)) else {
        return Ok(None);
    };
    let fastest = closed.iter().copied().max_by(|a, b| a.re.total_cmp(&b.re));
    if let Some(pole) = fastest.filter(|pole| pole.re > STEADY_RATE) {
        return Err(NoMargins::Continuous(pole));
    }
    // The middle of the frequencies, in octaves.
    let sizes: Vec<f64> =
        closed.iter().map(|pole| modulus(*pole)).filter(|size| *size > STEADY_RATE).collect();
    let middle = sizes.iter().map(|size| libm::log(*size)).sum::<f64>() / sizes.len().max(1) as f64;
    let half = HALF_PERIOD / libm::exp(middle);
    let one = DMatrix::identity(transfer.a.nrows(), transfer.a.nrows());
    let Some(back) = inverse(&one - &transfer.a * half) else { return Ok(None) };
    let b = &back * &transfer.b;
    let image = TransferMatrices {
        a: &back * (one + &transfer.a * half),
        c: &transfer.c * &back,
        d: &transfer.d + &transfer.c * &b * half,
        b: b * (2.0 * half),
    };
    Ok(Some((image, 2.0 * half)))
}

#[cfg(test)]
mod tests {
    use nalgebra::dmatrix;

    use super::*;

    /// L = 1.5/s³ + 3/s² + 2/s behind one more gain: k (2 s² + 3 s + 1.5)/s³ is stable for 6 k > 1.5, and crosses 1 at
    /// the root of w⁶ = 4 w⁴ + 3 w² + 2.25 for k = 1.
    #[test]
    fn a_loop_in_continuous_time() {
        let transfer = TransferMatrices {
            a: dmatrix![0.0, 1.0, 0.0; 0.0, 0.0, 1.0; 0.0, 0.0, 0.0],
            b: dmatrix![0.0; 0.0; 1.0],
            c: dmatrix![1.5, 3.0, 2.0],
            d: dmatrix![0.0],
        };
        let found =
            CommonMargins::from_transfer(transfer.clone(), None, vec!["u".into()], &[0]).expect("stable");
        assert!((found.gain_below - 0.25).abs() < 1e-9, "{found:?}");
        assert_eq!(found.gain_above, None);
        let at = |w: f64| Complex::new(1.5 - 2.0 * w * w, 3.0 * w) / Complex::new(0.0, -w * w * w);
        let (mut low, mut high) = (1.0, 10.0);
        for _ in 0..100 {
            let middle = 0.5 * (low + high);
            if at(middle).norm_sqr() > 1.0 { low = middle } else { high = middle }
        }
        let crossing = -at(low);
        let phase = crossing.im.atan2(crossing.re).abs();
        assert!((found.phase_rad - phase).abs() < 1e-9, "{} {phase}", found.phase_rad);
        let unstable = TransferMatrices { c: dmatrix![-1.0, 0.0, 0.0], ..transfer };
        let Err(NoMargins::Continuous(pole)) =
            CommonMargins::from_transfer(unstable, None, vec!["u".into()], &[0])
        else {
            panic!("stable")
        };
        assert!((pole.re - 1.0).abs() < 1e-12, "s³ = 1");
    }
}
