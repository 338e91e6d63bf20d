//! Motion of the flexible body over a segment, during which the commanded loads are constant.

use std::sync::Arc;

use flexsc_numerics::attitude::Vector;
use nalgebra::{Matrix3, Quaternion};

use super::appendages::ArticulatedMotion;
use super::body::{FlexibleBody, FreeMode};
use super::constants::{BodyConstants, tensor};
use super::rotors::{Bearing, RotorState, SlipDirection, gimbal};
use super::segment_loads::SegmentLoads;
use super::shared::{SharedBody, SharedSteps, StepResponses};
use super::small_rotation::SmallRotation;
use super::state::{BodyView, IntegratorState, NextStep};
use super::step::StepMemory;
use super::step_levels::{BodyMotion, ModeAmplitude, StepLevels};
use super::surroundings::TimedSurroundings;

/// Number of steps between two calls of `go_on` (cancellation check).
const STEPS: u64 = 256;

/// Number of off-grid step lengths whose responses are kept, because lengths between samples and commands recur.
pub(super) const EXTRA_RESPONSES: usize = 16;

/// Three-axis motion of a flexible body, and the loads that act on it during the segment.
#[derive(Clone, Debug)]
pub struct ThreeAxisMotion {
    pub(super) model: Arc<BodyConstants>,
    pub(super) levels: Arc<StepLevels>,
    /// Data shared with other runs; `None` once the body's constants are its own.
    pub(super) shared: Option<Arc<SharedBody>>,
    /// States at the start of the segment, at the last instant of the step grid, and at the current instant.
    pub(super) initial: IntegratorState,
    pub(super) grid: IntegratorState,
    pub(super) current: IntegratorState,
    /// Times of `grid` and of `current` since the start of the segment (s).
    pub(super) grid_time: f64,
    pub(super) time: f64,
    pub(super) view: BodyView,
    pub(super) loads: SegmentLoads,
    /// Bearings of the rotors (or empty), how each rotor slips, and whether it has just stopped or broken away.
    pub(super) bearings: Vec<Bearing>,
    pub(super) slips: Vec<SlipDirection>,
    pub(super) at_event: Vec<bool>,
    /// Next step of the grid, if it has been searched for stick-slip events.
    pub(super) next_step: Option<NextStep>,
    /// Responses over a grid step at each level, computed on first use.
    pub(super) grid_responses: Vec<Option<StepResponses>>,
    /// Responses over the last off-grid steps, and the index that is replaced next.
    pub(super) extra_responses: Vec<StepResponses>,
    pub(super) next_extra: usize,
    /// Level of the next grid step, once it has been determined.
    pub(super) next_level: Option<usize>,
    /// Amplitude of each mode at the start of the next step.
    pub(super) amplitudes: Vec<ModeAmplitude>,
    memory: StepMemory,
    counts: StepCounts,
    /// Articulated appendages, on drives or hinges, if any.
    pub(super) appendages: Option<Box<ArticulatedMotion>>,
}

/// Computational cost of the motion.
#[derive(Copy, Clone, Debug, Default, PartialEq, Eq)]
pub struct StepCounts {
    /// Number of steps.
    pub steps: u64,
    /// Number of iterations over the stages of these steps.
    pub iterations: u64,
}

impl FlexibleBody {
    /// Returns the step length (s) that resolves all modes while the body turns, and torques change, at the given
    /// rate (rad/s).
    pub fn step(&self, rate: f64) -> f64 {
        let levels = StepLevels::new(&BodyConstants::new(self));
        levels.length(levels.level(BodyMotion {
            rate,
            elastic_rotation_rate: rate,
            acceleration: 0.0,
            amplitudes: None,
        }))
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
        shared_steps: &SharedSteps,
        body: &FlexibleBody,
        (attitude, rigid): (Quaternion<f64>, Vector),
        modes: &[[f64; 2]],
    ) -> Self {
        let shared = shared_steps.for_body(body);
        let model = shared.model.clone();
        let rigid_momentum = body.inertia * rigid;
        let at = |index: usize| modes.get(index).copied().unwrap_or_default();
        let (mut elastic_rotation, mut rate) = (Vector::zeros(), rigid);
        for (index, mode) in body.modes.iter().enumerate() {
            let [q, speed] = at(index);
            elastic_rotation += mode.rotation * q;
            rate += mode.rotation * speed;
        }
        let indexed = body.modes.iter().enumerate();
        let momentum = indexed
            .clone()
            .fold(rigid_momentum, |sum, (index, mode)| sum + mode.moments * rate * at(index)[0]);
        let canonical = |(index, mode): (usize, &FreeMode)| {
            let [q, speed] = at(index);
            [q, (speed - mode.rotation.dot(&rigid_momentum)) / mode.frequency, 0.0, 0.0]
        };
        let state = IntegratorState {
            mean_attitude: attitude,
            mean_momentum: SmallRotation::new(elastic_rotation).to_mean_axes(&momentum),
            rigid_angle: Vector::zeros(),
            com: [Vector::zeros(); 2],
            rounding: (Quaternion::default(), Vector::zeros(), Vector::zeros()),
            modes: indexed.map(canonical).collect(),
            rotor_states: Vec::new(),
        };
        let mut motion = Self {
            levels: shared.levels.clone(),
            shared: Some(shared),
            grid: state.clone(),
            current: state.clone(),
            grid_time: 0.0,
            time: 0.0,
            view: BodyView::empty(state.modes.len()),
            loads: SegmentLoads::default(),
            bearings: Vec::new(),
            slips: Vec::new(),
            at_event: Vec::new(),
            next_step: None,
            grid_responses: Vec::new(),
            extra_responses: Vec::new(),
            next_extra: 0,
            next_level: None,
            amplitudes: vec![ModeAmplitude::default(); state.modes.len()],
            memory: StepMemory::new(state.modes.len()),
            counts: StepCounts::default(),
            appendages: None,
            initial: state,
            model,
        };
        motion.update_view();
        motion
    }

    /// Sets the bearings of the rotors, one each, before the first segment.
    pub fn set_bearings(&mut self, bearings: Vec<Bearing>) {
        for state in [&mut self.initial, &mut self.grid, &mut self.current] {
            state.rotor_states = vec![RotorState::default(); bearings.len()];
        }
        self.slips = vec![SlipDirection::default(); bearings.len()];
        self.at_event = vec![false; bearings.len()];
        self.bearings = bearings;
    }

    /// Begins a segment at the current instant, under the given loads; call `resolve_stick_slip` next if there are rotors in
    /// bearings.
    pub fn begin_segment(&mut self, loads: &SegmentLoads) {
        let counts = |loads: &SegmentLoads| (loads.rotors.len(), loads.gimbals.len());
        let same_rotors = counts(loads) == counts(&self.loads);
        let simple =
            same_rotors && self.bearings.is_empty() && self.appendages.is_none() && loads.gimbals.is_empty();
        let stored = simple.then(|| self.loads.rotors(self.time).0);
        if !same_rotors {
            self.add_rotors(loads);
        }
        self.next_step = None;
        self.invalidate_step();
        (self.loads.torque, self.loads.com_acceleration) = (loads.torque, loads.com_acceleration);
        self.loads.forces.clone_from(&loads.forces);
        self.loads.force_arms.clone_from(&loads.force_arms);
        self.loads.rotors.clone_from(&loads.rotors);
        self.loads.gimbals.clone_from(&loads.gimbals);
        self.initial.copy_from(&self.current);
        self.grid.copy_from(&self.current);
        (self.grid_time, self.time) = (0.0, 0.0);
        // Skip the update if the same state with the same rotor momentum is already in view.
        let bits = |of: Vector| of.data.0[0].map(f64::to_bits);
        if stored.is_none_or(|stored| bits(stored) != bits(self.loads.rotors(0.0).0)) {
            self.update_view();
        }
    }

    /// Advances the body to `t` (s) after the start of the segment, while `go_on` permits; `surroundings` holds the
    /// environment and the segment's start time since the start of the run (s). Stops at an earlier stick-slip event
    /// and then returns its time (s).
    ///
    /// # Errors
    /// The error of `go_on`.
    pub fn advance<E>(
        &mut self,
        t: f64,
        surroundings: TimedSurroundings,
        mut go_on: impl FnMut() -> Result<(), E>,
    ) -> Result<Option<f64>, E> {
        if t < self.grid_time {
            self.grid.copy_from(&self.initial);
            self.grid_time = 0.0;
            self.invalidate_step();
        }
        let (mut steps, can_stick) = (0_u64, self.can_stick());
        loop {
            let level = match self.next_level {
                Some(level) => level,
                None => self.level(surroundings),
            };
            self.next_level = Some(level);
            self.ensure_responses(level);
            if can_stick {
                self.search_next_step(level, surroundings);
                let event = self.next_step.as_ref().and_then(|next_step| next_step.event);
                if let Some((at, _)) = event.filter(|(at, _)| *at <= t) {
                    self.step_off_grid(at - self.grid_time, surroundings);
                    return Ok(Some(at));
                }
            }
            let Some(Some(StepResponses { h, .. })) = self.grid_responses.get(level) else { break };
            let h = *h;
            if self.grid_time + h > t {
                break;
            }
            steps += 1;
            if steps.is_multiple_of(STEPS) {
                go_on()?;
            }
            if let Some(next_step) =
                self.next_step.as_ref().filter(|next_step| can_stick && next_step.from == self.grid_time)
            {
                self.grid.copy_from(&next_step.to);
            } else {
                self.advance_grid(level, surroundings);
            }
            self.grid_time += h;
            self.invalidate_step();
        }
        self.step_off_grid(t - self.grid_time, surroundings);
        Ok(None)
    }

    /// Invalidates the data cached for the start of the next step.
    pub(super) fn invalidate_step(&mut self) {
        self.memory.invalidate();
        self.next_level = None;
    }

    /// Advances the state on the grid, but not its time, by one step of the given level; returns the step length (s).
    pub(super) fn advance_grid(&mut self, level: usize, surroundings: TimedSurroundings) -> Option<f64> {
        let Some(Some(StepResponses { h, responses })) = self.grid_responses.get(level) else { return None };
        let bearings_now = (&responses[..], &self.bearings[..], &self.slips[..]);
        let step = self.loads.step(
            &self.model,
            bearings_now,
            *h,
            self.grid_time,
            surroundings,
            self.appendages.as_deref(),
        );
        self.counts.iterations += u64::from(step.run(&mut self.grid, &mut self.memory));
        self.counts.steps += 1;
        Some(*h)
    }

    /// Sets the current state to `h` (s) after the last grid instant, by one off-grid step, and updates the view.
    pub(super) fn step_off_grid(&mut self, h: f64, surroundings: TimedSurroundings) {
        self.current.copy_from(&self.grid);
        self.time = self.grid_time + h;
        if h > 0.0 {
            let place = self.ensure_off_grid_responses(h);
            let bearings_now =
                (&self.extra_responses[place].responses[..], &self.bearings[..], &self.slips[..]);
            let step = self.loads.step(
                &self.model,
                bearings_now,
                h,
                self.grid_time,
                surroundings,
                self.appendages.as_deref(),
            );
            self.counts.iterations += u64::from(step.run(&mut self.current, &mut self.memory));
            self.counts.steps += 1;
        }
        self.update_view();
    }

    /// Advances the body to a stick-slip event at `t` (s) after the start of the segment, within a tick of where the
    /// motion stopped, and marks the event's rotor for `resolve_stick_slip`.
    pub fn stop_at_event(&mut self, t: f64, surroundings: TimedSurroundings) {
        self.step_off_grid(t - self.grid_time, surroundings);
        self.set_event();
    }

    /// Returns the inertia tensor of the deformed body at the current instant (kg m²).
    pub fn inertia(&self) -> Matrix3<f64> {
        if let Some(inertia) = &self.view.inertia {
            return *inertia;
        }
        let modes = self.model.modes.iter().zip(&self.view.displacements);
        modes.fold(self.model.inertia, |sum, (of, q)| sum + tensor(of.moments) * *q)
    }

    pub(super) fn update_view(&mut self) {
        let (mut stored, mut stuck_inertia) = (Vector::zeros(), Matrix3::zeros());
        if self.bearings.is_empty() {
            stored = self.loads.rotors(self.time).0;
        } else {
            let bearings_now = self.current_bearings(&self.slips);
            stored += bearings_now.stored(self.current.rotor_states.iter().map(|rotor| rotor.values.x));
            stuck_inertia += bearings_now.stuck_inertia();
        }
        if let Some((momentum, _)) = gimbal::total_momentum(&self.loads.gimbals, self.time) {
            stored += momentum;
        }
        match &self.appendages {
            Some(appendages) => appendages.view(self.time, &self.current, &stored, &mut self.view),
            None => self.view.compute(&self.model, &self.current, &stored, &stuck_inertia),
        }
    }

    /// Returns the view of the body at the current instant.
    pub fn view(&self) -> &BodyView {
        &self.view
    }

    /// Returns the energy of each mode at the current instant (J): (q'² + W² q²)/2.
    pub fn energies(&self) -> impl Iterator<Item = f64> + '_ {
        let view = self.view.displacements.iter().zip(&self.view.rates);
        view.zip(self.model.modes.iter().enumerate()).map(|((q, rate), (index, mode))| {
            let stretched = self.view.frequencies.get(index).unwrap_or(&mode.frequency) * q;
            0.5 * (rate * rate + stretched * stretched)
        })
    }

    /// Returns the computational cost since the start.
    pub fn counts(&self) -> StepCounts {
        self.counts
    }

    /// Replaces the step levels.
    #[cfg(test)]
    pub(super) fn set_levels(&mut self, levels: StepLevels) {
        self.levels = Arc::new(levels);
        self.grid_responses.clear();
        self.invalidate_step();
    }
}
