//! Descriptions of the observed quantities: those of the fields of topics that log the same quantity.

use flexsc_core::record::description;
use flexsc_core::{ObservationField, ObservationGroup};
use serde_json::Value;

/// Topic and path of the fields that log a quantity: of one axis, and of three axes. A name that ends with a slash stands for
/// a nested row.
struct LoggedField {
    name: &'static str,
    one_axis: &'static str,
    three_axes: &'static [&'static str],
}

const LOGGED: [LoggedField; 14] = [
    LoggedField { name: "angle", one_axis: "attitude/angle_rad", three_axes: &[] },
    LoggedField {
        name: "attitude",
        one_axis: "",
        three_axes: &["pointing/q_w", "pointing/q_x", "pointing/q_y", "pointing/q_z"],
    },
    LoggedField {
        name: "error",
        one_axis: "",
        three_axes: &["pointing/roll_error_rad", "pointing/pitch_error_rad", "pointing/yaw_error_rad"],
    },
    LoggedField { name: "rate", one_axis: "rate/rate_rad_s", three_axes: &["rates/axes/rate_rad_s"] },
    LoggedField { name: "rigid_angle", one_axis: "attitude/rigid_rad", three_axes: &[] },
    LoggedField { name: "rigid_rate", one_axis: "rate/rigid_rad_s", three_axes: &["rates/axes/rigid_rad_s"] },
    LoggedField {
        name: "modes",
        one_axis: "modes/modes/displacement_rad",
        three_axes: &["vibrations/modes/displacement"],
    },
    LoggedField {
        name: "mode_rates",
        one_axis: "modes/modes/rate_rad_s",
        three_axes: &["vibrations/modes/rate"],
    },
    LoggedField { name: "torque", one_axis: "torque/applied_nm", three_axes: &["torques/axes/applied_nm"] },
    LoggedField { name: "wheel_speed", one_axis: "wheel/speed_rad_s", three_axes: &[] },
    LoggedField { name: "wheel_speeds", one_axis: "", three_axes: &["wheels/wheels/speed_rad_s"] },
    LoggedField {
        name: "gimbal_angles",
        one_axis: "",
        three_axes: &["control_moment_gyros/gyros/angle_rad"],
    },
    LoggedField {
        name: "gimbal_rates",
        one_axis: "",
        three_axes: &["control_moment_gyros/gyros/rate_rad_s"],
    },
    LoggedField {
        name: "command",
        one_axis: "torque/feedback_nm",
        three_axes: &["torques/axes/feedback_nm"],
    },
];

const HINGES: [(&str, &str); 2] =
    [("hinge_angles", "hinges/hinges/angle_rad"), ("hinge_rates", "hinges/hinges/rate_rad_s")];

/// Texts of all topics.
pub struct Texts(Value);

impl Texts {
    /// Reads the texts of the topics.
    pub fn new() -> Self {
        Self(description::topics())
    }

    /// Returns the description of a field at a path of a topic: `rates/axes/rate_rad_s`.
    fn field(&self, path: &str) -> Option<&str> {
        let mut steps = path.split('/');
        let mut found = self.0.get(steps.next()?)?;
        for step in steps {
            found = found.get("fields")?.as_array()?.iter().find(|field| field["name"] == step)?;
        }
        found["doc"].as_str()
    }

    /// Returns the description of element `index` of a quantity.
    fn quantity(&self, name: &str, index: usize, is_three_axis: bool) -> Option<&str> {
        if let Some((_, path)) = HINGES.iter().find(|(own, _)| *own == name) {
            return self.field(path);
        }
        let logged = LOGGED.iter().find(|logged| logged.name == name)?;
        if !is_three_axis {
            return self.field(logged.one_axis);
        }
        self.field(logged.three_axes.get(index).or(logged.three_axes.first())?)
    }

    /// Returns the description of element `index` of an observed field.
    pub fn observed(&self, field: &ObservationField, index: usize, is_three_axis: bool) -> String {
        let own = self.quantity(field.name, index, is_three_axis).unwrap_or(field.name);
        match field.group {
            ObservationGroup::True => own.to_owned(),
            ObservationGroup::Measured => format!("Latest measurement; NaN before the first. {own}"),
            ObservationGroup::Estimated => format!("Estimate that the laws read. {own}"),
        }
    }

    /// Returns the description of the commanded torque.
    pub fn command(&self, is_three_axis: bool) -> String {
        self.quantity("command", 0, is_three_axis).unwrap_or("command").to_owned()
    }

    /// Returns the description of the mean envelope over the last window.
    pub fn window_mean(&self) -> String {
        self.field("envelope_mean/mean_rad").unwrap_or("mean envelope").to_owned()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_quantity_has_the_text_of_a_topic() {
        let texts = Texts::new();
        let own = LOGGED.iter().flat_map(|of| of.three_axes.iter().chain([&of.one_axis]));
        for path in own.chain(HINGES.iter().map(|(_, path)| path)).filter(|path| !path.is_empty()) {
            assert!(texts.field(path).is_some_and(|text| text.len() > 5), "{path}");
        }
        assert!(texts.window_mean().contains("rad") && texts.command(true).contains("commanded"));
        assert_eq!(texts.field("rates/axes/nothing"), None);
    }
}
