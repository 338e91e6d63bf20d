//! Place of the library that every exported FMU contains.

use std::env::consts::{DLL_PREFIX, DLL_SUFFIX};
use std::path::{Path, PathBuf};

use crate::error::CoSimulationError;

/// Finds the library in a directory, that of the command or of the Python package, or below `deps`, where cargo has it for
/// tests.
///
/// # Errors
/// Fails if it is in neither.
pub fn find_library(directory: Option<&Path>) -> Result<PathBuf, CoSimulationError> {
    let name = format!("{DLL_PREFIX}flexsc_fmi{DLL_SUFFIX}");
    let beside = directory.map(|directory| [directory.join(&name), directory.join("deps").join(&name)]);
    let found = beside.into_iter().flatten().find(|path| path.is_file());
    found.ok_or_else(|| {
        let place = directory.map_or_else(String::new, |directory| format!(" in {}", directory.display()));
        CoSimulationError::refused(format!(
            "the library of FMUs, {name}, is not{place}\n\nhint: build it with `cargo build --release -p flexsc-fmi`, and put it \
             there or state its path"
        ))
    })
}
