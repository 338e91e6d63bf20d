//! Mount of a machine: springs and dampers between the hub and a rigid appendage, such as the isolator of a wheel or a cooler.

use flexsc_formats::document::ConfigError;
use flexsc_formats::structure::Shape;
use flexsc_numerics::attitude::{Vector, vector};
use flexsc_numerics::quantity::{Finite, Frequency, NonNegative};
use nalgebra::{Cholesky, DMatrix, Matrix3, SymmetricEigen};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::clamped::ClampedMode;
use super::hinge::RigidBody;
use super::mass::point_mass_inertia;

/// A mount that carries the appendage as a rigid body, which moves against it by small displacements and rotations.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Mount {
    /// Natural frequency of its displacement on a fixed base (rad/s), in any direction.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub translation: Option<Frequency>,
    /// Natural frequency of its rotation about its centre of mass on a fixed base (rad/s), about any axis.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub rocking: Option<Frequency>,
    /// Stiffness at the root, in place of both: force (N) and torque (N m) along its own axes per displacement (m) and rotation (rad),
    /// row by row; positive definite.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub stiffness: Option<[[Finite; 6]; 6]>,
    /// Damping ratio of each mode on a fixed base.
    #[serde(default)]
    pub damping: NonNegative,
    /// Axis in its own axes about which the mount does not give, of any length, such as that of a wheel: there the rotor turns.
    /// Default: it rocks about all axes.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub axis: Option<[Finite; 3]>,
}

/// Largest difference across the diagonal of a stiffness, relative to its largest element.
const ASYMMETRY: f64 = 1e-9;

impl Mount {
    /// Returns the modes of a rigid body on the mount; `None` if its mass or its stiffness is not positive definite, or a frequency
    /// is out of range.
    pub(super) fn modes(&self, body: &RigidBody<'_>) -> Option<Vec<ClampedMode>> {
        let basis = self.basis();
        let factor = Cholesky::new(basis.tr_mul(&(body.mass_matrix() * &basis)))?;
        let half = factor.l().solve_lower_triangular(&basis.tr_mul(&(self.stiffness(body)? * &basis)))?;
        let square = factor.l().solve_lower_triangular(&half.transpose())?;
        if square.iter().any(|element| !element.is_finite()) {
            return None;
        }
        let eigen = SymmetricEigen::new(0.5 * (&square + square.transpose()));
        let mut rising: Vec<usize> = (0..basis.ncols()).collect();
        rising.sort_by(|a, b| eigen.eigenvalues[*a].total_cmp(&eigen.eigenvalues[*b]));
        let shapes = &basis * factor.l().tr_solve_lower_triangular(&eigen.eigenvectors)?;
        let mode = |index: usize| {
            let frequency = Frequency::new(f64::sqrt(eigen.eigenvalues[index]))?;
            let motion = shapes.column(index);
            let shift = Vector::new(motion[0], motion[1], motion[2]);
            Some(self.mode(frequency, (shift, Vector::new(motion[3], motion[4], motion[5])), body))
        };
        rising.into_iter().map(mode).collect()
    }

    /// Returns the mode in which the body is displaced by p + a x r per unit.
    fn mode(&self, frequency: Frequency, (p, a): (Vector, Vector), body: &RigidBody<'_>) -> ClampedMode {
        let three = |v: Vector| [v.x, v.y, v.z].map(|component| Finite::new(component).unwrap_or_default());
        // Integral of r (p + a x r)' dm. That of r (a x r)' is its product with [a]'.
        let moments =
            body.mass * body.centre * p.transpose() + body.second_moment() * a.cross_matrix().transpose();
        let shape = |position: &[Finite; 3]| Shape {
            translation: three(p + a.cross(&vector(position))),
            rotation: three(a),
        };
        ClampedMode {
            frequency,
            damping: self.damping,
            translation: three((p + a.cross(&body.centre)) * body.mass),
            along: None,
            rotation: None,
            moments: Some([0, 1, 2].map(|row| three(moments.row(row).transpose()))),
            displacement: Finite::default(),
            rate: Finite::default(),
            shapes: body.points.iter().map(|point| (point.name.clone(), shape(&point.position))).collect(),
        }
    }

    /// Returns the motions that the mount allows: displacement of the root and rotation, one column each.
    fn basis(&self) -> DMatrix<f64> {
        let Some(axis) = &self.axis else { return DMatrix::identity(6, 6) };
        let axis = vector(axis).normalize();
        let first = axis.cross(&Vector::ith(axis.iamin(), 1.0)).normalize();
        let across = [first, axis.cross(&first)];
        DMatrix::from_fn(6, 5, |row, column| match (row.checked_sub(3), column.checked_sub(3)) {
            (None, None) => f64::from(u8::from(row == column)),
            (Some(row), Some(column)) => across[column][row],
            _ => 0.0,
        })
    }

    /// Returns the stiffness at the root; `None` if it is not given whole.
    fn stiffness(&self, body: &RigidBody<'_>) -> Option<DMatrix<f64>> {
        if let Some(given) = &self.stiffness {
            return Some(DMatrix::from_fn(6, 6, |row, column| {
                0.5 * (given[row][column].get() + given[column][row].get())
            }));
        }
        let [translation, rocking] = [self.translation?, self.rocking?].map(|own| own.get() * own.get());
        let about_centre = RigidBody { inertia: body.inertia * (rocking / translation), ..*body };
        Some(about_centre.mass_matrix() * translation)
    }

    /// Checks the length of the axis.
    ///
    /// # Errors
    /// The key, and the reason.
    pub(super) fn check_axis(&self) -> Result<(), ConfigError> {
        let Some(axis) = &self.axis else { return Ok(()) };
        let length = vector(axis).norm();
        let why = format!("must have a length of 1e-6 to 1e6, got {length}");
        if (1e-6..=1e6).contains(&length) { Ok(()) } else { Err(ConfigError::new("axis", why)) }
    }

    /// Returns true if an appendage has inertia about all axes about which the mount lets it rotate.
    pub(super) fn has_inertia(&self, body: &RigidBody<'_>) -> bool {
        let basis = self.basis();
        Cholesky::new(basis.tr_mul(&(body.mass_matrix() * &basis))).is_some()
    }

    /// Checks the mount for values that are inconsistent with each other or with the appendage.
    ///
    /// # Errors
    /// A key within the mount, and the reason.
    pub(super) fn check(&self, body: &RigidBody<'_>) -> Result<(), ConfigError> {
        let fault = |key: &str, why: &str| Err(ConfigError::new(key, why));
        match (&self.stiffness, self.translation, self.rocking) {
            (None, Some(_), Some(_)) => {}
            (None, None, _) => {
                return fault("translation", "must be given, with `rocking`, or a `stiffness`");
            }
            (None, _, None) => {
                return fault("rocking", "must be given, with `translation`, or a `stiffness`");
            }
            (Some(_), Some(_), _) => return fault("translation", "must be left out with a `stiffness`"),
            (Some(_), _, Some(_)) => return fault("rocking", "must be left out with a `stiffness`"),
            (Some(given), None, None) => {
                let given = DMatrix::from_fn(6, 6, |row, column| given[row][column].get());
                if (&given - given.transpose()).amax() > ASYMMETRY * given.amax() {
                    return fault("stiffness", "must be symmetric");
                }
            }
        }
        if self.modes(body).is_none() {
            let why = format!(
                "must be positive definite, and give natural frequencies of {} to {} rad/s",
                Frequency::SMALLEST,
                Frequency::LARGEST
            );
            return fault("stiffness", &why);
        }
        Ok(())
    }
}

impl RigidBody<'_> {
    /// Returns the mass matrix over displacement of the root and rotation.
    fn mass_matrix(&self) -> DMatrix<f64> {
        let across = self.centre.cross_matrix() * self.mass;
        let about_root = self.inertia + point_mass_inertia(self.mass, &self.centre);
        let mut matrix = DMatrix::from_diagonal_element(6, 6, self.mass);
        matrix.view_mut((0, 3), (3, 3)).copy_from(&-across);
        matrix.view_mut((3, 0), (3, 3)).copy_from(&across);
        matrix.view_mut((3, 3), (3, 3)).copy_from(&about_root);
        matrix
    }

    /// Returns the integral of r r' dm, with positions from the root (kg m²).
    pub(super) fn second_moment(&self) -> Matrix3<f64> {
        let own = &self.inertia;
        0.5 * own.trace() * Matrix3::identity() - own + self.mass * self.centre * self.centre.transpose()
    }
}
