//! Field of a potential in spherical harmonics, in Cartesian form (\[Cunningham70\]), which has no singularity at the
//! poles.
//!
//! V = a sum (a/r)^(n+1) (g cos(m phi) + h sin(m phi)) P(n, m), Schmidt semi-normalised, and B = -grad V. The functions
//! V(n, m) = (a/r)^(n+1) P cos(m phi), and W(n, m) with the sine, follow from recurrences in x, y, z and r² with P not
//! normalised, and the derivatives of those of degree n are those of degree n + 1.

use flexsc_numerics::attitude::Vector;

use super::time_jet::{JetNumber, TimeJet};

/// Highest degree of a model.
pub(super) const MOST_DEGREES: usize = 13;

/// Number of degrees and orders of the functions, of which the field takes one degree and order more than its
/// coefficients.
const SIZE: usize = MOST_DEGREES + 2;

/// Factors of the recurrence of degrees, V(n, m) = a z V(n - 1, m) - b r² V(n - 2, m): a = (2n - 1)/(n - m) and b =
/// (n + m - 1)/(n - m), by degree and order.
const RECURRENCE: [[[f64; 2]; SIZE]; SIZE] = {
    let mut factors = [[[0.0; 2]; SIZE]; SIZE];
    let mut n = 1;
    while n < SIZE {
        let mut m = 0;
        while m < n {
            let below = (n - m) as f64;
            factors[n][m] = [(2 * n - 1) as f64 / below, (n + m - 1) as f64 / below];
            m += 1;
        }
        n += 1;
    }
    factors
};

/// Field of a planet in spherical harmonics, in axes that rotate with it.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct SphericalHarmonics {
    /// Reference radius of the coefficients (m).
    radius: f64,
    /// Shares of the functions in the field, by degree from 1 and by order of the function from 0.
    shares: Vec<Vec<FunctionShare>>,
    /// Upper bound of the field of each degree at the reference radius (T).
    bounds: Vec<f64>,
}

/// Shares of the functions V and W of one degree and order in the field along x, y and z (T).
#[derive(Copy, Clone, Debug, PartialEq)]
struct FunctionShare {
    v: [f64; 3],
    w: [f64; 3],
}

impl SphericalHarmonics {
    /// Creates the field of Schmidt semi-normalised coefficients \[g, h\] (T) up to a degree of at most
    /// [`MOST_DEGREES`], in the order of degree n from 1 and order m from 0 to n.
    pub fn new(radius: f64, degree: usize, mut schmidt: impl Iterator<Item = [f64; 2]>) -> Self {
        let (mut shares, mut bounds) = (Vec::new(), Vec::new());
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
            let coefficients: Vec<[f64; 2]> = rows.collect();
            shares.push(function_shares(&coefficients));
        }
        Self { radius, shares, bounds }
    }

    /// Returns the highest degree.
    pub fn degree(&self) -> usize {
        self.shares.len()
    }

    /// Returns the field of the degrees up to `degree`.
    pub fn truncated(&self, degree: usize) -> Self {
        let mut field = self.clone();
        field.shares.truncate(degree);
        field.bounds.truncate(degree);
        field
    }

    /// Returns the field (T) at a position from the planet's centre (m), both in the planet's axes.
    pub fn at(&self, position: &Vector) -> Vector {
        let ratio = self.radius / position.norm_squared();
        let squared = self.radius * ratio;
        let scaled = [position.x, position.y, position.z].map(|part| part * ratio);
        let (v, w) = self.functions(scaled, squared, f64::sqrt(squared));
        let mut field = Vector::zeros();
        for ((shares, v), w) in self.shares.iter().zip(&v[2..]).zip(&w[2..]) {
            for ((share, v), w) in shares.iter().zip(v).zip(w) {
                field += Vector::from(share.v) * *v + Vector::from(share.w) * *w;
            }
        }
        field
    }

    /// Returns the field (T) with its first two derivatives in time at a position that moves, from position (m), velocity and
    /// acceleration, all in the planet's axes.
    pub fn motion(&self, [position, velocity, acceleration]: [Vector; 3]) -> [Vector; 3] {
        let axes: [TimeJet; 3] =
            std::array::from_fn(|axis| TimeJet([position[axis], velocity[axis], acceleration[axis]]));
        let ratio = (axes[0] * axes[0] + axes[1] * axes[1] + axes[2] * axes[2]).inverse() * self.radius;
        let squared = ratio * self.radius;
        let (v, w) = self.functions(axes.map(|part| part * ratio), squared, squared.square_root());
        let mut motion = [Vector::zeros(); 3];
        for ((shares, v), w) in self.shares.iter().zip(&v[2..]).zip(&w[2..]) {
            for ((share, v), w) in shares.iter().zip(v).zip(w) {
                for (order, part) in motion.iter_mut().enumerate() {
                    *part += Vector::from(share.v) * v.0[order] + Vector::from(share.w) * w.0[order];
                }
            }
        }
        motion
    }

    /// Returns the functions V and W by degree and order, from the position times a/r², from (a/r)² and from a/r.
    fn functions<T: JetNumber>(
        &self,
        [x, y, z]: [T; 3],
        squared: T,
        first: T,
    ) -> ([[T; SIZE]; SIZE], [[T; SIZE]; SIZE]) {
        let (mut v, mut w) = ([[T::default(); SIZE]; SIZE], [[T::default(); SIZE]; SIZE]);
        v[0][0] = first;
        for n in 1..=self.degree() + 1 {
            for m in 0..n {
                let [first, second] = RECURRENCE[n][m];
                let [first, second] = [z * first, squared * second];
                let before = n.saturating_sub(2);
                v[n][m] = first * v[n - 1][m] - second * v[before][m];
                w[n][m] = first * w[n - 1][m] - second * w[before][m];
            }
            let (factor, [cos, sin]) = ((2 * n - 1) as f64, [v[n - 1][n - 1], w[n - 1][n - 1]]);
            v[n][n] = (x * cos - y * sin) * factor;
            w[n][n] = (x * sin + y * cos) * factor;
        }
        (v, w)
    }

    /// Returns an upper bound of the change of the field with the position (T/m) at this distance from the centre (m) and beyond.
    ///
    /// Half of the Laplacian of the sum of squares of harmonic functions is that of their gradients: the squares of the derivatives of the
    /// vector harmonics of degree n add up to (n + 1)(2n + 1)(n + 2)(2n + 3). A symmetric matrix without trace stretches by at
    /// most sqrt(2/3) of its norm.
    pub fn gradient_bound(&self, distance: f64) -> f64 {
        let ratio = self.radius / distance;
        let mut power = ratio * ratio;
        let sum = self.bounds.iter().enumerate().fold(0.0, |sum, (index, bound)| {
            power *= ratio;
            sum + bound * power * f64::sqrt(((index + 3) * (2 * index + 5)) as f64)
        });
        f64::sqrt(2.0 / 3.0) * sum / distance
    }

    /// Returns an upper bound of the field's size (T), the root of the sum of the squares of its complex components, at a
    /// complex position r: for |r.r| at least the square of `distance` (m), and sum |r|² at most `stretch` times |r.r|.
    ///
    /// By the addition theorem, an identity of polynomials that holds at complex points too, the squares of the field of
    /// degree n are at most those at that distance times the Legendre polynomial of degree n + 1 at `stretch`.
    pub fn complex_bound(&self, distance: f64, stretch: f64) -> f64 {
        let ratio = self.radius / distance;
        let mut power = ratio * ratio;
        let (mut before, mut legendre) = (1.0, stretch);
        self.bounds.iter().enumerate().fold(0.0, |sum, (index, bound)| {
            let n = (index + 1) as f64;
            power *= ratio;
            (before, legendre) = (legendre, ((2.0 * n + 1.0) * stretch * legendre - n * before) / (n + 1.0));
            sum + bound * power * f64::sqrt(legendre)
        })
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

/// Returns the shares of the functions of degree n + 1 in the field of degree n, whose coefficients \[g, h\], for
/// functions that are not normalised, are given from order 0 on.
fn function_shares(coefficients: &[[f64; 2]]) -> Vec<FunctionShare> {
    let n = coefficients.len() - 1;
    let mut shares = vec![FunctionShare { v: [0.0; 3], w: [0.0; 3] }; n + 2];
    for (m, [g, h]) in coefficients.iter().copied().enumerate() {
        let along = (n - m + 1) as f64;
        shares[m].v[2] += along * g;
        shares[m].w[2] += along * h;
        if m == 0 {
            shares[1].v[0] += g;
            shares[1].w[1] += g;
            continue;
        }
        let next = &mut shares[m + 1];
        (next.v[0], next.w[0]) = (next.v[0] + 0.5 * g, next.w[0] + 0.5 * h);
        (next.v[1], next.w[1]) = (next.v[1] - 0.5 * h, next.w[1] + 0.5 * g);
        let factor = 0.5 * along * (n - m + 2) as f64;
        let last = &mut shares[m - 1];
        (last.v[0], last.w[0]) = (last.v[0] - factor * g, last.w[0] - factor * h);
        (last.v[1], last.w[1]) = (last.v[1] - factor * h, last.w[1] + factor * g);
    }
    shares
}
