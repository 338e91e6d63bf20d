//! Topic of the lines of sight of a three-axis body.

use crate::row::rows;

rows! {
    package "flexsc.v1";

    /// A line of sight and its point, about and along an axis of the body.
    LineOfSightAxis {
        /// Component of the rotation from the target direction of the line of sight to the actual one (rad).
        error_rad: f64,
        /// Rotation of the point by the vibration of the structure, relative to the hub (rad).
        rotation_rad: f64,
        /// Displacement of the point by the vibration of the structure, relative to the hub (m).
        displacement_m: f64,
    }
    /// A sample of a line of sight.
    LineOfSightSample = "/line_of_sight" at Sample {
        /// Index of the line of sight in the scenario, from 0.
        line: u64,
        /// Angle between the line of sight and its target direction (rad).
        error_rad: f64,
        /// About and along x, y and z.
        axes: Vec<LineOfSightAxis>,
    }
    /// A fine mirror about an axis of the body; angles are those by which the line of sight turns.
    FineMirrorAxis {
        /// Component of the rotation of the line of sight before the mirror (rad).
        before_rad: f64,
        /// Angle of the mirror (rad).
        angle_rad: f64,
        /// Command of the mirror (rad).
        command_rad: f64,
    }
    /// The fine mirror of a line of sight, at a sample of the line.
    FineMirrorSample = "/fine_mirror" at Sample {
        /// Index of the line of sight in the scenario, from 0.
        line: u64,
        /// Periods of the mirror until then in which its stroke or its rate limited a command.
        limited: u64,
        /// About x, y and z.
        axes: Vec<FineMirrorAxis>,
    }
}
