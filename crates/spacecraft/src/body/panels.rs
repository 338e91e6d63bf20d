//! A body of a hub and equal solar panels, each a chain of rigid sections in elastic hinges (\[Rotation\], the
//! example).
//!
//! All panels move alike: two panels antisymmetrically. The coordinates are the hub's angle theta and the displacement
//! v_k of each section's outer end from the position given by the hub's rotation, with x_k its distance from the axis.
//! Each panel has the kinetic energy
//!
//! 1/2 sum mu_k u_k² + (m_k l_k/3) (u_(k-1)² + u_(k-1) u_k + u_k²), u_k = x_k theta' + v_k',
//!
//! and the potential energy 1/2 sum c_k (phi_(k+1) - phi_k)² with the sections' angles phi_k = (v_k - v_(k-1))/l_k.

use flexsc_dynamics::axis_model::AxisModel;
use flexsc_dynamics::chain_model::Chain;
use flexsc_formats::document::ConfigError;
use flexsc_formats::structure::Structure;
use flexsc_numerics::quantity::{Finite, NonNegative, Positive, Tolerance};
use nalgebra::DMatrix;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::output::radians;
use super::reduction::{ModalReduction, ObservedCoordinate};
use super::{DampingRatios, Drive, Load, load};

/// Largest number of sections of a panel.
const MOST_SECTIONS: usize = 99;

/// A hub with panels.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Panels {
    /// Moment of inertia of the hub alone (kg m²).
    pub hub_inertia: Positive,
    /// Distance of the first hinge from the axis (m).
    pub root: NonNegative,
    /// Number of equal panels.
    #[serde(default = "two")]
    pub count: u32,
    /// Sections of each panel, from the hub outwards.
    pub sections: Vec<Section>,
    /// Kinematics of the sections.
    #[serde(default)]
    pub kinematics: Kinematics,
    /// Error tolerance of each integration step of the exact kinematics (rad).
    #[serde(default = "tight")]
    pub tolerance: Tolerance,
    /// Quantity that the actuator commands.
    #[serde(default)]
    pub drive: Drive,
    /// Damping ratio of all modes, or a list with one for each mode that is kept.
    #[serde(default)]
    pub damping: DampingRatios,
    /// Number of modes to keep, lowest frequencies first; default: all up to 1e3 rad/s.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub keep: Option<u32>,
    /// Rigid angle at the start (rad).
    #[serde(default)]
    pub angle: Finite,
    /// Rigid rate at the start (rad/s).
    #[serde(default)]
    pub rate: Finite,
}

/// A section of a panel.
#[derive(Copy, Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Section {
    /// Length l (m).
    pub length: Positive,
    /// Mass per unit length m (kg/m).
    pub mass_per_length: Positive,
    /// Mass mu lumped at the outer end (kg).
    #[serde(default)]
    pub tip_mass: NonNegative,
    /// Stiffness c of the hinge at the inner end (N m/rad).
    pub hinge_stiffness: Positive,
}

/// Kinematics of the sections.
#[derive(Copy, Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Kinematics {
    /// Small angles relative to the hub: the motion has modes and a closed form.
    #[default]
    Linear,
    /// Large angles: the motion is integrated. The modes are those of small angles.
    Exact,
}

fn two() -> u32 {
    2
}

fn tight() -> Tolerance {
    Tolerance::TIGHT
}

impl Panels {
    /// Computes the structure in the coordinates theta (rad), v_1, v_2, ... (m).
    ///
    /// # Errors
    /// A number of panels or of sections that is zero, or more than 99 sections.
    pub fn structure(&self) -> Result<Structure, ConfigError> {
        let s = self.sections.len();
        if !(1..=MOST_SECTIONS).contains(&s) {
            return Err(ConfigError::new("sections", format!("must be 1 to {MOST_SECTIONS}, got {s}")));
        }
        if self.count == 0 {
            return Err(ConfigError::new("count", "must be 1 or more, got 0"));
        }
        let count = f64::from(self.count);
        let mut mass = DMatrix::zeros(s + 1, s + 1);
        mass[(0, 0)] = self.hub_inertia.get();
        let mut stiffness = DMatrix::zeros(s + 1, s + 1);
        let mut inner = self.root.get();
        for (k, section) in (1..).zip(&self.sections) {
            let (l, tip) = (section.length.get(), section.tip_mass.get());
            let third = section.mass_per_length.get() * l / 3.0;
            let outer = inner + l;
            // The velocity u_k is a sum over these coordinates; the hinge at the root has no displacement.
            let ends = [(inner, (k > 1).then(|| k - 1)), (outer, Some(k))];
            for (a, (xa, va)) in ends.into_iter().enumerate() {
                for (b, (xb, vb)) in ends.into_iter().enumerate() {
                    let lumped = if a == 1 && b == 1 { tip } else { 0.0 };
                    let weight = count * (lumped + if a == b { third } else { 0.5 * third });
                    for (i, xi) in [(Some(0), xa), (va, 1.0)] {
                        for (j, xj) in [(Some(0), xb), (vb, 1.0)] {
                            if let (Some(i), Some(j)) = (i, j) {
                                mass[(i, j)] += weight * (xi * xj);
                            }
                        }
                    }
                }
            }
            // The angle phi_k - phi_(k-1) is a sum over these displacements.
            let c = count * section.hinge_stiffness.get();
            let own = [(k, 1.0, l), (k.wrapping_sub(1), -1.0, l)];
            let before = self.sections.get(k.wrapping_sub(2)).map(|before| before.length.get());
            let before = before.map(|l| [(k - 1, -1.0, l), (k.wrapping_sub(2), 1.0, l)]);
            let parts: Vec<(usize, f64, f64)> =
                own.into_iter().chain(before.into_iter().flatten()).filter(|(v, ..)| *v > 0).collect();
            for &(i, sign_i, length_i) in &parts {
                for &(j, sign_j, length_j) in &parts {
                    stiffness[(i, j)] += sign_i * sign_j * (c / (length_i * length_j));
                }
            }
            inner = outer;
        }
        Structure::new(mass, stiffness, 0, None).map_err(|fault| exceeds_precision(&fault.why))
    }

    /// Returns the exact chain, if the sections turn by any angles, under a torque on the hub or under a load.
    pub fn chain(&self, model: &AxisModel, load: Option<&Load>) -> Option<Chain> {
        let structure = self.structure().ok().filter(|_| self.kinematics == Kinematics::Exact)?;
        let lengths: Vec<f64> = self.sections.iter().map(|section| section.length.get()).collect();
        let chain =
            Chain::new(&lengths, structure.mass(), structure.stiffness(), model, self.tolerance.get());
        Some(match load.and_then(|load| self.torques(load).ok()) {
            Some(torques) => chain.with_load(torques),
            None => chain,
        })
    }

    /// Returns the torque of a load on the hub, and on each section of all panels together, per unit of their sum.
    fn torques(&self, load: &Load) -> Result<Vec<f64>, ConfigError> {
        let (hub, sections) = load.on_parts("hub", "sections", self.sections.len(), "section")?;
        let of_panels = sections.into_iter().map(|torque| f64::from(self.count) * torque);
        let torques: Vec<f64> = std::iter::once(hub).chain(of_panels).collect();
        let sum = load::torque(&torques, &vec![1.0; torques.len()])?;
        Ok(torques.into_iter().map(|torque| torque / sum).collect())
    }

    /// Returns the generalised forces of a load on theta, v_1, v_2, ...: a torque M on section k does the work
    /// M (theta + (v_k - v_(k-1))/l_k).
    fn forces(&self, load: &Load) -> Result<Vec<f64>, ConfigError> {
        let torques = self.torques(load)?;
        let mut forces = vec![0.0; torques.len()];
        forces[0] = torques.iter().sum();
        for (k, (torque, section)) in (1..).zip(torques[1..].iter().zip(&self.sections)) {
            let force = torque / section.length.get();
            forces[k] += force;
            if k > 1 {
                forces[k - 1] -= force;
            }
        }
        Ok(forces)
    }

    /// Computes the planar body with the modes of the structure, under a torque on the hub or under a load. Its outputs are the
    /// angles phi_k of the sections relative to the hub (rad): `section_1`, `section_2` and so on.
    pub fn solve(&self, load: Option<&Load>) -> Result<AxisModel, ConfigError> {
        let structure = self.structure()?;
        let observed = |(index, section): (usize, &Section)| {
            let mut weights = vec![0.0; self.sections.len() + 1];
            weights[index + 1] = 1.0 / section.length.get();
            if index > 0 {
                weights[index] = -1.0 / section.length.get();
            }
            ObservedCoordinate { name: format!("section_{}", index + 1), unit: radians(), weights }
        };
        let outputs = self.sections.iter().enumerate().map(observed).collect();
        let Self { drive, damping, keep, angle, rate, .. } = self;
        let reduction = ModalReduction {
            drive: (*drive).into(),
            damping,
            damping_matrix: None,
            keep: *keep,
            angle: *angle,
            rate: *rate,
            outputs,
            load: load.map(|load| self.forces(load)).transpose()?,
        };
        reduction.axis_model(&structure).map_err(|fault| match fault.key.as_str() {
            "damping" | "keep" | "load" => fault,
            _ => exceeds_precision(&fault.why),
        })
    }
}

/// Returns the fault of panels without modes, which occurs only if rounding removes some because the numbers differ by
/// many orders of magnitude.
fn exceeds_precision(why: &str) -> ConfigError {
    ConfigError::new("sections", format!("hold numbers that differ too much in size: the matrix {why}"))
}
