//! Calls of the functions of FMUs in right and wrong orders, with odd values, and states whose bytes are changed.

use std::fmt::Write as _;
use std::io;

use flexsc_core::Scenario;
use flexsc_cosim::{Causality, FmuContent, FmuPart, FmuRun, ValueKind};

use super::Seeds;
use crate::case::{CALLS, Case};
use crate::chance::Chance;
use crate::{mutate, nasty};

/// Scenarios and the parts of them that are simulated.
const PARTS: [(&str, FmuPart); 5] = [
    ("relay-fixed", FmuPart::Loop),
    ("wheel-fixed-gain", FmuPart::Plant),
    ("wheel-fixed-gain", FmuPart::Controller),
    ("earth-observer", FmuPart::Loop),
    ("earth-observer", FmuPart::Controller),
];
/// Largest number that is set: torques act on bodies of some kg m².
const HEAVIEST: f64 = 1e3;
/// Functions of the instance alone.
const FUNCTIONS: [&str; 11] = [
    "begin",
    "configure",
    "configured",
    "event",
    "stepping",
    "evaluate",
    "update",
    "cancel",
    "terminate",
    "reset",
    "update",
];
/// Members of a serialised state, and values in their place.
const MEMBERS: [&str; 12] = [
    "\"keys\":[",
    "\"seed\":",
    "\"grid_ns\":",
    "\"stop_time\":",
    "\"inputs\":[",
    "\"applied\":[",
    "\"reached\":",
    "\"whole\":",
    "\"part\":",
    "\"is_complete\":",
    "\"events\":",
    "\"token\":",
];

/// Content of an FMU, and its variables: reference, letter of the kind, and true if it can be set.
pub struct Fmu {
    content: FmuContent,
    variables: Vec<(u32, &'static str, bool)>,
}

/// FMUs of short scenarios.
pub fn seeds(seeds: &Seeds) -> io::Result<Vec<Fmu>> {
    let found = PARTS.into_iter().filter_map(|(name, part)| {
        let (_, text, _) = seeds.scenarios.iter().find(|(shipped, ..)| shipped == name)?;
        Some(fmu(text, part))
    });
    found.collect::<Result<_, _>>().map_err(io::Error::other)
}

fn fmu(text: &str, part: FmuPart) -> Result<Fmu, Box<dyn std::error::Error + Send + Sync>> {
    let lines = text.lines().map(|line| if line.starts_with("duration") { "duration = 20.0" } else { line });
    let scenario = Scenario::parse("s.toml", &lines.collect::<Vec<_>>().join("\n"))?;
    let content = FmuContent::new(&scenario, part)?;
    let run = FmuRun::new(content.clone())?;
    let variables = run.table().variables().iter().map(|variable| {
        let kind = match variable.kind {
            ValueKind::Float => "f",
            ValueKind::Clock(_) => "c",
            ValueKind::Structural => "u",
            ValueKind::Integer => "i",
        };
        (variable.reference, kind, !matches!(variable.causality, Causality::Output | Causality::Independent))
    });
    Ok(Fmu { variables: variables.collect(), content })
}

pub fn make(fmus: &[Fmu], chance: &mut Chance) -> Case {
    let fmu = &fmus[chance.below(fmus.len())];
    let mut calls = format!("new {} {}\n", [3, 3, 2][chance.below(3)], chance.below(2));
    if chance.percent(85) {
        for _ in 0..chance.below(4) {
            set(fmu, &mut calls, chance);
        }
        let stop = chance.one(&["-", "-", "20", "40", "5e-324", "1e300", "nan"]);
        let _ = writeln!(
            calls,
            "initialize {stop}\nbegin\n{}",
            chance.one(&["stepping", "update\nstepping", ""])
        );
    }
    for _ in 0..chance.below(60) {
        call(fmu, &mut calls, chance);
    }
    let mut toml = fmu.content.toml.clone();
    if chance.percent(5) {
        mutate::number(&mut toml, chance);
    }
    let part = fmu.content.part.name();
    Case::new(
        &format!("export-fmu resources/scenario.toml --part {part} -o m.fmu"),
        vec![
            ("resources/scenario.toml".to_owned(), toml.into_bytes()),
            ("resources/part.txt".to_owned(), part.into()),
            (CALLS.to_owned(), calls.into_bytes()),
        ],
    )
}

fn call(fmu: &Fmu, calls: &mut String, chance: &mut Chance) {
    let slot = chance.below(4);
    let _ = match chance.below(24) {
        0..8 => {
            let from = if chance.percent(90) { "now" } else { nasty::number(chance) };
            let size = if chance.percent(90) {
                chance.one(&["0.1", "0.25", "0.37", "1", "0"])
            } else {
                nasty::number(chance)
            };
            writeln!(calls, "step {from} {size}\n{}", chance.one(&["", "", "event\nupdate\nstepping"]))
        }
        8..11 => {
            let (reference, kind, _) = variable(fmu, chance);
            let kind = if chance.percent(85) { kind } else { chance.one(&["f", "i", "c", "q", "u", "null"]) };
            writeln!(calls, "get {kind} {reference} {}", [1, 1, 1, 0, 3, 4096][chance.below(6)])
        }
        11..14 => {
            set(fmu, calls, chance);
            Ok(())
        }
        14 | 15 => writeln!(calls, "save {slot}"),
        16 => writeln!(calls, "load {slot}"),
        17 => writeln!(calls, "again {slot}"),
        18 => writeln!(calls, "free {slot}"),
        19 => writeln!(calls, "save {slot}\nwrite {slot}\nread {}", chance.below(4)),
        20 => {
            let edit = edit(chance);
            writeln!(calls, "save {slot}\nwrite {slot}\n{edit}\nread {slot}\nload {slot}\nstep now 0.1")
        }
        21 if chance.percent(20) => writeln!(calls, "new {} 1", [2, 3][chance.below(2)]),
        _ => writeln!(calls, "{}", chance.one(&FUNCTIONS)),
    };
}

/// A change of the bytes of a state.
fn edit(chance: &mut Chance) -> String {
    let member = chance.one(&MEMBERS);
    match chance.below(6) {
        0 => format!("edit {member}"),
        1 => {
            // The number of the mode before the journal.
            let mode = char::from(chance.below(8) as u8);
            format!("edit {}{{ {mode}{{", char::from(chance.below(6) as u8))
        }
        2 => format!("edit [ {}", "[".repeat([1, 100, 5000][chance.below(3)])),
        _ => {
            let whole = nasty::whole(chance, 0);
            let value = match chance.below(5) {
                0 => chance.one(&["null", "true", "false", "\"a\"", "{}", "-1", "1.5", "[[0,0]]"]).to_owned(),
                1 => 1e300_f64.to_bits().to_string(),
                _ => whole.to_string(),
            };
            format!("put {member} {value}")
        }
    }
}

fn variable<'a>(fmu: &'a Fmu, chance: &mut Chance) -> (u32, &'a str, bool) {
    if chance.percent(5) {
        return (nasty::whole(chance, 0) as u32, "f", true);
    }
    fmu.variables[chance.below(fmu.variables.len())]
}

/// Sets a variable, most often one that can be set.
fn set(fmu: &Fmu, calls: &mut String, chance: &mut Chance) {
    let mut found = variable(fmu, chance);
    for _ in 0..8 {
        if found.2 {
            break;
        }
        found = variable(fmu, chance);
    }
    let (reference, kind, _) = found;
    let mut value =
        if chance.percent(60) { chance.one(&["0.1", "1", "0", "1e-3"]) } else { nasty::number(chance) };
    // A torque of 1e20 N m makes a body turn so fast that a step takes hours, which an importer has asked for.
    if kind == "f" && value.parse().is_ok_and(|number: f64| number.is_finite() && number.abs() > HEAVIEST) {
        value = "100";
    }
    let _ = writeln!(calls, "set {kind} {reference} {value}");
}
