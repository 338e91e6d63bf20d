//! Certified search of the lanes whose crossing could not be predicted with certainty.

#![allow(clippy::inline_always, reason = "inside functions with a target feature nothing else is inlined")]
#![allow(clippy::needless_range_loop, reason = "adaptors of iterators lack the processor's instructions")]

use flexsc_dynamics::damping::DampingRule;
use flexsc_dynamics::predicted_crossing::PredictedCrossing;
use flexsc_numerics::lanes::{LaneFloat, SimdTask};

use super::{NEVER, RelayKernel, SHORT};
use crate::host::{CyclePhase, LaneHost};
use crate::lane_time::LaneTime;

/// Task that searches the lanes without a certain crossing.
pub(super) struct UncertainCrossings<'a, 'b, R: LaneFloat, D> {
    pub kernel: &'a mut RelayKernel<R, D>,
    pub host: &'a mut (dyn LaneHost + 'b),
    pub phase: CyclePhase,
    pub found: PredictedCrossing<R>,
}

impl<R: LaneFloat, D: DampingRule<R>> SimdTask for UncertainCrossings<'_, '_, R, D> {
    type Output = ((LaneTime<R>, R), R::Mask);

    #[inline(always)]
    fn run<K: LaneFloat>(self, _: K) -> Self::Output {
        self.kernel.search_uncertain(self.host, self.phase, self.found)
    }
}

impl<R: LaneFloat, D: DampingRule<R>> RelayKernel<R, D> {
    /// Searches the lanes without a certain crossing for their first one.
    #[inline(always)]
    fn search_uncertain(
        &mut self,
        host: &mut dyn LaneHost,
        phase: CyclePhase,
        found: PredictedCrossing<R>,
    ) -> ((LaneTime<R>, R), R::Mask) {
        let (zero, one, certain) = (self.angle.splat(0.0), self.angle.splat(1.0), found.certain);
        // Lanes without a certain crossing do not move yet.
        for mode in &mut self.modes {
            for part in 0..2 {
                mode.end[part] = R::select(certain, mode.end[part], mode.start[part]);
            }
        }
        let mut span = LaneTime::from_ticks(R::select(certain, found.ticks, zero));
        let mut after = R::select(certain, found.after, zero);
        let mut first = R::select(found.first | !certain, one, -one);
        let known = R::select(certain, one, zero);
        self.write_snapshot();
        for lane in 0..R::LANES {
            if !self.active[lane] || known.lane(lane) > 0.0 {
                continue;
            }
            self.lane_state(lane);
            let side = self.lane_state.side;
            let found = &mut self.found;
            if !host.find_crossing(lane, phase, &self.lane_state, found) {
                // No crossing within the run: the end of the run comes first.
                span = span.with_lane(lane, (NEVER as u64, 0));
                continue;
            }
            let (parts, seconds) = found.after;
            if !(seconds > 0.0 && seconds < SHORT) {
                host.reject(lane);
                self.active[lane] = false;
                continue;
            }
            span = span.with_lane(lane, parts);
            after = after.with_lane(lane, seconds);
            if phase == CyclePhase::Coast {
                first = first.with_lane(lane, if found.right == (side > 0.0) { 1.0 } else { -1.0 });
            }
            for index in 0..found.modes.len() {
                let (mode, [x, y]) = (&mut self.modes[index], found.modes[index]);
                mode.end[0] = mode.end[0].with_lane(lane, 0.0 + side * x);
                mode.end[1] = mode.end[1].with_lane(lane, side * y);
            }
        }
        ((span, after), zero.lt(first))
    }
}
