//! Assignment of runs to the lanes of the kernel.

#![allow(clippy::inline_always, reason = "inside functions with a target feature nothing else is inlined")]
#![allow(clippy::needless_range_loop, reason = "adaptors of iterators lack the processor's instructions")]

use flexsc_dynamics::damping::DampingRule;
use flexsc_dynamics::predicted_crossing::{FARTHEST_TURN, PredictedMode};
use flexsc_numerics::lanes::{LaneFloat, SimdWidth4};

use super::mode::LaneMode;
use super::{MOST, NEVER, ROWS, RelayKernel};
use crate::chatter::CYCLES;
use crate::envelope_lanes::{EnvelopePhasor, PhasorState};
use crate::host::{FoundCrossing, LaneHost, LaneState, RunSetup};
use crate::lane_time::LaneTime;

impl<R: LaneFloat, D: DampingRule<R>> RelayKernel<R, D> {
    /// Creates lanes without runs, for bodies and envelopes with the given numbers of modes.
    #[inline(always)]
    pub(super) fn new(kind: R, modes: usize, tracks: usize) -> Self {
        let (zero, one) = (kind.splat(0.0), kind.splat(1.0));
        let (start, never) =
            (LaneTime { whole: zero, part: zero }, LaneTime { whole: kind.splat(NEVER), part: zero });
        let damping = D::undamped(kind);
        let still = PredictedMode {
            frequency: one,
            equilibrium: zero,
            displacement: zero,
            quadrature: zero,
            damping,
        };
        let track = EnvelopePhasor {
            frequency: one,
            excitability: zero,
            equilibrium: zero,
            damping,
            now: PhasorState { frame: [zero; 2], axis: [one, zero], deviation: [zero; 2] },
        };
        let mode = LaneMode { frequency: one, excitability: zero, damping, at: [zero; 2], end: [zero; 2] };
        let mut flight = Self {
            now: start,
            end: start,
            side: one,
            angle: zero,
            rate: zero,
            modes: Vec::with_capacity(modes),
            moved: Vec::with_capacity(modes),
            fastest: one,
            longest: one,
            edge: one,
            back: one,
            strong: one,
            weak: one,
            k_t: zero,
            band: one,
            pushed: start,
            lasted: zero,
            tracks: Vec::with_capacity(tracks),
            four: SimdWidth4::best(),
            cycles: 0,
            looked_at: u64::MAX,
            marks: [0; MOST],
            marked: start,
            watches: false,
            listens: false,
            looks: false,
            seen: start,
            integral: zero,
            closes: never,
            window: never,
            active: [false; MOST],
            rows: vec![[0.0; MOST]; ROWS + 2 * modes],
            sight: LaneState::default(),
            found: FoundCrossing::default(),
        };
        for _ in 0..modes {
            flight.modes.push(mode);
            flight.moved.push(still);
        }
        for _ in 0..tracks {
            flight.tracks.push(track);
        }
        flight
    }

    /// Assigns the next runs to idle lanes; returns true if any lane is active.
    #[inline(always)]
    pub(super) fn refill(&mut self, host: &mut dyn LaneHost) -> bool {
        let mut any = false;
        for lane in 0..R::LANES {
            if !self.active[lane]
                && let Some(setup) = host.next_run(lane)
            {
                self.begin(lane, setup);
            }
            any |= self.active[lane];
        }
        // The host's requests may change with the runs.
        (self.listens, self.looks) = (host.wants_switchings(), host.wants_band_exits());
        any
    }

    /// Initialises a lane with a run.
    #[inline(always)]
    fn begin(&mut self, lane: usize, setup: &RunSetup) {
        let put = |of: &mut R, value: f64| *of = of.with_lane(lane, value);
        self.active[lane] = true;
        self.marks[lane] = self.cycles;
        self.marked = self.marked.with_lane(lane, (0, 0));
        self.looked_at = self.looked_at.min(self.cycles + CYCLES);
        self.now = self.now.with_lane(lane, (0, 0));
        self.seen = self.seen.with_lane(lane, (0, 0));
        self.end = self.end.with_lane(lane, setup.end);
        self.watches |= setup.window.is_some();
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
        put(&mut self.band, setup.band);
        put(&mut self.integral, 0.0);
        let mut fastest = 0.0_f64;
        for (index, [frequency, k, x, y, ratio]) in setup.modes.iter().copied().enumerate() {
            fastest = fastest.max(frequency);
            let mode = &mut self.modes[index];
            put(&mut mode.frequency, frequency);
            put(&mut mode.excitability, k);
            put(&mut mode.at[0], x);
            put(&mut mode.at[1], y);
            mode.damping = mode.damping.with_lane(lane, frequency, ratio);
        }
        put(&mut self.fastest, fastest);
        put(&mut self.longest, FARTHEST_TURN / fastest);
        for (track, of) in self.tracks.iter_mut().zip(&setup.tracks) {
            let [frequency, k, x, y, ratio] = *of;
            track.damping = track.damping.with_lane(lane, frequency, ratio);
            put(&mut track.frequency, frequency);
            put(&mut track.excitability, k);
            put(&mut track.equilibrium, 0.0);
            for (part, value) in [x, y].into_iter().enumerate() {
                put(&mut track.now.frame[part], value);
                put(&mut track.now.deviation[part], value);
                put(&mut track.now.axis[part], [1.0, 0.0][part]);
            }
        }
    }
}
