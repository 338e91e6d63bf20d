//! All integration tests of flexsc, one binary.

mod bad_scenarios;
mod campaigns;
mod cli;
mod determinism;
mod events;
mod layout;
mod logs;
mod plot;
mod relay;
mod stops;
mod util;
