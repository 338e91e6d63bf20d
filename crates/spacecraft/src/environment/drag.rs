//! Drag of the atmosphere on plates, as a torque: the orbit does not change (\[Wertz78\]).
//!
//! On a plate of area A and outward normal n that moves at v relative to the air, the force is -rho/2 C A (n.v) v where
//! n.v > 0, and zero otherwise: a plate with two sides is two plates. The atmosphere turns with the planet.

use flexsc_formats::document::ConfigError;
use flexsc_numerics::attitude::{Vector, vector};
use flexsc_numerics::quantity::{Finite, Positive};
use nalgebra::Quaternion;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::orbit::to_body;
use super::{Kepler, OrbitPosition};

/// Drag of the atmosphere.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Drag {
    /// Density at a distance of the orbit's semi-major axis (kg/m³).
    pub density: Positive,
    /// Scale height, in which the density falls to 1/e (m); default: the density is uniform.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub scale_height: Option<Positive>,
    /// Drag coefficient.
    #[serde(default = "coefficient")]
    pub coefficient: Positive,
    /// Rotation rate of the atmosphere with the planet (rad/s); default: the Earth's.
    #[serde(default = "rotation")]
    pub rotation: Finite,
    /// The plates.
    pub plates: Vec<DragPlate>,
}

/// A plate; drag acts on one side of it.
#[derive(Copy, Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(rename = "Plate")]
pub struct DragPlate {
    /// Area (m²).
    pub area: Positive,
    /// Outward normal in the body's axes, of any length.
    pub normal: [Finite; 3],
    /// Position of its centre (m): from the point O of a spacecraft, or from the centre of mass of a spatial body.
    pub at: [Finite; 3],
}

fn coefficient() -> Positive {
    Positive::new(2.2).unwrap_or(Positive::ONE)
}

fn rotation() -> Finite {
    Finite::new(7.292_115e-5).unwrap_or_default()
}

impl Drag {
    /// Returns an inconsistency between values: a key within the drag, and the reason.
    pub(super) fn fault(&self, on_orbit: bool) -> Option<ConfigError> {
        if !on_orbit {
            return Some(ConfigError::new("", "needs an `orbit`, and there is none"));
        }
        let flat = |plate: &DragPlate| plate.normal.iter().all(|part| part.get() == 0.0);
        let index = self.plates.iter().position(flat)?;
        Some(ConfigError::new(format!("plates[{index}].normal"), "must not be zero, got [0, 0, 0]"))
    }

    /// Returns the density at a distance from the planet's centre (m), in kg/m³.
    fn density_at(&self, distance: f64, orbit: &Kepler) -> f64 {
        let above = distance - orbit.semi_major_axis.get();
        let fallen = self.scale_height.map_or(1.0, |height| libm::exp(-above / height.get()));
        self.density.get() * fallen
    }

    /// Returns the torque about the centre of mass `centre` (m) on a body of the given attitude, in its axes (N m).
    pub(super) fn torque(
        &self,
        orbit: &Kepler,
        place: &OrbitPosition,
        attitude: &Quaternion<f64>,
        centre: &Vector,
    ) -> Vector {
        let carried = Vector::z().cross(&place.position) * self.rotation.get();
        let flow = to_body(attitude, &(place.velocity - carried));
        let factor = -0.5 * self.coefficient.get() * self.density_at(place.position.norm(), orbit);
        self.plates.iter().fold(Vector::zeros(), |sum, plate| {
            let projected_area = vector(&plate.normal).normalize().dot(&flow).max(0.0) * plate.area.get();
            sum + (vector(&plate.at) - centre).cross(&flow) * (factor * projected_area)
        })
    }

    /// Returns an upper bound of the torque (N m).
    pub(super) fn bound(&self, orbit: &Kepler, centre: &Vector) -> f64 {
        let nearest = orbit.nearest();
        let speed = nearest * (orbit.fastest() + self.rotation.get().abs());
        let factor = 0.5 * self.coefficient.get() * self.density_at(nearest, orbit) * speed * speed;
        let arm = |plate: &DragPlate| plate.area.get() * (vector(&plate.at) - centre).norm();
        factor * self.plates.iter().map(arm).sum::<f64>()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use flexsc_numerics::attitude::rotation as turned;

    #[test]
    fn a_plate_is_pushed_back_where_it_meets_the_flow() {
        // Without rotation of the atmosphere: rho/2 C A v² at the plate's arm.
        let orbit: Kepler = flexsc_formats::document::from_text("semi_major_axis = 6.8e6").unwrap();
        let drag: Drag = flexsc_formats::document::from_text(
            "density = 4e-12\nscale_height = 6e4\nrotation = 0\nplates = [{ area = 2.0, normal = [0, 3, 0], at = [0.1, 0, 0.5] }]",
        )
        .unwrap();
        assert_eq!(drag.fault(true), None);
        // At the start the body is on the inertial x axis and moves along y.
        let place = orbit.at(0.0);
        let centre = Vector::new(0.1, 0.0, 0.0);
        let speed = f64::sqrt(3.986_004_418e14 / 6.8e6);
        let force = 0.5 * 4e-12 * 2.2 * 2.0 * speed * speed;
        let torque = |by: Vector| drag.torque(&orbit, &place, &turned(&by), &centre);
        assert!((torque(Vector::zeros()) - Vector::new(0.5 * force, 0.0, 0.0)).norm() < 1e-12 * force);
        assert!(torque(Vector::zeros()).norm() <= drag.bound(&orbit, &centre) * (1.0 + 1e-12));
        // Turned by 60 degrees about z the plate meets half of the flow; by more than 90 degrees, none.
        let third = torque(Vector::new(0.0, 0.0, std::f64::consts::FRAC_PI_3));
        assert!((third.norm() - 0.25 * force).abs() < 1e-12 * force, "{third}");
        assert_eq!(torque(Vector::new(0.0, 0.0, 2.0)), Vector::zeros());
        // An atmosphere that turns with the planet changes the relative flow.
        let carried = Drag { rotation: Finite::new(1e-4).unwrap(), ..drag.clone() };
        let slower = carried.torque(&orbit, &place, &turned(&Vector::zeros()), &centre).x / (0.5 * force);
        assert!((slower - libm::pow(1.0 - 680.0 / speed, 2.0)).abs() < 1e-12, "{slower}");
        assert!((drag.density_at(6.86e6, &orbit) / 4e-12 - libm::exp(-1.0)).abs() < 1e-15);
        assert_eq!(drag.fault(false).unwrap().key, "");
    }
}
