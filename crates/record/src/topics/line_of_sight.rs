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
}
