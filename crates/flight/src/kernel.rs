//! Runs of the relay law side by side: in phase, each with a clock of its own.
//!
//! The law's cycle is coast, push and brake in every run. The lanes of a [`Flight`] are at the same place of it, each at its
//! own time; seen in a mirror wherever the left boundary is reached, all push back from the right. A run that ends gives its
//! lane to the next one at the cycle's end. What a lane does depends on no other.

#![allow(clippy::inline_always, reason = "inside functions with a target feature nothing else is inlined")]
#![allow(clippy::needless_range_loop, reason = "adaptors of iterators lack the processor's instructions")]

mod chatter;
mod fill;
mod look;
mod mode;

use super::clock::{Clock, nearest_ticks};
use super::crew::{Crew, CyclePlace, LaneSight, Searched, Structure};
use super::track::{self, PhasorTrack, Turning};
use flexsc_motion::damping::Damping;
use flexsc_motion::guess::{Departure, GuessLevel, GuessOscillator, GuessedTrip, locate};
use flexsc_motion::lanes::{Four, Mask, Real};
use mode::LaneMode;

/// Most lanes.
pub const MOST: usize = 16;
/// Beyond every run (s).
const NEVER: f64 = 1e17;
/// Spans below so many seconds fit 64 bits of femtoseconds.
const SHORT: f64 = 9_000.0;
/// What is written of a lane beside its modes.
const ROWS: usize = 6;

/// A number in the mirror, if there is one.
#[inline(always)]
fn seen<R: Real>(mirror: Option<R>, number: R) -> R {
    match mirror {
        Some(mirror) => mirror * number,
        None => number,
    }
}

/// Runs side by side.
pub struct Flight<R: Real, D> {
    now: Clock<R>,
    end: Clock<R>,
    side: R,
    angle: R,
    rate: R,
    modes: Vec<LaneMode<R, D>>,
    /// The modes of a motion, where there are more or fewer than two.
    moved: Vec<GuessOscillator<R, D>>,
    fastest: R,
    longest: R,
    edge: R,
    back: R,
    strong: R,
    weak: R,
    k_t: R,
    band: R,
    /// When the push of a run alone began, and how long the last push lasted (s).
    pushed: Clock<R>,
    lasted: R,
    tracks: Vec<PhasorTrack<R, D>>,
    /// What follows those of one run side by side.
    four: Four,
    /// Whether any run has windows.
    watches: bool,
    /// What the crew wants to know: switchings, and where the angle may leave the band.
    listens: bool,
    looks: bool,
    /// When the envelope was followed last, its integral, and when and after how long windows close.
    seen: Clock<R>,
    integral: R,
    closes: Clock<R>,
    window: Clock<R>,
    /// Which lanes have a run that goes on.
    active: [bool; MOST],
    /// Cycles since the flight began, and the number of the one after which lanes are looked at for chatter.
    cycles: u64,
    looked_at: u64,
    /// For each lane, after how many cycles its last window of switchings ended, and when.
    marks: [u64; MOST],
    marked: Clock<R>,
    /// All lanes as plain numbers, and one of them.
    rows: Vec<[f64; MOST]>,
    sight: LaneSight,
    /// What was searched last.
    found: Searched,
}

impl<R: Real, D: Damping<R>> Flight<R, D> {
    /// A run alone is handed back where it ends.
    const IS_ALONE: bool = R::LANES == 1;

    /// Makes all runs of a crew.
    #[inline(always)]
    pub fn fly(kind: R, structure: Structure, crew: &mut dyn Crew) {
        let mut flight = Self::new(kind, structure.modes, structure.tracks);
        let mut place = CyclePlace::Brake;
        // One place at a time, whose code is here once.
        loop {
            place = match place {
                CyclePlace::Coast if !Self::IS_ALONE || flight.active[0] => CyclePlace::Push,
                CyclePlace::Push if !Self::IS_ALONE || flight.active[0] => CyclePlace::Brake,
                _ => {
                    if !flight.fill(crew) || !flight.cycle(crew) {
                        return;
                    }
                    CyclePlace::Coast
                }
            };
            flight.go(crew, place);
        }
    }

    /// The motion of one place, and the switching at its end.
    #[inline(always)]
    fn go(&mut self, crew: &mut dyn Crew, place: CyclePlace) {
        let one = self.angle.of(1.0);
        let (moment, towards, level) = match place {
            CyclePlace::Coast => (self.weak, one, self.edge),
            CyclePlace::Push => (-self.strong, -one, self.back),
            CyclePlace::Brake => (self.strong, one, self.edge),
        };
        for track in &mut self.tracks {
            track.command(moment);
        }
        if Self::IS_ALONE && place == CyclePlace::Push {
            self.pushed = self.now;
        }
        let (span, right) = if place == CyclePlace::Brake {
            (self.brake(crew, moment), one.le(one))
        } else if place == CyclePlace::Push {
            self.guarded(crew, place, moment, &[GuessLevel { angle: level, towards }])
        } else {
            let other = GuessLevel { angle: -self.edge, towards: -towards };
            self.guarded(crew, place, moment, &[GuessLevel { angle: level, towards }, other])
        };
        if place == CyclePlace::Push {
            self.lasted = span.1;
        }
        // Seen in the mirror, what reaches the left boundary reaches the right one.
        let mirror = if place == CyclePlace::Coast { Some(R::select(right, one, -one)) } else { None };
        self.arrive(crew, place, moment, span, mirror);
        if Self::IS_ALONE && !self.active[0] {
            return;
        }
        self.tell(
            crew,
            match place {
                CyclePlace::Coast => CyclePlace::Push,
                CyclePlace::Push => CyclePlace::Brake,
                CyclePlace::Brake => CyclePlace::Coast,
            },
        );
    }

    /// The envelope in the mirror.
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

    /// The brake, which lasts as long as the law says.
    #[inline(always)]
    fn brake(&mut self, crew: &mut dyn Crew, moment: R) -> (Clock<R>, R) {
        let nearest = nearest_ticks(self.k_t * self.lasted);
        // So long a brake is for a run alone.
        let fits = nearest.lt(nearest.of(SHORT * 1e15));
        if !fits.all() {
            for lane in 0..R::LANES {
                if self.active[lane] && nearest.lane(lane) >= SHORT * 1e15 {
                    crew.give_up(lane);
                    self.active[lane] = false;
                }
            }
        }
        let ticks = R::select(fits, nearest, nearest.of(0.0));
        let after = ticks / ticks.of(1e15);
        for mode in &mut self.modes {
            let mut moved = mode.depart(moment);
            moved.go(after);
            mode.arrive(&moved);
        }
        (Clock::of_ticks(ticks), after)
    }

    /// Finds the first trip: after how long, and of which level.
    #[inline(always)]
    fn guarded<const LEVELS: usize>(
        &mut self,
        crew: &mut dyn Crew,
        place: CyclePlace,
        moment: R,
        levels: &[GuessLevel<R>; LEVELS],
    ) -> ((Clock<R>, R), R::Mask) {
        let (zero, one) = (moment.of(0.0), moment.of(1.0));
        let (fastest, longest) = (self.fastest, self.longest);
        let from = Departure { angle: self.angle, rate: self.rate, moment, fastest, longest };
        let found: GuessedTrip<R> = match &mut self.modes[..] {
            // So many modes, which is usual, stay in registers.
            [first, second] if !D::IS_DAMPED => {
                let mut two = [first.depart(moment), second.depart(moment)];
                let found = locate(&from, levels, &mut two);
                first.arrive(&two[0]);
                second.arrive(&two[1]);
                found
            }
            modes => {
                for index in 0..modes.len() {
                    self.moved[index] = modes[index].depart(moment);
                }
                let found = locate(&from, levels, &mut self.moved);
                for index in 0..modes.len() {
                    modes[index].arrive(&self.moved[index]);
                }
                found
            }
        };
        let certain = found.certain;
        if certain.all() {
            return ((Clock::of_ticks(found.ticks), found.after), found.first);
        }
        // Lanes without a run stay where they are.
        for mode in &mut self.modes {
            for part in 0..2 {
                mode.end[part] = R::select(certain, mode.end[part], mode.at[part]);
            }
        }
        let mut span = Clock::of_ticks(R::select(certain, found.ticks, zero));
        let mut after = R::select(certain, found.after, zero);
        let mut first = R::select(found.first | !certain, one, -one);
        let known = R::select(certain, one, zero);
        self.write();
        for lane in 0..R::LANES {
            if !self.active[lane] || known.lane(lane) > 0.0 {
                continue;
            }
            self.look(lane);
            let side = self.sight.side;
            let found = &mut self.found;
            if !crew.search(lane, place, &self.sight, found) {
                // Nothing within the run, whose end is before any trip that lies so far ahead.
                span = span.with_lane(lane, (NEVER as u64, 0));
                continue;
            }
            let (parts, seconds) = found.after;
            if !(seconds > 0.0 && seconds < SHORT) {
                crew.give_up(lane);
                self.active[lane] = false;
                continue;
            }
            span = span.with_lane(lane, parts);
            after = after.with_lane(lane, seconds);
            if place == CyclePlace::Coast {
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

    /// Ends the motion that departed last, such a span after its departure: windows close on the way, and runs
    /// that end do so. What comes of it is seen in the mirror, if there is one.
    #[inline(always)]
    fn arrive(
        &mut self,
        crew: &mut dyn Crew,
        place: CyclePlace,
        moment: R,
        (span, h): (Clock<R>, R),
        mirror: Option<R>,
    ) {
        let zero = h.of(0.0);
        let until = self.now.plus(span);
        let ends = !until.not_after(self.end);
        let until = if ends.any() { Clock::select(ends, self.end, until) } else { until };
        if Self::IS_ALONE && (ends.any() || crew.stops()) {
            self.hand_back(crew, place);
            return;
        }
        // Where no run ends, it takes as long as was found.
        let lasts = if ends.any() { None } else { Some(h) };
        if self.looks {
            let span = match lasts {
                Some(span) => span,
                None => until.since(self.now).seconds(),
            };
            self.stray(crew, place, moment, span, until);
        }
        self.follow(crew, until, lasts);
        self.now = until;
        self.angle = seen(mirror, self.angle + h * (self.rate + h.of(0.5) * moment * h));
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
            let ended = R::select(ends, h.of(1.0), zero);
            for lane in 0..R::LANES {
                if ended.lane(lane) > 0.0 {
                    self.active[lane] = false;
                    // What is in the lane until another run comes moves without end or number.
                    self.closes = self.closes.with_lane(lane, (NEVER as u64, 0));
                }
            }
        }
    }

    /// Follows the envelope to an instant of each lane, by the windows that close on the way. It was followed last so many
    /// seconds before, if that is known.
    #[inline(always)]
    fn follow(&mut self, crew: &mut dyn Crew, until: Clock<R>, mut whole: Option<R>) {
        if !self.watches {
            return;
        }
        let zero = self.angle.of(0.0);
        let mut goes_on = zero.le(zero);
        loop {
            let due = goes_on & self.closes.not_after(until);
            let at = if due.any() { Clock::select(due, self.closes, until) } else { until };
            let time = at.seconds();
            let span = match whole.take() {
                Some(whole) if !due.any() => whole,
                _ => at.since(self.seen).seconds(),
            };
            if Self::IS_ALONE && !D::IS_DAMPED && self.tracks.len() > 1 {
                self.integral = track::follow(self.four, &mut self.tracks, time, span, self.integral);
            } else {
                self.follow_each(goes_on, time, span);
            }
            self.seen = Clock::select(goes_on, at, self.seen);
            if !due.any() {
                return;
            }
            self.close(crew, R::select(due, zero.of(1.0), zero));
            self.integral = R::select(due, zero, self.integral);
            self.closes = Clock::select(due, self.closes.plus(self.window), self.closes);
            goes_on = due;
        }
    }

    /// Follows the modes of the envelope one after the other, in the lanes that go on.
    #[inline(always)]
    fn follow_each(&mut self, goes_on: R::Mask, time: R, span: R) {
        let zero = time.of(0.0);
        for track in &mut self.tracks {
            let (mut there, mut integral) = track.advance(time, span);
            // As a rule all go on.
            if !goes_on.all() {
                there = Turning::select(goes_on, &there, &track.now);
                integral = R::select(goes_on, integral, zero);
            }
            track.now = there;
            self.integral = self.integral + integral;
        }
    }

    /// Windows close now in the lanes that have a 1.
    fn close(&mut self, crew: &mut dyn Crew, closing: R) {
        for lane in 0..R::LANES {
            if closing.lane(lane) > 0.0 {
                let (integral, gain) = (self.integral.lane(lane), self.k_t.lane(lane));
                let gain = crew.closed(lane, self.seen.lane(lane), integral, gain);
                self.k_t = self.k_t.with_lane(lane, gain);
            }
        }
    }
}
