//! Steering of control moment gyros: gimbal rates whose torque on the body is the demanded one.
//!
//! With unit vectors t_i perpendicular to the spin axes, the columns of A, rotors of momentum h give the torque -h A d'
//! at gimbal rates d'. The rates are A' (A A' + P)^-1 u, with u the demanded torque per unit of h. P = 0 is the
//! pseudo-inverse; a weight that grows towards singular angles keeps the rates finite there (\[Nakamura86\]), and
//! time-varying off-diagonal elements of it move the gimbals out of angles at which the demanded torque is along the
//! singular direction (\[Wie01\]).

use flexsc_numerics::attitude::Vector;
use flexsc_numerics::inverse::inverse_3x3;
use flexsc_numerics::quantity::{Finite, NonNegative, Positive};
use nalgebra::Matrix3;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// How the demanded torque becomes gimbal rates.
#[derive(Copy, Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Steering {
    /// Smallest sum of squared gimbal rates that gives the torque, by the pseudo-inverse: the rates grow without limit towards
    /// singular angles.
    PseudoInverse,
    /// Pseudo-inverse with a weight on the rates that grows towards singular angles, where the torque then differs from
    /// the demanded one.
    #[default]
    SingularityRobust,
}

/// The weight P = w (1 + E) of `singularity_robust` steering, with w = weight exp(-decay m²) and the singularity measure m.
#[derive(Copy, Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Robustness {
    /// The weight at singular angles; default: 0.01.
    #[serde(default = "weight")]
    pub weight: Positive,
    /// Decay of the weight with the square of the singularity measure; default: 10.
    #[serde(default = "decay")]
    pub decay: NonNegative,
    /// Amplitude of the elements of E beside its diagonal, below 0.5; default: 0.1.
    #[serde(default = "dither")]
    pub dither: NonNegative,
    /// Angular frequency of these elements (rad/s), whose phases are 0, 90 and 180 degrees; default: pi/2.
    #[serde(default = "frequency")]
    pub frequency: Positive,
}

fn weight() -> Positive {
    Positive::new(0.01).unwrap_or(Positive::ONE)
}

fn decay() -> NonNegative {
    NonNegative::new(10.0).unwrap_or_default()
}

fn dither() -> NonNegative {
    NonNegative::new(0.1).unwrap_or_default()
}

fn frequency() -> Positive {
    Positive::new(std::f64::consts::FRAC_PI_2).unwrap_or(Positive::ONE)
}

impl Default for Robustness {
    fn default() -> Self {
        Self { weight: weight(), decay: decay(), dither: dither(), frequency: frequency() }
    }
}

/// Null motion: gimbal rates whose torques cancel each other, towards preferred gimbal angles.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct NullMotion {
    /// Preferred angle of each gimbal, of four or more (rad).
    pub angles: Vec<Finite>,
    /// Gain with which the gimbals turn towards them, as far as no torque results (1/s).
    pub gain: Positive,
}

/// Determinant of A A' below which the angles are singular to rounding: the pseudo-inverse is then that of a matrix
/// with [`LEAST`] added, and there is no null motion.
const SINGULAR: f64 = 1e-12;

/// Diagonal element added to A A' at singular angles: see [`SINGULAR`].
const LEAST: f64 = 1e-9;

/// Axes of a control moment gyro, unit vectors in the body's axes.
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct GyroAxes {
    /// Direction of the momentum with the gimbal at angle 0.
    pub spin: Vector,
    /// Direction in which the momentum rotates from there.
    pub across: Vector,
}

impl GyroAxes {
    /// Returns the direction in which the momentum changes with the gimbal at an angle (rad).
    fn column(&self, angle: f64) -> Vector {
        let (sin, cos) = libm::sincos(angle);
        self.across * cos - self.spin * sin
    }
}

/// Returns the columns of A with gimbals at these angles (rad).
pub fn torque_directions(axes: &[GyroAxes], angles: &[f64]) -> Vec<Vector> {
    axes.iter().zip(angles).map(|(axes, angle)| axes.column(*angle)).collect()
}

/// Returns A A'.
fn gram(columns: &[Vector]) -> Matrix3<f64> {
    columns.iter().fold(Matrix3::zeros(), |sum, column| sum + column * column.transpose())
}

/// Returns the singularity measure, sqrt(det(A A')): 0 where the gimbals give no torque in some direction.
pub fn singularity_measure(columns: &[Vector]) -> f64 {
    f64::sqrt(gram(columns).determinant().max(0.0))
}

/// Returns A' (A A')^-1 u: the smallest rates with A d' = u.
fn least(columns: &[Vector], gram: &Matrix3<f64>, demanded: &Vector) -> Vec<f64> {
    let singular = gram.determinant() < SINGULAR;
    let whole = if singular { gram + Matrix3::from_diagonal_element(LEAST) } else { *gram };
    through(columns, &whole, demanded)
}

/// Returns A' M^-1 u; zeros if the matrix has no inverse.
fn through(columns: &[Vector], matrix: &Matrix3<f64>, demanded: &Vector) -> Vec<f64> {
    let solved = inverse_3x3(*matrix).map_or_else(Vector::zeros, |inverse| inverse * demanded);
    columns.iter().map(|column| column.dot(&solved)).collect()
}

/// Returns gimbal rates (rad/s) with A d' = `wanted` by the steering rule, at `t` (s) after the start.
pub fn gimbal_rates(columns: &[Vector], robust: Option<&Robustness>, demanded: &Vector, t: f64) -> Vec<f64> {
    let gram = gram(columns);
    let Some(robust) = robust else { return least(columns, &gram, demanded) };
    let weight = robust.weight.get() * libm::exp(-robust.decay.get() * gram.determinant().max(0.0));
    let (sin, cos) = libm::sincos(robust.frequency.get() * t);
    let [a, b, c] = [sin, cos, -sin].map(|part| robust.dither.get() * part);
    let whole = gram + Matrix3::new(1.0, c, b, c, 1.0, a, b, a, 1.0) * weight;
    through(columns, &whole, demanded)
}

/// Returns the null component of these rates, which gives no torque: d' - A' (A A')^-1 A d'; zeros at singular angles.
pub fn null_component(columns: &[Vector], rates: &[f64]) -> Vec<f64> {
    let gram = gram(columns);
    if gram.determinant() < SINGULAR {
        return vec![0.0; rates.len()];
    }
    let sum = columns.iter().zip(rates).fold(Vector::zeros(), |sum, (column, rate)| sum + column * *rate);
    let gimbal_motion = through(columns, &gram, &sum);
    rates.iter().zip(gimbal_motion).map(|(rate, motion)| rate - motion).collect()
}
