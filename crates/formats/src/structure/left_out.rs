//! What a build without the feature `matrices` says of large matrices and of NumPy's archives.

use nalgebra::DMatrix;

use super::reduced::{Reduced, Unsolved};

/// Why, and what helps.
pub const LEFT_OUT: &str =
    "need the feature `matrices`, which this build leaves out: `cargo build --release --features full`";

/// In place of the eigenproblem of large matrices.
pub fn large(_: &DMatrix<f64>, _: &DMatrix<f64>, _: &DMatrix<f64>) -> Result<Reduced, Unsolved> {
    Err(Unsolved::LeftOut)
}

/// In place of the reader of NumPy's archives.
pub mod npz {
    use std::path::Path;

    use nalgebra::DMatrix;

    pub fn read(_: &Path, _: Option<&str>) -> Result<DMatrix<f64>, String> {
        Err(format!("NumPy's archives {}", super::LEFT_OUT))
    }
}
