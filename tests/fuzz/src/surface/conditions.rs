//! Conditions of modes of operation: words of the grammar in any order, deep, long, and beyond their numbers.

use super::Seeds;
use crate::case::Case;
use crate::chance::Chance;
use crate::node::Node;
use crate::{mutate, nasty};

/// Scenarios with modes, and quantities that they have.
const QUANTITIES: &[(&str, &[&str])] = &[
    (
        "safe-mode",
        &[
            "field",
            "field_rate",
            "silent(star_tracker)",
            "silent(sun_sensor)",
            "entries(safe)",
            "momentum",
            "wheel_speed",
        ],
    ),
    (
        "site-pass",
        &[
            "elevation(pass)",
            "truth.elevation(pass)",
            "truth.sunlight",
            "sunlight",
            "entries(rest)",
            "silent(gyro)",
        ],
    ),
    ("cubesat-day", &["silent(star_tracker)", "entries(pass)", "sunlight", "truth.sunlight", "momentum"]),
    ("orbit-correction", &["attitude_error", "rate_error", "truth.run_time"]),
];
/// Quantities that most scenarios have, and some that none has.
const COMMON: &[&str] = &[
    "time",
    "run_time",
    "rate",
    "rate_error",
    "attitude_error",
    "truth.time",
    "truth.run_time",
    "lock_lost",
    "elevation(rest)",
    "nothing",
];
/// Name of a number of a condition.
const NAMED: &str = "slow";
/// Words that stand where a quantity or a number is expected.
const STRAYS: &[&str] = &[
    "",
    "(",
    ")",
    "and",
    "or",
    "not",
    "<",
    "<=",
    "=",
    "== 1",
    "[",
    "silent(",
    "entries()",
    "truth.",
    "\u{202e}",
    "\u{e9}",
    "\\u0000",
    "\\\"",
];
const UNITS: &[&str] = &["", "", "", " s", " deg", " deg/s", " rad/s", " min", " h", " T", " kg", " %"];
const COMMANDS: &[&str] = &[
    "check s.toml",
    "check s.toml",
    "simulate s.toml --log none",
    "simulate s.toml --log full -o out",
    "simulate s.toml --runs 3 -o out",
    "margins s.toml --json",
];

pub fn make(seeds: &Seeds, chance: &mut Chance) -> Case {
    let (name, _) = QUANTITIES[chance.below(QUANTITIES.len())];
    let shipped = seeds.scenarios.iter().find(|(shipped, ..)| shipped == name);
    let mut tree = shipped.map_or_else(|| Node::Table(Vec::new()), |(_, _, tree)| tree.clone());
    *tree.key("duration") = Node::Leaf(chance.one(&["20.0", "60.0"]).to_owned());
    if let Node::Array(modes) = tree.key("mode") {
        let mut leaves: Vec<&mut Node> = modes.iter_mut().flat_map(leaves).collect();
        for _ in 0..chance.times() {
            let place = chance.below(leaves.len());
            if let Some(leave) = leaves.get_mut(place) {
                change(leave, name, chance);
            }
        }
    }
    if chance.percent(8) {
        mutate::tree(tree.key("mode"), &[], chance);
    }
    Case::new(chance.one(COMMANDS), vec![("s.toml".to_owned(), tree.toml().into_bytes())])
}

/// Returns the ends of a mode; none for one that has lost them.
fn leaves(mode: &mut Node) -> &mut [Node] {
    let Node::Table(keys) = mode else { return &mut [] };
    let leave = keys.iter_mut().find(|(key, _)| key == "leave");
    match leave {
        Some((_, Node::Array(leaves))) => leaves,
        _ => &mut [],
    }
}

/// Changes the end of a mode of a scenario.
fn change(leave: &mut Node, name: &str, chance: &mut Chance) {
    let (_, own) = QUANTITIES.iter().find(|(scenario, _)| *scenario == name).unwrap_or(&QUANTITIES[0]);
    let mut text = condition(0, own, chance);
    if chance.percent(20) {
        text = spoilt(text, chance);
    }
    if let Node::Table(keys) = leave {
        // Numbers that a condition does not name are refused.
        keys.retain(|(key, _)| key != "numbers");
    }
    if text.contains(NAMED) {
        let value = if chance.percent(70) { "0.1" } else { nasty::number(chance) };
        *leave.key("numbers").key(NAMED) = Node::Leaf(value.to_owned());
    }
    *leave.key("when") = Node::Leaf(format!("\"{text}\""));
    if chance.percent(15) {
        *leave.key("for") = Node::Leaf(nasty::number(chance).to_owned());
    }
}

/// A condition of the grammar, at most four levels deep.
fn condition(depth: usize, own: &[&str], chance: &mut Chance) -> String {
    let kind = if depth < 4 { chance.below(10) } else { 9 };
    let inner = |chance: &mut Chance| condition(depth + 1, own, chance);
    match kind {
        0 => format!("{} and {}", inner(chance), inner(chance)),
        1 => format!("{} or {}", inner(chance), inner(chance)),
        2 => format!("not {}", inner(chance)),
        3 => format!("({})", inner(chance)),
        _ => {
            let quantity = if chance.percent(85) { chance.one(own) } else { chance.one(COMMON) };
            let sign = chance.one(&["<", ">", "<=", ">="]);
            match chance.below(20) {
                0 => quantity.to_owned(),
                1 => format!("{quantity} {sign} {}", chance.one(own)),
                2 | 3 => format!("{quantity} {sign} {NAMED}"),
                4..9 => format!("{quantity} {sign} {}", nasty::number(chance)),
                9 => format!("{quantity} {sign} 1{}", chance.one(UNITS)),
                _ => format!("{quantity}{sign}{}", chance.one(&["0.1", "5", "1e-3", "0"])),
            }
        }
    }
}

/// A condition with a stray word, a long repetition, or less of it.
fn spoilt(text: String, chance: &mut Chance) -> String {
    let places: Vec<usize> = text.char_indices().map(|(place, _)| place).chain([text.len()]).collect();
    let place = places[chance.below(places.len())];
    let (before, after) = text.split_at(place);
    match chance.below(6) {
        0 => format!("{before} {} {after}", chance.one(STRAYS)),
        1 => before.to_owned(),
        2 => after.to_owned(),
        3 => {
            let (word, times) =
                (chance.one(&["(", "not ", "time > 1 or ", " "]), [30, 33, 100, 5000][chance.below(4)]);
            format!("{}{text}", word.repeat(times))
        }
        4 => format!("{}{text}{}", "(".repeat(32), ")".repeat(32)),
        _ => text,
    }
}
