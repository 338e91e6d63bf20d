//! Control moment gyros: rotors of constant speed, each in a gimbal whose rate produces the torque.

use flexsc_formats::count::counted;
use flexsc_formats::document::ConfigError;
use flexsc_numerics::attitude::Vector;
use flexsc_numerics::quantity::{Finite, Positive};
use flexsc_numerics::time::Span;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::failure::{ActiveFailures, FailureScope};
use super::steering::{self, GyroAxes, NullMotion, Robustness, Steering};
use super::{
    Actuator, ActuatorAuthority, ActuatorPlacement, ActuatorSpec, AxisActuatorContext,
    ControlMomentGyrosState, FailingComponent, Failure,
};
use crate::offers::{ActuatorOffers, ActuatorPlace, Offers, TorqueLimit};
use crate::requirement::Requirements;

/// Single-gimbal control moment gyros, identical except for their axes and gimbal angles.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ControlMomentGyros {
    /// Arrangement; default: given by `gimbal_axes` and `spin_axes`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub arrangement: Option<GimbalArrangement>,
    /// For a pyramid: angle of each gimbal axis from z (rad); default: 0.9553 rad (54.74 degrees), with about equal momentum in all
    /// directions.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub cant: Option<Finite>,
    /// Gimbal axis of each in the body's axes, of any length.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub gimbal_axes: Vec<[Finite; 3]>,
    /// Direction of the momentum of each with its gimbal at angle 0, of any length, at right angles to its gimbal axis.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub spin_axes: Vec<[Finite; 3]>,
    /// Angular momentum of each rotor, which is constant (N m s).
    pub momentum: Positive,
    /// Gimbal angles at the start (rad); default: 0.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub angles: Vec<Finite>,
    /// Largest gimbal rate (rad/s); no limit by default. If a demanded torque exceeds it, all rates are scaled down, and the torque
    /// keeps its axis.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub rate_limit: Option<Positive>,
    /// Time between updates of the gimbal rates, beside those at the law's commands (s); default: at these alone.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub period: Option<Span>,
    /// How the demanded torque becomes gimbal rates.
    #[serde(default)]
    pub steering: Steering,
    /// The weight of `singularity_robust` steering.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub robust: Option<Robustness>,
    /// Null motion towards preferred gimbal angles; none by default.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub null_motion: Option<Box<NullMotion>>,
    /// Intervals in which the gimbal rates fail: of all, or of the `gimbal` of a number from 1.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub faults: Vec<Failure>,
}

/// Arrangement of control moment gyros.
#[derive(Copy, Clone, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum GimbalArrangement {
    /// Four whose gimbal axes are normal to the faces of a pyramid: towards x, y, -x and -y, canted from z.
    Pyramid,
}

/// Default cant of a pyramid: atan(sqrt(2)) (rad).
const EQUAL_CANT: f64 = 0.955_316_618_124_509_3;

/// Largest cosine between a gimbal axis and its spin axis.
const SQUARE: f64 = 1e-6;

/// Sum of squared areas between gimbal axes below which they count as parallel.
const PARALLEL: f64 = 1e-9;

impl ActuatorSpec for ControlMomentGyros {
    fn start(&self, settings: &[AxisActuatorContext], on: &ActuatorPlacement<'_>) -> Box<dyn Actuator> {
        Box::new(ControlMomentGyrosState::new(self, on.gimbals, settings))
    }

    /// Returns the authority at the initial gimbal angles.
    fn authority(&self, axis: usize, inertia: f64, on: &ActuatorPlacement<'_>) -> ActuatorAuthority {
        ActuatorAuthority::constant(self.largest_torque(on.gimbals, axis) / inertia)
    }

    fn offers(&self) -> ActuatorOffers {
        ActuatorOffers {
            limits: [TorqueLimit::Varying; 3],
            turns_with_gimbals: true,
            ..ActuatorOffers::default()
        }
    }

    fn requires(&self, place: &ActuatorPlace<'_>, offers: &Offers, needs: &mut Requirements) {
        needs.require_axes(
            offers.body.axes == 3,
            "",
            "turn a body about three axes, and the body has one angle: use `[actuator.wheel]`",
        );
        place
            .require_single(needs, "write all of them in one `control_moment_gyros`, by their `gimbal_axes`");
        needs.require(
            self.period.is_some() || !offers.laws.iter().any(|law| law.offers.finds_crossings),
            "period",
            "must be given with a law `relay`, which holds its torque: gimbals at constant rates turn theirs",
        );
        needs.require(
            offers.body.is_two_way,
            "",
            "are for a `[spacecraft]`, which needs no appendages: the modes of a `[body.spatial]` are pushed by \
             torques that are constant for a while, and gimbals turn theirs",
        );
    }

    fn failures(&self) -> &[Failure] {
        &self.faults
    }

    fn failing_components(&self, _: usize) -> FailingComponent {
        FailingComponent::Gimbals(self.count())
    }
}

impl ControlMomentGyros {
    /// Returns the number of control moment gyros.
    pub fn count(&self) -> usize {
        match self.arrangement {
            Some(GimbalArrangement::Pyramid) => 4,
            None => self.gimbal_axes.len(),
        }
    }

    /// Returns the gimbal angles at the start (rad).
    pub(super) fn initial_angles(&self) -> Vec<f64> {
        (0..self.count()).map(|gyro| self.angles.get(gyro).map_or(0.0, |angle| angle.get())).collect()
    }

    /// Returns the weight of singularity-robust steering, if it is used.
    pub(super) fn steering_weight(&self) -> Option<Robustness> {
        (self.steering == Steering::SingularityRobust).then(|| self.robust.unwrap_or_default())
    }

    /// Returns the failures of a gimbal, if it has any.
    pub(super) fn gimbal_failures(&self, gyro: usize) -> Option<ActiveFailures> {
        let own =
            |scope: &FailureScope<'_>| scope.gimbal.is_none_or(|number| number.get() as usize == gyro + 1);
        ActiveFailures::new(&self.faults, own)
    }

    /// Returns the largest torque about a single axis at the initial gimbal angles (N m).
    pub fn largest_torque(&self, axes: &[GyroAxes], axis: usize) -> f64 {
        let limit = self.rate_limit.map_or(f64::INFINITY, Positive::get);
        let unit_torque = Vector::from_fn(|row, _| if row == axis { 1.0 } else { 0.0 });
        let rates = steering::gimbal_rates(
            &steering::torque_directions(axes, &self.initial_angles()),
            None,
            &unit_torque,
            0.0,
        );
        let largest = rates.into_iter().map(f64::abs).fold(0.0, f64::max);
        if largest > 0.0 { self.momentum.get() * limit / largest } else { 0.0 }
    }

    /// Checks all keys and returns the axes of each gyro.
    ///
    /// # Errors
    /// A `ConfigError` with a key that does not fit the others and the reason.
    pub fn axes(&self) -> Result<Vec<GyroAxes>, ConfigError> {
        let axes = self.directions()?;
        let count = axes.len();
        let each = |key: &str, given_count: usize| {
            let why = format!(
                "must be one for each of {}, got {given_count}",
                counted(count, "control moment gyro")
            );
            if given_count == count { Ok(()) } else { Err(ConfigError::new(key, why)) }
        };
        if !self.angles.is_empty() {
            each("angles", self.angles.len())?;
        }
        if let Some(null) = &self.null_motion {
            if count < 4 {
                let why = format!(
                    "needs four control moment gyros or more, whose torques can cancel each other, got {count}"
                );
                return Err(ConfigError::new("null_motion", why));
            }
            each("null_motion.angles", null.angles.len())?;
        }
        if let Some(robust) = &self.robust {
            if self.steering == Steering::PseudoInverse {
                let why = "applies only to `steering = \"singularity_robust\"`: leave it out";
                return Err(ConfigError::new("robust", why));
            }
            let dither = robust.dither.get();
            if dither >= 0.5 {
                return Err(ConfigError::new("robust.dither", format!("must be below 0.5, got {dither}")));
            }
        }
        Ok(axes)
    }

    fn directions(&self) -> Result<Vec<GyroAxes>, ConfigError> {
        let Some(GimbalArrangement::Pyramid) = self.arrangement else { return self.explicit_axes() };
        for (key, axes) in [("gimbal_axes", &self.gimbal_axes), ("spin_axes", &self.spin_axes)] {
            if !axes.is_empty() {
                return Err(ConfigError::new(key, "must be left out with an `arrangement`"));
            }
        }
        let (sin, cos) = libm::sincos(self.cant.map_or(EQUAL_CANT, Finite::get));
        if sin * sin < PARALLEL {
            let why = format!(
                "must tilt the gimbal axes away from each other, got {} rad: they are parallel, or nearly so",
                self.cant.map_or(EQUAL_CANT, Finite::get)
            );
            return Err(ConfigError::new("cant", why));
        }
        let faces = [[1.0, 0.0], [0.0, 1.0], [-1.0, 0.0], [0.0, -1.0]];
        Ok(faces
            .map(|[x, y]| GyroAxes {
                spin: Vector::new(-y, x, 0.0),
                across: Vector::new(-cos * x, -cos * y, sin),
            })
            .to_vec())
    }

    fn explicit_axes(&self) -> Result<Vec<GyroAxes>, ConfigError> {
        let refused = |key: &str, why: String| Err(ConfigError::new(key, why));
        if self.cant.is_some() {
            return refused("cant", "applies only to an `arrangement`, and none is given".to_owned());
        }
        let count = self.gimbal_axes.len();
        if count < 3 {
            let why = format!("must be three or more without an `arrangement`, got {count}");
            return refused("gimbal_axes", why);
        }
        if self.spin_axes.len() != count {
            let why = format!("must be one for each of {count} `gimbal_axes`, got {}", self.spin_axes.len());
            return refused("spin_axes", why);
        }
        let unit = |key: &str, index: usize, axis: &[Finite; 3]| {
            let axis = Vector::from(axis.map(Finite::get));
            let length = axis.norm();
            let why = || ConfigError::new(format!("{key}[{index}]"), "must not be zero, got [0, 0, 0]");
            if length > 0.0 && length.is_finite() { Ok(axis / length) } else { Err(why()) }
        };
        let (mut axes, mut gimbals) = (Vec::with_capacity(count), Vec::with_capacity(count));
        for (index, (gimbal, spin)) in self.gimbal_axes.iter().zip(&self.spin_axes).enumerate() {
            let (gimbal, spin) = (unit("gimbal_axes", index, gimbal)?, unit("spin_axes", index, spin)?);
            let along = gimbal.dot(&spin);
            if along.abs() > SQUARE {
                let angle = libm::acos(along).to_degrees();
                let why = format!("must be at right angles to its gimbal axis, got {angle:.6} degrees");
                return refused(&format!("spin_axes[{index}]"), why);
            }
            let across = gimbal.cross(&spin).normalize();
            axes.push(GyroAxes { spin: across.cross(&gimbal).normalize(), across });
            gimbals.push(gimbal);
        }
        let apart: f64 = gimbals.iter().map(|gimbal| gimbals[0].cross(gimbal).norm_squared()).sum();
        if apart < PARALLEL {
            let why = "must not all be parallel, or nearly so: the torques would lie in a plane".to_owned();
            return refused("gimbal_axes", why);
        }
        Ok(axes)
    }

    /// Returns the largest expected gimbal rate (rad/s): the limit, or 0 without one.
    pub fn largest_gimbal_rate(&self) -> f64 {
        self.rate_limit.map_or(0.0, Positive::get)
    }

    /// Returns preferred angles (rad) and gain (1/s) of the null motion, if it is used.
    pub(super) fn null_motion(&self) -> Option<(Vec<f64>, f64)> {
        let null = self.null_motion.as_deref()?;
        Some((null.angles.iter().map(|angle| angle.get()).collect(), null.gain.get()))
    }
}
