//! Lanes that switch without end.

#![allow(clippy::inline_always, reason = "inside functions with a target feature nothing else is inlined")]

use flexsc_dynamics::damping::DampingRule;
use flexsc_numerics::lanes::LaneFloat;

use super::RelayKernel;
use crate::chatter::{CYCLES, shortest_window};
use crate::host::LaneHost;

impl<R: LaneFloat, D: DampingRule<R>> RelayKernel<R, D> {
    /// Begins a cycle of all lanes, and ends the runs that chatter. Returns true if any run continues.
    #[inline(always)]
    pub(super) fn cycle(&mut self, host: &mut dyn LaneHost) -> bool {
        if self.cycles >= self.next_chatter_check {
            self.end_windows(host);
        }
        self.cycles += 1;
        !Self::IS_SINGLE || self.active[0]
    }

    /// Ends the windows of switchings that are full.
    #[inline(never)]
    fn end_windows(&mut self, host: &mut dyn LaneHost) {
        self.next_chatter_check = u64::MAX;
        for lane in 0..R::LANES {
            if !self.active[lane] {
                continue;
            }
            if self.cycles - self.marks[lane] == CYCLES {
                let span = self.now.since(self.marked).seconds().lane(lane);
                if span < shortest_window(self.fastest.lane(lane)) {
                    host.chatters(lane, self.now.lane(lane));
                    self.active[lane] = false;
                    continue;
                }
                self.marked = self.marked.with_lane(lane, self.now.lane(lane));
                self.marks[lane] = self.cycles;
            }
            self.next_chatter_check = self.next_chatter_check.min(self.marks[lane] + CYCLES);
        }
    }
}
