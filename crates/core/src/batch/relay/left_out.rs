//! Relay runs with damped modes in a build without their kernel: all go one by one.

use super::Runs;
use crate::lanes::Processor;

/// Makes none of them.
pub(super) fn fly_damped(_: Processor, _: &mut Runs<'_>) {}
