//! Modes of a spacecraft as tables: effective masses of each appendage's modes, and the response at each point to a
//! torque on the hub.

use flexsc_dynamics::three_axis::DriveAngles;
use flexsc_numerics::attitude::Vector;
use flexsc_spacecraft::body::craft::{Appendage, AssembledSpacecraft};
use serde::Serialize;

use super::mode_influence::ModeInfluences;
use flexsc_scenario::{AppendageDrives, Scenario};

/// Number of equal parts of a run at whose ends frequencies are listed.
const PARTS: u32 = 12;

/// Modes of a spacecraft, clamped and free.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct SpacecraftModes {
    /// Free modes.
    #[serde(flatten)]
    pub free: ModeInfluences,
    /// Total mass (kg).
    pub mass_kg: f64,
    /// Total centre of mass, from the spacecraft's point O (m).
    pub centre_m: [f64; 3],
    /// Inertia tensor about the centre of mass, without the spin inertia of the wheels (kg m²).
    pub inertia_kg_m2: [[f64; 3]; 3],
    /// Off-diagonal damping of the free modes.
    pub damping_coupling: f64,
    /// True if runs keep the whole damping matrix of the free modes, as linear models do; false if they keep its diagonal.
    pub whole_damping: bool,
    /// Modes with the roots held, appendage by appendage.
    pub clamped: Vec<ClampedModeRow>,
    /// Masses of the appendages that their modes do not carry.
    pub residual: Vec<ResidualMass>,
    /// Response at each point to a torque on the hub.
    pub points: Vec<PointResponse>,
    /// Frequencies of the free modes over the run; empty where no drive turns an appendage.
    pub turned: Vec<ModesAtAngles>,
}

/// Free modes at one set of drive angles.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ModesAtAngles {
    /// Time (s).
    pub time_s: f64,
    /// Angle of each drive (rad).
    pub angles_rad: Vec<f64>,
    /// Natural frequencies (rad/s), increasing.
    pub frequencies_rad_s: Vec<f64>,
}

/// Mode of an appendage with its root held.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ClampedModeRow {
    /// Name of the appendage.
    pub appendage: String,
    /// Natural frequency (rad/s).
    pub frequency_rad_s: f64,
    /// Damping ratio.
    pub damping: f64,
    /// Effective mass along the axes of the appendage (kg): squares of the mode's participation in translation.
    pub effective_mass_kg: [f64; 3],
    /// Effective moment of inertia about the axes of the appendage through its root (kg m²).
    pub effective_inertia_kg_m2: [f64; 3],
    /// True if the first moments of the mode are known.
    pub first_moments: bool,
}

/// Mass of an appendage that its modes do not carry: it follows the root as if rigid, without the static flexibility of modes that
/// are left out.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ResidualMass {
    /// Name of the appendage.
    pub appendage: String,
    /// Mass of the appendage (kg).
    pub mass_kg: f64,
    /// Part of it that no mode carries along each of its axes.
    pub share: [f64; 3],
}

impl ResidualMass {
    /// Returns the residual mass of an appendage with modes.
    fn new(appendage: &Appendage) -> Self {
        let mass = appendage.mass.get();
        let carried = appendage.participations().into_iter().map(|(own, _)| own.component_mul(&own));
        let share = Vector::repeat(1.0) - carried.sum::<Vector>() / mass;
        Self { appendage: appendage.name.clone(), mass_kg: mass, share: three(&share.sup(&Vector::zeros())) }
    }
}

/// Point of the structure, and its response to a torque on the hub.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct PointResponse {
    /// Name of the point.
    pub point: String,
    /// Name of the appendage that carries the point; none for a point of the hub.
    pub appendage: Option<String>,
    /// Position from the total centre of mass (m).
    pub position_m: [f64; 3],
    /// Influence of a torque on the hub about each axis: the jump of the elastic rate at the point for each unit jump
    /// of the rigid rate, both about that axis, for each free mode.
    pub influences: [Vec<f64>; 3],
}

impl SpacecraftModes {
    /// Returns the modes of a scenario's spacecraft.
    pub fn from_scenario(scenario: &Scenario, craft: &AssembledSpacecraft) -> Self {
        let written = scenario.appendage.iter().flat_map(|appendage| {
            let participations = appendage.participations();
            participations.into_iter().map(move |participation| (&appendage.name, participation))
        });
        let clamped =
            craft.parts.iter().zip(written).map(|(part, (name, (translation, rotation)))| ClampedModeRow {
                appendage: name.clone(),
                frequency_rad_s: part.frequency,
                damping: part.damping,
                effective_mass_kg: three(&translation.component_mul(&translation)),
                effective_inertia_kg_m2: three(&rotation.component_mul(&rotation)),
                first_moments: part.knows_moments,
            });
        let flexible = scenario.appendage.iter().filter(|own| !own.participations().is_empty());
        let inertia = &craft.model.inertia;
        let rotations = craft.model.coupling.as_ref().map_or(&[][..], |coupling| &coupling.rotations);
        let on = |name: &str| {
            let mut appendages = scenario.appendage.iter();
            appendages.find(|appendage| appendage.points.iter().any(|point| point.name == name))
        };
        let points = craft.model.points.iter().map(|point| {
            let participation_about = |axis: usize| {
                let modes = point.shapes.iter().zip(rotations);
                modes.map(|((_, rotation), hub)| rotation[axis] * hub[axis] * inertia[(axis, axis)]).collect()
            };
            PointResponse {
                point: point.name.clone(),
                appendage: on(&point.name).map(|appendage| appendage.name.clone()),
                position_m: three(&point.position),
                influences: [0, 1, 2].map(participation_about),
            }
        });
        Self {
            free: ModeInfluences::from_scenario(scenario, &craft.model),
            mass_kg: craft.mass,
            centre_m: three(&craft.centre),
            inertia_kg_m2: [0, 1, 2].map(|row| three(&inertia.row(row).transpose())),
            damping_coupling: craft.damping_coupling,
            whole_damping: craft.model.articulation.is_some()
                || craft.model.coupling.as_ref().is_some_and(|coupling| coupling.couples_by_damping),
            clamped: clamped.collect(),
            residual: flexible.map(ResidualMass::new).collect(),
            points: points.collect(),
            turned: scenario
                .study
                .articulation()
                .map(|drives| modes_at_angles(drives, scenario))
                .unwrap_or_default(),
        }
    }
}

/// Returns the frequencies of the free modes at equidistant instants of the run.
fn modes_at_angles(
    AppendageDrives { driven, courses }: &AppendageDrives,
    scenario: &Scenario,
) -> Vec<ModesAtAngles> {
    let modes_at = |step: u32| {
        let time_s = scenario.duration.seconds() * f64::from(step) / f64::from(PARTS);
        let angles_rad: Vec<f64> = (0..courses.count()).map(|drive| courses.at(drive, time_s)[0]).collect();
        ModesAtAngles { time_s, frequencies_rad_s: driven.frequencies(&angles_rad), angles_rad }
    };
    (0..=PARTS).map(modes_at).collect()
}

fn three(vector: &Vector) -> [f64; 3] {
    [vector.x, vector.y, vector.z]
}
