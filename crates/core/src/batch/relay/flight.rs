//! Runs of the relay law side by side: in phase, each with a clock of its own.
//!
//! The law's cycle is coast, push and brake in every run. The lanes of a [`Flight`] are at the same place of it, each at its
//! own time; seen in a mirror wherever the left boundary is reached, all push back from the right. A run that ends gives its
//! lane to the next one at the cycle's end. What a lane does depends on no other.

#![allow(clippy::inline_always, reason = "inside functions with a target feature nothing else is inlined")]

use super::clock::{Clock, nearest_ticks};
use super::track::Track;
use crate::lanes::{Mask, Real};
use crate::motion::guess::{Departure, Found, Level, Oscillator, locate};
use crate::numerics::trig::sincos;

/// Most lanes.
pub const MOST: usize = 16;
/// Beyond every run (s).
const NEVER: f64 = 1e17;
/// Spans below so many seconds fit 64 bits of femtoseconds.
const SHORT: f64 = 9_000.0;
/// What is written of a lane beside its modes.
const ROWS: usize = 6;
/// An angle (rad) that no motion of a run in lanes reaches.
const FAR: f64 = 1e9;

/// One run at its start, as plain numbers. A mode: frequency, excitability, displacement and quadrature.
#[derive(Clone, Debug, Default)]
pub struct Setup {
    /// Rigid angle and rate.
    pub angle: f64,
    pub rate: f64,
    /// Modes of the body, and of the envelope's model.
    pub modes: Vec<[f64; 4]>,
    pub tracks: Vec<[f64; 4]>,
    /// Half the width of the dead zone, and where the brake begins.
    pub edge: f64,
    pub back: f64,
    /// Strong and weak moment (rad/s²), and braking gain.
    pub strong: f64,
    pub weak: f64,
    pub k_t: f64,
    /// The end, and the length of a window: whole seconds and femtoseconds.
    pub end: (u64, u64),
    pub window: Option<(u64, u64)>,
}

/// A place of the cycle.
#[derive(Copy, Clone, Debug, PartialEq, Eq)]
pub enum Place {
    /// In the dead zone, under the weak torque.
    Coast,
    /// Back from the right boundary.
    Push,
    /// Against the push.
    Brake,
}

/// One lane at one instant, out of the mirror. Displacements are from 0, not from an equilibrium.
#[derive(Clone, Debug, Default)]
pub struct Sight {
    /// Whole seconds and femtoseconds.
    pub at: (u64, u64),
    pub angle: f64,
    pub rate: f64,
    /// Displacement and quadrature of each mode.
    pub modes: Vec<[f64; 2]>,
    /// 1, or -1 in the mirror.
    pub side: f64,
    /// Braking gain.
    pub gain: f64,
}

/// A trip that was searched.
#[derive(Clone, Debug, Default)]
pub struct Searched {
    /// The span since departure: whole seconds and femtoseconds, and all of it in seconds.
    pub after: ((u64, u64), f64),
    /// Whether it is the right boundary, out of the mirror, or the only level.
    pub right: bool,
    /// Displacement from 0 and quadrature of each mode there.
    pub modes: Vec<[f64; 2]>,
}

/// Who has the runs.
pub trait Crew {
    /// Whether it wants switchings, and to know where bounds do not keep the angle within the band.
    const LISTENS: bool;

    /// The next run for a lane, whose last run has ended.
    fn next(&mut self, lane: usize) -> Option<Setup>;
    /// Looks for the first trip of a lane that departs here at this place; nothing within the run.
    fn search(&mut self, lane: usize, place: Place, from: &Sight) -> Option<Searched>;
    /// A lane cannot go on here: its run has to be made alone.
    fn give_up(&mut self, lane: usize);
    /// The law has switched to a place.
    fn switched(&mut self, lane: usize, to: Place, now: &Sight);
    /// A window has closed, with this integral of the envelope; answers the braking gain from now on.
    fn closed(&mut self, lane: usize, at: (u64, u64), integral: f64, gain: f64) -> f64;
    /// On the motion that departed here, at this place, and ends at an instant, the angle may leave the band (rad).
    fn strays(&mut self, lane: usize, place: Place, from: &Sight, until: (u64, u64));
    /// Half the width of the band about the goal (rad).
    fn band(&self, lane: usize) -> f64;
}

/// Runs side by side.
pub struct Flight<R: Real> {
    now: Clock<R>,
    end: Clock<R>,
    side: R,
    angle: R,
    rate: R,
    /// Displacements from 0; the modes about their equilibria at departure, and at the end of the motion.
    totals: Vec<R>,
    modes: Vec<Oscillator<R>>,
    moved: Vec<Oscillator<R>>,
    excitabilities: Vec<R>,
    fastest: R,
    edge: R,
    back: R,
    strong: R,
    weak: R,
    k_t: R,
    band: R,
    /// When the push began.
    pushed: Clock<R>,
    tracks: Vec<Track<R>>,
    /// When the envelope was followed last, its integral, and when and after how long windows close.
    seen: Clock<R>,
    integral: R,
    closes: Clock<R>,
    window: Clock<R>,
    /// Which lanes have a run that goes on.
    active: [bool; MOST],
    /// All lanes as plain numbers, and one of them.
    rows: Vec<[f64; MOST]>,
    sight: Sight,
}

impl<R: Real> Flight<R> {
    /// Lanes without runs, of bodies and envelopes with so many modes.
    #[inline(always)]
    fn new(kind: R, modes: usize, tracks: usize) -> Self {
        let (zero, one) = (kind.of(0.0), kind.of(1.0));
        let (start, never) = (Clock { whole: zero, part: zero }, Clock { whole: kind.of(NEVER), part: zero });
        let still = Oscillator { frequency: one, equilibrium: zero, displacement: zero, quadrature: zero };
        let track = Track {
            frequency: one,
            excitability: zero,
            frame: [zero; 2],
            axis: [one, zero],
            equilibrium: zero,
            deviation: [zero; 2],
        };
        let mut flight = Self {
            now: start,
            end: start,
            side: one,
            angle: zero,
            rate: zero,
            totals: Vec::with_capacity(modes),
            modes: Vec::with_capacity(modes),
            moved: Vec::with_capacity(modes),
            excitabilities: Vec::with_capacity(modes),
            fastest: one,
            edge: one,
            back: one,
            strong: one,
            weak: one,
            k_t: zero,
            band: one,
            pushed: start,
            tracks: Vec::with_capacity(tracks),
            seen: start,
            integral: zero,
            closes: never,
            window: never,
            active: [false; MOST],
            rows: vec![[0.0; MOST]; ROWS + 2 * modes],
            sight: Sight::default(),
        };
        for _ in 0..modes {
            flight.totals.push(zero);
            flight.modes.push(still);
            flight.moved.push(still);
            flight.excitabilities.push(zero);
        }
        for _ in 0..tracks {
            flight.tracks.push(track);
        }
        flight
    }

    /// Makes all runs of a crew, of bodies and envelopes with so many modes.
    #[inline(always)]
    pub fn fly<C: Crew>(kind: R, modes: usize, tracks: usize, crew: &mut C) {
        let mut flight = Self::new(kind, modes, tracks);
        let mut place = Place::Brake;
        // One place at a time, whose code is here once.
        loop {
            place = match place {
                Place::Coast => Place::Push,
                Place::Push => Place::Brake,
                Place::Brake => {
                    if !flight.fill(crew) {
                        return;
                    }
                    Place::Coast
                }
            };
            flight.go(crew, place);
        }
    }

    /// Gives lanes that have none the next runs; tells whether any has one.
    fn fill<C: Crew>(&mut self, crew: &mut C) -> bool {
        let mut any = false;
        for lane in 0..R::LANES {
            if !self.active[lane] {
                if let Some(setup) = crew.next(lane) {
                    self.begin(lane, &setup, crew.band(lane));
                }
            }
            any |= self.active[lane];
        }
        any
    }

    /// Puts a run into a lane.
    fn begin(&mut self, lane: usize, setup: &Setup, band: f64) {
        let put = |of: &mut R, value: f64| *of = of.with_lane(lane, value);
        self.active[lane] = true;
        self.now = self.now.with_lane(lane, (0, 0));
        self.seen = self.seen.with_lane(lane, (0, 0));
        self.end = self.end.with_lane(lane, setup.end);
        let window = setup.window.unwrap_or((NEVER as u64, 0));
        self.window = self.window.with_lane(lane, window);
        self.closes = self.closes.with_lane(lane, window);
        put(&mut self.side, 1.0);
        put(&mut self.angle, setup.angle);
        put(&mut self.rate, setup.rate);
        put(&mut self.edge, setup.edge);
        put(&mut self.back, setup.back);
        put(&mut self.strong, setup.strong);
        put(&mut self.weak, setup.weak);
        put(&mut self.k_t, setup.k_t);
        put(&mut self.band, band);
        put(&mut self.integral, 0.0);
        let mut fastest = 0.0_f64;
        for (index, [frequency, k, x, y]) in setup.modes.iter().copied().enumerate() {
            fastest = fastest.max(frequency);
            put(&mut self.modes[index].frequency, frequency);
            put(&mut self.modes[index].quadrature, y);
            put(&mut self.excitabilities[index], k);
            put(&mut self.totals[index], x);
        }
        put(&mut self.fastest, fastest);
        for (track, of) in self.tracks.iter_mut().zip(&setup.tracks) {
            let [frequency, k, x, y] = *of;
            put(&mut track.frequency, frequency);
            put(&mut track.excitability, k);
            put(&mut track.equilibrium, 0.0);
            for (part, value) in [x, y].into_iter().enumerate() {
                put(&mut track.frame[part], value);
                put(&mut track.deviation[part], value);
                put(&mut track.axis[part], [1.0, 0.0][part]);
            }
        }
    }

    /// The motion of one place, and the switching at its end.
    #[inline(always)]
    fn go<C: Crew>(&mut self, crew: &mut C, place: Place) {
        let one = self.angle.of(1.0);
        let (moment, towards, level) = match place {
            Place::Coast => (self.weak, one, self.edge),
            Place::Push => (-self.strong, -one, self.back),
            Place::Brake => (self.strong, one, self.edge),
        };
        self.depart(moment);
        for index in 0..self.modes.len() {
            self.moved[index] = self.modes[index];
        }
        if place == Place::Push {
            self.pushed = self.now;
        }
        let mut span = (self.now, one);
        let mut right = one.le(one);
        if place == Place::Brake {
            span = self.brake(crew);
        } else {
            // No push leads to the level that is far away.
            let far = if place == Place::Coast { -self.edge } else { one.of(FAR) };
            let levels = [Level { angle: level, towards }, Level { angle: far, towards: -towards }];
            (span, right) = self.guarded(crew, place, moment, &levels);
        }
        self.arrive(crew, place, moment, span);
        if place == Place::Coast {
            self.mirror(R::select(right, one, -one));
        }
        self.tell(
            crew,
            match place {
                Place::Coast => Place::Push,
                Place::Push => Place::Brake,
                Place::Brake => Place::Coast,
            },
        );
    }

    /// Seen in the mirror, what reaches the left boundary reaches the right one.
    #[inline(always)]
    fn mirror(&mut self, mirror: R) {
        self.side = mirror * self.side;
        self.angle = mirror * self.angle;
        self.rate = mirror * self.rate;
        for index in 0..self.modes.len() {
            self.totals[index] = mirror * self.totals[index];
            self.modes[index].quadrature = mirror * self.modes[index].quadrature;
        }
        for index in 0..self.tracks.len() {
            let track = &mut self.tracks[index];
            track.equilibrium = mirror * track.equilibrium;
            for part in 0..2 {
                track.frame[part] = mirror * track.frame[part];
                track.deviation[part] = mirror * track.deviation[part];
            }
        }
    }

    /// The brake, which lasts as long as the law says.
    #[inline(always)]
    fn brake<C: Crew>(&mut self, crew: &mut C) -> (Clock<R>, R) {
        let nearest = nearest_ticks(self.k_t * self.now.since(self.pushed).seconds());
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
        for index in 0..self.modes.len() {
            let mode = &mut self.moved[index];
            mode.turn(sincos(mode.frequency * after));
        }
        (Clock::of_ticks(ticks), after)
    }

    /// The modes turn about equilibria of this moment from now on.
    #[inline(always)]
    fn depart(&mut self, moment: R) {
        for index in 0..self.modes.len() {
            let mode = &mut self.modes[index];
            mode.equilibrium = self.excitabilities[index] * moment;
            mode.displacement = self.totals[index] - mode.equilibrium;
        }
        for track in &mut self.tracks {
            track.command(moment);
        }
    }

    /// Finds the first trip: after how long, and of which level.
    #[inline(always)]
    fn guarded<C: Crew>(
        &mut self,
        crew: &mut C,
        place: Place,
        moment: R,
        levels: &[Level<R>; 2],
    ) -> ((Clock<R>, R), R::Mask) {
        let (zero, one) = (moment.of(0.0), moment.of(1.0));
        let from = Departure { angle: self.angle, rate: self.rate, moment, fastest: self.fastest };
        let found: Found<R> = locate(&from, levels, &mut self.moved);
        let certain = found.certain;
        if certain.all() {
            return ((Clock::of_ticks(found.ticks), found.after), found.first);
        }
        // Lanes without a run stay where they are.
        for (moved, mode) in self.moved.iter_mut().zip(&self.modes) {
            moved.displacement = R::select(certain, moved.displacement, mode.displacement);
            moved.quadrature = R::select(certain, moved.quadrature, mode.quadrature);
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
            let Some(found) = crew.search(lane, place, &self.sight) else {
                // Nothing within the run, whose end is before any trip that lies so far ahead.
                span = span.with_lane(lane, (NEVER as u64, 0));
                continue;
            };
            let (parts, seconds) = found.after;
            if !(seconds > 0.0 && seconds < SHORT) {
                crew.give_up(lane);
                self.active[lane] = false;
                continue;
            }
            span = span.with_lane(lane, parts);
            after = after.with_lane(lane, seconds);
            if place == Place::Coast {
                first = first.with_lane(lane, if found.right == (side > 0.0) { 1.0 } else { -1.0 });
            }
            for (moved, [x, y]) in self.moved.iter_mut().zip(&found.modes) {
                moved.equilibrium = moved.equilibrium.with_lane(lane, 0.0);
                moved.displacement = moved.displacement.with_lane(lane, side * x);
                moved.quadrature = moved.quadrature.with_lane(lane, side * y);
            }
        }
        ((span, after), zero.lt(first))
    }

    /// Ends the motion that departed last, such a span after its departure: windows close on the way, and runs
    /// that end do so.
    #[inline(always)]
    fn arrive<C: Crew>(&mut self, crew: &mut C, place: Place, moment: R, (span, h): (Clock<R>, R)) {
        let zero = h.of(0.0);
        let until = self.now.plus(span);
        let ends = !until.not_after(self.end);
        let until = Clock::select(ends, self.end, until);
        if C::LISTENS {
            let span = until.since(self.now).seconds();
            self.stray(crew, place, moment, span, until);
        }
        self.follow(crew, until);
        self.now = until;
        self.angle = self.angle + h * (self.rate + h.of(0.5) * moment * h);
        self.rate = self.rate + moment * h;
        for index in 0..self.modes.len() {
            let moved = self.moved[index];
            self.totals[index] = moved.equilibrium + moved.displacement;
            self.modes[index].quadrature = moved.quadrature;
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

    /// Follows the envelope to an instant of each lane, by the windows that close on the way.
    #[inline(always)]
    fn follow<C: Crew>(&mut self, crew: &mut C, until: Clock<R>) {
        if self.tracks.is_empty() {
            return;
        }
        let zero = self.angle.of(0.0);
        let mut goes_on = zero.le(zero);
        loop {
            let due = goes_on & self.closes.not_after(until);
            let at = Clock::select(due, self.closes, until);
            let (time, span) = (at.seconds(), at.since(self.seen).seconds());
            for index in 0..self.tracks.len() {
                let mut advanced = self.tracks[index];
                let integral = advanced.advance(time, span);
                self.integral = self.integral + R::select(goes_on, integral, zero);
                self.tracks[index] = Track::select(goes_on, &advanced, &self.tracks[index]);
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

    /// Windows close now in the lanes that have a 1.
    fn close<C: Crew>(&mut self, crew: &mut C, closing: R) {
        for lane in 0..R::LANES {
            if closing.lane(lane) > 0.0 {
                let (integral, gain) = (self.integral.lane(lane), self.k_t.lane(lane));
                let gain = crew.closed(lane, self.seen.lane(lane), integral, gain);
                self.k_t = self.k_t.with_lane(lane, gain);
            }
        }
    }

    /// Where bounds do not keep the angle within the band on the motion that ends, the crew has to see for itself.
    #[inline(always)]
    fn stray<C: Crew>(&mut self, crew: &mut C, place: Place, moment: R, span: R, until: Clock<R>) {
        let zero = span.of(0.0);
        let (mut centre, mut reach) = (zero, zero);
        for mode in &self.modes {
            centre = centre + mode.equilibrium;
            reach = reach + mode.reach();
        }
        let end = self.angle + span * (self.rate + span.of(0.5) * moment * span);
        let (mut low, mut high) = (self.angle.min(end), self.angle.max(end));
        // The crest of the parabola, if it is on the way.
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

    /// Tells a switching of each lane.
    #[inline(always)]
    fn tell<C: Crew>(&mut self, crew: &mut C, to: Place) {
        if !C::LISTENS {
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

    /// Writes down what there is to look at.
    #[inline(always)]
    fn write(&mut self) {
        let [whole, part, side, k_t, angle, rate, rest @ ..] = &mut self.rows[..] else { return };
        self.now.whole.store(whole);
        self.now.part.store(part);
        self.side.store(side);
        self.k_t.store(k_t);
        (self.side * self.angle).store(angle);
        (self.side * self.rate).store(rate);
        for index in 0..self.modes.len() {
            (self.side * self.totals[index]).store(&mut rest[2 * index]);
            (self.side * self.modes[index].quadrature).store(&mut rest[2 * index + 1]);
        }
    }

    /// Looks at a lane of what was written down.
    fn look(&mut self, lane: usize) {
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
