//! Numbers side by side: arithmetic that is written once, for one run and for many in lanes.

mod real;

pub use real::Real;
