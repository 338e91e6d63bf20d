//! Gaussian motion of an output about its mean over an exposure: noise of the loop and broadband loads.

use flexsc_numerics::quadrature::nodes;

use super::noisy_loop::NoisyLoop;
use super::spectral_line::SpectralLine;
use super::vibration::Vibration;
use super::windows::{Functional, OutputMoments, j0};

/// Harmonics of the fastest motion that what is averaged over an exposure contains.
const HARMONICS: f64 = 4.0;
/// Most radians of the fastest harmonic in an exposure: faster motion has hardly any mean, and its amplitude is even.
const MOST_TURN: f64 = 600.0;
/// Part of the power of broadband motion that may be above the fastest motion.
const VANISHING: f64 = 1e-6;
/// Part of the power of broadband motion that is left out.
const ROUNDING: f64 = 1e-14;

/// Gaussian motion of an output during exposures that begin at samples of the law, or during one without end.
pub(super) struct ExposedMotion<'a> {
    noisy: &'a NoisyLoop,
    output: usize,
    /// Length of the exposures (s), and what the variances about the mean need.
    exposure: Option<(f64, OutputMoments)>,
    /// Motion by each broadband source.
    bands: Vec<BandMotion>,
    /// Frequency (rad/s) up to which they move it.
    edge: f64,
}

/// Motion by a broadband source about its mean over the exposures.
struct BandMotion {
    /// Variance but for its change during an exposure.
    even: f64,
    /// Parts of the variance that change: amplitude and frequency (rad/s).
    waves: Vec<[f64; 2]>,
}

impl BandMotion {
    /// Creates the motion of lines during exposures (s), or during one without end.
    fn new(lines: &[SpectralLine], exposure: Option<f64>) -> Self {
        let total: f64 = lines.iter().map(SpectralLine::mean_square).sum();
        let Some(length) = exposure else { return Self { even: total, waves: Vec::new() } };
        let mut found = Self { even: 0.0, waves: Vec::with_capacity(lines.len()) };
        for line in lines {
            let mean = line_mean(line, length);
            found.even += line.mean_square() * (1.0 + mean * mean);
            found.waves.push([-2.0 * line.mean_square() * mean, line.frequency_rad_s]);
        }
        // Aliases are many, and most have no part in it.
        found.waves.sort_by(|a, b| b[0].abs().total_cmp(&a[0].abs()));
        let mut left = 0.0;
        while let Some([amplitude, _]) = found.waves.last() {
            left += amplitude.abs();
            if left > ROUNDING * total {
                break;
            }
            found.waves.pop();
        }
        found
    }

    /// Returns the variance at a time from the middle of the exposure (s).
    fn variance(&self, time: f64) -> f64 {
        let wave = |[amplitude, frequency]: &[f64; 2]| amplitude * libm::cos(frequency * time);
        self.even + self.waves.iter().map(wave).sum::<f64>()
    }
}

impl<'a> ExposedMotion<'a> {
    /// Creates the motion of an output of a loop under its noise and broadband loads.
    ///
    /// # Errors
    /// An exposure that is not positive, or longer than a million periods of the loop.
    pub fn new(
        noisy: &'a NoisyLoop,
        vibration: &'a Vibration,
        output: usize,
        exposure: Option<f64>,
    ) -> Result<Self, String> {
        exposure.map_or(Ok(()), |length| noisy.check_time("window", length))?;
        let moments = |length| (length, noisy.moments(output, [0.0, noisy.period]));
        let sources = || vibration.sources_of(output, true);
        Ok(Self {
            noisy,
            output,
            exposure: exposure.map(moments),
            bands: sources().map(|own| BandMotion::new(&own.lines, exposure)).collect(),
            edge: upper_edge(sources().flat_map(|own| &own.lines)),
        })
    }

    /// Returns the frequency (rad/s) up to which the motion has all but a vanishing part of its power.
    pub fn fastest(&self) -> f64 {
        self.noisy.frequencies.iter().copied().fold(self.edge, f64::max)
    }

    /// Returns the variance about the mean from each source, those of the loop first, at a time from the middle of the exposure (s).
    pub fn variances(&self, time: f64) -> Vec<f64> {
        let mut found = match &self.exposure {
            None => self.noisy.mean_variances(&[self.output]).remove(0),
            Some((length, moments)) => {
                let about_mean = Functional::mean(0.0, *length, -1.0).with_point(time + 0.5 * length);
                self.noisy.functional_variances(self.output, &about_mean, moments)
            }
        };
        found.extend(self.bands.iter().map(|band| band.variance(time)));
        found
    }
}

/// Returns times from the middle of an exposure (s) with their parts of it, for means of what moves up to a frequency (rad/s); one time of
/// an exposure without end.
pub(super) fn instants(exposure: Option<f64>, fastest: f64) -> Vec<(f64, f64)> {
    let Some(length) = exposure else { return vec![(0.0, 1.0)] };
    let rate = (HARMONICS * fastest).min(MOST_TURN / length);
    let instant = |(from_start, weight): (f64, f64)| (from_start - 0.5 * length, weight / length);
    nodes(length, rate).into_iter().map(instant).collect()
}

/// Returns the square by which the amplitude of a sine about its mean over an exposure (s) exceeds its own, at a time from the middle.
pub(super) fn about_mean_square(line: &SpectralLine, length: f64, time: f64) -> f64 {
    let mean = line_mean(line, length);
    1.0 - 2.0 * mean * libm::cos(line.frequency_rad_s * time) + mean * mean
}

/// Returns the mean of a sine over an exposure (s), as a part of its amplitude, at its greatest.
fn line_mean(line: &SpectralLine, length: f64) -> f64 {
    j0(0.5 * line.frequency_rad_s * length)
}

/// Returns the frequency (rad/s) up to which lines have all but a vanishing part of their power.
fn upper_edge<'a>(lines: impl Iterator<Item = &'a SpectralLine>) -> f64 {
    let mut sorted: Vec<&SpectralLine> = lines.collect();
    let mut left: f64 = VANISHING * sorted.iter().map(|line| line.mean_square()).sum::<f64>();
    sorted.sort_by(|a, b| b.frequency_rad_s.total_cmp(&a.frequency_rad_s));
    let edge = sorted.into_iter().find(|line| {
        left -= line.mean_square();
        left < 0.0
    });
    edge.map_or(0.0, |line| line.frequency_rad_s)
}
