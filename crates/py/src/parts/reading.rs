//! True values and readings of sensors, for Python.

use flexsc_core::control::sensor::{Orientation, Reading as Engine, Truth as EngineTruth, VectorMeasurement};
use flexsc_core::numerics::attitude::Vector;
use flexsc_core::numerics::time::Instant as Exact;
use nalgebra::Quaternion;
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;

use super::instant::Instant;
use super::object::exactly;

/// A quaternion [w, x, y, z].
pub type Four = (f64, f64, f64, f64);
/// Three numbers along the body's axes.
pub type Three = (f64, f64, f64);

pub fn four(q: &Quaternion<f64>) -> Four {
    (q.w, q.i, q.j, q.k)
}

/// An angle, of a body with one.
pub fn angle(orientation: &Orientation) -> Option<f64> {
    if let Orientation::Angle(angle) = orientation { Some(*angle) } else { None }
}

/// An attitude, of a body with three axes.
pub fn attitude(orientation: &Orientation) -> Option<Four> {
    if let Orientation::Attitude(q) = orientation { Some(four(q)) } else { None }
}

/// Returns a vector as a tuple.
pub fn triple(vector: Option<Vector>) -> Option<Three> {
    vector.map(|vector| <[f64; 3]>::from(vector).into())
}

/// Returns the unit quaternion of four numbers.
pub fn unit_quaternion(object: &Bound<'_, PyAny>) -> PyResult<Quaternion<f64>> {
    let [w, x, y, z] = exactly::<4>(object, "attitude")?;
    let q = Quaternion::new(w, x, y, z);
    let length = q.norm();
    if (length - 1.0).abs() > 1e-6 || !length.is_finite() {
        let why = format!("attitude must be a unit quaternion (w, x, y, z), got one of length {length}");
        return Err(PyValueError::new_err(why));
    }
    Ok(q)
}

/// A measurement: the `angle` (rad) or the `attitude` (w, x, y, z), which default to the true one; the
/// `rate` (rad/s), three numbers or one; a `vector` in the body frame with its value in the `inertial`
/// frame.
///
/// >>> import flexsc
/// >>> flexsc.Reading(angle=1e-3, rate=2e-6).rate
/// (2e-06, 0.0, 0.0)
#[pyclass(frozen, eq, module = "flexsc._native")]
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct Reading {
    /// Orientation of the body, of a sensor that measures it.
    at: Option<Orientation>,
    rate: Option<[f64; 3]>,
    sight: Option<VectorMeasurement>,
}

impl Reading {
    pub fn from_engine(reading: &Engine) -> Self {
        Self { at: Some(reading.at), rate: reading.rate, sight: reading.sight }
    }

    /// The engine's reading, of a body that points there.
    pub fn within(&self, truth: &Orientation) -> PyResult<Engine> {
        let orientation = self.at.unwrap_or(*truth);
        let same = matches!(
            (&orientation, truth),
            (Orientation::Angle(_), Orientation::Angle(_))
                | (Orientation::Attitude(_), Orientation::Attitude(_))
        );
        if !same {
            let why =
                "a reading has an angle of a body with one angle, an attitude of a body with three axes";
            return Err(PyValueError::new_err(why));
        }
        Ok(Engine { at: orientation, rate: self.rate, sight: self.sight })
    }
}

#[pymethods]
impl Reading {
    #[new]
    #[pyo3(signature = (*, angle=None, attitude=None, rate=None, vector=None, inertial=None, is_direction=false))]
    fn new(
        angle: Option<f64>,
        attitude: Option<&Bound<'_, PyAny>>,
        rate: Option<&Bound<'_, PyAny>>,
        vector: Option<&Bound<'_, PyAny>>,
        inertial: Option<&Bound<'_, PyAny>>,
        is_direction: bool,
    ) -> PyResult<Self> {
        let attitude = attitude.map(unit_quaternion).transpose()?;
        let orientation = match (angle, attitude) {
            (Some(_), Some(_)) => {
                return Err(PyValueError::new_err("a reading has either an angle or an attitude"));
            }
            (Some(angle), None) => Some(Orientation::Angle(angle)),
            (None, Some(attitude)) => Some(Orientation::Attitude(attitude)),
            (None, None) => None,
        };
        let vector_of = |vector: Option<&Bound<'_, PyAny>>, name: &str| {
            vector.map(|object| exactly::<3>(object, name)).transpose()
        };
        let measurement = match (vector_of(vector, "vector")?, vector_of(inertial, "inertial")?) {
            (Some(vector), Some(inertial)) => Some(VectorMeasurement {
                vector: Vector::from(vector),
                inertial: Vector::from(inertial),
                is_direction,
            }),
            (None, None) => None,
            _ => return Err(PyValueError::new_err("a reading needs both vector and inertial, or neither")),
        };
        let rate = match rate {
            None => None,
            Some(rate) => match rate.extract::<f64>() {
                Ok(rate) => Some([rate, 0.0, 0.0]),
                Err(_) => Some(exactly::<3>(rate, "rate")?),
            },
        };
        Ok(Self { at: orientation, rate, sight: measurement })
    }

    /// Measured angle (rad), of a sensor that measures it.
    #[getter]
    fn angle(&self) -> Option<f64> {
        angle(self.at.as_ref()?)
    }

    /// Measured attitude (w, x, y, z), of a sensor that measures it.
    #[getter]
    fn attitude(&self) -> Option<Four> {
        attitude(self.at.as_ref()?)
    }

    /// Measured rates about each axis (rad/s), of a sensor that measures them.
    #[getter]
    fn rate(&self) -> Option<Three> {
        self.rate.map(Into::into)
    }

    /// Measured vector in the body frame, of a sensor that measures one.
    #[getter]
    fn vector(&self) -> Option<Three> {
        self.sight.map(|measurement| measurement.vector.into()).map(<[f64; 3]>::into)
    }

    /// Value of the vector in the inertial frame.
    #[getter]
    fn inertial(&self) -> Option<Three> {
        self.sight.map(|measurement| measurement.inertial.into()).map(<[f64; 3]>::into)
    }

    /// True if the vector is a direction, whose length means nothing.
    #[getter]
    fn is_direction(&self) -> bool {
        self.sight.is_some_and(|measurement| measurement.is_direction)
    }

    fn __deepcopy__(&self, _memo: &Bound<'_, PyAny>) -> Self {
        *self
    }
}

/// The true motion and sky at an instant, which sensors measure and disturbances depend on.
#[pyclass(frozen, module = "flexsc._native")]
#[derive(Copy, Clone, Debug)]
pub struct Truth {
    pub now: Exact,
    pub truth: EngineTruth,
}

attributes! { Truth {
    /// The instant: `truth.now - earlier` is the time between (s), without rounding before the
    /// difference.
    now: Instant = |this| Instant(this.now);
    /// The instant (s).
    time: f64 = |this| this.now.seconds();
    /// The angle with its elastic part (rad), for a single-axis body.
    angle: Option<f64> = |this| angle(&this.truth.orientation);
    /// The attitude (w, x, y, z) of a three-axis body, which rotates vectors from the body frame to the
    /// inertial frame.
    attitude: Option<Four> = |this| attitude(&this.truth.orientation);
    /// The elastic rotations at the sensor, in addition to the attitude (rad).
    elastic: Three = |this| this.truth.elastic.into();
    /// The rates at the sensor, including the elastic part (rad/s).
    rate: Three = |this| this.truth.rate.into();
    /// The rigid rates of the body (rad/s).
    rigid: Three = |this| this.truth.rigid_rate.into();
    /// The integral of `rate` (rad) up to a constant, as a gyro counts it.
    turned: Three = |this| this.truth.rate_integral.into();
    /// The magnetic field in the inertial frame (T), if there is one.
    field: Option<Three> = |this| triple(this.truth.environment.field);
    /// The direction to the Sun in the inertial frame, when in sunlight.
    sun: Option<Three> = |this| triple(this.truth.environment.sun);
    /// The position from the planet's centre in the inertial frame (m), on an orbit.
    position: Option<Three> = |this| triple(this.truth.environment.position);
    /// The velocity in the inertial frame (m/s), on an orbit.
    velocity: Option<Three> = |this| triple(this.truth.environment.velocity);
}

    /// The attitude rotated by three small angles about the body axes (rad).
    fn attitude_at(&self, angles: &Bound<'_, PyAny>) -> PyResult<Option<Four>> {
        Ok(attitude(&self.truth.orientation.rotated_by(exactly::<3>(angles, "angles")?)))
    }
}
