//! Parts of the kernel that are compiled as functions of their own.
//!
//! Inlined as well, they would make the kernel one function of half a million instructions, for which LLVM takes twice
//! as long. They are too long or too rare for the call to matter.

#![allow(clippy::inline_always, reason = "inside functions with a target feature nothing else is inlined")]

use flexsc_dynamics::damping::DampingRule;
use flexsc_dynamics::predicted_crossing::{
    PredictedCrossing, PredictedLevel, PredictedMode, SegmentStart, predict,
};
use flexsc_numerics::lanes::{LaneFloat, SimdTask};

use super::RelayKernel;
use crate::host::RunSetup;

/// Task that predicts the first crossing with any number of modes.
pub(super) struct Prediction<'a, R, D, const LEVELS: usize> {
    pub from: &'a SegmentStart<R>,
    pub levels: &'a [PredictedLevel<R>; LEVELS],
    pub modes: &'a mut [PredictedMode<R, D>],
}

impl<R: LaneFloat, D: DampingRule<R>, const LEVELS: usize> SimdTask for Prediction<'_, R, D, LEVELS> {
    type Output = PredictedCrossing<R>;

    #[inline(always)]
    fn run<K: LaneFloat>(self, _: K) -> Self::Output {
        predict(self.from, self.levels, self.modes)
    }
}

/// Task that integrates the envelope over a span (s) that ends at `time` (s).
pub(super) struct EnvelopeSpan<'a, R: LaneFloat, D> {
    pub kernel: &'a mut RelayKernel<R, D>,
    pub continuing: R::Mask,
    pub time: R,
    pub span: R,
}

impl<R: LaneFloat, D: DampingRule<R>> SimdTask for EnvelopeSpan<'_, R, D> {
    type Output = ();

    #[inline(always)]
    fn run<K: LaneFloat>(self, _: K) {
        self.kernel.follow_each(self.continuing, self.time, self.span);
    }
}

/// Task that initialises a lane with a run.
pub(super) struct RunStart<'a, R: LaneFloat, D> {
    pub kernel: &'a mut RelayKernel<R, D>,
    pub lane: usize,
    pub setup: &'a RunSetup,
}

impl<R: LaneFloat, D: DampingRule<R>> SimdTask for RunStart<'_, R, D> {
    type Output = ();

    #[inline(always)]
    fn run<K: LaneFloat>(self, _: K) {
        self.kernel.begin(self.lane, self.setup);
    }
}
