//! What a flight asks of who has the runs, and what it tells: plain numbers of one lane.

/// What all runs of a flight have in common.
#[derive(Copy, Clone, Debug, Default, PartialEq, Eq)]
pub struct Structure {
    /// How many modes the body has.
    pub modes: usize,
    /// How many modes the envelope's model has.
    pub tracks: usize,
    /// Whether a mode of the body or of the envelope is damped.
    pub is_damped: bool,
}

/// One run at its start, as plain numbers.
#[derive(Clone, Debug, Default)]
pub struct Setup {
    /// What it has in common with the other runs.
    pub structure: Structure,
    /// Rigid angle (rad).
    pub angle: f64,
    /// Rigid rate (rad/s).
    pub rate: f64,
    /// Modes of the body: frequency (rad/s), excitability (s²), displacement and quadrature (rad), damping ratio.
    pub modes: Vec<[f64; 5]>,
    /// Modes of the envelope's model: the same, with the phasor's imaginary part in place of the quadrature.
    pub tracks: Vec<[f64; 5]>,
    /// Half the width of the dead zone (rad).
    pub edge: f64,
    /// Where the brake begins (rad).
    pub back: f64,
    /// Strong and weak torque (N m).
    pub torques: [f64; 2],
    /// Strong moment (rad/s²).
    pub strong: f64,
    /// Weak moment (rad/s²).
    pub weak: f64,
    /// Braking gain.
    pub k_t: f64,
    /// Half the width of the band about the goal (rad).
    pub band: f64,
    /// The end: whole seconds and femtoseconds.
    pub end: (u64, u64),
    /// The length of a window of the envelope: whole seconds and femtoseconds; none without one.
    pub window: Option<(u64, u64)>,
}

impl Setup {
    /// The torque at a place of the cycle (N m).
    pub fn torque(&self, place: CyclePlace, side: f64) -> f64 {
        let [strong, weak] = self.torques;
        match place {
            CyclePlace::Coast => side * weak,
            CyclePlace::Push => -side * strong,
            CyclePlace::Brake => side * strong,
        }
    }
}

/// A place of the cycle.
#[derive(Copy, Clone, Debug, PartialEq, Eq)]
pub enum CyclePlace {
    /// In the dead zone, under the weak torque.
    Coast,
    /// Back from the right boundary.
    Push,
    /// Against the push.
    Brake,
}

/// One lane at one instant, out of the mirror. Displacements are from 0, not from an equilibrium.
#[derive(Clone, Debug, Default)]
pub struct LaneSight {
    /// Whole seconds and femtoseconds.
    pub at: (u64, u64),
    /// Rigid angle (rad).
    pub angle: f64,
    /// Rigid rate (rad/s).
    pub rate: f64,
    /// Displacement and quadrature of each mode (rad).
    pub modes: Vec<[f64; 2]>,
    /// 1, or -1 in the mirror.
    pub side: f64,
    /// Braking gain.
    pub gain: f64,
}

/// A run at a departure, as plain numbers, out of the mirror.
#[derive(Clone, Debug, Default)]
pub struct LaneRest {
    /// The motion that begins.
    pub place: Option<CyclePlace>,
    /// The body.
    pub from: LaneSight,
    /// When the last push began.
    pub pushed: (u64, u64),
    /// How often it has switched since the last window of switchings ended, and when that was.
    pub switched: (u64, (u64, u64)),
    /// Until when the envelope was followed.
    pub seen: (u64, u64),
    /// The integral of the envelope since the last window closed.
    pub integral: f64,
    /// The phasors of the envelope: in the turning frame, that frame's axis, equilibrium, deviation.
    pub tracks: Vec<[f64; 7]>,
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
    /// Whether it wants switchings.
    fn listens(&self) -> bool;
    /// Whether it wants to know where bounds do not keep the angle within the band.
    fn looks(&self) -> bool;
    /// The next run for a lane, whose last run has ended.
    fn next(&mut self, lane: usize) -> Option<&Setup>;
    /// Looks for the first trip of a lane that departs here at this place, and answers whether there is one within the run.
    fn search(&mut self, lane: usize, place: CyclePlace, from: &LaneSight, found: &mut Searched) -> bool;
    /// A lane cannot go on here: its run has to be made alone.
    fn give_up(&mut self, lane: usize);
    /// A lane has switched [`SWITCHINGS`](crate::SWITCHINGS) times in a span that is too short for a motion, up to here; its run ends.
    fn chatters(&mut self, lane: usize, at: (u64, u64));
    /// The law has switched to a place.
    fn switched(&mut self, lane: usize, to: CyclePlace, now: &LaneSight);
    /// A window has closed, with this integral of the envelope; answers the braking gain from now on.
    fn closed(&mut self, lane: usize, at: (u64, u64), integral: f64, gain: f64) -> f64;
    /// On the motion that departed here, at this place, and ends at an instant, the angle may leave the band (rad).
    fn strays(&mut self, lane: usize, place: CyclePlace, from: &LaneSight, until: (u64, u64));
    /// Whether its run must not go on.
    fn stops(&self) -> bool {
        false
    }
    /// Takes a run that was alone back at the last departure before its end, to go on with it elsewhere.
    fn take_back(&mut self, _rest: LaneRest) {}
}
