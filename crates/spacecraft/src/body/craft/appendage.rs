//! Appendage of a spacecraft, as a scenario describes it: a panel, an antenna, a mass on a spring.

use std::borrow::Cow;

use flexsc_dynamics::three_axis::{ArticulatedPanel, PanelMode};
use flexsc_formats::document::ConfigError;
use flexsc_formats::structure::mode_table::ModeTable;
use flexsc_numerics::attitude::{Vector, tensor, vector};
use flexsc_numerics::quantity::{Finite, Positive};
use nalgebra::Matrix3;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::axes_orientation::AxesOrientation;
use super::clamped::{ClampedMode, antisymmetric_part};
use super::craig_bampton::CraigBampton;
use super::drive::AppendageDrive;
use super::fe_units::FileUnits;
use super::hinge::{Hinge, RigidBody};
use super::mass::MassProperties;
use super::mount::Mount;
use super::plate::{Plate, PlateAxis, UniformPlate};
use super::thermal::Thermal;
use crate::body::DampingRatios;
use crate::body::spatial::NamedPoint;

/// An appendage, clamped to the hub at its root.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Appendage {
    /// Name.
    pub name: String,
    /// Mass (kg).
    pub mass: Positive,
    /// Centre of mass from the root (m), in its own axes.
    #[serde(default)]
    pub centre: [Finite; 3],
    /// Inertia tensor about its centre of mass (kg m²), row by row, in its own axes; default: zero, a point mass.
    #[serde(default)]
    pub inertia: [[Finite; 3]; 3],
    /// Position of its root from the point O of the spacecraft (m).
    #[serde(default)]
    pub at: [Finite; 3],
    /// Rotation of its axes relative to those of the body.
    #[serde(default, skip_serializing_if = "AxesOrientation::is_identity")]
    pub turned: AxesOrientation,
    /// Drive that turns it about an axis through its root during a run; default: none.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub drive: Option<AppendageDrive>,
    /// Hinge at its root, on which it swings as a rigid body at any angle, in place of `modes`; default: none.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub hinge: Option<Hinge>,
    /// Mount that carries it as a rigid body, in place of `modes`: an isolator of a wheel, a cooler or a package of gyros; default: none.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub mount: Option<Mount>,
    /// For a thin plate in the plane of its own x and y: the axis along which it extends, from which first moments follow
    /// with the participations in rotation; or size and first frequency of a uniform panel, in place of `modes`, `centre`
    /// and `inertia`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub plate: Option<Plate>,
    /// Named points of the appendage, measured from its root in its own axes; a name is unique in the spacecraft.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub points: Vec<NamedPoint>,
    /// Clamped modes: a table, or the path of a CSV file or of finite-element results: `.f06` of Nastran or
    /// MYSTRAN, `.dat` of CalculiX or its `.frd` with the deck beside it, `.flex` or `.txt` of 42. Without modes it
    /// is rigid.
    #[serde(default)]
    pub modes: ModeTable<ClampedMode>,
    /// Craig-Bampton model in place of `modes`; `damping` is then needed, and `mass`, `centre` and `inertia` are compared
    /// with it. Default: none.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub craig_bampton: Option<CraigBampton>,
    /// Damping ratio of modes read from finite-element results, or a list with one for each; required where the
    /// file has none, as all but those of 42.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub damping: Option<DampingRatios>,
    /// Number of modes to keep from finite-element results, 1 to 200, lowest frequencies first; default: all.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub keep: Option<usize>,
    /// Factor on its natural frequencies, whichever way they are given; damping ratios and shapes stay. Default: 1.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub frequency_factor: Option<Positive>,
    /// Thermal bending in sunlight; default: none.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub thermal: Option<Thermal>,
    /// Units of finite-element results, except for 42, whose files are in SI units: `m` (metres, kilograms), `mm` (millimetres,
    /// tonnes), `in` (inches, pound-force seconds squared an inch), or `length` (`m`, `cm`, `mm`, `in`, `ft`) and `mass` (`kg`, `g`,
    /// `t`, `lb`, `slug`, `slinch`); default: `m`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub units: Option<FileUnits>,
}

impl Appendage {
    /// Returns true if the appendage is a point mass, with zero inertia tensor.
    pub(super) fn is_point(&self) -> bool {
        self.inertia_tensor() == Matrix3::zeros()
    }

    /// Returns the uniform panel by whose size and first frequency the appendage is known, if it is.
    pub(super) const fn uniform_plate(&self) -> Option<&UniformPlate> {
        match &self.plate {
            Some(Plate::Uniform(plate)) => Some(plate),
            _ => None,
        }
    }

    /// Returns the centre of mass from the root (m), in the axes of the appendage.
    pub fn centre_of_mass(&self) -> Vector {
        self.uniform_plate().map_or_else(|| vector(&self.centre), UniformPlate::centre)
    }

    /// Returns the inertia tensor about the centre of mass (kg m²), in the axes of the appendage.
    pub fn inertia_tensor(&self) -> Matrix3<f64> {
        self.uniform_plate().map_or_else(|| tensor(&self.inertia), |plate| plate.inertia(self.mass.get()))
    }

    /// Returns the matrix that transforms vectors from the appendage's axes, at drive angle `angle` (rad), to the
    /// body's.
    pub fn axes(&self, angle: f64) -> Matrix3<f64> {
        let orientation = self.turned.matrix();
        self.drive.as_ref().map_or(orientation, |drive| orientation * drive.rotation(angle))
    }

    /// Returns the clamped modes: those of the table or of the mount, or the single mode of the hinge or of a uniform panel; without
    /// [`Spacecraft::frequency_factor`](super::Spacecraft::frequency_factor).
    pub fn clamped_modes(&self) -> Cow<'_, [ClampedMode]> {
        if let Some(plate) = self.uniform_plate() {
            return Cow::Owned(vec![plate.mode(self.mass.get(), &self.points)]);
        }
        if let Some(mount) = &self.mount {
            return mount.modes(&self.rigid_body()).map_or(Cow::Borrowed(&[]), Cow::Owned);
        }
        let hinged = self.hinge.as_ref().and_then(|hinge| hinge.mode(&self.rigid_body()));
        hinged.map_or(Cow::Borrowed(&self.modes), |mode| Cow::Owned(vec![mode]))
    }

    /// Returns the appendage as a rigid body on its hinge or its mount.
    fn rigid_body(&self) -> RigidBody<'_> {
        RigidBody {
            mass: self.mass.get(),
            centre: vector(&self.centre),
            inertia: tensor(&self.inertia),
            points: &self.points,
        }
    }

    /// Checks the hinge, and that no key is given that is inconsistent with one.
    ///
    /// # Errors
    /// The faulty key, and the reason.
    pub(super) fn check_hinge(&self) -> Result<(), ConfigError> {
        let Some(hinge) = &self.hinge else { return Ok(()) };
        let others = [
            ("drive", self.drive.is_some()),
            ("modes", self.modes.file().is_some() || !self.modes.is_empty()),
            ("plate", self.plate.is_some()),
            ("thermal", self.thermal.is_some()),
        ];
        if let Some((key, _)) = others.into_iter().find(|(_, is_given)| *is_given) {
            let why = "must be left out: an appendage with a `hinge` is rigid, and swings on the hinge alone";
            return Err(ConfigError::new(key, why));
        }
        hinge.check(&self.rigid_body()).map_err(|fault| fault.within("hinge"))
    }

    /// Checks the mount, and that no key is given that is inconsistent with one.
    ///
    /// # Errors
    /// The faulty key, and the reason.
    pub(super) fn check_mount(&self) -> Result<(), ConfigError> {
        let Some(mount) = &self.mount else { return Ok(()) };
        let others = [
            ("hinge", self.hinge.is_some()),
            ("modes", self.modes.file().is_some() || !self.modes.is_empty()),
            ("plate", self.plate.is_some()),
            ("thermal", self.thermal.is_some()),
        ];
        if let Some((key, _)) = others.into_iter().find(|(_, is_given)| *is_given) {
            let why = "must be left out: an appendage with a `mount` is rigid, and moves on the mount alone";
            return Err(ConfigError::new(key, why));
        }
        let body = self.rigid_body();
        mount.check_axis().map_err(|fault| fault.within("mount"))?;
        if !mount.has_inertia(&body) {
            let why = "must be above 0 about all axes about which the `mount` lets the appendage rotate";
            return Err(ConfigError::new("inertia", why));
        }
        mount.check(&body).map_err(|fault| fault.within("mount"))
    }

    /// Checks that no key is given that follows from the size and the frequency of a uniform panel, and that its points
    /// are on it.
    ///
    /// # Errors
    /// The faulty key, and the reason.
    pub(super) fn check_plate(&self) -> Result<(), ConfigError> {
        let Some(plate) = self.uniform_plate() else { return Ok(()) };
        let others = [
            ("centre", vector(&self.centre) != Vector::zeros()),
            ("inertia", tensor(&self.inertia) != Matrix3::zeros()),
            ("modes", self.modes.file().is_some() || !self.modes.is_empty()),
        ];
        if let Some((key, _)) = others.into_iter().find(|(_, is_given)| *is_given) {
            let why = "must be left out: it follows from the size and the frequency of `plate`; a plate whose modes are given is \
                       `plate = \"x\"` or `\"y\"`";
            return Err(ConfigError::new(key, why));
        }
        self.points.iter().enumerate().try_for_each(|(index, point)| {
            plate.carries(&point.position).map_err(|fault| fault.within(&format!("points[{index}]")))
        })
    }

    /// Returns the appendage as a panel of the integrator, with a factor on its natural frequencies; its drive, if it has
    /// one, gets the index `drives`.
    pub(super) fn for_integrator(&self, factor: f64, drives: usize) -> ArticulatedPanel {
        let mode = |mode: &ClampedMode| PanelMode {
            frequency: mode.frequency.get() * factor,
            damping: mode.damping.get(),
            translation: self.translation(mode),
            moments: self.moments(mode),
        };
        ArticulatedPanel {
            mass: self.mass.get(),
            root: vector(&self.at),
            axes: self.turned.matrix(),
            centre: self.centre_of_mass(),
            inertia: self.inertia_tensor(),
            modes: self.clamped_modes().iter().map(mode).collect(),
            drive: self.drive.as_ref().map(|drive| (drive.axis(), drives)),
            hinge: self.hinge.as_ref().map(|hinge| hinge.for_integrator(&self.rigid_body())),
        }
    }

    /// Returns the mass properties of the undeformed appendage in the body's axes, from the point O; `axes` transforms
    /// vectors from the appendage's axes to the body's.
    pub(super) fn mass_properties(&self, axes: &Matrix3<f64>) -> MassProperties {
        MassProperties {
            mass: self.mass.get(),
            centre: vector(&self.at) + axes * self.centre_of_mass(),
            inertia: axes * self.inertia_tensor() * axes.transpose(),
        }
    }

    /// Returns true if the complete first moments of a mode are known, and not only their antisymmetric part.
    pub(super) fn has_moments(&self, mode: &ClampedMode) -> bool {
        mode.moments.is_some() || self.plate.is_some() || self.is_point()
    }

    /// Returns the participation of each mode in translation (sqrt(kg)) and in rotation about the root (sqrt(kg) m), in
    /// the axes of the appendage.
    pub fn participations(&self) -> Vec<(Vector, Vector)> {
        self.clamped_modes()
            .iter()
            .map(|mode| (self.translation(mode), antisymmetric_part(&self.moments(mode))))
            .collect()
    }

    /// Returns the participation of a mode in translation, in the axes of the appendage (sqrt(kg)).
    pub(super) fn translation(&self, mode: &ClampedMode) -> Vector {
        mode.translation(self.mass.get())
    }

    /// Returns the first moments of a mode about the root, in the axes of the appendage (sqrt(kg) m).
    pub(super) fn moments(&self, mode: &ClampedMode) -> Matrix3<f64> {
        if let Some(moments) = mode.moments() {
            return moments;
        }
        if self.is_point() {
            return vector(&self.centre) * self.translation(mode).transpose();
        }
        let r = mode.rotation.as_ref().map_or_else(Vector::zeros, vector);
        match self.plate.as_ref().map(Plate::axis) {
            // Bending and torsion are unambiguous; in plane, points are assumed to move across the length.
            Some(PlateAxis::Y) => Matrix3::new(0.0, 0.0, -r.y, -r.z, 0.0, r.x, 0.0, 0.0, 0.0),
            Some(PlateAxis::X) => Matrix3::new(0.0, r.z, -r.y, 0.0, 0.0, r.x, 0.0, 0.0, 0.0),
            // The symmetric part is unknown: it is set to zero.
            None => -0.5 * r.cross_matrix(),
        }
    }
}
