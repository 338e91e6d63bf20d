//! Topics of a log: the fields of each row, with their units.

mod line_of_sight;
mod one_angle;
mod run;
mod three_axes;

use super::foxglove::{self, LogLevel, Plumes};
use super::row::{Topic, TopicRow};
use super::states::{Gate, Latch, Light, Lock, Onset, Phase, ReadingOutcome, Sliding, Trust, Use, Watch};
use crate::enum_label::LoggedEnum;

pub use line_of_sight::*;
pub use one_angle::*;
pub use run::*;
pub use three_axes::*;

/// Topic declarations, in the order of the list.
const PARTS: [&[Topic]; 5] =
    [one_angle::DECLARED, three_axes::DECLARED, line_of_sight::DECLARED, run::DECLARED, foxglove::DECLARED];

const COUNT: usize = PARTS[0].len() + PARTS[1].len() + PARTS[2].len() + PARTS[3].len() + PARTS[4].len() + 1;

/// All topics of a log.
pub const TOPICS: &[Topic] = {
    const ALL: [Topic; COUNT] = {
        let mut all = [Plumes::TOPIC; COUNT];
        let (mut part, mut in_part, mut index) = (0, 0, 0);
        while part < PARTS.len() {
            if in_part < PARTS[part].len() {
                all[index] = PARTS[part][in_part];
                in_part += 1;
                index += 1;
            } else {
                part += 1;
                in_part = 0;
            }
        }
        all
    };
    &ALL
};

/// Topics whose rows precede those of all others in a report, in their order. The rows of other topics follow in the
/// order of [`TOPICS`], and those of custom topics come last.
const REPORT_ORDER: [&str; 21] = [
    "/attitude",
    "/rate",
    "/modes",
    "/outputs",
    "/goal",
    "/torque",
    "/wheel",
    "/pointing",
    "/rates",
    "/vibrations",
    "/energy",
    "/position",
    "/torques",
    "/orbit",
    "/magnetorquers",
    "/envelope",
    "/drives",
    "/hinges",
    "/bearings",
    "/control_moment_gyros",
    "/wheels",
];

/// Place of each topic's rows in a report, in the order of [`TOPICS`].
const REPORT_RANKS: [usize; COUNT] = {
    let mut ranks = [0; COUNT];
    let mut index = 0;
    while index < COUNT {
        ranks[index] = REPORT_ORDER.len() + index;
        index += 1;
    }
    let mut place = 0;
    while place < REPORT_ORDER.len() {
        ranks[index_of(REPORT_ORDER[place])] = place;
        place += 1;
    }
    ranks
};

/// Returns the place of a topic's rows in a report; `None` stands for a custom topic.
pub(crate) fn report_rank(topic: Option<usize>) -> usize {
    topic.map_or(usize::MAX, |topic| REPORT_RANKS[topic])
}

/// Returns the index of a topic in [`TOPICS`], at compile time.
pub(crate) const fn index_of(name: &str) -> usize {
    let mut index = 0;
    while !same(TOPICS[index].name.as_bytes(), name.as_bytes()) {
        index += 1;
    }
    index
}

const fn same(a: &[u8], b: &[u8]) -> bool {
    let mut i = 0;
    while i < a.len() && i < b.len() && a[i] == b[i] {
        i += 1;
    }
    i == a.len() && i == b.len()
}

/// Returns the label of an enumeration's value, by its identifier in the schema of a log.
pub(crate) fn label_of(identifier: &str) -> String {
    let states = [
        &Lock::LABELS,
        &Onset::LABELS,
        &Gate::LABELS,
        &Use::LABELS,
        &Trust::LABELS,
        &Latch::LABELS,
        &Watch::LABELS,
        &Light::LABELS,
    ];
    let others = [
        &Phase::LABELS,
        &Trigger::LABELS,
        &Sliding::LABELS,
        &ReadingOutcome::LABELS,
        &Decision::LABELS,
        &LogLevel::LABELS,
    ];
    let mut labels = others.iter().chain(&states).flat_map(|field| field.values);
    let label = labels.find(|label| LoggedEnum::identifier(label) == identifier);
    label.map_or_else(|| identifier.to_owned(), |&label| label.to_owned())
}
