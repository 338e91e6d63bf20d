//! Trajectory of a plan: the motion of the body under the planned command, by the exact solution.

use std::f64::consts::TAU;
use std::sync::Arc as Shared;

use flexsc_core::dynamics::axis_model::{AxisModel, CommandedQuantity};
use flexsc_core::dynamics::flow::{ActiveWaveform, SegmentInput, UncoupledSegment};
use flexsc_core::dynamics::{AngleObservation, AxisState};
use flexsc_core::spacecraft::manoeuvre::Plan;

use crate::number_table::NumberTable;

/// Fewest and largest number of points of a line.
const FEWEST: f64 = 1500.0;
const MOST: f64 = 20_000.0;
/// Periods of the slowest mode that are shown after the manoeuvre.
const PERIODS: f64 = 4.0;

/// Motion of a body under a plan.
pub struct PlannedMotion {
    segment: UncoupledSegment,
    state: AxisState,
}

impl PlannedMotion {
    /// Creates the motion of a body under a plan, from the body's initial state.
    pub fn new(body: &AxisModel, plan: &Plan) -> Self {
        let mut segment = UncoupledSegment::new(body);
        let state = body.initial_state();
        let waveform = Some(ActiveWaveform::new(Shared::new(plan.waveform.clone()), 0.0));
        segment.depart(&state, &SegmentInput { constant: 0.0, waveform });
        Self { segment, state }
    }

    /// Returns the motion of the hub and the state of the body at a time (s) after the start of the plan.
    pub fn evaluate(&mut self, time: f64) -> (AngleObservation, &AxisState) {
        let hub = self.segment.at(time, &mut self.state);
        (hub, &self.state)
    }
}

/// Returns the end of the shown time (s): some periods of the slowest mode after the manoeuvre.
pub fn end(body: &AxisModel, plan: &Plan) -> f64 {
    let slowest = frequencies(body).fold(f64::INFINITY, f64::min);
    let after = if slowest.is_finite() { PERIODS * TAU / slowest } else { 0.0 };
    plan.time + after.max(0.2 * plan.time)
}

/// Returns the spacing of points (s) on a line of duration `length` (s).
pub fn step(body: &AxisModel, length: f64) -> f64 {
    let fastest = frequencies(body).fold(0.0, f64::max);
    let fine = if fastest > 0.0 { TAU / (24.0 * fastest) } else { length };
    fine.clamp(length / MOST, length / FEWEST)
}

/// Returns the trajectory as a table: command, motion of the hub, modes and outputs over time.
pub fn table(body: &AxisModel, plan: &Plan) -> NumberTable {
    let is_motion = body.drive == CommandedQuantity::Motion;
    let mut columns = ["time_s", "angle_rad", "rate_rad_s"].map(str::to_owned).to_vec();
    if is_motion {
        columns.push("acceleration_rad_s2".to_owned());
    }
    columns.push("torque_nm".to_owned());
    for index in 0..body.modes.len() {
        columns.push(format!("modes[{index}].displacement_rad"));
        columns.push(format!("modes[{index}].rate_rad_s"));
    }
    columns.extend(body.outputs.iter().map(|output| column(&output.name, &output.unit)));
    let end = end(body, plan);
    let mut motion = PlannedMotion::new(body, plan);
    let mut rows = Vec::new();
    for sample in plan.samples(body, step(body, end), end) {
        let (hub, state) = motion.evaluate(sample.time);
        let mut row = vec![sample.time, hub.angle, hub.rate];
        if is_motion {
            row.push(sample.command);
        }
        row.push(sample.torque);
        for (mode, frequency) in state.modes.iter().zip(frequencies(body)) {
            row.extend([mode.displacement, frequency * mode.quadrature]);
        }
        row.extend(body.outputs.iter().map(|output| output.evaluate(state)));
        rows.push(row.into_iter().map(Some).collect());
    }
    NumberTable { columns, rows }
}

/// Returns the name of a column: that of the quantity and its unit, such as `tip_m_s2` for `tip` in m/s².
fn column(name: &str, unit: &str) -> String {
    let mut column = name.to_owned();
    if !unit.is_empty() {
        column.push('_');
    }
    for letter in unit.chars() {
        match letter {
            '/' => column.push('_'),
            '²' => column.push('2'),
            '³' => column.push('3'),
            letter if letter.is_alphanumeric() => column.extend(letter.to_lowercase()),
            _ => {}
        }
    }
    column
}

fn frequencies(body: &AxisModel) -> impl Iterator<Item = f64> {
    body.modes.iter().map(|mode| mode.frequency.get())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn columns_have_units() {
        for (unit, expected) in [("rad", "tip_rad"), ("m/s²", "tip_m_s2"), ("N m", "tip_nm"), ("", "tip")] {
            assert_eq!(column("tip", unit), expected);
        }
    }
}
