//! The flight of a single run with damped modes.

use super::Alone;
use crate::flight::Flight;
use crate::motion::damping::Damped;

/// Makes the flight.
#[inline(never)]
pub(super) fn fly(alone: &mut Alone<'_>) {
    let (modes, tracks) = (alone.setup.modes.len(), alone.setup.tracks.len());
    Flight::<f64, Damped<f64>>::fly(f64::NAN, modes, tracks, alone);
}
