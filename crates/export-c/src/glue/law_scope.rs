//! Names of what laws about each axis have and read: their own state and constants, and the estimates.

use super::text::{VECTOR, about};
use crate::control_system::SampledLaws;

/// Laws of a control system, or of one of its modes.
pub struct LawScope<'a> {
    pub laws: &'a SampledLaws,
    /// Name of the mode; `None` of laws that act throughout.
    pub mode: Option<&'a str>,
    /// True if the variables `angle` and `rate` are the estimates of an attitude filter.
    pub has_attitude: bool,
}

impl LawScope<'_> {
    /// Returns the path of the struct with the state of the laws.
    pub fn path(&self) -> String {
        self.mode.map_or_else(|| "state".to_owned(), |mode| format!("state.law_{mode}"))
    }

    /// Returns a member of the state that is the laws' own.
    pub fn state(&self, member: &str) -> String {
        format!("{}.{member}", self.path())
    }

    /// Returns the name of a constant that is the laws' own.
    pub fn constant(&self, name: &str) -> String {
        self.mode.map_or_else(|| name.to_owned(), |mode| format!("{name}_{mode}")).to_uppercase()
    }

    /// Returns the estimated angle or rate about an axis: a component of the filter's estimate, or an input.
    pub fn estimate(&self, name: &str, axis: usize) -> String {
        let own = |name: &str| about(name, axis, self.laws.axis_count());
        if self.has_attitude {
            format!("{name}.{}", VECTOR[axis])
        } else if self.laws.filter.is_some() {
            format!("state.{}.{name}", own("estimate"))
        } else if self.laws.rate_filter.is_some() && name == "rate" {
            format!("state.{}.rate", own("rate_filter"))
        } else {
            format!("input.{}", own(name))
        }
    }
}
