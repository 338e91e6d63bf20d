//! Forcing of the modes at a node of a step: Gt, and forces that vary over the step.

use nalgebra::Matrix3;

use super::driven::Pulls;
use super::model::outward;
use super::step::{Beside, FeltByModes, Memory, TurningStep};

impl TurningStep<'_> {
    /// Returns true if modal forces depend on more than Gt and constants (change of inertia, drives, damping
    /// coupling, heating, imbalance).
    pub(super) fn is_loud(&self) -> bool {
        self.model.stretches
            || self.driven.is_some()
            || self.model.beside.is_some()
            || self.around.is_some_and(|(around, _)| !around.heated().is_empty())
            || self.borne.is_some_and(|borne| borne.shakes())
    }

    /// Returns true if the modes are forced by Gt, constants and centrifugal terms only, so that the SIMD path
    /// applies.
    pub(super) fn feels_motion_alone(&self) -> bool {
        let others = self.around.is_some() || self.model.beside.is_some();
        self.driven.is_none() && self.borne.is_none() && !(others && self.is_loud())
    }

    /// Updates the forcing g and s of the modes at a node; returns the largest change of a modal force (N/sqrt(kg)).
    pub(super) fn feel(
        &self,
        felt: &FeltByModes,
        modes: &mut [Memory],
        beside: &mut Beside,
        node: usize,
    ) -> f64 {
        let spun = outward(&felt.rate);
        let mut change = 0.0_f64;
        if let Some((driving, _)) = self.driven {
            let scratch = &mut beside.driven;
            let pulls = Pulls { around: self.around, tide: felt.tide, push: self.push };
            driving.pull((felt.stage, felt.t), &felt.rate, &pulls, scratch);
            let (given, swings) = (scratch.speeds.iter().zip(&scratch.p), driving.swings());
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
        if !self.is_loud() {
            return 0.0;
        }
        let more = self.around.is_some() || self.borne.is_some() || self.model.beside.is_some();
        for index in 0..modes.len() {
            let mut force = match self.driven {
                Some(_) => beside.driven.forces[index],
                None => self.model.modes[index].moved(&spun),
            };
            if more {
                force += self.other((index, node), felt.t, felt.tide.as_ref(), modes, &beside.spun.waves);
            }
            let memory = &mut modes[index];
            change = change.max((force - memory.s[node]).abs());
            memory.s[node] = force;
        }
        change
    }

    /// Returns the force on a mode by tides, rotor imbalance, damping coupling and heating (N/sqrt(kg)). For bodies
    /// with drives, tides and heating are computed with the appendages instead.
    pub(super) fn other(
        &self,
        (index, node): (usize, usize),
        t: f64,
        tide: Option<&Matrix3<f64>>,
        modes: &[Memory],
        waves: &[[f64; 2]],
    ) -> f64 {
        let mut force = 0.0;
        if let (Some(tide), None) = (tide, self.driven) {
            force += self.model.modes[index].pulled(tide);
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
        around.heated().iter().fold(0.0, |sum, heated| sum + heated.forces[mode] * heated.level(since + t))
    }
}
