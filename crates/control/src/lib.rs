//! The control system of a spacecraft: from sensor measurements to actuator outputs.
//!
//! Each role is a trait: [`sensor::Sensor`], [`estimator::Estimator`], [`adaptation::AdaptationSpec`], [`law::Law`],
//! [`actuator::Actuator`]. Every part of a run is a [`part::Part`], which reports its own rows for the log. `docs/extending.md` describes how to add a kind.
//!
//! Names in brackets, such as \[Likins70\], are sources: `docs/references.md` lists them.

pub mod actuator;
pub mod adaptation;
pub mod custom;
pub mod disturbance;
pub mod drive_profile;
pub mod estimator;
pub mod flight_quantity;
pub mod guidance;
pub mod interval;
mod kinds;
pub mod law;
pub mod linear_block;
pub mod offers;
pub mod one_or_many;
pub mod operation;
pub mod orientation;
pub mod part;
pub mod quantity;
pub mod requirement;
pub mod robustness;
pub mod sensor;
pub mod state_estimate;
