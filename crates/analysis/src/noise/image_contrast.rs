//! Modulation transfer function (MTF) of the motion of an image: the contrast that it leaves of a sine across the detector.
//!
//! An image moves by sines whose phases are unrelated and by Gaussian noise. Registered by its own mean over an exposure T, a
//! sine of the frequency w has at the time t from the middle of the exposure the amplitude A rho, rho² = 1 - 2 q cos w t + q²
//! with q = j0(w T/2), and the noise its variance V(t) about that mean. The contrast at the spatial frequency n is the mean
//! over the exposure of exp(-2 pi² n² V) times the product of J0(2 pi n A rho), which may be negative: light and dark then
//! change places. Without an exposure rho is 1, and V the variance of the output.

use std::f64::consts::PI;

use schemars::JsonSchema;
use serde::Serialize;

use super::exposed_motion::{ExposedMotion, about_mean_square, instants};
use super::noisy_loop::NoisyLoop;
use super::spectral_line::SpectralLine;
use super::vibration::Vibration;
use super::windows::j0;

/// Blur of an image over the time of an exposure.
#[derive(Clone, Debug, PartialEq)]
pub struct ImageBlur {
    /// Length of the exposure (s); `None` for one without end.
    exposure: Option<f64>,
    /// Times in the exposure.
    instants: Vec<BlurInstant>,
    /// Lines that always move the image, of each machine.
    lines: Vec<Vec<SpectralLine>>,
}

/// Variances of Gaussian motion at one time of an exposure.
#[derive(Clone, Debug, PartialEq)]
struct BlurInstant {
    /// Time from the middle (s).
    time: f64,
    /// Part of the exposure.
    part: f64,
    /// Variance about the mean (rad²) from each Gaussian source.
    variances: Vec<f64>,
}

impl ImageBlur {
    /// Returns the blur by an output of a loop and by machines during exposures (s) that begin at samples of the law, for other lines up
    /// to a frequency (rad/s). Its sources are those of the loop, and then those of the machines.
    ///
    /// # Errors
    /// See [`NoisyLoop::window_variances`].
    pub fn new(
        noisy: &NoisyLoop,
        vibration: &Vibration,
        output: usize,
        (exposure, fastest): (Option<f64>, f64),
    ) -> Result<Self, String> {
        let gaussian = ExposedMotion::new(noisy, vibration, output, exposure)?;
        let lines: Vec<Vec<SpectralLine>> =
            vibration.sources_of(output, false).map(|own| own.lines.clone()).collect();
        let of_lines = lines.iter().flatten().map(|line| line.frequency_rad_s);
        let fastest = of_lines.fold(fastest.max(gaussian.fastest()), f64::max);
        let instant =
            |(time, part): (f64, f64)| BlurInstant { time, part, variances: gaussian.variances(time) };
        let instants = instants(exposure, fastest).into_iter().map(instant).collect();
        Ok(Self { exposure, instants, lines })
    }

    /// Returns the blur by lines alone during exposures (s), or during one without end.
    pub fn by_lines(exposure: Option<f64>, lines: Vec<SpectralLine>) -> Self {
        let fastest = lines.iter().map(|line| line.frequency_rad_s).fold(0.0, f64::max);
        Self { lines: vec![lines], ..Self::by_variance(exposure, fastest, |_| 0.0) }
    }

    /// Returns the blur of an exposure (s) by a variance (rad²) over the time from its middle, and by motion up to a frequency (rad/s).
    pub fn by_variance(exposure: Option<f64>, fastest: f64, variance: impl Fn(f64) -> f64) -> Self {
        let instant = |(time, part): (f64, f64)| BlurInstant { time, part, variances: vec![variance(time)] };
        let instants = instants(exposure, fastest).into_iter().map(instant).collect();
        Self { exposure, instants, lines: Vec::new() }
    }

    /// Returns the contrast at a spatial frequency (cycles/rad) of an image that also moves by lines (rad).
    pub fn contrast(&self, frequency: f64, lines: &[SpectralLine]) -> f64 {
        self.contrast_of(frequency, lines, &|_| true)
    }

    /// Returns the contrast at a spatial frequency (cycles/rad) of an image that also moves by lines (rad), by those of the own sources
    /// that count.
    pub fn contrast_of(&self, frequency: f64, lines: &[SpectralLine], counts: &dyn Fn(usize) -> bool) -> f64 {
        let turn = 2.0 * PI * frequency;
        let gaussian = self.instants.first().map_or(0, |instant| instant.variances.len());
        let own: Vec<&SpectralLine> = self
            .lines
            .iter()
            .enumerate()
            .filter(|(machine, _)| counts(gaussian + machine))
            .flat_map(|(_, lines)| lines)
            .chain(lines)
            .collect();
        let contrast_at = |instant: &BlurInstant| {
            let of_line = |line: &&SpectralLine| {
                let square =
                    self.exposure.map_or(1.0, |length| about_mean_square(line, length, instant.time));
                libm::j0(turn * line.amplitude * square.max(0.0).sqrt())
            };
            let variances = instant.variances.iter().enumerate();
            let variance: f64 = variances.filter(|(source, _)| counts(*source)).map(|(_, own)| own).sum();
            let noise = libm::exp(-0.5 * turn * turn * variance);
            instant.part * noise * own.iter().map(of_line).product::<f64>()
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

#[cfg(test)]
mod tests {
    use flexsc_numerics::quadrature::nodes;

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
        close(
            ImageBlur::by_variance(None, 0.0, |_| 0.0).contrast(FREQUENCY, &lines),
            0.642_511_836_577_573,
            1e-15,
        );
        let blur = ImageBlur::by_lines(Some(EXPOSURE), lines.to_vec());
        close(blur.contrast(FREQUENCY, &[]), 0.951_749_337_277_069_1, 1e-14);
        // Beyond the first zero of J0 light and dark change places.
        let far = SpectralLine { amplitude: 3.0 / (2.0 * PI * FREQUENCY), ..lines[0] };
        close(
            ImageBlur::by_variance(None, 0.0, |_| 0.0).contrast(FREQUENCY, &[far]),
            -0.260_051_954_901_933_4,
            1e-14,
        );
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
        let blur = ImageBlur::by_variance(Some(EXPOSURE), 2.0 * PI * 50.0, mode);
        close(blur.contrast(FREQUENCY, &[]), 0.986_367_500_048_431_3, 1e-14);
        // Not the product of both alone, 0.95943337.
        close(blur.contrast(FREQUENCY, &[line(37.0)]), 0.959_708_713_158_169_7, 1e-14);
        let long = ImageBlur::by_variance(None, 0.0, |_| 0.09e-12);
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
