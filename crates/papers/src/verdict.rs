//! Verdicts: whether a paper's statement holds, decided by a stated condition, and compared with the known result.

/// Verdict on a statement of a paper.
#[derive(Clone, Debug, PartialEq)]
pub struct Verdict {
    /// Subject of the statement.
    pub name: String,
    /// True if the paper's statement holds.
    pub holds: bool,
    /// True if the statement is known to hold.
    pub expected: bool,
}

impl Verdict {
    /// Returns the word for the verdict: yes or no.
    pub fn word(&self) -> &'static str {
        if self.holds { "yes" } else { "no" }
    }

    /// Returns true if the verdict is the known one.
    pub fn is_as_expected(&self) -> bool {
        self.holds == self.expected
    }
}
