//! Plate of an appendage: in which direction a thin one extends, or a uniform panel that is known by its size and its
//! first frequency.

use std::fmt;

use flexsc_formats::document::ConfigError;
use flexsc_formats::structure::Shape;
use flexsc_formats::structure::mode_table::ModeRow;
use flexsc_numerics::attitude::{Vector, vector};
use flexsc_numerics::quantity::{Finite, Frequency, NonNegative, Positive};
use nalgebra::Matrix3;
use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::de::value::{MapAccessDeserializer, StrDeserializer};
use serde::de::{Error, MapAccess, Visitor};
use serde::{Deserialize, Deserializer, Serialize};

use super::clamped::ClampedMode;
use crate::body::spatial::NamedPoint;

/// First root of cos b cosh b = -1, and the ratio of the shape's two parts, (cosh b + cos b)/(sinh b + sin b)
/// (`tests/golden/plate_oracle.py`).
const ROOT: f64 = 1.875_104_068_711_961_2;
const RATIO: f64 = 0.734_095_513_758_912_8;

/// Terms of the series of the shape, of which the last is below 1e-17 of the first.
const TERMS: u32 = 6;

/// Part of the length or the width by which rounded positions of points may be beyond an edge.
const ROUNDING: f64 = 1e-6;

/// Axis along which a plate extends, in its own axes.
#[derive(Copy, Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
#[schemars(rename = "Plate")]
pub enum PlateAxis {
    /// Along x.
    X,
    /// Along y.
    #[default]
    Y,
}

/// A uniform rectangular panel of the mass of its appendage, clamped at the middle of one edge, in the first bending mode of
/// a cantilever.
#[derive(Copy, Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct UniformPlate {
    /// Axis along which it extends from the root; it bends out of the plane of x and y.
    #[serde(default)]
    pub along: PlateAxis,
    /// Length from the root to the tip (m).
    pub length: Positive,
    /// Width (m).
    pub width: Positive,
    /// First natural frequency with the root held (rad/s).
    pub frequency: Frequency,
    /// Damping ratio zeta with the root held: 0 undamped, 1 critical.
    #[serde(default)]
    pub damping: NonNegative,
}

/// Plate as a scenario describes it: by its axis, or by its size and first frequency.
#[derive(Copy, Clone, Debug, PartialEq, Serialize)]
#[serde(untagged)]
pub enum Plate {
    /// The axis of a plate whose modes are given.
    Axis(PlateAxis),
    /// A uniform panel, of which mode, centre of mass and inertia follow.
    Uniform(UniformPlate),
}

impl Plate {
    /// Returns the axis along which the plate extends.
    pub const fn axis(&self) -> PlateAxis {
        match self {
            Self::Axis(axis) => *axis,
            Self::Uniform(plate) => plate.along,
        }
    }
}

impl UniformPlate {
    /// Returns the centre of mass from the root (m).
    pub(super) fn centre(&self) -> Vector {
        self.direction() * (0.5 * self.length.get())
    }

    /// Returns the inertia tensor about the centre of mass for a mass (kg), in kg m².
    pub(super) fn inertia(&self, mass: f64) -> Matrix3<f64> {
        let (length, width) = (self.length.get(), self.width.get());
        let twelfth = mass / 12.0;
        let (bending, torsion) = (twelfth * length * length, twelfth * width * width);
        let moments = match self.along {
            PlateAxis::X => Vector::new(torsion, bending, bending + torsion),
            PlateAxis::Y => Vector::new(bending, torsion, bending + torsion),
        };
        Matrix3::from_diagonal(&moments)
    }

    /// Returns the first bending mode for a mass (kg), with its shape at points.
    pub(super) fn mode(&self, mass: f64, points: &[NamedPoint]) -> ClampedMode {
        let root = f64::sqrt(mass);
        let number = |value: f64| Finite::new(value).unwrap_or_default();
        let three = |v: Vector| [v.x, v.y, v.z].map(number);
        let mut mode = ClampedMode::from_frequency(self.frequency);
        mode.damping = self.damping;
        mode.translation[2] = number(2.0 * RATIO / ROOT * root);
        // Integral of r phi' dm: of the position along the plate and the displacement along z.
        let mut moments = <[[Finite; 3]; 3]>::default();
        moments[self.row()][2] = number(2.0 / (ROOT * ROOT) * root * self.length.get());
        mode.moments = Some(moments);
        for point in points {
            let position = vector(&point.position);
            let along = position[self.row()] / self.length.get();
            let [displacement, slope] = shape(along);
            let rotation = self.direction().cross(&Vector::z()) * (slope / (root * self.length.get()));
            let height = Vector::z() * position.z;
            let moved = Vector::z() * (displacement / root) + rotation.cross(&height);
            mode.shapes
                .insert(point.name.clone(), Shape { translation: three(moved), rotation: three(rotation) });
        }
        mode
    }

    /// Checks that a point is on the plate, at any height above it.
    ///
    /// # Errors
    /// The key of the position, and the reason.
    pub(super) fn carries(&self, position: &[Finite; 3]) -> Result<(), ConfigError> {
        let at = vector(position);
        let (length, width) = (self.length.get(), self.width.get());
        let (along, across) = (at[self.row()], at[1 - self.row()]);
        let (end, side) = (length * (1.0 + ROUNDING), 0.5 * width * (1.0 + ROUNDING));
        if (length - end..=end).contains(&along) && across.abs() <= side {
            return Ok(());
        }
        let names = ["x", "y"];
        let why = format!(
            "must be on the plate, with {} of 0 to {length} m and {} of -{2} to {2} m, got [{3}, {4}, {5}]",
            names[self.row()],
            names[1 - self.row()],
            0.5 * width,
            at.x,
            at.y,
            at.z
        );
        Err(ConfigError::new("position", why))
    }

    /// Returns the index of the axis along which it extends.
    const fn row(&self) -> usize {
        match self.along {
            PlateAxis::X => 0,
            PlateAxis::Y => 1,
        }
    }

    fn direction(&self) -> Vector {
        match self.along {
            PlateAxis::X => Vector::x(),
            PlateAxis::Y => Vector::y(),
        }
    }
}

/// Returns the first shape of a uniform cantilever of length and mass 1 at the fraction `along` of its length, and its
/// slope: cosh x - cos x - s (sinh x - sin x) with x = b `along`, by its power series.
fn shape(along: f64) -> [f64; 2] {
    let x = ROOT * along;
    let fourth = (x * x) * (x * x);
    // x/1!, whose successors are x²/2!, x³/3!, x⁵/5! and so on.
    let mut power = x;
    let (mut displacement, mut slope) = (0.0, 0.0);
    for term in 0..TERMS {
        let order = f64::from(4 * term);
        let square = power * x / (order + 2.0);
        let cube = square * x / (order + 3.0);
        displacement += square - RATIO * cube;
        slope += power - RATIO * square;
        power *= fourth / ((order + 2.0) * (order + 3.0) * (order + 4.0) * (order + 5.0));
    }
    [2.0 * displacement, 2.0 * ROOT * slope]
}

impl<'de> Deserialize<'de> for Plate {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_any(AxisOrSize)
    }
}

struct AxisOrSize;

impl<'de> Visitor<'de> for AxisOrSize {
    type Value = Plate;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("\"x\", \"y\", or { length = ..., width = ..., frequency = ... } of a uniform panel")
    }

    fn visit_str<E: Error>(self, axis: &str) -> Result<Plate, E> {
        PlateAxis::deserialize(StrDeserializer::new(axis)).map(Plate::Axis)
    }

    fn visit_map<A: MapAccess<'de>>(self, map: A) -> Result<Plate, A::Error> {
        UniformPlate::deserialize(MapAccessDeserializer::new(map)).map(Plate::Uniform)
    }
}

impl JsonSchema for Plate {
    fn schema_name() -> std::borrow::Cow<'static, str> {
        "PlateForm".into()
    }

    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        let (axis, size) =
            (generator.subschema_for::<PlateAxis>(), generator.subschema_for::<UniformPlate>());
        json_schema!({
            "description": "The axis of a plate, or a uniform panel by its size and first frequency",
            "anyOf": [axis, size]
        })
    }
}
