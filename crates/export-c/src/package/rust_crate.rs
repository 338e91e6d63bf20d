//! Exported control system as a crate: the module that is translated to C, and the flight code that it needs.

use std::collections::BTreeSet;
use std::fmt::Write as _;

use super::{ExportError, ExportOrigin, Package, PackageFile, Plan, Prepared, accuracy, static_files, text};
use crate::control_system::{CallLayout, Channel, NumberKind};
use crate::flight_sources::sources_in;
use crate::glue::camel;
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
    let replay = include_str!("files/rust/replay.rs");
    let real = if plan.precision.is_double() { "f64" } else { "f32" };
    let init = if plan.inits_at_time() { "&mut state, Ticks { whole: 0, part: 0 }" } else { "&mut state" };
    let replay = replay.replace("NAME", name).replace("REAL", real).replace("INIT", init);
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
        text("tests/replay.rs".to_owned(), replay.replace("CALLS", &calls(&plan))),
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

/// Returns the files of the flight code that a text needs, directly or by others.
fn needed_modules<'a>(sources: &[SourceFile<'a>], text: &str) -> Vec<SourceFile<'a>> {
    let mut found = BTreeSet::new();
    let mut texts = vec![text];
    while let Some(text) = texts.pop() {
        for path in text.split("crate::").skip(1) {
            let end = path.find(|letter: char| !letter.is_ascii_alphanumeric() && letter != '_');
            let name = &path[..end.unwrap_or(path.len())];
            if let Some(source) = sources.iter().find(|source| source.module == name)
                && found.insert(source.module)
            {
                texts.push(without_tests(source));
            }
        }
    }
    sources.iter().filter(|source| found.contains(source.module)).copied().collect()
}

fn manifest(plan: &Plan<'_>) -> String {
    format!(
        "[package]\nname = \"{}\"\nversion = \"0.1.0\"\nedition = \"2024\"\nrust-version = \"1.89\"\nlicense = \"MIT OR Apache-2.0\"\n\
         description = \"Control system of {}, exported by flexsc {}\"\npublish = false\n\n[lib]\ndoctest = false\n\n\
         # A workspace of its own, wherever the directory is.\n[workspace]\n",
        plan.prefix,
        plan.origin.file,
        env!("CARGO_PKG_VERSION")
    )
}

fn library(plan: &Plan<'_>, needed: &[SourceFile<'_>]) -> String {
    let mut modules: Vec<&str> = needed.iter().map(|own| own.module).chain(["control_system"]).collect();
    modules.sort_unstable();
    let modules: String = modules.iter().map(|name| format!("pub mod {name};\n")).collect();
    format!(
        "//! Control system of {}, exported by flexsc {}: see README.md.\n\n#![no_std]\n#![forbid(unsafe_code)]\n\
         #![allow(clippy::all, reason = \"the text is that of flexsc, where it is checked\")]\n\n{modules}\n\
         /// Version: the exporter, and the SHA-256 of the scenario in `scenario.toml`.\npub const VERSION: &str = \"{}\";\n",
        plan.origin.file,
        env!("CARGO_PKG_VERSION"),
        plan.version()
    )
}

/// Returns the arms of the test that call each function.
fn calls(plan: &Plan<'_>) -> String {
    let mut text = String::new();
    for (index, layout) in plan.calls.iter().enumerate() {
        let CallLayout { name, inputs, outputs, .. } = layout;
        let (kind, now) = (camel(name), if plan.has_time() { "_now, " } else { "" });
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

/// Returns a member of the inputs that is read from the file.
fn input(channel: &Channel) -> String {
    let read = match channel.kind {
        NumberKind::Real => "words.real()",
        NumberKind::Flag => "words.flag()",
        NumberKind::Integer(_) => "words.integer()",
    };
    let name = &channel.name;
    if channel.count == 1 {
        format!("{name}: {read}")
    } else {
        format!("{name}: std::array::from_fn(|_| {read})")
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
