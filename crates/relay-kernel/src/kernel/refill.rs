//! Assignment of runs to the lanes of the kernel.

#![allow(clippy::inline_always, reason = "inside functions with a target feature nothing else is inlined")]
#![allow(clippy::needless_range_loop, reason = "adaptors of iterators lack the processor's instructions")]

use flexsc_dynamics::damping::DampingRule;
use flexsc_dynamics::predicted_crossing::{FARTHEST_TURN, PredictedMode};
use flexsc_numerics::lanes::{LaneFloat, SimdWidth4};

use super::mode::LaneMode;
use super::outlined::RunStart;
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
        let mode = LaneMode { frequency: one, excitability: zero, damping, start: [zero; 2], end: [zero; 2] };
        let mut kernel = Self {
            now: start,
            end: start,
            side: one,
            angle: zero,
            rate: zero,
            modes: Vec::with_capacity(modes),
            predicted_modes: Vec::with_capacity(modes),
            fastest: one,
            longest: one,
            edge: one,
            back: one,
            strong: one,
            weak: one,
            k_t: zero,
            band: one,
            push_start: start,
            push_duration: zero,
            tracks: Vec::with_capacity(tracks),
            simd: SimdWidth4::best(),
            cycles: 0,
            next_chatter_check: u64::MAX,
            marks: [0; MOST],
            marked: start,
            has_windows: false,
            wants_switchings: false,
            wants_band_exits: false,
            integrated_to: start,
            integral: zero,
            closes: never,
            window: never,
            active: [false; MOST],
            rows: vec![[0.0; MOST]; ROWS + 2 * modes],
            lane_state: LaneState::default(),
            found: FoundCrossing::default(),
        };
        for _ in 0..modes {
            kernel.modes.push(mode);
            kernel.predicted_modes.push(still);
        }
        for _ in 0..tracks {
            kernel.tracks.push(track);
        }
        kernel
    }

    /// Assigns the next runs to idle lanes; returns true if any lane is active.
    #[inline(always)]
    pub(super) fn refill(&mut self, host: &mut dyn LaneHost) -> bool {
        let mut any = false;
        for lane in 0..R::LANES {
            if !self.active[lane]
                && let Some(setup) = host.next_run(lane)
            {
                self.angle.run_outlined(RunStart { kernel: self, lane, setup });
            }
            any |= self.active[lane];
        }
        // The host's requests may change with the runs.
        (self.wants_switchings, self.wants_band_exits) = (host.wants_switchings(), host.wants_band_exits());
        any
    }

    /// Initialises a lane with a run.
    #[inline(always)]
    pub(super) fn begin(&mut self, lane: usize, setup: &RunSetup) {
        let set = |lanes: &mut R, value: f64| *lanes = lanes.with_lane(lane, value);
        self.active[lane] = true;
        self.marks[lane] = self.cycles;
        self.marked = self.marked.with_lane(lane, (0, 0));
        self.next_chatter_check = self.next_chatter_check.min(self.cycles + CYCLES);
        self.now = self.now.with_lane(lane, (0, 0));
        self.integrated_to = self.integrated_to.with_lane(lane, (0, 0));
        self.end = self.end.with_lane(lane, setup.end);
        self.has_windows |= setup.window.is_some();
        let window = setup.window.unwrap_or((NEVER as u64, 0));
        self.window = self.window.with_lane(lane, window);
        self.closes = self.closes.with_lane(lane, window);
        set(&mut self.side, 1.0);
        set(&mut self.angle, setup.angle);
        set(&mut self.rate, setup.rate);
        set(&mut self.edge, setup.edge);
        set(&mut self.back, setup.back);
        set(&mut self.strong, setup.strong);
        set(&mut self.weak, setup.weak);
        set(&mut self.k_t, setup.k_t);
        set(&mut self.band, setup.band);
        set(&mut self.integral, 0.0);
        let mut fastest = 0.0_f64;
        for (index, [frequency, k, x, y, ratio]) in setup.modes.iter().copied().enumerate() {
            fastest = fastest.max(frequency);
            let mode = &mut self.modes[index];
            set(&mut mode.frequency, frequency);
            set(&mut mode.excitability, k);
            set(&mut mode.start[0], x);
            set(&mut mode.start[1], y);
            mode.damping = mode.damping.with_lane(lane, frequency, ratio);
        }
        set(&mut self.fastest, fastest);
        set(&mut self.longest, FARTHEST_TURN / fastest);
        for (track, values) in self.tracks.iter_mut().zip(&setup.tracks) {
            let [frequency, k, x, y, ratio] = *values;
            track.damping = track.damping.with_lane(lane, frequency, ratio);
            set(&mut track.frequency, frequency);
            set(&mut track.excitability, k);
            set(&mut track.equilibrium, 0.0);
            for (part, value) in [x, y].into_iter().enumerate() {
                set(&mut track.now.frame[part], value);
                set(&mut track.now.deviation[part], value);
                set(&mut track.now.axis[part], [1.0, 0.0][part]);
            }
        }
    }
}
