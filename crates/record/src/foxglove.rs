//! Messages of the package `foxglove` for viewers: log lines, frames and scenes.
//!
//! Names and numbers of the fields are those of the published schemas. Unused fields at the end of a message are left
//! out.

use super::row::{LogDate, LogSpan, Row, Sink, Source, Topic, TopicRow, label_cells, rows};
use crate::enum_label::LoggedEnum;

/// Severity of a log line.
#[derive(Copy, Clone, Debug, PartialEq, Eq)]
pub enum LogLevel {
    /// Unknown severity.
    Unknown,
    /// Message for debugging.
    Debug,
    /// Informational message.
    Info,
    /// Warning message.
    Warning,
    /// Error message.
    Error,
    /// Fatal error.
    Fatal,
}

impl LogLevel {
    /// Labels of the enumeration, for a log column.
    pub const LABELS: LoggedEnum = LoggedEnum {
        name: "Log.Level",
        docs: &[
            " Unknown severity.",
            " For debugging.",
            " Information.",
            " A warning.",
            " An error.",
            " A fatal error.",
        ],
        values: &["unknown", "debug", "info", "warning", "error", "fatal"],
    };
    const VALUES: &[Self] =
        &[Self::Unknown, Self::Debug, Self::Info, Self::Warning, Self::Error, Self::Fatal];
}

/// Extent of a deletion of scene entities.
#[derive(Copy, Clone, Debug, PartialEq, Eq)]
pub enum Deleted {
    /// Entity of the given id.
    MatchingId,
    /// All entities of the topic.
    All,
}

impl Deleted {
    const LABELS: LoggedEnum = LoggedEnum {
        name: "SceneEntityDeletion.Type",
        docs: &[" The entity of this id.", " All entities of the topic."],
        values: &["matching id", "all"],
    };
    const VALUES: &[Self] = &[Self::MatchingId, Self::All];
}

/// Connection of the points of a line.
#[derive(Copy, Clone, Debug, PartialEq, Eq)]
pub enum LineType {
    /// Each point is joined to the next.
    Strip,
    /// Each point is joined to the next, and the last to the first.
    Loop,
    /// Points are joined in pairs.
    List,
}

impl LineType {
    const LABELS: LoggedEnum = LoggedEnum {
        name: "LinePrimitive.Type",
        docs: &[" Each point with the next.", " Also the last point with the first.", " In pairs."],
        values: &["line strip", "line loop", "line list"],
    };
    const VALUES: &[Self] = &[Self::Strip, Self::Loop, Self::List];
}

label_cells!(LogLevel, Deleted, LineType);

rows! {
    package "foxglove";

    /// A line of the log.
    Log = "/log" {
        /// Time of the message.
        timestamp: LogDate,
        /// Severity.
        level: LogLevel,
        /// Text of the message.
        message: String,
        /// Source of the message.
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
        /// The x component.
        x: f64,
        /// The y component.
        y: f64,
        /// The z component.
        z: f64,
        /// Real part.
        w: f64,
    }
    /// A position and an attitude.
    Pose {
        /// Position (m).
        position: Vector3,
        /// Attitude.
        orientation: Quaternion,
    }
    /// A colour; each component is from 0 to 1.
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
    /// Pose of a frame in another.
    FrameTransform {
        /// Time of the message.
        timestamp: LogDate,
        /// Name of the parent frame.
        parent_frame_id: String,
        /// Name of the frame.
        child_frame_id: String,
        /// Origin in the parent frame (m).
        translation: Vector3,
        /// Attitude in the parent frame.
        rotation: Quaternion,
    }
    /// Poses of the frames.
    FrameTransforms = "/tf" at Scene {
        /// Each frame.
        transforms: Vec<FrameTransform>,
    }
    /// Entities that a scene no longer has.
    SceneEntityDeletion {
        /// Time of the message.
        timestamp: LogDate,
        /// Kind of deletion.
        r#type: Deleted,
        /// Id of the entity.
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
        /// Pose of its start; it points along x.
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
        /// Pose of its centre.
        pose: Pose,
        /// Edges (m).
        size: Vector3,
        /// Colour.
        color: Color,
    }
    /// A sphere.
    SpherePrimitive {
        /// Pose of its centre.
        pose: Pose,
        /// Diameters (m).
        size: Vector3,
        /// Colour.
        color: Color,
    }
    /// A cylinder or a cone about z.
    CylinderPrimitive {
        /// Pose of its centre.
        pose: Pose,
        /// Diameters and height (m).
        size: Vector3,
        /// Fraction of the diameters at the lower end.
        bottom_scale: f64,
        /// Fraction of the diameters at the upper end.
        top_scale: f64,
        /// Colour.
        color: Color,
    }
    /// Lines.
    LinePrimitive {
        /// How the points are joined into lines.
        r#type: LineType,
        /// Their pose.
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
        /// Their pose.
        pose: Pose,
        /// Their corners, three for each triangle.
        points: Vec<Point3>,
        /// Colour.
        color: Color,
    }
    /// A text.
    TextPrimitive {
        /// Pose of the text.
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
        /// Time of the message.
        timestamp: LogDate,
        /// Frame in which it is drawn.
        frame_id: String,
        /// Id; a later entity with the same id replaces it.
        id: String,
        /// Time for which it is shown.
        lifetime: LogSpan,
        /// Whether it moves with its frame.
        frame_locked: bool,
        /// Remarks.
        metadata: Vec<KeyValuePair>,
        /// Arrows.
        arrows: Vec<ArrowPrimitive>,
        /// Boxes.
        cubes: Vec<CubePrimitive>,
        /// Spheres.
        spheres: Vec<SpherePrimitive>,
        /// Cylinders and cones.
        cylinders: Vec<CylinderPrimitive>,
        /// Lines.
        lines: Vec<LinePrimitive>,
        /// Triangles.
        triangles: Vec<TriangleListPrimitive>,
        /// Texts.
        texts: Vec<TextPrimitive>,
    }
    /// Contents of a scene.
    SceneUpdate = "/scene" at Scene {
        /// Entities to remove.
        deletions: Vec<SceneEntityDeletion>,
        /// Entities of the scene from now on.
        entities: Vec<SceneEntity>,
    }
}

/// Plumes of the firing thrusters: a separate scene, complete at each change.
#[derive(Clone, Debug, PartialEq)]
pub struct Plumes(pub SceneUpdate);

impl Row for Plumes {
    const DOC: &'static [&'static str] = SceneUpdate::DOC;
    const FIELDS: &'static [super::row::RowField] = SceneUpdate::FIELDS;

    fn write_to<S: Sink>(&self, sink: &mut S) {
        self.0.write_to(sink);
    }

    fn read_rows<S: Source>(source: &S, before: &str) -> Option<Vec<Self>> {
        Some(SceneUpdate::read_rows(source, before)?.into_iter().map(Self).collect())
    }
}

impl TopicRow for Plumes {
    const TOPIC: Topic = Topic { name: "/plumes", ..SceneUpdate::TOPIC };
}
