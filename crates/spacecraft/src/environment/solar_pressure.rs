//! Pressure of sunlight: a force that is constant in inertial axes at a point of the body, or forces on plates
//! (\[Wertz78\]).
//!
//! On a plate of area A whose outward normal n faces the Sun s, n.s = c > 0, and which reflects the part r_s specularly
//! and r_d diffusely, the force is -P A c ((1 - r_s) s + 2 (r_s c + r_d/3) n), else zero: a plate with two sides is two
//! plates. Plates do not shade each other.

use flexsc_dynamics::three_axis::{PanelPlaces, SkyAt};
use flexsc_formats::document::ConfigError;
use flexsc_numerics::attitude::{Vector, vector};
use flexsc_numerics::quantity::{Finite, NonNegative, Positive, Time};
use flexsc_numerics::time::{Instant, Span};
use nalgebra::Matrix3;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::orbit::transformed;
use super::plate_mount::{MountedPlate, PlateMounts};

/// Pressure of sunlight: one `force` at a point, or `plates`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct SolarPressure {
    /// The force (N), constant in inertial axes whatever the Sun's distance; required without `plates`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub force: Option<[Finite; 3]>,
    /// Centre of pressure (m): from the point O of a spacecraft, or from the centre of mass of a spatial body.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub at: Option<[Finite; 3]>,
    /// Plates in place of one force: where the normal n faces the Sun s with the cosine c, the force is
    /// -P A c ((1 - specular) s + 2 (specular c + diffuse/3) n). A plate with two sides is two entries; plates do
    /// not shade each other, and the force bends nothing.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub plates: Vec<SolarPlate>,
    /// Pressure of sunlight on the plates at 1 au (N/m²); default: that of 1361 W/m². With `sun = "epoch"` it falls with the
    /// square of the Sun's distance at the date.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub pressure: Option<Positive>,
    /// Intervals \[from, to\] without sunlight (s), in addition to the shadow of the orbit's planet.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub shadow: Vec<[Time; 2]>,
}

/// A plate; sunlight presses on one side of it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(rename = "LitPlate")]
pub struct SolarPlate {
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
    /// The part of the light that it reflects like a mirror.
    #[serde(default)]
    pub specular: NonNegative,
    /// The part that it reflects diffusely.
    #[serde(default)]
    pub diffuse: NonNegative,
}

/// Pressure at 1 au (N/m²): 1361 W/m² divided by the speed of light.
const AT_EARTH: f64 = 1361.0 / 299_792_458.0;

impl SolarPressure {
    /// Returns the instants at which the intervals without sunlight begin and end.
    pub(super) fn shadow_times(&self) -> impl Iterator<Item = Instant> {
        self.shadow.iter().flatten().map(|time| at(*time))
    }

    /// Returns true if the body is in sunlight at a time since the start (s).
    pub(super) fn is_lit(&self, t: f64) -> bool {
        !self.shadow.iter().any(|[from, to]| at(*from).seconds() <= t && t < at(*to).seconds())
    }

    /// Returns an inconsistency between values, with or without a Sun: a key within the pressure, and the reason.
    pub(super) fn fault(&self, has_sun: bool) -> Option<ConfigError> {
        let is_single = self.plates.is_empty();
        for (key, is_given) in [("force", self.force.is_some()), ("at", self.at.is_some())] {
            if is_single && !is_given {
                return Some(ConfigError::new(key, "must be given where there are no `plates`"));
            }
            if !is_single && is_given {
                return Some(ConfigError::new(
                    key,
                    "is for sunlight without `plates`: leave one of them out",
                ));
            }
        }
        if is_single && self.pressure.is_some() {
            return Some(ConfigError::new("pressure", "is that on `plates`, and there are none"));
        }
        if !is_single && !has_sun {
            return Some(ConfigError::new(
                "plates",
                "need `environment.sun`, the direction that they face or not",
            ));
        }
        if let Some(fault) = self.plates.iter().enumerate().find_map(SolarPlate::fault) {
            return Some(fault);
        }
        let index = self.shadow.iter().position(|[from, to]| from >= to)?;
        let [from, to] = self.shadow[index].map(Time::get);
        let why = format!("must be [from, to] (s) with `to` later than `from`, got [{from}, {to}]");
        Some(ConfigError::new(format!("shadow[{index}]"), why))
    }
}

/// Pressure of sunlight on a body during a run.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct SunlightLoad {
    /// Force in inertial axes (N) and its point (m), without plates.
    single: Option<[Vector; 2]>,
    /// Pressure at 1 au (N/m²).
    pressure: f64,
    plates: Vec<LitPlate>,
    /// Largest distance (m) that the centre of mass may move.
    centre_shift: f64,
}

/// Plate in sunlight, with the parts of the force -P A c (absorbed s + (specular c + diffuse) n).
#[derive(Clone, Debug, PartialEq)]
struct LitPlate {
    plate: MountedPlate,
    absorbed: f64,
    specular: f64,
    diffuse: f64,
}

impl SunlightLoad {
    /// Creates the load on plates with these mounts.
    pub fn new(spec: &SolarPressure, mounts: &PlateMounts) -> Self {
        let lit = |(index, plate): (usize, &SolarPlate)| {
            let (specular, diffuse) = (plate.specular.get(), plate.diffuse.get());
            let mount = mounts.lit.get(index).and_then(Option::as_ref);
            LitPlate {
                plate: MountedPlate::new(mount, [&plate.normal, &plate.at], plate.area, mounts.turn),
                absorbed: 1.0 - specular,
                specular: 2.0 * specular,
                diffuse: 2.0 / 3.0 * diffuse,
            }
        };
        let single = spec.force.as_ref().zip(spec.at.as_ref());
        Self {
            single: single.map(|(force, at)| [vector(force), vector(at)]),
            pressure: spec.pressure.map_or(AT_EARTH, Positive::get),
            plates: spec.plates.iter().enumerate().map(lit).collect(),
            centre_shift: mounts.centre_shift,
        }
    }

    /// Returns the torque (N m) of sunlight about the centre of mass on a body whose axes are the rows of `turn` in inertial
    /// axes, in its axes.
    pub fn torque(&self, turn: &Matrix3<f64>, sky: &SkyAt, places: &PanelPlaces<'_>) -> Vector {
        if let Some([force, at]) = &self.single {
            return (at - places.centre).cross(&transformed(turn, force)) * sky.part_in_view;
        }
        let sun = transformed(turn, &sky.sun);
        let mut sum = Vector::zeros();
        for LitPlate { plate, absorbed, specular, diffuse } in &self.plates {
            let [normal, arm] = plate.place(places);
            let faced = normal.dot(&sun);
            if faced > 0.0 {
                let force = sun * *absorbed + normal * (specular * faced + diffuse);
                sum += arm.cross(&force) * (plate.area * faced);
            }
        }
        sum * -(self.pressure * sky.pressure * sky.part_in_view)
    }

    /// Returns an upper bound of the torque (N m) about the centre of mass `centre` (m); `most_pressure` is the largest pressure
    /// relative to that at 1 au.
    pub fn bound(&self, centre: &Vector, most_pressure: f64) -> f64 {
        if let Some([force, at]) = &self.single {
            return force.norm() * ((at - centre).norm() + self.centre_shift);
        }
        let most = |LitPlate { plate, absorbed, specular, diffuse }: &LitPlate| {
            (absorbed + specular + diffuse) * plate.area * (plate.arm(centre) + self.centre_shift)
        };
        self.pressure * most_pressure * self.plates.iter().map(most).sum::<f64>()
    }
}

impl SolarPlate {
    fn fault((index, plate): (usize, &Self)) -> Option<ConfigError> {
        if plate.normal.iter().all(|part| part.get() == 0.0) {
            return Some(ConfigError::new(
                format!("plates[{index}].normal"),
                "must not be zero, got [0, 0, 0]",
            ));
        }
        let reflected = plate.specular.get() + plate.diffuse.get();
        let why = || format!("and `diffuse` must be at most 1 together, got {reflected}");
        (reflected > 1.0).then(|| ConfigError::new(format!("plates[{index}].specular"), why()))
    }
}

fn at(time: Time) -> Instant {
    Instant::START + Span::from_seconds(time.get())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::environment::orbit::body_axes;
    use flexsc_numerics::attitude::rotation;

    fn pressed(keys: &str) -> SolarPressure {
        flexsc_formats::document::from_text(keys).unwrap()
    }

    #[test]
    fn plates_absorb_and_reflect() {
        // Plate of 2 m² about z, 0.5 m along x, in light from 60 degrees off its normal.
        let sun = Vector::new(0.0, f64::sqrt(0.75), 0.5);
        let centre = Vector::new(0.1, 0.0, 0.0);
        let torque = |parts: &str, by: Vector| {
            let keys = format!("plates = [{{ area = 2, normal = [0, 0, 4], at = [0.6, 0, 0] {parts} }}]");
            let pressure = pressed(&keys);
            assert_eq!(pressure.fault(true), None);
            let load = SunlightLoad::new(&pressure, &PlateMounts::default());
            let sky = SkyAt { sun, pressure: 1.0, part_in_view: 1.0, ..SkyAt::default() };
            let places = PanelPlaces { centre, axes: &[] };
            let found = load.torque(&body_axes(&rotation(&by)), &sky, &places);
            assert!(found.norm() <= load.bound(&centre, 1.0));
            found / (4.539_807_335_646_65e-6 * 2.0 * 0.5)
        };
        let arm = Vector::new(0.5, 0.0, 0.0);
        let none = Vector::zeros();
        // Absorption: force along the light. Mirror: 2 c along the normal. Diffuse: along the light, and 2/3 along the
        // normal.
        let along = |force: Vector| arm.cross(&force);
        assert!((torque("", none) - along(-sun)).norm() < 1e-12);
        assert!((torque(", specular = 1", none) - along(Vector::new(0.0, 0.0, -1.0))).norm() < 1e-12);
        let white = -sun - Vector::new(0.0, 0.0, 2.0 / 3.0);
        assert!((torque(", diffuse = 1", none) - along(white)).norm() < 1e-12);
        // No force on a plate turned away from the light by more than 90 degrees.
        assert_eq!(torque(", specular = 0.3", Vector::new(0.6, 0.0, 0.0)), none);
        // Turned into the light by 60 degrees, both parts of the force are along z.
        let faced =
            torque(", specular = 0.3, diffuse = 0.2", Vector::new(-std::f64::consts::FRAC_PI_3, 0.0, 0.0));
        let straight = along(Vector::new(0.0, 0.0, -2.0 * (1.0 + 0.3 + 2.0 / 3.0 * 0.2)));
        assert!((faced - straight).norm() < 1e-12, "{faced}");
    }

    #[test]
    fn what_presses_is_a_force_or_plates() {
        let plate = "plates = [{ area = 1, normal = [0, 0, 1], at = [0, 0, 0]";
        for (keys, sun, found) in [
            ("force = [1, 0, 0]".to_owned(), true, "`at` must be given"),
            ("at = [1, 0, 0]".to_owned(), true, "`force` must be given"),
            (format!("{plate} }}]"), false, "`plates` need `environment.sun`"),
            (format!("{plate} }}]\nforce = [1, 0, 0]"), true, "`force` is for sunlight without `plates`"),
            (format!("{plate}, specular = 0.7, diffuse = 0.4 }}]"), true, "must be at most 1 together"),
            ("force = [1, 0, 0]\nat = [0, 0, 0]\npressure = 1e-6".to_owned(), true, "`pressure` is that on"),
            (plate.replace("0, 0, 1]", "0, 0, 0]") + " }]", true, "must not be zero"),
        ] {
            let fault = pressed(&keys).fault(sun).expect(found).to_string();
            assert!(fault.contains(found), "{fault}");
        }
        assert_eq!(pressed("force = [1, 0, 0]\nat = [0, 0, 0]").fault(false), None);
    }
}
