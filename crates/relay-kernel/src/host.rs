//! Interface between the kernel and the host of the runs: plain numbers of one lane.

/// Properties that all runs of a batch have in common.
#[derive(Copy, Clone, Debug, Default, PartialEq, Eq)]
pub struct LaneShape {
    /// Number of modes of the body.
    pub modes: usize,
    /// Number of modes of the envelope's model.
    pub tracks: usize,
    /// True if a mode of the body or of the envelope is damped.
    pub is_damped: bool,
}

/// Initial state and parameters of one run, as plain numbers.
#[derive(Clone, Debug, Default)]
pub struct RunSetup {
    /// Properties in common with the other runs.
    pub structure: LaneShape,
    /// Rigid angle (rad).
    pub angle: f64,
    /// Rigid rate (rad/s).
    pub rate: f64,
    /// Modes of the body: frequency (rad/s), excitability (s²), displacement and quadrature (rad), damping ratio.
    pub modes: Vec<[f64; 5]>,
    /// Modes of the envelope's model, as `modes`, with the phasor's imaginary part in place of the quadrature.
    pub tracks: Vec<[f64; 5]>,
    /// Half-width of the dead zone (rad).
    pub edge: f64,
    /// Angle at which the brake begins (rad).
    pub back: f64,
    /// Strong and weak torque (N m).
    pub torques: [f64; 2],
    /// Angular acceleration by the strong torque (rad/s²).
    pub strong: f64,
    /// Angular acceleration by the weak torque (rad/s²).
    pub weak: f64,
    /// Braking gain.
    pub k_t: f64,
    /// Half-width of the band about the target (rad).
    pub band: f64,
    /// End of the run: whole seconds and femtoseconds.
    pub end: (u64, u64),
    /// Length of a window of the envelope: whole seconds and femtoseconds; `None` without windows.
    pub window: Option<(u64, u64)>,
}

impl RunSetup {
    /// Returns the torque at a phase of the cycle (N m).
    pub fn torque(&self, phase: CyclePhase, side: f64) -> f64 {
        let [strong, weak] = self.torques;
        match phase {
            CyclePhase::Coast => side * weak,
            CyclePhase::Push => -side * strong,
            CyclePhase::Brake => side * strong,
        }
    }
}

/// Phase of the limit cycle.
#[derive(Copy, Clone, Debug, PartialEq, Eq)]
pub enum CyclePhase {
    /// In the dead zone, under the weak torque.
    Coast,
    /// Accelerating back from the right boundary.
    Push,
    /// Decelerating after the push.
    Brake,
}

/// State of one lane at one instant, without mirroring. Displacements are relative to 0, not to an equilibrium.
#[derive(Clone, Debug, Default)]
pub struct LaneState {
    /// Time: whole seconds and femtoseconds.
    pub time: (u64, u64),
    /// Rigid angle (rad).
    pub angle: f64,
    /// Rigid rate (rad/s).
    pub rate: f64,
    /// Displacement and quadrature of each mode (rad).
    pub modes: Vec<[f64; 2]>,
    /// Side of the motion: 1, or -1 if it is mirrored.
    pub side: f64,
    /// Braking gain.
    pub gain: f64,
}

/// State of a run at the start of a motion, as plain numbers, without mirroring; passed back to the host.
#[derive(Clone, Debug, Default)]
pub struct LaneHandover {
    /// Phase of the cycle that begins.
    pub phase: Option<CyclePhase>,
    /// State of the body.
    pub from: LaneState,
    /// Start time of the last push.
    pub push_start: (u64, u64),
    /// Number of switchings since the last window of switchings ended, and the time of that end.
    pub switched: (u64, (u64, u64)),
    /// Time up to which the envelope is integrated.
    pub integrated_to: (u64, u64),
    /// Integral of the envelope since the end of the last window.
    pub integral: f64,
    /// Phasors of the envelope: in the rotating frame (2), axis of that frame (2), equilibrium, deviation (2).
    pub tracks: Vec<[f64; 7]>,
}

/// Threshold crossing found by the host's search.
#[derive(Clone, Debug, Default)]
pub struct FoundCrossing {
    /// Time since the start of the motion: whole seconds and femtoseconds, and in seconds.
    pub after: ((u64, u64), f64),
    /// True if the right boundary is reached, without mirroring, or the only threshold.
    pub right: bool,
    /// Displacement from 0 and quadrature of each mode at the crossing (rad).
    pub modes: Vec<[f64; 2]>,
}

/// Host of the runs in the lanes: supplies setups, receives events.
pub trait LaneHost {
    /// Returns true if `on_switching` must be called for every switching.
    fn wants_switchings(&self) -> bool;
    /// Returns true if `on_possible_band_exit` must be called where bounds do not keep the angle within the band.
    fn wants_band_exits(&self) -> bool;
    /// Returns the next run for a lane whose last run has ended.
    fn next_run(&mut self, lane: usize) -> Option<&RunSetup>;
    /// Searches the first crossing of a lane for a motion from `from` at a phase of the cycle; returns true if there
    /// is one within the run.
    fn find_crossing(
        &mut self,
        lane: usize,
        phase: CyclePhase,
        from: &LaneState,
        found: &mut FoundCrossing,
    ) -> bool;
    /// Rejects a lane that the kernel cannot continue: its run must be computed singly.
    fn reject(&mut self, lane: usize);
    /// Receives a lane that has switched [`SWITCHINGS`](crate::SWITCHINGS) times in a span too short for a motion; its
    /// run ends.
    fn chatters(&mut self, lane: usize, now: (u64, u64));
    /// Receives a switching of the law to a phase of the cycle.
    fn on_switching(&mut self, lane: usize, next: CyclePhase, state: &LaneState);
    /// Receives the envelope integral of a window that has ended; returns the braking gain from then on.
    fn on_window(&mut self, lane: usize, now: (u64, u64), integral: f64, gain: f64) -> f64;
    /// Receives a motion from `from`, at a phase of the cycle, during which the angle may leave the band (rad) before
    /// `until`.
    fn on_possible_band_exit(&mut self, lane: usize, phase: CyclePhase, from: &LaneState, until: (u64, u64));
    /// Returns true if the run must stop.
    fn should_stop(&self) -> bool {
        false
    }
    /// Receives a single run at the last switching before its end, to be continued by the host.
    fn hand_over(&mut self, _rest: LaneHandover) {}
}
