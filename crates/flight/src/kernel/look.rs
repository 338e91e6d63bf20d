//! Extraction of single lanes from the kernel, as plain numbers for the host.

#![allow(clippy::inline_always, reason = "inside functions with a target feature nothing else is inlined")]
#![allow(clippy::needless_range_loop, reason = "adaptors of iterators lack the processor's instructions")]

use super::Flight;
use crate::clock::Clock;
use crate::crew::{Crew, CyclePlace, LaneRest};
use crate::track::Turning;
use flexsc_motion::damping::Damping;
use flexsc_motion::lanes::{Mask, Real};

impl<R: Real, D: Damping<R>> Flight<R, D> {
    /// Notifies the host of lanes whose bounds do not keep the angle within the band during the motion that ends.
    #[inline(always)]
    pub(super) fn stray(
        &mut self,
        crew: &mut dyn Crew,
        place: CyclePlace,
        moment: R,
        span: R,
        until: Clock<R>,
    ) {
        let zero = span.of(0.0);
        let (mut centre, mut reach) = (zero, zero);
        for mode in &self.modes {
            let mode = mode.depart(moment);
            centre = centre + mode.equilibrium;
            reach = reach + mode.reach();
        }
        let end = self.angle + span * (self.rate + span.of(0.5) * moment * span);
        let (mut low, mut high) = (self.angle.min(end), self.angle.max(end));
        // Vertex of the parabola, if it lies within the motion.
        let crest = self.angle - span.of(0.5) * self.rate * (self.rate / moment);
        let turns = (self.rate * (self.rate + moment * span)).le(zero);
        low = R::select(turns, low.min(crest), low);
        high = R::select(turns, high.max(crest), high);
        let within = (high + centre + reach).le(self.band) & (-self.band).le(low + centre - reach);
        if within.all() {
            return;
        }
        let strays = R::select(within, zero, span.of(1.0));
        self.write();
        for lane in 0..R::LANES {
            if self.active[lane] && strays.lane(lane) > 0.0 {
                self.look(lane);
                crew.strays(lane, place, &self.sight, until.lane(lane));
            }
        }
    }

    /// Notifies the host of a switching in each lane.
    #[inline(always)]
    pub(super) fn tell(&mut self, crew: &mut dyn Crew, to: CyclePlace) {
        if !self.listens {
            return;
        }
        self.write();
        for lane in 0..R::LANES {
            if self.active[lane] {
                self.look(lane);
                crew.switched(lane, to, &self.sight);
            }
        }
    }

    /// Hands the run of the first lane back to the host, at the start of the motion at `place`.
    pub(super) fn hand_back(&mut self, crew: &mut dyn Crew, place: CyclePlace) {
        self.active[0] = false;
        self.write();
        self.look(0);
        let side = self.side.lane(0);
        let mut tracks = Vec::with_capacity(self.tracks.len());
        for track in &self.tracks {
            let Turning { frame: [re, im], axis, deviation: [x, y] } = track.now;
            let mirrored = [re, im, track.equilibrium, x, y].map(|part| side * part.lane(0));
            let [re, im, equilibrium, x, y] = mirrored;
            tracks.push([re, im, axis[0].lane(0), axis[1].lane(0), equilibrium, x, y]);
        }
        crew.take_back(LaneRest {
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
    pub(super) fn write(&mut self) {
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
    pub(super) fn look(&mut self, lane: usize) {
        let [whole, part, side, k_t, angle, rate, rest @ ..] = &self.rows[..] else { return };
        let sight = &mut self.sight;
        sight.at = (whole[lane] as u64, part[lane] as u64);
        (sight.side, sight.gain) = (side[lane], k_t[lane]);
        (sight.angle, sight.rate) = (angle[lane], rate[lane]);
        sight.modes.clear();
        for pair in rest.chunks_exact(2) {
            sight.modes.push([pair[0][lane], pair[1][lane]]);
        }
    }
}
