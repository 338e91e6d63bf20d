//! Relay runs with damped modes in the lanes of a flight: a kernel of its own, in a module of its own, so that both compile at once.

use super::Runs;
use crate::flight::Flight;
use crate::lanes::{LaneWork, Real};
use crate::motion::damping::Damped;

/// Runs of which all have damped modes.
pub(super) struct DampedRuns<'r, 'a>(pub &'r mut Runs<'a>);

impl LaneWork for DampedRuns<'_, '_> {
    type Output = ();

    #[allow(clippy::inline_always, reason = "a function of its own would lack the processor's instructions")]
    #[inline(always)]
    fn run<R: Real>(self, kind: R) {
        let Some(first) = self.0.jobs.first() else { return };
        let (modes, tracks, _) = Runs::structure(first.scenario);
        Flight::<R, Damped<R>>::fly(kind, modes, tracks, self.0);
    }
}
