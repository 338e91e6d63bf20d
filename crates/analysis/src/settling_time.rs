//! Settling times of a linear loop after a step of its target: bounds by poles and residues, smooth in the parameters of
//! the loop.
//!
//! The step is a deviation of the rigid angle about one axis, at rest, with filters and estimators that have followed it and
//! a law without a past. Each measured angle is then a sum r l^k over the poles l of the loop, and the sum of |r| |l|^k falls
//! below the band at a time after which the angle stays in it.

use flexsc_control::law::LAST_ANGLE;
use flexsc_formats::document::ConfigError;
use flexsc_numerics::attitude::AXES;
use nalgebra::{Complex, DMatrix};
use schemars::JsonSchema;
use serde::Serialize;

use super::eigenvalues::eigenvalues;
use super::margins::{FrequencyResponse, ResidueResponse, modulus, steady_change};
use super::open_loop::{LoopBreak, LoopParts, OpenLoop, TransferMatrices};
use flexsc_scenario::Scenario;

/// Half width of the band, relative to the step.
pub const SETTLING_BAND: f64 = 0.05;

/// Number of doublings of the samples in which filters follow a step.
const DOUBLINGS: usize = 60;
/// Weight of the angles of the step against the steadiness of the body.
const STEP_WEIGHT: f64 = 1e3;
/// Singular values below this part of the largest one are rounding.
const LEAST_SINGULAR: f64 = 1e-12;
/// Change of a defective state matrix, relative to its size, that gives it a basis of eigenvectors.
const SPLITTING: f64 = 1e-13;
/// Distance within which poles are equal; those of a defective pole are apart by the root of a rounding.
const EQUAL: f64 = 1e-11;
/// Decay in a sample of a pole at 0.
const FASTEST: f64 = 700.0;
/// Number of halvings of the interval of a settling time.
const HALVINGS: usize = 200;

/// Settling time of an angle after a step about an axis.
#[derive(Clone, Debug, PartialEq, Serialize, JsonSchema)]
pub struct SettlingTime {
    /// Axis of the step: `roll`, `pitch` or `yaw`, and `angle` for a body with one axis.
    pub step: &'static str,
    /// Axis of the angle, in the same words.
    pub angle: &'static str,
    /// Time (s) after which the angle stays within 5 % of the step, a bound by the poles of the loop; infinite if a part does
    /// not decay.
    #[schemars(extend("x-null" = "infinite"))]
    pub time_s: f64,
}

/// Returns the settling times of a scenario's loop: of each angle after a step about each axis.
///
/// # Errors
/// A scenario without a linear loop, and a loop whose poles have no basis of eigenvectors.
pub fn settling_times(scenario: &Scenario) -> Result<Vec<SettlingTime>, ConfigError> {
    LoopParts::from_scenario(scenario, LoopBreak::Command)?.settling_times()
}

impl LoopParts<'_> {
    /// Returns the settling times of the loop, which is cut open at the command: of each angle after a step about each
    /// axis.
    ///
    /// # Errors
    /// Parts that a linear loop does not have together, and a loop whose poles have no basis of eigenvectors.
    pub(crate) fn settling_times(&self) -> Result<Vec<SettlingTime>, ConfigError> {
        let opened = OpenLoop::from_parts(self)?;
        let response = StepResponse::new(self, &opened);
        let terms = response.and_then(StepResponse::terms);
        let Some(terms) = terms else {
            return Err(ConfigError::new("law", "has a loop whose settling time cannot be computed"));
        };
        let count = self.body.inputs.len();
        let name = |axis: usize| if count == 1 { "angle" } else { AXES[axis] };
        let pairs = (0..count * count).map(|pair| (pair / count, pair % count));
        Ok(pairs
            .map(|(step, angle)| SettlingTime {
                step: name(step),
                angle: name(angle),
                time_s: opened.period * settling(&terms, step * count + angle, steady_change(opened.period)),
            })
            .collect())
    }
}

/// Pole, and its residues: of each angle after each step.
type Term = (Complex<f64>, Vec<Complex<f64>>);

/// Closed loop with the states after a step about each axis, and rows of the angles.
struct StepResponse(TransferMatrices);

impl StepResponse {
    fn new(parts: &LoopParts<'_>, opened: &OpenLoop) -> Option<Self> {
        let axes = parts.body.inputs.len();
        let (a, order) = (&opened.transfer.a, opened.states.len());
        let name = |place: usize| &opened.states[place].name;
        let is_of_law =
            |place: &usize| parts.law.block.states.iter().any(|state| state.name == *name(*place));
        let in_body = |place: usize| parts.body.states.iter().position(|state| state.name == *name(place));
        let (body, others): (Vec<usize>, Vec<usize>) =
            (0..order).filter(|place| !is_of_law(place)).partition(|place| in_body(*place).is_some());
        let angles = DMatrix::from_fn(axes, order, |axis, place| {
            in_body(place).map_or(0.0, |own| parts.body.c[(2 * axis, own)])
        });
        // Without commands the body stays as it is, at the angles of the step.
        let still = a.select_rows(&body).select_columns(&body) - DMatrix::identity(body.len(), body.len());
        let mut equations = still.resize_vertically(body.len() + axes, 0.0);
        let weighted = angles.select_columns(&body) * STEP_WEIGHT;
        equations.rows_mut(body.len(), axes).copy_from(&weighted);
        let mut right = DMatrix::zeros(body.len() + axes, axes);
        right.rows_mut(body.len(), axes).fill_diagonal(STEP_WEIGHT);
        let factors = equations.svd(true, true);
        let turned = factors.solve(&right, LEAST_SINGULAR * factors.singular_values.max()).ok()?;
        let of_others = a.select_rows(&others);
        let followed =
            followed(of_others.select_columns(&others), of_others.select_columns(&body) * &turned)?;
        let mut start = DMatrix::zeros(order, axes);
        for (places, known) in [(&body, &turned), (&others, &followed)] {
            for (row, place) in places.iter().enumerate() {
                start.row_mut(*place).copy_from(&known.row(row));
            }
        }
        // A differentiator starts with the angle itself, as in a run; the other states of the law are 0.
        for place in (0..order).filter(|place| opened.states[*place].name.ends_with(LAST_ANGLE)) {
            let angle = a.row(place) * &start;
            start.row_mut(place).copy_from(&angle);
        }
        let a = opened.transfer.sensitivity()?.a;
        Some(Self(TransferMatrices { a, b: start, c: angles, d: DMatrix::zeros(axes, axes) }))
    }

    /// Returns the poles with their residues.
    fn terms(mut self) -> Option<Vec<Term>> {
        if let Some(terms) = self.terms_as_it_is() {
            return Some(terms);
        }
        // Delays have a defective pole at 0. A change within rounding parts it: its terms are then large, and gone after a few
        // samples.
        let size = SPLITTING * self.0.a.norm();
        for (place, entry) in self.0.a.iter_mut().enumerate() {
            *entry += size * libm::sin(1.0 + 3.7 * place as f64);
        }
        self.terms_as_it_is()
    }

    fn terms_as_it_is(&self) -> Option<Vec<Term>> {
        let poles = eigenvalues(&self.0.a)?;
        Some(merged(ResidueResponse::new(&FrequencyResponse::new(&self.0), &poles)?.into_terms()))
    }
}

/// Adds the residues of equal poles, such as those of equal loops about several axes: their vectors, and with them the single
/// residues, depend on roundings.
fn merged(terms: Vec<Term>) -> Vec<Term> {
    let mut apart: Vec<Term> = Vec::with_capacity(terms.len());
    for (pole, residues) in terms {
        match apart.iter_mut().find(|(known, _)| modulus(*known - pole) <= EQUAL) {
            Some((_, sum)) => sum.iter_mut().zip(&residues).for_each(|(sum, residue)| *sum += residue),
            None => apart.push((pole, residues)),
        }
    }
    apart
}

/// Returns the states x of filters after many samples x' = a x + b from 0: what they do not learn of the input, such as a bias
/// without noise, remains 0. `None` if they do not settle.
fn followed(mut a: DMatrix<f64>, mut b: DMatrix<f64>) -> Option<DMatrix<f64>> {
    for _ in 0..DOUBLINGS {
        let change = &a * &b;
        if change.norm() <= f64::EPSILON * b.norm() {
            return Some(b);
        }
        b += change;
        a = &a * &a;
    }
    None
}

/// Returns the number of periods after which the sum of the terms of a response stays within the band. Poles that decay by at
/// most `steady` in a period last.
fn settling(terms: &[Term], response: usize, steady: f64) -> f64 {
    let decay = |pole: Complex<f64>| (-libm::log(modulus(pole))).min(FASTEST);
    let sizes: Vec<(f64, f64)> =
        terms.iter().map(|(pole, residues)| (modulus(residues[response]), decay(*pole))).collect();
    let bound = |time: f64| sizes.iter().map(|(size, decay)| size * libm::exp(-decay * time)).sum::<f64>();
    let lasting = sizes.iter().filter(|(_, decay)| *decay <= steady).map(|(size, _)| size).sum::<f64>();
    if lasting >= SETTLING_BAND || lasting.is_nan() {
        return f64::INFINITY;
    }
    if bound(0.0) <= SETTLING_BAND {
        return 0.0;
    }
    let mut high = 1.0;
    while bound(high) > SETTLING_BAND {
        high *= 2.0;
        if high > 1e15 {
            return f64::INFINITY;
        }
    }
    let mut low = 0.0;
    for _ in 0..HALVINGS {
        let middle = 0.5 * (low + high);
        if middle <= low || middle >= high {
            break;
        }
        if bound(middle) > SETTLING_BAND {
            low = middle;
        } else {
            high = middle;
        }
    }
    high
}
