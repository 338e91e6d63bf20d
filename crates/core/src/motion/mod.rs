//! How a body moves between events.

pub mod linear;
pub mod turning;
