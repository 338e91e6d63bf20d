//! Broadband forces and torques at a point: their one-sided spectral densities over frequency.

use std::f64::consts::TAU;

use flexsc_formats::document::ConfigError;
use flexsc_formats::load_density_table::LoadDensityTable;
use flexsc_numerics::quantity::{Finite, NonNegative, Positive};
use flexsc_numerics::time::Span;
use nalgebra::{Matrix6, SymmetricEigen, Vector6};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Twice the damping ratio of the two filters that make the corners.
pub(crate) const TWICE_DAMPING: f64 = 1.4;
/// Steps of a run in a period of the upper corner, or of the last row of a table: the mean over a step is held for it, which takes 1.6 % of the density at the corner.
pub(crate) const STEPS: f64 = 20.0;

/// Least ratio of the corners, at which the filters of runs keep half of the digits.
pub(crate) const LEAST_RATIO: f64 = 1e-8;

/// Least eigenvalue of a correlation matrix, for rounded numbers.
const LEAST: f64 = -1e-9;

/// Stationary Gaussian force and torque at a point, whose components are independent but for `correlation`: one-sided densities that are constant between two
/// corners, or a table over frequency.
///
/// Below `lower` a density falls with the fourth power of the frequency, above `upper` with its inverse: filters of the second order
/// with a damping ratio of 0.7. A table is linear between its rows on logarithmic scales, and zero outside.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct LoadDensity {
    /// One-sided density of the force along x, y and z between the corners (N²/Hz).
    #[serde(default)]
    pub force: [NonNegative; 3],
    /// One-sided density of the torque about x, y and z between the corners ((N m)²/Hz).
    #[serde(default)]
    pub torque: [NonNegative; 3],
    /// Correlation of the components: three rows for the force along x, y and z, or six with the torque about x, y and z; symmetric, with 1
    /// on the diagonal. Default: none.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub correlation: Option<Vec<Vec<Finite>>>,
    /// Lower corner (rad/s).
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub lower: Option<Positive>,
    /// Upper corner (rad/s).
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub upper: Option<Positive>,
    /// Densities over frequency in place of the corners, or the path of a .csv file: frequency (Hz) and density of the force (N²/Hz),
    /// the same along all axes or along x, y and z, which those of the torque about x, y and z ((N m)²/Hz) may follow.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub table: Option<LoadDensityTable>,
}

impl LoadDensity {
    /// Returns the corners (rad/s); `None` for a table.
    pub fn corners(&self) -> Option<[f64; 2]> {
        Some([self.lower?.get(), self.upper?.get()])
    }

    /// Returns the time for which a run holds the load.
    pub fn step(&self) -> Span {
        let highest = self.knots().into_iter().fold(0.0, f64::max);
        Span::from_seconds(TAU / (STEPS * highest))
    }

    /// Returns the densities of the force along and the torque about x, y and z between the corners (N²/Hz, (N m)²/Hz).
    pub fn levels(&self) -> [f64; 6] {
        std::array::from_fn(|place| match place {
            0..3 => self.force[place].get(),
            _ => self.torque[place - 3].get(),
        })
    }

    /// Returns the rows of the table; empty without one.
    fn rows(&self) -> &[Vec<f64>] {
        self.table.as_ref().map_or(&[], |table| table.rows())
    }

    /// Returns the rows of the table: frequency (Hz), and densities of the force along and the torque about x, y and z (N²/Hz, (N m)²/Hz).
    pub(crate) fn table_rows(&self) -> Vec<(f64, [f64; 6])> {
        self.rows().iter().map(|row| (row[0], std::array::from_fn(|place| of_row(row, place)))).collect()
    }

    /// Returns true if the density has a part along or about an axis: the force along x, y and z, then the torque.
    pub fn has_part(&self, place: usize) -> bool {
        match self.rows().first() {
            Some(_) => self.rows().iter().any(|row| of_row(row, place) > 0.0),
            None => self.levels()[place] > 0.0,
        }
    }

    /// Returns the correlation of the components, in which those without a density are alone.
    fn correlations(&self) -> Matrix6<f64> {
        let given = self.correlation.as_deref().unwrap_or_default();
        Matrix6::from_fn(|row, column| {
            let own = given.get(row).and_then(|row| row.get(column)).map_or(0.0, |value| value.get());
            if row == column {
                1.0
            } else if self.has_part(row) && self.has_part(column) {
                own
            } else {
                0.0
            }
        })
    }

    /// Returns a factor F of the correlation of the components, F F': the components are F times independent ones.
    pub(crate) fn correlation_factor(&self) -> Matrix6<f64> {
        let correlations = self.correlations();
        if correlations == Matrix6::identity() {
            return correlations;
        }
        let SymmetricEigen { eigenvectors, eigenvalues } = correlations.symmetric_eigen();
        let roots = eigenvalues.map(|value| value.max(0.0).sqrt());
        eigenvectors * Matrix6::from_diagonal(&Vector6::from(roots)) * eigenvectors.transpose()
    }

    /// Returns the loads whose powers add up to that of the density: each component, and the sum of each pair that is correlated.
    pub fn loads(&self) -> Vec<Vec<usize>> {
        let single = (0..6).filter(|place| self.has_part(*place)).map(|place| vec![place]);
        single.chain(self.pairs().into_iter().map(|(pair, _)| pair.to_vec())).collect()
    }

    /// Returns the density of each of [`Self::loads`] at a frequency (rad/s): that of correlated components is less their common part, which
    /// may be negative.
    pub fn load_densities(&self, frequency: f64) -> Vec<f64> {
        let mut each = self.at(frequency);
        let densities = each;
        let mut common = Vec::new();
        for ([one, other], correlation) in self.pairs() {
            let both = correlation * f64::sqrt(densities[one] * densities[other]);
            each[one] -= both;
            each[other] -= both;
            common.push(both);
        }
        let single = (0..6).filter(|place| self.has_part(*place)).map(|place| each[place]);
        single.chain(common).collect()
    }

    /// Returns the pairs of components that are correlated.
    fn pairs(&self) -> Vec<([usize; 2], f64)> {
        let correlations = self.correlations();
        let pairs = (0..6).flat_map(|one| (one + 1..6).map(move |other| [one, other]));
        let pairs = pairs.map(|[one, other]| ([one, other], correlations[(one, other)]));
        pairs.filter(|(_, correlation)| *correlation != 0.0).collect()
    }

    /// Returns the reason for which the correlation is none.
    fn correlation_fault(&self) -> Option<String> {
        let given = self.correlation.as_ref()?;
        let size = given.len();
        if ![3, 6].contains(&size) || given.iter().any(|row| row.len() != size) {
            return Some("must have three rows of three numbers, or six of six".to_owned());
        }
        let at = |row: usize, column: usize| given[row][column].get();
        for row in 0..size {
            for column in 0..=row {
                let (one, other) = (at(row, column), at(column, row));
                if row == column && one != 1.0 {
                    return Some(format!("must have 1 on the diagonal, got {one} in row {}", row + 1));
                }
                if one != other {
                    let place = format!("rows {} and {}", column + 1, row + 1);
                    return Some(format!("must be symmetric, got {other} and {one} in {place}"));
                }
            }
        }
        let least = self.correlations().symmetric_eigenvalues().min();
        (least < LEAST).then(|| {
            format!(
                "must be positive semidefinite, or no components have it: its least eigenvalue is {least:.4}"
            )
        })
    }

    /// Returns the frequencies (rad/s) at which the density bends: its corners, or the rows of its table.
    pub fn knots(&self) -> Vec<f64> {
        match self.corners() {
            Some(corners) => corners.to_vec(),
            None => self.rows().iter().map(|row| TAU * row[0]).collect(),
        }
    }

    /// Returns the densities of the force along and the torque about x, y and z at a frequency (rad/s).
    pub fn at(&self, frequency: f64) -> [f64; 6] {
        if let Some([lower, upper]) = self.corners() {
            let low_pass = |corner: f64| {
                let x = frequency / corner;
                let rest = 1.0 - x * x;
                1.0 / (rest * rest + TWICE_DAMPING * TWICE_DAMPING * x * x)
            };
            let x = frequency / lower;
            let shape = x * x * x * x * low_pass(lower) * low_pass(upper);
            return self.levels().map(|level| level * shape);
        }
        let (rows, hertz) = (self.rows(), frequency / TAU);
        let next = rows.partition_point(|row| row[0] < hertz);
        let Some((before, after)) = next.checked_sub(1).and_then(|last| Some((&rows[last], rows.get(next)?)))
        else {
            return [0.0; 6];
        };
        let part = libm::log(hertz / before[0]) / libm::log(after[0] / before[0]);
        std::array::from_fn(|place| {
            let [one, other] = [before, after].map(|row| of_row(row, place));
            // Where a density begins or ends, there is no logarithm.
            if one > 0.0 && other > 0.0 { one * libm::pow(other / one, part) } else { 0.0 }
        })
    }

    /// Checks the density; returns the inconsistent key and the reason.
    pub fn validate(&self) -> Option<ConfigError> {
        let refused = |key: &str, why: String| Some(ConfigError::new(key, why));
        if let Some(table) = &self.table {
            if let Some(why) = table.fault() {
                return refused("table", why);
            }
            if let Some(why) = self.correlation_fault() {
                return refused("correlation", why);
            }
            let is_given = self.lower.is_some() || self.upper.is_some() || self.levels() != [0.0; 6];
            let why = "has the densities of `force` and `torque` at all frequencies: leave those and the corners out";
            return if is_given { refused("table", why.to_owned()) } else { None };
        }
        if self.levels() == [0.0; 6] {
            return refused("force", "must have a density along an axis, or `torque` about one".to_owned());
        }
        let corner = [("lower", self.lower), ("upper", self.upper)];
        if let Some((key, _)) = corner.iter().find(|(_, corner)| corner.is_none()) {
            return refused(key, "must be given: the corner of the density, or a `table`".to_owned());
        }
        if let Some(why) = self.correlation_fault() {
            return refused("correlation", why);
        }
        let [lower, upper] = self.corners()?;
        if lower >= upper {
            return refused("upper", format!("must be above `lower`, {lower} rad/s, got {upper}"));
        }
        let why = format!("must be at least {LEAST_RATIO} of `upper`, {upper} rad/s, got {lower}");
        if lower < LEAST_RATIO * upper { refused("lower", why) } else { None }
    }
}

/// Returns the density along or about an axis in a row of a table.
fn of_row(row: &[f64], place: usize) -> f64 {
    match (row.len(), place) {
        (2, 0..3) => row[1],
        _ => row.get(place + 1).copied().unwrap_or(0.0),
    }
}
