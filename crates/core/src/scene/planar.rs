//! The scene of a body with one angle: a hub that turns about z, with panels of sections that bend in the plane.

use super::Extent;
use super::magnification::{angle, bending, displacements, largest, turning};
use super::part::{
    BODY, GOAL, HUB, INERTIAL, MARK, NOZZLE, PANEL, WHEEL, axes, cone, cube, entity, frame, line, scene,
    words,
};
use super::plume::{Burning, Nozzle};
use super::pose::{about_z, attitude};
use crate::actuator::Actuator;
use crate::body::spatial::Vector;
use crate::body::{Body, Phase};
use crate::record::foxglove::{FrameTransforms, Plumes, SceneEntity, SceneUpdate};
use crate::record::row::Stamp;
use crate::scenario::Scenario;
use crate::time::Span;

/// Panels of a body that has none of its own: so many sections, of this length altogether, from this distance on (m).
const SECTIONS: usize = 8;
const LENGTH: f64 = 10.0;
const ROOT: f64 = 1.2;
/// A wheel without a rotor of its own is drawn with this part of the body's inertia.
const ROTOR: f64 = 0.02;
/// No section is drawn at a larger angle to the hub (rad).
const LARGEST: f64 = 1.5;
/// A torque is drawn in so many steps, and as nothing below this part of the largest.
const STEPS: f64 = 4.0;
const LEAST: f64 = 0.01;
/// No more panels are drawn.
const MOST_PANELS: u32 = 12;

/// Where the body is.
#[derive(Copy, Clone, Debug)]
pub struct PlanarView<'a> {
    /// Time since the start (s).
    pub time: f64,
    /// Angle of the hub, elastic part included (rad).
    pub angle: f64,
    /// Angle of the body as if it were rigid (rad).
    pub rigid_angle: f64,
    /// The modes.
    pub modes: &'a [Phase],
    /// The angles of the sections relative to the hub (rad), of a body that has sections.
    pub sections: &'a [f64],
}

/// How the sections bend.
#[derive(Clone, Debug)]
enum Bends {
    /// By their own angles.
    Own,
    /// By these angles for a unit of each mode: the modes' slopes along the panel.
    Modes(Vec<Vec<f64>>),
}

/// A wheel: its speed at the start (rad/s), and how many times as much as the body it turns the other way.
#[derive(Clone, Debug)]
struct Wheel {
    speed: f64,
    ratio: f64,
    /// Angle and rate of the body at the start (rad, rad/s).
    from: (f64, f64),
}

/// The scene.
#[derive(Clone, Debug)]
pub struct PlanarScene {
    /// Period of the frames.
    pub period: Span,
    bending: f64,
    turning: f64,
    goal: Option<f64>,
    root: f64,
    lengths: Vec<f64>,
    bends: Bends,
    count: u32,
    wheel: Option<Wheel>,
    plumes: Option<Burning>,
    /// The largest torque so far (N m).
    largest: f64,
    frames: FrameTransforms,
}

impl PlanarScene {
    /// The scene of a scenario.
    pub fn new(scenario: &Scenario) -> Self {
        let (spec, model) = (&scenario.log.scene, &scenario.model);
        let reached = displacements(scenario);
        let (root, lengths, bends, count, bent) = match &scenario.body {
            Body::Panels(panels) => {
                let lengths: Vec<f64> = panels.sections.iter().map(|section| section.length.get()).collect();
                let of = |weights: &[crate::quantity::Finite]| {
                    weights.iter().zip(&reached).map(|(weight, x)| (weight.get() * x).abs()).sum::<f64>()
                };
                let bent = model.outputs.iter().map(|output| of(&output.modes)).fold(0.0, f64::max);
                (panels.root.get(), lengths, Bends::Own, panels.count.min(MOST_PANELS), bent)
            }
            _ => {
                let slopes = (0..model.modes.len()).map(|mode| slopes(mode, SECTIONS)).collect();
                let lengths = vec![LENGTH / SECTIONS as f64; SECTIONS];
                (ROOT, lengths, Bends::Modes(slopes), 2, reached.iter().sum())
            }
        };
        let goal = scenario.plan.as_ref().map(|_| scenario.goal().angle);
        let mut scene = Self {
            period: spec.period(scenario.log.period),
            bending: spec.bending.map_or_else(|| bending(bent), |factor| factor.get()),
            turning: spec.turning.map_or_else(|| turning(angle(scenario)), |factor| factor.get()),
            goal,
            root,
            lengths,
            bends,
            count,
            wheel: wheel(scenario),
            plumes: None,
            largest: largest(scenario),
            frames: FrameTransforms { transforms: Vec::new() },
        };
        if scene.wheel.is_none() {
            scene.plumes = Some(scene.thrusters());
        }
        scene.frames.transforms = scene.at_rest();
        scene
    }

    /// The half edge of the hub (m).
    fn half(&self) -> f64 {
        (0.8 * self.root).max(0.06 * self.length())
    }

    fn length(&self) -> f64 {
        self.lengths.iter().sum()
    }

    /// Two pairs of thrusters, each a couple about z: those that push to positive rates first.
    fn thrusters(&self) -> Burning {
        let half = self.half();
        let side = |name: &str, y: f64, x: f64| Nozzle {
            frame: BODY.to_owned(),
            name: name.to_owned(),
            at: Vector::new(0.6 * half * x, 1.15 * half * y, 0.0),
            direction: Vector::new(x, 0.0, 0.0),
        };
        let plus = [side("plus 1", 1.0, 1.0), side("plus 2", -1.0, -1.0)];
        let minus = [side("minus 1", 1.0, -1.0), side("minus 2", -1.0, 1.0)];
        Burning::new(plus.into_iter().chain(minus).collect(), 0.45 * self.length())
    }

    /// The frames of a body that is not turned and not bent.
    fn at_rest(&self) -> Vec<crate::record::foxglove::FrameTransform> {
        let mut frames = vec![frame(INERTIAL, BODY, Vector::zeros())];
        if self.wheel.is_some() {
            frames.push(frame(BODY, "wheel", Vector::z() * (1.3 * self.half())));
        }
        for panel in 0..self.count {
            let (sin, cos) = libm::sincos(self.azimuth(panel));
            let mut parent = (BODY.to_owned(), Vector::new(cos, sin, 0.0) * self.root);
            for (section, length) in self.lengths.iter().enumerate() {
                let child = section_frame(panel, section);
                frames.push(frame(&parent.0, &child, parent.1));
                parent = (child, Vector::x() * *length);
            }
        }
        frames
    }

    fn azimuth(&self, panel: u32) -> f64 {
        f64::from(panel) * (std::f64::consts::TAU / f64::from(self.count))
    }

    /// How far it reaches, and its frames.
    pub fn extent(&self) -> Extent {
        Extent::new(self.root + self.length(), &self.frames)
    }

    /// What the scene consists of.
    pub fn parts(&self, stamp: Stamp) -> SceneUpdate {
        let (half, length) = (self.half(), self.length());
        let mut hub = entity(stamp, BODY, "hub");
        hub.cubes.push(cube(Vector::zeros(), Vector::repeat(2.0 * half), HUB));
        hub.arrows = axes(2.2 * half);
        for nozzle in self.plumes.iter().flat_map(Burning::nozzles) {
            let back = nozzle.at - nozzle.direction * (0.5 * half);
            hub.cylinders.push(cone(back, nozzle.at, [0.12 * half, 0.4 * half], NOZZLE));
        }
        let mut entities = vec![hub, self.surroundings(stamp)];
        if self.wheel.is_some() {
            entities.push(disc(stamp, half));
        }
        for panel in 0..self.count {
            for (section, long) in self.lengths.iter().enumerate() {
                let mut plate = entity(stamp, &section_frame(panel, section), &section_frame(panel, section));
                let size = Vector::new(0.97 * long, 0.012 * length, 0.22 * length);
                plate.cubes.push(cube(Vector::x() * (0.5 * long), size, PANEL));
                entities.push(plate);
            }
        }
        scene(entities)
    }

    /// Lines at angle 0 and at the goal, and words on the magnification.
    fn surroundings(&self, stamp: Stamp) -> SceneEntity {
        let reach = 1.15 * (self.root + self.length());
        let mut entity = entity(stamp, INERTIAL, "surroundings");
        entity.lines.push(line(Vector::x() * -reach, Vector::x() * reach, HUB));
        if let Some(goal) = self.goal {
            let (sin, cos) = libm::sincos(self.turning * goal);
            entity.lines.push(line(Vector::zeros(), Vector::new(cos, sin, 0.0) * reach, GOAL));
        }
        let text = format!("bending × {}, turning × {} (schematic)", self.bending, self.turning);
        entity.texts.push(words(Vector::z() * (0.45 * reach), text));
        entity
    }

    /// Where the frames are.
    pub fn frames(&mut self, stamp: Stamp, view: PlanarView<'_>) -> &FrameTransforms {
        let bent = self.bent(view);
        let azimuths: Vec<f64> = (0..self.count).map(|panel| self.azimuth(panel)).collect();
        let turned = self.wheel.as_ref().map(|wheel| {
            let (angle, rate) = wheel.from;
            wheel.speed * view.time - wheel.ratio * (view.rigid_angle - angle - rate * view.time)
        });
        let mut frames = self.frames.transforms.iter_mut();
        let mut turn = |by: f64| {
            if let Some(frame) = frames.next() {
                (frame.timestamp, frame.rotation) = (stamp, attitude(&about_z(by)));
            }
        };
        turn(self.turning * view.angle);
        turned.into_iter().for_each(&mut turn);
        for azimuth in azimuths {
            let mut before = -azimuth;
            for angle in &bent {
                turn(angle - before);
                before = *angle;
            }
        }
        &self.frames
    }

    /// The angle of each section to the hub, as drawn (rad).
    fn bent(&self, view: PlanarView<'_>) -> Vec<f64> {
        let drawn = |angle: f64| (self.bending * angle).clamp(-LARGEST, LARGEST);
        match &self.bends {
            Bends::Own => view.sections.iter().copied().map(drawn).collect(),
            // Where the hub swings one way, the panels swing the other.
            Bends::Modes(slopes) => (0..self.lengths.len())
                .map(|section| {
                    let modes = slopes.iter().zip(view.modes);
                    drawn(-modes.map(|(slopes, mode)| slopes[section] * mode.displacement).sum::<f64>())
                })
                .collect(),
        }
    }

    /// The plumes under a torque (N m), if they are new.
    pub fn plumes(&mut self, stamp: Stamp, torque: f64) -> Option<Plumes> {
        let plumes = self.plumes.as_mut()?;
        self.largest = self.largest.max(torque.abs());
        let part = if self.largest > 0.0 { torque.abs() / self.largest } else { 0.0 };
        let part = if part < LEAST { 0.0 } else { libm::ceil(STEPS * part) / STEPS };
        let (plus, minus) = if torque > 0.0 { (part, 0.0) } else { (0.0, part) };
        plumes.change(stamp, vec![plus, plus, minus, minus])
    }
}

/// The slopes of a mode along a panel that is clamped at the hub, at the middles of equal sections, 1 at the tip.
fn slopes(mode: usize, sections: usize) -> Vec<f64> {
    // What is finer than the sections would look like something else.
    let waves = 2.0 * mode.min(sections / 2 - 1) as f64 + 1.0;
    let slope = |section: usize| {
        let along = (section as f64 + 0.5) / sections as f64;
        libm::sin(waves * std::f64::consts::FRAC_PI_2 * along)
    };
    (0..sections).map(slope).collect()
}

fn section_frame(panel: u32, section: usize) -> String {
    format!("panel_{}/{}", panel + 1, section + 1)
}

fn wheel(scenario: &Scenario) -> Option<Wheel> {
    let Actuator::Wheel(wheel) = &scenario.actuator else { return None };
    let model = &scenario.model;
    let (speed, inertia) = match &wheel.rotor {
        Some(rotor) => (rotor.speed.get(), rotor.inertia.get()),
        None => (0.0, ROTOR * model.inertia.get()),
    };
    let from = (model.angle.get(), model.rate.get());
    Some(Wheel { speed, ratio: model.commanded_inertia() / inertia, from })
}

/// A disc on the hub, with a mark that shows how it turns.
fn disc(stamp: Stamp, half: f64) -> SceneEntity {
    let mut disc = entity(stamp, "wheel", "wheel");
    let (low, high) = (Vector::z() * (-0.15 * half), Vector::z() * (0.15 * half));
    disc.cylinders.push(cone(low, high, [1.7 * half; 2], WHEEL));
    disc.cubes.push(cube(
        Vector::new(0.42 * half, 0.0, 0.16 * half),
        Vector::new(0.8 * half, 0.12 * half, 0.06 * half),
        MARK,
    ));
    disc
}
