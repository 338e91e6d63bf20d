//! Control systems of scenarios as C99 for flight computers, translated from the Rust code that the engine calls.
//!
//! - [`control_system`]: the control system of a scenario, of plain laws, as Rust runs it;
//! - `translate`: the subset of Rust in which these laws are written, to C99;
//! - `package`: the files that are exported; [`vectors`]: calls of a run, which the exported code replays.

pub mod control_system;
pub mod vectors;
