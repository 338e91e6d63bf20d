//! Errors at the sampling instants of requirements, and robustness of those over time, which only metrics read.

/// Sampled errors of the requirements that are due at an instant.
#[derive(Clone, Debug, Default)]
pub struct RequirementErrors(pub Vec<RequirementError>);

/// Sampled error of a requirement.
#[derive(Copy, Clone, Debug)]
pub struct RequirementError {
    /// Index of the requirement among those of the scenario.
    pub requirement: usize,
    /// Error about the body's axes (rad or rad/s); of a body with one angle, about the first.
    pub error: [f64; 3],
}

/// Robustness of the requirements over time, at the end of a run.
#[derive(Clone, Debug, Default)]
pub struct RobustnessOfRequirements(pub Vec<RequirementRobustness>);

/// Robustness of a requirement over time, whatever follows the run.
#[derive(Copy, Clone, Debug)]
pub struct RequirementRobustness {
    /// Index of the requirement among those of the scenario.
    pub requirement: usize,
    /// Least robustness; infinite where a part beyond the run, or no part of it, decides.
    pub least: f64,
    /// Largest robustness.
    pub largest: f64,
    /// Time (s) of the value that decides.
    pub at: f64,
}

impl RequirementRobustness {
    /// Returns the robustness that decides, infinite if no part of the run was to meet anything; `None` if what follows the
    /// run decides.
    pub fn decided(&self) -> Option<f64> {
        if self.least >= 0.0 { Some(self.least) } else { Some(self.largest).filter(|largest| *largest < 0.0) }
    }
}

/// Signals that the requirements over time of a run read, for records that want them.
#[derive(Clone, Debug, Default)]
pub struct RequirementSignals {
    /// Times (s) and values of each quantity, to be joined by straight lines.
    pub signals: Vec<Vec<(f64, f64)>>,
    /// Index of each requirement over time, and of the signal of each of its comparisons and flags.
    pub of_requirements: Vec<(usize, Vec<usize>)>,
}

/// Requirements that begin or cease to count at an instant.
#[derive(Clone, Debug, Default)]
pub struct RequirementScopes(pub Vec<RequirementScope>);

/// Beginning or end of the time in which a requirement counts.
#[derive(Copy, Clone, Debug)]
pub struct RequirementScope {
    /// Index of the requirement among those of the scenario.
    pub requirement: usize,
    /// True from now on if it counts.
    pub counts: bool,
}
