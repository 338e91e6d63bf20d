//! Versions of FMI, and the name of a library and of its platform in each.

use crate::error::CoSimulationError;

/// Name of the library in an FMU, without its extension.
pub const MODEL_IDENTIFIER: &str = "flexsc";

/// Version of the standard.
#[derive(Copy, Clone, Debug, PartialEq, Eq)]
pub enum FmiVersion {
    /// FMI 2.0.
    V2,
    /// FMI 3.0.
    V3,
}

impl FmiVersion {
    /// Returns the folder of libraries for this platform.
    ///
    /// # Errors
    /// Fails for a platform that the version of the standard has no name for.
    pub fn platform(self) -> Result<&'static str, CoSimulationError> {
        let (system, processor) = (std::env::consts::OS, std::env::consts::ARCH);
        match (self, system, processor) {
            (Self::V3, "linux", "x86_64") => Ok("x86_64-linux"),
            (Self::V3, "linux", "aarch64") => Ok("aarch64-linux"),
            (Self::V3, "macos", "x86_64") => Ok("x86_64-darwin"),
            (Self::V3, "macos", "aarch64") => Ok("aarch64-darwin"),
            (Self::V3, "windows", "x86_64") => Ok("x86_64-windows"),
            (Self::V3, "windows", "aarch64") => Ok("aarch64-windows"),
            (Self::V2, "linux", "x86_64") => Ok("linux64"),
            (Self::V2, "macos", _) => Ok("darwin64"),
            (Self::V2, "windows", "x86_64") => Ok("win64"),
            _ => Err(CoSimulationError::refused(format!(
                "this version of FMI has no name for the platform {processor} {system}\n\nhint: export FMI 3.0"
            ))),
        }
    }
}
