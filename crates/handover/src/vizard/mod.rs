//! Messages for Vizard: a file of protobuf messages, each after its length.
//!
//! The rotation is true; only the bending of parts is magnified, as in scenes. Parts are boxes of their own, with the
//! spacecraft as their parent.

mod messages;
mod pulses;

use flexsc_core::numerics::attitude::{Vector, vector};
use flexsc_core::numerics::quantity::Positive;
use flexsc_core::record::foxglove::{Color, FrameTransform, SceneEntity};
use flexsc_core::record::row::LogDate;
use flexsc_core::record::{Columns, SceneSource};
use flexsc_core::spacecraft::environment::SurroundingsState;
use flexsc_view::scene::Scene;
use nalgebra::Quaternion;
use prost::Message;

use crate::calendar::CivilDate;
use crate::error::HandoverError;
use crate::motion_rows::{AttitudeSample, OrbitSample, RunLog, nanoseconds};
use crate::oem::center;
use crate::options::{HandoverOptions, keyword_value};
use crate::placement::{BODY, Placement, in_body};
use crate::scene_rows::{HubMotion, SceneRow, section_weights};
use messages::{
    VizCelestialBody, VizEpoch, VizMessage, VizModel, VizSensor, VizSettings, VizSpacecraft, VizThruster,
    VizTime, VizWheel,
};
use pulses::{jet_pulses, nested_numbers, open_parts};

/// Astronomical unit (m).
const UNIT: f64 = 149_597_870_700.0;
/// Rotation rate of the Earth (rad/s).
const EARTH_RATE: f64 = 7.292_115e-5;

/// Returns the run as the bytes of a Vizard file (length-delimited protobuf).
pub fn to_vizard(run: &RunLog<'_>, options: &HandoverOptions) -> Result<Vec<u8>, HandoverError> {
    let attitudes = run.attitude_rows()?;
    let orbit = run.orbit_rows()?;
    let rows = run.scene_rows(0)?;
    let epoch = match options.epoch_ns.or(run.scenario.date_ns()) {
        Some(_) => Some(options.date(run)?),
        None => None,
    };
    if rows.len() != attitudes.len() || orbit.as_ref().is_some_and(|orbit| orbit.len() != rows.len()) {
        let why = "not a readable log of flexsc: rows of its topics do not belong together";
        return Err(HandoverError::Refused(why.to_owned()));
    }
    let name = keyword_value(&run.scenario.name);
    let sections = section_weights(run.scenario);
    let mut scene = Scene::new(run.scenario).with_true_rotation();
    let parts = parts(&scene);
    let planet = if orbit.is_some() { Some(center(run, options)?.to_lowercase()) } else { None };
    let times: Vec<u64> = rows.iter().map(|row| row.time_ns).collect();
    let equipment = Equipment::new(run, &times)?;
    let mut file = Vec::new();
    for (index, (row, attitude)) in rows.iter().zip(&attitudes).enumerate() {
        let place = orbit.as_ref().map(|orbit| orbit[index]);
        let frames = row.draw(&mut scene, &sections).transforms.clone();
        let mut main = spacecraft(&name, attitude, place.as_ref());
        equipment.add(&mut main, index);
        let mut message = VizMessage {
            current_time: Some(VizTime { frame_number: index as i64, elapsed_ns: row.time_ns as f64 }),
            celestial_bodies: planet
                .as_ref()
                .map_or_else(Vec::new, |planet| bodies(run, planet, row.time_ns)),
            spacecraft: Vec::with_capacity(1 + parts.len()),
            settings: (index == 0).then(|| settings(&name, &parts)),
            epoch: epoch.filter(|_| index == 0).map(date),
        };
        let body = body_placement(row, place.as_ref());
        let moving = parts.iter().filter(|part| part.frame != BODY);
        message.spacecraft.push(main);
        message.spacecraft.extend(moving.map(|part| part.spacecraft(&name, &body, &frames, place.as_ref())));
        message
            .encode_length_delimited(&mut file)
            .map_err(|error| HandoverError::Refused(error.to_string()))?;
    }
    Ok(file)
}

fn date(epoch: u64) -> VizEpoch {
    let date = CivilDate::from_nanoseconds(epoch);
    VizEpoch {
        year: date.year as i32,
        month: date.month as i32,
        day: date.day as i32,
        hours: date.hour as i32,
        minutes: date.minute as i32,
        seconds: date.nanoseconds as f64 / 1e9,
    }
}

/// Returns the modified Rodrigues parameters of a unit quaternion: of both sets the one of at most half a turn.
fn rodrigues(q: &Quaternion<f64>) -> Vec<f64> {
    let sign = if q.w < 0.0 { -1.0 } else { 1.0 };
    let scale = sign / (1.0 + sign * q.w);
    // Adding 0 removes the sign of a zero.
    [q.i, q.j, q.k].map(|part| part * scale + 0.0).to_vec()
}

fn list(of: &Vector) -> Vec<f64> {
    of.iter().copied().collect()
}

fn spacecraft(name: &str, attitude: &AttitudeSample, place: Option<&OrbitSample>) -> VizSpacecraft {
    VizSpacecraft {
        spacecraft_name: name.to_owned(),
        position: list(&place.map_or_else(Vector::zeros, |place| place.position)),
        velocity: list(&place.map_or_else(Vector::zeros, |place| place.velocity)),
        rotation: rodrigues(&attitude.attitude),
        ..VizSpacecraft::default()
    }
}

/// Returns the placement of the drawn body's axes in inertial axes.
fn body_placement(row: &SceneRow, place: Option<&OrbitSample>) -> Placement {
    let rotation = match row.hub {
        HubMotion::OneAxis { angle, .. } => {
            let (sin, cos) = libm::sincos(0.5 * angle);
            Quaternion::new(cos, 0.0, 0.0, sin)
        }
        HubMotion::ThreeAxis(attitude) => attitude,
    };
    Placement { rotation, at: place.map_or_else(Vector::zeros, |place| place.position) }
}

/// Box of a scene.
struct BoxPart {
    /// Name: that of the frame.
    frame: String,
    /// Placement of its centre in the frame.
    center: Placement,
    /// Edges (m).
    edges: Vector,
    color: Color,
}

impl BoxPart {
    fn spacecraft(
        &self,
        parent: &str,
        body: &Placement,
        frames: &[FrameTransform],
        place: Option<&OrbitSample>,
    ) -> VizSpacecraft {
        let placement = body.then(&in_body(frames, &self.frame)).then(&self.center);
        VizSpacecraft {
            spacecraft_name: self.frame.clone(),
            position: list(&placement.at),
            velocity: list(&place.map_or_else(Vector::zeros, |place| place.velocity)),
            rotation: rodrigues(&placement.rotation),
            parent_spacecraft_name: parent.to_owned(),
            ..VizSpacecraft::default()
        }
    }
}

/// Returns the hub and the sections of panels, wings and booms as boxes.
fn parts(scene: &Scene) -> Vec<BoxPart> {
    let part = |entity: SceneEntity| {
        let SceneEntity { frame_id: frame, cubes, cylinders, .. } = entity;
        let is_section = frame.contains('/') && !frame.starts_with("point_");
        let (pose, size, color) =
            if let Some(cube) = cubes.into_iter().next().filter(|_| is_section || frame == BODY) {
                (cube.pose, cube.size, cube.color)
            } else {
                let boom = cylinders.into_iter().next().filter(|_| is_section)?;
                (boom.pose, boom.size, boom.color)
            };
        let edges = Vector::new(size.x, size.y, size.z);
        Some(BoxPart { frame, center: Placement::from_pose(&pose), edges, color })
    };
    scene.parts(LogDate::default()).entities.into_iter().filter_map(part).collect()
}

fn settings(name: &str, parts: &[BoxPart]) -> VizSettings {
    let mut models: Vec<VizModel> = Vec::new();
    for part in parts {
        let body = if part.frame == BODY { name } else { &part.frame };
        let Color { r, g, b, a } = part.color;
        let color: Vec<i32> = [r, g, b, a].map(|c| libm::round(255.0 * c) as i32).to_vec();
        let scale = list(&part.edges);
        match models.iter_mut().find(|model| model.scale == scale && model.color == color) {
            Some(model) => model.bodies.push(body.to_owned()),
            None => models.push(VizModel {
                model_path: "CUBE".to_owned(),
                bodies: vec![body.to_owned()],
                offset: vec![0.0; 3],
                rotation: vec![0.0; 3],
                scale,
                color,
            }),
        }
    }
    VizSettings {
        spacecraft_axes: 1,
        custom_models: models,
        spacecraft_labels: -1,
        main_camera_target: name.to_owned(),
        start_at_spacecraft: 1,
    }
}

/// Returns the planet, and the Sun if the scenario has one.
fn bodies(run: &RunLog<'_>, planet: &str, time_ns: u64) -> Vec<VizCelestialBody> {
    let Some(sky) = run.scenario.study.surroundings.as_ref().map(SurroundingsState::sky) else {
        return Vec::new();
    };
    let t = time_ns as f64 / 1e9;
    let body = |name: &str, position: Vector, angle: f64| {
        let (sin, cos) = libm::sincos(angle);
        VizCelestialBody {
            body_name: name.to_owned(),
            position: list(&position),
            velocity: vec![0.0; 3],
            rotation: vec![cos, sin, 0.0, -sin, cos, 0.0, 0.0, 0.0, 1.0],
            ..VizCelestialBody::default()
        }
    };
    let rate = if planet == "earth" { EARTH_RATE } else { 0.0 };
    let orbit = sky.orbit().map(|orbit| [orbit.gravity() / 1e9, orbit.planet_radius() / 1e3]);
    let [mu, radius_km] = orbit.unwrap_or_default();
    let own = body(planet, Vector::zeros(), sky.greenwich() + rate * t);
    let mut all = vec![VizCelestialBody { mu, radius_km, ..own }];
    all.extend(sky.sun().map(|sun| body("sun", sun.direction(t) * UNIT, 0.0)));
    all
}

/// Returns the indices of the rows of a table, without rows of equal times.
fn distinct_rows(table: &Columns) -> Vec<usize> {
    let times = table.numbers("time_s").unwrap_or_default();
    let mut rows: Vec<usize> = (0..times.len()).collect();
    rows.dedup_by_key(|row| nanoseconds(times[*row]));
    rows
}

/// Wheels, thrusters and sensors of a spacecraft.
struct Equipment {
    wheels: Vec<VizWheel>,
    /// Speed (rad/s) and torque (N m) of each wheel at each row.
    wheel_rows: Vec<[Vec<f64>; 2]>,
    thrusters: Vec<VizThruster>,
    /// Part of the time before each row in which each thruster fires.
    open: Vec<Vec<f64>>,
    sensors: Vec<VizSensor>,
}

impl Equipment {
    fn new(run: &RunLog<'_>, times: &[u64]) -> Result<Self, HandoverError> {
        let scenario = run.scenario;
        let [wheels, wheel, jets, thrusters] = run.tables(["/wheels", "/wheel", "/jets", "/thrusters"])?;
        let pulses = jet_pulses(scenario, jets.as_ref(), thrusters.as_ref())?;
        let mut made = Self {
            wheels: Vec::new(),
            wheel_rows: Vec::new(),
            thrusters: Vec::new(),
            open: pulses.iter().map(|pulses| open_parts(pulses, times)).collect(),
            sensors: Vec::new(),
        };
        let at = |point: Option<&str>| {
            let body = scenario.model.three_axis();
            let first = || body.and_then(|body| body.points.first()).map(|point| point.position);
            let named = point.and_then(|point| body?.point(point));
            named.or_else(first).unwrap_or_default()
        };
        if let Some((own, _)) = scenario.actuator.wheels() {
            let limit = |of: Option<Positive>| of.map_or(0.0, Positive::get);
            made.wheels.extend(own.rotors().unwrap_or_default().iter().map(|rotor| VizWheel {
                position: vec![0.0; 3],
                spin_axis: list(&rotor.axis),
                max_speed: limit(own.speed_limit),
                max_torque: limit(own.torque),
                ..VizWheel::default()
            }));
            let width = made.wheels.len();
            let values =
                |field: &str, row: usize| nested_numbers(wheels.as_ref(), "wheels", field, row, width);
            let row = |row: usize| [values("speed_rad_s", row), values("torque_nm", row)];
            made.wheel_rows = wheels.iter().flat_map(distinct_rows).map(row).collect();
        } else if let Some(table) = wheel {
            made.wheels.push(VizWheel {
                position: vec![0.0; 3],
                spin_axis: list(&Vector::z()),
                ..VizWheel::default()
            });
            let speeds = table.numbers("speed_rad_s").unwrap_or_default();
            let row = |row: usize| [speeds.get(row).copied().into_iter().collect(), Vec::new()];
            made.wheel_rows = distinct_rows(&table).into_iter().map(row).collect();
        }
        for thruster in scenario.actuator.jets().iter().flat_map(|(jets, _)| &jets.thrusters) {
            made.thrusters.push(VizThruster {
                position: list(&(at(Some(&thruster.point)) + vector(&thruster.offset))),
                thrust_vector: list(&vector(&thruster.direction).normalize()),
                current_thrust: 0.0,
                max_thrust: thruster.thrust.get(),
                thruster_tag: thruster.name.clone(),
            });
        }
        for (index, sensor) in scenario.sensor.iter().enumerate() {
            // A viewer draws a cone of less than half a turn.
            let view = sensor.field_of_view().filter(|view| view.half_angle < std::f64::consts::FRAC_PI_2);
            made.sensors.extend(view.map(|view| VizSensor {
                position: list(&at(sensor.point())),
                field_of_view: vec![2.0 * view.half_angle.to_degrees()],
                normal_vector: list(&view.boresight),
                label: format!("sensor {}", index + 1),
            }));
        }
        Ok(made)
    }

    /// Adds the equipment to a spacecraft, as it is at a row.
    fn add(&self, spacecraft: &mut VizSpacecraft, row: usize) {
        let wheels = self.wheels.iter().enumerate().map(|(index, wheel)| {
            let value =
                |of: usize| self.wheel_rows.get(row).and_then(|values| values[of].get(index).copied());
            VizWheel {
                wheel_speed: value(0).unwrap_or_default(),
                wheel_torque: value(1).unwrap_or_default(),
                ..wheel.clone()
            }
        });
        let thrusters = self.thrusters.iter().enumerate().map(|(index, thruster)| {
            let part = self.open.get(index).and_then(|parts| parts.get(row)).copied().unwrap_or_default();
            VizThruster { current_thrust: part * thruster.max_thrust, ..thruster.clone() }
        });
        spacecraft.reaction_wheels = wheels.collect();
        spacecraft.thrusters = thrusters.collect();
        spacecraft.generic_sensors.clone_from(&self.sensors);
    }
}
