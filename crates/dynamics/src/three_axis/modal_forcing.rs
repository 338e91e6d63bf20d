//! Forcing of the modes at a node of a step: Gt, and forces that vary over the step.

use nalgebra::Matrix3;

use super::appendages::StageForces;
use super::model::centrifugal_terms;
use super::step::{IntegrationStep, ModalForcing, ModeMemory, OptionalStages};

impl IntegrationStep<'_> {
    /// Returns true if modal forces depend on more than Gt and constants (change of inertia, drives, damping
    /// coupling, heating, imbalance).
    pub(super) fn has_varying_forces(&self) -> bool {
        self.model.stretches
            || self.driven.is_some()
            || self.model.beside.is_some()
            || self.around.is_some_and(|(around, _)| !around.thermal_forces().is_empty())
            || self.borne.is_some_and(|borne| borne.has_imbalance())
    }

    /// Returns true if the modes are forced by Gt, constants and centrifugal terms only, so that the SIMD path
    /// applies.
    pub(super) fn only_rigid_forcing(&self) -> bool {
        let others = self.around.is_some() || self.model.beside.is_some();
        self.driven.is_none() && self.borne.is_none() && !(others && self.has_varying_forces())
    }

    /// Updates the forcing g and s of the modes at a node; returns the largest change of a modal force (N/sqrt(kg)).
    pub(super) fn update_modal_forces(
        &self,
        felt: &ModalForcing,
        modes: &mut [ModeMemory],
        beside: &mut OptionalStages,
        node: usize,
    ) -> f64 {
        let spun = centrifugal_terms(&felt.rate);
        let mut change = 0.0_f64;
        if let Some((driving, _)) = self.driven {
            let scratch = &mut beside.driven;
            let pulls = StageForces { around: self.around, tide: felt.tide, push: self.push };
            driving.compute_forces((felt.stage, felt.t), &felt.rate, &pulls, scratch);
            let (given, swings) = (scratch.speeds.iter().zip(&scratch.p), driving.has_hinges());
            for ((memory, (speed, p)), of) in modes.iter_mut().zip(given).zip(&self.model.modes) {
                let turned = speed - p;
                // Rates due to hinges depend on the hinge angles, which are found by the iteration.
                if swings {
                    change = change.max((turned - memory.g[node]).abs() * of.frequency);
                }
                (memory.g[node], memory.rate[node]) = (turned, *speed);
            }
        } else {
            for (memory, of) in modes.iter_mut().zip(&self.model.modes) {
                memory.g[node] = of.rotation.dot(&felt.turning);
                memory.rate[node] += memory.g[node];
            }
        }
        if !self.has_varying_forces() {
            return 0.0;
        }
        let more = self.around.is_some() || self.borne.is_some() || self.model.beside.is_some();
        for index in 0..modes.len() {
            let mut force = match self.driven {
                Some(_) => beside.driven.forces[index],
                None => self.model.modes[index].centrifugal_force(&spun),
            };
            if more {
                force += self.additional_force(
                    (index, node),
                    felt.t,
                    felt.tide.as_ref(),
                    modes,
                    &beside.spun.waves,
                );
            }
            let memory = &mut modes[index];
            change = change.max((force - memory.s[node]).abs());
            memory.s[node] = force;
        }
        change
    }

    /// Returns the force on a mode by tides, rotor imbalance, damping coupling and heating (N/sqrt(kg)). For bodies
    /// with drives, tides and heating are computed with the appendages instead.
    pub(super) fn additional_force(
        &self,
        (index, node): (usize, usize),
        t: f64,
        tide: Option<&Matrix3<f64>>,
        modes: &[ModeMemory],
        waves: &[[f64; 2]],
    ) -> f64 {
        let mut force = 0.0;
        if let (Some(tide), None) = (tide, self.driven) {
            force += self.model.modes[index].tidal_force(tide);
        }
        if let Some(borne) = self.borne.filter(|_| !waves.is_empty()) {
            force += borne.force(index, waves);
        }
        if let Some(damping) = &self.model.beside {
            let others = modes.iter().enumerate();
            force -= others.map(|(other, of)| damping[(index, other)] * of.rate[node]).sum::<f64>();
        }
        if self.driven.is_none() {
            force += self.warmth(index, t);
        }
        force
    }

    /// Returns the thermal force on a mode (N/sqrt(kg)) `t` (s) after the start of the step.
    fn warmth(&self, mode: usize, t: f64) -> f64 {
        let Some((around, since)) = self.around else { return 0.0 };
        around
            .thermal_forces()
            .iter()
            .fold(0.0, |sum, heated| sum + heated.forces[mode] * heated.level(since + t))
    }
}
