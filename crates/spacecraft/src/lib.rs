//! Flexible spacecraft and their environment, as a scenario describes them.
//!
//! - [`body`]: one-axis and three-axis bodies, chains of panels; modes, appendages, drives;
//! - [`environment`], [`disturbance`]: orbits, fields, pressure; external torques and forces;
//! - [`manoeuvre`]: planned rotations, and the alternatives compared with them.
//!
//! Names in brackets, such as \[Likins70\], are sources: `docs/references.md` lists them.

pub mod axes;
pub mod body;
pub mod disturbance;
pub mod environment;
mod held_lines;
pub mod load_density;
pub mod load_lines;
mod machine_load;
pub mod manoeuvre;
mod shaped_load;
pub mod sine;
