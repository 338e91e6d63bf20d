//! Modulation transfer function (MTF) of the motion of an image: the contrast that it leaves of a sine across the detector.
//!
//! An image moves by sines whose phases are unrelated and by Gaussian noise. Registered by its own mean over an exposure T, a
//! sine of the frequency w has at the time t from the middle of the exposure the amplitude A rho, rho² = 1 - 2 q cos w t + q²
//! with q = j0(w T/2), and the noise its variance V(t) about that mean. The contrast at the spatial frequency n is the mean
//! over the exposure of exp(-2 pi² n² V) times the product of J0(2 pi n A rho), which may be negative: light and dark then
//! change places. Without an exposure rho is 1, and V the variance of the output.

use std::f64::consts::PI;

use flexsc_numerics::quadrature::nodes;
use schemars::JsonSchema;
use serde::Serialize;

use super::noisy_loop::NoisyLoop;
use super::spectral_line::SpectralLine;
use super::windows::{Functional, j0};

/// Harmonics of the fastest motion that the contrast over an exposure contains.
const HARMONICS: f64 = 4.0;
/// Most radians of the fastest harmonic in an exposure: faster motion has hardly any mean, and its amplitude is even.
const MOST_TURN: f64 = 600.0;
/// Part of the power of broadband motion that may be above the fastest motion.
const VANISHING: f64 = 1e-6;

/// Blur of an image by Gaussian noise over the time of an exposure.
#[derive(Clone, Debug, PartialEq)]
pub struct ImageBlur {
    /// Length of the exposure (s); `None` for one without end.
    exposure: Option<f64>,
    /// Times from the middle of the exposure (s), their parts of it, and variances about the mean (rad²).
    instants: Vec<BlurInstant>,
    /// Lines that always move the image.
    lines: Vec<SpectralLine>,
}

/// Variance of the noise at one time of an exposure.
#[derive(Copy, Clone, Debug, PartialEq)]
struct BlurInstant {
    time: f64,
    part: f64,
    variance: f64,
}

impl ImageBlur {
    /// Returns the blur by an output of a loop during exposures that begin at samples of the law, and by Gaussian motion that is given
    /// as lines, for other lines up to a frequency (rad/s).
    ///
    /// # Errors
    /// See [`NoisyLoop::window_variances`].
    pub fn new(
        noisy: &NoisyLoop,
        output: usize,
        (exposure, fastest): (Option<f64>, f64),
        gaussian: &[SpectralLine],
    ) -> Result<Self, String> {
        let Some(length) = exposure else {
            let bands: f64 = gaussian.iter().map(SpectralLine::mean_square).sum();
            return Ok(Self::long(noisy.mean_variances(&[output])[0].iter().sum::<f64>() + bands));
        };
        noisy.check_time("window", length)?;
        let fastest = noisy.frequencies.iter().copied().fold(fastest, f64::max).max(upper_edge(gaussian));
        let moments = noisy.moments(output, [0.0, noisy.period]);
        let variance = |time: f64| {
            let about_mean = Functional::mean(0.0, length, -1.0).with_point(time + 0.5 * length);
            let bands =
                gaussian.iter().map(|line| line.mean_square() * about_mean_square(line, length, time));
            noisy.functional_variances(output, &about_mean, &moments).iter().sum::<f64>() + bands.sum::<f64>()
        };
        Ok(Self::over_exposure(length, fastest, variance))
    }

    /// Returns the blur of an exposure without end by a variance (rad²).
    pub fn long(variance: f64) -> Self {
        Self {
            exposure: None,
            instants: vec![BlurInstant { time: 0.0, part: 1.0, variance }],
            lines: Vec::new(),
        }
    }

    /// Returns the blur of an exposure (s) by a variance (rad²) over the time from its middle, and by motion up to a frequency
    /// (rad/s).
    fn over_exposure(length: f64, fastest: f64, variance: impl Fn(f64) -> f64) -> Self {
        let rate = (HARMONICS * fastest).min(MOST_TURN / length);
        let instant = |(from_start, weight): (f64, f64)| {
            let time = from_start - 0.5 * length;
            BlurInstant { time, part: weight / length, variance: variance(time) }
        };
        let instants = nodes(length, rate).into_iter().map(instant).collect();
        Self { exposure: Some(length), instants, lines: Vec::new() }
    }

    /// Returns the blur with lines that always move the image.
    #[must_use]
    pub fn with_lines(self, lines: Vec<SpectralLine>) -> Self {
        Self { lines, ..self }
    }

    /// Returns the contrast at a spatial frequency (cycles/rad) of an image that also moves by lines (rad).
    pub fn contrast(&self, frequency: f64, lines: &[SpectralLine]) -> f64 {
        let turn = 2.0 * PI * frequency;
        let contrast_at = |instant: &BlurInstant| {
            let of_line = |line: &SpectralLine| {
                let square =
                    self.exposure.map_or(1.0, |length| about_mean_square(line, length, instant.time));
                libm::j0(turn * line.amplitude * square.max(0.0).sqrt())
            };
            let noise = libm::exp(-0.5 * turn * turn * instant.variance);
            instant.part * noise * self.lines.iter().chain(lines).map(of_line).product::<f64>()
        };
        self.instants.iter().map(contrast_at).sum()
    }
}

/// Factors of an image's contrast at the Nyquist frequency of its pixels besides that of the motion in `mtf`.
#[derive(Copy, Clone, Debug, PartialEq, Serialize, JsonSchema)]
#[schemars(extend("x-dict" = true))]
pub struct ImageFactors {
    /// Spatial frequency (cycles/rad).
    pub spatial_frequency: f64,
    /// Contrast of the mean over a pixel.
    pub detector: f64,
    /// Contrast of a circular aperture without a central obscuration, if its diffraction is given.
    pub diffraction: Option<f64>,
    /// Contrast under a steady rate over the exposure, if one is given: negative where light and dark have changed places.
    pub smear: Option<f64>,
    /// Product of these.
    pub product: f64,
}

impl ImageFactors {
    /// Returns the factors of pixels of an angle (rad), of an aperture with this wavelength over its diameter (rad), and of an angle by
    /// which the image moves during an exposure (rad).
    pub fn new(pixel: f64, diffraction: Option<f64>, smear: Option<f64>) -> Self {
        let spatial_frequency = 0.5 / pixel;
        let mean_over = |angle: f64| j0(PI * spatial_frequency * angle);
        let aperture = |angle: f64| {
            let x = spatial_frequency * angle;
            if x < 1.0 { 2.0 / PI * (libm::acos(x) - x * f64::sqrt(1.0 - x * x)) } else { 0.0 }
        };
        let (detector, diffraction, smear) =
            (mean_over(pixel), diffraction.map(aperture), smear.map(mean_over));
        let product = detector * diffraction.unwrap_or(1.0) * smear.unwrap_or(1.0);
        Self { spatial_frequency, detector, diffraction, smear, product }
    }
}

/// Returns the square by which the amplitude of a sine about its mean over an exposure (s) exceeds its own, at a time from the middle.
fn about_mean_square(line: &SpectralLine, length: f64, time: f64) -> f64 {
    let mean = j0(0.5 * line.frequency_rad_s * length);
    1.0 - 2.0 * mean * libm::cos(line.frequency_rad_s * time) + mean * mean
}

/// Returns the frequency (rad/s) up to which lines have all but a vanishing part of their power.
fn upper_edge(lines: &[SpectralLine]) -> f64 {
    let mut left: f64 = VANISHING * lines.iter().map(SpectralLine::mean_square).sum::<f64>();
    let mut sorted: Vec<&SpectralLine> = lines.iter().collect();
    sorted.sort_by(|a, b| b.frequency_rad_s.total_cmp(&a.frequency_rad_s));
    let edge = sorted.into_iter().find(|line| {
        left -= line.mean_square();
        left < 0.0
    });
    edge.map_or(0.0, |line| line.frequency_rad_s)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Exposure (s) and spatial frequency (cycles/rad) of all numbers.
    const EXPOSURE: f64 = 0.004;
    const FREQUENCY: f64 = 2.5e5;

    fn line(hertz: f64) -> SpectralLine {
        SpectralLine { frequency_rad_s: 2.0 * PI * hertz, amplitude: 0.8e-6 }
    }

    fn close(found: f64, exact: f64, most: f64) {
        assert!((found - exact).abs() < most, "{found} {exact}");
    }

    /// Against quadratures over 48 phases of the sine, to 22 digits.
    #[test]
    fn a_line_loses_contrast_by_bessel_functions() {
        let lines = [line(50.0)];
        close(ImageBlur::long(0.0).contrast(FREQUENCY, &lines), 0.642_511_836_577_573, 1e-15);
        let blur = ImageBlur::over_exposure(EXPOSURE, lines[0].frequency_rad_s, |_| 0.0);
        close(blur.contrast(FREQUENCY, &lines), 0.951_749_337_277_069_1, 1e-14);
        // Beyond the first zero of J0 light and dark change places.
        let far = SpectralLine { amplitude: 3.0 / (2.0 * PI * FREQUENCY), ..lines[0] };
        close(ImageBlur::long(0.0).contrast(FREQUENCY, &[far]), -0.260_051_954_901_933_4, 1e-14);
    }

    /// Variance of a mode of 50 Hz and 1 % under white noise about its mean over the exposure, by its covariance.
    fn mode(time: f64) -> f64 {
        let (w, z, sigma) = (2.0 * PI * 50.0, 0.01, 0.3e-6);
        let damped = w * f64::sqrt(1.0 - z * z);
        let covariance = |lag: f64| {
            let lag = lag.abs();
            let phase = damped * lag;
            sigma * sigma * libm::exp(-z * w * lag) * (libm::cos(phase) + z * w / damped * libm::sin(phase))
        };
        let mean = |from: f64, to: f64, of: &dyn Fn(f64) -> f64| {
            let all = nodes(to - from, 4.0 * w).into_iter();
            all.map(|(t, weight)| weight / (to - from) * of(from + t)).sum::<f64>()
        };
        let half = 0.5 * EXPOSURE;
        // The covariance has a kink at 0: both sides apart.
        let beside = |at: f64| {
            let part = |from: f64, to: f64| {
                if to > from { (to - from) * mean(from, to, &|s| covariance(at - s)) } else { 0.0 }
            };
            (part(-half, at) + part(at, half)) / EXPOSURE
        };
        covariance(0.0) - 2.0 * beside(time) + mean(-half, half, &beside)
    }

    /// Against quadratures of mpmath to 30 digits, and 200 000 paths (0.986368 to 4e-5; with a line 0.95985 to 1e-4).
    #[test]
    fn noise_loses_contrast_by_its_variance_over_the_exposure() {
        close(mode(0.0), 3.933_708_076_601_503e-16, 1e-27);
        close(mode(0.5 * EXPOSURE), 3.232_248_891_272_251e-14, 1e-27);
        let blur = ImageBlur::over_exposure(EXPOSURE, 2.0 * PI * 50.0, mode);
        close(blur.contrast(FREQUENCY, &[]), 0.986_367_500_048_431_3, 1e-14);
        // Not the product of both alone, 0.95943337.
        close(blur.contrast(FREQUENCY, &[line(37.0)]), 0.959_708_713_158_169_7, 1e-14);
        let long = ImageBlur::long(0.09e-12);
        close(long.contrast(FREQUENCY, &[line(37.0)]), 0.574_989_735_754_48, 1e-13);
    }

    /// Numbers by mpmath: sinc(1/2), the overlap of two circles half a diameter apart, and sinc(1.5), which is negative.
    #[test]
    fn detector_aperture_and_smear_have_factors() {
        let factors = ImageFactors::new(2e-6, Some(2e-6), Some(6e-6));
        assert_eq!(factors.spatial_frequency, FREQUENCY);
        close(factors.detector, 0.636_619_772_367_581_3, 1e-14);
        close(factors.diffraction.expect("given"), 0.391_002_218_955_771_8, 1e-14);
        close(factors.smear.expect("given"), -0.212_206_590_789_193_8, 1e-14);
        close(factors.product, -0.052_822_410_175_172_27, 1e-14);
        assert_eq!(ImageFactors::new(1e-6, Some(3e-6), None).product, 0.0);
    }
}
