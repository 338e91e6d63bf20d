//! Coarse Sun cells: each gives a current in proportion to the cosine of the Sun's angle to its normal. The lit ones
//! together give the direction to the Sun.
//!
//! With the normals n_i of the cells whose signals c_i are at least `threshold`, the direction is the vector s that
//! minimises the sum of (n_i.s - c_i)², scaled to length 1. It needs three cells whose normals are not in a plane.

use flexsc_formats::document::ConfigError;
use flexsc_numerics::attitude::{Vector, vector};
use flexsc_numerics::inverse::inverse_3x3;
use flexsc_numerics::quantity::{Finite, NonNegative, Positive, Time};
use flexsc_numerics::random::{Seed, Stream};
use flexsc_numerics::time::{Instant, Span};
use flexsc_spacecraft::environment::to_body;
use nalgebra::Matrix3;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::direction_sensor::SensedBody;
use super::failure::with_failures;
use super::latency_queue::LatencyQueue;
use super::sun_sensor::SensedSun;
use super::{
    MeasuredQuantity, Reading, ReferenceNoise, Sensor, SensorFailure, SensorSpec, Subject, Truth,
    VectorMeasurement,
};
use crate::offers::Offers;
use crate::part::Part;
use crate::quantity::QuantityShape;
use crate::requirement::Requirements;

/// Least determinant of the sum of n n' over the lit cells, at which they still give a direction.
const LEAST_SPREAD: f64 = 1e-3;

/// Largest number of cells.
const MOST_CELLS: usize = 64;

/// Coarse Sun cells on a body with three axes. Together they measure the direction to the Sun as a unit vector. Light that
/// the planet reflects is not modelled.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct SunCells {
    /// The cells, three to 64, whose normals are not all in a plane.
    pub cells: Vec<SunCell>,
    /// Half angle within which light reaches a cell (rad), at most pi/2; default: pi/2.
    #[serde(default = "half_sphere")]
    pub field_of_view: Positive,
    /// Signal below which a cell counts as dark; a cell that faces the Sun has the signal 1.
    #[serde(default = "threshold")]
    pub threshold: Positive,
    /// Point of the structure at which they are mounted; default: the first of the body's points.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub point: Option<String>,
    /// Period of their samples (s).
    pub period: Span,
    /// Standard deviation of the white noise of each signal.
    #[serde(default)]
    pub noise: NonNegative,
    /// Time from a sample to its output (s).
    #[serde(default)]
    pub latency: Time,
    /// Intervals in which all cells fail.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub faults: Vec<SensorFailure>,
}

/// A Sun cell.
#[derive(Copy, Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct SunCell {
    /// Outward normal in the body's axes, of any length.
    pub normal: [Finite; 3],
    /// Relative error of its signal.
    #[serde(default)]
    pub scale: Finite,
    /// Constant error of its signal.
    #[serde(default)]
    pub bias: Finite,
}

fn half_sphere() -> Positive {
    Positive::new(std::f64::consts::FRAC_PI_2).unwrap_or(Positive::ONE)
}

fn threshold() -> Positive {
    Positive::new(0.1).unwrap_or(Positive::ONE)
}

impl SensorSpec for SunCells {
    fn start(&self, _: usize, seed: Seed, ordinal: usize) -> Box<dyn Sensor> {
        Box::new(SunCellsState::new(self, seed, ordinal))
    }

    fn period(&self, _: Option<Span>) -> Option<Span> {
        Some(self.period)
    }

    fn subject(&self) -> Subject {
        Subject::Direction
    }

    fn point(&self) -> Option<&str> {
        self.point.as_deref()
    }

    fn faults(&self) -> &[SensorFailure] {
        &self.faults
    }

    fn validate(&self) -> Option<ConfigError> {
        let flat = |cell: &SunCell| cell.normal.iter().all(|part| part.get() == 0.0);
        if let Some(index) = self.cells.iter().position(flat) {
            let key = format!("cells[{index}].normal");
            return Some(ConfigError::new(key, "must not be zero, got [0, 0, 0]"));
        }
        if self.cells.len() > MOST_CELLS {
            let why = format!("must be at most {MOST_CELLS}, got {}", self.cells.len());
            return Some(ConfigError::new("cells", why));
        }
        let spread: Matrix3<f64> = self.normals().map(|normal| normal * normal.transpose()).sum();
        if spread.determinant() < LEAST_SPREAD {
            let why = "must have three normals that are not in a plane, to give a direction";
            return Some(ConfigError::new("cells", why));
        }
        let (view, most) = (self.field_of_view.get(), std::f64::consts::FRAC_PI_2);
        if view > most {
            let why = format!("must be at most pi/2, since no light reaches a cell from behind, got {view}");
            return Some(ConfigError::new("field_of_view", why));
        }
        let threshold = self.threshold.get();
        (threshold >= 1.0).then(|| {
            let why = format!("must be below 1, the signal of a cell that faces the Sun, got {threshold}");
            ConfigError::new("threshold", why)
        })
    }

    fn requires(&self, _: usize, offers: &Offers, needs: &mut Requirements) {
        super::requirements::require_attitude(offers, needs);
        needs.require(offers.environment.sun, "", SensedSun::UNDEFINED);
    }

    fn reference(&self) -> Option<(Span, ReferenceNoise)> {
        Some((self.latency(), ReferenceNoise::Sun(self.covariance())))
    }

    fn measured_quantities(&self, _: bool, _: usize) -> Vec<MeasuredQuantity> {
        vec![MeasuredQuantity::vector("direction", "", QuantityShape::Vector, SensedSun::MEANING)]
    }
}

impl SunCells {
    /// Iterates over the outward normals in the body's axes, unit vectors.
    fn normals(&self) -> impl Iterator<Item = Vector> {
        self.cells.iter().map(|cell| vector(&cell.normal).normalize())
    }

    /// Returns the latency of a reading.
    pub fn latency(&self) -> Span {
        Span::from_seconds(self.latency.get())
    }

    /// Returns the covariance of the direction with half of all cells lit.
    pub fn covariance(&self) -> Matrix3<f64> {
        let spread: Matrix3<f64> = self.normals().map(|normal| normal * normal.transpose()).sum();
        let variance = self.noise.get() * self.noise.get();
        inverse_3x3(spread).map_or_else(Matrix3::zeros, |inverse| inverse * (2.0 * variance))
    }
}

/// Run-time state of Sun cells.
#[derive(Clone, Debug)]
pub struct SunCellsState {
    sensor: SunCells,
    /// Outward normals in the body's axes, unit vectors.
    normals: Vec<Vector>,
    noise: Vec<Stream>,
    late: LatencyQueue,
}

impl SunCellsState {
    /// Creates the run-time state; `ordinal` counts earlier Sun cells.
    fn new(sensor: &SunCells, seed: Seed, ordinal: usize) -> Self {
        let draws = |cell: usize| seed.stream(&format!("sun cells {ordinal} {cell}"));
        Self {
            normals: sensor.normals().collect(),
            noise: (0..sensor.cells.len()).map(draws).collect(),
            late: LatencyQueue::new(sensor.period, sensor.latency()),
            sensor: sensor.clone(),
        }
    }

    /// Returns the direction to the Sun in the body's axes, as measured, for its true direction.
    fn direction(&mut self, exact: Option<&Vector>) -> Option<Vector> {
        // Random numbers are drawn in shadow too, so that later ones do not depend on it.
        let draws: Vec<f64> = self.noise.iter_mut().map(Stream::normal).collect();
        let exact = exact?;
        let (mut spread, mut sum) = (Matrix3::zeros(), Vector::zeros());
        for ((cell, normal), draw) in self.sensor.cells.iter().zip(&self.normals).zip(draws) {
            let cosine = normal.dot(exact);
            let off = libm::atan2(normal.cross(exact).norm(), cosine);
            let light = if off < self.sensor.field_of_view.get() { cosine.max(0.0) } else { 0.0 };
            let errors = cell.scale.get() * light + cell.bias.get() + self.sensor.noise.get() * draw;
            let signal = light + errors;
            if signal >= self.sensor.threshold.get() {
                spread += normal * normal.transpose();
                sum += normal * signal;
            }
        }
        if spread.determinant() < LEAST_SPREAD {
            return None;
        }
        (inverse_3x3(spread)? * sum).try_normalize(f64::MIN_POSITIVE)
    }

    fn measure(&mut self, now: Instant, truth: &Truth, last: Option<&Reading>) -> Option<Reading> {
        let attitude = truth.orientation.rotated_by(truth.sensor_angles()).attitude()?;
        let inertial = truth.environment.sun;
        let exact = inertial.map(|inertial| to_body(&attitude, &inertial));
        let vector = self.direction(exact.as_ref());
        let reading = vector.zip(inertial).map(|(vector, inertial)| Reading {
            at: truth.orientation,
            rate: None,
            sight: Some(VectorMeasurement { vector, inertial, is_direction: true }),
        });
        with_failures(&self.sensor.faults, now, reading, last)
    }
}

impl Part for SunCellsState {}

impl Sensor for SunCellsState {
    fn read(&mut self, now: Instant, truth: &Truth, last: Option<&Reading>) -> Option<Reading> {
        if self.late.samples_now(now) {
            let reading = self.measure(now, truth, last);
            self.late.push(now, reading);
        }
        self.late.take_due(now)
    }

    fn next_due(&mut self, _: Instant, _: Span) -> Instant {
        self.late.next_due()
    }

    fn copy(&self) -> Box<dyn Sensor> {
        Box::new(self.clone())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Six cells on the faces of a cube.
    const CUBE: &str = "period = 1.0\ncells = [{ normal = [1, 0, 0] }, { normal = [-2, 0, 0] }, { normal = [0, 1, 0] }, \
                        { normal = [0, -1, 0] }, { normal = [0, 0, 1] }, { normal = [0, 0, -1] }]\n";

    fn cells(keys: &str) -> SunCells {
        flexsc_formats::document::from_text(keys).unwrap()
    }

    fn start(keys: &str) -> SunCellsState {
        let cells = cells(&format!("{CUBE}{keys}"));
        assert_eq!(cells.validate(), None);
        SunCellsState::new(&cells, Seed { scenario: 1, run: 0 }, 0)
    }

    #[test]
    fn three_lit_cells_give_the_direction() {
        let sun = Vector::new(0.6, -0.5, 0.4).normalize();
        let found = start("").direction(Some(&sun)).unwrap();
        assert!((found - sun).norm() < 1e-15, "{found}");
        assert_eq!(start("").direction(None), None);
        // Two lit cells, or three in a narrow field of view, give no direction.
        assert_eq!(start("").direction(Some(&Vector::new(0.6, 0.8, 0.0))), None);
        assert_eq!(start("field_of_view = 0.5").direction(Some(&sun)), None);
        // Below the threshold a cell is dark.
        let low = Vector::new(0.7, -0.7, 0.1).normalize();
        assert!(start("threshold = 0.2").direction(Some(&low)).is_none());
        assert!(start("threshold = 0.05").direction(Some(&low)).is_some());
    }

    #[test]
    fn errors_of_a_cell_turn_the_direction() {
        let keys = CUBE.replace("normal = [1, 0, 0]", "normal = [1, 0, 0], scale = 0.1, bias = -0.02");
        let mut state = SunCellsState::new(&cells(&keys), Seed { scenario: 1, run: 0 }, 0);
        let sun = Vector::new(0.6, -0.5, 0.4).normalize();
        let exact = Vector::new(1.1 * sun.x - 0.02, sun.y, sun.z).normalize();
        assert!((state.direction(Some(&sun)).unwrap() - exact).norm() < 1e-15);
        // The filter's covariance is that of the direction that the lit half of the cells measures.
        let mut noisy = start("noise = 1e-3");
        let (count, mut squares) = (20_000, 0.0);
        for _ in 0..count {
            squares += (noisy.direction(Some(&sun)).unwrap() - sun).norm_squared() / f64::from(count);
        }
        let covariance = noisy.sensor.covariance();
        assert!((covariance - Matrix3::identity() * 1e-6).norm() < 1e-18, "{covariance}");
        // Across the direction alone: two of three variances.
        assert!((squares / 2e-6 - 1.0).abs() < 0.03, "{squares}");
    }

    #[test]
    fn cells_that_give_no_direction_are_refused() {
        let fault = |keys: &str| cells(keys).validate().unwrap().to_string();
        let two =
            "period = 1.0\ncells = [{ normal = [1, 0, 0] }, { normal = [0, 1, 0] }, { normal = [1, 1, 0] }]";
        assert!(fault(two).starts_with("`cells` must have three normals"));
        assert!(fault("period = 1.0\ncells = []").starts_with("`cells` must have three"));
        assert!(
            fault("period = 1.0\ncells = [{ normal = [0, 0, 0] }]").starts_with("`cells[0].normal` must")
        );
        assert!(fault(&format!("{CUBE}field_of_view = 1.6")).starts_with("`field_of_view` must be at most"));
        assert!(fault(&format!("{CUBE}threshold = 1.0")).starts_with("`threshold` must be below 1"));
    }
}
