//! Precision of the flight computer: functions of `flexsc-flight` in double or in single precision, on the same structs.
//!
//! The modules are those of `flexsc-flight` with `f32` for `f64`: `build.rs` makes their text, and `flexsc export-c` translates the same
//! text to C. Only the functions of mathematics in `src/single` are written anew. Structs keep doubles everywhere: a call in
//! [`Precision::Single`] rounds its arguments to single precision, computes in it, and returns what it has changed. A number of
//! single precision is a double without rounding, so that a state has the same bits between two calls as on a flight computer that
//! holds floats. Time stays in integers; spans become floats.

mod precision;
mod recent_past;
mod twin;

pub use precision::Precision;

#[allow(
    missing_docs,
    dead_code,
    clippy::all,
    clippy::pedantic,
    reason = "the text is that of flexsc-flight, where it is checked in double precision"
)]
mod functions {
    use crate::twin::Twin;

    include!(concat!(env!("OUT_DIR"), "/functions.rs"));
}

pub use functions::*;
