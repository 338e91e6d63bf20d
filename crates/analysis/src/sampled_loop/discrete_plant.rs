//! Plant of a sampled loop in discrete time at given frequencies: everything that does not depend on the gain.

use flexsc_control::law::Differentiation;
use flexsc_dynamics::flow::CoupledMatrices;
use nalgebra::{DMatrix, DVector};

use super::{ClosedLoop, SampledLoop};

/// Plant of a loop in discrete time, z+ = Ad z + sum of B_i u_{k-n-i}.
#[derive(Clone, Debug)]
pub struct DiscretePlant<'a> {
    sampled_loop: &'a SampledLoop,
    transition: DMatrix<f64>,
    /// Response to a unit of the command from n samples ago, and to the one before it where a delay divides the period.
    forced: Vec<DVector<f64>>,
    /// Whole periods n of the delay.
    late: usize,
}

impl SampledLoop {
    /// Returns the whole periods of the delay, and the part of a period beyond them (s).
    fn lateness(&self) -> (f64, f64) {
        let periods = self.delay / self.period;
        // A delay of whole periods stays one in spite of rounding.
        let late = libm::floor(periods + 1e-9);
        (late, (periods - late).max(0.0) * self.period)
    }

    /// Returns the spans over which the body's motion is needed (s): a period and, where a delay divides it, its parts.
    fn spans(&self) -> Vec<f64> {
        let (_, part) = self.lateness();
        if part > 1e-9 * self.period {
            vec![self.period, self.period - part, part]
        } else {
            vec![self.period]
        }
    }
}

impl<'a> DiscretePlant<'a> {
    /// Creates the plant of a loop whose natural frequencies are multiplied by `ratios`.
    pub fn new(sampled_loop: &'a SampledLoop, ratios: &[f64]) -> Self {
        let coupled =
            CoupledMatrices::new(&sampled_loop.body, sampled_loop.back_emf, sampled_loop.total, ratios);
        Self::from(
            sampled_loop,
            sampled_loop.spans().into_iter().map(|span| coupled.discrete(span)).collect(),
        )
    }

    /// Creates the plants of a loop for several sets of ratios of the natural frequencies.
    pub fn for_ratios(sampled_loop: &'a SampledLoop, ratios: &[Vec<f64>]) -> Vec<Self> {
        let system = |ratios: &Vec<f64>| {
            CoupledMatrices::new(&sampled_loop.body, sampled_loop.back_emf, sampled_loop.total, ratios)
        };
        let systems: Vec<_> = ratios.iter().map(system).collect();
        let spans = sampled_loop.spans();
        let all: Vec<_> =
            systems.iter().flat_map(|system| spans.iter().map(move |span| (system, *span))).collect();
        let found = CoupledMatrices::discrete_many(&all);
        found.chunks(spans.len()).map(|found| Self::from(sampled_loop, found.to_vec())).collect()
    }

    /// Creates the plant from the transitions over the spans of a loop.
    fn from(sampled_loop: &'a SampledLoop, found: Vec<(DMatrix<f64>, DVector<f64>)>) -> Self {
        let (late, _) = sampled_loop.lateness();
        let mut found = found.into_iter();
        // The first transition always exists.
        let (transition, mut whole) =
            found.next().unwrap_or_else(|| (DMatrix::zeros(0, 0), DVector::zeros(0)));
        whole *= sampled_loop.authority;
        let forced = match (found.next(), found.next()) {
            (Some((rest, new)), Some((_, added))) => {
                let old = rest * added;
                vec![new * sampled_loop.authority, old * sampled_loop.authority]
            }
            _ => vec![whole],
        };
        Self { sampled_loop, transition, forced, late: late as usize }
    }

    /// Closes the loop with a gain of the extra loop.
    ///
    /// The state is (z, y_{k-1} where the law takes differences, u_{k-1}, u_{k-2}, ... as far as they still act).
    pub fn closed(&self, gain: f64) -> ClosedLoop {
        let sampled_loop = self.sampled_loop;
        let body = self.transition.nrows();
        let differs = sampled_loop.differentiation != Differentiation::Exact;
        let pending = body + usize::from(differs);
        let order = pending + self.late + self.forced.len() - 1;

        // y and y' are the sums of all displacements and of all rates, with the dominant mode's once more for the extra
        // loop.
        let weight = |j: usize| if j / 2 == sampled_loop.dominant + 1 { 1.0 + gain } else { 1.0 };
        let (k_p, k_d) = (sampled_loop.k_p, sampled_loop.k_d);
        let (angle, rate, last) = match sampled_loop.differentiation {
            Differentiation::Exact => (k_p, k_d, 0.0),
            Differentiation::Difference => (k_p + k_d / sampled_loop.period, 0.0, -k_d / sampled_loop.period),
            Differentiation::Raw => (k_p + k_d, 0.0, -k_d),
        };
        let mut closed = ClosedLoop::zero(order);
        for j in 0..body {
            let (shown, fed_back) = if j % 2 == 0 { (1.0, angle) } else { (0.0, rate) };
            closed.angle[j] = shown;
            closed.feedback[j] = fed_back * weight(j);
            if differs {
                closed.free[(body, j)] = shown * weight(j);
            }
        }
        if differs {
            closed.feedback[body] = last;
        }
        closed.free.view_mut((0, 0), (body, body)).copy_from(&self.transition);
        // The current command, or the rest of earlier ones.
        for (i, column) in self.forced.iter().enumerate() {
            match self.late + i {
                0 => closed.forced.rows_mut(0, body).copy_from(column),
                back => closed.free.view_mut((0, pending + back - 1), (body, 1)).copy_from(column),
            }
        }
        for slot in pending..order {
            if slot == pending {
                closed.forced[slot] = 1.0;
            } else {
                closed.free[(slot, slot - 1)] = 1.0;
            }
        }
        self.start(&mut closed.start, gain, differs);
        closed.period = sampled_loop.period;
        closed.shape.clone_from(&sampled_loop.shape);
        closed
    }

    /// Writes the initial state of the body. y_{-1} is y_0, so that the first difference is 0.
    fn start(&self, state: &mut DVector<f64>, gain: f64, differs: bool) {
        let body = &self.sampled_loop.body;
        (state[0], state[1]) = (body.angle.get(), body.rate.get());
        for (i, mode) in body.modes.iter().enumerate() {
            (state[2 + 2 * i], state[3 + 2 * i]) = (mode.displacement.get(), mode.rate.get());
        }
        if differs {
            let modes = &body.modes;
            let displaced: f64 = modes.iter().map(|mode| mode.displacement.get()).sum();
            let dominant = modes.get(self.sampled_loop.dominant).map_or(0.0, |mode| mode.displacement.get());
            state[2 + 2 * modes.len()] = state[0] + displaced + gain * dominant;
        }
    }
}
