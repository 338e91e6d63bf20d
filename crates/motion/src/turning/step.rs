//! One step: Gauss-Legendre of order 6 for momentum and attitude in mean axes, the modes exact.
//!
//! With th = sum phi q, Q = Q_m o exp(th) and H = exp(-\[th\]) H_m, the rate of the mean axes is
//! w_m = exp(\[th\]) (J^-1 Gt + (1 - Gr) phi q'), in which the elastic rate has left but for products with th. The stages are
//! found by fixed-point passes; what modes need of a stage is Gt, three numbers, and s where there is any. The attitude follows
//! from the rates of the mean axes afterwards, and is part of the passes only where the surroundings look at it.

use nalgebra::{Matrix3, Vector2};

use super::bearing::{Borne, Spun};
use super::driven::{Driving, Scratch};
use super::facing::{Facing, inertial};
use super::model::{Model, Surroundings};
use super::nodes::{Guess, Nodes, Passes};
use super::response::Response;
use super::shape::Sums;
use super::state::State;
use crate::attitude::Vector;
use crate::numerics::gauss_legendre::{NODES, WEIGHTS, exact_sum};

/// Passes after which the stages are taken as they are.
pub(super) const PASSES: u32 = 60;

/// The part of the rotors' momenta below which none of the whole counts.
const ROTORS: f64 = 1e-2;

/// A step: what moves, for how long, and what acts.
pub(super) struct Step<'a> {
    pub model: &'a Model,
    /// The modes' responses over the step.
    pub responses: &'a [Response],
    /// Length (s).
    pub h: f64,
    /// Torque on the hub in its axes (N m).
    pub torque: Vector,
    /// The acceleration of the centre of mass in the hub's axes (m/s²), if anything pushes it.
    pub push: Option<Vector>,
    /// Modal forces, without what the torque gives (N/sqrt(kg)).
    pub forces: &'a [f64],
    /// What a unit of each mode adds to the torque (N/sqrt(kg)).
    pub levers: &'a [Vector],
    /// Momentum of the rotors at the start of the step (N m s), and its rate (N m).
    pub rotors: (Vector, Vector),
    /// Rotors in bearings, which are not among them; their momenta are parts of the state.
    pub borne: Option<Borne<'a>>,
    /// The surroundings, and the time since the start of the run (s).
    pub around: Option<(&'a dyn Surroundings, f64)>,
    /// Drives that turn appendages, and the time since the departure (s).
    pub driven: Option<(&'a Driving, f64)>,
}

/// The memory of steps: what they keep of each mode, and of rotors in bearings.
#[derive(Clone, Debug)]
pub(super) struct Work {
    modes: Vec<Memory>,
    nodes: Nodes,
    beside: Beside,
    /// The stage at the start of the last step, if other steps begin there too, and the largest rate of a mode and force on one.
    start: Option<(Stage, [f64; 2])>,
}

/// What steps keep of rotors in bearings and of drives.
#[derive(Clone, Debug, Default)]
pub(super) struct Beside {
    pub spun: Spun,
    pub driven: Scratch,
}

#[derive(Clone, Debug, Default)]
pub(super) struct Memory {
    /// g and s at the start of the step.
    pub start: [f64; 2],
    /// q and P/W at the nodes and the end, but for g and s.
    pub known: [[f64; 4]; 2],
    /// phi' Gt, and the varying force s, at the nodes; the fourth is none.
    pub g: [f64; 4],
    pub s: [f64; 4],
    /// P at the nodes, then q'.
    pub rate: [f64; 4],
}

/// What a stage comes to.
#[derive(Copy, Clone, Debug)]
pub(super) struct Stage {
    /// H_m'.
    pub push: Vector,
    /// w_m.
    pub mean: Vector,
    /// J^-1 Gt, and Gt.
    pub rigid: Vector,
    pub turning: Vector,
    /// The acceleration of the centre of mass in mean axes (m/s²).
    pub pushed: Vector,
}

/// Gt, the hub's rate and the surroundings' tide, which modes feel.
pub(super) struct Felt {
    pub turning: Vector,
    pub rate: Vector,
    pub tide: Option<Matrix3<f64>>,
    /// Since the start of the step (s).
    pub t: f64,
    /// The start of the step, and its nodes, from 0.
    pub stage: usize,
}

impl Work {
    /// Memory for so many modes.
    pub fn new(modes: usize) -> Self {
        Self {
            modes: vec![Memory::default(); modes],
            nodes: Nodes::default(),
            beside: Beside::default(),
            start: None,
        }
    }

    /// The next step begins elsewhere, or under something else.
    pub fn move_on(&mut self) {
        self.start = None;
    }
}

impl Step<'_> {
    /// Takes the step; tells the number of passes.
    pub fn take(&self, state: &mut State, work: &mut Work) -> u32 {
        let Work { modes, nodes, beside, start } = work;
        if let Some((driving, t)) = self.driven {
            driving.prepare(t, self.h, &mut beside.driven);
        }
        let special = self.borne.is_some() || self.driven.is_some();
        let (stage, [fastest, forced]) = match *start {
            Some(start) if !special => start,
            _ => self.start(state, modes, beside),
        };
        *start = Some((stage, [fastest, forced]));
        let lanes = self.model.lanes;
        lanes.run(Guess { step: self, state, start: &stage, modes, nodes });
        let speed = fastest.max(self.h * forced);
        let mut stages = nodes.stages();
        let mut facing = Facing::default();
        if self.around.is_some() {
            facing.find(&state.attitude, &means(&stages), self.h);
        }
        let passes = if special {
            self.one_by_one(state, (&mut stages, &mut facing), (modes, beside), speed)
        } else {
            let passes = lanes.run(Passes { step: self, state, modes, nodes, facing: &mut facing, speed });
            stages = nodes.stages();
            passes
        };
        self.end(state, (&stages, &facing), modes, &beside.spun);
        passes
    }

    /// What the momentum is measured by (N m s): sums of rotors' momenta are no more exact than a part of these.
    pub(super) fn size(&self, state: &State) -> f64 {
        state.momentum.norm() + self.h * self.torque.norm() + ROTORS * self.rotors.0.norm()
    }

    /// Keeps q and P of a mode, where drives turn what the others make of them.
    #[inline]
    pub(super) fn keep(&self, index: usize, q: f64, p: f64, beside: &mut Beside) {
        if self.driven.is_some() {
            (beside.driven.q[index], beside.driven.p[index]) = (q, p);
        }
    }

    /// The stage at the start, and the largest rate of a mode and force on one.
    fn start(&self, state: &State, modes: &mut [Memory], beside: &mut Beside) -> (Stage, [f64; 2]) {
        let mut sums = Sums::default();
        for (index, memory) in modes.iter_mut().enumerate() {
            let [q, p, ..] = state.modes[index];
            memory.rate[0] = self.model.modes[index].frequency * p;
            self.keep(index, q, memory.rate[0], beside);
            sums.add(&self.model.modes[index], q, memory.rate[0], self.model.stretches);
            sums.lever(self, index, q);
        }
        if self.borne.is_some() {
            let Spun { at, now, .. } = &mut beside.spun;
            at.clear();
            at.extend(state.spins.iter().map(|spin| spin.sums));
            now.resize(at.len(), Vector::zeros());
        }
        let (stage, felt) = self.turning((0, 0.0), &sums.shape(), &state.momentum, &state.attitude, beside);
        if self.borne.is_some() {
            let Spun { rates, now, .. } = &mut beside.spun;
            rates.clear();
            rates.extend(now.iter().map(|now| [*now; 3]));
        }
        self.feel(&felt, modes, beside, 0);
        let mut most = [0.0_f64; 2];
        for memory in modes {
            memory.start = [memory.g[0], memory.s[0]];
            most = [most[0].max(memory.rate[0].abs()), most[1].max(memory.s[0].abs())];
        }
        (stage, most)
    }

    /// Position and velocity of the centre of mass at the end, by the quadrature of the nodes.
    fn move_on(&self, state: &mut State, stages: &[Stage; 3], facing: &Facing) {
        let [position, velocity] = &mut state.moved;
        *position += *velocity * self.h;
        if self.push.is_some() {
            for (index, ((stage, weight), node)) in stages.iter().zip(WEIGHTS).zip(NODES).enumerate() {
                let pushed = inertial(&facing.at(&state.attitude, index, self.h), &stage.pushed);
                *velocity += pushed * (weight * self.h);
                *position += pushed * (weight * (1.0 - node) * self.h * self.h);
            }
        }
    }

    /// The state at the end.
    fn end(
        &self,
        state: &mut State,
        (stages, facing): (&[Stage; 3], &Facing),
        modes: &[Memory],
        spun: &Spun,
    ) {
        self.move_on(state, stages, facing);
        let [a, b, c] = weights(&WEIGHTS, self.h);
        let push = stages[0].push * a + stages[1].push * b + stages[2].push * c;
        let turn = facing.turns[0] * a + facing.turns[1] * b + facing.turns[2] * c;
        let rigid = stages[0].rigid * a + stages[1].rigid * b + stages[2].rigid * c;
        let State { attitude, momentum, turned, lost, modes: states, spins, .. } = state;
        if self.borne.is_some() {
            for (spin, rates) in spins.iter_mut().zip(&spun.rates) {
                let change = rates[0] * a + rates[1] * b + rates[2] * c;
                (spin.sums, spin.lost) = exact_sum(spin.sums, change + spin.lost);
            }
        }
        (attitude.coords, lost.0.coords) = exact_sum(attitude.coords, turn.coords + lost.0.coords);
        (*momentum, lost.1) = exact_sum(*momentum, push + lost.1);
        (*turned, lost.2) = exact_sum(*turned, rigid + lost.2);
        // The method keeps the length but for rounding, of which this removes what is left.
        let excess = attitude.norm_squared() - 1.0;
        if excess.abs() > 4.0 * f64::EPSILON {
            *attitude *= 1.0 - 0.5 * excess;
        }
        let loud = self.is_loud();
        for ((memory, response), mode) in modes.iter().zip(self.responses).zip(states) {
            let mut end = Vector2::from(memory.known.map(|of| of[3]));
            end += Vector2::from(answer(&response.of_rate, &memory.g, 3));
            if loud {
                end += Vector2::from(answer(&response.of_force, &memory.s, 3));
            }
            // What was left out moves on with the mode, with what the rounded transition makes too long.
            let [a, b, c, d] = response.free.map(|entry| entry[3]);
            let left = Vector2::new(a * mode[2] + b * mode[3], c * mode[2] + d * mode[3]);
            let (end, left) = exact_sum(end, left - end * response.excess);
            *mode = [end.x, end.y, left.x, left.y];
        }
    }
}

/// The rates of the mean axes.
pub(super) fn means(stages: &[Stage; 3]) -> [Vector; 3] {
    [stages[0].mean, stages[1].mean, stages[2].mean]
}

/// The weights of the stages in a step of `h` seconds.
#[inline]
pub(super) fn weights(of: &[f64; 3], h: f64) -> [f64; 3] {
    [of[0] * h, of[1] * h, of[2] * h]
}

/// What q and P/W make at a node, or the end, of numbers at all nodes.
#[inline]
pub(super) fn answer(of: &[[[f64; 4]; 3]; 2], by: &[f64; 4], node: usize) -> [f64; 2] {
    of.map(|of| of[0][node] * by[0] + of[1][node] * by[1] + of[2][node] * by[2])
}
