//! Forcing of the modes at a node of a step: Gt, and forces that vary over the step.

use flexsc_numerics::attitude::Vector;
use flexsc_numerics::lanes::{LaneFloat, SimdTask};
use nalgebra::Matrix3;

use super::stage_values::ModalForcing;
use super::{IntegrationStep, ModeMemory, OptionalStages};
use crate::three_axis::appendages::StageForces;
use crate::three_axis::constants::{ModeGroup4, centrifugal_terms};
use crate::three_axis::rotors::RotorStage;

impl IntegrationStep<'_> {
    /// Returns true if modal forces depend on more than Gt and constants (change of inertia, drives, damping
    /// coupling, heating, imbalance).
    pub(super) fn has_varying_forces(&self) -> bool {
        self.model.changes_inertia
            || self.appendages.is_some()
            || self.model.coupled_damping.is_some()
            || self.surroundings.is_some_and(|(surroundings, _)| !surroundings.thermal_forces().is_empty())
            || self.bearings.is_some_and(|bearings| bearings.has_forces())
    }

    /// Returns true if the modes are forced by Gt, constants and centrifugal terms only, so that the SIMD path
    /// applies.
    pub(super) fn only_rigid_forcing(&self) -> bool {
        let others = self.surroundings.is_some() || self.model.coupled_damping.is_some();
        self.appendages.is_none() && self.bearings.is_none() && !(others && self.has_varying_forces())
    }

    /// Updates the forcing g and s of the modes at a node; returns the largest change of a modal force (N/sqrt(kg)).
    pub(super) fn update_modal_forces(
        &self,
        forcing: &ModalForcing,
        modes: &mut [ModeMemory],
        optional: &mut OptionalStages,
        node: usize,
    ) -> f64 {
        let centrifugal = centrifugal_terms(&forcing.rate);
        let mut change = 0.0_f64;
        if let Some((appendages, _)) = self.appendages {
            let scratch = &mut optional.appendages;
            let sources = StageForces {
                surroundings: self.surroundings,
                tide: forcing.tide,
                com_acceleration: self.com_acceleration,
            };
            appendages.compute_forces((forcing.stage, forcing.t), &forcing.rate, &sources, scratch);
            let (given, hinged) = (scratch.modal_rates.iter().zip(&scratch.p), appendages.has_hinges());
            for ((memory, (rate, p)), of) in modes.iter_mut().zip(given).zip(&self.model.modes) {
                let imposed = rate - p;
                // Rates due to hinges depend on the hinge angles, which are found by the iteration.
                if hinged {
                    change = change.max((imposed - memory.g[node]).abs() * of.frequency);
                }
                (memory.g[node], memory.rate[node]) = (imposed, *rate);
            }
        } else {
            for (memory, of) in modes.iter_mut().zip(&self.model.modes) {
                memory.g[node] = of.rotation.dot(&forcing.rigid_momentum);
                memory.rate[node] += memory.g[node];
            }
        }
        if !self.has_varying_forces() {
            return 0.0;
        }
        let others =
            self.surroundings.is_some() || self.bearings.is_some() || self.model.coupled_damping.is_some();
        for index in 0..modes.len() {
            let mut force = match self.appendages {
                Some(_) => optional.appendages.forces[index],
                None => self.model.modes[index].centrifugal_force(&centrifugal),
            };
            if others {
                force += self.additional_force(
                    (index, node),
                    forcing.t,
                    forcing.tide.as_ref(),
                    modes,
                    &optional.rotors,
                );
            }
            let memory = &mut modes[index];
            change = change.max((force - memory.s[node]).abs());
            memory.s[node] = force;
        }
        change
    }

    /// Returns the force on a mode by tides, rotor imbalance and whirl, damping coupling and heating (N/sqrt(kg)). For bodies
    /// with drives, tides and heating are computed with the appendages instead.
    pub(super) fn additional_force(
        &self,
        (index, node): (usize, usize),
        t: f64,
        tide: Option<&Matrix3<f64>>,
        modes: &[ModeMemory],
        rotors: &RotorStage,
    ) -> f64 {
        let mut force = 0.0;
        if let (Some(tide), None) = (tide, self.appendages) {
            force += self.model.modes[index].tidal_force(tide);
        }
        let is_forced = !(rotors.imbalance_terms.is_empty() && rotors.whirl.is_empty());
        if let Some(bearings) = self.bearings.filter(|_| is_forced) {
            force += bearings.force(index, rotors);
        }
        if let Some(damping) = &self.model.coupled_damping {
            let modal = modes.iter().enumerate();
            force -= modal.map(|(other, of)| damping[(index, other)] * of.rate[node]).sum::<f64>();
        }
        if self.appendages.is_none() {
            force += self.thermal_force(index, t);
        }
        force
    }

    /// Returns the thermal force on a mode (N/sqrt(kg)) `t` (s) after the start of the step.
    fn thermal_force(&self, mode: usize, t: f64) -> f64 {
        let Some((surroundings, since)) = self.surroundings else { return 0.0 };
        surroundings.thermal_forces().iter().enumerate().fold(0.0, |sum, (index, heated)| {
            sum + heated.forces[mode] * surroundings.thermal_level(index, since + t)
        })
    }
}

/// SIMD task that computes the modal forcing by Gt and by the centrifugal terms, four modes per register.
pub struct ModalForcesSimd<'a> {
    pub groups_of_four: &'a [ModeGroup4],
    pub states: &'a [[f64; 4]],
    /// Rigid momentum Gt (N m s).
    pub rigid_momentum: Vector,
    /// Centrifugal terms of the rotation (rad²/s²), as `centrifugal_terms` returns them; `None` if no mode changes the inertia.
    pub centrifugal: Option<[f64; 6]>,
    /// Modes to fill: g and s at the start of the step are written.
    pub modes: &'a mut [ModeMemory],
}

impl SimdTask for ModalForcesSimd<'_> {
    /// Largest rate |q'| of a mode (m sqrt(kg)/s), and largest force on one (N/sqrt(kg)).
    type Output = [f64; 2];

    #[inline(always)]
    fn run<R: LaneFloat>(self, kind: R) -> [f64; 2] {
        let Self { groups_of_four, states, rigid_momentum, centrifugal, modes } = self;
        let (mut largest_rate, mut largest_force) = (kind.splat(0.0), kind.splat(0.0));
        for group in 0..groups_of_four.len() {
            let (of, first) = (&groups_of_four[group], 4 * group);
            let mut p = [0.0; 4];
            for lane in 0..4 {
                if let Some(state) = states.get(first + lane) {
                    p[lane] = state[1];
                }
            }
            let g = of.dot_rotation(kind, &rigid_momentum);
            largest_rate = (kind.load(&of.frequency) * kind.load(&p) + g).abs().max(largest_rate);
            let mut kept = [[0.0; 4]; 2];
            g.store(&mut kept[0]);
            if let Some(centrifugal) = &centrifugal {
                let s = of.centrifugal_force(kind, centrifugal);
                largest_force = s.abs().max(largest_force);
                s.store(&mut kept[1]);
            }
            for lane in 0..4 {
                if let Some(memory) = modes.get_mut(first + lane) {
                    memory.start = [kept[0][lane], kept[1][lane]];
                }
            }
        }
        let mut largest = [[0.0; 4]; 2];
        largest_rate.store(&mut largest[0]);
        largest_force.store(&mut largest[1]);
        largest.map(|of| of[0].max(of[1]).max(of[2]).max(of[3]))
    }
}
