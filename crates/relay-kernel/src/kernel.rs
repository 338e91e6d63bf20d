//! Kernel of the relay law: runs in SIMD lanes, at the same phase of the cycle, each with its own time.
//!
//! The law's cycle is coast, push and brake in every run. The lanes of a [`RelayKernel`] are at the same phase of it, each
//! at its own time; coordinates are mirrored where the left boundary is reached, so that all push back from the
//! right. A lane whose run has ended receives the next run at the end of the cycle. The results of a lane do not
//! depend on other lanes.

#![allow(clippy::inline_always, reason = "inside functions with a target feature nothing else is inlined")]
#![allow(clippy::needless_range_loop, reason = "adaptors of iterators lack the processor's instructions")]

mod chatter;
mod mode;
mod outlined;
mod readout;
mod refill;
mod uncertain;

use flexsc_dynamics::damping::DampingRule;
use flexsc_dynamics::predicted_crossing::{
    PredictedCrossing, PredictedLevel, PredictedMode, SegmentStart, predict,
};
use flexsc_numerics::lanes::{LaneFloat, Mask, SimdWidth4};

use super::envelope_lanes::{self, EnvelopePhasor, PhasorState};
use super::host::{CyclePhase, FoundCrossing, LaneHost, LaneShape, LaneState};
use super::lane_time::{LaneTime, nearest_ticks};
use mode::LaneMode;
use outlined::{EnvelopeSpan, Prediction};
use uncertain::UncertainCrossings;

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
fn mirrored<R: LaneFloat>(mirror: Option<R>, number: R) -> R {
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
    predicted_modes: Vec<PredictedMode<R, D>>,
    fastest: R,
    longest: R,
    edge: R,
    back: R,
    strong: R,
    weak: R,
    k_t: R,
    band: R,
    /// Start of the last push (single runs only), and duration of the last push (s).
    push_start: LaneTime<R>,
    push_duration: R,
    tracks: Vec<EnvelopePhasor<R, D>>,
    /// SIMD instructions for the phasors of a single run.
    simd: SimdWidth4,
    /// True if any run has windows.
    has_windows: bool,
    /// Events that the host requested: switchings, and possible exits from the band.
    wants_switchings: bool,
    wants_band_exits: bool,
    /// Time up to which the envelope is integrated, its integral, end of the current window, and length of the
    /// windows.
    integrated_to: LaneTime<R>,
    integral: R,
    closes: LaneTime<R>,
    window: LaneTime<R>,
    /// True for the lanes with an active run.
    active: [bool; MOST],
    /// Number of cycles since the kernel started, and the number of cycles after which lanes are checked for chatter.
    cycles: u64,
    next_chatter_check: u64,
    /// Number of cycles, and time, at which the last window of switchings of each lane ended.
    marks: [u64; MOST],
    marked: LaneTime<R>,
    /// State of all lanes as plain numbers, and of one of them.
    rows: Vec<[f64; MOST]>,
    lane_state: LaneState,
    /// Result of the last search.
    found: FoundCrossing,
}

impl<R: LaneFloat, D: DampingRule<R>> RelayKernel<R, D> {
    /// True for a single run, which is handed back to the host at its end.
    const IS_SINGLE: bool = R::LANES == 1;

    /// Computes all runs of a host.
    #[inline(always)]
    pub fn run(kind: R, structure: LaneShape, host: &mut dyn LaneHost) {
        let mut kernel = Self::new(kind, structure.modes, structure.tracks);
        let mut phase = CyclePhase::Brake;
        // One phase per iteration, so that its code is instantiated once.
        loop {
            phase = match phase {
                CyclePhase::Coast if !Self::IS_SINGLE || kernel.active[0] => CyclePhase::Push,
                CyclePhase::Push if !Self::IS_SINGLE || kernel.active[0] => CyclePhase::Brake,
                _ => {
                    if !kernel.refill(host) || !kernel.cycle(host) {
                        return;
                    }
                    CyclePhase::Coast
                }
            };
            kernel.compute_phase(host, phase);
        }
    }

    /// Computes the motion of one phase, and the switching at its end.
    #[inline(always)]
    fn compute_phase(&mut self, host: &mut dyn LaneHost, phase: CyclePhase) {
        let one = self.angle.splat(1.0);
        let (moment, towards, level) = match phase {
            CyclePhase::Coast => (self.weak, one, self.edge),
            CyclePhase::Push => (-self.strong, -one, self.back),
            CyclePhase::Brake => (self.strong, one, self.edge),
        };
        for track in &mut self.tracks {
            track.command(moment);
        }
        if Self::IS_SINGLE && phase == CyclePhase::Push {
            self.push_start = self.now;
        }
        let (span, reaches_right) = if phase == CyclePhase::Brake {
            (self.brake(host, moment), one.le(one))
        } else if phase == CyclePhase::Push {
            self.guarded(host, phase, moment, &[PredictedLevel { angle: level, towards }])
        } else {
            let other = PredictedLevel { angle: -self.edge, towards: -towards };
            self.guarded(host, phase, moment, &[PredictedLevel { angle: level, towards }, other])
        };
        if phase == CyclePhase::Push {
            self.push_duration = span.1;
        }
        // After mirroring, the left boundary is the right one.
        let mirror =
            if phase == CyclePhase::Coast { Some(R::select(reaches_right, one, -one)) } else { None };
        self.arrive(host, phase, moment, span, mirror);
        if Self::IS_SINGLE && !self.active[0] {
            return;
        }
        self.report_switchings(
            host,
            match phase {
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
        let nearest = nearest_ticks(self.k_t * self.push_duration);
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
            let mut mode_motion = mode.about_equilibrium(moment);
            mode_motion.advance(after);
            mode.store_end(&mode_motion);
        }
        (LaneTime::from_ticks(ticks), after)
    }

    /// Finds the first crossing: its time, and which threshold is reached.
    #[inline(always)]
    fn guarded<const LEVELS: usize>(
        &mut self,
        host: &mut dyn LaneHost,
        phase: CyclePhase,
        moment: R,
        levels: &[PredictedLevel<R>; LEVELS],
    ) -> ((LaneTime<R>, R), R::Mask) {
        let (fastest, longest) = (self.fastest, self.longest);
        let from = SegmentStart { angle: self.angle, rate: self.rate, moment, fastest, longest };
        let found: PredictedCrossing<R> = match &mut self.modes[..] {
            // Two modes, the usual case, stay in registers.
            [first, second] if !D::IS_DAMPED => {
                let mut two = [first.about_equilibrium(moment), second.about_equilibrium(moment)];
                let found = predict(&from, levels, &mut two);
                first.store_end(&two[0]);
                second.store_end(&two[1]);
                found
            }
            modes => {
                for index in 0..modes.len() {
                    self.predicted_modes[index] = modes[index].about_equilibrium(moment);
                }
                let modes_now = &mut self.predicted_modes[..];
                let found = moment.run_outlined(Prediction { from: &from, levels, modes: modes_now });
                for index in 0..modes.len() {
                    modes[index].store_end(&self.predicted_modes[index]);
                }
                found
            }
        };
        if found.certain.all() {
            return ((LaneTime::from_ticks(found.ticks), found.after), found.first);
        }
        moment.run_outlined(UncertainCrossings { kernel: self, host, phase, found })
    }

    /// Ends the motion after `span`: closes windows on the way, and ends runs that are due. The resulting state is
    /// mirrored if a mirror is given.
    #[inline(always)]
    fn arrive(
        &mut self,
        host: &mut dyn LaneHost,
        phase: CyclePhase,
        moment: R,
        (span, h): (LaneTime<R>, R),
        mirror: Option<R>,
    ) {
        let zero = h.splat(0.0);
        let until = self.now.add(span);
        let ends = !until.is_at_or_before(self.end);
        let until = if ends.any() { LaneTime::select(ends, self.end, until) } else { until };
        if Self::IS_SINGLE && (ends.any() || host.should_stop()) {
            self.hand_over(host, phase);
            return;
        }
        // If no run ends, the duration is the one found.
        let lasts = if ends.any() { None } else { Some(h) };
        if self.wants_band_exits {
            let span = match lasts {
                Some(span) => span,
                None => until.since(self.now).seconds(),
            };
            self.check_band(host, phase, moment, span, until);
        }
        self.follow(host, until, lasts);
        self.now = until;
        self.angle = mirrored(mirror, self.angle + h * (self.rate + h.splat(0.5) * moment * h));
        self.rate = mirrored(mirror, self.rate + moment * h);
        for mode in &mut self.modes {
            for part in 0..2 {
                mode.start[part] = mirrored(mirror, mode.end[part]);
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
        if !self.has_windows {
            return;
        }
        let zero = self.angle.splat(0.0);
        let mut continuing = zero.le(zero);
        loop {
            let due = continuing & self.closes.is_at_or_before(until);
            let reached = if due.any() { LaneTime::select(due, self.closes, until) } else { until };
            let time = reached.seconds();
            let span = match whole.take() {
                Some(whole) if !due.any() => whole,
                _ => reached.since(self.integrated_to).seconds(),
            };
            if Self::IS_SINGLE && !D::IS_DAMPED && self.tracks.len() > 1 {
                self.integral =
                    envelope_lanes::advance_group(self.simd, &mut self.tracks, time, span, self.integral);
            } else {
                time.run_outlined(EnvelopeSpan { kernel: self, continuing, time, span });
            }
            self.integrated_to = LaneTime::select(continuing, reached, self.integrated_to);
            if !due.any() {
                return;
            }
            self.close(host, R::select(due, zero.splat(1.0), zero));
            self.integral = R::select(due, zero, self.integral);
            self.closes = LaneTime::select(due, self.closes.add(self.window), self.closes);
            continuing = due;
        }
    }

    /// Integrates the modes of the envelope one after the other, in the lanes that continue.
    #[inline(always)]
    fn follow_each(&mut self, continuing: R::Mask, time: R, span: R) {
        let zero = time.splat(0.0);
        for track in &mut self.tracks {
            let (mut advanced, mut integral) = track.advance(time, span);
            // Usually all lanes continue.
            if !continuing.all() {
                advanced = PhasorState::select(continuing, &advanced, &track.now);
                integral = R::select(continuing, integral, zero);
            }
            track.now = advanced;
            self.integral = self.integral + integral;
        }
    }

    /// Closes the windows of the lanes in which `closing` is 1.
    fn close(&mut self, host: &mut dyn LaneHost, closing: R) {
        for lane in 0..R::LANES {
            if closing.lane(lane) > 0.0 {
                let (integral, gain) = (self.integral.lane(lane), self.k_t.lane(lane));
                let gain = host.on_window(lane, self.integrated_to.lane(lane), integral, gain);
                self.k_t = self.k_t.with_lane(lane, gain);
            }
        }
    }
}
