//! What the modes feel at a node of a step: Gt, and forces that vary.

use super::model::outward;
use super::step::{Felt, Memory, Step};

impl Step<'_> {
    /// Whether modes are forced by more than Gt and constants.
    pub(super) fn is_loud(&self) -> bool {
        self.model.stretches
            || self.model.beside.is_some()
            || self.around.is_some_and(|(around, _)| !around.heated().is_empty())
            || self.borne.is_some_and(|borne| borne.shakes())
    }

    /// The force of what is warmed on a mode (N/sqrt(kg)) so many seconds after the start of the step.
    fn warmth(&self, mode: usize, t: f64) -> f64 {
        let Some((around, since)) = self.around else { return 0.0 };
        around.heated().iter().fold(0.0, |sum, heated| sum + heated.forces[mode] * heated.level(since + t))
    }

    /// Gives the modes what they feel at a node; tells by how much their forces changed.
    pub(super) fn feel(&self, felt: &Felt, modes: &mut [Memory], waves: &[[f64; 2]], node: usize) -> f64 {
        for (memory, of) in modes.iter_mut().zip(&self.model.modes) {
            memory.g[node] = of.rotation.dot(&felt.turning);
            memory.rate += memory.g[node];
        }
        if !self.is_loud() {
            return 0.0;
        }
        let spun = outward(&felt.rate);
        let mut change = 0.0_f64;
        let more = self.is_forced_otherwise();
        for index in 0..modes.len() {
            let mut force = self.model.modes[index].moved(&spun);
            if more {
                force += self.other(index, felt, modes, waves);
            }
            let memory = &mut modes[index];
            change = change.max((force - memory.s[node]).abs());
            memory.s[node] = force;
        }
        change
    }

    /// Whether modes are forced by more than the centrifugal acceleration.
    fn is_forced_otherwise(&self) -> bool {
        self.around.is_some() || self.borne.is_some() || self.model.beside.is_some()
    }

    /// The force on a mode of tides, waves, other modes' damping and warmth (N/sqrt(kg)).
    fn other(&self, index: usize, felt: &Felt, modes: &[Memory], waves: &[[f64; 2]]) -> f64 {
        let mut force = 0.0;
        if let Some(tide) = &felt.tide {
            force += self.model.modes[index].pulled(tide);
        }
        if let Some(borne) = self.borne.filter(|_| !waves.is_empty()) {
            force += borne.force(index, waves);
        }
        if let Some(beside) = &self.model.beside {
            let others = modes.iter().enumerate();
            force -= others.map(|(other, of)| beside[(index, other)] * of.rate).sum::<f64>();
        }
        force + self.warmth(index, felt.t)
    }
}
