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
        place: CyclePhase,
        moment: R,
        span: R,
        until: LaneTime<R>,
    ) {
        let zero = span.splat(0.0);
        let (mut centre, mut reach) = (zero, zero);
        for mode in &self.modes {
            let mode = mode.depart(moment);
            centre = centre + mode.equilibrium;
            reach = reach + mode.amplitude_bound();
        }
        let end = self.angle + span * (self.rate + span.splat(0.5) * moment * span);
        let (mut low, mut high) = (self.angle.min(end), self.angle.max(end));
        // Vertex of the parabola, if it lies within the motion.
        let crest = self.angle - span.splat(0.5) * self.rate * (self.rate / moment);
        let turns = (self.rate * (self.rate + moment * span)).le(zero);
        low = R::select(turns, low.min(crest), low);
        high = R::select(turns, high.max(crest), high);
        let within = (high + centre + reach).le(self.band) & (-self.band).le(low + centre - reach);
        if within.all() {
            return;
        }
        let strays = R::select(within, zero, span.splat(1.0));
        self.write_snapshot();
        for lane in 0..R::LANES {
            if self.active[lane] && strays.lane(lane) > 0.0 {
                self.lane_state(lane);
                host.on_possible_band_exit(lane, place, &self.sight, until.lane(lane));
            }
        }
    }

    /// Notifies the host of a switching in each lane.
    #[inline(always)]
    pub(super) fn report_switchings(&mut self, host: &mut dyn LaneHost, to: CyclePhase) {
        if !self.listens {
            return;
        }
        self.write_snapshot();
        for lane in 0..R::LANES {
            if self.active[lane] {
                self.lane_state(lane);
                host.on_switching(lane, to, &self.sight);
            }
        }
    }

    /// Hands the run of the first lane back to the host, at the start of the motion at `place`.
    pub(super) fn hand_over(&mut self, host: &mut dyn LaneHost, place: CyclePhase) {
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
            place: Some(place),
            from: self.sight.clone(),
            pushed: self.pushed.lane(0),
            // The cycle that this place is of has been counted.
            switched: (3 * (self.cycles - 1 - self.marks[0]) + place as u64, self.marked.lane(0)),
            seen: self.seen.lane(0),
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
                (self.side * self.modes[index].at[part]).store(&mut rest[2 * index + part]);
            }
        }
    }

    /// Copies the state of one lane from the rows.
    pub(super) fn lane_state(&mut self, lane: usize) {
        let [whole, part, side, k_t, angle, rate, rest @ ..] = &self.rows[..] else { return };
        let measurement = &mut self.sight;
        measurement.at = (whole[lane] as u64, part[lane] as u64);
        (measurement.side, measurement.gain) = (side[lane], k_t[lane]);
        (measurement.angle, measurement.rate) = (angle[lane], rate[lane]);
        measurement.modes.clear();
        for pair in rest.chunks_exact(2) {
            measurement.modes.push([pair[0][lane], pair[1][lane]]);
        }
    }
}
