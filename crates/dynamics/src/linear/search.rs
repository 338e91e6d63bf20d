//! Certified search on a linear plant: any number of guards on any outputs, in one search.

use flexsc_numerics::time::Span;

use super::segment::{LinearOutput, LinearSegment};
use crate::crossing::{BoundedMotion, first_root};
use crate::guard::Guard;

/// Limit on the horizon for which poles are treated as slow (s).
const LONG: f64 = 1e3;

/// Guard on one of the outputs.
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct OutputGuard {
    /// Index of the output.
    pub output: usize,
    /// Threshold and direction.
    pub guard: Guard,
}

impl BoundedMotion for LinearSegment {
    type Guard = OutputGuard;
    type State = LinearOutput;
    type Observation = ();

    fn initial(&self, state: &mut LinearOutput) {
        self.initial_output(state);
    }

    fn evaluate(&self, h: f64, state: &mut LinearOutput) {
        self.at(h, state);
    }

    fn is_finite(state: &LinearOutput, (): ()) -> bool {
        state.outputs.iter().all(|sensed| sensed.angle.is_finite())
    }

    fn holds(level: OutputGuard, state: &LinearOutput, (): ()) -> bool {
        level.guard.holds(state.outputs[level.output].angle)
    }

    fn bounds_valid_for(state: &LinearOutput) -> f64 {
        state.window
    }

    /// Returns the earliest trip by a bound: fast non-growing poles stay within their residues of a line; slow ones
    /// accelerate towards the guard at most as at one of the ends, or by their change of phase meanwhile.
    fn earliest_crossing(
        &self,
        OutputGuard { output, guard }: OutputGuard,
        horizon: Span,
        state: &LinearOutput,
    ) -> f64 {
        let (flow, towards) = (&*self.flow, guard.side.sign());
        let horizon = horizon.seconds().min(LONG).min(state.window);
        let (mut angle, mut rate) = self.origins[output];
        let (mut reach, mut acceleration) = (0.0, 0.0);
        let count = flow.poles.len();
        for (k, simple) in flow.poles.iter().enumerate() {
            let (pole, sigma) = (&simple.pole, simple.pole.lambda.re);
            let (a, size) = (self.residues[output * count + k], self.sizes[output * count + k]);
            if pole.size * horizon > 3.0 && sigma <= 0.0 {
                let slope = a * pole.inverse;
                rate -= simple.weight * slope.re;
                angle -= simple.weight * (slope * pole.inverse).re;
                reach += size / (pole.size * pole.size);
                continue;
            }
            let now = simple.weight * towards * a.re;
            acceleration += if a.im == 0.0 && pole.lambda.im == 0.0 {
                now.max(now * libm::exp(sigma * horizon))
            } else {
                let growth = if sigma > 0.0 { simple.growth } else { 1.0 };
                (size * growth).min(now + size * pole.size * growth * horizon)
            };
        }
        for (cluster, rates) in flow.clusters.iter().zip(&state.rates) {
            acceleration += cluster.bounds(output, rates)[0];
        }
        let gap = towards * (guard.level - angle) - reach;
        if gap <= 0.0 {
            return 0.0;
        }
        first_root(gap, towards * rate, acceleration).min(horizon)
    }

    fn safe_stride(&self, OutputGuard { output, guard }: OutputGuard, state: &LinearOutput, (): ()) -> f64 {
        let (now, towards) = (state.outputs[output], guard.side.sign());
        let (gap, speed, acceleration) =
            (guard.gap(now.angle), towards * now.rate, towards * now.acceleration);
        let q = first_root(gap, speed, acceleration);
        let steepest = state.curvature[output].min(acceleration + state.jerk[output] * q / 3.0);
        first_root(gap, speed, steepest).min(state.window)
    }

    fn has_no_crossing(
        &self,
        OutputGuard { output, guard }: OutputGuard,
        state: &LinearOutput,
        (): (),
        time: f64,
    ) -> bool {
        let (now, towards) = (state.outputs[output], guard.side.sign());
        guard.gap(now.angle) > time * (towards * now.rate + 0.5 * state.curvature[output] * time)
    }
}
