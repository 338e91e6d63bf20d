//! Lines of outputs, and the loads that make them.

use nalgebra::{Complex, DVector};
use serde::Serialize;

/// Frequency of a line (rad/s, with a sign) and its complex amplitude.
pub type ComplexLine = (f64, Complex<f64>);

/// Load on the states of the body, cosine cos w t + sine sin w t, as columns of their rate of change.
#[derive(Clone, Debug, PartialEq)]
pub struct SineLoad {
    /// Column of the cosine.
    pub cosine: DVector<f64>,
    /// Column of the sine.
    pub sine: DVector<f64>,
}

/// Sine of an output.
#[derive(Copy, Clone, Debug, Default, PartialEq, Serialize)]
pub struct SpectralLine {
    /// Frequency (rad/s).
    pub frequency_rad_s: f64,
    /// Amplitude, in the unit of the output.
    pub amplitude: f64,
}

impl SpectralLine {
    /// Returns the mean square.
    pub fn mean_square(&self) -> f64 {
        0.5 * self.amplitude * self.amplitude
    }
}

/// Lines of an output under a load.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct OutputLines {
    /// Line at the frequency of the load.
    pub direct: SpectralLine,
    /// Lines below the Nyquist frequency of the law that sampling makes of it, the largest first.
    pub aliases: Vec<SpectralLine>,
}

impl OutputLines {
    /// Returns all lines.
    pub fn all(&self) -> impl Iterator<Item = &SpectralLine> {
        self.aliases.iter().chain([&self.direct])
    }

    /// Returns the mean square of all lines.
    pub fn mean_square(&self) -> f64 {
        self.all().map(SpectralLine::mean_square).sum()
    }
}
