//! One step: Gauss-Legendre of order 6 for momentum and attitude in mean axes, the modes exact.
//!
//! With th = sum phi q, Q = Q_m o exp(th) and H = exp(-\[th\]) H_m, the rate of the mean axes is
//! w_m = exp(\[th\]) (J^-1 Gt + (1 - Gr) phi q'), in which the elastic rate has left but for products with th. The stages are
//! found by fixed-point passes; what modes need of a stage is Gt, three numbers, and s where there is any. The attitude follows
//! from the rates of the mean axes afterwards, and is part of the passes only where the surroundings look at it.

use nalgebra::{Matrix3, Quaternion, Vector2};

use super::bearing::{Borne, Spun};
use super::driven::{Driving, Scratch};
use super::facing::{Facing, inertial};
use super::model::{Model, Surroundings};
use super::response::Response;
use super::rotation::Bend;
use super::settled::{Change, SETTLED};
use super::shape::{Shape, Sums};
use super::state::State;
use crate::attitude::{Vector, rotation};
use crate::numerics::gauss_legendre::{MATRIX, NODES, WEIGHTS, exact_sum};

/// Passes after which the stages are taken as they are.
const PASSES: u32 = 60;

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
    beside: Beside,
}

/// What steps keep of rotors in bearings and of drives.
#[derive(Clone, Debug, Default)]
pub(super) struct Beside {
    pub spun: Spun,
    pub driven: Scratch,
}

#[derive(Clone, Debug, Default)]
pub(super) struct Memory {
    /// q and P/W at the nodes and the end, but for g and s.
    pub known: [[f64; 2]; 4],
    /// phi' Gt, and the varying force s, at the nodes.
    pub g: [f64; 3],
    pub s: [f64; 3],
    /// P of the stage at hand, then q'.
    pub rate: f64,
}

/// What a stage comes to.
#[derive(Copy, Clone)]
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
        Self { modes: vec![Memory::default(); modes], beside: Beside::default() }
    }
}

impl Step<'_> {
    /// Takes the step; tells the number of passes.
    pub fn take(&self, state: &mut State, work: &mut Work) -> u32 {
        let (modes, beside) = (&mut work.modes[..], &mut work.beside);
        if let Some((driving, t)) = self.driven {
            driving.prepare(t, self.h, &mut beside.driven);
        }
        let mut stages = self.guess(state, modes, beside);
        let speed =
            modes.iter().fold(0.0, |most, mode| mode.rate.abs().max(self.h * mode.s[0].abs()).max(most));
        let size = self.size(state);
        let mut facing = Facing::default();
        let seeks = self.around.is_some();
        if seeks {
            facing.find(&state.attitude, &stages, self.h);
        }
        let (mut before, mut passes) = (0.0, 0);
        while passes < PASSES {
            passes += 1;
            let mut change = Change::default();
            for node in 0..3 {
                let at = if seeks { facing.at(&state.attitude, node, self.h) } else { state.attitude };
                let found = self.stage(node, state, (&stages, &at), (modes, beside), &mut change);
                change.spun = change.spun.max(beside.spun.take_over(node, self.h));
                change.see(&stages[node], &found);
                stages[node] = found;
            }
            if seeks {
                facing.find(&state.attitude, &stages, self.h);
            }
            // What the next pass changes, at the rate of the last two or by what changed.
            let most = change.most(self.h, size, speed);
            let settled = most <= SETTLED || most * most <= SETTLED * before;
            if settled || self.leaves(&change, size, speed) <= SETTLED {
                break;
            }
            before = most;
        }
        if !seeks {
            facing.find(&state.attitude, &stages, self.h);
        }
        self.end(state, (&stages, &facing), modes, &beside.spun);
        passes
    }

    /// What the momentum is measured by (N m s): sums of rotors' momenta are no more exact than a part of these.
    fn size(&self, state: &State) -> f64 {
        state.momentum.norm() + self.h * self.torque.norm() + ROTORS * self.rotors.0.norm()
    }

    /// Keeps q and P of a mode, where drives turn what the others make of them.
    #[inline]
    fn keep(&self, index: usize, q: f64, p: f64, beside: &mut Beside) {
        if self.driven.is_some() {
            (beside.driven.q[index], beside.driven.p[index]) = (q, p);
        }
    }

    /// What the state comes to by itself, and the first guess: stages are like the start, and what turns grows.
    fn guess(&self, state: &State, modes: &mut [Memory], beside: &mut Beside) -> [Stage; 3] {
        let mut sums = Sums::default();
        for (index, (memory, response)) in modes.iter_mut().zip(self.responses).enumerate() {
            let [q, p, ..] = state.modes[index];
            let force = self.forces.get(index).copied().unwrap_or(0.0);
            for (known, (free, constant)) in
                memory.known.iter_mut().zip(response.free.iter().zip(&response.of_constant))
            {
                let [a, b, c, d] = free;
                *known = [a * q + b * p + constant[0] * force, c * q + d * p + constant[1] * force];
            }
            memory.rate = self.model.modes[index].frequency * p;
            self.keep(index, q, memory.rate, beside);
            sums.add(&self.model.modes[index], q, memory.rate, self.model.stretches);
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
        // What turns the body grows as the torque and the rotors have it: most of what a first pass would find.
        let grows = if self.driven.is_some() { Vector::zeros() } else { stage.push - self.rotors.1 };
        for (memory, of) in modes.iter_mut().zip(&self.model.modes) {
            let slope = of.rotation.dot(&grows) * self.h;
            memory.g = NODES.map(|node| memory.g[0] + slope * node);
            memory.s = [memory.s[0]; 3];
        }
        let slope = self.model.inverse * grows * self.h;
        NODES.map(|node| {
            let more = slope * node;
            Stage {
                rigid: stage.rigid + more,
                mean: stage.mean + more,
                turning: stage.turning + grows * (self.h * node),
                push: stage.push - more.cross(&state.momentum),
                pushed: stage.pushed,
            }
        })
    }

    /// The stage at a node, where the mean axes face this way.
    fn stage(
        &self,
        node: usize,
        state: &State,
        (stages, facing): (&[Stage; 3], &Quaternion<f64>),
        (modes, beside): (&mut [Memory], &mut Beside),
        change: &mut Change,
    ) -> Stage {
        let shape = self.shape(node, modes, beside);
        let [a, b, c] = weights(&MATRIX[node], self.h);
        let momentum = state.momentum + stages[0].push * a + stages[1].push * b + stages[2].push * c;
        if self.borne.is_some() {
            let Spun { at, rates, .. } = &mut beside.spun;
            for ((at, rates), spin) in at.iter_mut().zip(&*rates).zip(&state.spins) {
                *at = spin.sums + rates[0] * a + rates[1] * b + rates[2] * c;
            }
        }
        let (stage, felt) = self.turning((node + 1, NODES[node] * self.h), &shape, &momentum, facing, beside);
        change.forced = change.forced.max(self.feel(&felt, modes, beside, node));
        change.stretched = change.stretched.max(shape.changed.norm_squared());
        change.rate = change.rate.max(felt.rate.norm_squared());
        stage
    }

    /// How the modes are at a node.
    fn shape(&self, node: usize, modes: &mut [Memory], beside: &mut Beside) -> Shape {
        let mut sums = Sums::default();
        let (loud, plain) = (self.is_loud(), self.driven.is_none() && self.levers.is_empty());
        let all = modes.iter_mut().zip(self.responses).zip(&self.model.modes);
        for (index, ((memory, response), of)) in all.enumerate() {
            let [mut q, mut p] = memory.known[node];
            let [of_q, of_p] = &response.of_rate[node];
            q += dot(of_q, &memory.g);
            p += dot(of_p, &memory.g);
            if loud {
                let [of_q, of_p] = &response.of_force[node];
                q += dot(of_q, &memory.s);
                p += dot(of_p, &memory.s);
            }
            memory.rate = of.frequency * p;
            sums.add(of, q, memory.rate, self.model.stretches);
            if !plain {
                self.keep(index, q, memory.rate, beside);
                sums.lever(self, index, q);
            }
        }
        sums.shape()
    }

    /// How the body turns `t` seconds after the start of the step.
    fn turning(
        &self,
        (stage, t): (usize, f64),
        shape: &Shape,
        momentum: &Vector,
        facing: &Quaternion<f64>,
        beside: &mut Beside,
    ) -> (Stage, Felt) {
        let model = self.model;
        let bend = Bend::new(shape.bent);
        let (rotors, change) = &self.rotors;
        let mut free = bend.back(momentum) - (rotors + change * t);
        let mut locked = None;
        if let Some(borne) = &self.borne {
            free -= borne.stored(beside.spun.at.iter().map(|at| at.x));
            locked = borne.sticks().then(|| borne.locked());
        }
        let (mut levered, mut inertia) = (shape.levered, model.inertia + shape.changed);
        let (turning, rigid, rate) = if let Some((driving, _)) = self.driven {
            let turns = driving.turns(stage, &free, self.push, &mut beside.driven);
            (levered, inertia) = (turns.levered, turns.inertia);
            (free, turns.rate - turns.elastic, turns.rate)
        } else if model.stretches || locked.is_some() {
            let changed = locked.map_or(shape.changed, |locked| shape.changed + locked);
            let (turning, rate) = model.rates(&free, &shape.elastic, &changed);
            (turning, model.inverse * turning, rate)
        } else {
            let rigid = model.inverse * free;
            (free, rigid, rigid + shape.elastic + model.bending * free)
        };
        let (mut torque, mut tide) = (self.torque, None);
        if !self.levers.is_empty() || self.driven.is_some() {
            torque += levered;
        }
        if let Some((around, since)) = self.around {
            let hub = facing * rotation(&shape.bent);
            torque += around.torque(since + t, &hub, &inertia);
            tide = if model.stretches || self.driven.is_some() { around.tide(since + t, &hub) } else { None };
        }
        if let Some(borne) = &self.borne {
            torque += borne.feel(&rate, &mut beside.spun);
        }
        let mean = bend.forward(&(rigid + bend.excess(&(rate - rigid))));
        let made = Stage {
            push: bend.forward(&torque) - mean.cross(momentum),
            mean,
            rigid,
            turning,
            pushed: self.push.map_or_else(Vector::zeros, |push| bend.forward(&push)),
        };
        (made, Felt { turning, rate, tide, t, stage })
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
            let [of_q, of_p] = &response.of_rate[3];
            let mut end = Vector2::from(memory.known[3]);
            end += Vector2::new(dot(of_q, &memory.g), dot(of_p, &memory.g));
            if loud {
                let [of_q, of_p] = &response.of_force[3];
                end += Vector2::new(dot(of_q, &memory.s), dot(of_p, &memory.s));
            }
            // What was left out moves on with the mode, with what the rounded transition makes too long.
            let [a, b, c, d] = response.free[3];
            let left = Vector2::new(a * mode[2] + b * mode[3], c * mode[2] + d * mode[3]);
            let (end, left) = exact_sum(end, left - end * response.excess);
            *mode = [end.x, end.y, left.x, left.y];
        }
    }
}

/// The weights of the stages in a step of `h` seconds.
#[inline]
pub(super) fn weights(of: &[f64; 3], h: f64) -> [f64; 3] {
    [of[0] * h, of[1] * h, of[2] * h]
}

#[inline]
fn dot(a: &[f64; 3], b: &[f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}
