//! Friction in the bearings of wheels, and its compensation by the drives.

use flexsc_formats::document::ConfigError;
use flexsc_numerics::quantity::{NonNegative, shortest};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::per_wheel::PerWheel;

/// Largest ratio of the Coulomb friction to the torque of a motor, which is then stalled ...
const STALLS: f64 = 10.0;
/// ... and largest deceleration of a wheel by it (rad/s²), or the wheel would stop within a step of the motion.
const STOPS: f64 = 500.0;

/// Bearing friction: c Omega + t sgn Omega for a turning wheel, and up to the breakaway torque for a wheel at rest.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Friction {
    /// Coulomb friction t (N m), at most 10 times `torque` and 500 rad/s² times `inertia`: one number for all
    /// wheels, or one for each.
    #[serde(default)]
    pub coulomb: PerWheel<NonNegative>,
    /// Viscous friction c (N m s/rad): one number for all wheels, or one for each.
    #[serde(default)]
    pub viscous: PerWheel<NonNegative>,
    /// Torque up to which the bearing holds a wheel at rest (N m): one number for all wheels, or one for each;
    /// default: the Coulomb friction.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub breakaway: Option<PerWheel<NonNegative>>,
}

impl Friction {
    /// Returns the breakaway torque of a wheel's bearing (N m).
    pub fn breakaway_torque(&self, wheel: usize) -> f64 {
        self.breakaway
            .as_ref()
            .map_or(self.coulomb.for_wheel(wheel), |breakaway| breakaway.for_wheel(wheel))
            .get()
    }

    /// Checks the values against each other and the number of wheels.
    ///
    /// # Errors
    /// A `ConfigError` with a key within the friction and the reason.
    pub fn validate(&self, wheels: usize) -> Result<(), ConfigError> {
        self.coulomb.validate_count("coulomb", wheels)?;
        self.viscous.validate_count("viscous", wheels)?;
        if let Some(breakaway) = &self.breakaway {
            breakaway.validate_count("breakaway", wheels)?;
            for wheel in 0..wheels {
                let (coulomb, holds) = (self.coulomb.for_wheel(wheel).get(), self.breakaway_torque(wheel));
                if holds < coulomb {
                    let why = format!("must be at least `coulomb`, {coulomb} N m, got {holds}");
                    return Err(ConfigError::new("breakaway", why));
                }
            }
        }
        Ok(())
    }

    /// Checks the friction against the wheels' inertia (kg m²) and the largest torque of their motors (N m), if any.
    ///
    /// # Errors
    /// A key within the friction, and why.
    pub fn check_of(&self, (inertia, torque): (f64, Option<f64>), wheels: usize) -> Result<(), ConfigError> {
        for coulomb in (0..wheels).map(|wheel| self.coulomb.for_wheel(wheel).get()) {
            let why = match torque {
                Some(torque) if coulomb > STALLS * torque => {
                    format!(
                        "must be at most {STALLS} times the torque of the motor, {torque} N m, got {}",
                        shortest(coulomb)
                    )
                }
                _ if coulomb > STOPS * inertia => format!(
                    "must slow a wheel of {inertia} kg m\u{b2} by at most {STOPS} rad/s\u{b2}, got {}: is it in N m?",
                    shortest(coulomb)
                ),
                _ => continue,
            };
            return Err(ConfigError::new("coulomb", why));
        }
        Ok(())
    }
}
