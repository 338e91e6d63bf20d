//! Panels of a one-axis body.

use flexsc_core::Scenario;
use flexsc_core::dynamics::axis_model::{AxisModel, AxisOutput};

use super::Tab;
use super::panel::{LayoutPanel, MOST_LINES, PlotLine, line};
use crate::scene::Extent;

/// Returns true if a scenario has a filter that acts at samples.
pub fn filters(scenario: &Scenario) -> bool {
    let estimator = scenario.estimator.as_ref();
    estimator.is_some_and(|estimator| estimator.filters_measurements())
}

/// Returns true if the law feeds back after a manoeuvre, or if there is no manoeuvre.
pub fn feeds_back(scenario: &Scenario) -> bool {
    scenario.law.pd().is_some()
}

/// Returns the tabs of a scenario.
pub fn tabs(scenario: &Scenario, body: &AxisModel) -> Vec<Tab> {
    let log = vec![LayoutPanel::log(), LayoutPanel::message("arrival", "End of the manoeuvre", "/arrival")];
    vec![
        Tab { title: "Motion", panels: motion(scenario, body) },
        Tab { title: "Estimator", panels: estimator(scenario, body) },
        Tab { title: "Log", panels: log },
    ]
}

fn motion(scenario: &Scenario, body: &AxisModel) -> Vec<LayoutPanel> {
    let relay = scenario.law.is_switching();
    let mut panels = vec![LayoutPanel::scene(Extent::from_scenario(scenario))];
    if relay {
        let title = "Phase plane: angle (rad) and rate (rad/s)";
        let lines = vec![line("/rate.rate_rad_s", "motion")];
        panels.push(LayoutPanel::plane("phase", title, "/attitude.angle_rad", lines));
    }
    panels.extend([
        LayoutPanel::plot("angle", "Angle (rad)", angles(scenario)),
        LayoutPanel::plot(
            "rate",
            "Rate (rad/s)",
            vec![
                line("/rate.rate_rad_s", "hub"),
                line("/rate.rigid_rad_s", "rigid"),
                line("/goal.rate_rad_s", "goal"),
            ],
        ),
        LayoutPanel::plot("modes", "Elastic modes (rad)", modes(body)),
        LayoutPanel::plot("outputs", "Observed coordinates", outputs(body)),
        LayoutPanel::plot("torque", torque_title(body), torques(scenario)),
        LayoutPanel::plot("wheel", "Wheel speed (rad/s)", vec![line("/wheel.speed_rad_s", "speed")]),
    ]);
    let state = if relay { "/command.state" } else { "/law.state" };
    panels.push(LayoutPanel::states("law", "State of the law", vec![line(state, "law")]));
    panels
}

fn angles(scenario: &Scenario) -> Vec<PlotLine> {
    let mut lines = vec![line("/attitude.angle_rad", "hub"), line("/attitude.rigid_rad", "rigid")];
    if scenario.study.sample_period.is_some() {
        lines.push(line("/attitude.measured_rad", "measured"));
    }
    lines.push(line("/goal.angle_rad", "goal"));
    if let Some(relay) = scenario.law.relay() {
        let zone = relay.dead_zone.get();
        lines.push(line("/command.angle_rad", "switchings").dots());
        lines.push(line(zone.to_string(), "+ dead zone"));
        lines.push(line((-zone).to_string(), "- dead zone"));
    }
    lines
}

fn modes(body: &AxisModel) -> Vec<PlotLine> {
    let count = body.modes.len();
    let each = (0..count.min(MOST_LINES))
        .map(|mode| line(format!("/modes.modes[{mode}].displacement_rad"), format!("mode {mode}")));
    let sum = (count != 1).then(|| line("/modes.elastic_rad", "sum"));
    sum.into_iter().chain(each).collect()
}

fn outputs(body: &AxisModel) -> Vec<PlotLine> {
    let outputs = body.outputs.iter().enumerate().take(MOST_LINES);
    let of = |(index, output): (usize, &AxisOutput)| {
        line(format!("/outputs.outputs[{index}].value"), format!("{} ({})", output.name, output.unit))
    };
    outputs.map(of).collect()
}

fn torques(scenario: &Scenario) -> Vec<PlotLine> {
    if !scenario.has_torque_rows() {
        return vec![line("/command.torque_nm", "torque").dots(), line("/law.torque_nm", "sampled")];
    }
    let mut lines = vec![line("/torque.applied_nm", "applied")];
    if scenario.plan.is_some() {
        lines.push(line("/torque.feedforward_nm", "planned"));
    }
    lines.push(line("/torque.feedback_nm", "commanded by the law"));
    if !scenario.disturbance.is_empty() {
        lines.push(line("/torque.disturbance_nm", "disturbance"));
    }
    lines
}

/// Returns the title of the torque plot: the commanded quantity and its unit.
fn torque_title(body: &AxisModel) -> String {
    let (name, unit) = body.commanded();
    let (first, rest) = name.split_at(1);
    format!("{}{rest} ({unit})", first.to_uppercase())
}

fn estimator(scenario: &Scenario, body: &AxisModel) -> Vec<LayoutPanel> {
    let mut panels = vec![LayoutPanel::plot(
        "envelope",
        "Envelope of the elastic modes (rad)",
        vec![
            // Viewers draw the first line above the others.
            line("/envelope_mean.mean_rad", "window mean").thick(),
            line("/envelope.envelope_rad", "envelope"),
        ],
    )];
    if scenario.law.is_switching() {
        let lines = vec![line("/envelope_mean.gain", "in each window").thick(), line("/law.gain", "sampled")];
        panels.push(LayoutPanel::plot("gain", "Braking gain k_t", lines));
    }
    panels.extend(adaptation(scenario));
    let plot = |name, title: &str, lines: &[(&str, &str)]| {
        let lines = lines.iter().map(|(field, label)| line(format!("/estimator.{field}"), *label));
        LayoutPanel::plot(name, title, lines.collect())
    };
    panels.extend([
        plot(
            "frequency",
            "Frequency of the dominant mode (rad/s)",
            &[("frequency_rad_s", "as the law reads it"), ("true_frequency_rad_s", "true")],
        ),
        plot("deviation", "Standard deviation (rad/s)", &[("frequency_sd_rad_s", "standard deviation")]),
        LayoutPanel::plot("dominant", "Dominant mode (rad)", dominant(scenario, body)),
        plot("nis", "NIS and NEES (1 if consistent)", &[("nis", "NIS"), ("nees", "NEES")]),
        LayoutPanel::states(
            "lock",
            "Lock and gate",
            vec![
                line("/estimator.lock", "lock"),
                line("/estimator.gated", "gated"),
                line("/estimator.measured", "measured"),
            ],
        ),
    ]);
    panels
}

/// Returns the panels of an adaptation: its objective, unless it is the envelope, and the gain that it tunes.
pub fn adaptation(scenario: &Scenario) -> Vec<LayoutPanel> {
    let search =
        LayoutPanel::states("search", "Search for the gain", vec![line("/adaptation.decision", "decision")]);
    let Some(adaptation) = scenario.adaptation.as_ref().filter(|of| of.window().is_some()) else {
        return vec![search];
    };
    let (objective, tunes) = (adaptation.objective(), adaptation.tunes());
    let (name, unit) = (objective.key().replace('_', " "), objective.unit(scenario.torque_unit()));
    let title =
        if unit.is_empty() { format!("Objective: {name}") } else { format!("Objective: {name} ({unit})") };
    vec![
        LayoutPanel::plot("objective", &title, vec![line("/objective.value", "in each window")]),
        LayoutPanel::plot(
            "tuned",
            format!("Tuned number: {tunes}"),
            vec![line("/objective.gain", "in each window")],
        ),
        search,
    ]
}

/// Returns the lines of the dominant mode: as the law reads it, and the true one.
fn dominant(scenario: &Scenario, body: &AxisModel) -> Vec<PlotLine> {
    let mut lines = vec![line("/estimator.displacement_rad", "as the law reads it")];
    let excitability = |mode: usize| body.modes[mode].excitability().abs();
    let modes = 0..body.modes.len();
    // Without an estimator there is nothing to compare with.
    if filters(scenario)
        && let Some(mode) =
            modes.reduce(|best, mode| if excitability(mode) > excitability(best) { mode } else { best })
    {
        lines.push(line(format!("/modes.modes[{mode}].displacement_rad"), "true"));
    }
    lines
}
