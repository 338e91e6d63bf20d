//! Lines of outputs, and the loads that make them.

use nalgebra::{Complex, DVector};
use serde::Serialize;

use crate::margins::frequency_response::modulus;

/// Frequency of a line (rad/s, with a sign) and its complex amplitude.
pub type ComplexLine = (f64, Complex<f64>);

/// Load on the states of the body, as the complex amplitude of their rate of change: its real part is that of the cosine, its
/// imaginary part less that of the sine.
pub type LoadColumn = DVector<Complex<f64>>;

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
    /// Returns lines, the last of which is that of the load, multiplied by a number.
    pub fn new(lines: Vec<ComplexLine>, by: f64) -> Self {
        let line = |(frequency, value): (f64, Complex<f64>)| SpectralLine {
            frequency_rad_s: frequency.abs(),
            amplitude: by * modulus(value),
        };
        let mut aliases: Vec<SpectralLine> = lines.into_iter().map(line).collect();
        let direct = aliases.pop().unwrap_or_default();
        aliases.sort_by(|a, b| b.amplitude.total_cmp(&a.amplitude));
        Self { direct, aliases }
    }

    /// Returns all lines.
    pub fn all(&self) -> impl Iterator<Item = &SpectralLine> {
        self.aliases.iter().chain([&self.direct])
    }

    /// Returns the mean square of all lines.
    pub fn mean_square(&self) -> f64 {
        self.all().map(SpectralLine::mean_square).sum()
    }
}
