//! Field of a potential in spherical harmonics, in Cartesian form (\[Cunningham70\]), which has no singularity at the
//! poles.
//!
//! V = a sum (a/r)^(n+1) (g cos(m phi) + h sin(m phi)) P(n, m), Schmidt semi-normalised, and B = -grad V. The functions
//! V(n, m) = (a/r)^(n+1) P cos(m phi), and W(n, m) with the sine, follow from recurrences in x, y, z and r² with P not
//! normalised, and the derivatives of those of degree n are those of degree n + 1.

use flexsc_numerics::attitude::Vector;

/// Highest degree of a model.
pub(super) const MOST_DEGREES: usize = 13;

/// Number of degrees and orders of the functions, of which the field takes one degree and order more than its
/// coefficients.
const SIZE: usize = MOST_DEGREES + 2;

/// Field of a planet in spherical harmonics, in axes that rotate with it.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct SphericalHarmonics {
    /// Reference radius of the coefficients (m).
    radius: f64,
    /// Coefficients \[g, h\] for functions that are not normalised (T), by degree from 1 and order from 0.
    coefficients: Vec<Vec<[f64; 2]>>,
    /// Upper bound of the field of each degree at the reference radius (T).
    bounds: Vec<f64>,
}

impl SphericalHarmonics {
    /// Creates the field of Schmidt semi-normalised coefficients \[g, h\] (T) up to a degree of at most
    /// [`MOST_DEGREES`], in the order of degree n from 1 and order m from 0 to n.
    pub fn new(radius: f64, degree: usize, mut schmidt: impl Iterator<Item = [f64; 2]>) -> Self {
        let (mut coefficients, mut bounds) = (Vec::new(), Vec::new());
        for n in 1..=degree.min(MOST_DEGREES) {
            let normalised: Vec<[f64; 2]> = schmidt.by_ref().take(n + 1).collect();
            let power: f64 = normalised.iter().flatten().map(|part| part * part).sum();
            // Addition theorem: the squares of the vector harmonics of degree n add up to (n + 1)(2n + 1).
            bounds.push(f64::sqrt(((n + 1) * (2 * n + 1)) as f64 * power));
            // sqrt((2 - d) (n - m)!/(n + m)!) with d = 1 for m = 0, else 0.
            let mut factor = 1.0;
            let rows = normalised.iter().enumerate().map(|(m, row)| {
                if m > 0 {
                    factor /= f64::sqrt(((n + 1 - m) * (n + m)) as f64 / if m == 1 { 2.0 } else { 1.0 });
                }
                row.map(|part| part * factor)
            });
            coefficients.push(rows.collect());
        }
        Self { radius, coefficients, bounds }
    }

    /// Returns the highest degree.
    pub fn degree(&self) -> usize {
        self.coefficients.len()
    }

    /// Returns the field of the degrees up to `degree`.
    pub fn truncated(&self, degree: usize) -> Self {
        let mut field = self.clone();
        field.coefficients.truncate(degree);
        field.bounds.truncate(degree);
        field
    }

    /// Returns the field (T) at a position from the planet's centre (m), both in the planet's axes.
    pub fn at(&self, position: &Vector) -> Vector {
        let (v, w) = self.functions(position);
        let mut field = Vector::zeros();
        for (n, rows) in (1..).zip(&self.coefficients) {
            let (v, w) = (&v[n + 1], &w[n + 1]);
            for (m, [g, h]) in rows.iter().enumerate() {
                field.z += (n - m + 1) as f64 * (g * v[m] + h * w[m]);
                if m == 0 {
                    field.x += g * v[1];
                    field.y += g * w[1];
                    continue;
                }
                let factor = 0.5 * ((n - m + 1) * (n - m + 2)) as f64;
                let [up, down] = [m + 1, m - 1];
                field.x += 0.5 * (g * v[up] + h * w[up]) - factor * (g * v[down] + h * w[down]);
                field.y += 0.5 * (g * w[up] - h * v[up]) + factor * (g * w[down] - h * v[down]);
            }
        }
        field
    }

    /// Returns the functions V and W at a position (m), by degree and order.
    fn functions(&self, position: &Vector) -> ([[f64; SIZE]; SIZE], [[f64; SIZE]; SIZE]) {
        let ratio = self.radius / position.norm_squared();
        let [x, y, z] = [position.x, position.y, position.z].map(|part| part * ratio);
        let squared = self.radius * ratio;
        let (mut v, mut w) = ([[0.0; SIZE]; SIZE], [[0.0; SIZE]; SIZE]);
        v[0][0] = f64::sqrt(squared);
        let top = self.degree() + 1;
        for m in 0..=top {
            if m > 0 {
                let (factor, [cos, sin]) = ((2 * m - 1) as f64, [v[m - 1][m - 1], w[m - 1][m - 1]]);
                v[m][m] = factor * (x * cos - y * sin);
                w[m][m] = factor * (x * sin + y * cos);
            }
            for n in m + 1..=top {
                let (first, share) = ((2 * n - 1) as f64 * z, 1.0 / (n - m) as f64);
                let second = if n > m + 1 { (n + m - 1) as f64 * squared } else { 0.0 };
                let before = n.saturating_sub(2);
                v[n][m] = (first * v[n - 1][m] - second * v[before][m]) * share;
                w[n][m] = (first * w[n - 1][m] - second * w[before][m]) * share;
            }
        }
        (v, w)
    }

    /// Returns an upper bound of the field (T) at this distance from the centre (m) and beyond.
    pub fn bound(&self, distance: f64) -> f64 {
        let ratio = self.radius / distance;
        let mut power = ratio * ratio;
        self.bounds.iter().fold(0.0, |sum, bound| {
            power *= ratio;
            sum + bound * power
        })
    }
}
