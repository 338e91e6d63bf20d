//! Reaction wheels about their own axes, which together give a torque about three axes and store its momentum.

use flexsc_dynamics::three_axis::Bearing;
use flexsc_dynamics::three_axis_model::ThreeAxisModel;
use flexsc_formats::count::counted;
use flexsc_formats::document::ConfigError;
use flexsc_numerics::attitude::Vector;
use flexsc_numerics::quantity::{Finite, NonNegative, Positive, Time};
use flexsc_spacecraft::body::craft::HubRotor;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::failure::{ActiveFailures, FailureScope};
use super::imbalance::TurningLoad;
use super::per_wheel::PerWheel;
use super::unloading::WheelUnloading;
use super::wheel_allocation::{Allocation, AllocationCriterion};
use super::{
    Actuator, ActuatorAuthority, ActuatorPlacement, ActuatorSpec, AxisActuatorContext, CommandResponse,
    FailingComponent, Failure, Friction, Ideal, Imbalance, WheelsState,
};
use crate::offers::{ActuatorOffers, ActuatorPlace, Offers, TorqueLimit};
use crate::requirement::{ROTATION, Requirements};

/// Reaction wheels, identical except for their axes and initial speeds.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Wheels {
    /// Arrangement of the wheels; default: given by `axes`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub arrangement: Option<Arrangement>,
    /// For a pyramid: angle of each axis above the xy plane (rad); default: 0.6155 rad, which gives equal torques about all
    /// three axes.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub cant: Option<Finite>,
    /// Axis of each wheel in the body's axes, of any length.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub axes: Vec<[Finite; 3]>,
    /// Moment of inertia of each wheel about its axis (kg m²). The inertia tensor of a `[body.spatial]` excludes
    /// it; that of a `[spacecraft]` includes the locked wheels.
    pub inertia: Positive,
    /// Point of the structure that carries each wheel, such as one of an appendage with a `mount`: one name for all wheels, or one
    /// for each. The rotor acts there, with the whole rate of the point. Default: all are on the hub.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub points: Option<PerWheel<String>>,
    /// Largest torque of each motor (N m); no limit by default. If a demanded torque exceeds it, the whole torque is scaled
    /// down and keeps its axis.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub torque: Option<Positive>,
    /// Largest momentum of each wheel about its axis (N m s), beyond which its motor cannot accelerate it; no limit by default.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub momentum: Option<Positive>,
    /// Largest speed of each wheel (rad/s), beyond which its motor cannot accelerate it; no limit by default.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub speed_limit: Option<Positive>,
    /// Time from a command of the law to the torques of the motors (s), as computation and data bus take it.
    #[serde(default, skip_serializing_if = "is_immediate")]
    pub delay: Time,
    /// Speed of each wheel at the start, relative to the body (rad/s); default: 0.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub speeds: Vec<Finite>,
    /// Friction of the bearings; none by default.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub friction: Option<Box<Friction>>,
    /// Friction that the drives assume and compensate within `torque`, from the true or measured wheel speeds; none
    /// by default.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub compensation: Option<Box<FrictionCompensation>>,
    /// Imbalance of the wheels; none by default.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub imbalance: Option<Box<Imbalance>>,
    /// How the demanded torque is distributed over the wheels.
    #[serde(default)]
    pub allocation: AllocationCriterion,
    /// For four wheels: a bias speed, maintained by torques that cancel each other; none by default.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub speed_bias: Option<SpeedBias>,
    /// Unloading by jets or magnetorquers; none by default.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub unloading: Option<Box<WheelUnloading>>,
    /// Intervals in which the motors fail: all, or the `wheel` of a number from 1.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub faults: Vec<Failure>,
}

#[expect(clippy::trivially_copy_pass_by_ref, reason = "serde asks for a reference")]
fn is_immediate(delay: &Time) -> bool {
    *delay == Time::default()
}

/// Rotor of a wheel that turns with a point of the structure.
#[derive(Clone, Debug, PartialEq)]
pub struct CarriedRotor {
    /// Index of the wheel.
    pub wheel: usize,
    /// Axis, and inertia about it.
    pub rotor: HubRotor,
    /// Speed at the start (rad/s).
    pub speed: f64,
    /// Rotation of the point per unit of each mode (rad/(m sqrt(kg))).
    pub rotations: Vec<Vector>,
}

/// Friction of the wheels as the drives model it.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(rename = "Compensation")]
pub struct FrictionCompensation {
    /// Coulomb friction (N m): one number for all wheels, or one for each.
    #[serde(default)]
    pub coulomb: PerWheel<NonNegative>,
    /// Viscous friction (N m s/rad): one number for all wheels, or one for each.
    #[serde(default)]
    pub viscous: PerWheel<NonNegative>,
}

/// Arrangement of wheels.
#[derive(Copy, Clone, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Arrangement {
    /// One each about x, y and z.
    Orthogonal,
    /// Four wheels with axes midway between x and y as seen along z, canted towards z.
    Pyramid,
}

/// A bias speed of four wheels, two in one direction and two in the other, in addition to what the torque requires.
#[derive(Copy, Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct SpeedBias {
    /// Bias speed (rad/s): that of the wheel with the largest part in the null vector of the axes, and of all four
    /// in a pyramid, two in each direction.
    pub speed: Finite,
    /// Gain with which the wheels are brought to the bias speed (1/s).
    pub gain: Positive,
}

/// Cant of a pyramid with equal torques about all axes: atan(1/sqrt(2)) (rad).
const EQUAL_CANT: f64 = 0.615_479_708_670_387_3;

impl ActuatorSpec for Wheels {
    fn start(&self, settings: &[AxisActuatorContext], on: &ActuatorPlacement<'_>) -> Box<dyn Actuator> {
        let Some(allocation) = on.wheels else { return Ideal::default().start(settings, on) };
        Box::new(WheelsState::new(self, allocation, settings).with_tachometer(on.tachometer))
    }

    fn authority(&self, axis: usize, inertia: f64, on: &ActuatorPlacement<'_>) -> ActuatorAuthority {
        let limit = self.torque.map_or(f64::INFINITY, Positive::get);
        let most = on.wheels.map_or(f64::INFINITY, |wheels| wheels.largest_torque(axis, limit));
        ActuatorAuthority { delay: self.delay.get(), ..ActuatorAuthority::constant(most / inertia) }
    }

    fn offers(&self) -> ActuatorOffers {
        let limit = self.torque.map_or(TorqueLimit::Unlimited, |_| TorqueLimit::Constant);
        ActuatorOffers {
            has_single_precision: true,
            limits: [limit; 3],
            is_delayed: self.delay.get() > 0.0,
            has_reaction_wheels: true,
            wheels: self.directions().map_or(0, |axes| axes.len()),
            has_wheel_speeds: true,
            ..ActuatorOffers::default()
        }
    }

    fn requires(&self, place: &ActuatorPlace<'_>, offers: &Offers, needs: &mut Requirements) {
        needs.require_axes(
            offers.body.axes == 3,
            "",
            "are for three axes: use `[actuator.wheel]` for a body with one angle",
        );
        place.require_single(needs, "write all wheels in one `wheels`, by their `axes`");
        if let Some(key) = self.bearing_key() {
            needs.require(offers.body.is_two_way, key, ROTATION);
        }
        if self.points.is_some() {
            let why = "needs appendages that do not turn, on drives or hinges";
            needs.require(!offers.body.turns_appendages, "points", why);
            let why =
                "needs bearings that do not stick: leave out `friction`, or have viscous friction alone";
            needs.require(self.friction_or_imbalance_key() != Some("friction"), "points", why);
        }
        if offers.body.turns_appendages
            && let Some(key) = self.friction_or_imbalance_key()
        {
            let why = "needs appendages that do not turn, on drives or hinges: the instants at which wheels stick, and the excitation of modes by \
                       imbalance, are searched for with constant modes";
            needs.require(false, key, why);
        }
    }

    fn failures(&self) -> &[Failure] {
        &self.faults
    }

    fn failing_components(&self, _: usize) -> FailingComponent {
        FailingComponent::Wheels(self.count())
    }

    fn command_response(&self) -> Option<CommandResponse> {
        Some(CommandResponse { gain: 1.0, delay: self.delay.get() })
    }
}

impl Wheels {
    /// Returns the number of wheels.
    pub fn count(&self) -> usize {
        match self.arrangement {
            Some(Arrangement::Orthogonal) => 3,
            Some(Arrangement::Pyramid) => 4,
            None => self.axes.len(),
        }
    }

    /// Returns the failures of a wheel, if it has any.
    pub(super) fn wheel_failures(&self, wheel: usize) -> Option<ActiveFailures> {
        let own =
            |scope: &FailureScope<'_>| scope.wheel.is_none_or(|number| number.get() as usize == wheel + 1);
        ActiveFailures::new(&self.faults, own)
    }

    /// Returns the initial speed (rad/s) of each of `count` wheels.
    pub fn speeds(&self, count: usize) -> Vec<f64> {
        (0..count).map(|wheel| self.speeds.get(wheel).map_or(0.0, |speed| speed.get())).collect()
    }

    /// Checks all keys and returns the allocation of a torque to the wheels.
    ///
    /// # Errors
    /// A `ConfigError` with a key that does not fit the others and the reason.
    pub fn allocation(&self) -> Result<Allocation, ConfigError> {
        let axes = self.directions()?;
        let count = axes.len();
        if self.allocation == AllocationCriterion::LeastLargest && count > 4 {
            let why = format!("must be `pseudo_inverse` for more than four wheels, got {count}");
            return Err(ConfigError::new("allocation", why));
        }
        let why = "must span all three axes: the given ones lie in a plane, or nearly so";
        let allocation = Allocation::new(&axes, self.allocation)
            .ok_or_else(|| ConfigError::new(if self.axes.is_empty() { "cant" } else { "axes" }, why))?;
        if !self.speeds.is_empty() && self.speeds.len() != count {
            let why =
                format!("must be one for each of {}, got {}", counted(count, "wheel"), self.speeds.len());
            return Err(ConfigError::new("speeds", why));
        }
        if let Some((wheel, speed)) = self.beyond_limits(&self.speeds(count)) {
            let why = format!("must be within `speed_limit` and `momentum`, got {speed}");
            return Err(ConfigError::new(format!("speeds[{wheel}]"), why));
        }
        if self.speed_bias.is_some() && allocation.null_vector().is_none() {
            let why =
                format!("needs four wheels, whose torques can cancel each other in one way, got {count}");
            return Err(ConfigError::new("speed_bias", why));
        }
        if let Some(friction) = &self.friction {
            friction.validate(count).map_err(|fault| fault.within("friction"))?;
            friction
                .check_of((self.inertia.get(), self.torque.map(Positive::get)), count)
                .map_err(|fault| fault.within("friction"))?;
        }
        if let Some(compensation) = &self.compensation {
            let FrictionCompensation { coulomb, viscous } = &**compensation;
            let checked = coulomb
                .validate_count("coulomb", count)
                .and_then(|()| viscous.validate_count("viscous", count));
            checked.map_err(|fault| fault.within("compensation"))?;
        }
        if let Some(points) = &self.points {
            points.validate_count("points", count)?;
        }
        if let Some(imbalance) = &self.imbalance {
            imbalance.check(count).map_err(|fault| fault.within("imbalance"))?;
            if self.points.is_some() && imbalance.point.is_some() {
                let why = "must be left out: the wheels are at their `points`";
                return Err(ConfigError::new("imbalance.point", why));
            }
        }
        Ok(allocation)
    }

    /// Returns the key by which a wheel's motion depends on that of the body: friction, imbalance, the points that carry wheels, or `None`.
    pub fn bearing_key(&self) -> Option<&'static str> {
        match (&self.friction, &self.imbalance) {
            (Some(_), _) => Some("friction"),
            (None, Some(_)) => Some("imbalance"),
            (None, None) => self.points.as_ref().map(|_| "points"),
        }
    }

    /// Returns the key by which wheels can stick or vibrate the body: friction, imbalance, or `None`.
    pub fn friction_or_imbalance_key(&self) -> Option<&'static str> {
        let wheels = self.rotors().map_or(0, |rotors| rotors.len());
        let grips = self
            .friction
            .as_ref()
            .is_some_and(|friction| (0..wheels).any(|wheel| friction.breakaway_torque(wheel) > 0.0));
        if grips { Some("friction") } else { self.imbalance.as_ref().map(|_| "imbalance") }
    }

    /// Returns the largest initial speed or bias speed (rad/s).
    pub fn largest_initial_speed(&self) -> f64 {
        let bias = self.speed_bias.map_or(0.0, |bias| bias.speed.get().abs());
        self.speeds.iter().map(|speed| speed.get().abs()).fold(bias, f64::max)
    }

    /// Returns the largest speed (rad/s) of a wheel on a body at rest, by the limits of its speed and its momentum; `None` without
    /// a limit.
    pub fn speed_bound(&self) -> Option<f64> {
        let full = self.momentum.map(|momentum| momentum.get() / self.inertia.get());
        self.speed_limit.map(Positive::get).into_iter().chain(full).reduce(f64::min)
    }

    /// Returns the bearings of the wheels on a body.
    ///
    /// # Errors
    /// A `ConfigError` with a key within the wheels and the reason.
    pub fn bearings(&self, body: &ThreeAxisModel) -> Result<Vec<Bearing>, ConfigError> {
        let carried = self.carried_rotors(body)?;
        let hub = body.coupling.as_ref().map_or(&[][..], |coupling| &coupling.rotations);
        let loads = self.turning_loads(body)?;
        let bearing = |(wheel, rotor): (usize, HubRotor)| {
            let friction = self.friction.as_ref();
            let (point, loads) = &loads[wheel];
            Bearing {
                inertia: rotor.spin_inertia,
                viscous: friction.map_or(0.0, |friction| friction.viscous.for_wheel(wheel).get()),
                coulomb: friction.map_or(0.0, |friction| friction.coulomb.for_wheel(wheel).get()),
                breakaway: friction.map_or(0.0, |friction| friction.breakaway_torque(wheel)),
                lines: loads.iter().map(|load| load.line(point, body)).collect(),
                tilts: carried.iter().find(|own| own.wheel == wheel).map_or_else(Vec::new, |own| {
                    own.rotations.iter().zip(hub).map(|(rotation, hub)| rotation - hub).collect()
                }),
            }
        };
        Ok(self.rotors()?.into_iter().enumerate().map(bearing).collect())
    }

    /// Returns the loads of the imbalance of each wheel, with the point at which they act.
    ///
    /// # Errors
    /// A `ConfigError` with a key within the wheels and the reason.
    pub fn turning_loads(
        &self,
        body: &ThreeAxisModel,
    ) -> Result<Vec<(String, Vec<TurningLoad>)>, ConfigError> {
        let loads = |(wheel, rotor): (usize, &HubRotor)| {
            let Some(imbalance) = &self.imbalance else { return Ok((String::new(), Vec::new())) };
            let carrier = self.points.as_ref().map(|points| points.for_wheel(wheel));
            let point =
                imbalance.point(carrier.as_deref(), body).map_err(|fault| fault.within("imbalance"))?;
            Ok((point.to_owned(), imbalance.turning_loads(wheel, rotor)))
        };
        self.rotors()?.iter().enumerate().map(loads).collect()
    }

    /// Returns the rotors of the wheels.
    ///
    /// # Errors
    /// A `ConfigError` with a key that does not fit the others and the reason.
    pub fn rotors(&self) -> Result<Vec<HubRotor>, ConfigError> {
        let spin_inertia = self.inertia.get();
        Ok(self.directions()?.into_iter().map(|axis| HubRotor { axis, spin_inertia }).collect())
    }

    /// Returns the rotors that turn with a point of the structure other than the hub.
    ///
    /// # Errors
    /// A `ConfigError` with a key within the wheels and the reason.
    pub fn carried_rotors(&self, body: &ThreeAxisModel) -> Result<Vec<CarriedRotor>, ConfigError> {
        let Some(points) = &self.points else { return Ok(Vec::new()) };
        let rotors = self.rotors()?;
        let speeds = self.speeds(rotors.len());
        let hub = body.coupling.as_ref().map_or(&[][..], |coupling| &coupling.rotations);
        let mut carried = Vec::new();
        for (wheel, rotor) in rotors.into_iter().enumerate() {
            let name = points.for_wheel(wheel);
            if body.point(&name).is_none() {
                let key = match points {
                    PerWheel::All(_) => "points".to_owned(),
                    PerWheel::Each(_) => format!("points[{wheel}]"),
                };
                let why = format!("must be one of the body's points, {}, got `{name}`", body.point_names());
                return Err(ConfigError::new(key, why));
            }
            let rotations: Vec<Vector> =
                body.shapes(&name).into_iter().map(|(_, rotation)| rotation).collect();
            if rotations != hub {
                carried.push(CarriedRotor { wheel, rotor, speed: speeds[wheel], rotations });
            }
        }
        Ok(carried)
    }

    /// Returns the unit axes of the wheels.
    fn directions(&self) -> Result<Vec<Vector>, ConfigError> {
        let Some(arrangement) = self.arrangement else {
            return self.explicit_axes();
        };
        if !self.axes.is_empty() {
            return Err(ConfigError::new("axes", "must be left out with an `arrangement`"));
        }
        if arrangement == Arrangement::Orthogonal {
            let why = "applies only to a pyramid: leave it out";
            let straight = vec![Vector::x(), Vector::y(), Vector::z()];
            return if self.cant.is_some() { Err(ConfigError::new("cant", why)) } else { Ok(straight) };
        }
        let (up, across) = libm::sincos(self.cant.map_or(EQUAL_CANT, Finite::get));
        let part = across * std::f64::consts::FRAC_1_SQRT_2;
        let signs = [[1.0, 1.0], [-1.0, 1.0], [-1.0, -1.0], [1.0, -1.0]];
        Ok(signs.map(|[x, y]| Vector::new(x * part, y * part, up)).to_vec())
    }

    fn explicit_axes(&self) -> Result<Vec<Vector>, ConfigError> {
        if self.axes.is_empty() {
            return Err(ConfigError::new("axes", "must be given without an `arrangement`"));
        }
        if self.cant.is_some() {
            return Err(ConfigError::new("cant", "applies only to an `arrangement`, and none is given"));
        }
        let unit = |(index, axis): (usize, &[Finite; 3])| {
            let axis = Vector::from(axis.map(Finite::get));
            let length = axis.norm();
            let why = || ConfigError::new(format!("axes[{index}]"), "must not be zero, got [0, 0, 0]");
            if length > 0.0 { Ok(axis / length) } else { Err(why()) }
        };
        self.axes.iter().enumerate().map(unit).collect()
    }

    /// Returns the first wheel whose initial speed exceeds a limit, with that speed.
    fn beyond_limits(&self, speeds: &[f64]) -> Option<(usize, f64)> {
        let most = self.speed_limit.map_or(f64::INFINITY, Positive::get);
        let momentum = self.momentum.map_or(f64::INFINITY, Positive::get);
        let is_beyond = |speed: f64| speed.abs() > most || speed.abs() * self.inertia.get() > momentum;
        speeds.iter().copied().enumerate().find(|(_, speed)| is_beyond(*speed))
    }
}
