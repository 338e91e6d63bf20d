//! Versions of FMI, and the name of a library.

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
