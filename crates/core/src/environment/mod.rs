//! The surroundings of a body with three axes: torques that depend on where it faces, and when.

mod around;
mod dipole;
mod gravity_gradient;
mod orbit;
mod solar_pressure;
#[cfg(test)]
mod tests;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::document::Fault;
use crate::quantity::Finite;
use crate::time::Instant;

pub use around::Around;
pub use dipole::Dipole;
pub use gravity_gradient::GravityGradient;
pub use solar_pressure::SolarPressure;

/// What surrounds a body with three axes. The torques add up.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Environment {
    /// Gravity gradient of a circular orbit.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub gravity_gradient: Option<GravityGradient>,
    /// Pressure of sunlight.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub solar_pressure: Option<SolarPressure>,
    /// A magnetic moment of the body in the field of its planet.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub dipole: Option<Dipole>,
    /// A torque that is constant in inertial axes (N m).
    #[serde(default)]
    pub torque: [Finite; 3],
}

impl Environment {
    /// The instants at which something begins or ends.
    pub fn edges(&self) -> impl Iterator<Item = Instant> {
        self.solar_pressure.iter().flat_map(SolarPressure::edges)
    }

    /// What single values cannot show to be wrong: a key within the environment, and why.
    pub fn fault(&self) -> Option<Fault> {
        let shadow = self.solar_pressure.as_ref().and_then(SolarPressure::fault);
        shadow.map(|fault| fault.within("solar_pressure")).or_else(|| {
            let (dipole, gradient) = (self.dipole.as_ref()?, self.gravity_gradient.as_ref()?);
            let (own, other) = (dipole.orbit_rate.get(), gradient.orbit_rate.get());
            if own != other {
                let why = format!("must be that of `gravity_gradient`, {other} rad/s, got {own}");
                return Some(Fault::new("dipole.orbit_rate", why));
            }
            (dipole.local != gradient.local)
                .then(|| Fault::new("dipole.local", "must be that of `gravity_gradient`: there is one orbit"))
        })
    }
}
