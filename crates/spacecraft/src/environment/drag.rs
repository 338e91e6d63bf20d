//! Drag of the atmosphere on plates, as a torque: the orbit does not change (\[Wertz78\]).
//!
//! On a plate of area A and outward normal n that moves at v relative to the air, the force is -rho/2 C A (n.v) v where
//! n.v > 0, and zero otherwise: a plate with two sides is two plates. The atmosphere turns with the planet.

use std::path::Path;

use flexsc_dynamics::three_axis::{PanelPlaces, SkyAt};
use flexsc_formats::density_table::DensityTable;
use flexsc_formats::document::ConfigError;
use flexsc_numerics::attitude::Vector;
use flexsc_numerics::quantity::{DensityFactor, Finite, Positive};
use nalgebra::Matrix3;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::density::{DensityRows, LOWEST};
use super::orbit::transformed;
use super::plate_mount::{MountedPlate, PlateMounts};
use super::sky_row::SkyRow;
use super::{DensityModel, OrbitKind, OrbitPath, density, ground_site};

/// Drag of the atmosphere.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Drag {
    /// Model of the density; default: exponential.
    #[serde(default, skip_serializing_if = "DensityModel::is_exponential")]
    pub model: DensityModel,
    /// Density of the exponential model (kg/m³), at `altitude`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub density: Option<Positive>,
    /// Scale height, in which the density falls to 1/e (m); default: the density is uniform.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub scale_height: Option<Positive>,
    /// Height above the planet's radius at which `density` holds (m), required with a `tle` or an `ephemeris`;
    /// default: that of the semi-major axis.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub altitude: Option<Positive>,
    /// Heights above the ellipsoid of WGS 84 and densities (m, kg/m³) of the model `table`, exponential between
    /// rows, or the path of a .csv file; they must cover the orbit.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub table: Option<DensityTable>,
    /// Exponent n of the bulge in the model of Harris and Priester: 2 for orbits near the equator, 6 for polar ones;
    /// default: 4.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub bulge_exponent: Option<Positive>,
    /// Factor of the density, of every model, from 0.001 to 1000, for campaigns and worst cases; default: 1.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub scale: Option<DensityFactor>,
    /// Drag coefficient.
    #[serde(default = "coefficient")]
    pub coefficient: Positive,
    /// Rotation rate of the atmosphere with the planet (rad/s); default: the Earth's.
    #[serde(default = "rotation")]
    pub rotation: Finite,
    /// The plates: the force is -rho/2 C A (n.v) v where the outward normal n faces the flow; a plate with two
    /// sides is two entries.
    pub plates: Vec<DragPlate>,
}

/// A plate; drag acts on one side of it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(rename = "Plate")]
pub struct DragPlate {
    /// Area (m²).
    pub area: Positive,
    /// Outward normal in the body's axes, of any length.
    pub normal: [Finite; 3],
    /// Position of its centre (m): from the point O of a spacecraft, or from the centre of mass of a spatial body.
    pub at: [Finite; 3],
    /// Name of the appendage on which the plate is, with which it turns; `normal` and `at` are then in its axes, from its root;
    /// default: the hub.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub appendage: Option<String>,
}

fn coefficient() -> Positive {
    Positive::new(2.2).unwrap_or(Positive::ONE)
}

fn rotation() -> Finite {
    Finite::new(7.292_115e-5).unwrap_or_default()
}

/// Exponent of the bulge between those of equatorial and polar orbits.
const BULGE_EXPONENT: f64 = 4.0;

impl Drag {
    /// Returns an inconsistency between values: a key within the drag, and the reason.
    pub(super) fn fault(&self, orbit: Option<&OrbitKind>, has_sun: bool) -> Option<ConfigError> {
        let Some(orbit) = orbit else {
            return Some(ConfigError::new("", "needs an `orbit`, and there is none"));
        };
        if let Some(fault) = self.model_fault(orbit, has_sun) {
            return Some(fault);
        }
        let flat = |plate: &DragPlate| plate.normal.iter().all(|part| part.get() == 0.0);
        let index = self.plates.iter().position(flat)?;
        Some(ConfigError::new(format!("plates[{index}].normal"), "must not be zero, got [0, 0, 0]"))
    }

    /// Checks the keys of the density; returns a key and the reason.
    fn model_fault(&self, orbit: &OrbitKind, has_sun: bool) -> Option<ConfigError> {
        let (exponential, harris, table) =
            (DensityModel::Exponential, DensityModel::HarrisPriester, DensityModel::Table);
        let given = [
            ("density", self.density.is_some(), exponential, "exponential"),
            ("scale_height", self.scale_height.is_some(), exponential, "exponential"),
            ("altitude", self.altitude.is_some(), exponential, "exponential"),
            ("bulge_exponent", self.bulge_exponent.is_some(), harris, "harris_priester"),
            ("table", self.table.is_some(), table, "table"),
        ];
        let other = given.into_iter().find(|(_, is_given, model, _)| *is_given && *model != self.model);
        if let Some((key, .., model)) = other {
            return Some(ConfigError::new(key, format!("is for `model = \"{model}\"`: leave it out")));
        }
        match self.model {
            DensityModel::Exponential if self.density.is_none() => {
                Some(ConfigError::new("density", "must be given for the exponential model"))
            }
            DensityModel::Exponential if self.altitude.is_none() && orbit.kepler().is_none() => {
                let why = "must be given with a `tle` or an `ephemeris`: the height at which `density` holds";
                Some(ConfigError::new("altitude", why))
            }
            DensityModel::HarrisPriester if !has_sun => {
                let why = "\"harris_priester\" has a bulge towards `environment.sun`, and there is none";
                Some(ConfigError::new("model", why))
            }
            DensityModel::HarrisPriester => {
                let exponent = self.bulge_exponent.map(Positive::get).filter(|exponent| *exponent > 20.0)?;
                Some(ConfigError::new("bulge_exponent", format!("must be at most 20, got {exponent}")))
            }
            DensityModel::Table => match &self.table {
                None => Some(ConfigError::new("table", "must be given for `model = \"table\"`")),
                Some(table) => table.fault().map(|why| ConfigError::new("table", why)),
            },
            DensityModel::Exponential => None,
        }
    }

    /// Checks that the density is known on the whole orbit; returns a key and the reason.
    pub(super) fn run_fault(&self, orbit: &OrbitPath) -> Option<ConfigError> {
        let [low, high] = heights(orbit);
        match (self.model, &self.table) {
            (DensityModel::HarrisPriester, _) if low < LOWEST => {
                let why = format!(
                    "\"harris_priester\" begins at {LOWEST} m, and the orbit goes down to {low:.0} m"
                );
                Some(ConfigError::new("model", why))
            }
            (DensityModel::Table, Some(table)) => {
                let (from, to) = (table.rows().first()?.first()?, table.rows().last()?.first()?);
                (*from > low || *to < high).then(|| {
                    let why = format!(
                        "must have heights from {low:.0} to {high:.0} m, where the orbit is, got {from} to {to} m"
                    );
                    ConfigError::new("table", why)
                })
            }
            _ => None,
        }
    }

    /// Reads the file of a table relative to `directory`; returns a key within the drag and the reason.
    pub fn read(&mut self, directory: &Path) -> Option<ConfigError> {
        let table = self.table.as_mut()?;
        table.read(directory).err().map(|why| ConfigError::new("table", why))
    }
}

/// Drag on a body during a run.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct DragLoad {
    air: Air,
    /// Factor of the density.
    scale: f64,
    coefficient: f64,
    /// Rotation rate of the atmosphere (rad/s).
    rotation: f64,
    plates: Vec<MountedPlate>,
    /// Largest distance (m) that the centre of mass may move.
    centre_shift: f64,
}

/// Density of the atmosphere.
#[derive(Clone, Debug, PartialEq)]
enum Air {
    Exponential(ExponentialAir),
    /// Exponent of the bulge.
    HarrisPriester(f64),
    Table(DensityRows<1>),
}

/// Density that is exponential in the distance from the planet's centre, or uniform.
#[derive(Clone, Debug, PartialEq)]
struct ExponentialAir {
    /// Density (kg/m³) at the reference.
    density: f64,
    /// Distance of the reference from the planet's centre (m).
    reference: f64,
    /// Height (m) in which the density falls to 1/e, infinite if it is uniform.
    scale_height: f64,
}

impl ExponentialAir {
    /// Returns the density (kg/m³) at a distance from the planet's centre (m).
    fn at(&self, distance: f64) -> f64 {
        self.density * libm::exp((self.reference - distance) / self.scale_height)
    }
}

impl Air {
    fn new(spec: &Drag, orbit: &OrbitPath) -> Self {
        match (spec.model, &spec.table) {
            (DensityModel::HarrisPriester, _) => {
                Self::HarrisPriester(spec.bulge_exponent.map_or(BULGE_EXPONENT, Positive::get))
            }
            (DensityModel::Table, Some(table)) => Self::Table(density::tabulated(table)),
            _ => {
                let reference = match (spec.altitude, orbit) {
                    (None, OrbitPath::Kepler(orbit)) => orbit.semi_major_axis.get(),
                    // An orbit by rows has an altitude.
                    (altitude, _) => orbit.planet_radius() + altitude.map_or(0.0, Positive::get),
                };
                Self::Exponential(ExponentialAir {
                    density: spec.density.map_or(0.0, Positive::get),
                    reference,
                    scale_height: spec.scale_height.map_or(f64::INFINITY, Positive::get),
                })
            }
        }
    }

    /// Returns an upper bound of the density on an orbit (kg/m³).
    fn bound(&self, orbit: &OrbitPath) -> f64 {
        let [low, high] = heights(orbit);
        match self {
            Self::Exponential(air) => air.at(orbit.nearest()),
            Self::HarrisPriester(_) => density::harris_priester_range(low)[1],
            Self::Table(rows) => rows.largest([low, high]),
        }
    }
}

impl DragLoad {
    /// Creates the load on plates with these mounts.
    pub fn new(spec: &Drag, orbit: &OrbitPath, mounts: &PlateMounts) -> Self {
        let braked = |(index, plate): (usize, &DragPlate)| {
            let mount = mounts.braked.get(index).and_then(Option::as_ref);
            MountedPlate::new(mount, [&plate.normal, &plate.at], plate.area, mounts.turn)
        };
        Self {
            air: Air::new(spec, orbit),
            scale: spec.scale.map_or(1.0, DensityFactor::get),
            coefficient: spec.coefficient.get(),
            rotation: spec.rotation.get(),
            plates: spec.plates.iter().enumerate().map(braked).collect(),
            centre_shift: mounts.centre_shift,
        }
    }

    /// Returns the density of the air (kg/m³).
    pub fn density(&self, row: &SkyRow) -> f64 {
        let density = match &self.air {
            Air::Exponential(air) => air.at(row.position().norm()),
            Air::HarrisPriester(exponent) => {
                density::harris_priester(row.height(), row.bulge_cosine(), *exponent)
            }
            Air::Table(rows) => rows.at(row.height())[0],
        };
        density * self.scale
    }

    /// Returns the velocity relative to the air in inertial axes (m/s).
    pub fn flow(&self, row: &SkyRow) -> Vector {
        row.velocity() - Vector::z().cross(&row.position()) * self.rotation
    }

    /// Returns the torque (N m) of drag about the centre of mass on a body whose axes are the rows of `turn` in inertial axes, in
    /// its axes.
    pub fn torque(&self, turn: &Matrix3<f64>, sky: &SkyAt, places: &PanelPlaces<'_>) -> Vector {
        let flow = transformed(turn, &sky.flow);
        let mut sum = Vector::zeros();
        for plate in &self.plates {
            let [normal, arm] = plate.place(places);
            sum += arm * (normal.dot(&flow).max(0.0) * plate.area);
        }
        sum.cross(&flow) * (-0.5 * self.coefficient * sky.density)
    }

    /// Returns an upper bound of the torque (N m) about the centre of mass `centre` (m).
    pub fn bound(&self, orbit: &OrbitPath, centre: &Vector) -> f64 {
        let speed = orbit.nearest() * (orbit.fastest() + self.rotation.abs());
        let factor = 0.5 * self.coefficient * self.scale * self.air.bound(orbit) * speed * speed;
        let arm = |plate: &MountedPlate| plate.area * (plate.arm(centre) + self.centre_shift);
        factor * self.plates.iter().map(arm).sum::<f64>()
    }
}

/// Returns bounds of the height above the Earth's ellipsoid on an orbit (m): it is flatter than the sphere of the equator.
fn heights(orbit: &OrbitPath) -> [f64; 2] {
    let [equator, pole] = [1.0, 1.0 - ground_site::FLATTENING].map(|factor| factor * ground_site::RADIUS);
    [orbit.nearest() - equator, orbit.farthest() - pole]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::environment::orbit::body_axes;
    use flexsc_numerics::attitude::rotation as turned;

    #[test]
    fn a_plate_is_pushed_back_where_it_meets_the_flow() {
        // Without rotation of the atmosphere: rho/2 C A v² at the plate's arm.
        let kind: OrbitKind = flexsc_formats::document::from_text("semi_major_axis = 6.8e6").unwrap();
        let orbit = kind.path(100.0, None).unwrap();
        let drag: Drag = flexsc_formats::document::from_text(
            "density = 4e-12\nscale_height = 6e4\nrotation = 0\nplates = [{ area = 2.0, normal = [0, 3, 0], at = [0.1, 0, 0.5] }]",
        )
        .unwrap();
        assert_eq!(drag.fault(Some(&kind), false), None);
        // At the start the body is on the inertial x axis and moves along y.
        let row = SkyRow::new(Some(&orbit), None, None, false, 0.0.into());
        let centre = Vector::new(0.1, 0.0, 0.0);
        let speed = f64::sqrt(3.986_004_418e14 / 6.8e6);
        let force = 0.5 * 4e-12 * 2.2 * 2.0 * speed * speed;
        let torque_on = |drag: &Drag, by: Vector| {
            let load = DragLoad::new(drag, &orbit, &PlateMounts::default());
            let sky = SkyAt { flow: load.flow(&row), density: load.density(&row), ..SkyAt::default() };
            let found = load.torque(&body_axes(&turned(&by)), &sky, &PanelPlaces { centre, axes: &[] });
            assert!(found.norm() <= load.bound(&orbit, &centre) * (1.0 + 1e-12));
            found
        };
        let torque = |by: Vector| torque_on(&drag, by);
        assert!((torque(Vector::zeros()) - Vector::new(0.5 * force, 0.0, 0.0)).norm() < 1e-12 * force);
        // Turned by 60 degrees about z the plate meets half of the flow; by more than 90 degrees, none.
        let third = torque(Vector::new(0.0, 0.0, std::f64::consts::FRAC_PI_3));
        assert!((third.norm() - 0.25 * force).abs() < 1e-12 * force, "{third}");
        assert_eq!(torque(Vector::new(0.0, 0.0, 2.0)), Vector::zeros());
        // An atmosphere that turns with the planet changes the relative flow.
        let carried = Drag { rotation: Finite::new(1e-4).unwrap(), ..drag.clone() };
        let slower = torque_on(&carried, Vector::zeros()).x / (0.5 * force);
        assert!((slower - libm::pow(1.0 - 680.0 / speed, 2.0)).abs() < 1e-12, "{slower}");
        let air = ExponentialAir { density: 1.0, reference: 6.8e6, scale_height: 6e4 };
        assert!((air.at(6.86e6) - libm::exp(-1.0)).abs() < 1e-15);
        assert_eq!(ExponentialAir { scale_height: f64::INFINITY, ..air }.at(7e6), 1.0);
        assert_eq!(drag.fault(None, false).unwrap().key, "");
    }
}
