//! Model of a three-axis body: rotation, and elastic modes with their shapes at named points of the structure.
//!
//! J w' + w x J w = M, Q' = 1/2 Q o (0, w), and q_i'' + 2 zeta_i w_i q_i' + w_i² q_i = sum_j f_i(r_j) . F_j +
//! phi_i(r_j) . M_j (\[Timakov14\], equations (1) and (2); hybrid coordinates, \[Likins70\]): mass-normalised modes,
//! which forces at points excite and sensors at points measure. Q transforms vectors from the body's axes to inertial
//! axes: v = Q o v_body o Q*. With a [`ModalCoupling`] the modes act back on the rotation ([`crate::three_axis`]).

use std::sync::Arc;

use flexsc_numerics::attitude::{Attitude, Vector};
use flexsc_numerics::quantity::{Finite, Frequency, NonNegative};
use nalgebra::{DMatrix, Matrix3};

use crate::periodic_torque::PeriodicTorque;
use crate::three_axis::{ArticulatedBody, FlexibleBody, FreeMode};

/// Model of a three-axis body.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ThreeAxisModel {
    /// Inertia tensor about the centre of mass (kg m²), without the spin inertia of the rotors.
    pub inertia: Matrix3<f64>,
    /// Attitude at the start.
    pub attitude: Attitude,
    /// Rates at the start (rad/s), in the body's axes.
    pub rate: [Finite; 3],
    /// Named points of the structure. Torques act at the first one by default.
    pub points: Vec<ModelPoint>,
    /// Free modes.
    pub modes: Vec<ThreeAxisMode>,
    /// Bounds of a small rotation about a fixed target, if the motion is linear within them.
    pub small_angles: Option<SmallAngleBounds>,
    /// Torque of the environment.
    pub disturbance: Option<PeriodicTorque>,
    /// Action of the modes on the rotation; `None` if they follow it without acting back.
    pub coupling: Option<ModalCoupling>,
    /// Body as a function of the angles of its drives and hinges; `None` if it has neither.
    pub articulation: Option<Arc<ArticulatedBody>>,
}

/// Bounds within which the rotation about a fixed target is linear.
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct SmallAngleBounds {
    /// Largest rotation from the target about each axis (rad).
    pub angle: f64,
    /// Largest rate about each axis (rad/s).
    pub rate: f64,
}

/// Named point of the structure.
#[derive(Clone, Debug, PartialEq)]
pub struct ModelPoint {
    /// Name.
    pub name: String,
    /// Position from the centre of mass (m).
    pub position: Vector,
    /// Translation (1/sqrt(kg)) and rotation (rad/(m sqrt(kg))) per unit of each mode.
    pub shapes: Vec<(Vector, Vector)>,
}

/// Mass-normalised free mode of a three-axis body.
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct ThreeAxisMode {
    /// Natural frequency w (rad/s).
    pub frequency: Frequency,
    /// Damping ratio zeta: 0 undamped, 1 critical.
    pub damping: NonNegative,
    /// Modal displacement at the start (m sqrt(kg)).
    pub displacement: Finite,
    /// Modal rate at the start (m sqrt(kg)/s).
    pub rate: Finite,
}

/// Action of the modes on the rotation of the body.
#[derive(Clone, Debug, PartialEq)]
pub struct ModalCoupling {
    /// Rotation of the hub per unit of each mode (rad/(m sqrt(kg))).
    pub rotations: Vec<Vector>,
    /// Change of the inertia tensor per unit of each mode (sqrt(kg) m).
    pub moments: Vec<Matrix3<f64>>,
    /// Damping matrix of all modes (1/s), with the damping ratios of the modes on its diagonal. Linear models have it whole.
    pub damping: DMatrix<f64>,
    /// True if runs have the damping matrix whole too; with its diagonal alone, the modes are uncoupled.
    pub couples_by_damping: bool,
}

impl ThreeAxisModel {
    /// Returns the position of a point from the centre of mass (m), if there is a point of this name.
    pub fn point(&self, name: &str) -> Option<Vector> {
        self.find(name).map(|point| point.position)
    }

    fn find(&self, name: &str) -> Option<&ModelPoint> {
        self.points.iter().find(|point| point.name == name)
    }

    /// Returns the names of all points, for messages.
    pub fn point_names(&self) -> String {
        let names: Vec<_> = self.points.iter().map(|point| format!("`{}`", point.name)).collect();
        if names.is_empty() { "none".to_owned() } else { names.join(", ") }
    }

    /// Returns the translation (1/sqrt(kg)) and rotation (rad/(m sqrt(kg))) of each mode at a point; zeros for a name
    /// that no point has.
    pub fn shapes(&self, point: &str) -> Vec<(Vector, Vector)> {
        self.find(point)
            .map_or_else(|| vec![Default::default(); self.modes.len()], |point| point.shapes.clone())
    }

    /// Returns the displacement per unit of each mode of the place at an offset (m) from a point, in hub axes that turn
    /// with the first point (1/sqrt(kg)).
    pub fn displacements(&self, point: &str, offset: &Vector) -> Vec<Vector> {
        let first = self.points.first().map_or("", |point| &point.name);
        let position = self.point(point).unwrap_or_default();
        let shift = |((shift, rotation), (_, hub)): (&(Vector, Vector), &(Vector, Vector))| {
            shift - hub.cross(&position) + (rotation - hub).cross(offset)
        };
        self.shapes(point).iter().zip(&self.shapes(first)).map(shift).collect()
    }

    /// Returns the body as the integrator takes it; `None` if the modes do not act back on the rotation.
    pub fn flexible(&self) -> Option<FlexibleBody> {
        let ModalCoupling { rotations, moments, damping, couples_by_damping } = self.coupling.as_ref()?;
        let effects = rotations.iter().zip(moments);
        let modes = self.modes.iter().zip(effects).map(|(mode, (rotation, moments))| FreeMode {
            frequency: mode.frequency.get(),
            damping: mode.damping.get(),
            rotation: *rotation,
            moments: *moments,
        });
        let damping = couples_by_damping.then(|| damping.clone());
        Some(FlexibleBody { inertia: self.inertia, modes: modes.collect(), damping })
    }
}
