//! Kalman filters: their start, a sample of the sensors, and a change of the target.

use std::fmt::Write as _;

use super::Glue;
use super::member::Member;
use super::text::{about, block, literal};
use crate::control_system::{AxisFilter, KalmanUnit};

/// Adds the filters.
pub fn add(glue: &mut Glue<'_>, unit: &KalmanUnit) {
    let axes = unit.axes.len();
    let estimates: Vec<_> = unit.axes.iter().map(|axis| axis.estimate).collect();
    let estimate = Member::about_axes("Estimate about each axis.", "estimate", "KalmanAxis", &estimates);
    glue.members.push(estimate.started());
    for (axis, filter) in unit.axes.iter().enumerate() {
        let order = filter.mean.len();
        let zeros = |about: &str, name: &str, count: usize| {
            Member::filled(about, &format!("{name}_{axis}"), "f64", "0.0", count).started()
        };
        glue.members.push(zeros("Mean of the state of a filter.", "mean", order));
        glue.members.push(zeros("Its covariance.", "covariance", order * order));
        let about = "Model of a filter: transition matrix over a period, change of the state by a unit moment, covariance of the noise.";
        glue.list(about, &format!("MODEL_{axis}"), "f64", &filter.model);
        glue.list("Variances at the start.", &format!("VARIANCES_{axis}"), "f64", &filter.variances);
    }
    add_start(glue, unit);
    let longest = unit.axes.iter().map(|axis| axis.mean.len()).max().unwrap_or(0);
    let buffer = longest * (1 + 2 * longest);
    let mut body = format!("    let mut buffer: [f64; {buffer}] = [0.0; {buffer}];\n");
    for (axis, filter) in unit.axes.iter().enumerate() {
        body += &block(&take(filter, axis, axes));
        let modes: &[&str] = if unit.gives_mode { &["displacement", "displacement_rate"] } else { &[] };
        let estimate = about("estimate", axis, axes);
        for name in ["angle", "rate"].iter().chain(modes) {
            let _ = writeln!(body, "    output.{} = state.{estimate}.{name};", about(name, axis, axes));
        }
        let lost = about("has_lost_lock", axis, axes);
        let _ = writeln!(body, "    output.{lost} = state.{estimate}.has_lost_lock();");
    }
    glue.call("sample", &body);
    let shift = |axis: usize| {
        format!(
            "    state.estimate[{axis}].shift(input.shift[{axis}], &mut state.mean_{axis});\n    output.angle[{axis}] = state.estimate[{axis}].angle;\n"
        )
    };
    let body: String = (0..axes).map(shift).collect();
    glue.call("shift", &body);
}

/// Adds the functions that start the filters.
fn add_start(glue: &mut Glue<'_>, unit: &KalmanUnit) {
    let (axes, mut first, mut body) = (unit.axes.len(), 0, String::new());
    for (axis, filter) in unit.axes.iter().enumerate() {
        let (estimate, own) = (about("estimate", axis, axes), &filter.estimate);
        let _ = write!(body,
            "    state.{estimate} = KalmanAxis::new(KalmanFeed::{:?}, {}, {}, {});
    kalman_axis::reset(mean, {first}, &VARIANCES_{axis}, &mut state.mean_{axis}, &mut state.covariance_{axis});
",
            own.feed, own.motion, own.mode, filter.measurements,
        );
        first += filter.mean.len();
    }
    let about_start = "Starts the filters with the mean of their states.";
    glue.function(about_start, "fn start_filters()", &["state: &mut State", "mean: &[f64]"], &body);
    let about_mean = "Mean of the states before the start: zeros.";
    glue.constant(about_mean, "NO_MEAN", &format!("[f64; {first}]"), &format!("[0.0; {first}]"));
    glue.init.push_str("    start_filters(state, &NO_MEAN);\n");
    let angle = |axis| format!("    output.{} = state.mean_{axis}[0];\n", about("angle", axis, axes));
    let angles: String = (0..axes).map(angle).collect();
    glue.call("start", &("    start_filters(state, &input.mean);\n".to_owned() + &angles));
}

/// Returns the statements by which a filter takes a sample.
fn take(filter: &AxisFilter, axis: usize, axes: usize) -> String {
    let own = |name: &str| about(name, axis, axes);
    let sample = &filter.sample;
    format!(
        "    let sample: KalmanSample = KalmanSample {{ is_measured: input.is_measured, angle: input.{}, rate: input.{}, angle_noise: {}, has_rate: {}, rate_noise: {}, motion: {}, is_gated: {} }};
    state.{}.take(&MODEL_{axis}, input.{}, &sample, &mut state.mean_{axis}, &mut state.covariance_{axis}, &mut buffer);
",
        own("angle"),
        own("rate"),
        literal(&sample.angle_noise),
        sample.has_rate,
        literal(&sample.rate_noise),
        sample.motion,
        sample.is_gated,
        own("estimate"),
        own("moment"),
    )
}
