//! Characteristic loci: the eigenvalues of a loop transfer over frequency, continued from one frequency to the next.
//!
//! A loop of one signal has its own transfer as its locus. One with several samples in a period, which is a matrix, has
//! as many loci: a factor k on all its samples is at the limit of stability where a locus passes -1/k.

use nalgebra::{Complex, DMatrix, DVector};

use crate::eigenvalues::complex_eigenvalues;

use super::frequency_response::{FrequencyResponse, modulus, unit_circle};

/// Ratio of the largest locus to another beyond which the other is rounding.
const WIDEST: f64 = 1e8;

/// Values of the loci at an angle.
#[derive(Clone, Debug, PartialEq)]
pub struct LociValues {
    /// Angle of the point on the unit circle (rad).
    pub angle: f64,
    /// Value of each locus, in the same order at all angles; 0 if it is rounding beside the largest one.
    pub values: Vec<Complex<f64>>,
}

/// Returns the loci of these loop transfers over angles, without those at poles.
pub fn loci(transfers: impl Iterator<Item = (f64, DMatrix<Complex<f64>>)>) -> Vec<LociValues> {
    let mut found: Vec<LociValues> = Vec::new();
    for (angle, transfer) in transfers {
        let Some(mut here) = complex_eigenvalues(transfer) else { continue };
        let largest = here.iter().map(Complex::norm_sqr).fold(0.0, f64::max);
        for value in here.iter_mut().filter(|value| value.norm_sqr() < largest / (WIDEST * WIDEST)) {
            *value = Complex::ZERO;
        }
        if let Some(before) = found.last() {
            here = before.values.iter().map(|value| take_nearest(&mut here, *value)).collect();
        }
        found.push(LociValues { angle, values: here });
    }
    found
}

/// Removes and returns the value that is nearest to another one.
fn take_nearest(values: &mut Vec<Complex<f64>>, to: Complex<f64>) -> Complex<f64> {
    let distance = |value: &Complex<f64>| (value - to).norm_sqr();
    let nearest = (0..values.len()).min_by(|a, b| distance(&values[*a]).total_cmp(&distance(&values[*b])));
    nearest.map_or(to, |place| values.swap_remove(place))
}

/// Part of a locus between two neighbouring angles.
pub struct LocusSegment<'a> {
    /// Response of the loop.
    pub response: &'a FrequencyResponse,
    /// Angles and values at the ends.
    pub ends: [(f64, Complex<f64>); 2],
}

impl LocusSegment<'_> {
    /// Returns the value of the locus at an angle between the ends; that of the nearer end at a pole.
    pub fn at(&self, angle: f64) -> Complex<f64> {
        let [(low, first), (high, last)] = self.ends;
        let part = (angle - low) / (high - low);
        let expected = first * (1.0 - part) + last * part;
        match self.response.at(unit_circle(angle)).and_then(complex_eigenvalues) {
            Some(mut here) => take_nearest(&mut here, expected),
            None if part < 0.5 => first,
            None => last,
        }
    }
}

/// Computes the eigenvector of a value of the loci by inverse iteration.
pub fn eigenvector(matrix: DMatrix<Complex<f64>>, value: Complex<f64>) -> Option<DVector<Complex<f64>>> {
    let count = matrix.nrows();
    let shift = value * (1.0 + 1e-9);
    let factors = (matrix - DMatrix::from_diagonal_element(count, count, shift)).lu();
    let mut vector = DVector::from_fn(count, |row, _| Complex::new(1.0, 0.3 * row as f64));
    for _ in 0..3 {
        vector = factors.solve(&vector)?;
        let size = vector.iter().map(|entry| modulus(*entry)).fold(0.0, f64::max);
        vector.iter_mut().for_each(|entry| *entry /= size);
    }
    vector.iter().all(|entry| entry.re.is_finite() && entry.im.is_finite()).then_some(vector)
}
