//! Outputs of a loop: angles, rates, pointing errors, coordinates of the body, lines of sight, and commands.

use flexsc_numerics::attitude::{AXES, Vector};
use nalgebra::RowDVector;

use super::mirror_states::line_row;
use super::motion::OutputRow;
use crate::linear_model::Signal;
use crate::open_loop::LoopParts;
use flexsc_scenario::Scenario;

/// Returns the outputs of a loop, with rows over the states of the body.
pub fn outputs(parts: &LoopParts<'_>) -> (Vec<Signal>, Vec<OutputRow>) {
    let model = &parts.body.model;
    let order = model.states.len();
    let measured = model.outputs.len() - order;
    let whole = parts.body.a.nrows();
    let mut all: Vec<(Signal, OutputRow)> = Vec::new();
    let row = |place: usize| {
        OutputRow::Body(RowDVector::from_row_slice(&model.c[place]).resize_horizontally(whole, 0.0))
    };
    all.extend((0..measured).map(|place| (model.outputs[place].clone(), row(place))));
    all.extend(
        parts.signals().into_iter().enumerate().map(|(axis, signal)| (signal, OutputRow::Command(axis))),
    );
    all.extend(error_rows(parts.scenario, whole));
    all.extend(line_of_line_rows(parts, whole));
    all.extend((measured..model.outputs.len()).map(|place| (model.outputs[place].clone(), row(place))));
    all.into_iter().unzip()
}

/// Returns the index of the output of a name, or an error with the names that there are.
pub fn output_index(outputs: &[Signal], name: &str) -> Result<usize, String> {
    outputs.iter().position(|output| output.name == name).ok_or_else(|| {
        let all: Vec<&str> = outputs.iter().map(|output| output.name.as_str()).collect();
        format!("signal must be `all` or some of {}, got {name}", all.join(", "))
    })
}

/// Returns the pointing error about each of three axes: the rotation of the hub, or, where the modes do not act back on
/// the rotation, that of the mean axes.
fn error_rows(scenario: &Scenario, order: usize) -> Vec<(Signal, OutputRow)> {
    let Some(body) = scenario.model.three_axis() else { return Vec::new() };
    let hub = body.coupling.as_ref().map_or(&[][..], |coupling| &coupling.rotations);
    let row = |(axis, name): (usize, &&str)| {
        let mut row = RowDVector::zeros(order);
        row[axis] = 1.0;
        hub.iter().enumerate().for_each(|(mode, rotation)| row[6 + 2 * mode] = rotation[axis]);
        (Signal { name: format!("{name}_error"), unit: "rad".to_owned() }, OutputRow::Body(row))
    };
    AXES.iter().enumerate().map(row).collect()
}

/// Returns true for the name of the error of a line of sight about an axis of the body.
pub fn is_line_about_axis(name: &str) -> bool {
    let about = name.strip_prefix("line_of_sight").and_then(|rest| rest.split_once('_'));
    about.is_some_and(|(_, about)| !DIAGONALS.iter().any(|(_, diagonal)| *diagonal == about))
}

/// Pairs of axes, and the names of the axes between them.
pub const DIAGONALS: [([usize; 2], &str); 3] = [([0, 1], "xy"), ([0, 2], "xz"), ([1, 2], "yz")];

/// Returns the error of each line of sight about the axes of the body and those between them, of one with a mirror also before the
/// mirror, and the angle of the mirror. Where a mirror is not among the states of the body, all three have the row before it.
fn line_of_line_rows(parts: &LoopParts<'_>, order: usize) -> Vec<(Signal, OutputRow)> {
    let scenario = parts.scenario;
    let Some(body) = scenario.model.three_axis() else { return Vec::new() };
    let mut all = Vec::new();
    for (index, line) in scenario.line_of_sight.iter().enumerate() {
        let sensitivity = line.sensitivity(body);
        let states = parts.mirrors.iter().find(|own| own.line == index);
        let mut across = [false; 3];
        for (axis, name) in ["x", "y", "z"].into_iter().enumerate() {
            let about = Vector::ith(axis, 1.0);
            let row = line_row(&sensitivity, &about, order);
            // A line along an axis has no error about it.
            if row.amax() <= 1e-12 {
                continue;
            }
            across[axis] = true;
            let mut add = |name: String, row: RowDVector<f64>| {
                all.push((Signal { name, unit: "rad".to_owned() }, OutputRow::Body(row)));
            };
            if line.mirror.is_some() {
                let angle = states.map_or_else(|| row.clone(), |states| states.angle_row(&about, order));
                let left = if states.is_some() { &row - &angle } else { row.clone() };
                add(format!("line_of_sight{index}_{name}"), left);
                add(format!("line_of_sight{index}_{name}_before_mirror"), row);
                add(format!("mirror{index}_{name}"), angle);
            } else {
                add(format!("line_of_sight{index}_{name}"), row);
            }
        }
        for (_, name) in DIAGONALS.iter().filter(|(pair, _)| pair.iter().all(|axis| across[*axis])) {
            let about = diagonal(name);
            let row = line_row(&sensitivity, &about, order);
            let angle = states.map(|states| states.angle_row(&about, order));
            let row = angle.map_or_else(|| row.clone(), |angle| &row - angle);
            let signal = Signal { name: format!("line_of_sight{index}_{name}"), unit: "rad".to_owned() };
            all.push((signal, OutputRow::Body(row)));
        }
    }
    all
}

/// Returns the axis between two axes of the body, by its name.
pub fn diagonal(name: &str) -> Vector {
    let part = |axis: &str| if name.contains(axis) { std::f64::consts::FRAC_1_SQRT_2 } else { 0.0 };
    Vector::new(part("x"), part("y"), part("z"))
}
