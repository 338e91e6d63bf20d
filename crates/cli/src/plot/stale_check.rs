//! Comparison of a log with the current state of the scenario file beside it.

use std::io::Write;
use std::path::Path;

use flexsc_core::Scenario;
use flexsc_core::record::{Log, difference};

use crate::say;

/// Warns if the scenario file beside a log has changed since, or is no longer valid.
pub fn warn_if_stale(log: &Log, path: &Path) {
    let file = path.with_extension("toml");
    if !file.is_file() {
        return;
    }
    let (log_name, name) = (path.display(), file.display());
    match Scenario::load(&file) {
        Err(_) => say!("note: {name} is not accepted now: {log_name} holds an earlier run"),
        Ok(now) => {
            let now = now.self_contained().to_toml();
            if let Some(then) = log.scenario().filter(|then| *then != now) {
                let difference = difference(then, &now);
                say!("note: {log_name} holds a run with other settings than {name} has now{difference}");
            }
        }
    }
}
