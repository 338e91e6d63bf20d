//! Flexible spacecraft and what surrounds them, as a scenario describes them.
//!
//! - [`body`]: bodies about one angle, in chains, on three axes; modes, appendages, drives;
//! - [`flow`]: how they move between events, about one angle and with modes that do not act back;
//! - [`wrench`]: all that acts on them;
//! - [`environment`], [`disturbance`]: orbits, fields, pressure; torques and forces from outside;
//! - [`manoeuvre`]: planned rotations, and the alternatives compared with them.
//!
//! Names in brackets, such as \[Likins70\], are sources: `docs/references.md` lists them.

pub mod axes;
pub mod body;
pub mod disturbance;
pub mod environment;
pub mod flow;
pub mod manoeuvre;
pub mod sine;
pub mod wrench;

use flexsc_formats::{count, document, structure};
use flexsc_motion::{self as motion, attitude, guard, lanes, numerics, quantity, random, time, waveform};
