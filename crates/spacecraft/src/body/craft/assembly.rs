//! Assembly of a spacecraft from its parts: total mass, clamped modes relative to the hub, free modes, points.

use std::sync::Arc;

use flexsc_dynamics::three_axis::{ArticulatedBody, ClampedModes, FreeModes};
use flexsc_dynamics::three_axis_model::{ModalCoupling, ModelPoint, ThreeAxisMode, ThreeAxisModel};
use flexsc_formats::document::ConfigError;
use flexsc_numerics::attitude::{Vector, vector};
use flexsc_numerics::quantity::{Finite, Frequency, NonNegative};
use nalgebra::{Matrix3, Matrix3xX};

use super::appendage::Appendage;
use super::clamped::antisymmetric_part;
use super::free_damping::FreeModeDamping;
use super::mass::MassProperties;
use super::spacecraft::Spacecraft;
use super::thermal;
use super::validation;
use super::{AssembledSpacecraft, HubRotor};
use crate::body::spatial::NamedPoint;

/// Clamped mode as a part of the spacecraft.
#[derive(Clone, Debug, PartialEq)]
pub struct ClampedModeInBody {
    /// Natural frequency with the root held (rad/s).
    pub frequency: f64,
    /// Damping ratio with the root held.
    pub damping: f64,
    /// Participation in translation, in the body's axes (sqrt(kg)).
    pub translation: Vector,
    /// First moments about the total centre of mass, in the body's axes (sqrt(kg) m).
    pub moments: Matrix3<f64>,
    /// True if the complete first moments are known, and not only their antisymmetric part.
    pub knows_moments: bool,
    /// True if the mode is the swing of a rigid body on a hinge, which is exact at any angle and rate.
    pub is_hinge: bool,
}

/// Appendage with the matrix that transforms vectors from its axes to the body's.
type OrientedAppendage<'a> = (&'a Appendage, Matrix3<f64>);

/// Point of the structure: its position in the body, and the shapes of the clamped modes there.
struct BodyPoint<'a> {
    point: &'a NamedPoint,
    at: Vector,
    /// Displacement and rotation per unit of each clamped mode, relative to the hub.
    shapes: Vec<(Vector, Vector)>,
}

impl AssembledSpacecraft {
    /// Assembles a spacecraft with the drives at `angles` (rad), one for each appendage (ignored for those without a
    /// drive).
    ///
    /// # Errors
    /// The key of inconsistent data, such as `appendage[1].modes[0].translation`, and the reason.
    pub fn assemble(
        spacecraft: &Spacecraft,
        appendages: &[Appendage],
        angles: &[f64],
        rotors: &[HubRotor],
    ) -> Result<Self, ConfigError> {
        validation::validate(spacecraft, appendages)?;
        let oriented: Vec<_> = appendages
            .iter()
            .zip(angles)
            .map(|(appendage, angle)| (appendage, appendage.axes(*angle)))
            .collect();
        let bodies = oriented.iter().map(|(appendage, axes)| appendage.mass_properties(axes));
        let bodies: Vec<_> = std::iter::once(spacecraft.mass_properties()).chain(bodies).collect();
        let whole = MassProperties::sum(&bodies);
        let spinning: Matrix3<f64> = rotors.iter().map(HubRotor::axial_inertia).sum();
        let parts = parts(spacecraft, &oriented, &whole.centre);
        for (index, appendage) in appendages.iter().enumerate() {
            let thermal = appendage.thermal.as_ref();
            if let Some(fault) = thermal.and_then(|thermal| thermal.fault(appendage.clamped_modes().len())) {
                return Err(fault.within(&format!("appendage[{index}]")));
            }
        }
        let held = ClampedModes {
            mass: whole.mass,
            inertia: whole.inertia - spinning,
            frequencies: parts.iter().map(|part| part.frequency).collect(),
            translations: columns(&parts, |part| part.translation),
            rotations: columns(&parts, |part| antisymmetric_part(&part.moments)),
        };
        let residual = held.residual_inertia().unwrap_or_else(Matrix3::zeros);
        validation::validate_hub_inertia(&residual, &held.inertia)?;
        let unsolved =
            || ConfigError::new("spacecraft.inertia", "leaves the free modes without a mass matrix");
        let free = held.free_modes().ok_or_else(unsolved)?;
        let ratios: Vec<f64> = parts.iter().map(|part| part.damping).collect();
        let damping = FreeModeDamping::new(&free, &held.frequencies, &ratios);
        let hub_points = spacecraft.hub_points();
        let places = places(&hub_points, &oriented, parts.len());
        let (attitude, rate) = spacecraft.initial_motion().as_written();
        Ok(Self {
            model: ThreeAxisModel {
                inertia: finite_tensor(held.inertia)?,
                attitude,
                rate,
                small_angles: spacecraft.small_angles.map(Into::into),
                modes: modes(appendages, &held, &free, &damping)?,
                points: points(&places, &free, &whole.centre)?,
                disturbance: None,
                coupling: Some(ModalCoupling {
                    rotations: (0..free.frequencies.len()).map(|mode| free.rotation(mode)).collect(),
                    moments: moments(&parts, &free),
                    couples_by_damping: spacecraft.whole_damping.unwrap_or_else(|| damping.couples_modes()),
                    damping: damping.matrix,
                }),
                articulation: articulation(spacecraft, appendages, &spinning),
            },
            mass: whole.mass,
            centre: whole.centre,
            bendings: thermal::bendings(appendages, &held.frequencies, &free.shapes),
            parts,
            damping_coupling: damping.coupling,
        })
    }
}

/// Returns the spacecraft as a function of the angles of its drives and hinges; `None` if it has neither.
fn articulation(
    spacecraft: &Spacecraft,
    appendages: &[Appendage],
    spinning: &Matrix3<f64>,
) -> Option<Arc<ArticulatedBody>> {
    let hub = spacecraft.mass_properties();
    let mut body =
        ArticulatedBody { hub: (hub.mass, hub.centre, hub.inertia - spinning), panels: Vec::new() };
    for appendage in appendages {
        let drives = body.drives();
        body.panels.push(appendage.for_integrator(spacecraft.frequency_factor(appendage), drives));
    }
    body.is_articulated().then(|| Arc::new(body))
}

impl HubRotor {
    /// Returns the rotor's inertia tensor about its axis alone (kg m²), in the body's axes.
    pub fn axial_inertia(&self) -> Matrix3<f64> {
        self.spin_inertia * self.axis * self.axis.transpose()
    }
}

impl ClampedModeInBody {
    /// Returns the change of the inertia tensor per unit of the mode (sqrt(kg) m): 2 tr(N) 1 - N - N'.
    fn stretching(&self) -> Matrix3<f64> {
        let n = &self.moments;
        2.0 * n.trace() * Matrix3::identity() - n - n.transpose()
    }
}

/// Returns the clamped modes about the total centre of mass, at a distance b from each root: N becomes C N C' + b (C
/// t)'.
fn parts(
    spacecraft: &Spacecraft,
    appendages: &[OrientedAppendage<'_>],
    centre: &Vector,
) -> Vec<ClampedModeInBody> {
    let modes_of = |(appendage, axes): &OrientedAppendage<'_>| -> Vec<ClampedModeInBody> {
        let from_centre = vector(&appendage.at) - centre;
        let factor = spacecraft.frequency_factor(appendage);
        let mode = |mode: &super::ClampedMode| {
            let translation = axes * appendage.translation(mode);
            let own = axes * appendage.moments(mode) * axes.transpose();
            ClampedModeInBody {
                frequency: mode.frequency.get() * factor,
                damping: mode.damping.get(),
                translation,
                moments: own + from_centre * translation.transpose(),
                knows_moments: appendage.has_moments(mode),
                is_hinge: appendage.hinge.is_some(),
            }
        };
        appendage.clamped_modes().iter().map(mode).collect()
    };
    appendages.iter().flat_map(modes_of).collect()
}

fn columns(parts: &[ClampedModeInBody], vector_of: impl Fn(&ClampedModeInBody) -> Vector) -> Matrix3xX<f64> {
    let columns: Vec<Vector> = parts.iter().map(vector_of).collect();
    Matrix3xX::from_fn(columns.len(), |row, column| columns[column][row])
}

/// Returns all points, those of the hub first.
fn places<'a>(
    hub: &'a [NamedPoint],
    appendages: &[OrientedAppendage<'a>],
    modes: usize,
) -> Vec<BodyPoint<'a>> {
    let rigid = || vec![(Vector::zeros(), Vector::zeros()); modes];
    let mut places: Vec<_> =
        hub.iter().map(|point| BodyPoint { point, at: vector(&point.position), shapes: rigid() }).collect();
    let mut first = 0;
    for (appendage, axes) in appendages {
        let clamped = appendage.clamped_modes();
        for point in &appendage.points {
            let mut shapes = rigid();
            for (index, mode) in clamped.iter().enumerate() {
                let shape = mode.shapes.get(&point.name).copied().unwrap_or_default();
                shapes[first + index] = (axes * vector(&shape.translation), axes * vector(&shape.rotation));
            }
            let position = vector(&appendage.at) + axes * vector(&point.position);
            places.push(BodyPoint { point, at: position, shapes });
        }
        first += clamped.len();
    }
    places
}

/// Returns all points with their shapes in the free modes.
fn points(places: &[BodyPoint], free: &FreeModes, centre: &Vector) -> Result<Vec<ModelPoint>, ConfigError> {
    let point = |place: &BodyPoint| {
        let shapes = (0..free.frequencies.len()).map(|mode| place.shape(free, mode, centre));
        Ok(ModelPoint {
            name: place.point.name.clone(),
            position: finite_vector(place.at - centre)?,
            shapes: shapes.collect::<Result<_, ConfigError>>()?,
        })
    };
    places.iter().map(point).collect()
}

/// Returns the free modes with their state at the start.
fn modes(
    appendages: &[Appendage],
    held: &ClampedModes,
    free: &FreeModes,
    damping: &FreeModeDamping,
) -> Result<Vec<ThreeAxisMode>, ConfigError> {
    let clamped: Vec<_> =
        appendages.iter().flat_map(|appendage| appendage.clamped_modes().into_owned()).collect();
    let displacements: Vec<f64> = clamped.iter().map(|mode| mode.displacement.get()).collect();
    let rates: Vec<f64> = clamped.iter().map(|mode| mode.rate.get()).collect();
    let (displacements, rates) = (held.to_free(free, &displacements), held.to_free(free, &rates));
    let mode = |(index, frequency): (usize, &f64)| {
        Ok(ThreeAxisMode {
            frequency: Frequency::new(*frequency).ok_or_else(|| exceeds_rate_limit(*frequency))?,
            damping: NonNegative::new(damping.ratios[index].max(0.0)).ok_or_else(out_of_range)?,
            displacement: finite(displacements[index])?,
            rate: finite(rates[index])?,
        })
    };
    free.frequencies.iter().enumerate().map(mode).collect()
}

impl BodyPoint<'_> {
    /// Returns the displacement u + phi x (p - c) + F Y and the rotation phi + R Y of the point in a free mode that
    /// consists of the clamped modes Y.
    fn shape(&self, free: &FreeModes, mode: usize, centre: &Vector) -> Result<(Vector, Vector), ConfigError> {
        let rotation = free.rotation(mode);
        let hub = (free.translation(mode) + rotation.cross(&(self.at - centre)), rotation);
        let column = free.shapes.column(mode);
        let parts = self.shapes.iter().zip(column.iter());
        let (translation, rotation) =
            parts.fold(hub, |(f, r), (shape, part)| (f + shape.0 * *part, r + shape.1 * *part));
        Ok((finite_vector(translation)?, finite_vector(rotation)?))
    }
}

/// Returns the change of the inertia tensor per unit of each free mode (sqrt(kg) m).
fn moments(parts: &[ClampedModeInBody], free: &FreeModes) -> Vec<Matrix3<f64>> {
    let moments_of = |mode: usize| {
        let column = free.shapes.column(mode);
        parts.iter().zip(column.iter()).map(|(part, share)| part.stretching() * *share).sum()
    };
    (0..free.frequencies.len()).map(moments_of).collect()
}

fn exceeds_rate_limit(frequency: f64) -> ConfigError {
    let why = format!(
        "must leave the hub inertia of its own: with the hub free a mode has {frequency:e} rad/s, and {} to {} rad/s are \
         computed",
        Frequency::SMALLEST,
        Frequency::LARGEST
    );
    ConfigError::new("spacecraft.inertia", why)
}

fn out_of_range() -> ConfigError {
    ConfigError::new("spacecraft", "has numbers whose products leave the range of double precision")
}

fn finite(value: f64) -> Result<Finite, ConfigError> {
    Finite::new(value).ok_or_else(out_of_range)
}

fn finite_vector(vector: Vector) -> Result<Vector, ConfigError> {
    if vector.iter().all(|component| component.is_finite()) { Ok(vector) } else { Err(out_of_range()) }
}

fn finite_tensor(tensor: Matrix3<f64>) -> Result<Matrix3<f64>, ConfigError> {
    if tensor.iter().all(|component| component.is_finite()) { Ok(tensor) } else { Err(out_of_range()) }
}
