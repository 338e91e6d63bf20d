//! The control system of a spacecraft: from sensor measurements to actuator outputs.
//!
//! Each role is a trait: [`sensor::Sense`], [`estimator::Estimate`], [`adaptation::Adapt`], [`law::Control`],
//! [`actuator::Actuate`]. `docs/extending.md` describes how to add a kind.
//!
//! Names in brackets, such as \[Likins70\], are sources: `docs/references.md` lists them.

pub mod actuator;
pub mod adaptation;
pub mod belief;
pub mod estimator;
pub mod law;
pub mod outage;
pub mod own;
pub mod parts;
pub mod sensor;

use flexsc_formats::{count, document};
use flexsc_motion::{self as motion, attitude, guard, lanes, numerics, quantity, random, time, waveform};
use flexsc_output::record;
use flexsc_spacecraft::{axes, body, environment, flow, manoeuvre, sine, wrench};
