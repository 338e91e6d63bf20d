//! Motion of an output of a loop under one machine, as lines.

use super::spectral_line::SpectralLine;

/// Measure of the lines of an output, by its index, that is largest at the worst frequency of a machine.
pub type Measure<'a> = &'a (dyn Fn(usize, &[SpectralLine]) -> f64 + Sync);

/// Motion of an output under one source.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SourceMotion {
    /// Lines, whose mean squares add up to the variance over time.
    pub lines: Vec<SpectralLine>,
    /// Variance at the samples of the law.
    pub sample_variance: f64,
    /// One-sided density of a broadband source (unit² per Hz) at the frequencies, without what sampling makes of it; none of a machine
    /// with lines.
    pub density: Option<Vec<f64>>,
    /// Worst frequency of a machine with lines.
    pub worst: Option<WorstTone>,
}

/// Worst frequency of a machine for an output.
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct WorstTone {
    /// Frequency of the machine (rad/s).
    pub frequency: f64,
    /// Largest deviation of the output over time, without what sampling makes of the lines.
    pub peak: f64,
}

impl SourceMotion {
    /// Returns the variance over time.
    pub fn variance(&self) -> f64 {
        self.lines.iter().map(SpectralLine::mean_square).sum()
    }
}
