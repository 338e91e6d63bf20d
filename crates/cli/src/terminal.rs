//! Support of escape sequences by the terminal.

use std::env::var_os;

/// Returns true if escape sequences are unwanted: `NO_COLOR` is set, or the terminal prints them (`TERM=dumb`).
pub fn is_plain() -> bool {
    is_set("NO_COLOR") || is_dumb()
}

/// Disables colours on a terminal that prints escape sequences, unless `CLICOLOR_FORCE` is set.
///
/// `anstream` colours every terminal if `CI` is set.
pub fn configure_colours() {
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
