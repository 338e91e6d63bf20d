//! Replacements for large matrices and NumPy archives in a build without the feature `matrices`.

use nalgebra::DMatrix;

use super::eigen_reduced::{EigenError, ReducedEigen};

/// Reason why the feature is missing, and the remedy.
pub const LEFT_OUT: &str =
    "need the feature `matrices`, which this build leaves out: `cargo build --release --features full`";

/// Replaces the solver for large matrices.
pub fn large(_: &DMatrix<f64>, _: &DMatrix<f64>, _: &DMatrix<f64>) -> Result<ReducedEigen, EigenError> {
    Err(EigenError::LeftOut)
}

/// Replaces the reader of NumPy archives.
pub mod npz {
    use std::path::Path;

    use nalgebra::DMatrix;

    pub fn read(_: &Path, _: Option<&str>) -> Result<DMatrix<f64>, String> {
        Err(format!("NumPy's archives {}", super::LEFT_OUT))
    }
}
