//! The messages that viewers know: log lines, frames and scenes of the package `foxglove`.
//!
//! Names and numbers of the fields are those of the published schemas. Fields that come last in a message and are never
//! used here are left out.

use super::row::{Lifetime, Row, Sink, Stamp, Topic, TopicRow, label_cells, rows};
use crate::label::Labels;

/// How much a line of the log matters.
#[derive(Copy, Clone, Debug, PartialEq, Eq)]
pub enum Level {
    /// Not told.
    Unknown,
    /// For those who look for an error.
    Debug,
    /// What happens.
    Info,
    /// What should not be.
    Warning,
    /// What fails.
    Error,
    /// What ends the run.
    Fatal,
}

impl Level {
    /// The enumeration as a log column.
    pub const LABELS: Labels = Labels {
        name: "Log.Level",
        docs: &[
            " Not told.",
            " For debugging.",
            " What happens.",
            " What should not be.",
            " A failure.",
            " The end.",
        ],
        values: &["unknown", "debug", "info", "warning", "error", "fatal"],
    };
}

/// What is deleted.
#[derive(Copy, Clone, Debug, PartialEq, Eq)]
pub enum Deleted {
    /// The entity of this id.
    MatchingId,
    /// All entities of the topic.
    All,
}

impl Deleted {
    const LABELS: Labels = Labels {
        name: "SceneEntityDeletion.Type",
        docs: &[" The entity of this id.", " All entities of the topic."],
        values: &["matching id", "all"],
    };
}

/// How points make lines.
#[derive(Copy, Clone, Debug, PartialEq, Eq)]
pub enum LineType {
    /// Each with the next.
    Strip,
    /// Also the last with the first.
    Loop,
    /// Two by two.
    List,
}

impl LineType {
    const LABELS: Labels = Labels {
        name: "LinePrimitive.Type",
        docs: &[" Each with the next.", " Also the last with the first.", " Two by two."],
        values: &["line strip", "line loop", "line list"],
    };
}

label_cells!(Level, Deleted, LineType);

rows! {
    package "foxglove";

    /// A line of the log.
    Log = "/log" {
        /// When.
        timestamp: Stamp,
        /// How much it matters.
        level: Level,
        /// What happened.
        message: String,
        /// Who tells.
        name: String,
    }
    /// A vector.
    Vector3 {
        /// Along x.
        x: f64,
        /// Along y.
        y: f64,
        /// Along z.
        z: f64,
    }
    /// A point.
    Point3 {
        /// Along x (m).
        x: f64,
        /// Along y (m).
        y: f64,
        /// Along z (m).
        z: f64,
    }
    /// A rotation.
    Quaternion {
        /// Part along x.
        x: f64,
        /// Part along y.
        y: f64,
        /// Part along z.
        z: f64,
        /// Real part.
        w: f64,
    }
    /// A place and an attitude.
    Pose {
        /// Place (m).
        position: Vector3,
        /// Attitude.
        orientation: Quaternion,
    }
    /// A colour, each part from 0 to 1.
    Color {
        /// Red.
        r: f64,
        /// Green.
        g: f64,
        /// Blue.
        b: f64,
        /// Opacity.
        a: f64,
    }
    /// Where a frame is in another.
    FrameTransform {
        /// When.
        timestamp: Stamp,
        /// Name of the other frame.
        parent_frame_id: String,
        /// Name of the frame.
        child_frame_id: String,
        /// Its origin in the other (m).
        translation: Vector3,
        /// Its attitude in the other.
        rotation: Quaternion,
    }
    /// Where frames are.
    FrameTransforms = "/tf" {
        /// Each frame.
        transforms: Vec<FrameTransform>,
    }
    /// Entities that a scene no longer has.
    SceneEntityDeletion {
        /// When.
        timestamp: Stamp,
        /// Which.
        r#type: Deleted,
        /// The id.
        id: String,
    }
    /// A remark.
    KeyValuePair {
        /// Key.
        key: String,
        /// Value.
        value: String,
    }
    /// An arrow.
    ArrowPrimitive {
        /// Where it begins; it points along x.
        pose: Pose,
        /// Length of its shaft (m).
        shaft_length: f64,
        /// Diameter of its shaft (m).
        shaft_diameter: f64,
        /// Length of its head (m).
        head_length: f64,
        /// Diameter of its head (m).
        head_diameter: f64,
        /// Colour.
        color: Color,
    }
    /// A box.
    CubePrimitive {
        /// Its middle.
        pose: Pose,
        /// Its edges (m).
        size: Vector3,
        /// Colour.
        color: Color,
    }
    /// A ball.
    SpherePrimitive {
        /// Its middle.
        pose: Pose,
        /// Its diameters (m).
        size: Vector3,
        /// Colour.
        color: Color,
    }
    /// A cylinder or a cone about z.
    CylinderPrimitive {
        /// Its middle.
        pose: Pose,
        /// Its diameters and its height (m).
        size: Vector3,
        /// Part of the diameters at the lower end.
        bottom_scale: f64,
        /// Part of the diameters at the upper end.
        top_scale: f64,
        /// Colour.
        color: Color,
    }
    /// Lines.
    LinePrimitive {
        /// How points make lines.
        r#type: LineType,
        /// Where they are.
        pose: Pose,
        /// Thickness (m, or pixels).
        thickness: f64,
        /// Whether the thickness is in pixels.
        scale_invariant: bool,
        /// The points.
        points: Vec<Point3>,
        /// Colour.
        color: Color,
    }
    /// Triangles.
    TriangleListPrimitive {
        /// Where they are.
        pose: Pose,
        /// Their corners, three by three.
        points: Vec<Point3>,
        /// Colour.
        color: Color,
    }
    /// A text.
    TextPrimitive {
        /// Where it is.
        pose: Pose,
        /// Whether it faces who looks.
        billboard: bool,
        /// Height of the font (m, or pixels).
        font_size: f64,
        /// Whether that height is in pixels.
        scale_invariant: bool,
        /// Colour.
        color: Color,
        /// The text.
        text: String,
    }
    /// A thing in a scene.
    SceneEntity {
        /// When.
        timestamp: Stamp,
        /// The frame in which it is.
        frame_id: String,
        /// Its id: a later entity of the same id takes its place.
        id: String,
        /// How long it stays.
        lifetime: Lifetime,
        /// Whether it moves with its frame.
        frame_locked: bool,
        /// Remarks.
        metadata: Vec<KeyValuePair>,
        /// Its arrows.
        arrows: Vec<ArrowPrimitive>,
        /// Its boxes.
        cubes: Vec<CubePrimitive>,
        /// Its balls.
        spheres: Vec<SpherePrimitive>,
        /// Its cylinders and cones.
        cylinders: Vec<CylinderPrimitive>,
        /// Its lines.
        lines: Vec<LinePrimitive>,
        /// Its triangles.
        triangles: Vec<TriangleListPrimitive>,
        /// Its texts.
        texts: Vec<TextPrimitive>,
    }
    /// What a scene consists of.
    SceneUpdate = "/scene" {
        /// What it no longer has.
        deletions: Vec<SceneEntityDeletion>,
        /// What it has from now on.
        entities: Vec<SceneEntity>,
    }
}

/// The plumes of the thrusters that fire: a scene of its own, whole at each change.
#[derive(Clone, Debug, PartialEq)]
pub struct Plumes(pub SceneUpdate);

impl Row for Plumes {
    const DOC: &'static [&'static str] = SceneUpdate::DOC;
    const FIELDS: &'static [super::row::Field] = SceneUpdate::FIELDS;

    fn put<S: Sink>(&self, sink: &mut S) {
        self.0.put(sink);
    }
}

impl TopicRow for Plumes {
    const TOPIC: Topic = Topic { name: "/plumes", ..SceneUpdate::TOPIC };
}
