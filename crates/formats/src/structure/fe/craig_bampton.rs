//! Craig-Bampton models: six rows of the node at an interface, and a row for each mode that is clamped there.

use nalgebra::DMatrix;

use super::{FileMass, FileMode, FileResults, kept};
use crate::structure::eigen;
use crate::structure::eigen_reduced::EigenError;

/// Elements that count as rounding, of the largest.
const ROUNDING: f64 = 1e-6;

/// Returns the modes of a model by its mass and stiffness matrices, whose rows `interface` are those of the interface.
///
/// # Errors
/// The name of the matrix or of the rows, and the reason for which they are no such model.
pub fn craig_bampton_modes(
    mass: &DMatrix<f64>,
    stiffness: &DMatrix<f64>,
    interface: &[usize; 6],
    keep: Option<usize>,
) -> Result<FileResults, (&'static str, String)> {
    let order = mass.nrows();
    for (name, matrix) in [("mass", mass), ("stiffness", stiffness)] {
        if matrix.shape() != (order, order) || order < 7 {
            let (rows, columns) = matrix.shape();
            let why =
                format!("must be square with at least 7 rows, and of one order, got {rows} x {columns}");
            return Err((name, why));
        }
        if (matrix - matrix.transpose()).amax() > ROUNDING * matrix.amax() {
            return Err((name, "must be symmetric: does the file have half of it?".to_owned()));
        }
    }
    let is_wrong = |at: usize| interface[at] >= order || interface[..at].contains(&interface[at]);
    if let Some(at) = (0..6).find(|at| is_wrong(*at)) {
        return Err((
            "interface",
            format!("must be six different rows from 0 to {}, got {}", order - 1, interface[at]),
        ));
    }
    let modal: Vec<usize> = (0..order).filter(|row| !interface.contains(row)).collect();
    let most = ROUNDING * stiffness.amax();
    let strain = |row: usize| interface.iter().map(|held| stiffness[(*held, row)].abs()).fold(0.0, f64::max);
    if let Some(row) = (0..order).find(|row| strain(*row) > most) {
        return Err((
            "stiffness",
            format!(
                "must be 0 in the rows of the interface, got {} in column {row}: another order of rows (`interface`), or a matrix that \
                 is not reduced",
                strain(row)
            ),
        ));
    }
    let block = |matrix: &DMatrix<f64>| {
        DMatrix::from_fn(modal.len(), modal.len(), |i, j| matrix[(modal[i], modal[j])])
    };
    let carried = DMatrix::from_fn(modal.len(), 6, |i, j| mass[(modal[i], interface[j])]);
    let count = kept(modal.len(), keep).map_err(|why| ("mass", why))?;
    let solved = eigen::modes(block(stiffness), block(mass), &carried).map_err(|error| match error {
        EigenError::Mass => ("mass", "must be positive definite in the rows of modes".to_owned()),
        EigenError::Stiffness => ("stiffness", "must be positive definite in the rows of modes".to_owned()),
        EigenError::Range => ("mass", crate::structure::TOO_FAR_APART.to_owned()),
        #[cfg(not(feature = "matrices"))]
        EigenError::LeftOut => (
            "mass",
            format!(
                "has more than {} modes, which {}",
                eigen::SMALL,
                crate::structure::unavailable::LEFT_OUT
            ),
        ),
    })?;
    let mode = |index: usize| {
        let part = |column: usize| solved.values[(index, column)];
        FileMode {
            frequency: solved.frequencies[index],
            translation: [part(0), part(1), part(2)],
            rotation: [part(3), part(4), part(5)],
            moments: None,
            damping: None,
            shapes: Vec::new(),
        }
    };
    let rigid = |row: usize, column: usize| mass[(interface[row], interface[column])];
    let own = FileMass {
        mass: rigid(0, 0),
        moment: Some([rigid(1, 5), rigid(2, 3), rigid(0, 4)]),
        inertia: Some(std::array::from_fn(|axis| rigid(3 + axis, 3 + axis))),
        clamp: None,
    };
    Ok(FileResults { modes: (0..count).map(mode).collect(), mass: Some(own) })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A boom of 3 m with its first mode, and its rows in another order.
    fn boom(order: &[usize; 7]) -> [DMatrix<f64>; 2] {
        let mut mass = DMatrix::from_diagonal(&[4.8, 4.8, 4.8, 0.1, 14.4, 14.4, 4.0].to_vec().into());
        for (i, j, element) in [(1, 5, 7.2), (2, 4, -7.2), (2, 6, 2.0 * 1.7155), (4, 6, -2.0 * 3.7385)] {
            (mass[(i, j)], mass[(j, i)]) = (element, element);
        }
        let mut stiffness = DMatrix::zeros(7, 7);
        stiffness[(6, 6)] = 4.0 * 6.177 * 6.177;
        [mass, stiffness].map(|matrix| DMatrix::from_fn(7, 7, |i, j| matrix[(order[i], order[j])]))
    }

    #[test]
    fn participations_are_the_rows_between_interface_and_modes() {
        let [mass, stiffness] = boom(&[6, 0, 1, 2, 3, 4, 5]);
        let found = craig_bampton_modes(&mass, &stiffness, &[1, 2, 3, 4, 5, 6], None).expect("a model");
        let mode = &found.modes[0];
        assert!((mode.frequency - 6.177).abs() < 1e-12);
        assert!(
            (mode.translation[2].abs() - 1.7155).abs() < 1e-12
                && (mode.rotation[1].abs() - 3.7385).abs() < 1e-12
        );
        let own = found.mass.expect("a mass");
        assert_eq!(
            (own.mass, own.moment, own.inertia),
            (4.8, Some([7.2, 0.0, 0.0]), Some([0.1, 14.4, 14.4]))
        );
    }

    #[test]
    fn other_matrices_are_refused_by_name() {
        let [mass, stiffness] = boom(&[0, 1, 2, 3, 4, 5, 6]);
        let rows = [0, 1, 2, 3, 4, 5];
        let refused =
            |mass: &DMatrix<f64>, stiffness: &DMatrix<f64>, rows: &[usize; 6], keep: Option<usize>| {
                let (name, why) = craig_bampton_modes(mass, stiffness, rows, keep).expect_err("no model");
                format!("{name} {why}")
            };
        assert!(refused(&mass, &stiffness, &[0, 1, 2, 3, 4, 6], None).starts_with("stiffness must be 0"));
        assert!(
            refused(&mass, &stiffness, &[0, 1, 2, 3, 4, 4], None)
                .contains("different rows from 0 to 6, got 4")
        );
        assert!(refused(&mass, &stiffness, &rows, Some(2)).contains("`keep` asks for 2"));
        assert!(
            refused(&mass.clone().insert_row(7, 0.0), &stiffness, &rows, None)
                .starts_with("mass must be square")
        );
        assert!(refused(&mass.lower_triangle(), &stiffness, &rows, None).contains("half of it"));
        assert!(refused(&mass, &(-1.0 * &stiffness), &rows, None).starts_with("stiffness must be positive"));
    }
}
