//! Largest rate of rotation of a spacecraft for which the model of its modes is valid.

use super::{AssembledSpacecraft, ClampedModeInBody};

/// Ratio of rate to clamped frequency above which terms of second order in the deformation are significant.
const WITH_MOMENTS: f64 = 0.2;
/// As `WITH_MOMENTS`, for unknown first moments, with which centrifugal forces on the modes are neglected.
const WITHOUT_MOMENTS: f64 = 0.01;

/// Largest rate of rotation of a spacecraft, with its reason.
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct RateLimit {
    /// Largest rate (rad/s).
    pub rate: f64,
    /// Explanation of the limit, as a text that follows the number.
    pub why: &'static str,
}

impl AssembledSpacecraft {
    /// Returns the largest rate at which the model of the modes is valid; `None` if the spacecraft is rigid, or all
    /// modes are of hinges.
    pub fn rate_limit(&self) -> Option<RateLimit> {
        let limit = |part: &ClampedModeInBody| {
            if part.knows_moments {
                let why = "a fifth of the lowest frequency with the root clamped: above it, the model neglects too much";
                RateLimit { rate: WITH_MOMENTS * part.frequency, why }
            } else {
                let why = "a hundredth of the lowest frequency of an appendage without first moments (`moments`, or `plate`)";
                RateLimit { rate: WITHOUT_MOMENTS * part.frequency, why }
            }
        };
        self.parts.iter().filter(|part| !part.is_hinge).map(limit).min_by(|a, b| a.rate.total_cmp(&b.rate))
    }
}
