//! The level of the next step, and the responses of the modes over it.

use super::amplitudes::Amplitudes;
use super::{BESIDE, Turning};
use crate::attitude::Vector;
use crate::turning::Surroundings;
use crate::turning::common::Regular;
use crate::turning::gimbal;
use crate::turning::model::{Constants, outward};
use crate::turning::pace::Pose;
use crate::turning::state::TurningState;

impl Turning {
    /// The level of the next step.
    pub(super) fn level(&mut self, around: Option<(&dyn Surroundings, f64)>) -> usize {
        let (exerted, slow) = around.map_or((0.0, 0.0), |(around, _)| (around.bound(), around.frequency()));
        let mut slow = slow + self.driving.as_ref().map_or(0.0, |driving| driving.angles.fastest());
        let (mut rotors, mut change) = self.acting.rotors(self.reached);
        if !self.bearings.is_empty() {
            rotors = self.borne_by(&self.slips).stored(self.grid.spins.iter().map(|spin| spin.sums.x));
        }
        let gimbals = gimbal::fastest(&self.acting.gimbals);
        if let Some((swung, by)) = gimbal::sum(&self.acting.gimbals, self.reached) {
            (rotors, change, slow) = (rotors + swung, change + by, slow + gimbals);
        }
        // What wheels in bearings, gimbals, warmth and forces do to modes and place is not estimated: steps resolve all modes.
        let known = self.bearings.is_empty()
            && gimbals == 0.0
            && self.driving.is_none()
            && self.acting.levers.is_empty()
            && self.acting.push == Vector::zeros()
            && around.is_none_or(|(around, _)| around.heated().is_empty());
        // Gt but for how much the body is bent now.
        let turning = self.grid.momentum - rotors;
        // A step turns a hinge by half of what it may turn the body.
        slow +=
            2.0 * self.driving.as_ref().map_or(0.0, |driving| driving.swinging(&self.grid.modes, &turning));
        let Self { model, grid, acting, amplitudes, .. } = self;
        let push = acting.torque.norm() + exerted + change.norm();
        let size = grid.momentum.norm();
        let rigid = model.inverse * turning;
        // What holds the displacements that each mode swings about, and loses nothing of.
        let pushed = acting.torque - change;
        let (net, spun) = (pushed - rigid.cross(&grid.momentum), outward(&rigid));
        let lanes = model.lanes;
        let (modes, forces) = (&grid.modes[..], &acting.forces[..]);
        lanes.run(Amplitudes { model, modes, forces, turning, pushed, net, spun, found: amplitudes });
        let pose = Pose {
            rate: model.mobility * (size + rotors.norm()) + slow,
            carried: rigid.norm() + model.mobility * size + slow,
            acceleration: model.mobility * push,
            amplitudes: known.then_some(&*amplitudes),
        };
        let turns = self.pace.level(pose);
        self.pace.resolving(turns, self.shakes(&self.grid))
    }

    /// The highest frequency at which wheels shake the body in a state (rad/s).
    fn shakes(&self, state: &TurningState) -> f64 {
        let size = state.momentum.norm();
        let shakes = self.bearings.iter().zip(&state.spins).map(|(bearing, spin)| {
            bearing.highest() * ((spin.sums.x / bearing.inertia).abs() + self.model.mobility * size)
        });
        shakes.fold(0.0, f64::max)
    }

    /// No part of the motion changes faster at the instant seen last (rad/s).
    pub fn fastest(&self, around: Option<&dyn Surroundings>) -> f64 {
        let mode = |(index, mode): (usize, &Constants)| {
            // Of a body with drives they change with the angles.
            let frequency =
                self.seen.frequencies.get(index).map_or(mode.frequency, |w| w.max(mode.frequency));
            frequency * (1.0 + 2.0 * mode.damping)
        };
        let modes = self.model.modes.iter().enumerate().map(mode).fold(0.0, f64::max);
        let slow = around.map_or(0.0, Surroundings::frequency)
            + self.driving.as_ref().map_or(0.0, |driving| driving.angles.fastest())
            + gimbal::fastest(&self.acting.gimbals);
        // The body turns, and precesses with what its rotors store.
        let stored = self.acting.rotors(self.now).0.norm()
            + self.here.spins.iter().map(|spin| spin.sums.x.abs()).sum::<f64>()
            + self.acting.gimbals.iter().map(|gimbal| gimbal.momentum).sum::<f64>();
        let turns = self.model.mobility * (self.here.momentum.norm() + stored);
        modes + slow + turns + self.shakes(&self.here)
    }

    /// Makes sure that there are responses over a step beside the grid, of `h` seconds; tells their place.
    pub(super) fn prepare_beside(&mut self, h: f64) -> usize {
        if let Some(place) = self.beside.iter().position(|known| known.h.to_bits() == h.to_bits()) {
            return place;
        }
        let known = self.responses(h);
        if self.beside.len() < BESIDE {
            self.beside.push(known);
            return self.beside.len() - 1;
        }
        let place = self.next_beside;
        self.next_beside = (place + 1) % BESIDE;
        self.beside[place] = known;
        place
    }

    /// Makes sure that there are responses for a level.
    pub(super) fn prepare(&mut self, level: usize) {
        if self.regular.len() <= level {
            self.regular.resize(level + 1, None);
        }
        if self.regular[level].is_none() {
            let h = self.pace.length(level);
            self.regular[level] = Some(self.responses(h));
        }
    }

    /// The responses of the modes over a step of `h` seconds.
    fn responses(&self, h: f64) -> Regular {
        self.known.as_ref().map_or_else(|| Regular::new(&self.model, h), |known| known.over(h))
    }
}
