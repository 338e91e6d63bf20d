//! Level (length) of the next step, and the modes' responses over it.

use flexsc_numerics::attitude::Vector;

use super::amplitudes::Amplitudes;
use super::{BESIDE, ThreeAxisMotion};
use crate::three_axis::Surroundings;
use crate::three_axis::common::StepResponses;
use crate::three_axis::gimbal;
use crate::three_axis::model::{ModeConstants, centrifugal_terms};
use crate::three_axis::pace::BodyMotion;
use crate::three_axis::state::IntegratorState;

impl ThreeAxisMotion {
    /// Determines the level of the next grid step.
    pub(super) fn level(&mut self, around: Option<(&dyn Surroundings, f64)>) -> usize {
        let (exerted, slow) = around.map_or((0.0, 0.0), |(around, _)| (around.bound(), around.frequency()));
        let mut slow = slow + self.driving.as_ref().map_or(0.0, |driving| driving.angles.fastest());
        let (mut rotors, mut change) = self.acting.rotors(self.reached);
        if !self.bearings.is_empty() {
            rotors =
                self.current_bearings(&self.slips).stored(self.grid.spins.iter().map(|spin| spin.sums.x));
        }
        let gimbals = gimbal::fastest(&self.acting.gimbals);
        if let Some((swung, by)) = gimbal::sum(&self.acting.gimbals, self.reached) {
            (rotors, change, slow) = (rotors + swung, change + by, slow + gimbals);
        }
        // Errors due to rotors in bearings, gimbals, heating and applied forces are not estimated: steps then resolve
        // all modes.
        let known = self.bearings.is_empty()
            && gimbals == 0.0
            && self.driving.is_none()
            && self.acting.levers.is_empty()
            && self.acting.push == Vector::zeros()
            && around.is_none_or(|(around, _)| around.thermal_forces().is_empty());
        // Gt without the present deformation.
        let turning = self.grid.momentum - rotors;
        // Within a step, a hinge turns by at most half of the angle allowed for the body.
        slow +=
            2.0 * self.driving.as_ref().map_or(0.0, |driving| driving.rate_bound(&self.grid.modes, &turning));
        let Self { model, grid, acting, amplitudes, .. } = self;
        let push = acting.torque.norm() + exerted + change.norm();
        let size = grid.momentum.norm();
        let rigid = model.inverse * turning;
        // Static deflections about which the modes oscillate; these do not contribute to the error.
        let pushed = acting.torque - change;
        let (net, spun) = (pushed - rigid.cross(&grid.momentum), centrifugal_terms(&rigid));
        let lanes = model.lanes;
        let (modes, forces) = (&grid.modes[..], &acting.forces[..]);
        lanes.run(Amplitudes { model, modes, forces, turning, pushed, net, spun, found: amplitudes });
        let pose = BodyMotion {
            rate: model.mobility * (size + rotors.norm()) + slow,
            carried: rigid.norm() + model.mobility * size + slow,
            acceleration: model.mobility * push,
            amplitudes: known.then_some(&*amplitudes),
        };
        let turns = self.pace.level(pose);
        self.pace.level_for_frequency(turns, self.shakes(&self.grid))
    }

    /// Returns the highest frequency of the rotors' imbalance in a state (rad/s).
    fn shakes(&self, state: &IntegratorState) -> f64 {
        let size = state.momentum.norm();
        let shakes = self.bearings.iter().zip(&state.spins).map(|(bearing, spin)| {
            bearing.highest() * ((spin.sums.x / bearing.inertia).abs() + self.model.mobility * size)
        });
        shakes.fold(0.0, f64::max)
    }

    /// Returns an upper bound of the fastest rate of change in the motion at the current instant (rad/s).
    pub fn fastest(&self, around: Option<&dyn Surroundings>) -> f64 {
        let mode = |(index, mode): (usize, &ModeConstants)| {
            // With driven appendages, frequencies change with the drive angles.
            let frequency =
                self.seen.frequencies.get(index).map_or(mode.frequency, |w| w.max(mode.frequency));
            frequency * (1.0 + 2.0 * mode.damping)
        };
        let modes = self.model.modes.iter().enumerate().map(mode).fold(0.0, f64::max);
        let slow = around.map_or(0.0, Surroundings::frequency)
            + self.driving.as_ref().map_or(0.0, |driving| driving.angles.fastest())
            + gimbal::fastest(&self.acting.gimbals);
        // The body turns, and precesses due to the momentum stored in its rotors.
        let stored = self.acting.rotors(self.now).0.norm()
            + self.here.spins.iter().map(|spin| spin.sums.x.abs()).sum::<f64>()
            + self.acting.gimbals.iter().map(|gimbal| gimbal.momentum).sum::<f64>();
        let turns = self.model.mobility * (self.here.momentum.norm() + stored);
        modes + slow + turns + self.shakes(&self.here)
    }

    /// Ensures that responses over an off-grid step of `h` (s) exist; returns their index in `beside`.
    pub(super) fn ensure_off_grid_responses(&mut self, h: f64) -> usize {
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

    /// Ensures that responses for the grid step of a level exist.
    pub(super) fn ensure_responses(&mut self, level: usize) {
        if self.regular.len() <= level {
            self.regular.resize(level + 1, None);
        }
        if self.regular[level].is_none() {
            let h = self.pace.length(level);
            self.regular[level] = Some(self.responses(h));
        }
    }

    /// Returns the responses of the modes over a step of `h` (s), shared if possible.
    fn responses(&self, h: f64) -> StepResponses {
        self.known.as_ref().map_or_else(|| StepResponses::new(&self.model, h), |known| known.responses(h))
    }
}
