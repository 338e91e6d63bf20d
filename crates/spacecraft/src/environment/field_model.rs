//! Models of the Earth's magnetic field: their coefficients at a date.

use flexsc_formats::document::ConfigError;
use flexsc_formats::harmonic_table::HarmonicTable;
use flexsc_numerics::time::Span;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::date::year;
use super::spherical_harmonics::{MOST_DEGREES, SphericalHarmonics};
use super::{igrf_14, wmm_2025};

/// Reference radius of the models (m).
const RADIUS: f64 = 6_371_200.0;

/// Last year of both models.
const LAST_YEAR: f64 = 2030.0;

/// Model of a planet's magnetic field.
#[derive(Copy, Clone, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
pub enum FieldModel {
    /// A dipole through the planet's centre, constant in the planet's axes.
    #[serde(rename = "dipole")]
    Dipole,
    /// The International Geomagnetic Reference Field, 14th generation, for 2000 to 2030.
    #[serde(rename = "IGRF-14")]
    Igrf14,
    /// The World Magnetic Model for 2025 to 2030.
    #[serde(rename = "WMM2025")]
    Wmm2025,
    /// Coefficients of the scenario or of a file.
    #[serde(rename = "table")]
    Table,
}

impl FieldModel {
    /// Returns the model's name in a scenario.
    pub fn name(self) -> &'static str {
        match self {
            Self::Dipole => "dipole",
            Self::Igrf14 => "IGRF-14",
            Self::Wmm2025 => "WMM2025",
            Self::Table => "table",
        }
    }

    /// Returns the highest degree of the model, the highest of any table.
    pub fn highest_degree(self) -> usize {
        match self {
            Self::Dipole => 1,
            Self::Igrf14 | Self::Table => MOST_DEGREES,
            Self::Wmm2025 => 12,
        }
    }

    /// Returns the first year of the model.
    fn first_year(self) -> f64 {
        if self == Self::Igrf14 { 2000.0 } else { 2025.0 }
    }

    /// Returns the years of the model, of a table those of its own; `None` if it does not depend on the date.
    fn years(self, table: Option<&HarmonicTable>) -> Option<[f64; 2]> {
        match self {
            Self::Dipole => None,
            Self::Igrf14 | Self::Wmm2025 => Some([self.first_year(), LAST_YEAR]),
            Self::Table => table?.years(),
        }
    }

    /// Checks that the model covers a run of this duration from `epoch_ns` nanoseconds after 1970, UTC; returns the key and
    /// the reason if not.
    pub(super) fn date_error(
        self,
        table: Option<&HarmonicTable>,
        epoch_ns: Option<u64>,
        duration: Span,
    ) -> Option<ConfigError> {
        let (name, [first, last]) = (self.name(), self.years(table)?);
        let key = if self == Self::Table { "table" } else { "model" };
        let Some(epoch_ns) = epoch_ns else {
            let why = format!(
                "depends on the date with \"{name}\": it needs the scenario's `epoch`, and there is none"
            );
            return Some(ConfigError::new(key, why));
        };
        let start = epoch_ns as f64 / 1e9;
        let (from, to) = (year(start), year(start + duration.seconds()));
        let igrf = Self::Igrf14.first_year();
        let other = if self != Self::Igrf14 && from >= igrf && to <= LAST_YEAR {
            format!("use \"{}\", which covers {igrf} to {LAST_YEAR}", Self::Igrf14.name())
        } else {
            "use \"dipole\" outside".to_owned()
        };
        let why = || {
            format!(
                "covers {first} to {last} with \"{name}\", and the run is from {from:.2} to {to:.2}: {other}"
            )
        };
        (from < first || to > last).then(|| ConfigError::new(key, why()))
    }

    /// Returns the field up to a degree at `epoch_ns` nanoseconds after 1970, UTC; `None` for the dipole and for tables, which
    /// have coefficients of their own.
    pub(super) fn harmonics(self, degree: usize, epoch_ns: u64) -> Option<SphericalHarmonics> {
        self.harmonics_in(degree, year(epoch_ns as f64 / 1e9))
    }

    fn harmonics_in(self, degree: usize, year: f64) -> Option<SphericalHarmonics> {
        let since = year - self.first_year();
        let new = |rows: &mut dyn Iterator<Item = [f64; 2]>| {
            SphericalHarmonics::new(RADIUS, degree, rows.map(|row| row.map(|part| part * 1e-9)))
        };
        match self {
            Self::Dipole | Self::Table => None,
            Self::Igrf14 => {
                // Linear between the epochs of every five years, and from the last one on with the rate.
                let epoch = ((since / 5.0) as usize).min(5);
                let rest = since - 5.0 * epoch as f64;
                let at = |row: &[f64; 7]| {
                    let rate = if epoch == 5 { row[6] } else { (row[epoch + 1] - row[epoch]) / 5.0 };
                    row[epoch] + rate * rest
                };
                Some(new(&mut igrf_14::COEFFICIENTS.iter().map(|[g, h]| [at(g), at(h)])))
            }
            Self::Wmm2025 => {
                let at = |[value, rate]: &[f64; 2]| value + rate * since;
                Some(new(&mut wmm_2025::COEFFICIENTS.iter().map(|[g, h]| [at(g), at(h)])))
            }
        }
    }
}

#[cfg(test)]
mod tests;
