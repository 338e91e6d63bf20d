//! Level (length) of the next step, and the modes' responses over it.

use flexsc_numerics::attitude::Vector;
use flexsc_numerics::lanes::{LaneFloat, SimdTask};

use super::constants::{BodyConstants, ModeConstants, centrifugal_terms};
use super::motion::{EXTRA_RESPONSES, ThreeAxisMotion};
use super::rotors::{Bearing, gimbal};
use super::shared::StepResponses;
use super::state::IntegratorState;
use super::step_levels::{BodyMotion, ModeAmplitude};
use super::surroundings::{Surroundings, TimedSurroundings};

impl ThreeAxisMotion {
    /// Determines the level of the next grid step.
    pub(super) fn level(&mut self, surroundings: TimedSurroundings) -> usize {
        let (exerted, environment_rate) = surroundings.map_or((0.0, 0.0), |(around, since)| {
            (around.bound(), around.frequency_at(since + self.grid_time))
        });
        let mut environment_rate =
            environment_rate + self.appendages.as_ref().map_or(0.0, |appendages| appendages.angles.fastest());
        let (mut rotors, mut change) = self.loads.rotors(self.grid_time);
        if !self.bearings.is_empty() {
            rotors = self
                .current_bearings(&self.slips)
                .stored(self.grid.rotor_states.iter().map(|rotor| rotor.values.x));
        }
        let gimbals = gimbal::largest_rate(&self.loads.gimbals);
        if let Some((momentum, rate)) = gimbal::total_momentum(&self.loads.gimbals, self.grid_time) {
            (rotors, change, environment_rate) =
                (rotors + momentum, change + rate, environment_rate + gimbals);
        }
        // Errors due to rotors in bearings, gimbals, heating and applied forces are not estimated: steps then resolve
        // all modes.
        let estimated = self.bearings.is_empty()
            && gimbals == 0.0
            && self.appendages.is_none()
            && self.loads.force_arms.is_empty()
            && self.loads.com_acceleration == Vector::zeros()
            && surroundings.is_none_or(|(surroundings, _)| surroundings.thermal_forces().is_empty());
        // Gt without the present deformation.
        let rigid_momentum = self.grid.mean_momentum - rotors;
        // Within a step, a hinge turns by at most half of the angle allowed for the body.
        environment_rate += 2.0
            * self
                .appendages
                .as_ref()
                .map_or(0.0, |appendages| appendages.rate_bound(&self.grid.modes, &rigid_momentum));
        let Self { model, grid, loads, amplitudes, .. } = self;
        let torque = loads.torque.norm() + exerted + change.norm();
        let momentum = grid.mean_momentum.norm();
        let rigid_rate = model.inverse * rigid_momentum;
        // Static deflections about which the modes oscillate; these do not contribute to the error.
        let applied = loads.torque - change;
        let (net, centrifugal) =
            (applied - rigid_rate.cross(&grid.mean_momentum), centrifugal_terms(&rigid_rate));
        let lanes = model.lanes;
        let (modes, forces) = (&grid.modes[..], &loads.forces[..]);
        lanes.run(Amplitudes {
            model,
            modes,
            forces,
            rigid_momentum,
            applied,
            net,
            centrifugal,
            found: amplitudes,
        });
        let motion = BodyMotion {
            rate: model.mobility * (momentum + rotors.norm()) + environment_rate,
            elastic_rotation_rate: rigid_rate.norm() + model.mobility * momentum + environment_rate,
            acceleration: model.mobility * torque,
            amplitudes: estimated.then_some(&*amplitudes),
        };
        let level = self.levels.level(motion);
        let whirl = self.whirl_rate(&self.grid);
        let fastest = self.imbalance_frequency(&self.grid).max(self.friction_rate()).max(whirl);
        self.levels.level_for_frequency(level, fastest)
    }

    /// Returns the highest rate at which viscous friction slows a rotor (1/s): the stages of a longer step would not
    /// converge.
    fn friction_rate(&self) -> f64 {
        self.bearings.iter().map(Bearing::viscous_rate).fold(0.0, f64::max)
    }

    /// Returns the largest rate at which rotors that tilt move the modes in a state (rad/s).
    fn whirl_rate(&self, state: &IntegratorState) -> f64 {
        let rotors = self.bearings.iter().zip(&state.rotor_states);
        rotors.map(|(bearing, rotor)| bearing.whirl_rate(rotor.values.x)).fold(0.0, f64::max)
    }

    /// Returns the highest frequency of the rotors' imbalance in a state (rad/s).
    fn imbalance_frequency(&self, state: &IntegratorState) -> f64 {
        let momentum = state.mean_momentum.norm();
        let frequencies = self.bearings.iter().zip(&state.rotor_states).map(|(bearing, rotor)| {
            bearing.highest_order()
                * ((rotor.values.x / bearing.inertia).abs() + self.model.mobility * momentum)
        });
        frequencies.fold(0.0, f64::max)
    }

    /// Returns an upper bound of the fastest rate of change in the motion at the current instant (rad/s).
    pub fn fastest(&self, surroundings: Option<&dyn Surroundings>) -> f64 {
        let mode = |(index, mode): (usize, &ModeConstants)| {
            // With driven appendages, frequencies change with the drive angles.
            let frequency =
                self.view.frequencies.get(index).map_or(mode.frequency, |w| w.max(mode.frequency));
            frequency * (1.0 + 2.0 * mode.damping)
        };
        let modes = self.model.modes.iter().enumerate().map(mode).fold(0.0, f64::max);
        let environment_rate = surroundings.map_or(0.0, Surroundings::frequency)
            + self.appendages.as_ref().map_or(0.0, |appendages| appendages.angles.fastest())
            + gimbal::largest_rate(&self.loads.gimbals);
        // The body turns, and precesses due to the momentum stored in its rotors.
        let stored = self.loads.rotors(self.time).0.norm()
            + self.current.rotor_states.iter().map(|rotor| rotor.values.x.abs()).sum::<f64>()
            + self.loads.gimbals.iter().map(|gimbal| gimbal.momentum).sum::<f64>();
        let rotation = self.model.mobility * (self.current.mean_momentum.norm() + stored);
        modes
            + environment_rate
            + rotation
            + self.imbalance_frequency(&self.current)
            + self.whirl_rate(&self.current)
    }

    /// Ensures that responses over an off-grid step of `h` (s) exist; returns their index in `extra_responses`.
    pub(super) fn ensure_off_grid_responses(&mut self, h: f64) -> usize {
        if let Some(index) = self.extra_responses.iter().position(|known| known.h.to_bits() == h.to_bits()) {
            return index;
        }
        let responses = self.responses(h);
        if self.extra_responses.len() < EXTRA_RESPONSES {
            self.extra_responses.push(responses);
            return self.extra_responses.len() - 1;
        }
        let index = self.next_extra;
        self.next_extra = (index + 1) % EXTRA_RESPONSES;
        self.extra_responses[index] = responses;
        index
    }

    /// Ensures that responses for the grid step of a level exist.
    pub(super) fn ensure_responses(&mut self, level: usize) {
        if self.grid_responses.len() <= level {
            self.grid_responses.resize(level + 1, None);
        }
        if self.grid_responses[level].is_none() {
            let h = self.levels.length(level);
            self.grid_responses[level] = Some(self.responses(h));
        }
    }

    /// Returns the responses of the modes over a step of `h` (s), shared if possible.
    fn responses(&self, h: f64) -> StepResponses {
        self.shared.as_ref().map_or_else(|| StepResponses::new(&self.model, h), |shared| shared.responses(h))
    }
}

/// SIMD task that computes the amplitudes of the modes from their states and the loads.
struct Amplitudes<'a> {
    pub model: &'a BodyConstants,
    /// States of the modes: q and P/W of each.
    pub modes: &'a [[f64; 4]],
    /// Modal forces other than those of the torque (N/sqrt(kg)); empty or one per mode.
    pub forces: &'a [f64],
    /// Rigid momentum Gt (N m s).
    pub rigid_momentum: Vector,
    /// Torque on the hub less the reaction of the rotors, without and with the gyroscopic torque (N m).
    pub applied: Vector,
    pub net: Vector,
    /// Centrifugal terms of the rotation (rad²/s²), as `centrifugal_terms` returns them.
    pub centrifugal: [f64; 6],
    pub found: &'a mut [ModeAmplitude],
}

impl SimdTask for Amplitudes<'_> {
    type Output = ();

    #[inline(always)]
    fn run<R: LaneFloat>(self, kind: R) {
        let Self { model, modes, forces, rigid_momentum, applied, net, centrifugal, found } = self;
        for group in 0..model.groups_of_four.len() {
            let (of, first) = (&model.groups_of_four[group], 4 * group);
            let (mut q, mut p, mut given) = ([0.0; 4], [0.0; 4], [0.0; 4]);
            for lane in 0..4 {
                if let Some([displacement, rate, ..]) = modes.get(first + lane) {
                    (q[lane], p[lane]) = (*displacement, *rate);
                }
                if let Some(force) = forces.get(first + lane) {
                    given[lane] = *force;
                }
            }
            let (q, p, force) = (kind.load(&q), kind.load(&p), kind.load(&given));
            let w = kind.load(&of.frequency);
            let static_deflection =
                (of.dot_rotation(kind, &net) + of.centrifugal_force(kind, &centrifugal) + force) / (w * w);
            let rate = (p + of.dot_rotation(kind, &rigid_momentum) / w).abs();
            let bound =
                ((of.dot_rotation(kind, &applied) + force).abs() / (w * w)).max(static_deflection.abs());
            // Bounds each of the displacement, the rate and the static deflection by torque or rotation.
            let bound = q.abs() + rate + bound;
            let oscillation = bound.min((q - static_deflection).abs() + rate);
            let mut kept = [[0.0; 4]; 2];
            bound.store(&mut kept[0]);
            oscillation.store(&mut kept[1]);
            for lane in 0..4 {
                if let Some(amplitude) = found.get_mut(first + lane) {
                    *amplitude = ModeAmplitude { displacement: kept[0][lane], oscillation: kept[1][lane] };
                }
            }
        }
    }
}
