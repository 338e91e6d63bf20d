//! Broadband forces and torques at a point: their one-sided spectral densities over frequency.

use std::f64::consts::TAU;

use flexsc_formats::document::ConfigError;
use flexsc_formats::load_density_table::LoadDensityTable;
use flexsc_numerics::quantity::{NonNegative, Positive};
use flexsc_numerics::time::Span;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Twice the damping ratio of the two filters that make the corners.
pub(crate) const TWICE_DAMPING: f64 = 1.4;
/// Steps of a run in a period of the upper corner: the mean over a step is held for it, which takes 1.6 % of the density at the corner.
pub(crate) const STEPS: f64 = 20.0;

/// Least ratio of the corners, at which the filters of runs keep half of the digits.
pub(crate) const LEAST_RATIO: f64 = 1e-8;

/// Reason why a table is refused in runs.
pub const TABLE_HAS_NO_RUN: &str = "has no run: `spectrum` has it; for runs give `force` or `torque` between the corners `lower` and `upper`";

/// Stationary Gaussian force and torque at a point, whose components are independent: one-sided densities that are constant between two
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

    /// Returns the time for which a run holds the load (s); `None` for a table.
    pub fn step(&self) -> Option<Span> {
        self.corners().map(|[_, upper]| Span::from_seconds(TAU / (STEPS * upper)))
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

    /// Returns true if the density has a part along or about an axis: the force along x, y and z, then the torque.
    pub fn has_part(&self, place: usize) -> bool {
        match self.rows().first() {
            Some(_) => self.rows().iter().any(|row| of_row(row, place) > 0.0),
            None => self.levels()[place] > 0.0,
        }
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
