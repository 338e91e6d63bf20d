//! Kernel of the relay law: runs in SIMD lanes, at the same phase of the cycle, each with its own time.
//!
//! The law's cycle is coast, push and brake in every run. The lanes of a [`Flight`] are at the same phase of it, each
//! at its own time; coordinates are mirrored where the left boundary is reached, so that all push back from the
//! right. A lane whose run has ended receives the next run at the end of the cycle. The results of a lane do not
//! depend on other lanes.

#![allow(clippy::inline_always, reason = "inside functions with a target feature nothing else is inlined")]
#![allow(clippy::needless_range_loop, reason = "adaptors of iterators lack the processor's instructions")]

mod chatter;
mod mode;
mod readout;
mod refill;

use flexsc_dynamics::damping::DampingRule;
use flexsc_dynamics::predicted_crossing::{
    PredictedCrossing, PredictedLevel, PredictedMode, SegmentStart, predict,
};
use flexsc_numerics::lanes::{LaneFloat, Mask, SimdWidth4};

use super::envelope_lanes::{self, EnvelopePhasor, PhasorState};
use super::host::{CyclePhase, FoundCrossing, LaneHost, LaneShape, LaneState};
use super::lane_time::{LaneTime, nearest_ticks};
use mode::LaneMode;

/// Largest number of lanes.
pub const MOST: usize = 16;
/// Time beyond every run (s).
const NEVER: f64 = 1e17;
/// Length (s) below which spans fit 64 bits of femtoseconds.
const SHORT: f64 = 9_000.0;
/// Number of rows written per lane, without its modes.
const ROWS: usize = 6;

/// Mirrors a number, if a mirror is given.
#[inline(always)]
fn seen<R: LaneFloat>(mirror: Option<R>, number: R) -> R {
    match mirror {
        Some(mirror) => mirror * number,
        None => number,
    }
}

/// Kernel state: the runs in SIMD lanes.
pub struct RelayKernel<R: LaneFloat, D> {
    now: LaneTime<R>,
    end: LaneTime<R>,
    side: R,
    angle: R,
    rate: R,
    modes: Vec<LaneMode<R, D>>,
    /// Modes during a motion, for numbers of modes other than two.
    moved: Vec<PredictedMode<R, D>>,
    fastest: R,
    longest: R,
    edge: R,
    back: R,
    strong: R,
    weak: R,
    k_t: R,
    band: R,
    /// Start of the last push (single runs only), and duration of the last push (s).
    pushed: LaneTime<R>,
    lasted: R,
    tracks: Vec<EnvelopePhasor<R, D>>,
    /// SIMD instructions for the phasors of a single run.
    four: SimdWidth4,
    /// True if any run has windows.
    watches: bool,
    /// Events that the host requested: switchings, and possible exits from the band.
    listens: bool,
    looks: bool,
    /// Time up to which the envelope is integrated, its integral, end of the current window, and length of the
    /// windows.
    seen: LaneTime<R>,
    integral: R,
    closes: LaneTime<R>,
    window: LaneTime<R>,
    /// True for the lanes with an active run.
    active: [bool; MOST],
    /// Cycles since the flight began, and the number of the one after which lanes are looked at for chatter.
    cycles: u64,
    looked_at: u64,
    /// For each lane, after how many cycles its last window of switchings ended, and when.
    marks: [u64; MOST],
    marked: LaneTime<R>,
    /// State of all lanes as plain numbers, and of one of them.
    rows: Vec<[f64; MOST]>,
    sight: LaneState,
    /// Result of the last search.
    found: FoundCrossing,
}

impl<R: LaneFloat, D: DampingRule<R>> RelayKernel<R, D> {
    /// True for a single run, which is handed back to the host where it ends.
    const IS_ALONE: bool = R::LANES == 1;

    /// Computes all runs of a host.
    #[inline(always)]
    pub fn run(kind: R, structure: LaneShape, host: &mut dyn LaneHost) {
        let mut flight = Self::new(kind, structure.modes, structure.tracks);
        let mut place = CyclePhase::Brake;
        // One phase per iteration, so that its code is instantiated once.
        loop {
            place = match place {
                CyclePhase::Coast if !Self::IS_ALONE || flight.active[0] => CyclePhase::Push,
                CyclePhase::Push if !Self::IS_ALONE || flight.active[0] => CyclePhase::Brake,
                _ => {
                    if !flight.refill(host) || !flight.cycle(host) {
                        return;
                    }
                    CyclePhase::Coast
                }
            };
            flight.go(host, place);
        }
    }

    /// Computes the motion of one phase, and the switching at its end.
    #[inline(always)]
    fn go(&mut self, host: &mut dyn LaneHost, place: CyclePhase) {
        let one = self.angle.splat(1.0);
        let (moment, towards, level) = match place {
            CyclePhase::Coast => (self.weak, one, self.edge),
            CyclePhase::Push => (-self.strong, -one, self.back),
            CyclePhase::Brake => (self.strong, one, self.edge),
        };
        for track in &mut self.tracks {
            track.command(moment);
        }
        if Self::IS_ALONE && place == CyclePhase::Push {
            self.pushed = self.now;
        }
        let (span, right) = if place == CyclePhase::Brake {
            (self.brake(host, moment), one.le(one))
        } else if place == CyclePhase::Push {
            self.guarded(host, place, moment, &[PredictedLevel { angle: level, towards }])
        } else {
            let other = PredictedLevel { angle: -self.edge, towards: -towards };
            self.guarded(host, place, moment, &[PredictedLevel { angle: level, towards }, other])
        };
        if place == CyclePhase::Push {
            self.lasted = span.1;
        }
        // After mirroring, the left boundary is the right one.
        let mirror = if place == CyclePhase::Coast { Some(R::select(right, one, -one)) } else { None };
        self.arrive(host, place, moment, span, mirror);
        if Self::IS_ALONE && !self.active[0] {
            return;
        }
        self.report_switchings(
            host,
            match place {
                CyclePhase::Coast => CyclePhase::Push,
                CyclePhase::Push => CyclePhase::Brake,
                CyclePhase::Brake => CyclePhase::Coast,
            },
        );
    }

    /// Mirrors the envelope.
    #[inline(always)]
    fn mirror(&mut self, mirror: R) {
        self.side = mirror * self.side;
        for index in 0..self.tracks.len() {
            let track = &mut self.tracks[index];
            track.equilibrium = mirror * track.equilibrium;
            for part in 0..2 {
                track.now.frame[part] = mirror * track.now.frame[part];
                track.now.deviation[part] = mirror * track.now.deviation[part];
            }
        }
    }

    /// Computes the brake, whose duration is given by the law.
    #[inline(always)]
    fn brake(&mut self, host: &mut dyn LaneHost, moment: R) -> (LaneTime<R>, R) {
        let nearest = nearest_ticks(self.k_t * self.lasted);
        // Longer brakes require a single run.
        let fits = nearest.lt(nearest.splat(SHORT * 1e15));
        if !fits.all() {
            for lane in 0..R::LANES {
                if self.active[lane] && nearest.lane(lane) >= SHORT * 1e15 {
                    host.reject(lane);
                    self.active[lane] = false;
                }
            }
        }
        let ticks = R::select(fits, nearest, nearest.splat(0.0));
        let after = ticks / ticks.splat(1e15);
        for mode in &mut self.modes {
            let mut moved = mode.depart(moment);
            moved.advance(after);
            mode.store_end(&moved);
        }
        (LaneTime::from_ticks(ticks), after)
    }

    /// Finds the first crossing: its time, and which threshold is reached.
    #[inline(always)]
    fn guarded<const LEVELS: usize>(
        &mut self,
        host: &mut dyn LaneHost,
        place: CyclePhase,
        moment: R,
        levels: &[PredictedLevel<R>; LEVELS],
    ) -> ((LaneTime<R>, R), R::Mask) {
        let (zero, one) = (moment.splat(0.0), moment.splat(1.0));
        let (fastest, longest) = (self.fastest, self.longest);
        let from = SegmentStart { angle: self.angle, rate: self.rate, moment, fastest, longest };
        let found: PredictedCrossing<R> = match &mut self.modes[..] {
            // Two modes, the usual case, stay in registers.
            [first, second] if !D::IS_DAMPED => {
                let mut two = [first.depart(moment), second.depart(moment)];
                let found = predict(&from, levels, &mut two);
                first.store_end(&two[0]);
                second.store_end(&two[1]);
                found
            }
            modes => {
                for index in 0..modes.len() {
                    self.moved[index] = modes[index].depart(moment);
                }
                let found = predict(&from, levels, &mut self.moved);
                for index in 0..modes.len() {
                    modes[index].store_end(&self.moved[index]);
                }
                found
            }
        };
        let certain = found.certain;
        if certain.all() {
            return ((LaneTime::from_ticks(found.ticks), found.after), found.first);
        }
        // Lanes without a certain crossing do not move yet.
        for mode in &mut self.modes {
            for part in 0..2 {
                mode.end[part] = R::select(certain, mode.end[part], mode.at[part]);
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
            let side = self.sight.side;
            let found = &mut self.found;
            if !host.find_crossing(lane, place, &self.sight, found) {
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
            if place == CyclePhase::Coast {
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

    /// Ends the motion after `span`: closes windows on the way, and ends runs that are due. The resulting state is
    /// mirrored if a mirror is given.
    #[inline(always)]
    fn arrive(
        &mut self,
        host: &mut dyn LaneHost,
        place: CyclePhase,
        moment: R,
        (span, h): (LaneTime<R>, R),
        mirror: Option<R>,
    ) {
        let zero = h.splat(0.0);
        let until = self.now.add(span);
        let ends = !until.is_at_or_before(self.end);
        let until = if ends.any() { LaneTime::select(ends, self.end, until) } else { until };
        if Self::IS_ALONE && (ends.any() || host.should_stop()) {
            self.hand_over(host, place);
            return;
        }
        // If no run ends, the duration is the one found.
        let lasts = if ends.any() { None } else { Some(h) };
        if self.looks {
            let span = match lasts {
                Some(span) => span,
                None => until.since(self.now).seconds(),
            };
            self.check_band(host, place, moment, span, until);
        }
        self.follow(host, until, lasts);
        self.now = until;
        self.angle = seen(mirror, self.angle + h * (self.rate + h.splat(0.5) * moment * h));
        self.rate = seen(mirror, self.rate + moment * h);
        for mode in &mut self.modes {
            for part in 0..2 {
                mode.at[part] = seen(mirror, mode.end[part]);
            }
        }
        if let Some(mirror) = mirror {
            self.mirror(mirror);
        }
        if ends.any() {
            let ended = R::select(ends, h.splat(1.0), zero);
            for lane in 0..R::LANES {
                if ended.lane(lane) > 0.0 {
                    self.active[lane] = false;
                    // The idle lane must keep moving with finite numbers until it receives another run.
                    self.closes = self.closes.with_lane(lane, (NEVER as u64, 0));
                }
            }
        }
    }

    /// Integrates the envelope up to an instant of each lane, closing windows on the way. `whole` is the time since
    /// the last update, if known (s).
    #[inline(always)]
    fn follow(&mut self, host: &mut dyn LaneHost, until: LaneTime<R>, mut whole: Option<R>) {
        if !self.watches {
            return;
        }
        let zero = self.angle.splat(0.0);
        let mut goes_on = zero.le(zero);
        loop {
            let due = goes_on & self.closes.is_at_or_before(until);
            let at = if due.any() { LaneTime::select(due, self.closes, until) } else { until };
            let time = at.seconds();
            let span = match whole.take() {
                Some(whole) if !due.any() => whole,
                _ => at.since(self.seen).seconds(),
            };
            if Self::IS_ALONE && !D::IS_DAMPED && self.tracks.len() > 1 {
                self.integral =
                    envelope_lanes::advance_group(self.four, &mut self.tracks, time, span, self.integral);
            } else {
                self.follow_each(goes_on, time, span);
            }
            self.seen = LaneTime::select(goes_on, at, self.seen);
            if !due.any() {
                return;
            }
            self.close(host, R::select(due, zero.splat(1.0), zero));
            self.integral = R::select(due, zero, self.integral);
            self.closes = LaneTime::select(due, self.closes.add(self.window), self.closes);
            goes_on = due;
        }
    }

    /// Integrates the modes of the envelope one after the other, in the lanes that continue.
    #[inline(always)]
    fn follow_each(&mut self, goes_on: R::Mask, time: R, span: R) {
        let zero = time.splat(0.0);
        for track in &mut self.tracks {
            let (mut there, mut integral) = track.advance(time, span);
            // Usually all lanes continue.
            if !goes_on.all() {
                there = PhasorState::select(goes_on, &there, &track.now);
                integral = R::select(goes_on, integral, zero);
            }
            track.now = there;
            self.integral = self.integral + integral;
        }
    }

    /// Closes the windows of the lanes in which `closing` is 1.
    fn close(&mut self, host: &mut dyn LaneHost, closing: R) {
        for lane in 0..R::LANES {
            if closing.lane(lane) > 0.0 {
                let (integral, gain) = (self.integral.lane(lane), self.k_t.lane(lane));
                let gain = host.on_window(lane, self.seen.lane(lane), integral, gain);
                self.k_t = self.k_t.with_lane(lane, gain);
            }
        }
    }
}
