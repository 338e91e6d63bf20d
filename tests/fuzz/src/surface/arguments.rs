//! Arguments: every command with options it has, and values that it may not expect.

use clap::{Arg, Command};

use super::{Seeds, scenarios};
use crate::case::Case;
use crate::chance::Chance;
use crate::nasty;

/// Values of options, beside numbers.
const VALUES: &[&str] = &[
    "law.relay.k_t=0.34",
    "duration=5",
    "duration=1e18",
    "duration=nan",
    "seed=1:3:3",
    "body.planar.rate=0:1:4",
    "=",
    "a=",
    "=1",
    "a.b.c=1",
    "log.period=1e-12",
    "name=\"x\"",
    "body.planar.modes[0].gain=1",
    "body.planar.modes[9].gain=1",
    "law={}",
    "law.relay=1",
    "0:3",
    "3:0",
    "0:18446744073709551615",
    "5",
    "18446744073709551614:18446744073709551615",
    "1000000000000",
    "0.05:0.5:4",
    "0.05:0.5:100000000000",
    "0.5:0.5:1",
    "1:0:3",
    "nan:inf:3",
    "0:0:0",
    "-1:1:3",
    "1e-300:1e300:3",
    "max",
    "none",
    "events",
    "full",
    "scene",
    "svg",
    "png",
    "both",
    "settling_time_s",
    "settling_time_s,settled",
    "phase-plane",
    "torque,angle",
    "x.svg",
    "x.png",
    "out",
    "out/deep/er",
    "s.toml",
    "/attitude",
    "/command",
    "127.0.0.1:0",
    "localhost:0",
    "256.0.0.1:1",
    "",
    " ",
    "-",
    "--",
    "\u{1f680}",
    "%s",
    "1,2,3",
    "true",
    "bash",
    "zsh",
];
/// Paths to read from or write to, all within the directory where the command runs: the command may be root's.
const PATHS: &[&str] = &[
    "s.toml",
    "t.toml",
    "l.mcap",
    "c",
    "c/runs.csv",
    "out",
    "out/a.svg",
    "none",
    "x.svg",
    "x.json",
    "/dev/null/x",
    "s.toml/x",
    ".",
    "",
];

pub fn make(logs: &[Vec<u8>], seeds: &Seeds, chance: &mut Chance) -> Case {
    let mut program = flexsc_cli::command();
    program.build();
    // A server waits for a client: the surface of packets has one.
    let verbs: Vec<&Command> = program.get_subcommands().filter(|verb| verb.get_name() != "serve").collect();
    let verb = verbs[chance.below(verbs.len())];
    let mut arguments = vec![verb.get_name().to_owned()];
    let mut command = verb;
    let inner: Vec<&Command> = verb.get_subcommands().filter(|c| c.get_name() != "help").collect();
    if !inner.is_empty() && chance.percent(95) {
        command = inner[chance.below(inner.len())];
        arguments.push(command.get_name().to_owned());
    }
    for argument in command.get_arguments().filter(|a| a.is_positional()) {
        if chance.percent(93) {
            arguments.push(positional(verb.get_name(), argument, chance));
        }
    }
    let options: Vec<&Arg> = command.get_arguments().filter(|a| !a.is_positional()).collect();
    for argument in &options {
        if argument.is_required_set() && chance.percent(90) || chance.percent(15) {
            option(argument, &mut arguments, chance);
        }
    }
    if chance.percent(8) {
        let place = 1 + chance.below(arguments.len());
        let stray = chance.one(&["--", "-", "-h", "--help", "--version", "--x", "-zzz", "--set", "a=b", ""]);
        arguments.insert(place.min(arguments.len()), stray.to_owned());
    }
    let changed = chance.percent(15);
    let files = vec![
        ("s.toml".to_owned(), if changed { scenarios::text(seeds, chance) } else { shipped(seeds, chance) }),
        ("t.toml".to_owned(), shipped(seeds, chance)),
        ("l.mcap".to_owned(), logs[chance.below(logs.len())].clone()),
        ("c/runs.csv".to_owned(), b"run,seed,settled,settling_time_s\n0,1,true,3\n1,2,true,4\n".to_vec()),
        ("c/scenario.toml".to_owned(), shipped(seeds, chance)),
    ];
    Case { arguments, files }
}

/// A shipped scenario; most are made short.
fn shipped(seeds: &Seeds, chance: &mut Chance) -> Vec<u8> {
    let (_, text, _) = &seeds.scenarios[chance.below(seeds.scenarios.len())];
    let short = chance.percent(80);
    let lines =
        text.lines().map(|line| if short && line.starts_with("duration") { "duration = 20.0" } else { line });
    lines.collect::<Vec<_>>().join("\n").into_bytes()
}

fn positional(verb: &str, argument: &Arg, chance: &mut Chance) -> String {
    let values = argument.get_possible_values();
    if !values.is_empty() {
        return values[chance.below(values.len())].get_name().to_owned();
    }
    if chance.percent(20) {
        return chance.one(PATHS).to_owned();
    }
    match verb {
        "export" | "log" => "l.mcap",
        "plot" => chance.one(&["l.mcap", "c"]),
        "layout" => chance.one(&["l.mcap", "s.toml"]),
        _ => "s.toml",
    }
    .to_owned()
}

fn option(argument: &Arg, arguments: &mut Vec<String>, chance: &mut Chance) {
    let Some(name) = argument.get_long() else { return };
    // Live runs take any free port of this machine.
    if name == "live" {
        return arguments.push("--live=127.0.0.1:0".to_owned());
    }
    arguments.push(format!("--{name}"));
    if !argument.get_action().takes_values() || chance.percent(2) {
        return;
    }
    let values = argument.get_possible_values();
    let kind = argument.get_value_names().and_then(|names| names.first()).map_or("", |name| name);
    let value = match chance.below(10) {
        0..7 if !values.is_empty() => values[chance.below(values.len())].get_name().to_owned(),
        0..7 if kind.contains("DIR") || kind.contains("FILE") => chance.one(PATHS).to_owned(),
        0..4 if kind.contains("KEY=START") => chance
            .one(&["seed=1:3:3", "duration=1:2:2", "law.relay.k_t=0.3:0.4:3", "log.period=1:1e-30:3"])
            .to_owned(),
        0..4 if kind.contains("LO:HI:COUNT") => {
            chance.one(&["0.1:1:3", "0.05:0.5:5", "1:2:1000000", "0:1:2"]).to_owned()
        }
        0..4 if kind.contains("KEY=") => format!(
            "{}={}",
            chance.one(&["duration", "seed", "log.period", "law.relay.k_t", "epoch"]),
            nasty::leaf(chance)
        ),
        0..7 => nasty::number(chance).to_owned(),
        _ => chance.one(VALUES).to_owned(),
    };
    let names_file = kind.contains("DIR") || kind.contains("FILE") || kind == "PATH";
    arguments.push(tame(value, names_file || name == "docs"));
}

/// Confines output paths to the directory where the command runs.
fn tame(value: String, names_file: bool) -> String {
    let leaves =
        value.contains("..") || names_file && value.starts_with('/') && !value.starts_with("/dev/null/");
    if leaves { "out".to_owned() } else { value }
}
