//! Free modes of a spacecraft from the clamped modes of its appendages.
//!
//! With the centre of mass eliminated, the clamped modes eta have the mass matrix E = 1 - t' t/m and are coupled to
//! the rate of the hub by delta (\[Likins70\]). Elimination of that rate leaves S = E - delta' J⁻¹ delta, and O² y =
//! W² S y with Y' S Y = 1 gives the free modes, eta = Y q. Computed as eigenvalues W⁻² of O⁻¹ S O⁻¹, they keep their
//! digits, and no rigid mode takes part.

use flexsc_numerics::attitude::Vector;
use nalgebra::{Cholesky, DMatrix, Matrix3, Matrix3xX, SymmetricEigen};

/// Clamped modes and their coupling to a free hub, one column per mode.
#[derive(Clone, Debug, PartialEq)]
pub struct ClampedModes {
    /// Total mass m (kg).
    pub mass: f64,
    /// Inertia tensor J about the total centre of mass, without the spin inertia of rotors (kg m²).
    pub inertia: Matrix3<f64>,
    /// Natural frequencies O (rad/s).
    pub frequencies: Vec<f64>,
    /// Participations t in translation (sqrt(kg)).
    pub translations: Matrix3xX<f64>,
    /// Participations delta in rotation about the total centre of mass (sqrt(kg) m).
    pub rotations: Matrix3xX<f64>,
}

/// Free modes, one column per mode.
#[derive(Clone, Debug, PartialEq)]
pub struct FreeModes {
    /// Natural frequencies W (rad/s), increasing.
    pub frequencies: Vec<f64>,
    /// Composition from clamped modes, eta = Y q. The largest element of a column is positive.
    pub shapes: DMatrix<f64>,
    /// Rotation phi = -J⁻¹ delta Y of the hub (rad/(m sqrt(kg))).
    pub rotations: Matrix3xX<f64>,
    /// Displacement -t Y/m of the point of the hub at the centre of mass (1/sqrt(kg)).
    pub translations: Matrix3xX<f64>,
}

impl ClampedModes {
    /// Returns the mass matrix E of the clamped modes with the centre of mass at rest.
    pub fn mass_matrix(&self) -> DMatrix<f64> {
        let order = self.frequencies.len();
        DMatrix::identity(order, order) - self.translations.tr_mul(&self.translations) / self.mass
    }

    /// Returns the residual inertia J - delta E⁻¹ delta' (kg m²), which no mode carries, if E is positive definite.
    pub fn residual_inertia(&self) -> Option<Matrix3<f64>> {
        let mass = Cholesky::new(self.mass_matrix())?;
        let carried = &self.rotations * mass.solve(&self.rotations.transpose());
        Some(self.inertia - Matrix3::from_fn(|row, column| carried[(row, column)]))
    }

    /// Returns the free modes, if the mass matrix is positive definite.
    pub fn free_modes(&self) -> Option<FreeModes> {
        let (order, hub) = (self.frequencies.len(), Cholesky::new(self.inertia)?);
        let mass = self.mass_matrix() - self.rotations.tr_mul(&hub.solve(&self.rotations));
        let of = |index: usize| self.frequencies[index];
        let compliance = DMatrix::from_fn(order, order, |row, column| {
            0.5 * (mass[(row, column)] + mass[(column, row)]) / (of(row) * of(column))
        });
        if compliance.iter().any(|element| !element.is_finite()) {
            return None;
        }
        // Special case: a rigid body has no modes.
        let (values, vectors) = if order == 0 {
            (Vec::new(), DMatrix::zeros(0, 0))
        } else {
            let eigen = SymmetricEigen::new(compliance);
            (eigen.eigenvalues.as_slice().to_vec(), eigen.eigenvectors)
        };
        if values.iter().any(|value| *value <= 0.0) {
            return None;
        }
        let mut falling: Vec<usize> = (0..order).collect();
        falling.sort_by(|a, b| values[*b].total_cmp(&values[*a]));
        let frequencies: Vec<f64> = falling.iter().map(|index| 1.0 / f64::sqrt(values[*index])).collect();
        let mut shapes = DMatrix::from_fn(order, order, |row, column| {
            vectors[(row, falling[column])] * frequencies[column] / of(row)
        });
        for mut column in shapes.column_iter_mut() {
            if column[column.iamax()] < 0.0 {
                column.neg_mut();
            }
        }
        Some(FreeModes {
            rotations: -hub.solve(&(&self.rotations * &shapes)),
            translations: &self.translations * &shapes * (-1.0 / self.mass),
            frequencies,
            shapes,
        })
    }

    /// Returns the coordinates of the free modes for those of the clamped modes: q = Y⁻¹ eta, with Y⁻¹ = Y' S = W⁻²
    /// Y' O².
    pub fn to_free(&self, free: &FreeModes, eta: &[f64]) -> Vec<f64> {
        let column = |(column, frequency): (usize, &f64)| {
            let parts = eta.iter().zip(&self.frequencies).enumerate();
            let sum: f64 =
                parts.map(|(row, (eta, held))| free.shapes[(row, column)] * held * held * eta).sum();
            sum / (frequency * frequency)
        };
        free.frequencies.iter().enumerate().map(column).collect()
    }
}

impl FreeModes {
    /// Returns the rotation of the hub in a mode (rad/(m sqrt(kg))).
    pub fn rotation(&self, mode: usize) -> Vector {
        self.rotations.column(mode).into_owned()
    }

    /// Returns the displacement of the hub's point at the centre of mass in a mode (1/sqrt(kg)).
    pub fn translation(&self, mode: usize) -> Vector {
        self.translations.column(mode).into_owned()
    }
}
