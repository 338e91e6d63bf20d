//! Manoeuvres: rotations planned ahead, whose command leaves the elastic modes at rest.

mod waveform;

pub use waveform::{Shape, Term, Waveform};
