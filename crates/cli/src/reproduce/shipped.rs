//! The scenarios of the repository, compiled in: an installed command has no checkout beside it.

use std::path::Path;

use flexsc_core::{Document, Scenario};

use crate::failure::Failure;

/// Lists scenarios by the path that commands give them.
macro_rules! shipped {
    ($($name:literal),+ $(,)?) => {
        &[$((
            concat!("scenarios/", $name, ".toml"),
            include_str!(concat!("../../../../scenarios/", $name, ".toml")),
        )),+]
    };
}

/// Path and text of each.
pub const SCENARIOS: &[(&str, &str)] = shipped![
    "iss-delay-limit",
    "iss-identification",
    "iss-manoeuvre",
    "iss-manoeuvre-off",
    "iss-mismatch",
    "iss-ringdown",
    "iss-ringdown-off",
    "relay-adaptive",
    "relay-fixed",
    "relay-no-freeze",
    "relay-one-sided",
    "relay-quiet",
    "rotation-cosine",
    "rotation-kinematic",
    "rotation-nonlinear",
    "rotation-robust",
    "rotation-sine",
    "rotation-spin-up",
    "rotation-thrusters",
    "wheel-ekf",
    "wheel-fast-mode",
    "wheel-fixed-gain",
    "wheel-robust-gain",
    "wheel-scheduled-gain",
    "wheel-slow-mode",
    "wheel-unstable-band",
];

/// A scenario with some keys set, as `--set` and `--seed` of the command do it.
pub fn load(path: &Path, set: &[String], seed: Option<u64>) -> Result<Scenario, Failure> {
    let Some((name, text)) = SCENARIOS.iter().find(|(shipped, _)| Path::new(shipped) == path) else {
        return Err(Failure::Arguments(format!("{}: no scenario of the papers", path.display())));
    };
    crate::scenario::with(Document::parse(name, (*text).to_owned())?, set, seed)
}
