//! Relays about the axes: decisions at events, and the same law polled at samples.

use flexsc_core::control::law::LawKind;
use flexsc_flight::guard::GuardDirection;
use flexsc_flight::relay::{PolledRelay, RelayCommand, RelayEvent};
use flexsc_flight::ticks::Ticks;

use super::{CallLayout, Channel, NotExportable, WordReader, all_of_kind};

/// Relay about each axis.
#[derive(Clone, Debug)]
pub struct Relays {
    /// Relays.
    pub axes: Vec<PolledRelay>,
}

impl Relays {
    /// Returns the relays of a scenario.
    pub(super) fn new(laws: &[&LawKind]) -> Result<Self, NotExportable> {
        let relay = |law: &LawKind| {
            let LawKind::Relay(relay) = law else { return None };
            let mut law = relay.flight_law();
            let command = law.command(Ticks::default());
            law.pushed_at = Ticks::default();
            Some(PolledRelay { law, has_started: false, command })
        };
        Ok(Self { axes: all_of_kind(laws, relay)? })
    }

    /// Returns the functions: a decision at an event, and a poll at a sample.
    pub(super) fn calls(&self) -> Vec<CallLayout> {
        let zone = self.axes.iter().map(|relay| relay.law.dead_zone).fold(0.0, f64::max);
        let axes = self.axes.len();
        let decide = CallLayout {
            inputs: vec![
                Channel::integer("axis", "Axis, from 0", 1, axes as u64),
                Channel::integer("event", "Event: 0 start, 1 first guard, 2 second guard, 3 time", 1, 4),
                Channel::real("angle", "Estimated angle (rad)", 1, 2.0 * zone),
            ],
            outputs: vec![
                Channel::real("torque", "Torque (N m)", 1, 1.0),
                Channel::flag("has_timeout", "True if the next decision is at the time `until`", 1),
                Channel::integer("until_whole", "Time of the next decision: whole seconds", 1, 0),
                Channel::integer("until_part", "Time of the next decision: femtoseconds past them", 1, 0),
                Channel::integer("guard_count", "Number of guards", 1, 3),
                Channel::flag("guard_is_lower", "True for a guard that trips at or below its level", 2),
                Channel::real("guard_level", "Level of each guard (rad)", 2, 1.0),
            ],
            ..CallLayout::new(
                "decide",
                "Decides about an axis at an event; the command holds until a guard on the angle trips, or until its time.",
            )
        };
        let poll = CallLayout {
            inputs: vec![Channel::real("angle", "Measured angle about each axis (rad)", axes, 2.0 * zone)],
            outputs: vec![Channel::real("torque", "Torque about each axis (N m)", axes, 1.0)],
            ..CallLayout::new("poll", "Polls the guards and the times of all axes at a sample.")
        };
        vec![decide, poll]
    }

    /// Calls a function, and returns the words of its outputs.
    pub(super) fn call(&mut self, call: usize, now: Ticks, inputs: &[u64]) -> Vec<u64> {
        let mut words = WordReader::new(inputs);
        if call == 1 {
            return self.axes.iter_mut().map(|relay| relay.step(now, words.real()).to_bits()).collect();
        }
        let (axis, event, angle) = (words.word() as usize, words.word(), words.real());
        let Some(relay) = self.axes.get_mut(axis) else { return Vec::new() };
        relay.decide(now, RelayEvent::from_number(event as i64), angle);
        output_words(&relay.command)
    }
}

/// Returns a command as the words of the outputs of `decide`.
fn output_words(command: &RelayCommand) -> Vec<u64> {
    let [first, second] = command.guards;
    vec![
        command.torque.to_bits(),
        u64::from(command.has_timeout),
        command.until.whole as u64,
        command.until.part as u64,
        command.guard_count as u64,
        u64::from(first.side == GuardDirection::AtMost),
        u64::from(second.side == GuardDirection::AtMost),
        first.level.to_bits(),
        second.level.to_bits(),
    ]
}
