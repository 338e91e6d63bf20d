//! Primitives of a scene: frames, and the boxes, cones and texts that are fixed to them.

use flexsc_core::numerics::attitude::Vector;
use flexsc_core::record::foxglove::{
    ArrowPrimitive, Color, CubePrimitive, CylinderPrimitive, FrameTransform, LinePrimitive, LineType,
    SceneEntity, SceneUpdate, TextPrimitive,
};
use flexsc_core::record::row::{LogDate, LogSpan};

use super::pose::{from_z, place, point, pose, unrotated};

/// Name of the inertial frame.
pub const INERTIAL: &str = "inertial";
/// Name of the body frame.
pub const BODY: &str = "body";

/// Colour of hubs. All colours are two greys, and colours that colour-blind readers can distinguish.
pub const HUB: Color = Color { r: 0.75, g: 0.75, b: 0.78, a: 1.0 };
/// Colour of panels.
pub const PANEL: Color = Color { r: 0.0, g: 0.45, b: 0.70, a: 1.0 };
/// Colour of booms.
pub const BOOM: Color = Color { r: 0.90, g: 0.88, b: 0.80, a: 1.0 };
/// Colour of wheels.
pub const WHEEL: Color = Color { r: 0.80, g: 0.47, b: 0.65, a: 1.0 };
/// Colour of marks.
pub const MARK: Color = Color { r: 0.15, g: 0.15, b: 0.15, a: 1.0 };
/// Colour of nozzles and masses.
pub const NOZZLE: Color = Color { r: 0.40, g: 0.40, b: 0.42, a: 1.0 };
/// Colour of plumes.
pub const PLUME: Color = Color { r: 0.90, g: 0.60, b: 0.0, a: 0.75 };
/// Colour of goals.
pub const GOAL: Color = Color { r: 0.0, g: 0.62, b: 0.45, a: 0.8 };
/// Colour of texts.
const WORDS: Color = Color { r: 0.90, g: 0.60, b: 0.0, a: 1.0 };

/// Creates a frame within another one, at a place.
pub fn frame(parent: &str, child: &str, at: Vector) -> FrameTransform {
    let pose = unrotated(at);
    FrameTransform {
        timestamp: LogDate::default(),
        parent_frame_id: parent.to_owned(),
        child_frame_id: child.to_owned(),
        translation: pose.position,
        rotation: pose.orientation,
    }
}

/// Creates an empty entity, fixed to a frame.
pub fn entity(stamp: LogDate, frame: &str, id: &str) -> SceneEntity {
    SceneEntity {
        timestamp: stamp,
        frame_id: frame.to_owned(),
        id: id.to_owned(),
        lifetime: LogSpan::default(),
        frame_locked: true,
        metadata: Vec::new(),
        arrows: Vec::new(),
        cubes: Vec::new(),
        spheres: Vec::new(),
        cylinders: Vec::new(),
        lines: Vec::new(),
        triangles: Vec::new(),
        texts: Vec::new(),
    }
}

/// Creates a scene update with these entities.
pub fn scene(entities: Vec<SceneEntity>) -> SceneUpdate {
    SceneUpdate { deletions: Vec::new(), entities }
}

/// Creates a box centred at a place.
pub fn cube(at: Vector, size: Vector, color: Color) -> CubePrimitive {
    CubePrimitive { pose: unrotated(at), size: place(size), color }
}

/// Creates a cylinder or a cone between two places, with its diameters at the first and at the second.
pub fn cone(from: Vector, to: Vector, [first, second]: [f64; 2], color: Color) -> CylinderPrimitive {
    let axis = to - from;
    let length = f64::sqrt(axis.norm_squared());
    let widest = first.max(second);
    CylinderPrimitive {
        pose: pose(0.5 * (from + to), &from_z(axis / length)),
        size: place(Vector::new(widest, widest, length)),
        bottom_scale: first / widest,
        top_scale: second / widest,
        color,
    }
}

/// Creates the axes of a frame: x red, y green, z blue.
pub fn axes(length: f64) -> Vec<ArrowPrimitive> {
    let arrow = |axis: usize| {
        // An arrow points along x.
        let turned = match axis {
            1 => super::pose::about_z(std::f64::consts::FRAC_PI_2),
            2 => super::pose::about(Vector::y() * -std::f64::consts::FRAC_PI_2),
            _ => super::pose::about_z(0.0),
        };
        let part = |own: usize| if axis == own { 0.9 } else { 0.1 };
        ArrowPrimitive {
            pose: pose(Vector::zeros(), &turned),
            shaft_length: 0.85 * length,
            shaft_diameter: 0.03 * length,
            head_length: 0.15 * length,
            head_diameter: 0.08 * length,
            color: Color { r: part(0), g: part(1), b: part(2), a: 1.0 },
        }
    };
    [0, 1, 2].map(arrow).into()
}

/// Creates a straight line.
pub fn line(from: Vector, to: Vector, color: Color) -> LinePrimitive {
    LinePrimitive {
        r#type: LineType::Strip,
        pose: unrotated(Vector::zeros()),
        thickness: 2.0,
        scale_invariant: true,
        points: vec![point(from), point(to)],
        color,
    }
}

/// Creates a text that faces the viewer.
pub fn words(at: Vector, text: String) -> TextPrimitive {
    TextPrimitive {
        pose: unrotated(at),
        billboard: true,
        font_size: 18.0,
        scale_invariant: true,
        color: WORDS,
        text,
    }
}
