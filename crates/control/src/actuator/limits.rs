//! Limits of actuators: which wheel, magnetorquer, jet or gimbal is at a limit at the start of a control cycle.

use flexsc_numerics::attitude::AXES;
use flexsc_numerics::quantity::Positive;
use flexsc_numerics::time::Span;
use flexsc_record::{Magnetorquers, Report, Wheels};

use super::control_moment_gyros_state::gimbal_rate;
use super::{AssignedActuator, JetCycle};
use crate::one_or_many::OneOrMany;

/// A value is at its limit if it misses it by this part of it.
const AT_LIMIT: f64 = 1e-3;

/// Kind of limit, in the order of the metrics.
#[derive(Copy, Clone, Debug, PartialEq, Eq)]
pub enum LimitKind {
    /// Torque of the motor of a wheel.
    Torque,
    /// Momentum or speed of a wheel.
    Momentum,
    /// Moment of a magnetorquer.
    Moment,
    /// Time in each period for which jets are on.
    OnTime,
    /// Rate of the gimbals of control moment gyros.
    GimbalRate,
}

impl LimitKind {
    /// All kinds, in their order.
    pub const ALL: [Self; 5] = [Self::Torque, Self::Momentum, Self::Moment, Self::OnTime, Self::GimbalRate];
}

/// Quantity of an actuator that has a limit, with the index of the wheel, axis or thruster.
#[derive(Copy, Clone, Debug, PartialEq, Eq)]
enum LimitedQuantity {
    WheelTorque(usize),
    WheelMomentum(usize),
    WheelSpeed(usize),
    Moment(usize),
    GroupOnTime(usize),
    ThrusterOnTime(usize),
    GimbalRate,
}

/// Limit of a quantity of an actuator.
#[derive(Clone, Debug)]
pub struct ActuatorLimit {
    quantity: LimitedQuantity,
    /// Largest size, in the unit of the quantity.
    limit: f64,
    /// Description of the actuator at this limit: `wheel 3 at its speed limit`.
    name: String,
}

impl ActuatorLimit {
    /// Returns the kind of the limit.
    pub fn kind(&self) -> LimitKind {
        match self.quantity {
            LimitedQuantity::WheelTorque(_) => LimitKind::Torque,
            LimitedQuantity::WheelMomentum(_) | LimitedQuantity::WheelSpeed(_) => LimitKind::Momentum,
            LimitedQuantity::Moment(_) => LimitKind::Moment,
            LimitedQuantity::GroupOnTime(_) | LimitedQuantity::ThrusterOnTime(_) => LimitKind::OnTime,
            LimitedQuantity::GimbalRate => LimitKind::GimbalRate,
        }
    }

    /// Returns the index of the wheel, if it is the limit of one.
    pub fn wheel(&self) -> Option<usize> {
        match self.quantity {
            LimitedQuantity::WheelTorque(wheel)
            | LimitedQuantity::WheelMomentum(wheel)
            | LimitedQuantity::WheelSpeed(wheel) => Some(wheel),
            _ => None,
        }
    }

    /// Returns the description of the actuator at this limit: `wheel 3 at its speed limit`.
    pub fn name(&self) -> &str {
        &self.name
    }
}

/// Limits of the actuators of a body, and which of them are reached.
#[derive(Clone, Debug, Default)]
pub struct ActuatorLimits {
    limits: Vec<ActuatorLimit>,
    /// For each limit the sign of the quantity that is at it; 0 for one that is not.
    reached: Vec<f64>,
}

impl ActuatorLimits {
    /// Returns the limits of these actuators, under a law of this period.
    pub fn new(actuators: &OneOrMany<AssignedActuator>, law_period: Option<Span>) -> Self {
        let mut limits = Vec::new();
        let mut add = |quantity, limit: Option<f64>, name: String| {
            limits.extend(limit.map(|limit| ActuatorLimit { quantity, limit, name }));
        };
        if let Some((wheels, _)) = actuators.wheels() {
            for index in 0..wheels.count() {
                let name = |limit: &str| format!("wheel {} at its {limit} limit", index + 1);
                let size = |limit: Option<Positive>| limit.map(Positive::get);
                add(LimitedQuantity::WheelTorque(index), size(wheels.torque), name("torque"));
                add(LimitedQuantity::WheelMomentum(index), size(wheels.momentum), name("momentum"));
                add(LimitedQuantity::WheelSpeed(index), size(wheels.speed_limit), name("speed"));
            }
        }
        if let Some((torquers, _)) = actuators.magnetorquers() {
            for (axis, letter) in ["x", "y", "z"].into_iter().enumerate() {
                let moment = torquers.moment.about(axis).get();
                let name = format!("magnetorquer {letter} at its largest moment");
                add(LimitedQuantity::Moment(axis), Some(moment), name);
            }
        }
        if let Some((jets, _)) = actuators.jets() {
            let period = jets.period.or(law_period).map(Span::seconds);
            for (axis, about) in AXES.into_iter().enumerate() {
                let name = format!("jets about {about} on all the time");
                add(LimitedQuantity::GroupOnTime(axis), period.filter(|_| jets.groups.is_some()), name);
            }
            for (index, thruster) in jets.names().into_iter().enumerate() {
                let name = format!("thruster {thruster} on all the time");
                add(LimitedQuantity::ThrusterOnTime(index), period.filter(|_| jets.groups.is_none()), name);
            }
        }
        if let Some((gyros, _)) = actuators.control_moment_gyros() {
            let limit = gyros.rate_limit.map(Positive::get);
            add(LimitedQuantity::GimbalRate, limit, "gimbals at their rate limit".to_owned());
        }
        Self { reached: vec![0.0; limits.len()], limits }
    }

    /// Returns true if there is no limit.
    pub fn is_empty(&self) -> bool {
        self.limits.is_empty()
    }

    /// Returns the number of limits.
    pub fn count(&self) -> usize {
        self.limits.len()
    }

    /// Returns true if there is a limit of this kind.
    pub fn has(&self, kind: LimitKind) -> bool {
        self.limits.iter().any(|limit| limit.kind() == kind)
    }

    /// Returns the description of the actuator at a limit, by its index: `wheel 3 at its speed limit`.
    pub fn name(&self, index: usize) -> &str {
        self.limits.get(index).map_or("", ActuatorLimit::name)
    }

    /// Observes the actuators in the report of a control cycle.
    pub fn observe(&mut self, report: &Report) {
        let wheels = report.get().map_or(&[][..], |row: &Wheels| &row.wheels);
        let torquers = report.get().map_or(&[][..], |row: &Magnetorquers| &row.axes);
        let jets: Option<&JetCycle> = report.get();
        for (reached, ActuatorLimit { quantity, limit, .. }) in self.reached.iter_mut().zip(&self.limits) {
            let value = match *quantity {
                LimitedQuantity::WheelTorque(index) => wheels.get(index).map(|wheel| wheel.torque_nm),
                LimitedQuantity::WheelMomentum(index) => wheels.get(index).map(|wheel| wheel.momentum_nm_s),
                LimitedQuantity::WheelSpeed(index) => wheels.get(index).map(|wheel| wheel.speed_rad_s),
                LimitedQuantity::Moment(axis) => torquers.get(axis).map(|torquer| torquer.moment_am2),
                LimitedQuantity::GroupOnTime(axis) => jets.map(|jets| jets.on[axis]),
                LimitedQuantity::ThrusterOnTime(index) => jets.and_then(|jets| jets.each.get(index).copied()),
                LimitedQuantity::GimbalRate => gimbal_rate(report),
            };
            let value = value.unwrap_or(0.0);
            *reached = if value.abs() >= limit * (1.0 - AT_LIMIT) { value.signum() } else { 0.0 };
        }
    }

    /// Iterates over the limits that were reached in the last cycle: the index and the limit of each, and the sign of the
    /// quantity.
    pub fn reached(&self) -> impl Iterator<Item = (usize, &ActuatorLimit, f64)> {
        let each = self.limits.iter().zip(&self.reached).enumerate();
        each.filter(|(_, (_, sign))| **sign != 0.0).map(|(index, (limit, sign))| (index, limit, *sign))
    }
}
