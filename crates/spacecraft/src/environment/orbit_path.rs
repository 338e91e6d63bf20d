//! The orbit of a run, by Kepler elements or by positions at instants.

use std::sync::Arc;

use flexsc_numerics::attitude::Vector;
use flexsc_numerics::time_arcs::SplitTime;

use super::{Kepler, OrbitPosition, SampledOrbit};

/// Orbit of a run.
#[derive(Clone, Debug, PartialEq)]
pub enum OrbitPath {
    /// Kepler elements, which may drift.
    Kepler(Kepler),
    /// Positions at instants.
    Sampled(Arc<SampledOrbit>),
}

/// Declares functions that every kind of orbit has.
macro_rules! of_each {
    ($($(#[doc = $doc:literal])+ $name:ident($($argument:ident: $kind:ty),*) -> $returned:ty;)+) => {
        impl OrbitPath {
            $(
                $(#[doc = $doc])+
                pub fn $name(&self $(, $argument: $kind)*) -> $returned {
                    match self {
                        Self::Kepler(orbit) => orbit.$name($($argument),*),
                        Self::Sampled(orbit) => orbit.$name($($argument),*),
                    }
                }
            )+
        }
    };
}

of_each! {
    /// Returns the position on the orbit at a time since the start (s).
    at(t: f64) -> OrbitPosition;
    /// Returns position (m), velocity, acceleration and its rate of change in inertial axes at a time since the start (s).
    motion(t: f64) -> [Vector; 4];
    /// Returns a lower bound of the distance from the planet's centre (m).
    nearest() -> f64;
    /// Returns an upper bound of the distance from the planet's centre (m).
    farthest() -> f64;
    /// Returns an upper bound of the rate of the local axes (rad/s).
    fastest() -> f64;
    /// Returns an upper bound of the speed (m/s).
    largest_speed() -> f64;
    /// Returns an upper bound of the rate of the velocity's direction (rad/s).
    fastest_velocity() -> f64;
    /// Returns an upper bound of the rate of the orbit's normal (rad/s).
    plane_rate() -> f64;
}

impl OrbitPath {
    /// Returns position (m) and velocity in inertial axes at a time since the start.
    pub(super) fn state(&self, t: SplitTime) -> [Vector; 2] {
        match self {
            Self::Kepler(orbit) => {
                let place = orbit.place(t);
                [place.position, place.velocity]
            }
            Self::Sampled(orbit) => {
                let [position, velocity, ..] = orbit.motion_at(t);
                [position, velocity]
            }
        }
    }

    /// Returns the gravitational parameter of the planet (m³/s²).
    pub fn gravity(&self) -> f64 {
        match self {
            Self::Kepler(orbit) => orbit.gravity.get(),
            Self::Sampled(orbit) => orbit.gravity(),
        }
    }

    /// Returns the radius of the planet (m).
    pub fn planet_radius(&self) -> f64 {
        match self {
            Self::Kepler(orbit) => orbit.planet_radius.get(),
            Self::Sampled(orbit) => orbit.planet_radius(),
        }
    }

    /// Returns the orbit's normal with its first two derivatives in inertial axes at a time since the start (s); the length
    /// is any.
    pub(super) fn normal_motion(&self, t: f64) -> [Vector; 3] {
        if let Self::Kepler(orbit) = self
            && orbit.drifts()
        {
            return orbit.normal_motion(t);
        }
        let [position, velocity, acceleration, jerk] = self.motion(t);
        let change = velocity.cross(&acceleration) + position.cross(&jerk);
        [position.cross(&velocity), position.cross(&acceleration), change]
    }
}
