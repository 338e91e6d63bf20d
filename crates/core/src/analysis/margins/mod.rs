//! Stability margins of a loop that is cut open: gain, phase and delay at every crossing, modulus and disk margins.
//!
//! Each signal at the break has its own margins, with the loops of the others closed. All signals together have a
//! modulus margin 1/max s1(S) and a disk margin 1/max s1((S - T)/2), with the largest singular value s1, for any
//! perturbation of the matrix of loop gains \[SeilerPackardGahinet20\].

mod crossings;
mod frequency_grid;
pub(in crate::analysis) mod frequency_response;
mod loci;
pub(in crate::analysis) mod poles;

use std::f64::consts::PI;

use flexsc_numerics::scalar_search::maximum;
use nalgebra::{Complex, DMatrix};
use serde::{Serialize, Serializer};

pub use crossings::{Crossings, GainCrossing, PhaseCrossing};
pub use frequency_grid::frequency_grid;
pub use frequency_response::FrequencyResponse;
pub use loci::LociValues;
pub use poles::{UnstableLoop, eigenvalues};

use super::open_loop::{LoopBreak, OpenLoop, TransferMatrices};
pub(super) use frequency_grid::coarse_frequency_grid;
pub(super) use frequency_response::{largest_gain, modulus, unit_circle};
pub(super) use loci::eigenvalues_of;
pub(super) use poles::ROUNDING;

use crossings::SampledTransfer;
use loci::loci;

/// Number of largest values on the grid that are refined.
const REFINED: usize = 3;

/// Margins of a stable loop.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct StabilityMargins {
    /// Largest magnitude of a pole of the closed loop.
    pub spectral_radius: f64,
    /// Point at which the loop is cut open.
    #[serde(rename = "loop", serialize_with = "break_name")]
    pub opened: LoopBreak,
    /// Period after which the loop repeats (s).
    pub period_s: f64,
    /// Samples of the law in a period.
    pub samples: usize,
    /// Margins of each signal at the break, with the loops of the others closed.
    pub loops: Vec<SignalMargins>,
    /// Modulus margin of all signals together.
    pub modulus: PeakMargin,
    /// Disk margin of all signals together.
    pub disk: DiskMargin,
}

#[expect(clippy::trivially_copy_pass_by_ref, reason = "serde asks for a reference")]
fn break_name<S: Serializer>(opened: &LoopBreak, serializer: S) -> Result<S::Ok, S::Error> {
    serializer.serialize_str(opened.name())
}

/// Margins of one signal at the break.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct SignalMargins {
    /// Name of the signal.
    pub signal: String,
    /// Crossings with their margins.
    #[serde(flatten)]
    pub crossings: Crossings,
    /// Largest factor below 1 on the loop gain at which the loop is at the limit of stability; 0 if there is none.
    pub gain_below: f64,
    /// Smallest factor above 1 on the loop gain at which the loop is at the limit of stability; none if there is none.
    pub gain_above: Option<f64>,
    /// Smallest phase, of either sign, that makes the loop unstable (rad); pi if there is none.
    pub phase_rad: f64,
    /// Smallest delay that makes the loop unstable (s); none if there is none, or for several samples in a period.
    pub delay_s: Option<f64>,
    /// Modulus margin: smallest distance of the loop transfer from -1.
    pub modulus: PeakMargin,
    /// Disk margin.
    pub disk: DiskMargin,
    /// Loop transfer over frequency: its value, or its eigenvalues for several samples in a period.
    #[serde(skip)]
    pub loci: Vec<LociValues>,
}

/// Margin that is the inverse of a largest value over frequency.
#[derive(Copy, Clone, Debug, PartialEq, Serialize)]
pub struct PeakMargin {
    /// Margin.
    pub margin: f64,
    /// Frequency at which it is attained (rad/s).
    pub frequency_rad_s: f64,
}

/// Symmetric disk margin: gain and phase may be off together.
#[derive(Copy, Clone, Debug, PartialEq, Serialize)]
pub struct DiskMargin {
    /// Margin alpha, at most 2.
    pub alpha: f64,
    /// Frequency at which it is attained (rad/s).
    pub frequency_rad_s: f64,
    /// Factors on the loop gain within which the loop is stable.
    pub gains: [f64; 2],
    /// Phase of either sign up to which the loop is stable (rad).
    pub phase_rad: f64,
}

impl StabilityMargins {
    /// Computes the margins of a loop.
    ///
    /// # Errors
    /// The closed loop is not stable.
    pub fn new(opened: &OpenLoop) -> Result<Self, UnstableLoop> {
        let failed = |signal: &str| UnstableLoop {
            spectral_radius: f64::INFINITY,
            frequency_rad_s: 0.0,
            damping: -1.0,
            signal: signal.to_owned(),
        };
        let first = opened.signals.first().map_or("", |signal| &signal.name);
        let sensitivity = opened.transfer.sensitivity().ok_or_else(|| failed(first))?;
        let closed = eigenvalues(&sensitivity.a).ok_or_else(|| failed(first))?;
        let spectral_radius = poles::require_stable(opened, &sensitivity.a, &closed)?;
        let mut others = eigenvalues(&opened.transfer.a).unwrap_or_default();
        let count = opened.signals.len();
        let all: Vec<usize> = (0..opened.transfer.b.ncols()).collect();
        let mut signals = Vec::with_capacity(count);
        for (index, signal) in opened.signals.iter().enumerate() {
            let own: Vec<usize> = all.iter().copied().filter(|place| place % count == index).collect();
            let transfer = opened.transfer.with_others_closed(&own).ok_or_else(|| failed(&signal.name))?;
            // The loop with the others closed has resonances of its own.
            others.extend(eigenvalues(&transfer.a).unwrap_or_default());
            signals.push((own, transfer));
        }
        let sensitivity = Sensitivity::new(&sensitivity, frequency_grid(&closed, &others), opened.period);
        let loops = opened.signals.iter().zip(&signals).map(|(signal, (own, transfer))| {
            let response = FrequencyResponse::new(transfer);
            let (period, samples) = (opened.period, opened.samples);
            let transfer = SampledTransfer { response: &response, period, samples };
            SignalMargins::new(&signal.name, &transfer, &sensitivity, own)
        });
        let loops = loops.collect();
        Ok(Self {
            spectral_radius,
            opened: opened.opened,
            period_s: opened.period,
            samples: opened.samples,
            loops,
            modulus: sensitivity.modulus(&all),
            disk: sensitivity.disk(&all),
        })
    }
}

impl SignalMargins {
    fn new(signal: &str, transfer: &SampledTransfer<'_>, sensitivity: &Sensitivity, own: &[usize]) -> Self {
        let loci = loci(sensitivity.loop_transfers(own));
        let crossings = Crossings::find(transfer, &loci);
        let factors = || crossings.phase.iter().map(|crossing| crossing.factor);
        let phases = crossings.gain.iter().map(|crossing| crossing.phase_rad.abs());
        let delays = crossings.gain.iter().filter_map(|crossing| crossing.delay_s);
        Self {
            signal: signal.to_owned(),
            gain_below: factors().filter(|factor| *factor < 1.0).fold(0.0, f64::max),
            gain_above: factors().filter(|factor| *factor >= 1.0).min_by(f64::total_cmp),
            phase_rad: phases.fold(PI, f64::min),
            delay_s: delays.min_by(f64::total_cmp),
            modulus: sensitivity.modulus(own),
            disk: sensitivity.disk(own),
            crossings,
            loci,
        }
    }
}

/// Sensitivity of all signals over a grid of angles.
struct Sensitivity {
    response: FrequencyResponse,
    angles: Vec<f64>,
    /// Value at each angle; none at a pole.
    values: Vec<Option<DMatrix<Complex<f64>>>>,
    period: f64,
}

impl Sensitivity {
    fn new(transfer: &TransferMatrices, angles: Vec<f64>, period: f64) -> Self {
        let response = FrequencyResponse::new(transfer);
        let values = angles.iter().map(|angle| response.scan(unit_circle(*angle))).collect();
        Self { response, angles, values, period }
    }

    /// Returns the loop transfer of some signals at each angle, with the loops of the others closed: S^-1 - 1 of their
    /// block of the sensitivity S.
    fn loop_transfers(&self, own: &[usize]) -> impl Iterator<Item = (f64, DMatrix<Complex<f64>>)> {
        self.angles.iter().zip(&self.values).filter_map(|(angle, value)| {
            let value = value.as_ref()?;
            let own = DMatrix::from_fn(own.len(), own.len(), |row, column| value[(own[row], own[column])]);
            let one = DMatrix::identity(own.nrows(), own.ncols());
            Some((*angle, own.try_inverse()? - one))
        })
    }

    /// Returns the modulus margin of some signals, 1/max s1(S).
    fn modulus(&self, signals: &[usize]) -> PeakMargin {
        self.peak(signals, 0.0)
    }

    /// Returns the disk margin of some signals, 1/max s1(S - 1/2).
    fn disk(&self, signals: &[usize]) -> DiskMargin {
        let PeakMargin { margin: alpha, frequency_rad_s } = self.peak(signals, 0.5);
        let least = (2.0 - alpha) / (2.0 + alpha);
        let phase_rad = 2.0 * libm::atan(0.5 * alpha);
        DiskMargin { alpha, frequency_rad_s, gains: [least, 1.0 / least], phase_rad }
    }

    /// Returns the inverse of the largest s1(S - shift) over frequency, of some signals.
    fn peak(&self, signals: &[usize], shift: f64) -> PeakMargin {
        let gain = |value: &DMatrix<Complex<f64>>| {
            let count = signals.len();
            let own = DMatrix::from_fn(count, count, |row, column| {
                value[(signals[row], signals[column])] - if row == column { shift } else { 0.0 }
            });
            largest_gain(&own)
        };
        let gains: Vec<f64> = self.values.iter().map(|value| value.as_ref().map_or(0.0, &gain)).collect();
        let last = gains.len() - 1;
        let mut peaks: Vec<usize> = (0..=last)
            .filter(|k| (*k == 0 || gains[k - 1] <= gains[*k]) && (*k == last || gains[k + 1] <= gains[*k]))
            .collect();
        peaks.sort_by(|a, b| gains[*b].total_cmp(&gains[*a]));
        let at = |angle: f64| self.response.at(unit_circle(angle)).as_ref().map_or(0.0, &gain);
        let refined = peaks.iter().take(REFINED).map(|k| {
            let found = maximum(at, self.angles[k.saturating_sub(1)], self.angles[(k + 1).min(last)]);
            if found.1 > gains[*k] { found } else { (self.angles[*k], gains[*k]) }
        });
        let largest = refined.max_by(|a, b| a.1.total_cmp(&b.1)).unwrap_or((PI, 0.0));
        PeakMargin { margin: 1.0 / largest.1, frequency_rad_s: largest.0 / self.period }
    }
}
