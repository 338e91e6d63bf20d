//! Imbalance of wheels: forces and torques that rotate with them, and their harmonics.

use flexsc_dynamics::three_axis::HarmonicLine;
use flexsc_dynamics::three_axis_model::ThreeAxisModel;
use flexsc_formats::count::counted;
use flexsc_formats::document::ConfigError;
use flexsc_numerics::attitude::{Vector, vector};
use flexsc_numerics::quantity::{Finite, NonNegative, Positive};
use flexsc_spacecraft::body::craft::HubRotor;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::per_wheel::PerWheel;

/// Imbalance of wheels: forces and torques on the body at wheel speed Omega and angle th.
///
/// Each force and torque is its coefficient times Omega², along e1 cos(k th + phase) + e2 sin(k th + phase), where e1 is z x a of the
/// wheel's axis a, or x of one along z, and e2 is a x e1. The angle th begins at `angle`.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Imbalance {
    /// Static imbalance (kg m): the force across the axis once per turn is this times the square of the speed; one
    /// number for all wheels, or one for each.
    #[serde(default, rename = "static")]
    pub static_: PerWheel<NonNegative>,
    /// Dynamic imbalance (kg m²): the torque across the axis once per turn is this times the square of the speed;
    /// one number for all wheels, or one for each.
    #[serde(default)]
    pub dynamic: PerWheel<NonNegative>,
    /// Phase lead of the torque over the force (rad); one number for all wheels, or one for each.
    #[serde(default)]
    pub phase: PerWheel<Finite>,
    /// Angle of the rotor at the start (rad); one number for all wheels, or one for each: with equal angles, wheels
    /// that turn against each other cancel in part.
    #[serde(default, skip_serializing_if = "PerWheel::is_default")]
    pub angle: PerWheel<Finite>,
    /// Further harmonics of the speed, the same for all wheels.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub harmonics: Vec<Harmonic>,
    /// Point of the structure at which the wheels shake; default: `points` of the wheels, else the first of the body's points.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub point: Option<String>,
    /// Position of each wheel relative to that point (m); default: at the point.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub positions: Vec<[Finite; 3]>,
}

/// A harmonic of the imbalance.
#[derive(Copy, Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Harmonic {
    /// Order k: periods per turn of the wheel; it may be fractional.
    pub order: Positive,
    /// Force perpendicular to the axis over the square of the speed (kg m).
    #[serde(default)]
    pub force: NonNegative,
    /// Torque perpendicular to the axis over the square of the speed (kg m²).
    #[serde(default)]
    pub torque: NonNegative,
    /// Force along the axis per (rad/s)² (kg m), proportional to cos(k th + phase).
    #[serde(default)]
    pub axial: NonNegative,
    /// Phase of the harmonic (rad).
    #[serde(default)]
    pub phase: Finite,
}

impl Imbalance {
    /// Checks the values against the number of wheels.
    ///
    /// # Errors
    /// A `ConfigError` with a key within the imbalance and the reason.
    pub fn check(&self, wheels: usize) -> Result<(), ConfigError> {
        self.static_.validate_count("static", wheels)?;
        self.dynamic.validate_count("dynamic", wheels)?;
        self.phase.validate_count("phase", wheels)?;
        self.angle.validate_count("angle", wheels)?;
        if !self.positions.is_empty() && self.positions.len() != wheels {
            let why =
                format!("must be one for each of {}, got {}", counted(wheels, "wheel"), self.positions.len());
            return Err(ConfigError::new("positions", why));
        }
        Ok(())
    }

    /// Returns true if two wheels shake the body alike, but for their axes, from the start on at equal or opposite speeds.
    pub fn is_in_step(&self, one: usize, other: usize) -> bool {
        self.static_.for_wheel(one) == self.static_.for_wheel(other)
            && self.dynamic.for_wheel(one) == self.dynamic.for_wheel(other)
            && self.phase.for_wheel(one) == self.phase.for_wheel(other)
            && self.angle.for_wheel(one) == self.angle.for_wheel(other)
    }

    /// Returns the point of a body at which a wheel shakes: where it is mounted, else that of the imbalance.
    ///
    /// # Errors
    /// A `ConfigError` with a key within the imbalance and the reason.
    pub fn point<'a>(
        &'a self,
        carrier: Option<&'a str>,
        body: &'a ThreeAxisModel,
    ) -> Result<&'a str, ConfigError> {
        let first = body.points.first().map_or("", |point| point.name.as_str());
        let name = carrier.or(self.point.as_deref()).unwrap_or(first);
        if body.point(name).is_none() {
            let why = format!("must be one of the body's points, {}, got `{name}`", body.point_names());
            return Err(ConfigError::new("point", why));
        }
        Ok(name)
    }

    /// Returns the loads of a wheel at its point.
    pub fn turning_loads(&self, wheel: usize, rotor: &HubRotor) -> Vec<TurningLoad> {
        let offset = self.positions.get(wheel).map_or_else(Vector::zeros, vector);
        let load = |order: f64, force: [Vector; 2], moment: [Vector; 2]| {
            let moment = [0, 1].map(|part| moment[part] + offset.cross(&force[part]));
            TurningLoad { order, force, moment }
        };
        let (first, second) = across(&rotor.axis);
        // Coefficients of cos x and sin x in e1 cos(x + phase) + e2 sin(x + phase).
        let force_at = |phase: f64| {
            let (sin, cos) = libm::sincos(phase);
            [first * cos + second * sin, second * cos - first * sin]
        };
        let times = |vectors: [Vector; 2], by: f64| vectors.map(|part| part * by);
        let plus = |a: [Vector; 2], b: [Vector; 2]| [a[0] + b[0], a[1] + b[1]];
        let (force, torque) = (self.static_.for_wheel(wheel).get(), self.dynamic.for_wheel(wheel).get());
        let (phase, angle) = (self.phase.for_wheel(wheel).get(), self.angle.for_wheel(wheel).get());
        let mut loads = Vec::new();
        if force > 0.0 || torque > 0.0 {
            loads.push(load(1.0, times(force_at(angle), force), times(force_at(angle + phase), torque)));
        }
        for harmonic in &self.harmonics {
            let phase = harmonic.order.get() * angle + harmonic.phase.get();
            let (sin, cos) = libm::sincos(phase);
            let across = force_at(phase);
            let along = times([rotor.axis * cos, rotor.axis * -sin], harmonic.axial.get());
            let force = plus(times(across, harmonic.force.get()), along);
            loads.push(load(harmonic.order.get(), force, times(across, harmonic.torque.get())));
        }
        loads
    }
}

/// Load of a wheel at its point that turns with it: Omega² (c cos k psi + s sin k psi) with the order k and the angle psi of the rotor.
#[derive(Clone, Debug, PartialEq)]
pub struct TurningLoad {
    /// Order k: periods per turn.
    pub order: f64,
    /// Coefficients c and s of the force (kg m).
    pub force: [Vector; 2],
    /// Coefficients c and s of the moment about the point (kg m²).
    pub moment: [Vector; 2],
}

impl TurningLoad {
    /// Returns the load at a point of a body as its effect on the hub and the modes.
    pub fn line(&self, point: &str, body: &ThreeAxisModel) -> HarmonicLine {
        let Self { order, force, moment } = self;
        let place = body.point(point).unwrap_or_default();
        let torque = [0, 1].map(|part: usize| moment[part] + place.cross(&force[part]));
        let shapes = body.shapes(point);
        let hub = body.coupling.as_ref().map_or(&[][..], |coupling| &coupling.rotations);
        let beyond = |part: usize| -> Vec<f64> {
            let effect_of = |((translation, rotation), hub): (&(Vector, Vector), &Vector)| {
                translation.dot(&force[part]) + rotation.dot(&moment[part]) - hub.dot(&torque[part])
            };
            shapes.iter().zip(hub).map(effect_of).collect()
        };
        HarmonicLine { order: *order, torque, force: *force, forces: [beyond(0), beyond(1)] }
    }
}

/// Returns two unit vectors perpendicular to a wheel's axis, in the sense of its rotation.
fn across(axis: &Vector) -> (Vector, Vector) {
    let level = Vector::z().cross(axis);
    let first = if level.norm() > 1e-9 { level.normalize() } else { Vector::x() };
    (first, axis.cross(&first))
}
