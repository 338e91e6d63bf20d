//! Manoeuvres: rotations planned ahead, whose command leaves the elastic modes at rest.

mod waveform;

pub use waveform::{Shape, Term, Waveform};

/// A manoeuvre as planned.
#[derive(Clone, Debug, PartialEq)]
pub struct Plan {
    /// The command.
    pub waveform: Waveform,
    /// How long it lasts (s).
    pub time: f64,
    /// Rigid angle gained (rad).
    pub angle: f64,
    /// Rate at the end (rad/s).
    pub end_rate: f64,
}
