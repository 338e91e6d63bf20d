//! The magnetic field of a planet, which turns with it: a model of the Earth's, or a dipole through the centre, tilted
//! against the axis (\[Wertz78\]).

use std::path::Path;
use std::sync::Arc;

use flexsc_formats::document::ConfigError;
use flexsc_formats::harmonic_table::HarmonicTable;
use flexsc_numerics::attitude::Vector;
use flexsc_numerics::quantity::{Finite, Positive};
use flexsc_numerics::time::Span;
use flexsc_numerics::time_arcs::SplitTime;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::FieldModel;
use super::date::{greenwich, year};
use super::phase::Phase;
use super::spherical_harmonics::SphericalHarmonics;

/// Magnetic field of the orbit's planet: a model of the Earth's, or a tilted dipole, B = (a/R)³ (3 (g.r) r - g) with r
/// the direction from the planet's centre and g, which points south.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct MagneticField {
    /// Model of the field, which stays that of the `epoch` during the run and is refused outside its years;
    /// default: that of the `table`, else the dipole, and IGRF-14 in a scenario with an `epoch` unless
    /// `coefficients` or `radius` differ from their defaults.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub model: Option<FieldModel>,
    /// Gauss coefficients, or the path of their file: .shc, or .COF as of the World Magnetic Model.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub table: Option<HarmonicTable>,
    /// Degree up to which a model's spherical harmonics are taken, from 1 on; default: the model's highest, 13 of IGRF-14,
    /// 12 of WMM2025, and up to 13 of a table.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub degree: Option<u32>,
    /// Coefficients g11, h11 and g10 of a dipole (T), a vector in axes that rotate with the planet: z along its axis, x
    /// through its prime meridian; default: the Earth's from IGRF-13 for 2020.
    pub coefficients: [Finite; 3],
    /// Reference radius a of the coefficients of a dipole or a table (m); default: the Earth's mean radius.
    pub radius: Positive,
    /// Rotation rate of the planet (rad/s); default: the Earth's.
    pub rotation: Finite,
    /// Angle from the inertial x to the prime meridian at the start (rad); default: that of Greenwich at the
    /// scenario's `epoch`, so that field and Sun belong to one hour, 0 without one.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub meridian: Option<Finite>,
}

impl Default for MagneticField {
    /// Returns the field of the Earth.
    fn default() -> Self {
        Self {
            model: None,
            table: None,
            degree: None,
            coefficients: [-1450.9e-9, 4652.5e-9, -29_404.8e-9].map(|t| Finite::new(t).unwrap_or_default()),
            radius: Positive::new(6_371_200.0).unwrap_or(Positive::ONE),
            rotation: Finite::new(7.292_115e-5).unwrap_or_default(),
            meridian: None,
        }
    }
}

impl MagneticField {
    /// Returns the first key of the dipole that differs from its default.
    fn dipole_key(&self) -> Option<&'static str> {
        let earth = Self::default();
        let keys = [
            ("coefficients", self.coefficients != earth.coefficients),
            ("radius", self.radius != earth.radius),
        ];
        keys.into_iter().find(|(_, differs)| *differs).map(|(key, _)| key)
    }

    /// Returns the model of the field in a scenario with a date of its start, or without.
    pub fn model(&self, has_date: bool) -> FieldModel {
        let default = match self.dipole_key() {
            _ if self.table.is_some() => FieldModel::Table,
            None if has_date => FieldModel::Igrf14,
            _ => FieldModel::Dipole,
        };
        self.model.unwrap_or(default)
    }

    /// Returns the highest degree of a model with the table's coefficients.
    fn highest_degree(&self, model: FieldModel) -> usize {
        let own = self.table.as_ref().filter(|_| model == FieldModel::Table);
        own.map_or(usize::MAX, HarmonicTable::degree).min(model.highest_degree())
    }

    /// Reads the file of a table relative to `directory`, or takes the coefficients of `other` if that has read the same file;
    /// returns a key within the field and the reason.
    pub fn read(&mut self, directory: &Path, other: Option<&Self>) -> Option<ConfigError> {
        let table = self.table.as_mut()?;
        table.locate(directory);
        let other = other.and_then(|other| other.table.as_ref());
        table.read(other).err().map(|why| ConfigError::new("table", why))
    }

    /// Replaces the reference to the file of a table by its coefficients.
    pub(super) fn inline(&mut self) {
        if let Some(table) = &mut self.table {
            table.inline(FieldModel::Table.highest_degree());
        }
    }

    /// Checks the field's keys against each other and against a run of this duration from `epoch_ns` nanoseconds after
    /// 1970, if known; returns the key and the reason.
    pub(super) fn run_error(&self, duration: Span, epoch_ns: Option<u64>) -> Option<ConfigError> {
        let model = self.model(epoch_ns.is_some());
        let (name, highest) = (model.name(), self.highest_degree(model));
        if self.table.is_some() != (model == FieldModel::Table) {
            let why = if self.table.is_some() {
                format!("is for the model \"table\", and the model is \"{name}\": leave it out")
            } else {
                "must be given for the model \"table\"".to_owned()
            };
            return Some(ConfigError::new("table", why));
        }
        let given = self.dipole_key().filter(|key| model != FieldModel::Table || *key == "coefficients");
        if let Some(key) = given.filter(|_| model != FieldModel::Dipole) {
            let why = format!("is for the model \"dipole\", and the model is \"{name}\": leave it out");
            return Some(ConfigError::new(key, why));
        }
        if let Some(degree) = self.degree.filter(|degree| !(1..=highest).contains(&(*degree as usize))) {
            let range = if highest == 1 { "1".to_owned() } else { format!("from 1 to {highest}") };
            let why = format!("must be {range} with the model \"{name}\", got {degree}");
            return Some(ConfigError::new("degree", why));
        }
        model.date_error(self.table.as_ref(), epoch_ns, duration)
    }
}

/// Magnetic field of a planet in a run.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct PlanetField {
    source: FieldSource,
    /// Rotation rate of the planet (rad/s).
    pub rotation: f64,
    /// Angle from the inertial x to the prime meridian at the start (rad).
    meridian: f64,
}

/// Source of a planet's field, in axes that rotate with the planet.
#[derive(Clone, Debug, PartialEq)]
enum FieldSource {
    /// Dipole, as the vector (g11, h11, g10) (T) with its reference radius (m).
    Dipole(Vector, f64),
    /// Spherical harmonics.
    Harmonics(Arc<SphericalHarmonics>),
}

impl PlanetField {
    /// Creates the field of a scenario that begins `epoch_ns` nanoseconds after 1970, UTC, if known. The coefficients of
    /// a model are those at the start.
    pub fn new(field: &MagneticField, epoch_ns: Option<u64>) -> Self {
        let model = field.model(epoch_ns.is_some());
        let degree = field.degree.map_or(field.highest_degree(model), |degree| degree as usize);
        let dipole =
            || FieldSource::Dipole(Vector::from(field.coefficients.map(Finite::get)), field.radius.get());
        let table = field.table.as_ref().filter(|_| model == FieldModel::Table);
        let tabulated = table.map(|table| {
            let rows = table.coefficients(degree, year(epoch_ns.unwrap_or(0) as f64 / 1e9));
            let tesla = rows.into_iter().map(|row| row.map(|part| part * 1e-9));
            SphericalHarmonics::new(field.radius.get(), degree, tesla)
        });
        let source = tabulated.or_else(|| model.harmonics(degree, epoch_ns.unwrap_or(0)));
        Self {
            source: source.map_or_else(dipole, |source| FieldSource::Harmonics(Arc::new(source))),
            rotation: field.rotation.get(),
            meridian: field.meridian.map_or_else(|| epoch_ns.map_or(0.0, greenwich), Finite::get),
        }
    }

    /// Returns the highest degree of the spherical harmonics, 1 of a dipole.
    pub fn degree(&self) -> usize {
        match &self.source {
            FieldSource::Dipole(..) => 1,
            FieldSource::Harmonics(harmonics) => harmonics.degree(),
        }
    }

    /// Returns the field of the degrees up to `degree`.
    pub fn truncated(&self, degree: usize) -> Self {
        let source = match &self.source {
            dipole @ FieldSource::Dipole(..) => dipole.clone(),
            FieldSource::Harmonics(harmonics) => {
                FieldSource::Harmonics(Arc::new(harmonics.truncated(degree)))
            }
        };
        Self { source, ..*self }
    }

    /// Returns sine and cosine of the angle from the inertial x to the prime meridian at a time since the start.
    fn turned(&self, t: SplitTime) -> (f64, f64) {
        libm::sincos(Phase { start: self.meridian, rate: [self.rotation, 0.0] }.at(t))
    }

    /// Returns the field (T) at a position from the planet's centre (m), both in inertial axes, at a time since the
    /// start.
    pub fn at(&self, position: &Vector, t: impl Into<SplitTime>) -> Vector {
        let (sin, cos) = self.turned(t.into());
        match &self.source {
            FieldSource::Dipole(coefficients, radius) => {
                let [x, y, z] = (*coefficients).into();
                let south = Vector::new(cos * x - sin * y, sin * x + cos * y, z);
                let distance = position.norm();
                let (up, ratio) = (position / distance, radius / distance);
                (up * (3.0 * south.dot(&up)) - south) * (ratio * ratio * ratio)
            }
            FieldSource::Harmonics(harmonics) => {
                let [x, y, z] = (*position).into();
                let field = harmonics.at(&Vector::new(cos * x + sin * y, cos * y - sin * x, z));
                Vector::new(cos * field.x - sin * field.y, sin * field.x + cos * field.y, field.z)
            }
        }
    }

    /// Returns the field (T) with its first two derivatives in inertial axes, from position (m), velocity and acceleration in
    /// inertial axes, at a time since the start (s).
    pub fn motion(&self, motion: [Vector; 3], t: f64) -> [Vector; 3] {
        let (sin, cos) = self.turned(t.into());
        let turn = Vector::z() * self.rotation;
        let [position, velocity, acceleration] =
            motion.map(|v| Vector::new(cos * v.x + sin * v.y, cos * v.y - sin * v.x, v.z));
        let velocity = velocity - turn.cross(&position);
        let carried = turn.cross(&velocity) * 2.0 + turn.cross(&turn.cross(&position));
        let [field, rate, change] = self.harmonics().motion([position, velocity, acceleration - carried]);
        let change = change + turn.cross(&rate) * 2.0 + turn.cross(&turn.cross(&field));
        [field, rate + turn.cross(&field), change]
            .map(|v| Vector::new(cos * v.x - sin * v.y, sin * v.x + cos * v.y, v.z))
    }

    /// Returns an upper bound of the rate of the field (T/s) for a body that moves at up to `speed` (m/s) between two distances
    /// from the centre (m).
    pub fn rate_bound(&self, [nearest, farthest]: [f64; 2], speed: f64) -> f64 {
        let turn = self.rotation.abs();
        self.harmonics().gradient_bound(nearest) * (speed + turn * farthest) + turn * self.bound(nearest)
    }

    /// Returns the spherical harmonics, of a dipole those of degree 1.
    fn harmonics(&self) -> Arc<SphericalHarmonics> {
        match &self.source {
            FieldSource::Harmonics(harmonics) => harmonics.clone(),
            FieldSource::Dipole(coefficients, radius) => {
                let rows = [[coefficients.z, 0.0], [coefficients.x, coefficients.y]];
                Arc::new(SphericalHarmonics::new(*radius, 1, rows.into_iter()))
            }
        }
    }

    /// Returns an upper bound of the field's size (T) where time, and with it the position, has an imaginary part: as for
    /// [`SphericalHarmonics::complex_bound`], without the planet's rotation.
    pub fn complex_bound(&self, distance: f64, stretch: f64) -> f64 {
        self.harmonics().complex_bound(distance, stretch)
    }

    /// Returns an upper bound of the field (T) at this distance from the centre (m) and beyond.
    pub fn bound(&self, distance: f64) -> f64 {
        match &self.source {
            FieldSource::Dipole(coefficients, radius) => {
                let ratio = radius / distance;
                2.0 * coefficients.norm() * ratio * ratio * ratio
            }
            FieldSource::Harmonics(harmonics) => harmonics.bound(distance),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::environment::Kepler;

    #[test]
    fn without_a_tilt_it_is_that_of_the_local_axes() {
        // Expected field: b (cos u sin i, -cos i, 2 sin u sin i) in local axes, at the angle u past the ascending node.
        let field: MagneticField =
            flexsc_formats::document::from_text("coefficients = [0, 0, -3e-5]\nradius = 6.4e6").unwrap();
        let field = PlanetField::new(&field, None);
        let (inclination, radius) = (0.9, 7e6);
        let orbit: Kepler = flexsc_formats::document::from_text(&format!(
            "semi_major_axis = {radius}\ninclination = {inclination}\nnode = 0.4\nperigee = 0.3\nanomaly = 0.2"
        ))
        .unwrap();
        let strength = 3e-5 * libm::pow(6.4e6 / radius, 3.0);
        let (across, along) = libm::sincos(inclination);
        for t in [0.0, 500.0, 4000.0] {
            let place = orbit.at(t);
            let (sin, cos) = libm::sincos(0.5 + orbit.mean_motion() * t);
            let exact = Vector::new(cos * across, -along, 2.0 * sin * across) * strength;
            let found = field.at(&place.position, t);
            let local = Vector::from(place.local.map(|axis| axis.dot(&found)));
            assert!((local - exact).norm() < 1e-13 * strength, "{t} {local} {exact}");
            assert!(found.norm() <= field.bound(radius));
        }
    }

    #[test]
    fn with_a_date_its_meridian_is_that_of_greenwich_unless_it_is_a_key() {
        let date = Some(1_774_017_960_000_000_000);
        let dipole = MagneticField { model: Some(FieldModel::Dipole), ..MagneticField::default() };
        let given = MagneticField { meridian: Finite::new(0.691_984_659), ..dipole.clone() };
        let position = Vector::new(7e6, -1e6, 2e6);
        let at = |field: &MagneticField, date| PlanetField::new(field, date).at(&position, 900.0);
        assert!((at(&dipole, date) - at(&given, None)).norm() < 1e-13);
        assert_eq!(at(&given, date), at(&given, None));
        assert_ne!(at(&dipole, date), at(&dipole, None));
    }

    #[test]
    fn a_model_turns_with_the_planet() {
        // 2026-03-20T14:46:00Z.
        let date = Some(1_774_017_960_000_000_000);
        let at = |meridian: f64, position: &Vector, t: f64| {
            let field = MagneticField { meridian: Finite::new(meridian), ..MagneticField::default() };
            PlanetField::new(&field, date).at(position, t)
        };
        let turned = |v: &Vector, angle: f64| {
            let (sin, cos) = libm::sincos(angle);
            Vector::new(cos * v.x - sin * v.y, sin * v.x + cos * v.y, v.z)
        };
        let position = Vector::new(5e6, -3e6, 4e6);
        let fixed = at(0.0, &position, 0.0);
        for (meridian, t) in [(0.7, 0.0), (0.0, 9000.0), (2.0, 50_000.0)] {
            let angle = meridian + 7.292_115e-5 * t;
            let off = at(meridian, &turned(&position, angle), t) - turned(&fixed, angle);
            assert!(off.norm() < 1e-18, "{meridian} {t} {off}");
        }
        // The default meridian is that of Greenwich.
        let default = PlanetField::new(&MagneticField::default(), date).at(&position, 900.0);
        assert!((default - at(0.691_984_659, &position, 900.0)).norm() < 1e-12);
    }

    #[test]
    fn the_earths_is_29_8_microtesla_over_its_magnetic_equator_and_turns_with_it() {
        let earth = MagneticField::default();
        let axis = Vector::from(earth.coefficients.map(Finite::get)).normalize();
        let field = PlanetField::new(&earth, None);
        let across = axis.cross(&Vector::x()).normalize() * 6_371_200.0;
        assert!(
            (field.at(&across, 0.0).norm() - 29_805.924e-9).abs() < 1e-12,
            "{}",
            field.at(&across, 0.0).norm()
        );
        assert!((field.at(&(axis * 6_371_200.0), 0.0).norm() - 2.0 * 29_805.924e-9).abs() < 2e-12);
        // The dipole is tilted by 9.4 degrees against the axis.
        assert!((libm::acos(-axis.z) - 0.164).abs() < 1e-3);
        let position = Vector::new(7e6, -1e6, 2e6);
        let quarter = std::f64::consts::FRAC_PI_2 / 7.292_115e-5;
        let rotated = Vector::new(1e6, 7e6, 2e6);
        let [before, after] = [field.at(&position, 0.0), field.at(&rotated, quarter)];
        assert!((Vector::new(-before.y, before.x, before.z) - after).norm() < 1e-18);
    }
}
