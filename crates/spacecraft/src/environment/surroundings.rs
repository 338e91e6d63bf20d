//! Run-time state of the environment of one body.

use flexsc_dynamics::three_axis::{PanelPlaces, Surroundings, ThermalForces};
use flexsc_numerics::attitude::{Vector, vector};
use flexsc_numerics::time::Instant;
use nalgebra::{Matrix3, Quaternion};

use super::dipole::AxialDipole;
use super::orbit::to_body;
use super::plate_mount::{PlateMounts, PlatePlaces};
use super::thermal_response::ThermalResponse;
use super::{
    Environment, EnvironmentObservation, GravityGradient, OrbitEnvironment, OrbitPath, OrbitPosition,
    SolarPressure, SunPath,
};
use crate::body::craft::Bending;

/// Environment of a body during a run.
#[derive(Clone, Debug, PartialEq)]
pub struct SurroundingsState {
    environment: Environment,
    sky: OrbitEnvironment,
    /// Field of the body's dipole, if that has one of its own.
    axial: Option<AxialDipole>,
    /// Inertia of the rotors about their axes (kg m²), which the body's inertia leaves out and gravity acts on too.
    spinning: Matrix3<f64>,
    /// Centre of mass from the origin of positions (m).
    centre: Vector,
    mounts: PlateMounts,
    /// Torque that is constant in inertial axes (N m).
    torque: Vector,
    /// Thermal bending of the appendages, and their levels over time.
    heated: Vec<ThermalForces>,
    responses: Vec<ThermalResponse>,
    /// Magnetic moment of the torquers, in the body's axes (A m²).
    held: Vector,
    bound: f64,
    frequency: f64,
}

impl SurroundingsState {
    /// Creates the environment of a body under `sky`, with the appendages of its plates. The inertia tensors (kg m²) are those of the body without the
    /// rotors' axial inertia, and of the rotors about their axes; `centre` is the centre of mass from the origin of
    /// positions (m).
    pub fn new(
        environment: &Environment,
        sky: OrbitEnvironment,
        [inertia, spinning]: [Matrix3<f64>; 2],
        centre: &Vector,
        mounts: PlateMounts,
    ) -> Self {
        let nearest = sky.sun().map_or(1.0, SunPath::most_pressure);
        let pressed = environment
            .solar_pressure
            .as_ref()
            .map_or(0.0, |pressure| pressure.bound(centre, nearest, &mounts));
        let torque = vector(&environment.torque);
        let (gradient, dipole) = (environment.gravity_gradient.as_ref(), environment.dipole.as_ref());
        let pull = gradient.map_or(0.0, |gradient| gradient.bound(&(inertia + spinning), &sky));
        let push = dipole.map_or(0.0, |dipole| dipole.bound(sky.field_bound()));
        let drag = environment.drag.as_ref().zip(sky.orbit());
        let braked = drag.map_or(0.0, |(drag, orbit)| drag.bound(orbit, centre, &mounts));
        let axial = dipole.and_then(super::Dipole::own_field);
        let own =
            gradient.and_then(|gradient| gradient.orbit_rate).map(flexsc_numerics::quantity::Positive::get);
        let orbits = [own, axial.map(|orbit| orbit.rate), sky.orbit().map(OrbitPath::fastest)];
        let fastest = orbits.into_iter().flatten().fold(0.0, f64::max) + sky.field_rotation();
        Self {
            environment: environment.clone(),
            axial,
            spinning,
            centre: *centre,
            mounts,
            bound: torque.norm() + pressed + pull + push + braked,
            // Gradient and dipole torques are of second order in the sine and cosine of the local axes' angle; a field of
            // degree n is of order n + 1.
            frequency: (sky.field_degree() + 1).max(2) as f64 * fastest,
            torque,
            held: Vector::zeros(),
            heated: Vec::new(),
            responses: Vec::new(),
            sky,
        }
    }

    /// Adds thermal bending of the body by sunlight, relative to the state of light at the start.
    #[must_use]
    pub fn with_thermal_bending(self, bendings: &[Bending]) -> Self {
        let heated =
            bendings.iter().map(|bending| ThermalForces { forces: bending.forces.clone() }).collect();
        let responses = bendings.iter().map(|bending| ThermalResponse::new(bending.time_constant)).collect();
        let fastest = bendings.iter().map(|bending| 1.0 / bending.time_constant).fold(0.0, f64::max);
        Self { heated, responses, frequency: self.frequency + fastest, ..self }
    }

    /// Sets the magnetic moment of the torquers from now on, in the body's axes (A m²).
    pub fn set_magnetic_moment(&mut self, moment: Vector) {
        self.held = moment;
    }

    /// Returns the torque of the torquers' moment on a body of the given attitude, in its axes (N m).
    pub fn magnetic_torque(&self, t: f64, attitude: &Quaternion<f64>) -> Vector {
        if self.held == Vector::zeros() {
            return Vector::zeros();
        }
        self.sky.field_at(t).map_or_else(Vector::zeros, |field| self.held.cross(&to_body(attitude, &field)))
    }

    /// Returns the orbit, field and Sun.
    pub fn sky(&self) -> &OrbitEnvironment {
        &self.sky
    }

    /// Returns the observable field and Sun direction at a time since the start (s).
    pub fn observation(&self, t: f64) -> EnvironmentObservation {
        self.sky.observation(t)
    }

    /// Adds the torques of sunlight and drag (N m) at a time (s) and an attitude, about the centre of mass (m) and with the rotations
    /// of the appendages.
    fn add_plate_torques(
        &self,
        torque: &mut Vector,
        (t, attitude): (f64, &Quaternion<f64>),
        place: Option<&OrbitPosition>,
        (centre, axes): (&Vector, Option<&[Matrix3<f64>]>),
    ) {
        let Environment { solar_pressure, drag, .. } = &self.environment;
        if let Some(pressure) = solar_pressure.as_ref().filter(|pressure| pressure.is_lit(t)) {
            let part = self.sky.part_in_view(t);
            if part > 0.0 {
                let light = self.sky.sun().map(|sun| sun.light(t));
                let places = PlatePlaces { mounts: &self.mounts.lit, axes };
                *torque += pressure.torque(attitude, light, centre, places) * part;
            }
        }
        if let (Some(drag), Some(orbit), Some(place)) = (drag, self.sky.orbit(), place) {
            let sun = self.sky.sun().map(|sun| sun.direction(t));
            let density = drag.density_at(place, orbit, sun.as_ref());
            let places = PlatePlaces { mounts: &self.mounts.braked, axes };
            *torque += drag.torque(density, place, attitude, (centre, places));
        }
    }

    /// Returns true if sunlight acts on the body.
    fn depends_on_light(&self) -> bool {
        self.environment.solar_pressure.is_some() || !self.heated.is_empty()
    }

    /// Returns the instants at which a torque or bending by sunlight begins or ends.
    pub fn change_times(&self) -> impl Iterator<Item = Instant> {
        let own = self.environment.solar_pressure.iter().flat_map(SolarPressure::shadow_times);
        own.chain(self.depends_on_light().then(|| self.sky.shadow_edges()).into_iter().flatten())
    }
}

impl Surroundings for SurroundingsState {
    fn torque(&self, t: f64, attitude: &Quaternion<f64>, inertia: &Matrix3<f64>) -> Vector {
        let Environment { gravity_gradient, dipole, .. } = &self.environment;
        let mut torque = to_body(attitude, &self.torque);
        let place = self.sky.position(t);
        if let Some(gradient) = gravity_gradient {
            let pull = gradient.direction_and_strength(t, attitude, place.as_ref());
            torque += GravityGradient::torque(pull, &(inertia + self.spinning));
        }
        if !self.mounts.turn {
            self.add_plate_torques(&mut torque, (t, attitude), place.as_ref(), (&self.centre, None));
        }
        let is_held = self.held != Vector::zeros();
        let field = if is_held || dipole.is_some() { self.sky.field_at(t) } else { None };
        if let Some(dipole) = dipole {
            let field = self.axial.map(|own| own.at(t)).or(field).unwrap_or_default();
            torque += dipole.torque(&field, attitude);
        }
        if let Some(field) = field.filter(|_| is_held) {
            torque += self.held.cross(&to_body(attitude, &field));
        }
        torque
    }

    fn panel_torque(&self, t: f64, attitude: &Quaternion<f64>, panels: &PanelPlaces<'_>) -> Vector {
        let mut torque = Vector::zeros();
        if self.mounts.turn {
            let place = self.sky.position(t);
            self.add_plate_torques(
                &mut torque,
                (t, attitude),
                place.as_ref(),
                (&panels.centre, Some(panels.axes)),
            );
        }
        torque
    }

    fn tidal_tensor(&self, t: f64, attitude: &Quaternion<f64>) -> Option<Matrix3<f64>> {
        let gradient = self.environment.gravity_gradient.as_ref()?;
        Some(GravityGradient::modal_tensor(gradient.direction_and_strength(
            t,
            attitude,
            self.sky.position(t).as_ref(),
        )))
    }

    fn thermal_forces(&self) -> &[ThermalForces] {
        &self.heated
    }

    fn thermal_level(&self, index: usize, t: f64) -> f64 {
        self.responses.get(index).map_or(0.0, |response| response.level(&self.sky, t))
    }

    fn bound(&self) -> f64 {
        self.bound + self.held.norm() * self.sky.field_bound()
    }

    fn frequency(&self) -> f64 {
        self.frequency
    }

    fn frequency_at(&self, t: f64) -> f64 {
        if self.depends_on_light() { self.frequency + self.sky.light_rate(t) } else { self.frequency }
    }
}
