//! Exported control system as a crate: the module that is translated to C, and the flight code that it needs.

use std::collections::BTreeSet;
use std::fmt::Write as _;

use super::{ExportError, ExportOrigin, Package, PackageFile, Plan, Prepared, accuracy, static_files, text};
use crate::control_system::{CallLayout, Channel, NumberKind};
use crate::flight_sources::sources_in;
use crate::glue::camel;
use crate::self_test::{BLOCK, EXTREME_BLOCK, SEED, cycle_milliseconds, extremes, self_test};
use crate::translate::SourceFile;
use crate::vectors;
use flexsc_core::Scenario;

/// Exports the control system of a scenario as a crate with this name, and at most `most` vectors of its run.
///
/// # Errors
/// An [`ExportError`] if a part of the control system has no plain code, or if its run fails.
pub fn export_rust(
    scenario: &Scenario,
    origin: ExportOrigin<'_>,
    name: &str,
    most: usize,
) -> Result<Package, ExportError> {
    let prepared = Prepared::new(scenario, most)?;
    let plan = prepared.plan(origin, name);
    let accuracy = accuracy::output_accuracies(scenario, &prepared.vectors)
        .map_err(|fault| ExportError::Vectors(fault.into()))?;
    let sources = sources_in(plan.precision);
    let module = plan.module();
    let needed = needed_modules(&sources, &module.text);
    let mut files: Vec<PackageFile> =
        needed.iter().map(|own| text(format!("src/{}.rs", own.module), flight_file(own))).collect();
    files.extend([
        text("Cargo.toml".to_owned(), manifest(&plan)),
        text("README.md".to_owned(), static_files::readme_of_crate(&plan, prepared.vectors.len(), &accuracy)),
        text("scenario.toml".to_owned(), prepared.effective.clone()),
        text(
            "src/control_system.rs".to_owned(),
            format!(
                "{}\nimpl State {{\n    /// State before `init`.\n    pub const UNSET: Self = {};\n}}\n",
                module.text, module.state
            ),
        ),
        text("src/lib.rs".to_owned(), library(&plan, &needed)),
        text("tests/replay.rs".to_owned(), replay(&plan)),
        PackageFile { path: "vectors.bin".to_owned(), bytes: vectors::to_bytes(&prepared.vectors) },
    ]);
    files.sort_by(|a, b| a.path.cmp(&b.path));
    let Prepared { calls, vectors, excluded_parts, .. } = prepared;
    Ok(Package { files, calls, vectors: vectors.len(), excluded_parts, accuracy })
}

/// Returns the text of a file of the flight code without its tests.
fn without_tests<'a>(file: &SourceFile<'a>) -> &'a str {
    file.text.split("\n#[cfg(test)]").next().unwrap_or_default()
}

/// Returns a file of the flight code with its licence.
fn flight_file(file: &SourceFile<'_>) -> String {
    format!(
        "// SPDX-License-Identifier: MIT OR Apache-2.0\n// {} of flexsc {}\n\n{}\n",
        file.path,
        env!("CARGO_PKG_VERSION"),
        without_tests(file).trim_end()
    )
}

/// Returns the files of the flight code that a text needs, directly or by others: those that it names, and those with methods of their
/// types.
fn needed_modules<'a>(sources: &[SourceFile<'a>], text: &str) -> Vec<SourceFile<'a>> {
    let mut found = BTreeSet::new();
    let mut texts = vec![text];
    while let Some(text) = texts.pop() {
        let names = text.split("crate::").skip(1).map(first_name);
        let types = ["\npub struct ", "\npub enum "]
            .into_iter()
            .flat_map(|kind| text.split(kind).skip(1))
            .map(first_name);
        let named = names.filter_map(|name| sources.iter().find(|source| source.module == name));
        let methods = types.flat_map(|name| {
            sources.iter().filter(move |own| own.text.contains(&format!("\nimpl {name} {{")))
        });
        for source in named.chain(methods).collect::<Vec<_>>() {
            if found.insert(source.module) {
                texts.push(without_tests(source));
            }
        }
    }
    sources.iter().filter(|source| found.contains(source.module)).copied().collect()
}

/// Returns the name at the start of a text.
fn first_name(text: &str) -> &str {
    let end = text.find(|letter: char| !letter.is_ascii_alphanumeric() && letter != '_');
    &text[..end.unwrap_or(text.len())]
}

fn manifest(plan: &Plan<'_>) -> String {
    format!(
        "[package]\nname = \"{}\"\nversion = \"0.1.0\"\nedition = \"2024\"\nrust-version = \"1.89\"\nlicense = \"MIT OR Apache-2.0\"\n\
         description = \"Control system, exported by flexsc {}\"\npublish = false\n\n[lib]\ntest = false\ndoctest = false\n\n\
         # A workspace of its own, wherever the directory is.\n[workspace]\n",
        plan.prefix,
        env!("CARGO_PKG_VERSION")
    )
}

fn library(plan: &Plan<'_>, needed: &[SourceFile<'_>]) -> String {
    let mut modules: Vec<&str> = needed.iter().map(|own| own.module).chain(["control_system"]).collect();
    modules.sort_unstable();
    let modules: String = modules.iter().flat_map(|name| ["pub mod ", name, ";\n"]).collect();
    format!(
        "//! Control system of {}, exported by flexsc {}: see README.md.\n\n#![no_std]\n#![forbid(unsafe_code)]\n\
         #![allow(clippy::all, reason = \"the text is that of flexsc, where it is checked\")]\n\n{modules}\n\
         /// Version: the exporter, and the SHA-256 of the scenario in `scenario.toml`.\npub const VERSION: &str = \"{}\";\n",
        plan.origin.file,
        env!("CARGO_PKG_VERSION"),
        plan.version()
    )
}

/// Cycles of the test with random inputs: the last of its blocks has extreme ones.
const CYCLES: u64 = BLOCK * EXTREME_BLOCK;

/// Returns the test that replays the vectors, and repeats the self-test.
fn replay(plan: &Plan<'_>) -> String {
    let list = |items: Vec<String>| items.join(", ");
    let time = "Ticks { whole: _time[0], part: _time[1] }";
    let init = if plan.inits_at_time() { format!("init(state, {time})") } else { "init(state)".to_owned() };
    let ticks = if plan.has_time() { format!("use {}::ticks::Ticks;\n", plan.prefix) } else { String::new() };
    let extremes = extremes(plan.precision).iter().map(|word| format!("0x{word:016x}")).collect();
    let named = [
        ("NAME", plan.prefix.to_owned()),
        ("REAL", if plan.precision.is_double() { "f64" } else { "f32" }.to_owned()),
        ("TICKS", ticks),
        ("COUNT", plan.calls.len().to_string()),
        ("STARTS", list(plan.calls.iter().map(|call| call.is_start.to_string()).collect())),
        ("EXTREME_WORDS", list(extremes)),
        ("INIT", init),
        ("CALLS", calls(plan, time)),
        ("SEED", format!("0x{SEED:016x}")),
        ("CYCLES_u64", format!("{CYCLES}_u64")),
        ("MILLISECONDS", cycle_milliseconds(plan.system).to_string()),
        ("BLOCK", BLOCK.to_string()),
        ("EXTREME ", format!("{EXTREME_BLOCK} ")),
        ("HASH", format!("0x{:016x}", self_test(plan.system, CYCLES))),
    ];
    let template = include_str!("files/rust/replay.rs").to_owned();
    named.iter().fold(template, |text, (name, value)| text.replace(name, value))
}

/// Returns the arms of the test that call each function.
fn calls(plan: &Plan<'_>, time: &str) -> String {
    let mut text = String::new();
    for (index, layout) in plan.calls.iter().enumerate() {
        let CallLayout { name, inputs, outputs, .. } = layout;
        let (kind, now) = (camel(name), if plan.has_time() { format!("{time}, ") } else { String::new() });
        let mut given: Vec<String> = inputs.iter().map(input).collect();
        if given.is_empty() {
            given.push("unused: false".to_owned());
        }
        let _ = write!(
            text,
            "        {index} => {{\n            let input = {kind}Input {{ {} }};\n            let mut output = {kind}Output::ZERO;\n            {name}(state, {now}&input, &mut output);\n",
            given.join(", ")
        );
        for channel in outputs {
            let _ = writeln!(text, "            {}", output(channel));
        }
        text.push_str("        }\n");
    }
    text
}

/// Returns a member of the inputs with its next value.
fn input(channel: &Channel) -> String {
    let Channel { name, count, scale, is_unit, .. } = channel;
    let plural = if *count == 1 { "" } else { "s" };
    match channel.kind {
        NumberKind::Real if *is_unit => format!("{name}: from.units({scale:?})"),
        NumberKind::Real => format!("{name}: from.real{plural}({scale:?})"),
        NumberKind::Flag => format!("{name}: from.flag{plural}()"),
        NumberKind::Integer(below) => format!("{name}: from.integer({})", below.max(1)),
    }
}

/// Returns the statement that adds the words of an output.
fn output(channel: &Channel) -> String {
    let name = &channel.name;
    let word = |value: &str| match channel.kind {
        NumberKind::Real => format!("bits({value})"),
        NumberKind::Flag => format!("u64::from({value})"),
        NumberKind::Integer(_) => format!("{value} as u64"),
    };
    if channel.count == 1 {
        format!("found.push((\"{name}\", {}));", word(&format!("output.{name}")))
    } else {
        format!("found.extend(output.{name}.map(|value| (\"{name}\", {})));", word("value"))
    }
}
