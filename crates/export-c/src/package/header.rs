//! Header of an exported control system: types, structs of inputs and outputs, and the functions.

use std::fmt::Write as _;

use super::Plan;
use crate::translate::Translation;

/// Returns the header file: the types of the flight code, the state of the control system, and its functions.
pub fn header(plan: &Plan<'_>, translation: &Translation) -> String {
    let prefix = plan.prefix;
    let guard = format!("{}_H", prefix.to_uppercase());
    let mut text = format!(
        "/* Control system of {}, exported by flexsc {}.\n *\n * The code is translated from the Rust code that flexsc calls in a \
         run, and returns the same bits\n * if it is compiled as the Makefile does: IEEE 754 {}, no contraction, no fast-math. \
         Units are SI.\n{}\n *\n{}\n */\n#ifndef {guard}\n#define {guard}\n\n",
        plan.origin.file,
        env!("CARGO_PKG_VERSION"),
        plan.numbers(),
        excluded_parts(plan),
        trace(plan)
    );
    text.push_str(translation.includes.trim());
    text.push_str("\n\n");
    text.push_str(translation.declarations.trim());
    text.push_str("\n\n");
    let _ = writeln!(
        text,
        "/* Version: the exporter, and the SHA-256 of the scenario in `scenario.toml`. */\nextern const char {prefix}_version[{}];\n",
        plan.version().len() + 1
    );
    text.push_str(&translation.prototypes);
    let _ = writeln!(text, "#endif");
    text
}

/// Returns the lines of a comment by which the export can be traced.
fn trace(plan: &Plan<'_>) -> String {
    let changes = plan
        .origin
        .changes
        .iter()
        .map(|change| format!("\n *   changed: {change}"))
        .collect::<Vec<_>>()
        .concat();
    format!(
        " * Scenario with all defaults: scenario.toml, SHA-256\n * {}.{changes}\n * The translated functions are part of flexsc: SPDX-License-Identifier: MIT OR Apache-2.0.",
        plan.digest
    )
}

/// Returns the lines of a comment that list the parts of the control loop that are not in the code, and its inputs from elsewhere.
fn excluded_parts(plan: &Plan<'_>) -> String {
    let list = |is_supplied: bool| -> String {
        let parts = plan.excluded_parts.iter().filter(|part| part.is_supplied == is_supplied);
        parts.fold(String::new(), |all, part| all + &format!("\n *   {}: {}", part.key, part.duty))
    };
    let (left_out, supplied) = (list(false), list(true));
    let mut text = if left_out.is_empty() {
        " *\n * Every part of the scenario's control loop is in this code.".to_owned()
    } else {
        format!(" *\n * Not part of this code; the caller must:{left_out}")
    };
    if !supplied.is_empty() {
        let _ = write!(text, "\n * Inputs from guidance and ephemerides; the caller must:{supplied}");
    }
    text
}
