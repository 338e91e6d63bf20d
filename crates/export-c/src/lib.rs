//! Control systems of scenarios for flight computers: as C99, translated from the Rust code that the engine calls, or as a crate of it.
//!
//! - [`control_system`]: the control system of a scenario, of plain laws, as Rust runs it;
//! - `glue`: the functions that call its units, as a module in the subset of Rust that is translated;
//! - [`mod@translate`]: the subset of Rust in which these laws are written, to C99, evaluated in the same order, so that both return
//!   equal bits under a compiler that keeps IEEE 754;
//! - [`package`]: the files that are exported; [`vectors`]: calls of a run, which the exported code replays; [`self_test`]: a hash
//!   over calls with random and extreme inputs.

pub mod control_system;
mod flight_sources;
mod glue;
pub mod package;
pub mod self_test;
pub mod translate;
pub mod vectors;

pub use translate::{SourceFile, Translation, TranslationError, translate};
