//! Source of an exported control system: the translated flight code and the functions that call it.

use super::Plan;
use crate::translate::Translation;

/// Returns the source.
pub fn source(plan: &Plan<'_>, translation: &Translation) -> String {
    let (prefix, version) = (plan.prefix, plan.version());
    format!(
        "/* Control system of {}: see {prefix}.h. */\n\n#include \"{prefix}.h\"\n\n{}\n\nconst char {prefix}_version[{}] = \"{version}\";\n\n{}\n",
        plan.origin.file,
        translation.guards.trim(),
        version.len() + 1,
        translation.definitions.trim()
    )
}
