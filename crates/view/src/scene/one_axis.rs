//! Scene of a one-axis body: a hub that rotates about z, with panels of sections that bend in the plane.

use flexsc_core::Scenario;
use flexsc_core::dynamics::axis_model::AxisModel;
use flexsc_core::numerics::attitude::Vector;
use flexsc_core::numerics::quantity::Positive;
use flexsc_core::numerics::time::Span;
use flexsc_core::record::OneAxisPose;
use flexsc_core::record::foxglove::{FrameTransform, FrameTransforms, Plumes, SceneEntity, SceneUpdate};
use flexsc_core::record::row::LogDate;

use super::Extent;
use super::magnification::{bending, expected_angle, largest_torque, turning};
use super::panels::ScenePanels;
use super::plume::{ActivePlumes, ScenePlume};
use super::pose::{about_z, attitude};
use super::primitives::{
    BODY, GOAL, HUB, INERTIAL, NOZZLE, PANEL, axes, cone, cube, entity, frame, line, scene, words,
};
use super::wheel::{SceneWheel, disc};

/// Number of steps in which a torque is drawn, and the fraction of the largest torque below which it is drawn as zero.
const STEPS: f64 = 4.0;
const LEAST: f64 = 0.01;

/// Scene of a one-axis body.
#[derive(Clone, Debug)]
pub struct OneAxisScene {
    /// Period of the frames.
    pub period: Span,
    /// Magnification of the elastic motion.
    pub bending: f64,
    /// Magnification of the rotation.
    pub turning: f64,
    goal: Option<f64>,
    panels: ScenePanels,
    wheel: Option<SceneWheel>,
    /// Plumes of the thrusters; `None` with a wheel.
    pub plumes: Option<ActivePlumes>,
    /// Largest torque since the start (N m).
    largest: f64,
    /// Frames at the last pose.
    pub frames: FrameTransforms,
}

impl OneAxisScene {
    /// Creates the scene of a scenario.
    pub fn new(scenario: &Scenario, body: &AxisModel) -> Self {
        let spec = &scenario.log.scene;
        let panels = ScenePanels::from_scenario(scenario, body);
        let period = spec.period(scenario.log_period());
        let mut scene = Self {
            period,
            bending: spec.bending.map_or_else(|| bending(panels.bent), Positive::get),
            turning: spec.turning.map_or_else(|| turning(expected_angle(scenario, body)), Positive::get),
            goal: scenario.plan.as_ref().map(|_| scenario.goal().angle),
            panels,
            wheel: SceneWheel::from_scenario(scenario, body, period),
            plumes: None,
            largest: largest_torque(scenario, body),
            frames: FrameTransforms { transforms: Vec::new() },
        };
        if scene.wheel.is_none() {
            scene.plumes = Some(scene.thrusters());
        }
        scene.frames.transforms = scene.at_rest();
        scene
    }

    /// Returns the half edge of the hub (m).
    fn half(&self) -> f64 {
        (0.8 * self.panels.root).max(0.06 * self.panels.length())
    }

    /// Returns two pairs of thrusters, each a couple about z: those that push to positive rates first.
    fn thrusters(&self) -> ActivePlumes {
        let half = self.half();
        let side = |name: &str, y: f64, x: f64| ScenePlume {
            frame: BODY.to_owned(),
            name: name.to_owned(),
            at: Vector::new(0.6 * half * x, 1.15 * half * y, 0.0),
            direction: Vector::new(x, 0.0, 0.0),
        };
        let plus = [side("plus 1", 1.0, 1.0), side("plus 2", -1.0, -1.0)];
        let minus = [side("minus 1", 1.0, -1.0), side("minus 2", -1.0, 1.0)];
        ActivePlumes::new(plus.into_iter().chain(minus).collect(), 0.45 * self.panels.length())
    }

    /// Returns the frames of a body that is neither rotated nor bent.
    fn at_rest(&self) -> Vec<FrameTransform> {
        let mut frames = vec![frame(INERTIAL, BODY, Vector::zeros())];
        if self.wheel.is_some() {
            frames.push(frame(BODY, "wheel", Vector::z() * (1.3 * self.half())));
        }
        for panel in 0..self.panels.count {
            let (sin, cos) = libm::sincos(self.panels.azimuth(panel));
            let mut parent = (BODY.to_owned(), Vector::new(cos, sin, 0.0) * self.panels.root);
            for (section, length) in self.panels.lengths.iter().enumerate() {
                let child = section_frame(panel, section);
                frames.push(frame(&parent.0, &child, parent.1));
                parent = (child, Vector::x() * *length);
            }
        }
        frames
    }

    /// Returns the extent of the scene.
    pub fn extent(&self) -> Extent {
        Extent::new(self.panels.root + self.panels.length(), &self.frames)
    }

    /// Returns the entities of the scene.
    pub fn parts(&self, stamp: LogDate) -> SceneUpdate {
        let (half, length) = (self.half(), self.panels.length());
        let mut hub = entity(stamp, BODY, "hub");
        hub.cubes.push(cube(Vector::zeros(), Vector::repeat(2.0 * half), HUB));
        hub.arrows = axes(2.2 * half);
        for nozzle in self.plumes.iter().flat_map(ActivePlumes::nozzles) {
            let back = nozzle.at - nozzle.direction * (0.5 * half);
            hub.cylinders.push(cone(back, nozzle.at, [0.12 * half, 0.4 * half], NOZZLE));
        }
        let mut entities = vec![hub, self.surroundings(stamp)];
        if self.wheel.is_some() {
            entities.push(disc(stamp, half));
        }
        for panel in 0..self.panels.count {
            for (section, long) in self.panels.lengths.iter().enumerate() {
                let mut plate = entity(stamp, &section_frame(panel, section), &section_frame(panel, section));
                let size = Vector::new(0.97 * long, 0.012 * length, 0.22 * length);
                plate.cubes.push(cube(Vector::x() * (0.5 * long), size, PANEL));
                entities.push(plate);
            }
        }
        scene(entities)
    }

    /// Returns the lines at angle 0 and at the goal, and a text with the magnification.
    fn surroundings(&self, stamp: LogDate) -> SceneEntity {
        let reach = 1.15 * (self.panels.root + self.panels.length());
        let mut entity = entity(stamp, INERTIAL, "surroundings");
        entity.lines.push(line(Vector::x() * -reach, Vector::x() * reach, HUB));
        if let Some(goal) = self.goal {
            let (sin, cos) = libm::sincos(self.turning * goal);
            entity.lines.push(line(Vector::zeros(), Vector::new(cos, sin, 0.0) * reach, GOAL));
        }
        let wheel = self.wheel.as_ref().map(|wheel| wheel.slowed).filter(|slowed| *slowed > 1.0);
        let wheel = wheel.map_or_else(String::new, |slowed| format!(", wheel ÷ {slowed}"));
        let text = format!("bending × {}, turning × {}{wheel} (schematic)", self.bending, self.turning);
        entity.texts.push(words(Vector::z() * (0.65 * reach), text));
        entity
    }

    /// Updates the frames to a pose of the body.
    pub fn set_pose(&mut self, stamp: LogDate, pose: OneAxisPose<'_>) {
        let bent = self.panels.angles(self.bending, pose);
        let azimuths: Vec<f64> = (0..self.panels.count).map(|panel| self.panels.azimuth(panel)).collect();
        let turned = self.wheel.as_ref().map(|wheel| wheel.angle(pose));
        let mut frames = self.frames.transforms.iter_mut();
        let mut turn = |by: f64| {
            if let Some(frame) = frames.next() {
                (frame.timestamp, frame.rotation) = (stamp, attitude(&about_z(by)));
            }
        };
        turn(self.turning * pose.angle);
        turned.into_iter().for_each(&mut turn);
        for azimuth in azimuths {
            let mut before = -azimuth;
            for angle in &bent {
                turn(angle - before);
                before = *angle;
            }
        }
    }

    /// Returns the plumes under a torque (N m) if they have changed.
    pub fn plumes(&mut self, stamp: LogDate, torque: f64) -> Option<Plumes> {
        let plumes = self.plumes.as_mut()?;
        self.largest = self.largest.max(torque.abs());
        let part = if self.largest > 0.0 { torque.abs() / self.largest } else { 0.0 };
        let part = if part < LEAST { 0.0 } else { libm::ceil(STEPS * part) / STEPS };
        let (plus, minus) = if torque > 0.0 { (part, 0.0) } else { (0.0, part) };
        plumes.change(stamp, vec![plus, plus, minus, minus])
    }
}

fn section_frame(panel: u32, section: usize) -> String {
    format!("panel_{}/{}", panel + 1, section + 1)
}
