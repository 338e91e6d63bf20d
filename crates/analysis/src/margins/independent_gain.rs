//! Disk margin of signals that are off independently of each other: a structured singular value.
//!
//! The structured singular value of a matrix M for complex factors, one on each signal, is at most the smallest largest
//! singular value of D M D^-1 over positive diagonal D, and equal to it for up to three signals \[PackardDoyle93\]. As a
//! function of ln D it is convex: ellipsoids with a subgradient find it.

use nalgebra::{Complex, DMatrix, DVector};

use super::frequency_response::largest_gain;

/// Largest |ln D|.
const WIDEST: f64 = 12.0;
/// Improvement, relative to the value, at which the search ends.
const TOLERANCE: f64 = 1e-13;
/// Largest number of ellipsoids, for each pair of signals.
const MOST_STEPS: usize = 200;

/// Returns the structured singular value of a matrix for independent complex factors, from above; at most `enough` is
/// returned as it is.
pub fn independent_gain(matrix: &DMatrix<Complex<f64>>, enough: f64) -> f64 {
    let free = matrix.nrows() - 1;
    let mut least = largest_gain(matrix);
    if free == 0 {
        return least;
    }
    let mut centre = DVector::<f64>::zeros(free);
    let mut shape = DMatrix::<f64>::identity(free, free) * (WIDEST * WIDEST * free as f64);
    for _ in 0..MOST_STEPS * free * (free + 1) {
        if least <= enough {
            return least;
        }
        let Some((value, slope)) = scaled_gain(matrix, &centre) else { return least };
        least = least.min(value);
        let along = &shape * &slope;
        let width = f64::sqrt(slope.dot(&along).max(0.0));
        // The value falls by at most the width within the ellipsoid.
        if width <= TOLERANCE * least {
            break;
        }
        let order = free as f64;
        let step = along / width;
        centre -= &step / (order + 1.0);
        shape = if free == 1 {
            shape * 0.25
        } else {
            (&shape - &step * step.transpose() * (2.0 / (order + 1.0)))
                * (order * order / (order * order - 1.0))
        };
    }
    least
}

/// Returns the largest singular value s of D M D^-1 with ln D = (0, x), and its slope in x: s (|u|² - |v|²) of its
/// singular vectors.
fn scaled_gain(matrix: &DMatrix<Complex<f64>>, x: &DVector<f64>) -> Option<(f64, DVector<f64>)> {
    let factor = |place: usize| if place == 0 { 1.0 } else { libm::exp(x[place - 1]) };
    let scaled = DMatrix::from_fn(matrix.nrows(), matrix.ncols(), |row, column| {
        matrix[(row, column)] * (factor(row) / factor(column))
    });
    let size = scaled.iter().map(Complex::norm_sqr).fold(0.0, f64::max);
    if !(size > 0.0 && size.is_finite()) {
        return None;
    }
    let size = f64::sqrt(size);
    let scaled = scaled.map(|entry| entry / size);
    let eigen = (scaled.adjoint() * &scaled).symmetric_eigen();
    let (place, square) = eigen.eigenvalues.argmax();
    let right = eigen.eigenvectors.column(place);
    let left = &scaled * right;
    let value = f64::sqrt(square.max(0.0));
    let slope = DVector::from_fn(x.len(), |place, _| {
        size * value * (left[place + 1].norm_sqr() / square - right[place + 1].norm_sqr())
    });
    Some((size * value, slope))
}

#[cfg(test)]
mod tests {
    use nalgebra::dmatrix;

    use super::*;

    fn real(matrix: &DMatrix<f64>) -> DMatrix<Complex<f64>> {
        matrix.map(|entry| Complex::new(entry, 0.0))
    }

    /// Of a triangular matrix, the value is the largest magnitude on the diagonal; of a matrix of rank one, the sum of the
    /// magnitudes there; of [[0, a], [b, 0]], the root of a b.
    #[test]
    fn values_in_closed_form() {
        for (matrix, expected) in [
            (dmatrix![0.5, 9.0; 0.0, -0.7], 0.7),
            (dmatrix![0.0, 4.0; 9.0, 0.0], 6.0),
            (dmatrix![1.0, 10.0, 100.0; 0.2, 2.0, 20.0; 0.03, 0.3, 3.0], 6.0),
            (dmatrix![3.0, 0.0; 0.0, 4.0], 4.0),
        ] {
            let found = independent_gain(&real(&matrix), 0.0);
            assert!((found / expected - 1.0).abs() < 1e-4, "{found} {expected}");
        }
    }

    /// No factors make more of the matrix: the spectral radius of U M over diagonal U of magnitude 1 is the value, for up to
    /// three signals.
    #[test]
    fn the_value_is_the_largest_spectral_radius() {
        let matrix = DMatrix::from_fn(3, 3, |row, column| {
            let place = (3 * row + column) as f64;
            Complex::new(libm::sin(1.0 + 2.3 * place), libm::cos(0.7 * place * place))
        });
        let found = independent_gain(&matrix, 0.0);
        let squared = |angles: [f64; 2]| {
            let turn = |angle: f64| Complex::new(libm::cos(angle), libm::sin(angle));
            let phases = [Complex::new(1.0, 0.0), turn(angles[0]), turn(angles[1])];
            let turned = DMatrix::from_fn(3, 3, |row, column| phases[row] * matrix[(row, column)]);
            let values = crate::eigenvalues::complex_eigenvalues(turned).expect("values");
            values.iter().map(Complex::norm_sqr).fold(0.0, f64::max)
        };
        // A grid over the circle, and finer ones about the best of it.
        let (mut largest, mut best, mut half_width) = (0.0_f64, [0.0; 2], std::f64::consts::PI);
        for _ in 0..3 {
            let place = |k: i32, centre: f64| centre + half_width * f64::from(k) / 20.0;
            let centre = best;
            for (a, b) in (-20..=20).flat_map(|a| (-20..=20).map(move |b| (a, b))) {
                let angles = [place(a, centre[0]), place(b, centre[1])];
                let found = squared(angles);
                if found > largest {
                    (largest, best) = (found, angles);
                }
            }
            half_width /= 10.0;
        }
        let largest = f64::sqrt(largest);
        assert!(largest <= found * (1.0 + 1e-12) && largest > found * (1.0 - 1e-4), "{largest} {found}");
        assert!(found < largest_gain(&matrix));
    }
}
