//! Length of arcs on which polynomials are proved to have an error below 1e-15: of the position relative to the semi-major
//! axis, and of the magnetic field relative to its largest value on the orbit.
//!
//! The interpolant of degree N at the Chebyshev nodes errs by at most 4 M p^-N/(p - 1), where M bounds the function on the
//! ellipse with the sum p of half-axes about the arc; there the imaginary part of the time is at most b = (L/4) (p - 1/p). With
//! the rate n of the mean anomaly, |Im E| is at most the least root y of y - e sinh y = n b, and |r.r| at least the square of
//! R = a (1 - e cosh y). The planet's axis, node and perigee turn by imaginary angles of their rates times b.

use flexsc_numerics::time_arcs::DEGREE;

use super::Kepler;
use super::magnetic_field::PlanetField;

/// Error that is accepted.
const ERROR: f64 = 1e-15;

/// Length of the shortest arc (s), whose error is bounded on any orbit that takes more than some seconds.
const SHORTEST: f64 = 1.0 / 1024.0;

/// Length of the longest arc (s).
pub(super) const LONGEST: f64 = 8192.0;

impl Kepler {
    /// Returns the length of the arcs (s), a power of two: the longest with a bound of the error below 1e-15.
    pub(super) fn arc_length(&self, field: Option<&PlanetField>) -> f64 {
        // The real bound of the field is about twice its largest value.
        let largest = field.map_or(0.0, |field| 0.5 * field.bound(self.nearest()));
        let holds = |length: f64| {
            let [position, magnetic] = self.arc_errors(field, length);
            position <= ERROR * self.semi_major_axis.get() && magnetic <= ERROR * largest
        };
        let mut length = LONGEST;
        while length > SHORTEST && !holds(length) {
            length *= 0.5;
        }
        length
    }

    /// Returns bounds of the errors of position (m) and field (T) on arcs of a length (s).
    pub(super) fn arc_errors(&self, field: Option<&PlanetField>, length: f64) -> [f64; 2] {
        let mut least = [f64::INFINITY, if field.is_some() { f64::INFINITY } else { 0.0 }];
        let mut sum = 1.1;
        for _ in 0..40 {
            sum *= 1.15;
            let Some(sizes) = self.complex_sizes(field, 0.25 * length * (sum - 1.0 / sum)) else { break };
            let factor = 4.0 / (libm::pow(sum, DEGREE as f64) * (sum - 1.0));
            for (least, size) in least.iter_mut().zip(sizes) {
                *least = least.min(factor * size);
            }
        }
        least
    }

    /// Returns bounds of the sizes of position (m) and field (T) where the imaginary part of the time is at most `b` (s); `None`
    /// where there may be a singularity.
    fn complex_sizes(&self, field: Option<&PlanetField>, b: f64) -> Option<[f64; 2]> {
        let (a, e) = (self.semi_major_axis.get(), self.eccentricity.get());
        let y = imaginary_anomaly(self.anomaly_rate() * b, e)?;
        let (sinh, cosh) = (libm::sinh(y), libm::cosh(y));
        let nearest = 1.0 - e * cosh;
        if nearest <= 0.0 || !cosh.is_finite() {
            return None;
        }
        let turn = self.plane_rate() * b;
        let ahead = (cosh + e) * (cosh + e) + sinh * sinh;
        let position = a * f64::sqrt(ahead) * libm::exp(turn);
        let magnetic = field.map_or(0.0, |field| {
            let spin = field.rotation.abs() * b;
            let wide = 1.0 + 2.0 * (1.0 - e * e) * (sinh / nearest) * (sinh / nearest);
            let stretch = wide * libm::exp(2.0 * (turn + spin));
            field.complex_bound(a * nearest, stretch) * libm::exp(spin)
        });
        Some([position, magnetic])
    }
}

/// Returns the least root y of y - e sinh y = mean; `None` if there is none.
fn imaginary_anomaly(mean: f64, e: f64) -> Option<f64> {
    let mut y = mean;
    // The left side is concave and rises to its maximum: Newton's method approaches the root from below.
    for _ in 0..100 {
        let slope = 1.0 - e * libm::cosh(y);
        if slope <= 0.0 {
            return None;
        }
        let step = (mean - (y - e * libm::sinh(y))) / slope;
        y += step;
        if step.abs() <= 1e-12 * y {
            return Some(y);
        }
    }
    None
}
