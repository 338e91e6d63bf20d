//! How a body moves between events.

pub mod linear;
