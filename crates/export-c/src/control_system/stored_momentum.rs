//! Momentum stored in the rotors, as laws, conditions of modes and the unloading of wheels read it.

use flexsc_core::Scenario;
use flexsc_core::control::flight_quantity::FlightQuantity;
use flexsc_flight::vector3::Vector3;
use flexsc_flight::wheel_momentum;

use super::Channel;
use super::actuation::wheel_inertia;

/// Origin of the stored momentum.
#[derive(Clone, Debug, PartialEq)]
pub enum StoredMomentum {
    /// No rotors: it is 0.
    None,
    /// Speeds of reaction wheels, which are inputs, and the estimated rate.
    Wheels {
        /// Axes of the wheels.
        axes: Vec<Vector3>,
        /// Moment of inertia of each wheel about its axis (kg m²).
        inertia: f64,
    },
    /// Input: the momentum of control moment gyros, whose steering is not part of the code.
    Input,
}

impl StoredMomentum {
    /// Returns the stored momentum of a scenario's rotors.
    pub(super) fn new(scenario: &Scenario) -> Self {
        let members = scenario.actuator.members();
        let mut executing = members.iter().filter(|member| member.executes()).map(|member| &*member.kind);
        if executing.clone().any(|kind| kind.offers().turns_with_gimbals) {
            return Self::Input;
        }
        let inertia = executing.find_map(wheel_inertia);
        match scenario.study.wheels.as_ref().zip(inertia) {
            Some((wheels, inertia)) => Self::Wheels { axes: wheels.flight_axes().to_vec(), inertia },
            None => Self::None,
        }
    }

    /// Returns the number of wheels whose speeds are inputs.
    pub fn wheel_count(&self) -> usize {
        if let Self::Wheels { axes, .. } = self { axes.len() } else { 0 }
    }

    /// Returns the inputs from which it follows, apart from the estimated rate; random momenta have this typical size (N m s).
    pub(super) fn channel(&self, scale: f64) -> Option<Channel> {
        match self {
            Self::None => None,
            Self::Wheels { axes, .. } => {
                Some(Channel::from_quantity(FlightQuantity::WheelSpeed, axes.len(), 100.0))
            }
            Self::Input => Some(Channel::from_quantity(FlightQuantity::StoredMomentum, 3, scale)),
        }
    }

    /// Returns the momentum (N m s) for these numbers of its input, and the estimated rate (rad/s).
    pub(super) fn momentum(&self, given: &[f64], rate: &Vector3) -> Vector3 {
        match (self, given) {
            (Self::Wheels { axes, inertia }, _) if given.len() >= axes.len() => {
                wheel_momentum::stored(axes, *inertia, given, rate)
            }
            (Self::Input, [x, y, z]) => Vector3 { x: *x, y: *y, z: *z },
            _ => Vector3::ZERO,
        }
    }
}
