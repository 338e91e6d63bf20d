//! The magnetic field of a planet: a dipole through its centre, tilted against its axis, that turns with it
//! (\[Wertz78\]).

use flexsc_numerics::attitude::Vector;
use flexsc_numerics::quantity::{Finite, Positive};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::date::greenwich;

/// A tilted dipole: B = (a/R)³ (3 (g.r) r - g) with r the direction from the planet's centre and g, which points south.
#[derive(Copy, Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct MagneticField {
    /// Coefficients g11, h11 and g10 of the field (T), a vector in axes that rotate with the planet: z along its axis, x
    /// through its prime meridian; default: the Earth's from IGRF-13 for 2020.
    pub coefficients: [Finite; 3],
    /// Reference radius a of the coefficients (m); default: the Earth's mean radius.
    pub radius: Positive,
    /// Rotation rate of the planet (rad/s); default: the Earth's.
    pub rotation: Finite,
    /// Angle from the inertial x to the prime meridian at the start (rad); default: that of Greenwich at the scenario's `epoch`, 0
    /// without one.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub meridian: Option<Finite>,
}

impl Default for MagneticField {
    /// Returns the field of the Earth.
    fn default() -> Self {
        Self {
            coefficients: [-1450.9e-9, 4652.5e-9, -29_404.8e-9].map(|t| Finite::new(t).unwrap_or_default()),
            radius: Positive::new(6_371_200.0).unwrap_or(Positive::ONE),
            rotation: Finite::new(7.292_115e-5).unwrap_or_default(),
            meridian: None,
        }
    }
}

impl MagneticField {
    /// Returns the field with its meridian, for a scenario that begins `epoch_ns` nanoseconds after 1970, UTC.
    #[must_use]
    pub fn at_epoch(mut self, epoch_ns: u64) -> Self {
        self.meridian = self.meridian.or_else(|| Finite::new(greenwich(epoch_ns)));
        self
    }

    /// Returns the field (T) at a position from the planet's centre (m), both in inertial axes, at a time since the
    /// start (s).
    pub fn at(&self, position: &Vector, t: f64) -> Vector {
        let [x, y, z] = self.coefficients.map(Finite::get);
        let (sin, cos) = libm::sincos(self.meridian.unwrap_or_default().get() + self.rotation.get() * t);
        let south = Vector::new(cos * x - sin * y, sin * x + cos * y, z);
        let distance = position.norm();
        let (up, ratio) = (position / distance, self.radius.get() / distance);
        (up * (3.0 * south.dot(&up)) - south) * (ratio * ratio * ratio)
    }

    /// Returns an upper bound of the field (T) at this distance from the centre (m) and beyond.
    pub fn bound(&self, distance: f64) -> f64 {
        let ratio = self.radius.get() / distance;
        2.0 * Vector::from(self.coefficients.map(Finite::get)).norm() * ratio * ratio * ratio
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::environment::Kepler;

    #[test]
    fn without_a_tilt_it_is_that_of_the_local_axes() {
        // Expected field: b (cos u sin i, -cos i, 2 sin u sin i) in local axes, at the angle u past the ascending node.
        let field: MagneticField =
            flexsc_formats::document::from_text("coefficients = [0, 0, -3e-5]\nradius = 6.4e6").unwrap();
        let (inclination, radius) = (0.9, 7e6);
        let orbit: Kepler = flexsc_formats::document::from_text(&format!(
            "semi_major_axis = {radius}\ninclination = {inclination}\nnode = 0.4\nperigee = 0.3\nanomaly = 0.2"
        ))
        .unwrap();
        let strength = 3e-5 * libm::pow(6.4e6 / radius, 3.0);
        let (across, along) = libm::sincos(inclination);
        for t in [0.0, 500.0, 4000.0] {
            let place = orbit.at(t);
            let (sin, cos) = libm::sincos(0.5 + orbit.mean_motion() * t);
            let exact = Vector::new(cos * across, -along, 2.0 * sin * across) * strength;
            let found = field.at(&place.position, t);
            let local = Vector::from(place.local.map(|axis| axis.dot(&found)));
            assert!((local - exact).norm() < 1e-13 * strength, "{t} {local} {exact}");
            assert!(found.norm() <= field.bound(radius));
        }
    }

    #[test]
    fn with_a_date_its_meridian_is_that_of_greenwich_unless_it_is_a_key() {
        let field = MagneticField::default().at_epoch(1_774_017_960_000_000_000);
        let same = MagneticField { meridian: Finite::new(0.691_984_659), ..MagneticField::default() };
        let position = Vector::new(7e6, -1e6, 2e6);
        assert!((field.at(&position, 900.0) - same.at(&position, 900.0)).norm() < 1e-13);
        assert_eq!(same.at_epoch(1_774_017_960_000_000_000), same);
    }

    #[test]
    fn the_earths_is_29_8_microtesla_over_its_magnetic_equator_and_turns_with_it() {
        let field = MagneticField::default();
        let axis = Vector::from(field.coefficients.map(Finite::get)).normalize();
        let across = axis.cross(&Vector::x()).normalize() * 6_371_200.0;
        assert!(
            (field.at(&across, 0.0).norm() - 29_805.924e-9).abs() < 1e-12,
            "{}",
            field.at(&across, 0.0).norm()
        );
        assert!((field.at(&(axis * 6_371_200.0), 0.0).norm() - 2.0 * 29_805.924e-9).abs() < 2e-12);
        // The dipole is tilted by 9.4 degrees against the axis.
        assert!((libm::acos(-axis.z) - 0.164).abs() < 1e-3);
        let position = Vector::new(7e6, -1e6, 2e6);
        let quarter = std::f64::consts::FRAC_PI_2 / 7.292_115e-5;
        let rotated = Vector::new(1e6, 7e6, 2e6);
        let [before, after] = [field.at(&position, 0.0), field.at(&rotated, quarter)];
        assert!((Vector::new(-before.y, before.x, before.z) - after).norm() < 1e-18);
    }
}
