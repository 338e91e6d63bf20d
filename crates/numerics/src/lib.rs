//! Numerical methods of flexsc, independent of spacecraft.
//!
//! - [`time`]: instants and spans in integer femtoseconds; [`random`]: named, seeded streams;
//! - [`quantity`]: numbers that are valid by construction; [`attitude`]: vectors, quaternions, rotations;
//! - [`lanes`]: the same arithmetic on many runs in SIMD lanes, equal to the bit;
//! - [`time_arcs`]: functions of time as polynomials on arcs;
//! - the other modules: special functions, quadrature, integration, roots.
//!
//! Names in brackets, such as \[Likins70\], are sources: `docs/references.md` lists them.

pub mod attitude;
pub mod biquad;
pub mod delay_margin;
pub mod elliptic;
pub mod enclosure;
pub mod exp_branch_free;
pub mod exponential;
pub mod extrapolation;
pub mod flight_types;
pub mod gauss_legendre;
pub mod inverse;
pub mod lanes;
pub mod normal;
pub mod order_statistics;
pub mod phasor;
pub mod phi;
pub mod polynomial;
pub mod polynomial_lanes;
pub mod quadrature;
pub mod quantity;
pub mod random;
pub mod scalar_search;
pub mod signal;
pub mod simplex;
pub mod swing_damped;
pub mod swing_integral;
pub mod swing_series;
pub mod time;
pub mod time_arcs;
pub mod trig;
