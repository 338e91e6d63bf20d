//! Scenario files: those that are shipped, changed as trees and as text.

use super::Seeds;
use crate::case::Case;
use crate::chance::Chance;
use crate::mutate;
use crate::node::Node;

/// Commands that are run with the scenarios.
const COMMANDS: &[&str] = &[
    "check s.toml",
    "check s.toml",
    "check s.toml",
    "simulate s.toml --log none",
    "simulate s.toml --log none --json",
    "simulate s.toml -o out",
    "simulate s.toml --log full -o out",
    "simulate s.toml --log scene",
    "simulate s.toml --runs 4 -o out",
    "simulate s.toml --runs 3 --log events --json",
    "sweep s.toml --set seed=1:3:3 -o out",
    "modes s.toml",
    "modes s.toml --json",
    "cycle s.toml",
    "plan s.toml",
    "plan s.toml --compare",
    "tune s.toml",
    "map s.toml --frequency 0.05:0.5:4 --period 0.1:2:3",
    "damping s.toml",
    "identify s.toml --runs 3",
    "observer s.toml",
    "layout s.toml -o l.json",
];

pub fn make(seeds: &Seeds, chance: &mut Chance) -> Case {
    let text = text(seeds, chance);
    Case::new(chance.one(COMMANDS), vec![("s.toml".to_owned(), text)])
}

/// A scenario that is no longer right.
pub fn text(seeds: &Seeds, chance: &mut Chance) -> Vec<u8> {
    let (_, text, tree) = &seeds.scenarios[chance.below(seeds.scenarios.len())];
    match chance.below(10) {
        0..6 => {
            let mut tree = tree.clone();
            // Most runs are short, so that there are many.
            if chance.percent(85) {
                *tree.key("duration") = Node::Leaf(chance.one(&["20.0", "2.0", "100.0"]).to_owned());
            }
            for _ in 0..chance.times() {
                mutate::tree(&mut tree, &seeds.trees, chance);
            }
            tree.toml().into_bytes()
        }
        6..8 => {
            let mut text = text.clone();
            for _ in 0..chance.times() {
                mutate::number(&mut text, chance);
            }
            text.into_bytes()
        }
        _ => {
            let mut text = text.clone().into_bytes();
            for _ in 0..chance.times() {
                mutate::bytes(&mut text, chance);
            }
            text
        }
    }
}
