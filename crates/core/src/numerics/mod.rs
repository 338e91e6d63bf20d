//! Numbers: special functions, quadrature, integration, roots. Nothing here knows a spacecraft.

pub(crate) mod biquad;
pub mod delay_margin;
pub mod elliptic;
pub mod exponential;
pub(crate) mod extrapolation;
pub(crate) mod gauss_legendre;
pub(crate) mod normal;
pub mod phasor;
pub(crate) mod phi;
pub(crate) mod polynomial;
pub(crate) mod polynomials;
pub(crate) mod quadrature;
pub(crate) mod simplex;
pub(crate) mod stumpff;
pub mod swing_integral;
pub(crate) mod swing_series;
pub(crate) mod trig;
