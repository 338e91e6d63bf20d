//! Loads at points of the body, with the measured paths that take the place of the model.
//!
//! Between the rows of its table a path is interpolated on logarithmic scales, with the phase along the shorter arc. Outside its table the
//! model is left.

use std::cmp::Ordering;

use flexsc_formats::document::ConfigError;
use flexsc_scenario::Scenario;
use nalgebra::{Complex, DVector};

use super::load_column;
use crate::linear_model::Signal;
use crate::margins::frequency_response::{modulus, unit_circle};

/// Force along and torque about x, y and z at a point of the body.
#[derive(Clone, Debug, PartialEq)]
pub struct PointLoad {
    /// Name of the point.
    pub point: String,
    /// Amplitudes of the force, and then of the torque (N, N m).
    pub amplitudes: [f64; 6],
    /// Column of the rates of the body's states.
    pub column: DVector<f64>,
}

impl PointLoad {
    /// Creates a load by its amplitudes; each component has a column of the rates of the body's states.
    pub fn new(point: &str, amplitudes: [f64; 6], column: impl Fn(usize) -> DVector<f64>) -> Self {
        let given = (0..6).filter(|part| amplitudes[*part] != 0.0);
        let column = given.map(|part| column(part) * amplitudes[part]).sum();
        Self { point: point.to_owned(), amplitudes, column }
    }
}

/// Measured response of an output to a component of a load.
#[derive(Clone, Debug, PartialEq)]
pub struct MeasuredResponse {
    /// Place of the output among those that are asked for.
    pub output: usize,
    /// Number of the load.
    pub load: usize,
    /// Number of the load that has this component alone.
    pub alone: usize,
    /// Amplitude of the component.
    amplitude: f64,
    /// Frequencies (rad/s) and responses.
    rows: Vec<(f64, Complex<f64>)>,
}
