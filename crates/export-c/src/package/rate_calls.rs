//! Function of exported filters of the rigid rates: a sample of the sensors.

use std::fmt::Write as _;

use super::Plan;
use super::signature::{about, signature};
use crate::control_system::RateUnit;

/// Writes the function.
pub fn sample(plan: &Plan<'_>, unit: &RateUnit, text: &mut String) {
    let axes = unit.axes.len();
    let _ = writeln!(text, "{}\n{{", signature(plan, &plan.calls[0]));
    for axis in 0..axes {
        let [filter, rate, change] =
            ["rate_filter", "rate", "rate_change"].map(|name| about(name, axis, axes));
        let _ = writeln!(
            text,
            "    rigid_rate_filter_take(&state->{filter}, input->is_measured, input->{rate}, input->{change});\n    \
             output->{rate} = state->{filter}.rate;"
        );
    }
    text.push_str("}\n\n");
}
