//! Numerical methods, independent of spacecraft: special functions, quadrature, integration, roots.

pub mod biquad;
pub mod delay_margin;
pub mod elliptic;
pub mod exp_branch_free;
pub mod exponential;
pub mod extrapolation;
pub mod gauss_legendre;
pub mod normal;
pub mod phasor;
pub mod phi;
pub mod polynomial;
pub mod polynomial_lanes;
pub mod quadrature;
pub mod simplex;
pub mod stumpff;
pub mod swing_damped;
pub mod swing_integral;
pub mod swing_series;
pub mod trig;
