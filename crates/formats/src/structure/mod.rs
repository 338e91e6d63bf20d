//! Modes of a structure that turns about one axis, given by its mass and stiffness matrices.
//!
//! M q'' + K q = Q, where one coordinate is the angle theta of the hub (\[Rotation\], equation (7)). A unit rigid
//! rotation displaces the coordinates by r, so that with q = r theta + e the elastic coordinates e exclude the hub and
//! theta is the only coordinate without stiffness:
//!
//! J theta'' + m' e'' = torque, m theta'' + Mc e'' + Kc e = 0, J = r' M r, m = the elastic part of M r.

mod csv;
mod eigen;
#[cfg(feature = "matrices")]
mod eigen_large;
mod eigen_reduced;
pub mod fe;
mod matrix;
mod matrix_market;
pub mod mode_table;
#[cfg(feature = "matrices")]
mod npz;
mod shape;
#[cfg(not(feature = "matrices"))]
mod unavailable;

use nalgebra::{DMatrix, DVector};

use crate::document::ConfigError;
pub use eigen::values as eigenvalues;
use eigen_reduced::EigenError;
pub use matrix::Matrix;
pub use matrix_market::{MatrixElements, read_elements as read_matrix_market};
pub use shape::Shape;

/// Largest order of the matrices.
pub const LARGEST: usize = 2000;

/// Relative difference, of a matrix's largest element, that counts as rounding.
const ROUNDING: f64 = 1e-9;

/// Structure that can turn about one axis, and has no other motion without strain.
#[derive(Clone, Debug, PartialEq)]
pub struct Structure {
    mass: DMatrix<f64>,
    stiffness: DMatrix<f64>,
    hub: usize,
    rotation: DVector<f64>,
}

/// State of the hub in the modes.
#[derive(Copy, Clone, Debug, PartialEq, Eq)]
pub enum HubState {
    /// Free hub, driven by a torque.
    Free,
    /// Hub that is held, or moved as commanded.
    Held,
}

/// Modes of a structure.
#[derive(Clone, Debug, PartialEq)]
pub struct Modes {
    /// Moment of inertia J about the axis (kg m²).
    pub inertia: f64,
    /// Natural frequencies (rad/s), increasing.
    pub frequencies: Vec<f64>,
    /// Participation of the hub in each mode of unit modal mass: for a free hub its angle X_n\[theta\] (kg⁻¹ᐟ² m⁻¹),
    /// for a held one its coupling X_n' m (kg¹ᐟ² m; \[Rotation\], equations (17) and (18)).
    pub participations: Vec<f64>,
    /// Value of each observed coordinate under a unit rigid rotation.
    pub rigid: Vec<f64>,
    /// Value of each observed coordinate in each mode of unit modal mass.
    pub shapes: Vec<Vec<f64>>,
}

impl Structure {
    /// Creates the structure of a mass and a stiffness matrix (SI, of the order of the coordinates) with the hub's
    /// angle (rad) at index `hub`. `rotation` is the displacement of each coordinate under a unit rigid rotation;
    /// without it only the hub's angle turns, and all other coordinates are relative to it.
    ///
    /// # Errors
    /// A matrix that is not square, symmetric and finite, of an order from 2 to 2000; a hub or a rotation that does not
    /// fit; a rotation that strains the structure. The fault's key is `mass`, `stiffness`, `hub` or `rotation`.
    pub fn new(
        mass: DMatrix<f64>,
        stiffness: DMatrix<f64>,
        hub: usize,
        rotation: Option<&[f64]>,
    ) -> Result<Self, ConfigError> {
        let mass = symmetric("mass", mass)?;
        let stiffness = symmetric("stiffness", stiffness)?;
        let order = mass.nrows();
        if stiffness.nrows() != order {
            let found = stiffness.nrows();
            return fault(
                "stiffness",
                format!("must be {order} x {order}, as the mass, got {found} x {found}"),
            );
        }
        if hub >= order {
            return fault("hub", format!("must be the index of a coordinate, 0 to {}, got {hub}", order - 1));
        }
        if let Some(i) = (0..order).find(|i| mass[(*i, *i)] <= 0.0) {
            return fault(&format!("mass[{i}][{i}]"), format!("must be positive, got {}", mass[(i, i)]));
        }
        let hub_rotation = match rotation {
            None => DVector::from_fn(order, |i, _| if i == hub { 1.0 } else { 0.0 }),
            Some(rotation) if rotation.len() == order => DVector::from_column_slice(rotation),
            Some(rotation) => {
                let why =
                    format!("must have one number for each of {order} coordinates, got {}", rotation.len());
                return fault("rotation", why);
            }
        };
        if hub_rotation[hub] != 1.0 {
            let why = format!("must be 1, as the angle of the hub itself, got {}", hub_rotation[hub]);
            return fault(&format!("rotation[{hub}]"), why);
        }
        let strain = &stiffness * &hub_rotation;
        let bound = ROUNDING * stiffness.amax() * hub_rotation.amax();
        if let Some(i) = (0..order).find(|i| strain[*i].abs() > bound) {
            let why = if rotation.is_some() {
                format!("must strain nothing, but the stiffness gives {} for coordinate {i}", strain[i])
            } else {
                format!(
                    "must be 0, as the hub's angle alone strains nothing, got {}; if other coordinates turn with the \
                     hub, say by how much in `rotation`",
                    strain[i]
                )
            };
            let key = rotation.map_or_else(|| format!("stiffness[{i}][{hub}]"), |_| "rotation".to_owned());
            return Err(ConfigError::new(key, why));
        }
        Ok(Self { mass, stiffness, hub, rotation: hub_rotation })
    }

    /// Returns the mass matrix, of the order of the coordinates.
    pub fn mass(&self) -> &DMatrix<f64> {
        &self.mass
    }

    /// Returns the stiffness matrix, of the order of the coordinates.
    pub fn stiffness(&self) -> &DMatrix<f64> {
        &self.stiffness
    }

    /// Returns the displacement of each coordinate under a unit rigid rotation.
    pub fn rotation(&self) -> &[f64] {
        self.rotation.as_slice()
    }

    /// Returns a damping matrix of this structure, made symmetric to the last digit.
    ///
    /// # Errors
    /// A matrix that is not symmetric and finite, that does not fit, or that resists the rotation.
    pub fn damping(&self, damping: DMatrix<f64>) -> Result<DMatrix<f64>, ConfigError> {
        let damping = symmetric("damping_matrix", damping)?;
        let (order, found) = (self.mass.nrows(), damping.nrows());
        if found != order {
            return fault(
                "damping_matrix",
                format!("must be {order} x {order}, as the mass, got {found} x {found}"),
            );
        }
        let resistance = &damping * &self.rotation;
        let bound = ROUNDING * damping.amax() * self.rotation.amax();
        if let Some(i) = (0..order).find(|i| resistance[*i].abs() > bound) {
            let why = format!(
                "must not resist the rotation of the whole, but gives {} for coordinate {i}",
                resistance[i]
            );
            return fault("damping_matrix", why);
        }
        Ok(damping)
    }

    /// Computes the elastic modes: those of the free structure if a torque is commanded, of the clamped one if the
    /// motion of the hub is. Each observed coordinate is a sum of coordinates with the given weights.
    ///
    /// # Errors
    /// A matrix that is not positive definite.
    pub fn modes(&self, hub: HubState, observed: &[Vec<f64>]) -> Result<Modes, ConfigError> {
        let elastic: Vec<usize> = (0..self.mass.nrows()).filter(|i| *i != self.hub).collect();
        let order = elastic.len();
        let momenta = &self.mass * &self.rotation;
        let inertia = momenta.dot(&self.rotation);
        let coupling = DVector::from_fn(order, |i, _| momenta[elastic[i]]);
        if inertia <= 0.0 {
            return fault("mass", format!("{DEFINITE}, but the moment of inertia is {inertia}"));
        }
        let block =
            |matrix: &DMatrix<f64>| DMatrix::from_fn(order, order, |i, j| matrix[(elastic[i], elastic[j])]);
        let mut mass = block(&self.mass);
        if hub == HubState::Free {
            mass.ger(-1.0 / inertia, &coupling, &coupling, 1.0);
        }
        let functionals = DMatrix::from_fn(order, 1 + observed.len(), |i, column| match column {
            0 => coupling[i],
            _ => observed[column - 1][elastic[i]],
        });
        let solved = eigen::modes(block(&self.stiffness), mass, &functionals).map_err(|error| match error {
            EigenError::Range => ConfigError::new("mass", TOO_FAR_APART),
            #[cfg(not(feature = "matrices"))]
            EigenError::LeftOut => {
                let (most, why) = (eigen::SMALL, unavailable::LEFT_OUT);
                ConfigError::new("mass", format!("has {order} elastic coordinates: more than {most} {why}"))
            }
            EigenError::Mass => ConfigError::new("mass", format!("{DEFINITE}, and is not")),
            EigenError::Stiffness => ConfigError::new("stiffness", format!(
                    "{DEFINITE} with the hub held, and is not: the structure has another motion without strain \
                     beside the rotation, or a negative stiffness"
                )),
        })?;
        let couplings = solved.values.column(0);
        if hub == HubState::Held && couplings.norm_squared() >= inertia {
            return fault("mass", format!("{DEFINITE}, and is not"));
        }
        let rigid: Vec<f64> = observed.iter().map(|weights| dot(weights, self.rotation.as_slice())).collect();
        let participations: Vec<f64> = match hub {
            HubState::Free => couplings.iter().map(|coupling| -coupling / inertia).collect(),
            HubState::Held => couplings.iter().copied().collect(),
        };
        // A free mode also moves the hub, and all coordinates that turn with it.
        let turns = |n: usize, rigid: f64| match hub {
            HubState::Free => rigid * participations[n],
            HubState::Held => 0.0,
        };
        let shape = |(c, rigid): (usize, &f64)| {
            (0..order).map(|n| solved.values[(n, c + 1)] + turns(n, *rigid)).collect()
        };
        let shapes = rigid.iter().enumerate().map(shape).collect();
        Ok(Modes { inertia, frequencies: solved.frequencies, participations, rigid, shapes })
    }
}

/// Second half of the message about matrices whose modes leave the range of numbers.
pub const TOO_FAR_APART: &str = "holds numbers that differ too much in size for modes in double precision";

const DEFINITE: &str = "must be positive definite";

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).fold(0.0, |sum, (a, b)| sum + a * b)
}

fn fault<T>(key: &str, why: String) -> Result<T, ConfigError> {
    Err(ConfigError::new(key, why))
}

/// Checks that a matrix is square, finite and symmetric within rounding, and makes it symmetric to the last digit.
fn symmetric(key: &str, mut matrix: DMatrix<f64>) -> Result<DMatrix<f64>, ConfigError> {
    let (order, columns) = matrix.shape();
    if order != columns {
        return fault(key, format!("must be square, got {order} x {columns}"));
    }
    if !(2..=LARGEST).contains(&order) {
        return fault(key, format!("must be of order 2 to {LARGEST}, got {order} x {order}"));
    }
    let places = || (0..order).flat_map(|i| (0..order).map(move |j| (i, j)));
    if let Some((i, j)) = places().find(|place| !matrix[*place].is_finite()) {
        return fault(
            &format!("{key}[{i}][{j}]"),
            format!("must be a finite number, got {}", matrix[(i, j)]),
        );
    }
    let bound = ROUNDING * matrix.amax();
    for (i, j) in places().filter(|(i, j)| i > j) {
        let (lower, upper) = (matrix[(i, j)], matrix[(j, i)]);
        if (lower - upper).abs() > bound {
            let why = format!("must be symmetric: element [{i}][{j}] is {lower}, [{j}][{i}] is {upper}");
            return fault(&format!("{key}[{i}][{j}]"), why);
        }
        let mean = 0.5 * (lower + upper);
        (matrix[(i, j)], matrix[(j, i)]) = (mean, mean);
    }
    Ok(matrix)
}
