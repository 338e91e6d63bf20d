//! The motion from one departure to the next.

use std::sync::Arc;

use nalgebra::{Matrix3, Quaternion};

mod amplitudes;
mod level;

use super::bearing::{Bearing, Borne, Slip, Spin};
use super::common::{CommonSteps, KnownBody, Regular};
use super::driven::Driving;
use super::gimbal::{self, Gimbal, Swung};
use super::method::StepMemory;
use super::model::{Flexible, FreeMode, Model, Rotor, Surroundings, tensor};
use super::pace::{Amplitude, Pace, Pose};
use super::response::NodeResponse;
use super::rotation::Bend;
use super::state::{Ahead, TurningSight, TurningState};
use super::step::TurningStep;
use crate::attitude::Vector;

/// Steps after which the motion asks whether it may go on.
const STEPS: u64 = 256;

/// Lengths of steps beside the grid whose responses are kept: those between samples and commands come again and again.
const BESIDE: usize = 16;

/// A flexible body that turns, and what acts on it since it departed.
#[derive(Clone, Debug)]
pub struct Turning {
    pub(super) model: Arc<Model>,
    pub(super) pace: Arc<Pace>,
    /// What it has in common with other runs, as long as it does.
    pub(super) known: Option<Arc<KnownBody>>,
    /// The state at the departure, at the instant of the grid that was reached last, and at the instant seen last.
    pub(super) departed: TurningState,
    pub(super) grid: TurningState,
    pub(super) here: TurningState,
    /// Seconds since the departure of the last two.
    pub(super) reached: f64,
    pub(super) now: f64,
    pub(super) seen: TurningSight,
    pub(super) acting: Acting,
    /// The bearings of the rotors, if they have any, how each rotor slips, and whether it has just come to rest or let go.
    pub(super) bearings: Vec<Bearing>,
    pub(super) slips: Vec<Slip>,
    pub(super) resting: Vec<bool>,
    /// The step that follows, once it was looked at for rotors that come to rest.
    pub(super) ahead: Option<Ahead>,
    /// Responses over a step of the grid at each level, once they were needed.
    pub(super) regular: Vec<Option<Regular>>,
    /// Those over the last steps that were beside the grid, and the place of the next.
    pub(super) beside: Vec<Regular>,
    pub(super) next_beside: usize,
    /// The level of the next step of the grid, once it is known.
    next: Option<usize>,
    /// The amplitude of each mode at the start of a step.
    amplitudes: Vec<Amplitude>,
    work: StepMemory,
    effort: FlowEffort,
    /// Drives that turn appendages.
    pub(super) driving: Option<Box<Driving>>,
}

/// What acts from a departure on.
#[derive(Clone, Debug, Default)]
pub struct Acting {
    /// Torque on the hub in its axes (N m).
    pub torque: Vector,
    /// Modal forces beside phi' times the torque, which the motion has of itself (N/sqrt(kg)); none at all if there are none.
    pub forces: Vec<f64>,
    /// What a unit of each mode adds to the torque, of forces whose places it moves (N/sqrt(kg)); none at all if there are none.
    pub levers: Vec<Vector>,
    /// The acceleration of the centre of mass, in the hub's axes (m/s²).
    pub push: Vector,
    /// The rotors. One that was not there before brings its momentum with it.
    pub rotors: Vec<Rotor>,
    /// Rotors in gimbals; the same holds of them.
    pub gimbals: Vec<Gimbal>,
}

/// What the motion took so far.
#[derive(Copy, Clone, Debug, Default, PartialEq, Eq)]
pub struct FlowEffort {
    /// Steps.
    pub steps: u64,
    /// Passes over the stages of these steps.
    pub passes: u64,
}

impl Flexible {
    /// Length of the steps that resolve all modes while the body turns, and torques change, at such a rate (rad/s), in s.
    pub fn step(&self, rate: f64) -> f64 {
        let pace = Pace::new(&Model::new(self));
        pace.length(pace.level(Pose { rate, carried: rate, acceleration: 0.0, amplitudes: None }))
    }
}

impl Acting {
    /// Momentum of the rotors `t` seconds after the departure (N m s), and its rate (N m).
    fn rotors(&self, t: f64) -> (Vector, Vector) {
        self.rotors.iter().fold((Vector::zeros(), Vector::zeros()), |(sum, rate), rotor| {
            (sum + rotor.axis * (rotor.momentum + rotor.torque * t), rate + rotor.axis * rotor.torque)
        })
    }

    /// The step of `h` seconds that begins `t` seconds after the departure.
    fn step<'a>(
        &'a self,
        model: &'a Model,
        (responses, bearings, slips): (&'a [NodeResponse], &'a [Bearing], &'a [Slip]),
        h: f64,
        t: f64,
        around: Option<(&'a dyn Surroundings, f64)>,
        driving: Option<&'a Driving>,
    ) -> TurningStep<'a> {
        let count = self.rotors.len().min(bearings.len());
        let borne = Borne { bearings: &bearings[..count], rotors: &self.rotors, slips: &slips[..count] };
        let is_borne = count > 0;
        TurningStep {
            model,
            responses,
            h,
            torque: self.torque,
            push: (self.push != Vector::zeros()).then_some(self.push),
            // Of a body with drives what acts follows from the force alone.
            forces: if driving.is_some() { &[] } else { &self.forces },
            levers: &self.levers,
            rotors: if is_borne { (Vector::zeros(), Vector::zeros()) } else { self.rotors(t) },
            borne: is_borne.then_some(borne),
            swung: Swung::over(&self.gimbals, t, h),
            around: around.map(|(around, since)| (around, since + t)),
            driven: driving.map(|driving| (driving, t)),
        }
    }
}

impl Turning {
    /// A body whose mean axes have an attitude, with these rates as if it were rigid (rad/s), and q and q' of each mode
    /// (m sqrt(kg), and per second), at rest if they are left out; nothing acts.
    pub fn new(body: &Flexible, attitude: Quaternion<f64>, rigid: Vector, modes: &[[f64; 2]]) -> Self {
        Self::sharing(&CommonSteps::default(), body, (attitude, rigid), modes)
    }

    /// The same with what runs of this body have in common.
    pub fn sharing(
        common: &CommonSteps,
        body: &Flexible,
        (attitude, rigid): (Quaternion<f64>, Vector),
        modes: &[[f64; 2]],
    ) -> Self {
        let known = common.of(body);
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
        let state = TurningState {
            attitude,
            momentum: Bend::new(bent).forward(&momentum),
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
            seen: TurningSight::empty(state.modes.len()),
            acting: Acting::default(),
            bearings: Vec::new(),
            slips: Vec::new(),
            resting: Vec::new(),
            ahead: None,
            regular: Vec::new(),
            beside: Vec::new(),
            next_beside: 0,
            next: None,
            amplitudes: vec![Amplitude::default(); state.modes.len()],
            work: StepMemory::new(state.modes.len()),
            effort: FlowEffort::default(),
            driving: None,
            departed: state,
            model,
        };
        turning.look();
        turning
    }

    /// Gives the rotors bearings, one each, before the first departure.
    pub fn bear(&mut self, bearings: Vec<Bearing>) {
        for state in [&mut self.departed, &mut self.grid, &mut self.here] {
            state.spins = vec![Spin::default(); bearings.len()];
        }
        self.slips = vec![Slip::default(); bearings.len()];
        self.resting = vec![false; bearings.len()];
        self.bearings = bearings;
    }

    /// Begins a new motion at the instant seen last, under what acts from now on; rotors in bearings have to `settle` then.
    pub fn depart(&mut self, acting: &Acting) {
        let counts = |acting: &Acting| (acting.rotors.len(), acting.gimbals.len());
        let same = counts(acting) == counts(&self.acting);
        let plain = same && self.bearings.is_empty() && self.driving.is_none() && acting.gimbals.is_empty();
        let stored = plain.then(|| self.acting.rotors(self.now).0);
        if !same {
            self.take_on(acting);
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
        // The same state with the same momentum in the rotors was looked at on arrival.
        let bits = |of: Vector| of.data.0[0].map(f64::to_bits);
        if stored.is_none_or(|stored| bits(stored) != bits(self.acting.rotors(0.0).0)) {
            self.look();
        }
    }

    /// Brings the body to `t` seconds after the departure, which was so long after the start of the run (s), as long as it
    /// may `go_on`, or to the first instant before at which a rotor comes to rest or lets go, which it tells (s).
    ///
    /// # Errors
    /// What `go_on` says.
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
        let (mut steps, watches) = (0_u64, self.watches());
        loop {
            let level = match self.next {
                Some(level) => level,
                None => self.level(around),
            };
            self.next = Some(level);
            self.prepare(level);
            if watches {
                self.foresee(level, around);
                let meets = self.ahead.as_ref().and_then(|ahead| ahead.meets);
                if let Some((at, _)) = meets.filter(|(at, _)| *at <= t) {
                    self.step_beside(at - self.reached, around);
                    return Ok(Some(at));
                }
            }
            let Some(Some(Regular { h, .. })) = self.regular.get(level) else { break };
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
                self.take_step(level, &mut grid, around);
                self.grid = grid;
            }
            self.reached += h;
            self.move_on();
        }
        self.step_beside(t - self.reached, around);
        Ok(None)
    }

    /// What is known of the start of the next step holds no longer.
    pub(super) fn move_on(&mut self) {
        self.work.move_on();
        self.next = None;
    }

    /// Takes a state of the grid a step further, of this level; tells how long it is (s).
    pub(super) fn take_step(
        &mut self,
        level: usize,
        state: &mut TurningState,
        around: Option<(&dyn Surroundings, f64)>,
    ) -> Option<f64> {
        let Some(Some(Regular { h, responses })) = self.regular.get(level) else { return None };
        let borne = (&responses[..], &self.bearings[..], &self.slips[..]);
        let step = self.acting.step(&self.model, borne, *h, self.reached, around, self.driving.as_deref());
        self.effort.passes += u64::from(step.take(state, &mut self.work));
        self.effort.steps += 1;
        Some(*h)
    }

    /// Brings the body to `h` seconds after the instant of the grid, and looks.
    pub(super) fn step_beside(&mut self, h: f64, around: Option<(&dyn Surroundings, f64)>) {
        self.here.copy_from(&self.grid);
        self.now = self.reached + h;
        if h > 0.0 {
            let place = self.prepare_beside(h);
            let borne = (&self.beside[place].responses[..], &self.bearings[..], &self.slips[..]);
            let step = self.acting.step(&self.model, borne, h, self.reached, around, self.driving.as_deref());
            self.effort.passes += u64::from(step.take(&mut self.here, &mut self.work));
            self.effort.steps += 1;
        }
        self.look();
    }

    /// Brings the body to `t` seconds after the departure, an instant within a tick of that at which it stopped, and remembers that
    /// a rotor comes to rest there, or lets go.
    pub fn reach(&mut self, t: f64, around: Option<(&dyn Surroundings, f64)>) {
        self.step_beside(t - self.reached, around);
        self.meet();
    }

    /// The inertia tensor of the body as it is bent at the instant seen last (kg m²).
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
            let borne = self.borne_by(&self.slips);
            stored += borne.stored(self.here.spins.iter().map(|spin| spin.sums.x));
            locked += borne.locked();
        }
        if let Some((swung, _)) = gimbal::sum(&self.acting.gimbals, self.now) {
            stored += swung;
        }
        match &self.driving {
            Some(driving) => driving.look(self.now, &self.here, &stored, &mut self.seen),
            None => self.seen.look(&self.model, &self.here, &stored, &locked),
        }
    }

    /// The body at the instant seen last.
    pub fn seen(&self) -> &TurningSight {
        &self.seen
    }

    /// Energy of motion and deformation of each mode at the instant seen last (J): (q'² + W² q²)/2.
    pub fn energies(&self) -> impl Iterator<Item = f64> + '_ {
        let seen = self.seen.displacements.iter().zip(&self.seen.rates);
        seen.zip(self.model.modes.iter().enumerate()).map(|((q, rate), (index, mode))| {
            let stretched = self.seen.frequencies.get(index).unwrap_or(&mode.frequency) * q;
            0.5 * (rate * rate + stretched * stretched)
        })
    }

    /// What the motion took so far.
    pub fn effort(&self) -> FlowEffort {
        self.effort
    }

    /// Makes it walk at another pace.
    #[cfg(test)]
    pub(super) fn set_pace(&mut self, pace: Pace) {
        self.pace = Arc::new(pace);
        self.regular.clear();
        self.move_on();
    }
}
