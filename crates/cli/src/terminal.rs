//! Whether a terminal takes escape sequences.

use std::env::var_os;

/// Whether none are wanted: `NO_COLOR` is set, or the terminal shows them as they are (`TERM=dumb`).
pub fn is_plain() -> bool {
    is_set("NO_COLOR") || is_dumb()
}

/// Keeps colours from a terminal that shows escape sequences as they are, unless `CLICOLOR_FORCE` asks for them.
///
/// Where `CI` is set, `anstream` colours every terminal.
pub fn settle_colours() {
    if is_dumb() && !is_set("CLICOLOR_FORCE") {
        anstream::ColorChoice::Never.write_global();
    }
}

fn is_dumb() -> bool {
    var_os("TERM").is_some_and(|terminal| terminal == "dumb")
}

fn is_set(name: &str) -> bool {
    var_os(name).is_some_and(|value| !value.is_empty())
}
