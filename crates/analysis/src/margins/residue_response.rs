//! Transfer as a sum over its poles: d + sum r/(z - p), for scans over many frequencies.

use nalgebra::{Complex, DMatrix};

use super::frequency_response::{FrequencyResponse, modulus, unit_circle};

/// Difference from a solve, relative to the largest entry, up to which the sum is taken for the transfer.
const TOLERANCE: f64 = 1e-8;
/// Angles (rad) at which the sum is compared.
const COMPARED: [f64; 3] = [0.037, 0.71, 2.9];
/// Distance of the shift of an inverse iteration from its eigenvalue.
const SHIFT: f64 = 1e-10;
/// Number of inverse iterations.
const ITERATIONS: usize = 2;

/// Poles of a transfer with their residues.
#[derive(Clone, Debug)]
pub struct ResidueResponse {
    poles: Vec<Complex<f64>>,
    /// Residues of each pole, one of each entry, pole after pole.
    residues: Vec<Complex<f64>>,
    /// Feedthrough.
    feedthrough: DMatrix<Complex<f64>>,
}

impl ResidueResponse {
    /// Computes the residues of a transfer with these poles; `None` if its eigenvectors are no basis, within rounding.
    pub fn new(response: &FrequencyResponse, poles: &[Complex<f64>]) -> Option<Self> {
        let order = poles.len();
        if order == 0 || order != response.order() {
            return None;
        }
        let mut vectors = DMatrix::zeros(order, order);
        for (place, pole) in poles.iter().enumerate() {
            // Different starts, so that equal poles have different eigenvectors.
            let start = |row: usize, _: usize| {
                let phase = (1.0 + place as f64) * (1.7 + row as f64);
                Complex::new(libm::sin(phase), libm::cos(2.0 * phase))
            };
            let mut vector = DMatrix::from_fn(order, 1, start);
            let shift = *pole + Complex::new(SHIFT, 0.7 * SHIFT) * modulus(*pole).max(1.0);
            for _ in 0..ITERATIONS {
                vector = response.solve(shift, vector)?;
                let size = vector.iter().map(|entry| modulus(*entry)).fold(0.0, f64::max);
                vector.iter_mut().for_each(|entry| *entry /= size);
            }
            vectors.set_column(place, &vector.column(0));
        }
        let (input, output) = response.in_hessenberg_basis();
        let weights = output * &vectors;
        let drives = vectors.lu().solve(input)?;
        let (rows, columns) = (weights.nrows(), drives.ncols());
        let mut residues = Vec::with_capacity(order * rows * columns);
        for pole in 0..order {
            for column in 0..columns {
                residues.extend((0..rows).map(|row| weights[(row, pole)] * drives[(pole, column)]));
            }
        }
        let modal = Self { poles: poles.to_vec(), residues, feedthrough: response.feedthrough() };
        COMPARED.into_iter().map(unit_circle).all(|z| modal.agrees(response, z)).then_some(modal)
    }

    /// Returns the poles, each with its residues: one of each entry, column after column.
    pub fn into_terms(self) -> Vec<(Complex<f64>, Vec<Complex<f64>>)> {
        let count = self.feedthrough.len();
        let residues = self.residues.chunks_exact(count).map(<[Complex<f64>]>::to_vec);
        self.poles.into_iter().zip(residues).collect()
    }

    /// Returns true if the sum is the transfer at a point of the plane.
    fn agrees(&self, response: &FrequencyResponse, z: Complex<f64>) -> bool {
        let (Some(found), Some(expected)) = (self.at(z), response.scan(z)) else { return false };
        let largest =
            |matrix: &DMatrix<Complex<f64>>| matrix.iter().map(|entry| modulus(*entry)).fold(0.0, f64::max);
        largest(&(&found - &expected)) <= TOLERANCE * largest(&expected)
    }

    /// Returns the transfer at a point of the plane; `None` at a pole.
    pub fn at(&self, z: Complex<f64>) -> Option<DMatrix<Complex<f64>>> {
        let mut value = self.feedthrough.clone();
        let count = value.len();
        for (pole, residues) in self.poles.iter().zip(self.residues.chunks_exact(count)) {
            let distance = z - pole;
            let factor = distance.conj() / distance.norm_sqr();
            for (entry, residue) in value.iter_mut().zip(residues) {
                *entry += residue * factor;
            }
        }
        value.iter().all(|entry| entry.re.is_finite() && entry.im.is_finite()).then_some(value)
    }
}

#[cfg(test)]
mod tests {
    use nalgebra::dmatrix;

    use super::*;
    use crate::eigenvalues::eigenvalues;
    use crate::open_loop::TransferMatrices;

    fn modal(a: DMatrix<f64>) -> (FrequencyResponse, Option<ResidueResponse>) {
        let order = a.nrows();
        let poles = eigenvalues(&a).expect("values");
        let transfer = TransferMatrices {
            b: DMatrix::from_fn(order, 2, |row, column| 1.0 + row as f64 - 2.0 * column as f64),
            c: DMatrix::from_fn(2, order, |row, column| 0.3 + column as f64 * (1.0 - row as f64)),
            d: dmatrix![0.1, 0.2; 0.0, -0.4],
            a,
        };
        let response = FrequencyResponse::new(&transfer);
        let modal = ResidueResponse::new(&response, &poles);
        (response, modal)
    }

    #[test]
    fn the_sum_is_the_transfer() {
        // A light pair, an equal pair beside it, a real pole and a delay.
        let (re, im) = (0.999 * libm::cos(0.4), 0.999 * libm::sin(0.4));
        let mut a = DMatrix::zeros(6, 6);
        for first in [0, 2] {
            a.view_mut((first, first), (2, 2)).copy_from(&dmatrix![re, im; -im, re]);
        }
        (a[(4, 4)], a[(4, 0)], a[(5, 2)]) = (0.5, 0.2, 1.0);
        let (response, modal) = modal(a);
        let modal = modal.expect("a basis");
        for angle in [1e-3, 0.399, 0.4, 1.0, 3.1] {
            let z = unit_circle(angle);
            let (found, expected) = (modal.at(z).expect("no pole"), response.at(z).expect("no pole"));
            let off = (&found - &expected).map(modulus).max();
            assert!(off < 1e-9 * expected.map(modulus).max(), "{angle}: {off}");
        }
    }

    #[test]
    fn a_defective_matrix_has_none() {
        assert!(modal(dmatrix![0.0, 0.0, 0.0; 1.0, 0.0, 0.0; 0.0, 1.0, 0.0]).1.is_none());
    }
}
