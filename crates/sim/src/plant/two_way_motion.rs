//! Motion of a three-axis body whose modes act back on its rotation.

use std::sync::Arc;

use flexsc_control::drive_profile::DriveProfiles;
use flexsc_control::sensor::{Orientation, Truth};
use flexsc_dynamics::ModeState;
use flexsc_dynamics::flow::{ElasticModes, RigidBody, ThreeAxisState};
use flexsc_dynamics::periodic_torque::PeriodicTorque;
use flexsc_dynamics::sine::SineTorque;
use flexsc_dynamics::three_axis::{
    ArticulatedMotion, Bearing, DriveAngles, FlexibleBody, PanelPlaces, RotorObservation, SegmentLoads,
    SharedSteps, SkyAt, SlipDirection, Surroundings, ThermalForces, ThreeAxisMotion,
};
use flexsc_dynamics::three_axis_model::ThreeAxisModel;
use flexsc_dynamics::wrench::Wrench;
use flexsc_numerics::attitude::{Vector, rotation, vector};
use flexsc_spacecraft::body::craft::Translation;
use flexsc_spacecraft::environment::SurroundingsState;
use nalgebra::{Matrix3, Quaternion};

use flexsc_scenario::AppendageDrives;

/// Motion of a three-axis body whose modes act back on its rotation: the integrator, with the data that convert loads
/// and true state between it and the plant.
#[derive(Clone, Debug)]
pub struct TwoWayMotion {
    motion: ThreeAxisMotion,
    frequencies: Vec<f64>,
    /// Modal rotations of the hub (rad/(m sqrt(kg))).
    hub: Vec<Vector>,
    /// Modal rotations at the first sensor less those of the hub.
    sensor_offsets: Vec<Vector>,
    /// Modal rotations at the point where torques act less those of the hub.
    torque_offsets: Vec<Vector>,
    outside: ExternalTorques,
    acting: SegmentLoads,
    /// Translation under forces, and the initial position of the first point from the centre of mass (m).
    translation: Option<(Translation, Vector)>,
    /// Drive angles of the appendages, if there are drives or hinges, and the index of their next change of modes.
    drive_angles: Option<(Arc<DriveProfiles>, usize)>,
}

/// Mounting point of an accelerometer.
#[derive(Clone, Debug)]
pub struct AccelerometerMount {
    /// Position in the undeformed body, from the centre of mass (m).
    at: Vector,
    /// Displacement per unit of each mode, in hub axes, and (`turns`) rotation against the hub.
    shifts: Vec<Vector>,
    turns: Vec<Vector>,
    /// Total mass (kg).
    mass: f64,
}

impl AccelerometerMount {
    /// Creates the mount at a point of a body with total mass `mass` (kg).
    pub fn new(body: &ThreeAxisModel, mass: f64, point: &str) -> Self {
        let first = body.points.first().map_or("", |point| &point.name);
        let (here, hub) = (body.shapes(point), body.shapes(first));
        Self {
            mass,
            at: body.point(point).unwrap_or_default(),
            shifts: body.displacements(point, &Vector::zeros()),
            turns: here.iter().zip(&hub).map(|((_, here), (_, hub))| here - hub).collect(),
        }
    }
}

/// Torques that depend on time or attitude within a segment, as the integrator reads them.
#[derive(Clone, Debug)]
struct ExternalTorques {
    /// Periodic disturbance of the body itself.
    own: Option<PeriodicTorque>,
    /// Environment.
    around: Option<SurroundingsState>,
    /// Sinusoidal torques of actuators and disturbances, each with its axis.
    sines: Vec<(Vector, SineTorque)>,
}

impl ExternalTorques {
    /// Returns the torques for a segment that begins `began` seconds after the start; `None` if nothing acts.
    fn since(&self, began: f64) -> Option<(&dyn Surroundings, f64)> {
        let acts = self.own.is_some() || self.around.is_some() || !self.sines.is_empty();
        acts.then_some((self as &dyn Surroundings, began))
    }

    /// Returns the body's own disturbance and the environment, without the sines, at a time since the start (s).
    fn surrounding(&self, t: f64) -> SkyAt {
        let mut sky = self.around.as_ref().map_or_else(SkyAt::default, |around| around.sky_at(t));
        if let Some(own) = &self.own {
            sky.torque += own.at(t);
        }
        sky
    }
}

impl Surroundings for ExternalTorques {
    fn sky_at(&self, t: f64) -> SkyAt {
        let mut sky = self.surrounding(t);
        for (axis, sine) in &self.sines {
            sky.torque += axis * sine.at(t);
        }
        sky
    }

    fn torque(&self, sky: &SkyAt, attitude: &Quaternion<f64>, inertia: &Matrix3<f64>) -> Vector {
        self.around.as_ref().map_or(sky.torque, |around| around.torque(sky, attitude, inertia))
    }

    fn panel_torque(&self, sky: &SkyAt, attitude: &Quaternion<f64>, panels: &PanelPlaces<'_>) -> Vector {
        let around = self.around.as_ref();
        around.map_or_else(Vector::zeros, |around| around.panel_torque(sky, attitude, panels))
    }

    fn tidal_tensor(&self, sky: &SkyAt, attitude: &Quaternion<f64>) -> Option<Matrix3<f64>> {
        self.around.as_ref()?.tidal_tensor(sky, attitude)
    }

    fn thermal_forces(&self) -> &[ThermalForces] {
        self.around.as_ref().map_or(&[], Surroundings::thermal_forces)
    }

    fn thermal_level(&self, index: usize, t: f64) -> f64 {
        self.around.as_ref().map_or(0.0, |around| around.thermal_level(index, t))
    }

    fn bound(&self) -> f64 {
        let own = self.own.as_ref().map_or(0.0, PeriodicTorque::bound);
        let sines: f64 = self.sines.iter().map(|(_, sine)| sine.amplitude.abs()).sum();
        own + self.around.as_ref().map_or(0.0, Surroundings::bound) + sines
    }

    fn frequency(&self) -> f64 {
        let own = self.own.as_ref().map_or(0.0, PeriodicTorque::frequency);
        let fastest = self.sines.iter().map(|(_, sine)| sine.frequency).fold(0.0, f64::max);
        own + self.around.as_ref().map_or(0.0, Surroundings::frequency) + fastest
    }

    fn frequency_at(&self, t: f64) -> f64 {
        let around = self.around.as_ref().map_or(0.0, |around| around.frequency_at(t) - around.frequency());
        self.frequency() + around
    }
}

/// Two-way coupled motion, with the start of its segment.
#[derive(Copy, Clone, Debug)]
pub struct TwoWaySegment<'a> {
    pub motion: &'a TwoWayMotion,
    /// Start of the segment (s).
    pub start: f64,
}

impl TwoWayMotion {
    /// Creates the motion at the start, under the environment alone, with the modal rotations at the first sensor and
    /// where torques act, the bearings of the rotors, if any, and the steps that it shares with other runs.
    pub fn new(
        body: &ThreeAxisModel,
        flexible: &FlexibleBody,
        around: Option<SurroundingsState>,
        moving: Option<Translation>,
        [sensed, acts]: [&[Vector]; 2],
        (bearings, common): (&[Bearing], &SharedSteps),
    ) -> Self {
        let frequencies: Vec<f64> = flexible.modes.iter().map(|mode| mode.frequency).collect();
        let start = ElasticModes::start(body);
        let modes = start.iter().zip(&frequencies);
        let modes: Vec<_> = modes.map(|(phase, w)| [phase.displacement, w * phase.quadrature]).collect();
        let hub: Vec<Vector> = flexible.modes.iter().map(|mode| mode.rotation).collect();
        let beyond = |at: &[Vector]| at.iter().zip(&hub).map(|(at, hub)| at - hub).collect();
        let start = (body.attitude.get(), vector(&body.rate));
        let mut motion = ThreeAxisMotion::with_shared(common, flexible, start, &modes);
        let placed = |moving: Translation| {
            let [began, _] = moving.position(motion.view());
            (moving, began)
        };
        let moving = moving.map(placed);
        motion.set_bearings(bearings.to_vec());
        Self {
            translation: moving,
            motion,
            sensor_offsets: beyond(sensed),
            torque_offsets: beyond(acts),
            outside: ExternalTorques { own: body.disturbance, around, sines: Vec::new() },
            acting: SegmentLoads::default(),
            frequencies,
            hub,
            drive_angles: None,
        }
    }

    /// Returns the motion with drives that rotate the appendages, and hinges on which they swing.
    #[must_use]
    pub fn with_appendages(mut self, drives: Option<&AppendageDrives>) -> Self {
        let Some(AppendageDrives { driven, courses }) = drives else { return self };
        // Each run has its own arcs: those of runs on other threads are about other times.
        let courses = Arc::new(DriveProfiles::clone(courses));
        let Some(driving) = ArticulatedMotion::new(driven.clone(), courses.clone()) else { return self };
        self.motion.start_drives(driving);
        self.translation = self.translation.map(|(moving, _)| {
            let [began, _] = moving.position(self.motion.view());
            (moving, began)
        });
        self.drive_angles = Some((courses, 0));
        self
    }

    /// Returns true if drives rotate the appendages.
    pub fn has_drives(&self) -> bool {
        self.drive_angles.as_ref().is_some_and(|(courses, _)| courses.count() > 0)
    }

    /// Returns angle (rad) and rate (rad/s) of each hinge at the current instant.
    pub fn hinges(&self) -> &[[f64; 2]] {
        &self.motion.view().hinges
    }

    /// Returns angle (rad) and rate (rad/s) of each drive at `t` seconds after the start.
    pub fn drives(&self, t: f64) -> Vec<[f64; 2]> {
        let each = |courses: &DriveProfiles| (0..courses.count()).map(|drive| courses.at(drive, t)).collect();
        self.drive_angles.as_ref().map_or_else(Vec::new, |(courses, _)| each(courses))
    }

    /// Returns the modal frequencies (rad/s) and rotations of the hub at the current instant; `None` without drives and
    /// hinges.
    pub fn modes(&self) -> Option<(&[f64], &[Vector])> {
        let seen = self.motion.view();
        self.drive_angles.as_ref().map(|_| (&seen.frequencies[..], &seen.rotations[..]))
    }

    /// Returns the energy of motion and deformation of each mode (J).
    pub fn modal_energies(&self) -> impl Iterator<Item = f64> + '_ {
        self.motion.energies()
    }

    /// Replaces the modes by those of the drive angles that are due at `began` seconds after the start, before a
    /// segment begins.
    fn change_modal_basis(&mut self, began: f64) {
        self.motion.set_segment_start(began);
        let Some((courses, next)) = &mut self.drive_angles else { return };
        let mut to = None;
        while let Some((_, middle)) = courses.changes.get(*next).filter(|(at, _)| at.seconds() <= began) {
            (to, *next) = (Some(*middle), *next + 1);
        }
        if let Some(middle) = to {
            self.motion.change_basis(middle);
        }
    }

    /// Advances the body to `h` seconds after the segment's start, which was `began` seconds after the run's start,
    /// while `go_on` succeeds. Returns the time after the segment's start (s) at which a rotor sticks or lets go, if
    /// that comes earlier.
    pub fn advance<E>(
        &mut self,
        h: f64,
        began: f64,
        go_on: impl FnMut() -> Result<(), E>,
    ) -> Result<Option<f64>, E> {
        self.motion.advance(h, self.outside.since(began), go_on)
    }

    /// Advances the body to `h` seconds after the segment's start, the instant at which a rotor sticks or lets go.
    pub fn stop_at_bearing_event(&mut self, h: f64, began: f64) {
        self.motion.stop_at_event(h, self.outside.since(began));
    }

    /// Returns an upper bound on the frequencies in the motion at the current instant (rad/s).
    pub fn fastest(&self) -> f64 {
        self.motion.fastest(self.outside.since(0.0).map(|(outside, _)| outside))
    }

    /// Returns the slip states of the rotors in bearings.
    pub fn slip_states(&self) -> &[SlipDirection] {
        self.motion.slip_states()
    }

    /// Returns the heat of all rotors' friction since the start (J); `None` without bearings.
    pub fn friction_heat(&self) -> Option<f64> {
        self.motion.friction_heat()
    }

    /// Returns the states of the rotors in bearings at the current instant, in a segment that began `began` seconds
    /// after the start.
    pub fn rotor_observations(&self, began: f64) -> Vec<RotorObservation> {
        self.motion.rotor_observations(self.outside.since(began))
    }

    /// Returns the torque of the environment and the body's own disturbance at the current instant `t` (s), in hub axes
    /// (N m); `None` if there is neither.
    pub fn environment_torque(&self, t: f64) -> Option<Vector> {
        let acts = self.outside.around.is_some() || self.outside.own.is_some();
        let (centre, axes) = &self.motion.view().panels;
        acts.then(|| {
            let sky = self.outside.surrounding(t);
            let rest = self.outside.torque(&sky, self.attitude(), &self.motion.inertia());
            if axes.is_empty() {
                return rest;
            }
            rest + self.outside.panel_torque(&sky, self.attitude(), &PanelPlaces { centre: *centre, axes })
        })
    }

    /// Returns the environment of the body; `None` without one.
    pub fn surroundings(&self) -> Option<&SurroundingsState> {
        self.outside.around.as_ref()
    }

    /// Begins a motion segment at the current instant, `began` seconds after the start, under the loads from now on.
    pub fn depart(&mut self, wrench: &Wrench, began: f64) {
        let (push, hub) = (wrench.torque, Vector::from(wrench.hub));
        if let Some(around) = &mut self.outside.around {
            around.set_magnetic_moment(wrench.moment);
        }
        self.outside.sines.clone_from(&wrench.sines);
        let SegmentLoads { torque, forces, force_arms, rotors, gimbals, com_acceleration } = &mut self.acting;
        force_arms.clone_from(&wrench.levers);
        let moving = self.translation.as_ref();
        *com_acceleration =
            moving.map_or_else(Vector::zeros, |(moving, _)| moving.acceleration(&wrench.force));
        *torque = push + hub;
        rotors.clone_from(&wrench.rotors);
        gimbals.clone_from(&wrench.gimbals);
        // The integrator gives the modes their part of a torque on the hub; jets and torques at other points excite
        // them differently.
        let given = wrench.forces.iter().copied().chain(std::iter::repeat(0.0));
        let beyond = self.hub.iter().zip(&self.torque_offsets).zip(given);
        forces.clear();
        forces.extend(beyond.map(|((of_hub, acts), force)| force - of_hub.dot(&push) + acts.dot(&hub)));
        self.change_modal_basis(began);
        self.motion.begin_segment(&self.acting);
        self.motion.resolve_stick_slip(self.outside.since(began));
    }

    /// Writes the motion as seen from the mean axes into `state`.
    pub fn write_state(&self, rigid: &RigidBody, state: &mut ThreeAxisState) {
        let seen = self.motion.view();
        state.turn = rigid.start(seen.mean_attitude, seen.rigid_rate);
        let modes = seen.displacements.iter().zip(&seen.rates).zip(&self.frequencies);
        for (phase, ((displacement, rate), w)) in state.modes.iter_mut().zip(modes) {
            *phase = ModeState { displacement: *displacement, quadrature: rate / w };
        }
    }

    /// Writes the true state, except for the sky, into `truth`, with the modal rotations `sensed` at the sensor; the
    /// attitude is that of the hub. Returns the elastic part of the rates (rad/s).
    pub fn write_truth(&self, sensed: &[Vector], truth: &mut Truth) -> Vector {
        let seen = self.motion.view();
        let sum = |shapes: &[Vector], of: &[f64]| -> Vector {
            shapes.iter().zip(of).fold(Vector::zeros(), |sum, (shape, q)| sum + shape * *q)
        };
        let elastic = sum(sensed, &seen.rates);
        truth.orientation = Orientation::Attitude(seen.attitude);
        truth.elastic = sum(&self.sensor_offsets, &seen.displacements).into();
        truth.rate = (seen.rigid_rate + elastic).into();
        truth.rigid_rate = seen.rigid_rate.into();
        truth.rate_integral = (seen.rigid_angle + sum(sensed, &seen.displacements)).into();
        elastic
    }

    /// Returns the displacement of the first point since the start (m), and its velocity (m/s), if any force can act.
    pub fn position(&self) -> Option<[Vector; 2]> {
        self.translation.as_ref().map(|(moving, began)| {
            let [position, velocity] = moving.position(self.motion.view());
            [position - began, velocity]
        })
    }

    /// Returns the specific force at a mount (m/s²), in axes that rotate with it, at the current instant of a segment
    /// that began `began` seconds after the start: the acceleration without that of free fall.
    pub fn specific_force(&self, place: &AccelerometerMount, began: f64) -> Vector {
        let seen = self.motion.view();
        let found = self.motion.accelerations(self.outside.since(began));
        let sum = |shapes: &[Vector], of: &[f64]| -> Vector {
            shapes.iter().zip(of).fold(Vector::zeros(), |sum, (shape, q)| sum + shape * *q)
        };
        let arm = place.at + sum(&place.shifts, &seen.displacements);
        let moves = sum(&place.shifts, &seen.rates);
        let rate = &seen.rate;
        let force = found.centre
            + found.shaking / place.mass
            + sum(&place.shifts, &found.modes)
            + 2.0 * rate.cross(&moves)
            + found.hub.cross(&arm)
            + rate.cross(&rate.cross(&arm));
        let turned = rotation(&sum(&place.turns, &seen.displacements));
        (turned.conjugate() * Quaternion::from_imag(force) * turned).vector().into_owned()
    }

    /// Returns the attitude of the hub.
    pub fn attitude(&self) -> &Quaternion<f64> {
        &self.motion.view().attitude
    }

    /// Returns the energy of the rotation (J), and the angular momentum including rotors (N m s).
    pub fn energy(&self) -> (f64, f64) {
        let seen = self.motion.view();
        (seen.rotational_energy, seen.momentum.norm())
    }
}

#[cfg(test)]
mod tests;
