//! How fast a spacecraft may turn, by its modes.

use super::{Craft, Part};

/// Faster than this part of a clamped frequency the terms count that are of second order in the deformation.
const WITH_MOMENTS: f64 = 0.2;
/// The same where first moments are not known, and the pull on what turns is left out.
const WITHOUT_MOMENTS: f64 = 0.01;

/// The largest rate of a spacecraft.
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct Limit {
    /// It (rad/s).
    pub rate: f64,
    /// What it follows from, to be read after the number.
    pub why: &'static str,
}

impl Craft {
    /// The largest rate up to which its modes tell how it bends; none if it is rigid, or all swing on hinges.
    pub fn rate_limit(&self) -> Option<Limit> {
        let limit = |part: &Part| {
            if part.knows_moments {
                let why = "a fifth of the lowest frequency with the root clamped: above it, the model neglects too much";
                Limit { rate: WITH_MOMENTS * part.frequency, why }
            } else {
                let why = "a hundredth of the lowest frequency of an appendage without first moments (`moments`, or `plate`)";
                Limit { rate: WITHOUT_MOMENTS * part.frequency, why }
            }
        };
        self.parts.iter().filter(|part| !part.is_hinge).map(limit).min_by(|a, b| a.rate.total_cmp(&b.rate))
    }
}
