//! Tables of the points of a sweep: other keys, numbers, lines and bytes.

use super::structures;
use crate::case::Case;
use crate::chance::Chance;
use crate::nasty;

const SCENARIO: &str = include_str!("../../../../scenarios/relay-fixed.toml");
const TABLE: &str = "law.relay.k_t,seed\n0.30,1\n0.31,2\n0.32,3\n";
const KEYS: &[&str] = &[
    "law.relay.k_t",
    "law.relay.k_t",
    "law.relay.k_t",
    "seed",
    "duration",
    "name",
    "body.planar.modes[0].frequency",
    "body.planar.modes[9].gain",
    "body.planar.modes[0]",
    "law.relay",
    "uncertain",
    "",
    "a b",
    "\"law.relay.k_t\"",
    "\u{e9}",
    "\u{1b}[31m",
];
/// Keys that a table can have beside each other.
const RIGHT: [&str; 3] = ["law.relay.k_t", "body.planar.rate", "body.planar.angle"];
const CELLS: &[&str] = &[
    "0.31",
    "0.31",
    "0.31",
    "",
    "x",
    "\"0,3\"",
    "'0.3'",
    "true",
    "[1, 2]",
    "0.30 ",
    "0x1",
    "1_0",
    "{ a = 1 }",
    "1;2",
];
const OPTIONS: &[&str] = &[
    "",
    "",
    "",
    "--replicas 2",
    "--replicas 0",
    "--replicas 18446744073709551615",
    "--sample sobol:8",
    "--sample random:0",
    "--sample latin-hypercube:3",
    "--vary duration=1:50:2",
    "--runs 0:2",
    "--uncertain",
];

pub fn make(chance: &mut Chance) -> Case {
    let table =
        if chance.percent(40) { structures::spoilt(TABLE, chance) } else { table(chance).into_bytes() };
    let out = chance.one(&["-o out", "-o out.csv", "--json"]);
    let command = format!("sweep s.toml --points p.csv --set duration=50 {out} {}", chance.one(OPTIONS));
    Case::new(&command, vec![("s.toml".to_owned(), SCENARIO.into()), ("p.csv".to_owned(), table)])
}

/// A table of several keys, with a cell too few or too many at times.
fn table(chance: &mut Chance) -> String {
    let columns = [1, 1, 2, 3, 3, 50][chance.below(6)];
    let end = chance.one(&["\n", "\n", "\n", "\r\n", "\r", "\n\n", "\n#c\n"]);
    let row = |count: usize, cell: &mut dyn FnMut() -> String| {
        (0..count).map(|_| cell()).collect::<Vec<_>>().join(",")
    };
    // Odd keys, or odd cells, or none of them.
    let (keys, cells) = ([0, 0, 30][chance.below(3)], [0, 0, 2, 20][chance.below(4)]);
    let mut text = chance.one(&["", "", "", "", "\u{feff}"]).to_owned();
    let mut place = 0;
    text += &row(columns, &mut || {
        place += 1;
        let right = RIGHT[(place - 1) % RIGHT.len()];
        if chance.percent(keys) { chance.one(KEYS).to_owned() } else { right.to_owned() }
    });
    for _ in 0..[0, 1, 3, 20, 600][chance.below(5)] {
        text += end;
        let count = if chance.percent(99) { columns } else { columns + 1 };
        text += &row(count, &mut || match chance.below(100) {
            odd if odd >= cells => chance.one(&["0.31", "0.32", "1e-5"]).to_owned(),
            odd if odd % 2 == 0 => chance.one(CELLS).to_owned(),
            _ => nasty::number(chance).to_owned(),
        });
    }
    text + end
}
