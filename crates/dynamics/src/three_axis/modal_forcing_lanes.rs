//! Forcing of the modes at the start of a step, four modes per SIMD register.

use flexsc_numerics::attitude::Vector;
use flexsc_numerics::lanes::{LaneFloat, SimdTask};

use super::model::ModeGroup4;
use super::step::ModeMemory;

/// SIMD task that computes the modal forcing by Gt and by the centrifugal terms, four modes per register.
pub(super) struct ModalForcesSimd<'a> {
    pub abreast: &'a [ModeGroup4],
    pub states: &'a [[f64; 4]],
    /// Rigid momentum Gt (N m s).
    pub turning: Vector,
    /// Centrifugal terms of the rotation (rad²/s²), as `centrifugal_terms` returns them; `None` if no mode changes the inertia.
    pub spun: Option<[f64; 6]>,
    /// Modes to fill: g and s at the start of the step are written.
    pub modes: &'a mut [ModeMemory],
}

impl SimdTask for ModalForcesSimd<'_> {
    /// Largest rate |q'| of a mode (m sqrt(kg)/s), and largest force on one (N/sqrt(kg)).
    type Output = [f64; 2];

    #[inline(always)]
    fn run<R: LaneFloat>(self, kind: R) -> [f64; 2] {
        let Self { abreast, states, turning, spun, modes } = self;
        let (mut fastest, mut forced) = (kind.splat(0.0), kind.splat(0.0));
        for group in 0..abreast.len() {
            let (of, first) = (&abreast[group], 4 * group);
            let mut p = [0.0; 4];
            for lane in 0..4 {
                if let Some(state) = states.get(first + lane) {
                    p[lane] = state[1];
                }
            }
            let g = of.along(kind, &turning);
            fastest = (kind.load(&of.frequency) * kind.load(&p) + g).abs().max(fastest);
            let mut kept = [[0.0; 4]; 2];
            g.store(&mut kept[0]);
            if let Some(spun) = &spun {
                let s = of.centrifugal_force(kind, spun);
                forced = s.abs().max(forced);
                s.store(&mut kept[1]);
            }
            for lane in 0..4 {
                if let Some(memory) = modes.get_mut(first + lane) {
                    memory.start = [kept[0][lane], kept[1][lane]];
                }
            }
        }
        let mut most = [[0.0; 4]; 2];
        fastest.store(&mut most[0]);
        forced.store(&mut most[1]);
        most.map(|of| of[0].max(of[1]).max(of[2]).max(of[3]))
    }
}
