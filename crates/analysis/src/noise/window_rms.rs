//! Pointing indices over windows as rms: of the noise of a loop, and of lines.

use schemars::JsonSchema;
use serde::Serialize;

use super::noisy_loop::NoisyLoop;
use super::spectral_line::SpectralLine;
use super::windows::{Window, WindowVariances, WindowWeights};

/// Rms of an output over windows, in the unit of the output: of noise over those that begin at a sample of the law, of the
/// lines of wheels over those that begin at any time.
#[derive(Copy, Clone, Debug, PartialEq, Serialize, JsonSchema)]
#[schemars(extend("x-dict" = true))]
pub struct WindowRms {
    /// Length of the window (s).
    pub window_s: f64,
    /// Time from the start of a window to that of the next (s).
    pub separation_s: Option<f64>,
    /// Mean over the window: mean performance error, displacement of an exposure.
    pub mpe: f64,
    /// Output less the mean, at any time of the window: relative performance error, jitter of an exposure with its smear.
    pub rpe_uniform: f64,
    /// Output less the mean, at the end of the window.
    pub rpe_end: f64,
    /// Output less the mean, in the middle of the window.
    pub rpe_middle: f64,
    /// Straight line through the output, about its mean: smear of an exposure.
    pub smear: f64,
    /// Rest beyond mean and straight line.
    pub beyond_smear: f64,
    /// Difference of the means over two windows: performance drift or reproducibility error; none without a separation.
    pub pde: Option<f64>,
}

/// Returns the mean square of lines, or with a window that of their relative performance error within it.
pub fn square_within(lines: &[SpectralLine], window: Option<Window>) -> f64 {
    match window {
        Some(window) => {
            let rms = WindowRms::from_lines(lines.iter().copied(), window).rpe_uniform;
            rms * rms
        }
        None => lines.iter().map(SpectralLine::mean_square).sum(),
    }
}

impl WindowRms {
    /// Returns the rms over windows of sines whose phases are unrelated.
    pub fn from_lines(lines: impl Iterator<Item = SpectralLine>, window: Window) -> Self {
        let mut sum = WindowVariances::default();
        for SpectralLine { frequency_rad_s, amplitude } in lines {
            let square = 0.5 * amplitude * amplitude;
            let weights = WindowWeights::new(frequency_rad_s, window);
            sum.total += square;
            sum.mpe += square * weights.mpe;
            sum.rpe_uniform += square * weights.rpe_uniform;
            sum.rpe_end += square * weights.rpe_end;
            sum.rpe_middle += square * weights.rpe_middle;
            sum.smear += square * weights.smear;
            sum.pde += square * weights.pde;
        }
        Self::from_variances(&[sum], window)
    }

    /// Returns the rms of an output over windows, from all sources together.
    ///
    /// # Errors
    /// See [`NoisyLoop::window_variances`].
    pub fn new(noisy: &NoisyLoop, output: usize, window: Window) -> Result<Self, String> {
        Ok(Self::from_variances(&noisy.window_variances(output, window)?, window))
    }

    /// Returns the rms of this motion and independent lines together.
    #[must_use]
    pub fn with_lines(self, lines: impl Iterator<Item = SpectralLine>) -> Self {
        let other = Self::from_lines(lines, Window { length: self.window_s, separation: self.separation_s });
        Self {
            mpe: libm::hypot(self.mpe, other.mpe),
            rpe_uniform: libm::hypot(self.rpe_uniform, other.rpe_uniform),
            rpe_end: libm::hypot(self.rpe_end, other.rpe_end),
            rpe_middle: libm::hypot(self.rpe_middle, other.rpe_middle),
            smear: libm::hypot(self.smear, other.smear),
            beyond_smear: libm::hypot(self.beyond_smear, other.beyond_smear),
            pde: self.pde.zip(other.pde).map(|(one, other)| libm::hypot(one, other)),
            ..self
        }
    }

    /// Returns the rms over windows of several sources together.
    fn from_variances(each: &[WindowVariances], window: Window) -> Self {
        let rms = |value: fn(&WindowVariances) -> f64| f64::sqrt(each.iter().map(value).sum());
        Self {
            window_s: window.length,
            separation_s: window.separation,
            mpe: rms(|index| index.mpe),
            rpe_uniform: rms(|index| index.rpe_uniform),
            rpe_end: rms(|index| index.rpe_end),
            rpe_middle: rms(|index| index.rpe_middle),
            smear: rms(|index| index.smear),
            beyond_smear: rms(WindowVariances::beyond_smear),
            pde: window.separation.map(|_| rms(|index| index.pde)),
        }
    }
}
