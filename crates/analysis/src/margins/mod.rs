//! Stability margins of a loop that is cut open: gain, phase and delay at every crossing, modulus and disk margins.
//!
//! Each signal at the break has its own margins, with the loops of the others closed. All signals together have a
//! modulus margin 1/max s1(S) and a disk margin 1/max s1((S - T)/2), with the largest singular value s1, for any
//! perturbation of the matrix of loop gains \[SeilerPackardGahinet20\].

mod common_delay;
mod common_factor;
mod crossings;
mod frequency_grid;
pub(crate) mod frequency_response;
mod independent_gain;
mod loci;
pub(crate) mod poles;
mod residue_response;
mod root_locus;
mod sample_components;

use std::f64::consts::PI;

use flexsc_numerics::scalar_search::maximum;
use nalgebra::{Complex, DMatrix};
use schemars::JsonSchema;
use serde::Serialize;

pub use common_factor::{CommonMargins, NoMargins};
pub use crossings::{Crossings, GainCrossing, PhaseCrossing};
pub use frequency_grid::frequency_grid;
pub use frequency_response::FrequencyResponse;
pub use loci::LociValues;
pub use poles::{UnstableLoop, steady_change};
pub use root_locus::{LocusCrossing, RootLocus};

use super::open_loop::{LoopBreak, OpenLoop, TransferMatrices};
pub(super) use common_delay::common_delay;
pub(super) use frequency_grid::{coarse_frequency_grid, resonances};
pub(super) use frequency_response::{largest_direction, largest_gain, modulus, unit_circle};
pub(super) use poles::{is_stable, magnitude_text};
pub(super) use residue_response::ResidueResponse;
pub(super) use sample_components::LoopSamples;

use super::eigenvalues::eigenvalues;
use crossings::SampledTransfer;
use independent_gain::independent_gain;
use loci::loci;

/// Number of largest values on the grid that are refined.
const REFINED: usize = 3;

/// Margins of a stable loop.
#[derive(Clone, Debug, PartialEq, Serialize, JsonSchema)]
pub struct StabilityMargins {
    /// Largest magnitude of a pole of the closed loop.
    pub spectral_radius: f64,
    /// Point at which the loop is cut open.
    #[serde(rename = "loop")]
    pub opened: LoopBreak,
    /// Period (s) after which the loop repeats.
    pub period_s: f64,
    /// Samples of the law in a period.
    pub samples: usize,
    /// Margins of each signal at the break, with the loops of the others closed.
    #[schemars(extend("x-key" = "signal"))]
    pub loops: Vec<SignalMargins>,
    /// Modulus margin of all signals together: the inverse of the largest gain of the sensitivity.
    pub modulus: PeakMargin,
    /// Disk margin alpha of all signals together, for any perturbation of the matrix of loop gains.
    pub disk: DiskMargin,
    /// Disk margin alpha of all signals together, each with a perturbation of its own; it is not computed for one signal, nor
    /// for several samples of the law in a period.
    pub independent_disk: Option<DiskMargin>,
    /// Largest singular values over frequency.
    #[serde(skip)]
    pub singular_values: Vec<SingularValues>,
}

/// Largest singular values of all signals together at a frequency.
#[derive(Copy, Clone, Debug, PartialEq, Serialize, JsonSchema)]
pub struct SingularValues {
    /// Frequencies (rad/s) of the singular values, up to pi over the period, which follow the resonances. With several
    /// samples of the law in a period, the motion at a frequency also has its aliases.
    pub frequency_rad_s: f64,
    /// Largest singular value of the sensitivity S = (1 + L)^-1.
    pub sensitivity: f64,
    /// Largest singular value of the complementary sensitivity T = 1 - S.
    pub complementary: f64,
}

/// Margins of one signal at the break, with the loops of the other signals closed.
#[derive(Clone, Debug, PartialEq, Serialize, JsonSchema)]
#[schemars(rename = "LoopMargins")]
pub struct SignalMargins {
    /// Name of the signal.
    pub signal: String,
    /// Crossings with their margins.
    #[serde(flatten)]
    pub crossings: Crossings,
    /// Largest factor below 1 on the loop gain at which the loop is at the limit of stability; 0 if there is none.
    pub gain_below: f64,
    /// Smallest factor above 1 on the loop gain at which the loop is at the limit of stability.
    #[schemars(extend("x-null" = "infinite"))]
    pub gain_above: Option<f64>,
    /// Smallest phase (rad), of either sign, that makes the loop unstable; pi if there is none.
    pub phase_rad: f64,
    /// Smallest delay (s) that makes the loop unstable; it is not computed for several samples of the law in a period.
    #[schemars(extend("x-null" = "infinite"))]
    pub delay_s: Option<f64>,
    /// Modulus margin: smallest distance of the loop transfer from -1.
    pub modulus: PeakMargin,
    /// Disk margin alpha: gains of (2 - alpha)/(2 + alpha) to its inverse, and phases up to 2 atan(alpha/2), at once.
    pub disk: DiskMargin,
    /// Loop transfer over frequency: its value, or its eigenvalues for several samples in a period.
    #[serde(skip)]
    pub loci: Vec<LociValues>,
    /// Loop transfer at each angle of the grid.
    #[serde(skip)]
    transfers: Vec<(f64, DMatrix<Complex<f64>>)>,
    /// Samples of the law in a period.
    #[serde(skip)]
    samples: LoopSamples,
}

/// Margin that is the inverse of a largest value over frequency.
#[derive(Copy, Clone, Debug, PartialEq, Serialize, JsonSchema)]
#[schemars(extend("x-main" = "margin"))]
pub struct PeakMargin {
    /// Margin.
    pub margin: f64,
    /// Frequency (rad/s) at which it is attained.
    pub frequency_rad_s: f64,
}

/// Symmetric disk margin: gain and phase may be off together.
#[derive(Copy, Clone, Debug, PartialEq, Serialize, JsonSchema)]
#[schemars(extend("x-main" = "alpha"))]
pub struct DiskMargin {
    /// Margin alpha, at most 2.
    pub alpha: f64,
    /// Frequency (rad/s) at which it is attained.
    pub frequency_rad_s: f64,
    /// Factors on the loop gain within which the loop is stable.
    pub gains: [f64; 2],
    /// Phase (rad) of either sign up to which the loop is stable.
    pub phase_rad: f64,
}

impl DiskMargin {
    /// Returns the disk margin alpha at a frequency (rad/s), with the gains and the phase that it allows.
    fn new(alpha: f64, frequency_rad_s: f64) -> Self {
        let least = (2.0 - alpha) / (2.0 + alpha);
        let phase_rad = 2.0 * libm::atan(0.5 * alpha);
        Self { alpha, frequency_rad_s, gains: [least, 1.0 / least], phase_rad }
    }
}

impl StabilityMargins {
    /// Computes the margins of a loop.
    ///
    /// # Errors
    /// The closed loop is not stable.
    pub fn new(opened: &OpenLoop) -> Result<Self, UnstableLoop> {
        let failed = UnstableLoop::with_unknown_poles;
        let first = opened.signals.first().map_or("", |signal| &signal.name);
        let sensitivity = opened.transfer.sensitivity().ok_or_else(|| failed(first))?;
        let closed = eigenvalues(&sensitivity.a).ok_or_else(|| failed(first))?;
        let spectral_radius = poles::require_stable(opened, &sensitivity.a, &closed)?;
        let mut others = eigenvalues(&opened.transfer.a).ok_or_else(|| failed(first))?;
        let count = opened.signals.len();
        let all: Vec<usize> = (0..opened.transfer.b.ncols()).collect();
        let mut signals = Vec::with_capacity(count);
        for (index, signal) in opened.signals.iter().enumerate() {
            let own: Vec<usize> = all.iter().copied().filter(|place| place % count == index).collect();
            let transfer = opened.transfer.with_others_closed(&own).ok_or_else(|| failed(&signal.name))?;
            // The loop with the others closed has resonances of its own.
            others.extend(eigenvalues(&transfer.a).ok_or_else(|| failed(&signal.name))?);
            signals.push((own, transfer));
        }
        let samples = LoopSamples { period: opened.period, count: opened.samples };
        let sensitivity = Sensitivity::new(&sensitivity, (&closed, &others), samples);
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
            independent_disk: (opened.samples == 1 && count > 1).then(|| sensitivity.independent_disk()),
            singular_values: sensitivity.singular_values(),
        })
    }
}

impl SignalMargins {
    fn new(signal: &str, transfer: &SampledTransfer<'_>, sensitivity: &Sensitivity, own: &[usize]) -> Self {
        let transfers: Vec<_> = sensitivity.loop_transfers(own).collect();
        let loci = loci(transfers.iter().cloned());
        let crossings = Crossings::find(transfer, &loci);
        let CommonMargins { gain_below, gain_above, phase_rad } = CommonMargins::from_crossings(&crossings);
        let delays = crossings.gain.iter().filter_map(|crossing| crossing.delay_s);
        Self {
            signal: signal.to_owned(),
            gain_below,
            gain_above,
            phase_rad,
            delay_s: delays.min_by(f64::total_cmp),
            modulus: sensitivity.modulus(own),
            disk: sensitivity.disk(own),
            samples: LoopSamples { period: transfer.period, count: transfer.samples },
            crossings,
            loci,
            transfers,
        }
    }

    /// Returns the loop transfer over the frequencies (rad/s) up to half the rate of the law.
    pub fn response(&self) -> Vec<(f64, Complex<f64>)> {
        self.samples.over_frequency(&self.transfers, &self.loci)
    }
}

/// Sensitivity of all signals over a grid of angles.
struct Sensitivity {
    response: FrequencyResponse,
    angles: Vec<f64>,
    /// Value at each angle; none at a pole.
    values: Vec<Option<DMatrix<Complex<f64>>>>,
    samples: LoopSamples,
}

impl Sensitivity {
    /// Evaluates the sensitivity on the grid of the poles of the closed loop and of others.
    fn new(
        transfer: &TransferMatrices,
        (closed, others): (&[Complex<f64>], &[Complex<f64>]),
        samples: LoopSamples,
    ) -> Self {
        let angles = frequency_grid(closed, others);
        let response = FrequencyResponse::new(transfer);
        let modal = ResidueResponse::new(&response, closed);
        let at = |angle: &f64| {
            let z = unit_circle(*angle);
            modal.as_ref().map_or_else(|| response.scan(z), |modal| modal.at(z))
        };
        let values = angles.iter().map(at).collect();
        Self { response, angles, values, samples }
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
        DiskMargin::new(alpha, frequency_rad_s)
    }

    /// Returns the disk margin of all signals, each with a perturbation of its own: the inverse of the largest structured
    /// singular value of S - 1/2.
    fn independent_disk(&self) -> DiskMargin {
        let shifted = |value: &DMatrix<Complex<f64>>| {
            value - DMatrix::from_diagonal_element(value.nrows(), value.ncols(), Complex::new(0.5, 0.0))
        };
        let bound = |value: &Option<DMatrix<Complex<f64>>>| {
            value.as_ref().map_or(0.0, |value| largest_gain(&shifted(value)))
        };
        let bounds: Vec<f64> = self.values.iter().map(bound).collect();
        let mut order: Vec<usize> = (0..bounds.len()).collect();
        order.sort_by(|a, b| bounds[*b].total_cmp(&bounds[*a]));
        let (mut place, mut largest) = (0, 0.0);
        // A structured value is at most the largest singular value: what is below the largest one needs none.
        for k in order.into_iter().take_while(|k| bounds[*k] > 0.0) {
            if bounds[k] <= largest {
                break;
            }
            let Some(value) = &self.values[k] else { continue };
            let gain = independent_gain(&shifted(value), largest);
            if gain > largest {
                (place, largest) = (k, gain);
            }
        }
        let (low, high) = (place.saturating_sub(1), (place + 1).min(self.angles.len() - 1));
        let at = |angle: f64| {
            let value = self.response.at(unit_circle(angle));
            value.map_or(0.0, |value| independent_gain(&shifted(&value), 0.0))
        };
        let refined = maximum(at, self.angles[low], self.angles[high]);
        let (angle, gain) = if refined.1 > largest { refined } else { (self.angles[place], largest) };
        DiskMargin::new(1.0 / gain, angle / self.samples.period)
    }

    /// Returns the largest singular values of S and of T = 1 - S over frequency.
    fn singular_values(&self) -> Vec<SingularValues> {
        let at = |(angle, value): (&f64, &Option<DMatrix<Complex<f64>>>)| {
            let value = value.as_ref()?;
            Some(SingularValues {
                frequency_rad_s: angle / self.samples.period,
                sensitivity: largest_gain(value),
                complementary: largest_gain(&(DMatrix::identity(value.nrows(), value.ncols()) - value)),
            })
        };
        self.angles.iter().zip(&self.values).filter_map(at).collect()
    }

    /// Returns the inverse of the largest s1(S - shift) over frequency, of some signals.
    fn peak(&self, signals: &[usize], shift: f64) -> PeakMargin {
        let own = |value: &DMatrix<Complex<f64>>| {
            DMatrix::from_fn(signals.len(), signals.len(), |row, column| {
                value[(signals[row], signals[column])] - if row == column { shift } else { 0.0 }
            })
        };
        let gain = |value: &DMatrix<Complex<f64>>| largest_gain(&own(value));
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
        let value = self.response.at(unit_circle(largest.0));
        let direction = value.map(|value| largest_direction(&own(&value)));
        let motion = direction.as_ref().map_or(&[][..], |direction| direction.as_slice());
        PeakMargin { margin: 1.0 / largest.1, frequency_rad_s: self.samples.frequency(largest.0, motion).0 }
    }
}
