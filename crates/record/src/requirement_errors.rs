//! Errors at the sampling instants of requirements, which only metrics read.

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
