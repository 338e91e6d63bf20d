//! Motion of the flexible body over a segment, during which the commanded loads are constant.

use std::sync::Arc;

use nalgebra::{Matrix3, Quaternion};

mod amplitudes;
mod level;

use flexsc_numerics::attitude::Vector;

use super::appendages::ArticulatedMotion;
use super::bearing::{Bearing, BearingLoads, RotorState, SlipDirection};
use super::common::{SharedBody, SharedSteps, StepResponses};
use super::gimbal::{self, Gimbal, GimbalMomentum};
use super::method::StepMemory;
use super::model::{BodyConstants, FlexibleBody, FreeMode, Rotor, Surroundings, tensor};
use super::pace::{BodyMotion, ModeAmplitude, StepLevels};
use super::response::ModeResponse;
use super::rotation::SmallRotation;
use super::state::{BodyView, IntegratorState, NextStep};
use super::step::IntegrationStep;

/// Number of steps between two calls of `go_on` (cancellation check).
const STEPS: u64 = 256;

/// Number of off-grid step lengths whose responses are kept, because lengths between samples and commands recur.
const BESIDE: usize = 16;

/// Three-axis motion of a flexible body, and the loads that act on it during the segment.
#[derive(Clone, Debug)]
pub struct ThreeAxisMotion {
    pub(super) model: Arc<BodyConstants>,
    pub(super) pace: Arc<StepLevels>,
    /// Data shared with other runs; `None` once the body's constants are its own.
    pub(super) known: Option<Arc<SharedBody>>,
    /// States at the start of the segment, at the last instant of the step grid, and at the current instant.
    pub(super) departed: IntegratorState,
    pub(super) grid: IntegratorState,
    pub(super) here: IntegratorState,
    /// Times of `grid` and of `here` since the start of the segment (s).
    pub(super) reached: f64,
    pub(super) now: f64,
    pub(super) seen: BodyView,
    pub(super) acting: SegmentLoads,
    /// Bearings of the rotors (or empty), how each rotor slips, and whether it has just stopped or broken away.
    pub(super) bearings: Vec<Bearing>,
    pub(super) slips: Vec<SlipDirection>,
    pub(super) resting: Vec<bool>,
    /// Next step of the grid, if it has been searched for stick-slip events.
    pub(super) ahead: Option<NextStep>,
    /// Responses over a grid step at each level, computed on first use.
    pub(super) regular: Vec<Option<StepResponses>>,
    /// Responses over the last off-grid steps, and the index that is replaced next.
    pub(super) beside: Vec<StepResponses>,
    pub(super) next_beside: usize,
    /// Level of the next grid step, once it has been determined.
    next: Option<usize>,
    /// Amplitude of each mode at the start of the next step.
    amplitudes: Vec<ModeAmplitude>,
    work: StepMemory,
    effort: StepCounts,
    /// Driven appendages, if any.
    pub(super) driving: Option<Box<ArticulatedMotion>>,
}

/// Loads that act from the start of a segment.
#[derive(Clone, Debug, Default)]
pub struct SegmentLoads {
    /// Torque on the hub in its axes (N m).
    pub torque: Vector,
    /// Modal forces other than phi' times `torque`, which the motion adds itself (N/sqrt(kg)); empty if there are
    /// none.
    pub forces: Vec<f64>,
    /// Torque on the hub per unit of each mode, by forces whose points of application move (N/sqrt(kg)); empty if
    /// none.
    pub levers: Vec<Vector>,
    /// Acceleration of the centre of mass, in the hub's axes (m/s²).
    pub push: Vector,
    /// Rotors. One that was not present before adds its momentum to the body's.
    pub rotors: Vec<Rotor>,
    /// Rotors in gimbals. One that was not present before adds its momentum to the body's.
    pub gimbals: Vec<Gimbal>,
}

/// Computational cost of the motion.
#[derive(Copy, Clone, Debug, Default, PartialEq, Eq)]
pub struct StepCounts {
    /// Number of steps.
    pub steps: u64,
    /// Number of iterations over the stages of these steps.
    pub passes: u64,
}

impl FlexibleBody {
    /// Returns the step length (s) that resolves all modes while the body turns, and torques change, at the given
    /// rate (rad/s).
    pub fn step(&self, rate: f64) -> f64 {
        let pace = StepLevels::new(&BodyConstants::new(self));
        pace.length(pace.level(BodyMotion { rate, carried: rate, acceleration: 0.0, amplitudes: None }))
    }
}

impl SegmentLoads {
    /// Returns the momentum of the rotors `t` (s) after the start of the segment (N m s), and its rate (N m).
    fn rotors(&self, t: f64) -> (Vector, Vector) {
        self.rotors.iter().fold((Vector::zeros(), Vector::zeros()), |(sum, rate), rotor| {
            (sum + rotor.axis * (rotor.momentum + rotor.torque * t), rate + rotor.axis * rotor.torque)
        })
    }

    /// Creates the step of `h` (s) that begins `t` (s) after the start of the segment.
    fn step<'a>(
        &'a self,
        model: &'a BodyConstants,
        (responses, bearings, slips): (&'a [ModeResponse], &'a [Bearing], &'a [SlipDirection]),
        h: f64,
        t: f64,
        around: Option<(&'a dyn Surroundings, f64)>,
        driving: Option<&'a ArticulatedMotion>,
    ) -> IntegrationStep<'a> {
        let count = self.rotors.len().min(bearings.len());
        let loads =
            BearingLoads { bearings: &bearings[..count], rotors: &self.rotors, slips: &slips[..count] };
        IntegrationStep {
            model,
            responses,
            h,
            torque: self.torque,
            push: (self.push != Vector::zeros()).then_some(self.push),
            // With driven appendages, modal forces follow from the force alone.
            forces: if driving.is_some() { &[] } else { &self.forces },
            levers: &self.levers,
            rotors: if count > 0 { (Vector::zeros(), Vector::zeros()) } else { self.rotors(t) },
            borne: (count > 0).then_some(loads),
            swung: GimbalMomentum::over(&self.gimbals, t, h),
            around: around.map(|(around, since)| (around, since + t)),
            driven: driving.map(|driving| (driving, t)),
        }
    }
}

impl ThreeAxisMotion {
    /// Creates the motion of a body from the attitude of its mean axes, its rigid rate (rad/s), and q and q' of each
    /// mode (m sqrt(kg), m sqrt(kg)/s; zero if missing). Nothing acts.
    pub fn new(body: &FlexibleBody, attitude: Quaternion<f64>, rigid: Vector, modes: &[[f64; 2]]) -> Self {
        Self::with_shared(&SharedSteps::default(), body, (attitude, rigid), modes)
    }

    /// Creates the motion as [`ThreeAxisMotion::new`] does, with data shared by the runs of this body.
    pub fn with_shared(
        common: &SharedSteps,
        body: &FlexibleBody,
        (attitude, rigid): (Quaternion<f64>, Vector),
        modes: &[[f64; 2]],
    ) -> Self {
        let known = common.for_body(body);
        let model = known.model.clone();
        let turning = body.inertia * rigid;
        let at = |index: usize| modes.get(index).copied().unwrap_or_default();
        let (mut bent, mut rate) = (Vector::zeros(), rigid);
        for (index, mode) in body.modes.iter().enumerate() {
            let [q, speed] = at(index);
            bent += mode.rotation * q;
            rate += mode.rotation * speed;
        }
        let moved = body.modes.iter().enumerate();
        let momentum =
            moved.clone().fold(turning, |sum, (index, mode)| sum + mode.moments * rate * at(index)[0]);
        let canonical = |(index, mode): (usize, &FreeMode)| {
            let [q, speed] = at(index);
            [q, (speed - mode.rotation.dot(&turning)) / mode.frequency, 0.0, 0.0]
        };
        let state = IntegratorState {
            attitude,
            momentum: SmallRotation::new(bent).to_mean_axes(&momentum),
            turned: Vector::zeros(),
            moved: [Vector::zeros(); 2],
            lost: (Quaternion::default(), Vector::zeros(), Vector::zeros()),
            modes: moved.map(canonical).collect(),
            spins: Vec::new(),
        };
        let mut turning = Self {
            pace: known.pace.clone(),
            known: Some(known),
            grid: state.clone(),
            here: state.clone(),
            reached: 0.0,
            now: 0.0,
            seen: BodyView::empty(state.modes.len()),
            acting: SegmentLoads::default(),
            bearings: Vec::new(),
            slips: Vec::new(),
            resting: Vec::new(),
            ahead: None,
            regular: Vec::new(),
            beside: Vec::new(),
            next_beside: 0,
            next: None,
            amplitudes: vec![ModeAmplitude::default(); state.modes.len()],
            work: StepMemory::new(state.modes.len()),
            effort: StepCounts::default(),
            driving: None,
            departed: state,
            model,
        };
        turning.look();
        turning
    }

    /// Sets the bearings of the rotors, one each, before the first segment.
    pub fn set_bearings(&mut self, bearings: Vec<Bearing>) {
        for state in [&mut self.departed, &mut self.grid, &mut self.here] {
            state.spins = vec![RotorState::default(); bearings.len()];
        }
        self.slips = vec![SlipDirection::default(); bearings.len()];
        self.resting = vec![false; bearings.len()];
        self.bearings = bearings;
    }

    /// Begins a segment at the current instant, under the given loads; call `settle` next if there are rotors in
    /// bearings.
    pub fn depart(&mut self, acting: &SegmentLoads) {
        let counts = |acting: &SegmentLoads| (acting.rotors.len(), acting.gimbals.len());
        let same = counts(acting) == counts(&self.acting);
        let plain = same && self.bearings.is_empty() && self.driving.is_none() && acting.gimbals.is_empty();
        let stored = plain.then(|| self.acting.rotors(self.now).0);
        if !same {
            self.add_rotors(acting);
        }
        self.ahead = None;
        self.move_on();
        (self.acting.torque, self.acting.push) = (acting.torque, acting.push);
        self.acting.forces.clone_from(&acting.forces);
        self.acting.levers.clone_from(&acting.levers);
        self.acting.rotors.clone_from(&acting.rotors);
        self.acting.gimbals.clone_from(&acting.gimbals);
        self.departed.copy_from(&self.here);
        self.grid.copy_from(&self.here);
        (self.reached, self.now) = (0.0, 0.0);
        // Skip the update if the same state with the same rotor momentum is already in view.
        let bits = |of: Vector| of.data.0[0].map(f64::to_bits);
        if stored.is_none_or(|stored| bits(stored) != bits(self.acting.rotors(0.0).0)) {
            self.look();
        }
    }

    /// Advances the body to `t` (s) after the start of the segment, while `go_on` permits; `around` holds the
    /// environment and the segment's start time since the start of the run (s). Stops at an earlier stick-slip event
    /// and then returns its time (s).
    ///
    /// # Errors
    /// The error of `go_on`.
    pub fn advance<E>(
        &mut self,
        t: f64,
        around: Option<(&dyn Surroundings, f64)>,
        mut go_on: impl FnMut() -> Result<(), E>,
    ) -> Result<Option<f64>, E> {
        if t < self.reached {
            self.grid.copy_from(&self.departed);
            self.reached = 0.0;
            self.move_on();
        }
        let (mut steps, watches) = (0_u64, self.can_stick());
        loop {
            let level = match self.next {
                Some(level) => level,
                None => self.level(around),
            };
            self.next = Some(level);
            self.ensure_responses(level);
            if watches {
                self.search_next_step(level, around);
                let meets = self.ahead.as_ref().and_then(|ahead| ahead.meets);
                if let Some((at, _)) = meets.filter(|(at, _)| *at <= t) {
                    self.step_off_grid(at - self.reached, around);
                    return Ok(Some(at));
                }
            }
            let Some(Some(StepResponses { h, .. })) = self.regular.get(level) else { break };
            let h = *h;
            if self.reached + h > t {
                break;
            }
            steps += 1;
            if steps.is_multiple_of(STEPS) {
                go_on()?;
            }
            if let Some(ahead) = self.ahead.as_ref().filter(|ahead| watches && ahead.from == self.reached) {
                self.grid.copy_from(&ahead.to);
            } else {
                let mut grid = std::mem::take(&mut self.grid);
                self.advance_grid(level, &mut grid, around);
                self.grid = grid;
            }
            self.reached += h;
            self.move_on();
        }
        self.step_off_grid(t - self.reached, around);
        Ok(None)
    }

    /// Invalidates the data cached for the start of the next step.
    pub(super) fn move_on(&mut self) {
        self.work.invalidate();
        self.next = None;
    }

    /// Advances a state on the grid by one step of the given level; returns the step length (s).
    pub(super) fn advance_grid(
        &mut self,
        level: usize,
        state: &mut IntegratorState,
        around: Option<(&dyn Surroundings, f64)>,
    ) -> Option<f64> {
        let Some(Some(StepResponses { h, responses })) = self.regular.get(level) else { return None };
        let bearings_now = (&responses[..], &self.bearings[..], &self.slips[..]);
        let step =
            self.acting.step(&self.model, bearings_now, *h, self.reached, around, self.driving.as_deref());
        self.effort.passes += u64::from(step.run(state, &mut self.work));
        self.effort.steps += 1;
        Some(*h)
    }

    /// Sets the current state to `h` (s) after the last grid instant, by one off-grid step, and updates the view.
    pub(super) fn step_off_grid(&mut self, h: f64, around: Option<(&dyn Surroundings, f64)>) {
        self.here.copy_from(&self.grid);
        self.now = self.reached + h;
        if h > 0.0 {
            let place = self.ensure_off_grid_responses(h);
            let bearings_now = (&self.beside[place].responses[..], &self.bearings[..], &self.slips[..]);
            let step =
                self.acting.step(&self.model, bearings_now, h, self.reached, around, self.driving.as_deref());
            self.effort.passes += u64::from(step.run(&mut self.here, &mut self.work));
            self.effort.steps += 1;
        }
        self.look();
    }

    /// Advances the body to a stick-slip event at `t` (s) after the start of the segment, within a tick of where the
    /// motion stopped, and marks the event's rotor for `settle`.
    pub fn reach(&mut self, t: f64, around: Option<(&dyn Surroundings, f64)>) {
        self.step_off_grid(t - self.reached, around);
        self.set_event();
    }

    /// Returns the inertia tensor of the deformed body at the current instant (kg m²).
    pub fn inertia(&self) -> Matrix3<f64> {
        if let Some(inertia) = &self.seen.inertia {
            return *inertia;
        }
        let modes = self.model.modes.iter().zip(&self.seen.displacements);
        modes.fold(self.model.inertia, |sum, (of, q)| sum + tensor(of.moments) * *q)
    }

    pub(super) fn look(&mut self) {
        let (mut stored, mut locked) = (Vector::zeros(), Matrix3::zeros());
        if self.bearings.is_empty() {
            stored = self.acting.rotors(self.now).0;
        } else {
            let bearings_now = self.current_bearings(&self.slips);
            stored += bearings_now.stored(self.here.spins.iter().map(|spin| spin.sums.x));
            locked += bearings_now.stuck_inertia();
        }
        if let Some((swung, _)) = gimbal::sum(&self.acting.gimbals, self.now) {
            stored += swung;
        }
        match &self.driving {
            Some(driving) => driving.look(self.now, &self.here, &stored, &mut self.seen),
            None => self.seen.compute(&self.model, &self.here, &stored, &locked),
        }
    }

    /// Returns the view of the body at the current instant.
    pub fn seen(&self) -> &BodyView {
        &self.seen
    }

    /// Returns the energy of each mode at the current instant (J): (q'² + W² q²)/2.
    pub fn energies(&self) -> impl Iterator<Item = f64> + '_ {
        let seen = self.seen.displacements.iter().zip(&self.seen.rates);
        seen.zip(self.model.modes.iter().enumerate()).map(|((q, rate), (index, mode))| {
            let stretched = self.seen.frequencies.get(index).unwrap_or(&mode.frequency) * q;
            0.5 * (rate * rate + stretched * stretched)
        })
    }

    /// Returns the computational cost since the start.
    pub fn effort(&self) -> StepCounts {
        self.effort
    }

    /// Replaces the step levels.
    #[cfg(test)]
    pub(super) fn set_pace(&mut self, pace: StepLevels) {
        self.pace = Arc::new(pace);
        self.regular.clear();
        self.move_on();
    }
}
