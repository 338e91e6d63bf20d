//! Filters of a law's output: settings in a scenario, and the digital filters at the law's period.

use flexsc_formats::document::ConfigError;
use flexsc_numerics::biquad::Biquad;
use flexsc_numerics::quantity::{Finite, NonNegative, Positive};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::Tunable;

/// The kinds of filter.
#[derive(Copy, Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Filter {
    /// (s² + 2 depth zeta w s + w²)/(s² + 2 zeta w s + w²).
    Notch(Notch),
    /// w²/(s² + 2 zeta w s + w²).
    LowPass(LowPass),
    /// (1 + s/zero)/(1 + s/pole): a lead with the zero below the pole, else a lag, exact at sqrt(zero pole), where
    /// its phase is largest.
    Lead(Lead),
    /// (b0 + b1/z + b2/z²)/(1 + a1/z + a2/z²), with the coefficients as given.
    Biquad(Coefficients),
}

/// A notch: its gain is small at one frequency, and 1 far from it.
#[derive(Copy, Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Notch {
    /// The frequency w (rad/s).
    pub frequency: Positive,
    /// Gain at that frequency, below 1.
    pub depth: NonNegative,
    /// Damping ratio zeta of the denominator; a larger one makes the notch wider.
    #[serde(default = "wide")]
    pub damping: Positive,
}

/// A low-pass filter of second order.
#[derive(Copy, Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct LowPass {
    /// The frequency w (rad/s).
    pub frequency: Positive,
    /// The damping ratio zeta.
    #[serde(default = "butterworth")]
    pub damping: Positive,
}

/// A zero and a pole.
#[derive(Copy, Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Lead {
    /// The zero (rad/s).
    pub zero: Positive,
    /// The pole (rad/s).
    pub pole: Positive,
}

/// The coefficients of a digital filter at the law's period.
#[derive(Copy, Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Coefficients {
    /// b0, b1, b2.
    pub b: [Finite; 3],
    /// a1, a2.
    pub a: [Finite; 2],
}

fn wide() -> Positive {
    Positive::new(0.6).unwrap_or(Positive::ONE)
}

fn butterworth() -> Positive {
    Positive::new(std::f64::consts::FRAC_1_SQRT_2).unwrap_or(Positive::ONE)
}

impl Filter {
    /// Returns the filter's frequency as a tunable parameter, for samples `period` (s) apart; `None` of a lead or of
    /// coefficients.
    pub fn tunable(&self, period: f64) -> Option<Tunable> {
        let most = std::f64::consts::PI / period;
        match self {
            Self::Notch(notch) => {
                Some(Tunable::positive("notch.frequency", notch.frequency).with_upper(most))
            }
            Self::LowPass(pass) => {
                Some(Tunable::positive("low_pass.frequency", pass.frequency).with_upper(most))
            }
            Self::Lead(_) | Self::Biquad(_) => None,
        }
    }

    /// Returns the filter with another frequency (rad/s), if it has one.
    pub fn at(&self, frequency: f64) -> Option<Self> {
        let frequency = Positive::new(frequency)?;
        match self {
            Self::Notch(notch) => Some(Self::Notch(Notch { frequency, ..*notch })),
            Self::LowPass(pass) => Some(Self::LowPass(LowPass { frequency, ..*pass })),
            Self::Lead(_) | Self::Biquad(_) => None,
        }
    }

    /// Returns the digital filter for samples `period` (s) apart.
    ///
    /// # Errors
    /// A `ConfigError` with a key that does not fit the period and the reason.
    pub fn sampled(&self, period: f64) -> Result<Biquad, ConfigError> {
        match self {
            Self::Notch(notch) => {
                let (w, depth) = (notch.frequency.get(), notch.depth.get());
                if depth >= 1.0 {
                    return Err(ConfigError::new(
                        "notch.depth",
                        format!("must be a gain below 1, got {depth}"),
                    ));
                }
                below_nyquist(w, period).map_err(|why| ConfigError::new("notch.frequency", why))?;
                let damping = 2.0 * notch.damping.get() * w;
                Ok(Biquad::tustin([w * w, depth * damping, 1.0], [w * w, damping, 1.0], w, period))
            }
            Self::LowPass(pass) => {
                let w = pass.frequency.get();
                below_nyquist(w, period).map_err(|why| ConfigError::new("low_pass.frequency", why))?;
                let damping = 2.0 * pass.damping.get() * w;
                Ok(Biquad::tustin([w * w, 0.0, 0.0], [w * w, damping, 1.0], w, period))
            }
            Self::Lead(lead) => {
                let (zero, pole) = (lead.zero.get(), lead.pole.get());
                // The frequency with the largest phase.
                let middle = f64::sqrt(zero) * f64::sqrt(pole);
                below_nyquist(middle, period).map_err(|why| {
                    ConfigError::new("lead.pole", format!("makes the middle of zero and pole one that {why}"))
                })?;
                Ok(Biquad::tustin([1.0, 1.0 / zero, 0.0], [1.0, 1.0 / pole, 0.0], middle, period))
            }
            Self::Biquad(coefficients) => {
                let biquad = Biquad::new(coefficients.b.map(Finite::get), coefficients.a.map(Finite::get));
                let why = "must make a filter that is stable: |a2| < 1 and |a1| < 1 + a2";
                if biquad.is_stable() { Ok(biquad) } else { Err(ConfigError::new("biquad.a", why)) }
            }
        }
    }
}

/// Checks that a frequency is below the Nyquist frequency, above which samples show an alias.
fn below_nyquist(frequency: f64, period: f64) -> Result<(), String> {
    let most = std::f64::consts::PI / period;
    if frequency < most {
        return Ok(());
    }
    let turns = libm::round(frequency / (2.0 * most));
    let alias = (frequency - turns * 2.0 * most).abs();
    Err(format!(
        "must be below pi over the law's period, {most:.4} rad/s, got {frequency}: at samples this appears at {alias:.4} rad/s"
    ))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn filter(text: &str) -> Filter {
        flexsc_formats::document::from_text(text).unwrap()
    }

    fn close(found: [f64; 2], exact: [f64; 2], within: f64) {
        for (found, exact) in found.into_iter().zip(exact) {
            assert!((found - exact).abs() <= within, "{found} {exact}");
        }
    }

    #[test]
    fn the_coefficients_are_those_of_the_bilinear_transform() {
        let responses = |text: &str| {
            let mut biquad = filter(text).sampled(0.25).unwrap();
            [1.0, 0.0, 0.0, 0.0].map(|sample| biquad.filter(sample))
        };
        // Returns the impulse response of given coefficients: b0, b1 - a1 b0, ...
        let impulse = |b: [f64; 3], a: [f64; 2]| {
            let mut biquad = Biquad::new(b, a);
            [1.0, 0.0, 0.0, 0.0].map(|sample| biquad.filter(sample))
        };
        // Eight digits from SciPy's signal.bilinear, prewarped.
        let notch = impulse([0.866_960_62, -1.639_860_29, 0.842_771_65], [-1.639_860_29, 0.709_732_27]);
        let low = impulse([0.045_828_70, 0.091_657_41, 0.045_828_70], [-1.314_141_89, 0.497_456_71]);
        let found = responses("notch = { frequency = 1.1475, depth = 0.08333333333333333, damping = 0.6 }");
        for (found, exact) in found.into_iter().zip(notch) {
            assert!((found - exact).abs() < 3e-8, "{found} {exact}");
        }
        for (found, exact) in responses("low_pass = { frequency = 2.0, damping = 0.7 }").into_iter().zip(low)
        {
            assert!((found - exact).abs() < 3e-8, "{found} {exact}");
        }
    }

    #[test]
    fn gains_are_those_asked_for() {
        let notch = filter("notch = { frequency = 1.1475, depth = 0.05 }").sampled(0.25).unwrap();
        close(notch.response(1.1475, 0.25), [0.05, 0.0], 1e-12);
        close(notch.response(0.0, 0.25), [1.0, 0.0], 1e-13);
        // Half the zero's and pole's phases: atan(w/z) - atan(w/p) at sqrt(z p).
        let lead = filter("lead = { zero = 0.5, pole = 2.0 }").sampled(0.25).unwrap();
        let phase = libm::atan(2.0) - libm::atan(0.5);
        close(lead.response(1.0, 0.25), [2.0, phase], 1e-14);
        let low = filter("low_pass = { frequency = 2.0 }").sampled(0.25).unwrap();
        close(
            low.response(2.0, 0.25),
            [std::f64::consts::FRAC_1_SQRT_2, -std::f64::consts::FRAC_PI_2],
            1e-13,
        );
    }

    #[test]
    fn what_samples_cannot_show_is_refused() {
        let fault = |text: &str| filter(text).sampled(0.25).unwrap_err().to_string();
        let notch = fault("notch = { frequency = 50.4, depth = 0.1 }");
        assert!(
            notch.starts_with("`notch.frequency` must be below pi over the law's period, 12.5664 rad/s"),
            "{notch}"
        );
        assert!(notch.ends_with("appears at 0.1345 rad/s"), "{notch}");
        assert!(fault("notch = { frequency = 5.0, depth = 1.0 }").contains("a gain below 1"));
        assert!(fault("biquad = { b = [1.0, 0.0, 0.0], a = [-2.0, 1.0] }").contains("stable"));
        assert!(filter("biquad = { b = [1.0, 0.0, 0.0], a = [-1.0, 0.5] }").sampled(0.25).is_ok());
    }
}
