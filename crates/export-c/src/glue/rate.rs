//! Filters of the rigid rates: a sample of the sensors.

use super::Glue;
use super::member::Member;
use super::text::about;
use crate::control_system::RateUnit;

/// Adds the filters.
pub fn add(glue: &mut Glue<'_>, unit: &RateUnit) {
    let (about_filters, axes) = ("Filter of the rate about each axis.", unit.axes.len());
    glue.members.push(Member::about_axes(about_filters, "rate_filter", "RigidRateFilter", &unit.axes));
    let take = |axis: usize| {
        let [filter, rate, change] =
            ["rate_filter", "rate", "rate_change"].map(|name| about(name, axis, axes));
        format!(
            "    state.{filter}.take(input.is_measured, input.{rate}, input.{change});\n    output.{rate} = state.{filter}.rate;\n"
        )
    };
    let body: String = (0..axes).map(take).collect();
    glue.call("sample", &body);
}
