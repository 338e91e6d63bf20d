//! Scene of a three-axis body: a hub, a boom to each of its points, two wings, and jets at the points.
//!
//! The booms bend by a cubic between the mode shapes at their ends. The wings have no mode shapes, and bend against the
//! rotation of the hub.

use flexsc_core::Scenario;
use flexsc_core::control::actuator::GroupPair;
use flexsc_core::dynamics::ModeState;
use flexsc_core::dynamics::three_axis::ArticulatedPanel;
use flexsc_core::dynamics::three_axis_model::{ModelPoint, ThreeAxisModel};
use flexsc_core::numerics::attitude::{Vector, vector};
use flexsc_core::numerics::quantity::Positive;
use flexsc_core::numerics::time::Span;
use flexsc_core::record::ThreeAxisPose;
use flexsc_core::record::foxglove::{FrameTransform, FrameTransforms, Plumes, SceneUpdate};
use flexsc_core::record::row::LogDate;

use super::Extent;
use super::magnification::{bending, expected_attitude_angle, expected_modal_displacements, turning};
use super::plume::{ActivePlumes, ScenePlume};
use super::pose::{about, attitude, from_z, limited, magnified, place};
use super::primitives::{
    BODY, BOOM, HUB, INERTIAL, NOZZLE, PANEL, axes, cone, cube, entity, frame, scene, words,
};

/// Number of sections of a boom, and of a wing.
const SECTIONS: usize = 6;
/// Size (m) of the scene of a body without distant points.
const SIZE: f64 = 10.0;
/// Distance (m) from the centre of mass below which points are part of the hub.
const NEAR: f64 = 1.0;
/// Bending of the wings, relative to the elastic rotation of the hub and against it.
const SWING: f64 = 2.0;
/// Largest bending that is drawn (rad).
const LARGEST: f64 = 1.2;

/// Point of the structure, with the mode shapes there.
#[derive(Clone, Debug)]
struct ScenePoint {
    name: String,
    at: Vector,
    /// Translation (1/sqrt(kg)) and rotation (rad/(m sqrt(kg))) of each mode.
    shapes: Vec<(Vector, Vector)>,
}

impl ScenePoint {
    /// Returns translation (m) and rotation (rad) of the point for these states of the modes.
    fn moved(&self, modes: &[ModeState]) -> (Vector, Vector) {
        let zero = (Vector::zeros(), Vector::zeros());
        self.shapes.iter().zip(modes).fold(zero, |(u, theta), ((f, phi), mode)| {
            (u + f * mode.displacement, theta + phi * mode.displacement)
        })
    }

    fn is_distant(&self) -> bool {
        self.at.norm() > NEAR
    }
}

/// Scene of a three-axis body.
#[derive(Clone, Debug)]
pub struct ThreeAxisScene {
    /// Period of the frames.
    pub period: Span,
    /// Magnification of the elastic motion.
    pub bending: f64,
    /// Magnification of the rotation.
    pub turning: f64,
    /// Distance of the farthest point (m).
    size: f64,
    points: Vec<ScenePoint>,
    /// Nozzles that fire for plus and for minus about each axis.
    groups: [[Vec<usize>; 2]; 3],
    /// Plumes of the jets.
    pub plumes: ActivePlumes,
    /// Frames at the last pose.
    pub frames: FrameTransforms,
    /// Angle index (a drive, or one of the hinges after the drives) and rotation axis of each wing.
    turned: [Option<(usize, Vector)>; 2],
}

impl ThreeAxisScene {
    /// Creates the scene of a scenario.
    pub fn new(scenario: &Scenario, body: &ThreeAxisModel) -> Self {
        let spec = &scenario.log.scene;
        let jets = scenario.actuator.jets().map(|(jets, _)| jets);
        let thrusters = jets.map_or(&[][..], |jets| &jets.thrusters);
        let point = |point: &ModelPoint| ScenePoint {
            name: point.name.clone(),
            at: point.position,
            shapes: point.shapes.clone(),
        };
        let points: Vec<ScenePoint> = body.points.iter().map(point).collect();
        let farthest = points.iter().map(|point| point.at.norm()).fold(0.0, f64::max);
        let size = if farthest > NEAR { farthest } else { SIZE };
        let nozzles = thrusters.iter().map(|thruster| ScenePlume {
            frame: point_frame(&thruster.point),
            name: thruster.name.clone(),
            at: vector(&thruster.offset),
            direction: -vector(&thruster.direction).normalize(),
        });
        let own = |names: &[String]| -> Vec<usize> {
            names.iter().filter_map(|name| thrusters.iter().position(|t| t.name == *name)).collect()
        };
        let pair = |pair: Option<&GroupPair>| {
            pair.map_or_else(Default::default, |pair| [own(&pair.plus), own(&pair.minus)])
        };
        let reached = expected_modal_displacements(scenario, body);
        let bent = points.iter().map(|point| {
            let rotations = point.shapes.iter().zip(&reached);
            rotations.map(|((_, rotation), q)| rotation.norm() * q).sum::<f64>()
        });
        let bent = bent.fold(0.0, f64::max);
        let mut made = Self {
            period: spec.period(scenario.log_period()),
            bending: spec.bending.map_or_else(|| bending(bent), Positive::get),
            turning: spec
                .turning
                .map_or_else(|| turning(expected_attitude_angle(scenario, body)), Positive::get),
            size,
            groups: jets.map_or_else(Default::default, |jets| {
                let groups = jets.groups.as_ref();
                groups.map_or_else(Default::default, |of| of.each().map(pair))
            }),
            plumes: ActivePlumes::new(nozzles.collect(), 0.3 * size),
            frames: FrameTransforms { transforms: Vec::new() },
            turned: wings(scenario),
            points,
        };
        made.frames.transforms = made.at_rest();
        made
    }

    fn at_rest(&self) -> Vec<FrameTransform> {
        let mut frames = vec![frame(INERTIAL, BODY, Vector::zeros())];
        for point in &self.points {
            frames.push(frame(BODY, &point_frame(&point.name), point.at));
        }
        for point in self.points.iter().filter(|point| point.is_distant()) {
            frames.extend((0..SECTIONS).map(|section| {
                let along = section as f64 / SECTIONS as f64;
                frame(BODY, &boom_frame(point, section), point.at * along)
            }));
        }
        for (wing, side) in [1.0, -1.0].into_iter().enumerate() {
            let mut parent = (BODY.to_owned(), Vector::y() * (side * 0.1 * self.size));
            for section in 0..SECTIONS {
                let child = wing_frame(wing, section);
                frames.push(frame(&parent.0, &child, parent.1));
                parent = (child, Vector::y() * (side * self.panel()));
            }
        }
        frames
    }

    /// Returns the length of a section of a wing (m).
    fn panel(&self) -> f64 {
        1.1 * self.size / SECTIONS as f64
    }

    /// Returns the extent of the scene.
    pub fn extent(&self) -> Extent {
        Extent::new(1.2 * self.size, &self.frames)
    }

    /// Returns the entities of the scene.
    pub fn parts(&self, stamp: LogDate) -> SceneUpdate {
        let size = self.size;
        let mut hub = entity(stamp, BODY, "hub");
        hub.cubes.push(cube(Vector::zeros(), Vector::repeat(0.2 * size), HUB));
        hub.arrows = axes(0.35 * size);
        let mut entities = vec![hub];
        for point in self.points.iter().filter(|point| point.is_distant()) {
            let long = point.at.norm() / SECTIONS as f64;
            entities.extend((0..SECTIONS).map(|section| {
                let name = boom_frame(point, section);
                let mut part = entity(stamp, &name, &name);
                let end = Vector::z() * (0.97 * long);
                part.cylinders.push(cone(Vector::zeros(), end, [0.09 * size; 2], BOOM));
                part
            }));
        }
        for (wing, side) in [1.0, -1.0].into_iter().enumerate() {
            entities.extend((0..SECTIONS).map(|section| {
                let name = wing_frame(wing, section);
                let mut part = entity(stamp, &name, &name);
                let middle = Vector::y() * (0.5 * side * self.panel());
                let edges = Vector::new(0.3 * size, 0.96 * self.panel(), 0.01 * size);
                part.cubes.push(cube(middle, edges, PANEL));
                part
            }));
        }
        for nozzle in self.plumes.nozzles() {
            let mut part = entity(stamp, &nozzle.frame, &format!("nozzle_{}", nozzle.name));
            let back = nozzle.at - nozzle.direction * (0.03 * size);
            part.cylinders.push(cone(back, nozzle.at, [0.01 * size, 0.035 * size], NOZZLE));
            entities.push(part);
        }
        let mut surroundings = entity(stamp, INERTIAL, "surroundings");
        let text = format!("bending × {}, turning × {} (schematic)", self.bending, self.turning);
        surroundings.texts.push(words(Vector::z() * (0.8 * size), text));
        entities.push(surroundings);
        scene(entities)
    }

    /// Updates the frames to a pose of the body.
    pub fn set_pose(&mut self, stamp: LogDate, pose: ThreeAxisPose<'_>) {
        let ThreeAxisPose { attitude: q, modes, angles } = pose;
        let moved: Vec<_> = self.points.iter().map(|point| self.drawn(point, modes)).collect();
        let still = (Vector::zeros(), Vector::zeros());
        let near = self.points.iter().zip(&moved).find(|(point, _)| !point.is_distant());
        let hub = near.map_or(still, |(_, moved)| *moved);
        let mut placed = vec![(Vector::zeros(), magnified(q, self.turning))];
        placed
            .extend(self.points.iter().zip(&moved).map(|(point, (u, theta))| (point.at + u, about(*theta))));
        let distant = self.points.iter().zip(&moved).filter(|(point, _)| point.is_distant());
        for (point, end) in distant {
            placed.extend((0..SECTIONS).map(|section| {
                let along = section as f64 / SECTIONS as f64;
                let (u, theta) = between(point.at, hub, *end, along);
                (point.at * along + u, about(theta) * from_z(point.at.normalize()))
            }));
        }
        // Rotations from each section of a wing to the next, the same on both sides.
        let tip = limited(hub.1 * -SWING, LARGEST);
        let shape = |section: usize| {
            libm::sin(std::f64::consts::FRAC_PI_2 * (section as f64 + 0.5) / SECTIONS as f64)
        };
        let steps =
            (0..SECTIONS).map(|section| shape(section) - if section == 0 { 0.0 } else { shape(section - 1) });
        let steps: Vec<_> = steps.map(|step| about(tip * step)).collect();
        let root = |wing: usize| {
            let turned = self.turned[wing].and_then(|(by, axis)| Some(axis * *angles.get(by)?));
            about(turned.unwrap_or_default()) * steps[0]
        };
        let roots = [root(0), root(1)];
        let turned = roots.iter().flat_map(|root| std::iter::once(root).chain(&steps[1..]));
        let (free, chained) = self.frames.transforms.split_at_mut(placed.len());
        for (frame, (at, turned)) in free.iter_mut().zip(placed) {
            (frame.timestamp, frame.translation, frame.rotation) = (stamp, place(at), attitude(&turned));
        }
        for (frame, turned) in chained.iter_mut().zip(turned) {
            (frame.timestamp, frame.rotation) = (stamp, attitude(turned));
        }
    }

    /// Returns translation (m) and rotation (rad) of a point as drawn.
    fn drawn(&self, point: &ScenePoint, modes: &[ModeState]) -> (Vector, Vector) {
        let (u, theta) = point.moved(modes);
        (limited(u * self.bending, LARGEST * self.size), limited(theta * self.bending, LARGEST))
    }

    /// Returns the plumes if they have changed: where jets of each axis push with these signs, or where thrusters are
    /// open by `open`.
    pub fn plumes(&mut self, stamp: LogDate, signs: [f64; 3], open: Vec<f64>) -> Option<Plumes> {
        if !open.is_empty() {
            return self.plumes.change(stamp, open);
        }
        let mut parts = vec![0.0; self.plumes.nozzles().len()];
        for (pair, sign) in self.groups.iter().zip(signs).filter(|(_, sign)| *sign != 0.0) {
            pair[usize::from(sign < 0.0)].iter().for_each(|nozzle| parts[*nozzle] = 1.0);
        }
        self.plumes.change(stamp, parts)
    }
}

/// Finds the drive or hinge of each wing: the first on its side, or the only one for both. Drives rotate wings about y.
fn wings(scenario: &Scenario) -> [Option<(usize, Vector)>; 2] {
    let Some(drives) = &scenario.study.drives else { return [None; 2] };
    let mut hinges = drives.driven.drives();
    let mut axis = |panel: &ArticulatedPanel| {
        let (by, axis) = if let Some(hinge) = &panel.hinge {
            hinges += 1;
            (hinges - 1, panel.axes * hinge.about)
        } else {
            let (about, drive) = panel.drive?;
            (drive, Vector::y() * if (panel.axes * about).y < 0.0 { -1.0 } else { 1.0 })
        };
        Some((by, axis, panel.root.y))
    };
    let turned: Vec<_> = drives.driven.panels.iter().filter_map(&mut axis).collect();
    // The first wing points to +y.
    let of = |side: f64| {
        let own = turned.iter().find(|(.., root)| root * side > 0.0).or(turned.first());
        own.map(|(by, axis, _)| (*by, *axis))
    };
    [of(1.0), of(-1.0)]
}

/// Returns translation and rotation of a straight boom to a point at the fraction `s` of its length, between those of
/// its ends: a cubic whose slopes are the rotations.
fn between(to: Vector, from: (Vector, Vector), end: (Vector, Vector), s: f64) -> (Vector, Vector) {
    let (slope0, slope1) = (from.1.cross(&to), end.1.cross(&to));
    let (s2, s3) = (s * s, s * s * s);
    let u = from.0 * (2.0 * s3 - 3.0 * s2 + 1.0)
        + slope0 * (s3 - 2.0 * s2 + s)
        + end.0 * (3.0 * s2 - 2.0 * s3)
        + slope1 * (s3 - s2);
    let slope = (end.0 - from.0) * (6.0 * s - 6.0 * s2)
        + slope0 * (3.0 * s2 - 4.0 * s + 1.0)
        + slope1 * (3.0 * s2 - 2.0 * s);
    let direction = to.normalize();
    let twist = from.1.dot(&direction) * (1.0 - s) + end.1.dot(&direction) * s;
    (u, direction.cross(&slope) / to.norm() + direction * twist)
}

/// Returns the frame name of a point, which differs from all frames of the scene's other entities.
fn point_frame(point: &str) -> String {
    format!("point_{point}")
}

fn boom_frame(point: &ScenePoint, section: usize) -> String {
    format!("boom_{}/{}", point.name, section + 1)
}

fn wing_frame(wing: usize, section: usize) -> String {
    format!("wing_{}/{}", wing + 1, section + 1)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_boom_is_bent_as_its_ends_say() {
        let to = Vector::new(-30.0, 0.0, 0.0);
        let from = (Vector::new(0.0, 0.1, -0.2), Vector::new(0.02, 0.01, 0.03));
        let end = (Vector::new(0.0, -0.5, 0.4), Vector::new(-0.01, 0.04, -0.02));
        for (s, exact) in [(0.0, from), (1.0, end)] {
            let (u, theta) = between(to, from, end, s);
            assert!((u - exact.0).norm() < 1e-15 && (theta - exact.1).norm() < 1e-15, "{s}: {u} {theta}");
        }
        // The rotation across the boom is the slope of its displacement.
        let (s, h) = (0.3, 1e-6);
        let at = |s: f64| between(to, from, end, s);
        let slope = (at(s + h).0 - at(s - h).0) / (2.0 * h * 30.0);
        let across = at(s).1.cross(&to.normalize());
        assert!((across - slope).norm() < 1e-9, "{across} {slope}");
    }
}
