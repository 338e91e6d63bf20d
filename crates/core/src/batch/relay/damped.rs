//! Relay runs with damped modes in the lanes of a flight: a kernel of its own, in a module of its own, so that both compile at once.

use super::Runs;
use crate::flight::Flight;
use crate::lanes::{LaneWork, Processor, Real};
use crate::motion::damping::Damped;

/// Makes runs of which all have damped modes.
pub(super) fn fly_damped(processor: Processor, runs: &mut Runs<'_>) {
    processor.run_narrow(DampedRuns(runs));
}

struct DampedRuns<'r, 'a>(&'r mut Runs<'a>);

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
