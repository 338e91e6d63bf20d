//! Panels of a three-axis body.

use flexsc_core::Scenario;
use flexsc_core::control::estimator::EstimatorKind;
use flexsc_core::control::estimator::attitude::ElasticStates;
use flexsc_core::dynamics::three_axis::Bearing;
use flexsc_core::dynamics::three_axis_model::ThreeAxisModel;
use flexsc_core::numerics::attitude::AXES;
use flexsc_core::record::row::TopicRow;
use flexsc_core::record::{ControlMomentGyros, Hinges, Wheels};

use super::one_axis::adaptation;
use super::panel::{LayoutPanel, MOST_LINES, PlotLine, line};
use super::{Tab, declared};
use crate::scene::Extent;

/// No plot has the energies of more modes.
const MOST_MODES: usize = 12;

/// Returns the tabs of a scenario.
pub fn tabs(scenario: &Scenario, body: &ThreeAxisModel) -> Vec<Tab> {
    let plot = LayoutPanel::plot;
    let mut motion = vec![
        LayoutPanel::scene(Extent::from_scenario(scenario)),
        plot("error", "Pointing error (rad)", errors(scenario)),
        plot(
            "rigid",
            "Rigid rates (rad/s)",
            rates(&[("rigid_rad_s", ""), ("believed_rad_s", ", estimated")]),
        ),
        plot("elastic", "Elastic rates at the sensor (rad/s)", rates(&[("elastic_rad_s", "")])),
    ];
    if !scenario.study.jets_alone {
        motion.push(plot("torques", "Torques of the actuator (N m)", torques("applied_nm")));
    }
    if scenario.study.fires() {
        let pulses = AXES.iter().map(|axis| line(format!("/jets.{axis}_on_s"), *axis).dots());
        motion.push(plot("jets", "Pulses of the jets (s)", pulses.collect()));
        motion.push(plot("fuel", "Propellant (kg)", vec![line("/jets.fuel_kg", "used")]));
    }
    if scenario.environment.is_some() {
        motion.push(plot("around", "Torques of the surroundings (N m)", torques("disturbance_nm")));
    }
    if scenario.environment.as_ref().is_some_and(|around| around.magnetic_field.is_some()) {
        motion.push(plot("field", "Magnetic field (T)", along("/orbit", "field_t")));
    }
    if scenario.actuator.magnetorquers().is_some() {
        motion.push(plot("moments", "Magnetic moments (A m²)", along("/magnetorquers", "moment_am2")));
    }
    for (index, accelerometer) in scenario.sensor.accelerometers().take(1) {
        let (count, name) = (accelerometer.axis_count(), &scenario.study.sensor_points[index]);
        let axis = |axis: usize| {
            line(format!("/accelerations.axes[{axis}].measured_m_s2"), format!("axis {}", axis + 1))
        };
        let title = format!("Specific force at {name} (m/s²)");
        motion.push(LayoutPanel::plot("accelerations", title, (0..count).map(axis).collect()));
    }
    motion.extend(line_of_sight(scenario));
    if scenario.study.wheels.is_some() {
        let count = scenario.study.wheels.as_ref().map_or(0, |wheels| wheels.axes().len());
        motion.extend(declared::panels(&Wheels::TOPIC, count));
    }
    let gimbals = scenario.study.gimbals.len();
    if gimbals > 0 {
        motion.extend(declared::panels(&ControlMomentGyros::TOPIC, gimbals));
    }
    if scenario.study.translation.is_some() {
        let along = ["x", "y", "z"].map(|axis| line(format!("/position.{axis}_m"), axis));
        motion.push(plot("position", "Position (m)", along.into()));
    }
    if scenario.study.bearings.iter().any(Bearing::can_stick) {
        let each = |field: &str| -> Vec<PlotLine> {
            let of = |wheel: usize| {
                line(format!("/bearings.wheels[{wheel}].{field}"), format!("wheel {}", wheel + 1))
            };
            (0..scenario.study.bearings.len().min(MOST_LINES)).map(of).collect()
        };
        motion.push(plot("friction", "Friction of the wheels (N m)", each("friction_nm")));
        motion.push(LayoutPanel::states("sliding", "Which way wheels turn", each("sliding")));
    }
    motion.extend(turning(scenario));
    let mut elastic = vec![plot("energy", "Elastic energy (J)", energies(scenario, body))];
    if scenario.study.articulation().is_some() {
        let of = |mode: usize| line(format!("/drives.modes[{mode}].frequency_rad_s"), format!("mode {mode}"));
        let each = (0..body.modes.len().min(MOST_LINES)).map(of).collect();
        elastic.push(plot("drifting", "Natural frequencies (rad/s)", each));
    }
    if let Some(plan) = &scenario.study.adaptive {
        let tracked: Vec<usize> = plan.axes.iter().map(|design| design.modes.len()).collect();
        elastic.push(plot(
            "frequencies",
            "Natural frequencies, estimated and true (rad/s)",
            frequencies(&tracked),
        ));
    }
    let channels = |field: &str| {
        let channel = |(index, axis)| line(format!("/tracking.channels[{index}].{field}"), axis);
        AXES.into_iter().enumerate().map(channel).collect::<Vec<PlotLine>>()
    };
    if scenario.study.authorities.iter().any(|authority| authority.threshold > 0.0) {
        let mut lines = channels("acted_on_rad_s");
        for (axis, threshold) in AXES.into_iter().zip(&scenario.study.authorities) {
            let threshold = threshold.threshold;
            for (sign, value) in [('+', threshold), ('-', -threshold)] {
                lines.push(line(value.to_string(), format!("{sign} threshold of {axis}")));
            }
        }
        elastic.push(plot("damping", "Elastic rates that damping acts on (rad/s)", lines));
        elastic.push(LayoutPanel::states("latched", "Active damping: the threshold", channels("latched")));
        elastic.push(LayoutPanel::states("resting", "Active damping: the watchdog", channels("resting")));
    }
    elastic.extend(envelope(scenario));
    if scenario.study.adaptive.is_some() {
        elastic.push(LayoutPanel::states("trusted", "Observers: lock", channels("trusted")));
    }
    together(scenario, motion, elastic)
}

/// Returns the panels with the angles of drives and hinges.
fn turning(scenario: &Scenario) -> Vec<LayoutPanel> {
    let mut panels = Vec::new();
    if let Some(drives) = scenario.study.articulation() {
        let angle =
            |index: usize| line(format!("/drives.drives[{index}].angle_rad"), format!("drive {}", index + 1));
        let angles = (0..drives.courses.count().min(MOST_LINES)).map(angle).collect();
        panels.push(LayoutPanel::plot("drives", "Angles of the drives (rad)", angles));
    }
    let hinges = scenario.study.hinges();
    if hinges > 0 {
        panels.extend(declared::panels(&Hinges::TOPIC, hinges));
    }
    panels
}

/// Arranges the panels of the motion and of the modes in tabs.
fn together(scenario: &Scenario, motion: Vec<LayoutPanel>, elastic: Vec<LayoutPanel>) -> Vec<Tab> {
    let mut tabs = vec![Tab { title: "Motion", panels: motion }];
    if let Some(spec) = scenario.estimator.as_ref().and_then(EstimatorKind::attitude) {
        let mut panels = filter();
        panels.extend(spec.elastic.as_ref().filter(|elastic| elastic.identifies()).map(identified));
        tabs.push(Tab { title: "Attitude filter", panels });
    }
    tabs.push(Tab { title: "Elastic modes", panels: elastic });
    if scenario.adaptation.is_some() {
        tabs.push(Tab { title: "Adaptation", panels: adaptation(scenario) });
    }
    tabs.push(Tab { title: "Log", panels: vec![LayoutPanel::log()] });
    tabs
}

/// Returns the panel of the envelope with its window means; `None` without a monitor.
fn envelope(scenario: &Scenario) -> Option<LayoutPanel> {
    scenario.estimator.as_ref()?.envelope()?;
    let lines = vec![
        line("/envelope_mean.mean_rad", "window mean").thick(),
        line("/envelope.envelope_rad", "envelope"),
    ];
    Some(LayoutPanel::plot("envelope", "Envelope of the elastic modes (rad)", lines))
}

/// Returns the panels of an attitude filter: errors with its own standard deviations, and their consistency.
fn filter() -> Vec<LayoutPanel> {
    let beside = |field: &str, deviation: &str| {
        let axis = |(index, axis): (usize, &str)| {
            let at = |field: &str| format!("/attitude_filter.axes[{index}].{field}");
            [
                line(at(field), axis).color(index).thick(),
                line(at(deviation), format!("{axis}, standard deviation")).color(index + AXES.len()),
            ]
        };
        AXES.into_iter().enumerate().flat_map(axis).collect::<Vec<_>>()
    };
    let consistency = vec![
        line("/attitude_filter.nees", "NEES per state, 1 if consistent"),
        line("/attitude_filter.nis", "NIS per component, 1 if consistent"),
    ];
    vec![
        LayoutPanel::plot(
            "angles",
            "Errors of the attitude (rad)",
            beside("angle_error_rad", "angle_sd_rad"),
        ),
        LayoutPanel::plot(
            "biases",
            "Errors of the gyro's bias (rad/s)",
            beside("bias_error_rad_s", "bias_sd_rad_s"),
        ),
        LayoutPanel::plot("consistency", "NEES and NIS (1 if consistent)", consistency),
    ]
}

fn errors(scenario: &Scenario) -> Vec<PlotLine> {
    let errors = AXES.iter().map(|axis| line(format!("/pointing.{axis}_error_rad"), *axis));
    let zone = scenario.law.about(0).coasting_zone();
    let ends = zone.into_iter().flat_map(|zone| [("+ dead zone", zone), ("- dead zone", -zone)]);
    errors.chain(ends.map(|(label, value)| line(value.to_string(), label))).collect()
}

fn torques(field: &str) -> Vec<PlotLine> {
    let axis = |(index, axis)| line(format!("/torques.axes[{index}].{field}"), axis);
    AXES.into_iter().enumerate().map(axis).collect()
}

/// Returns the lines of a field of a topic, one along each axis.
fn along(topic: &str, field: &str) -> Vec<PlotLine> {
    let axis = |(index, axis)| line(format!("{topic}.axes[{index}].{field}"), axis);
    ["x", "y", "z"].into_iter().enumerate().map(axis).collect()
}

fn rates(fields: &[(&str, &str)]) -> Vec<PlotLine> {
    let of = |(field, remark): &(&str, &str)| {
        let axis = |(index, axis)| line(format!("/rates.axes[{index}].{field}"), format!("{axis}{remark}"));
        AXES.into_iter().enumerate().map(axis).collect::<Vec<_>>()
    };
    fields.iter().flat_map(of).collect()
}

/// Returns the panel of the frequencies that an attitude filter identifies, with the true ones.
fn identified(elastic: &ElasticStates) -> LayoutPanel {
    let of = |(index, mode): (usize, &usize)| {
        let at = |field: &str| format!("/attitude_filter_modes.modes[{index}].{field}");
        [
            line(at("frequency_rad_s"), format!("mode {mode}")).color(index).thick(),
            line(at("true_frequency_rad_s"), format!("mode {mode}, true")).color(index),
        ]
    };
    let lines = elastic.modes.iter().enumerate().take(MOST_LINES).flat_map(of).collect();
    LayoutPanel::plot("identified", "Frequencies that the filter identifies (rad/s)", lines)
}

/// Returns the lines of the energy of all modes, and of those that the jets excite most.
fn energies(scenario: &Scenario, body: &ThreeAxisModel) -> Vec<PlotLine> {
    let groups = || scenario.study.groups.iter().flatten().flatten();
    let push = |mode: usize| groups().map(|group| group.push.forces[mode].abs()).fold(0.0, f64::max);
    let excited = |mode: &usize| push(*mode) / body.modes[*mode].frequency.get();
    let mut modes: Vec<usize> = (0..body.modes.len()).collect();
    modes.sort_by(|a, b| excited(b).total_cmp(&excited(a)));
    modes.truncate(MOST_MODES);
    modes.sort_unstable();
    let each = modes
        .into_iter()
        .map(|mode| line(format!("/vibrations.modes[{mode}].energy_j"), format!("mode {mode}")));
    std::iter::once(line("/energy.elastic_j", "all modes")).chain(each).collect()
}

/// Returns the lines of the frequencies of the first tracked modes, with the true ones.
fn frequencies(tracked: &[usize]) -> Vec<PlotLine> {
    let named = AXES.into_iter().zip(tracked).flat_map(|(axis, count)| (0..*count).map(move |n| (axis, n)));
    let of = |(index, (axis, n)): (usize, (&str, usize))| {
        let at = |field: &str| format!("/tracking.trackers[{index}].{field}");
        [
            line(at("frequency_rad_s"), format!("{axis} {n}")).color(index).thick(),
            line(at("true_frequency_rad_s"), format!("{axis} {n}, true")).color(index),
        ]
    };
    named.enumerate().take(MOST_LINES).flat_map(of).collect()
}

/// Returns the panel of the first line of sight, if there is one.
fn line_of_sight(scenario: &Scenario) -> Option<LayoutPanel> {
    let point = &scenario.line_of_sight.first()?.point;
    let about = |(axis, name): (usize, &str)| {
        line(format!("/line_of_sight.axes[{axis}].error_rad"), format!("about {name}"))
    };
    let lines = ["x", "y", "z"].into_iter().enumerate().map(about).collect();
    Some(LayoutPanel::plot("line of sight", format!("Error of the line of sight of {point} (rad)"), lines))
}
