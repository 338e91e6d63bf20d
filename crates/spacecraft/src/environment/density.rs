//! Density of the atmosphere: exponential, by Harris and Priester, or by a table.
//!
//! The model of Harris and Priester, in the form of \[MontenbruckGill00\], has a least density at night and a largest in the
//! bulge of the day, which follows the Sun by 30 degrees. Between them the density is rho_m + (rho_M - rho_m) cos^n(psi/2),
//! with the angle psi to the bulge's apex.

use std::sync::LazyLock;

use flexsc_formats::density_table::DensityTable;
use flexsc_numerics::attitude::Vector;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Model of the density.
#[derive(Copy, Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum DensityModel {
    /// Exponential with one scale height, or uniform.
    #[default]
    Exponential,
    /// Harris and Priester, for mean solar activity: of the Earth, from 100 to 1000 km, with a bulge 30 degrees
    /// behind the Sun.
    HarrisPriester,
    /// Table of heights and densities.
    Table,
}

impl DensityModel {
    /// Returns true for the exponential model.
    pub fn is_exponential(&self) -> bool {
        *self == Self::Exponential
    }
}

/// Angle by which the bulge follows the Sun (rad).
const LAG: f64 = 30.0 * std::f64::consts::PI / 180.0;

/// Height (km), and density by night and in the bulge (g/km³), for mean solar activity.
#[rustfmt::skip]
const HARRIS_PRIESTER: [[f64; 3]; 50] = [
    [100.0, 497_400.0, 497_400.0], [120.0, 24_900.0, 24_900.0], [130.0, 8_377.0, 8_710.0],
    [140.0, 3_899.0, 4_059.0], [150.0, 2_122.0, 2_215.0], [160.0, 1_263.0, 1_344.0],
    [170.0, 800.8, 875.8], [180.0, 528.3, 601.0], [190.0, 361.7, 429.7], [200.0, 255.7, 316.2],
    [210.0, 183.9, 239.6], [220.0, 134.1, 185.3], [230.0, 99.49, 145.5], [240.0, 74.88, 115.7],
    [250.0, 57.09, 93.08], [260.0, 44.03, 75.55], [270.0, 34.30, 61.82], [280.0, 26.97, 50.95],
    [290.0, 21.39, 42.26], [300.0, 17.08, 35.26], [320.0, 10.99, 25.11], [340.0, 7.214, 18.19],
    [360.0, 4.824, 13.37], [380.0, 3.274, 9.955], [400.0, 2.249, 7.492], [420.0, 1.558, 5.684],
    [440.0, 1.091, 4.355], [460.0, 0.7701, 3.362], [480.0, 0.5474, 2.612], [500.0, 0.3916, 2.042],
    [520.0, 0.2819, 1.605], [540.0, 0.2042, 1.267], [560.0, 0.1488, 1.005], [580.0, 0.1092, 0.7997],
    [600.0, 0.08070, 0.6390], [620.0, 0.06012, 0.5123], [640.0, 0.04519, 0.4121],
    [660.0, 0.03430, 0.3325], [680.0, 0.02632, 0.2691], [700.0, 0.02043, 0.2185],
    [720.0, 0.01607, 0.1779], [740.0, 0.01281, 0.1452], [760.0, 0.01036, 0.1190],
    [780.0, 0.008_496, 0.09776], [800.0, 0.007_069, 0.08059], [840.0, 0.004_680, 0.05741],
    [880.0, 0.003_200, 0.04210], [920.0, 0.002_210, 0.03130], [960.0, 0.001_560, 0.02360],
    [1000.0, 0.001_150, 0.01810],
];

/// Lowest height of the model of Harris and Priester (m).
pub(super) const LOWEST: f64 = 100e3;

/// Densities that are exponential in the height between rows, and beyond them by the ends.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct DensityRows<const COLUMNS: usize>(Vec<DensityStretch<COLUMNS>>);

/// Densities from a row to the next.
#[derive(Copy, Clone, Debug, PartialEq)]
struct DensityStretch<const COLUMNS: usize> {
    /// Height of the row (m).
    height: f64,
    /// Densities there (kg/m³).
    densities: [f64; COLUMNS],
    /// Rates of their logarithms (1/m).
    slopes: [f64; COLUMNS],
}

impl<const COLUMNS: usize> DensityRows<COLUMNS> {
    /// Creates the densities (kg/m³) from at least two rows with increasing heights (m).
    fn new(rows: &[(f64, [f64; COLUMNS])]) -> Self {
        let stretch = |pair: &[(f64, [f64; COLUMNS])]| {
            let ((height, densities), (next, later)) = (pair[0], pair[1]);
            let slope = |column: usize| libm::log(later[column] / densities[column]) / (next - height);
            DensityStretch { height, densities, slopes: std::array::from_fn(slope) }
        };
        Self(rows.windows(2).map(stretch).collect())
    }

    /// Returns the densities (kg/m³) at a height (m).
    pub fn at(&self, height: f64) -> [f64; COLUMNS] {
        let past = self.0.partition_point(|row| row.height <= height);
        let row = &self.0[past.clamp(1, self.0.len()) - 1];
        std::array::from_fn(|column| {
            row.densities[column] * libm::exp((height - row.height) * row.slopes[column])
        })
    }
}

impl DensityRows<1> {
    /// Returns the largest density (kg/m³) between two heights (m), at one of them or at a row.
    pub fn largest(&self, [low, high]: [f64; 2]) -> f64 {
        let rows = self.0.iter().filter(|row| (low..=high).contains(&row.height)).map(|row| row.densities[0]);
        rows.chain([low, high].map(|height| self.at(height)[0])).fold(0.0, f64::max)
    }
}

static RANGES: LazyLock<DensityRows<2>> = LazyLock::new(|| {
    let rows = HARRIS_PRIESTER.map(|[height, night, bulge]| (1e3 * height, [1e-12 * night, 1e-12 * bulge]));
    DensityRows::new(&rows)
});

/// Returns the least and the largest density (kg/m³) of Harris and Priester at a height (m).
pub(super) fn harris_priester_range(height: f64) -> [f64; 2] {
    RANGES.at(height)
}

/// Returns the cosine of the angle between a position in inertial axes and the bulge's apex, with the direction of the Sun.
pub(super) fn bulge_cosine(position: &Vector, sun: &Vector) -> f64 {
    let (sin, cos) = libm::sincos(LAG);
    let apex = Vector::new(cos * sun.x - sin * sun.y, sin * sun.x + cos * sun.y, sun.z);
    position.dot(&apex) / position.norm()
}

/// Returns the density (kg/m³) of Harris and Priester at a height (m) and a cosine of the angle from the bulge, with the
/// exponent n of the bulge.
pub(super) fn harris_priester(height: f64, bulge_cosine: f64, exponent: f64) -> f64 {
    // cos²(psi/2).
    let squared = (0.5 + 0.5 * bulge_cosine).max(0.0);
    let [least, largest] = harris_priester_range(height);
    let part = if exponent == 4.0 { squared * squared } else { libm::pow(squared, 0.5 * exponent) };
    least + (largest - least) * part
}

/// Returns the densities (kg/m³) of a table by height.
pub(super) fn tabulated(table: &DensityTable) -> DensityRows<1> {
    let rows: Vec<(f64, [f64; 1])> = table.rows().iter().map(|row| (row[0], [row[1]])).collect();
    DensityRows::new(&rows)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::environment::ground_site;

    /// Densities (kg/m³) by `brahe` 1.8.0, whose bulge has cos^6(psi/2), under a Sun along (0.9, 0.4, 0.17).
    #[test]
    fn harris_priester_is_that_of_another_program() {
        let sun = Vector::new(0.9, 0.4, 0.17).normalize();
        for (position, density) in [
            ([6_878_137.0, 0.0, 0.0], 1.204_912_444_045_727_3e-12),
            ([-4.2e6, 4.1e6, 3.5e6], 1.318_557_517_542_684_4e-12),
            ([1.0e6, 2.0e6, 6.6e6], 2.718_018_310_404_475e-13),
            ([5.0e6, 4.3e6, -1.9e6], 2.073_225_210_692_086_6e-12),
            ([0.0, -7.2e6, 1e5], 5.668_066_129_231_358e-15),
        ] {
            let position = Vector::from(position);
            let found = harris_priester(ground_site::height(&position), bulge_cosine(&position, &sun), 6.0);
            assert!((found / density - 1.0).abs() < 1e-6, "{position}: {found:e} {density:e}");
        }
        // Rows of the table, by night and in the bulge.
        assert_eq!(harris_priester_range(400e3).map(|density| (density * 1e15).round()), [2249.0, 7492.0]);
    }

    #[test]
    fn tables_are_exponential_between_rows() {
        let table: DensityTable = serde_json::from_str("[[4e5, 4e-12], [5e5, 1e-12], [7e5, 1e-13]]").unwrap();
        assert_eq!(table.fault(), None);
        let at = |height: f64| tabulated(&table).at(height)[0];
        assert!((at(4.5e5) / 2e-12 - 1.0).abs() < 1e-14);
        assert!((at(7e5) / 1e-13 - 1.0).abs() < 1e-14);
        assert!((at(6e5) / f64::sqrt(1e-25) - 1.0).abs() < 1e-14);
    }
}
