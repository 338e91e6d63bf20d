//! Flexible spacecraft and what surrounds them, as a scenario describes them.
//!
//! - [`body`]: bodies about one angle, in chains, on three axes; modes, appendages, drives;
//! - [`environment`], [`disturbance`]: orbits, fields, pressure; torques and forces from outside;
//! - [`manoeuvre`]: planned rotations, and the alternatives compared with them.
//!
//! Names in brackets, such as \[Likins70\], are sources: `docs/references.md` lists them.

pub mod axes;
pub mod body;
pub mod disturbance;
pub mod environment;
pub mod manoeuvre;
pub mod sine;

use flexsc_formats::{count, document, structure};
use flexsc_motion::{self as motion, attitude, guard, lanes, numerics, quantity, random, time, waveform};
