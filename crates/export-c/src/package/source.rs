//! Source of an exported control system: the translated flight code, and the functions that call it.

use std::fmt::Write as _;

use super::{Plan, parameters, start_values};
use crate::translate::Translation;

/// Returns the source: the translated flight code, and the exported functions that call it.
pub fn source(plan: &Plan<'_>, translation: &Translation, functions: &str) -> String {
    let mut text = String::new();
    let _ = writeln!(
        text,
        "/* Control system of {}: see {}.h. */\n\n#include \"{}.h\"\n",
        plan.origin.file, plan.prefix, plan.prefix
    );
    text.push_str(translation.guards.trim());
    text.push_str("\n\n");
    text.push_str(translation.definitions.trim());
    text.push_str("\n\n");
    let _ = writeln!(
        text,
        "const char {}_version[{}] = \"{}\";\n",
        plan.prefix,
        plan.version().len() + 1,
        plan.version()
    );
    parameters::defaults(plan, &mut text);
    start_values::definition(plan, &mut text);
    text.push_str(functions);
    text
}
