//! Functions of exported Kalman filters: their start, a sample of the sensors, and a change of the target.

use std::fmt::Write as _;

use super::initialiser::initialiser;
use super::signature::{about, signature};
use super::{Plan, shim};
use crate::control_system::KalmanUnit;

/// Writes the members of the state.
pub fn members(plan: &Plan<'_>, unit: &KalmanUnit, text: &mut String) {
    let estimates = if unit.axes.len() == 1 { String::new() } else { format!("[{}]", unit.axes.len()) };
    let _ = writeln!(
        text,
        "    /* Estimate about each axis. */\n    {}_kalman_axis estimate{estimates};",
        plan.prefix
    );
    for (axis, filter) in unit.axes.iter().enumerate() {
        let order = filter.mean.len();
        let _ = writeln!(
            text,
            "    /* Mean and covariance of a filter. */\n    double mean_{axis}[{order}];\n    double covariance_{axis}[{}];",
            order * order
        );
    }
}

/// Writes the models, and the function that starts the filters with means, which `init` calls too.
pub fn start(plan: &Plan<'_>, unit: &KalmanUnit, text: &mut String) {
    let prefix = plan.prefix;
    for (axis, filter) in unit.axes.iter().enumerate() {
        let about = "Model of a filter: transition matrix over a period, change of the state by a unit moment, covariance of the noise.";
        *text += &shim::numbers(plan, about, &format!("model_{axis}"), &filter.model, 4);
        let name = format!("variances_{axis}");
        *text += &shim::numbers(plan, "Variances at the start.", &name, &filter.variances, 4);
    }
    let _ = writeln!(
        text,
        "/* Starts the filters with the mean of their states. */\nstatic void start_filters({prefix}_state *state, const double *mean)\n{{"
    );
    let (mut first, states) = (0, unit.axes.iter().map(|axis| axis.mean.len()).sum::<usize>());
    for (axis, filter) in unit.axes.iter().enumerate() {
        let (order, estimate) = (filter.mean.len(), about("estimate", axis, unit.axes.len()));
        let feed = format!("{prefix}_kalman_feed_{}", super::snake(&format!("{:?}", filter.estimate.feed)));
        let _ = writeln!(
            text,
            "    state->{estimate} = kalman_axis_new({}, {}, {}, {});\n    \
             kalman_axis_reset(mean, {states}, {first}, variances_{axis}, {order}, state->mean_{axis}, {order}, state->covariance_{axis}, {});",
            feed.to_uppercase(),
            filter.estimate.motion,
            filter.estimate.mode,
            filter.measurements,
            order * order,
        );
        first += order;
    }
    text.push_str("}\n\n");
}

/// Writes the statements of `init`.
pub fn init(unit: &KalmanUnit, text: &mut String) {
    let states: usize = unit.axes.iter().map(|axis| axis.mean.len()).sum();
    let _ = writeln!(text, "    static const double zero[{states}];\n    start_filters(state, zero);");
}

/// Writes the functions.
pub fn functions(plan: &Plan<'_>, unit: &KalmanUnit, text: &mut String) {
    let (prefix, axes) = (plan.prefix, unit.axes.len());
    let _ = writeln!(text, "{}\n{{\n    start_filters(state, input->mean);", signature(plan, &plan.calls[0]));
    for axis in 0..axes {
        let _ = writeln!(text, "    output->{} = state->mean_{axis}[0];", about("angle", axis, axes));
    }
    let longest = unit.axes.iter().map(|axis| axis.mean.len()).max().unwrap_or(0);
    let buffer = longest * (1 + 2 * longest);
    let _ = writeln!(
        text,
        "}}\n\n{}\n{{\n    double buffer[{buffer}];\n    {prefix}_kalman_sample sample;",
        signature(plan, &plan.calls[1])
    );
    for (axis, filter) in unit.axes.iter().enumerate() {
        let own = |name: &str| about(name, axis, axes);
        let (order, estimate) = (filter.mean.len(), own("estimate"));
        let _ = writeln!(
            text,
            "    sample = ({prefix}_kalman_sample){};\n    sample.is_measured = input->is_measured;\n    sample.angle = input->{};\n    \
             sample.rate = input->{};\n    kalman_axis_take(&state->{estimate}, model_{axis}, {}, input->{}, &sample, state->mean_{axis}, {order},\n        \
             state->covariance_{axis}, {}, buffer, {buffer});",
            initialiser(&filter.sample, prefix),
            own("angle"),
            own("rate"),
            filter.model.len(),
            own("moment"),
            order * order,
        );
        let mode: &[&str] = if unit.gives_mode { &["displacement", "displacement_rate"] } else { &[] };
        for name in ["angle", "rate"].iter().chain(mode) {
            let _ = writeln!(text, "    output->{} = state->{estimate}.{name};", own(name));
        }
        let _ = writeln!(
            text,
            "    output->{} = kalman_axis_has_lost_lock(&state->{estimate});",
            own("has_lost_lock")
        );
    }
    text.push_str("}\n\n");
    if axes < 3 {
        return;
    }
    let _ = writeln!(text, "{}\n{{", signature(plan, &plan.calls[2]));
    for (axis, filter) in unit.axes.iter().enumerate() {
        let _ = writeln!(
            text,
            "    kalman_axis_shift(&state->estimate[{axis}], input->shift[{axis}], state->mean_{axis}, {});\n    \
             output->angle[{axis}] = state->estimate[{axis}].angle;",
            filter.mean.len()
        );
    }
    text.push_str("}\n\n");
}
