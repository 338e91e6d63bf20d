//! Verdicts: whether what a paper says holds, decided by a stated condition, beside what is known to come out.

/// A verdict.
#[derive(Clone, Debug, PartialEq)]
pub struct Verdict {
    /// What it is about.
    pub name: String,
    /// Whether the paper's statement holds.
    pub holds: bool,
    /// Whether it is known to.
    pub expected: bool,
}

impl Verdict {
    /// The word of it: yes or no.
    pub fn word(&self) -> &'static str {
        if self.holds { "yes" } else { "no" }
    }

    /// Whether it came out as it is known to.
    pub fn is_as_expected(&self) -> bool {
        self.holds == self.expected
    }
}
