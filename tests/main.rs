//! All integration tests of flexsc, one binary.

mod bad_scenarios;
mod cli;
mod determinism;
mod events;
mod layout;
mod plot;
mod relay;
mod util;
