//! Run-time state of the environment of one body.

use flexsc_dynamics::three_axis::{PanelPlaces, SkyAt, Surroundings, ThermalForces};
use flexsc_numerics::attitude::{Vector, vector};
use flexsc_numerics::time::Instant;
use nalgebra::{Matrix3, Quaternion};

use super::dipole::AxialDipole;
use super::drag::DragLoad;
use super::orbit::{body_axes, to_body, transformed};
use super::plate_mount::PlateMounts;
use super::solar_pressure::SunlightLoad;
use super::thermal_response::ThermalResponse;
use super::{
    Environment, EnvironmentObservation, GravityGradient, OrbitEnvironment, OrbitPath, SolarPressure, SunPath,
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
    /// Forces on plates, and true if appendages turn with some of them.
    sunlight: Option<SunlightLoad>,
    drag: Option<DragLoad>,
    plates_turn: bool,
    /// Magnetic moment of the body (A m²).
    dipole: Vector,
    /// True if a torque depends on the position on the orbit, the field or the Sun, whatever the torquers do.
    follows_sky: bool,
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
    /// Creates the environment of a body under `sky`, with the appendages of its plates. The inertia tensors (kg m²) are those of
    /// the body without the rotors' axial inertia, and of the rotors about their axes; `centre` is the centre of mass from the
    /// origin of positions (m).
    pub fn new(
        environment: &Environment,
        sky: OrbitEnvironment,
        [inertia, spinning]: [Matrix3<f64>; 2],
        centre: &Vector,
        mounts: &PlateMounts,
    ) -> Self {
        let most_pressure = sky.sun().map_or(1.0, SunPath::most_pressure);
        let sunlight = environment.solar_pressure.as_ref().map(|spec| SunlightLoad::new(spec, mounts));
        let pressed = sunlight.as_ref().map_or(0.0, |load| load.bound(centre, most_pressure));
        let torque = vector(&environment.torque);
        let (gradient, dipole) = (environment.gravity_gradient.as_ref(), environment.dipole.as_ref());
        let pull = gradient.map_or(0.0, |gradient| gradient.bound(&(inertia + spinning), &sky));
        let push = dipole.map_or(0.0, |dipole| dipole.bound(sky.field_bound()));
        let drag = environment.drag.as_ref().zip(sky.orbit()).map(|(spec, orbit)| {
            let load = DragLoad::new(spec, orbit, mounts);
            let bound = load.bound(orbit, centre);
            (load, bound)
        });
        let braked = drag.as_ref().map_or(0.0, |(_, bound)| *bound);
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
            follows_sky: gradient.is_some_and(|gradient| gradient.orbit_rate.is_none())
                || (dipole.is_some() && axial.is_none())
                || drag.is_some()
                || (sunlight.is_some() && (sky.orbit().is_some() || sky.sun().is_some())),
            sunlight,
            drag: drag.map(|(load, _)| load),
            plates_turn: mounts.turn,
            dipole: dipole.map_or_else(Vector::zeros, |dipole| vector(&dipole.moment)),
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

    /// Returns the torques of sunlight and drag (N m) on a body with the rotation `turn` of inertial vectors to its axes, about
    /// its centre of mass.
    #[inline]
    fn plate_torque(&self, sky: &SkyAt, turn: &Matrix3<f64>, places: &PanelPlaces<'_>) -> Vector {
        let mut torque = Vector::zeros();
        if let Some(load) = self.sunlight.as_ref().filter(|_| sky.part_in_view > 0.0) {
            torque += load.torque(turn, sky, places);
        }
        if let Some(load) = &self.drag {
            torque += load.torque(turn, sky, places);
        }
        torque
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
    fn sky_at(&self, t: f64) -> SkyAt {
        let Environment { gravity_gradient, solar_pressure, .. } = &self.environment;
        let is_lit = solar_pressure.as_ref().is_some_and(|pressure| pressure.is_lit(t));
        let mut sky = SkyAt { part_in_view: f64::from(is_lit), ..SkyAt::default() };
        if self.follows_sky || self.held != Vector::zeros() {
            let row = self.sky.row(t);
            if let Some(orbit) = self.sky.orbit() {
                let position = row.position();
                let distance = position.norm();
                sky.nadir = position / -distance;
                sky.tide = orbit.gravity() / (distance * distance * distance);
            }
            sky.field = row.field();
            if is_lit {
                let light = row.light();
                (sky.sun, sky.pressure) = (light.direction, light.pressure);
                sky.part_in_view = self.sky.part_in_row(&row, t);
            }
            if let Some(drag) = &self.drag {
                (sky.flow, sky.density) = (drag.flow(&row), drag.density(&row));
            }
        }
        if let Some(pull) = gravity_gradient.as_ref().and_then(|gradient| gradient.own_pull(t)) {
            (sky.nadir, sky.tide) = pull;
        }
        if let Some(own) = &self.axial {
            sky.field = own.at(t);
        }
        sky
    }

    fn torque(&self, sky: &SkyAt, attitude: &Quaternion<f64>, inertia: &Matrix3<f64>) -> Vector {
        let turn = body_axes(attitude);
        let mut torque = sky.torque + transformed(&turn, &self.torque);
        if self.environment.gravity_gradient.is_some() {
            let nadir = transformed(&turn, &sky.nadir);
            torque += GravityGradient::torque(&nadir, sky.tide, &(inertia + self.spinning));
        }
        if !self.plates_turn {
            torque += self.plate_torque(sky, &turn, &PanelPlaces { centre: self.centre, axes: &[] });
        }
        // The body's own dipole along the axis of a circular orbit is the only field there, so torquers have none.
        let moment = if self.axial.is_some() { self.dipole } else { self.dipole + self.held };
        torque + moment.cross(&transformed(&turn, &sky.field))
    }

    fn panel_torque(&self, sky: &SkyAt, attitude: &Quaternion<f64>, panels: &PanelPlaces<'_>) -> Vector {
        if !self.plates_turn {
            return Vector::zeros();
        }
        self.plate_torque(sky, &body_axes(attitude), panels)
    }

    fn tidal_tensor(&self, sky: &SkyAt, attitude: &Quaternion<f64>) -> Option<Matrix3<f64>> {
        self.environment.gravity_gradient.as_ref()?;
        Some(GravityGradient::modal_tensor(&transformed(&body_axes(attitude), &sky.nadir), sky.tide))
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
