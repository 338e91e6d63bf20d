//! The panels of a body with three axes.

use super::panel::{Line, MOST_LINES, Panel, line};
use super::{Tab, metrics};
use crate::body::spatial::AXES;
use crate::scenario::{AxesEstimator, Scenario, SpatialLoop};
use crate::scene::Extent;

/// The tabs of a scenario.
pub fn tabs(scenario: &Scenario, spatial: &SpatialLoop) -> Vec<Tab> {
    let motion = vec![
        Panel::scene(Extent::of(scenario)),
        Panel::plot("error", "Beyond the target (rad)", errors(spatial)),
        Panel::plot(
            "rigid",
            "Rigid rates (rad/s)",
            rates(&[("rigid_rad_s", ""), ("believed_rad_s", ", believed")]),
        ),
        Panel::plot("elastic", "Elastic rates at the gyro (rad/s)", rates(&[("elastic_rad_s", "")])),
        Panel::plot(
            "jets",
            "Pulses of the jets (s)",
            AXES.iter().map(|axis| line(format!("/jets.{axis}_on_s"), *axis).dots()).collect(),
        ),
        Panel::plot("fuel", "Propellant (kg)", vec![line("/jets.fuel_kg", "used")]),
    ];
    let mut elastic = vec![Panel::plot("energy", "Elastic energy (J)", energies(spatial))];
    if let Some(AxesEstimator::Adaptive(plan)) = &spatial.estimator {
        let tracked: Vec<usize> = plan.axes.iter().map(|design| design.modes.len()).collect();
        elastic.push(Panel::plot(
            "frequencies",
            "Natural frequencies, estimated and true (rad/s)",
            frequencies(&tracked),
        ));
    }
    let channels = |field: &str| {
        let channel = |(index, axis)| line(format!("/tracking.channels[{index}].{field}"), axis);
        AXES.into_iter().enumerate().map(channel).collect::<Vec<Line>>()
    };
    if spatial.law.damping.is_some() {
        let mut lines = channels("acted_on_rad_s");
        for (axis, threshold) in AXES.into_iter().zip(spatial.thresholds) {
            for (sign, value) in [('+', threshold), ('-', -threshold)] {
                lines.push(line(value.to_string(), format!("{sign} threshold of {axis}")));
            }
        }
        elastic.push(Panel::plot("damping", "Elastic rates that damping acts on (rad/s)", lines));
        elastic.push(Panel::states("latched", "Active damping: the threshold", channels("latched")));
        elastic.push(Panel::states("resting", "Active damping: the watchdog", channels("resting")));
    }
    elastic.push(Panel::states("trusted", "Observers", channels("trusted")));
    let mut log = vec![Panel::log()];
    log.extend(metrics(scenario));
    vec![
        Tab { title: "Motion", panels: motion },
        Tab { title: "Elastic modes", panels: elastic },
        Tab { title: "Log", panels: log },
    ]
}

fn errors(spatial: &SpatialLoop) -> Vec<Line> {
    let zone = spatial.law.dead_zone.get();
    let errors = AXES.iter().map(|axis| line(format!("/pointing.{axis}_error_rad"), *axis));
    errors
        .chain(
            [("+ dead zone", zone), ("- dead zone", -zone)]
                .map(|(label, value)| line(value.to_string(), label)),
        )
        .collect()
}

fn rates(fields: &[(&str, &str)]) -> Vec<Line> {
    let of = |(field, remark): &(&str, &str)| {
        let axis = |(index, axis)| line(format!("/rates.axes[{index}].{field}"), format!("{axis}{remark}"));
        AXES.into_iter().enumerate().map(axis).collect::<Vec<_>>()
    };
    fields.iter().flat_map(of).collect()
}

/// The energy of all modes, and of those that the jets excite most.
fn energies(spatial: &SpatialLoop) -> Vec<Line> {
    let groups = || spatial.groups.iter().flatten();
    let push = |mode: usize| groups().map(|group| group.forces[mode].abs()).fold(0.0, f64::max);
    let excited = |mode: &usize| push(*mode) / spatial.body.modes[*mode].frequency.get();
    let mut modes: Vec<usize> = (0..spatial.body.modes.len()).collect();
    modes.sort_by(|a, b| excited(b).total_cmp(&excited(a)));
    modes.truncate(MOST_LINES - 1);
    modes.sort_unstable();
    let each = modes
        .into_iter()
        .map(|mode| line(format!("/vibrations.modes[{mode}].energy_j"), format!("mode {mode}")));
    std::iter::once(line("/energy.elastic_j", "all modes")).chain(each).collect()
}

/// The frequencies of the first tracked modes, each beside what it really is.
fn frequencies(tracked: &[usize]) -> Vec<Line> {
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
