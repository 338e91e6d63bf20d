//! Source files of the flight code, which are translated.

use flexsc_flight_precision::{Precision, SOURCES};

use crate::translate::SourceFile;

/// Defines the list of files, each with its text.
macro_rules! sources {
    ($($module:literal),* $(,)?) => {
        [$(SourceFile {
            path: concat!("crates/flight/src/", $module, ".rs"),
            module: $module,
            text: include_str!(concat!("../../flight/src/", $module, ".rs")),
        }),*]
    };
}

/// Number of files.
const COUNT: usize = 54;

/// Returns the source files of the flight code in a precision.
pub fn sources_in(precision: Precision) -> Vec<SourceFile<'static>> {
    match precision {
        Precision::Double => flight_sources().to_vec(),
        Precision::Single => {
            SOURCES.iter().map(|(module, path, text)| SourceFile { path, module, text }).collect()
        }
    }
}

/// Returns the source files of the flight code.
pub fn flight_sources() -> [SourceFile<'static>; COUNT] {
    sources![
        "active_damping",
        "argument_reduction",
        "attitude_estimator",
        "attitude_filter",
        "attitude_gate",
        "attitude_history",
        "attitude_law",
        "attitude_observation",
        "axis_motion",
        "b_dot",
        "binary64",
        "biquad",
        "compensator",
        "covariance_propagation",
        "delayed_observation",
        "error_measure",
        "exponentials",
        "filter_lock",
        "gain_schedule",
        "guard",
        "hypotenuse",
        "integer_square_root",
        "inverse_trigonometry",
        "jet_pulses",
        "kalman",
        "kalman_axis",
        "magnetorquers",
        "maths",
        "matrix3",
        "matrix6",
        "mode_condition",
        "mode_readings",
        "mode_supervisor",
        "momentum_unloading",
        "payne_hanek",
        "pd",
        "phase_plane",
        "pulse_timing",
        "pulse_width",
        "quaternion",
        "reading_judgement",
        "reading_status",
        "relay",
        "rigid_rate",
        "square_root",
        "stumpff",
        "supervised_mode",
        "switching_lines",
        "ticks",
        "torque_distribution",
        "trigonometry",
        "vector3",
        "wheel_allocation",
        "wheel_momentum",
    ]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sources_of_single_precision_name_their_files() {
        let sources = sources_in(Precision::Single);
        let path = |module: &str| sources.iter().find(|own| own.module == module).map(|own| own.path);
        assert_eq!(path("quaternion"), Some("crates/flight/src/quaternion.rs, in single precision"));
        assert_eq!(path("trigonometry"), Some("crates/flight-precision/src/single/trigonometry.rs"));
    }
}
