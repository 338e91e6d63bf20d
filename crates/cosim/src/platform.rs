//! Platforms of the libraries in an FMU, with their names in each version of FMI.

use crate::error::CoSimulationError;
use crate::fmi_version::FmiVersion;

/// Platform of a library.
#[derive(Debug, PartialEq, Eq)]
pub struct Platform {
    /// Operating system and processor, as Rust names them.
    target: (&'static str, &'static str),
    /// Folder in FMI 2.0; empty without one.
    fmi2: &'static str,
    /// Folder in FMI 3.0.
    fmi3: &'static str,
    /// Extension of libraries.
    pub(crate) suffix: &'static str,
}

const fn platform(
    target: (&'static str, &'static str),
    fmi2: &'static str,
    fmi3: &'static str,
    suffix: &'static str,
) -> Platform {
    Platform { target, fmi2, fmi3, suffix }
}

/// All platforms.
const PLATFORMS: &[Platform] = &[
    platform(("linux", "x86_64"), "linux64", "x86_64-linux", ".so"),
    platform(("linux", "aarch64"), "", "aarch64-linux", ".so"),
    platform(("windows", "x86_64"), "win64", "x86_64-windows", ".dll"),
    platform(("windows", "aarch64"), "", "aarch64-windows", ".dll"),
    platform(("macos", "x86_64"), "darwin64", "x86_64-darwin", ".dylib"),
    platform(("macos", "aarch64"), "darwin64", "aarch64-darwin", ".dylib"),
];

impl Platform {
    /// Returns the platform of this program.
    ///
    /// # Errors
    /// Fails for one without a name in FMI.
    pub fn host() -> Result<&'static Self, CoSimulationError> {
        let target = (std::env::consts::OS, std::env::consts::ARCH);
        let own = PLATFORMS.iter().find(|platform| platform.target == target);
        own.ok_or_else(|| {
            CoSimulationError::refused(format!("FMI has no name for the platform {} {}", target.1, target.0))
        })
    }

    /// Returns the platform with this name in a version of FMI, such as `win64` or `x86_64-windows`.
    ///
    /// # Errors
    /// Fails for any other name.
    pub fn from_name(name: &str) -> Result<&'static Self, CoSimulationError> {
        let own = PLATFORMS.iter().find(|of| of.fmi3 == name || (of.fmi2 == name && !name.is_empty()));
        own.ok_or_else(|| {
            let names: Vec<&str> = PLATFORMS.iter().map(|of| of.fmi3).collect();
            let names = names.join(", ");
            CoSimulationError::refused(format!(
                "`{name}` is no platform: it must be one of {names}, or linux64, win64, darwin64"
            ))
        })
    }

    /// Returns the folder of its libraries.
    ///
    /// # Errors
    /// Fails for a platform that the version of the standard has no name for.
    pub(crate) fn folder(&self, version: FmiVersion) -> Result<&'static str, CoSimulationError> {
        match version {
            FmiVersion::V3 => Ok(self.fmi3),
            FmiVersion::V2 if !self.fmi2.is_empty() => Ok(self.fmi2),
            FmiVersion::V2 => Err(CoSimulationError::refused(format!(
                "this version of FMI has no name for the platform {}\n\nhint: export FMI 3.0",
                self.fmi3
            ))),
        }
    }
}
