//! Phasors: complex numbers whose polar form uses the portable `libm`.

pub use nalgebra::Complex;

/// Complex number of doubles.
pub type Phasor = Complex<f64>;

/// Creates a phasor from its absolute value and argument (rad).
pub fn polar(abs: f64, arg: f64) -> Phasor {
    let (sin, cos) = libm::sincos(arg);
    Complex { re: abs * cos, im: abs * sin }
}

/// Returns the absolute value. The phasors of this crate are far from overflow and underflow.
#[inline]
pub fn abs(z: Phasor) -> f64 {
    f64::sqrt(z.re * z.re + z.im * z.im)
}

/// Returns the argument in (-pi, pi].
pub fn arg(z: Phasor) -> f64 {
    libm::atan2(z.im, z.re)
}
