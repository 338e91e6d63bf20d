//! Extraction of single lanes from the kernel, as plain numbers for the host.

#![allow(clippy::inline_always, reason = "inside functions with a target feature nothing else is inlined")]
#![allow(clippy::needless_range_loop, reason = "adaptors of iterators lack the processor's instructions")]

use flexsc_dynamics::damping::DampingRule;
use flexsc_numerics::lanes::{LaneFloat, Mask};

use super::RelayKernel;
use crate::envelope_lanes::PhasorState;
use crate::host::{CyclePhase, LaneHandover, LaneHost};
use crate::lane_time::LaneTime;

impl<R: LaneFloat, D: DampingRule<R>> RelayKernel<R, D> {
    /// Notifies the host of lanes whose bounds do not keep the angle within the band during the motion that ends.
    #[inline(always)]
    pub(super) fn check_band(
        &mut self,
        host: &mut dyn LaneHost,
        phase: CyclePhase,
        moment: R,
        span: R,
        until: LaneTime<R>,
    ) {
        let zero = span.splat(0.0);
        let (mut centre, mut reach) = (zero, zero);
        for mode in &self.modes {
            let mode = mode.about_equilibrium(moment);
            centre = centre + mode.equilibrium;
            reach = reach + mode.amplitude_bound();
        }
        let end = self.angle + span * (self.rate + span.splat(0.5) * moment * span);
        let (mut low, mut high) = (self.angle.min(end), self.angle.max(end));
        // Vertex of the parabola, if it lies within the motion.
        let crest = self.angle - span.splat(0.5) * self.rate * (self.rate / moment);
        let has_vertex = (self.rate * (self.rate + moment * span)).le(zero);
        low = R::select(has_vertex, low.min(crest), low);
        high = R::select(has_vertex, high.max(crest), high);
        let within = (high + centre + reach).le(self.band) & (-self.band).le(low + centre - reach);
        if within.all() {
            return;
        }
        let may_leave = R::select(within, zero, span.splat(1.0));
        self.write_snapshot();
        for lane in 0..R::LANES {
            if self.active[lane] && may_leave.lane(lane) > 0.0 {
                self.lane_state(lane);
                host.on_possible_band_exit(lane, phase, &self.lane_state, until.lane(lane));
            }
        }
    }

    /// Notifies the host of a switching in each lane.
    #[inline(always)]
    pub(super) fn report_switchings(&mut self, host: &mut dyn LaneHost, next: CyclePhase) {
        if !self.wants_switchings {
            return;
        }
        self.write_snapshot();
        for lane in 0..R::LANES {
            if self.active[lane] {
                self.lane_state(lane);
                host.on_switching(lane, next, &self.lane_state);
            }
        }
    }

    /// Hands the run of the first lane back to the host, at the start of the motion of `phase`.
    pub(super) fn hand_over(&mut self, host: &mut dyn LaneHost, phase: CyclePhase) {
        self.active[0] = false;
        self.write_snapshot();
        self.lane_state(0);
        let side = self.side.lane(0);
        let mut tracks = Vec::with_capacity(self.tracks.len());
        for track in &self.tracks {
            let PhasorState { frame: [re, im], axis, deviation: [x, y] } = track.now;
            let mirrored = [re, im, track.equilibrium, x, y].map(|part| side * part.lane(0));
            let [re, im, equilibrium, x, y] = mirrored;
            tracks.push([re, im, axis[0].lane(0), axis[1].lane(0), equilibrium, x, y]);
        }
        host.hand_over(LaneHandover {
            phase: Some(phase),
            from: self.lane_state.clone(),
            push_start: self.push_start.lane(0),
            // The current cycle has been counted already.
            switched: (3 * (self.cycles - 1 - self.marks[0]) + phase as u64, self.marked.lane(0)),
            integrated_to: self.integrated_to.lane(0),
            integral: self.integral.lane(0),
            tracks,
        });
    }

    /// Writes the state of all lanes to plain rows.
    #[inline(always)]
    pub(super) fn write_snapshot(&mut self) {
        let [whole, part, side, k_t, angle, rate, rest @ ..] = &mut self.rows[..] else { return };
        self.now.whole.store(whole);
        self.now.part.store(part);
        self.side.store(side);
        self.k_t.store(k_t);
        (self.side * self.angle).store(angle);
        (self.side * self.rate).store(rate);
        for index in 0..self.modes.len() {
            for part in 0..2 {
                (self.side * self.modes[index].start[part]).store(&mut rest[2 * index + part]);
            }
        }
    }

    /// Copies the state of one lane from the rows.
    pub(super) fn lane_state(&mut self, lane: usize) {
        let [whole, part, side, k_t, angle, rate, rest @ ..] = &self.rows[..] else { return };
        let state = &mut self.lane_state;
        state.time = (whole[lane] as u64, part[lane] as u64);
        (state.side, state.gain) = (side[lane], k_t[lane]);
        (state.angle, state.rate) = (angle[lane], rate[lane]);
        state.modes.clear();
        for pair in rest.chunks_exact(2) {
            state.modes.push([pair[0][lane], pair[1][lane]]);
        }
    }
}
