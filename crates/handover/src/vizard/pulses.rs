//! Thrust of jets between the rows of the motion.

use flexsc_core::Scenario;
use flexsc_core::control::actuator::GroupPair;
use flexsc_core::record::{Column, Columns};

use crate::error::HandoverError;
use crate::motion_rows::{nanoseconds, nested, numbers};

/// Pulse of a thruster (ns since the start).
#[derive(Copy, Clone, Debug, PartialEq, Eq)]
pub struct JetPulse {
    /// Start.
    pub from: u64,
    /// End.
    pub to: u64,
}

/// Returns the pulses of each thruster of the jets: those of `/thrusters`, where each fires on its own, or else those of
/// the groups in `/jets`.
pub fn jet_pulses(
    scenario: &Scenario,
    jets: Option<&Columns>,
    thrusters: Option<&Columns>,
) -> Result<Vec<Vec<JetPulse>>, HandoverError> {
    let Some((own, _)) = scenario.actuator.jets() else { return Ok(Vec::new()) };
    let count = own.thrusters.len();
    let mut pulses = vec![Vec::new(); count];
    let mut add = |thruster: usize, time: f64, on: f64| {
        let from = nanoseconds(time);
        if on > 0.0 && on.is_finite() {
            pulses[thruster].push(JetPulse { from, to: from.saturating_add(nanoseconds(on)) });
        }
    };
    if let Some(table) = thrusters {
        let lengths = nested(table, "thrusters", "on_s", count)?;
        for (row, time) in numbers(table, "time_s")?.iter().enumerate() {
            (0..count).for_each(|thruster| add(thruster, *time, lengths[row * count + thruster]));
        }
    } else if let Some((table, groups)) = jets.zip(own.groups.as_ref()) {
        let times = numbers(table, "time_s")?;
        let pairs: [Option<&GroupPair>; 3] = groups.each();
        for (pair, column) in pairs.into_iter().zip(["roll_on_s", "pitch_on_s", "yaw_on_s"]) {
            let (Some(pair), on) = (pair, numbers(table, column)?) else { continue };
            for (time, on) in times.iter().zip(on) {
                let group = if *on < 0.0 { &pair.minus } else { &pair.plus };
                for name in group {
                    let thruster = own.thrusters.iter().position(|thruster| thruster.name == *name);
                    if let Some(thruster) = thruster {
                        add(thruster, *time, on.abs());
                    }
                }
            }
        }
    }
    for of in &mut pulses {
        of.sort_by_key(|pulse| pulse.from);
    }
    Ok(pulses)
}

/// Returns the part of the time (0 to 1) before each row, since the row before, in which a thruster fires. Pulses are
/// in the order of their starts.
pub fn open_parts(pulses: &[JetPulse], times: &[u64]) -> Vec<f64> {
    let mut first = 0;
    let mut before = 0;
    let mut parts = Vec::with_capacity(times.len());
    for time in times {
        while pulses.get(first).is_some_and(|pulse| pulse.to <= before) {
            first += 1;
        }
        let started = pulses[first..].iter().take_while(|pulse| pulse.from < *time);
        let within = started.map(|pulse| pulse.to.min(*time).saturating_sub(pulse.from.max(before)) as f64);
        let open: f64 = within.sum();
        let long = time - before;
        parts.push(if long > 0 { (open / long as f64).min(1.0) } else { 0.0 });
        before = *time;
    }
    parts
}

/// Returns the numbers of a field of nested rows at a row; empty if the log has no such table.
pub fn nested_numbers(
    table: Option<&Columns>,
    name: &str,
    field: &str,
    row: usize,
    width: usize,
) -> Vec<f64> {
    let Some(Column::Rows(_, inner)) = table.and_then(|table| table.get(name)) else { return Vec::new() };
    let values = inner.numbers(field).unwrap_or_default();
    values.get(row * width..(row + 1) * width).unwrap_or_default().to_vec()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn parts_are_of_the_time_between_rows() {
        let pulse = |from, to| JetPulse { from, to };
        let pulses = [pulse(0, 50), pulse(120, 320), pulse(390, 400)];
        let parts = open_parts(&pulses, &[0, 100, 200, 300, 400, 500]);
        assert_eq!(parts, [0.0, 0.5, 0.8, 1.0, 0.3, 0.0]);
        assert_eq!(open_parts(&[pulse(0, 10), pulse(5, 10)], &[0, 10]), [0.0, 1.0]);
        assert_eq!(open_parts(&[], &[0, 10]), [0.0, 0.0]);
    }
}
