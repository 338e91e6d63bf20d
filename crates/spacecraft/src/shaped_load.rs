//! Broadband force and torque during a run: white noise through the filters of the corners of its density, whose mean over each step
//! acts. Values at the steps instead would have the aliases of the density at low frequencies, where a free body answers with 1/f².

use std::f64::consts::TAU;
use std::sync::Arc;

use flexsc_dynamics::wrench::ForceEffect;
use flexsc_numerics::exponential::exponential;
use flexsc_numerics::random::Stream;
use flexsc_numerics::time::Span;
use nalgebra::{Cholesky, DMatrix, Matrix4, Vector4};

use crate::load_density::{LoadDensity, STEPS, TWICE_DAMPING};

/// Step in units of the upper corner's inverse.
const STEP: f64 = TAU / STEPS;
/// Largest number of doublings until the filters have settled.
const DOUBLINGS: usize = 60;

/// Filters of a density, with the time in units of the upper corner's inverse. The last state is the integral of the load.
#[derive(Debug)]
struct Filters {
    /// States after a step.
    flow: Matrix4<f64>,
    /// States that a step adds per standard deviation of its draws.
    drawn: Matrix4<f64>,
    /// States at the start, likewise.
    settled: Matrix4<f64>,
}

/// Component of the load with its effect on the body.
#[derive(Clone, Debug)]
struct Part {
    unit: ForceEffect,
    state: Vector4<f64>,
    /// Mean over the last step.
    mean: f64,
}

/// State of a broadband load.
#[derive(Clone, Debug)]
pub struct ShapedLoad {
    filters: Arc<Filters>,
    parts: Vec<Part>,
    step: Span,
}

impl Filters {
    /// Returns the filters of corners (rad/s).
    fn new([lower, upper]: [f64; 2]) -> Option<Self> {
        let ratio = lower / upper;
        #[rustfmt::skip]
        let a = Matrix4::new(
            0.0, 1.0, 0.0, 0.0,
            -1.0, -TWICE_DAMPING, 0.0, 0.0,
            0.0, 0.0, 0.0, 1.0,
            1.0, 0.0, -ratio * ratio, -TWICE_DAMPING * ratio,
        );
        // Van Loan: the flow, and the covariance of the states that white noise adds over a step.
        let mut both = DMatrix::zeros(8, 8);
        both.view_mut((0, 0), (4, 4)).copy_from(&-a);
        both.view_mut((4, 4), (4, 4)).copy_from(&a.transpose());
        both[(1, 5)] = 1.0;
        let whole = exponential(&(both * STEP));
        let flow: Matrix4<f64> = whole.fixed_view::<4, 4>(4, 4).transpose();
        let covariance: Matrix4<f64> = flow * whole.fixed_view::<4, 4>(0, 4);
        let (mut settled, mut power) = (covariance, flow);
        for _ in 0..DOUBLINGS {
            settled += power * settled * power.transpose();
            power *= power;
        }
        let root = |of: Matrix4<f64>| Some(Cholesky::new((of + of.transpose()) * 0.5)?.l());
        Some(Self { flow, drawn: root(covariance)?, settled: root(settled)? })
    }
}

impl ShapedLoad {
    /// Creates the load of a density in its stationary state; `None` for a table. `unit` has the effect of a unit of each component.
    pub fn new(
        density: &LoadDensity,
        unit: impl Fn(usize) -> ForceEffect,
        draws: &mut Stream,
    ) -> Option<Self> {
        let corners = density.corners()?;
        let filters = Arc::new(Filters::new(corners)?);
        let given = (0..6).filter(|place| density.has_part(*place));
        let (levels, factor) = (density.levels(), density.correlation_factor());
        let part = |place: usize| {
            let mut effect = ForceEffect::default();
            for (row, level) in levels.iter().enumerate().filter(|(row, _)| factor[(*row, place)] != 0.0) {
                // White noise of the one-sided density S has the intensity S/2.
                let size = f64::sqrt(0.5 * level * corners[1]) * factor[(row, place)];
                effect.add_scaled(&unit(row), size);
            }
            let state = filters.settled * Vector4::from_fn(|_, _| draws.normal());
            Part { unit: effect, state, mean: 0.0 }
        };
        let parts = given.map(part).collect();
        Some(Self { filters, parts, step: density.step() })
    }

    /// Returns the time for which the load is held.
    pub fn step(&self) -> Span {
        self.step
    }

    /// Goes on by a step.
    pub fn advance(&mut self, draws: &mut Stream) {
        let Filters { flow, drawn, .. } = &*self.filters;
        for part in &mut self.parts {
            let before = part.state[3];
            part.state = flow * part.state + drawn * Vector4::from_fn(|_, _| draws.normal());
            part.mean = (part.state[3] - before) / STEP;
        }
    }

    /// Returns the effect of the load on the body.
    pub fn effect(&self) -> ForceEffect {
        let mut sum = ForceEffect::default();
        for part in &self.parts {
            sum.add_scaled(&part.unit, part.mean);
        }
        sum
    }
}

#[cfg(test)]
mod tests {
    use flexsc_numerics::attitude::Vector;
    use flexsc_numerics::random::Seed;
    use nalgebra::RowVector4;

    use super::*;
    use crate::load_density::LEAST_RATIO;

    #[test]
    fn the_widest_band_has_filters() {
        assert!(Filters::new([LEAST_RATIO, 1.0]).is_some());
    }

    /// Variance of a density of 1 N²/Hz between 5 and 120 Hz: an integral over frequency, by tests/golden/broadband.py.
    #[test]
    fn the_settled_load_has_the_variance_of_its_density() {
        let corners = [5.0, 120.0].map(|hertz| TAU * hertz);
        let filters = Filters::new(corners).expect("filters");
        let ratio = corners[0] / corners[1];
        let row = RowVector4::new(1.0, 0.0, -ratio * ratio, -TWICE_DAMPING * ratio) * filters.settled;
        let found = 0.5 * corners[1] * row.norm_squared();
        assert!((found / 129.245_122_388_258 - 1.0).abs() < 1e-9, "{found}");
        let after = filters.flow * filters.settled;
        let covariance = after * after.transpose() + filters.drawn * filters.drawn.transpose();
        assert!((covariance - filters.settled * filters.settled.transpose()).amax() < 1e-10);
        let density: LoadDensity = serde_json::from_str(
            r#"{"force": [1, 0, 4], "torque": [0, 0, 0], "lower": 31.4, "upper": 754.0}"#,
        )
        .expect("a density");
        let unit = |place| ForceEffect {
            force: Vector::from_fn(|row, _| if row == place { 1.0 } else { 0.0 }),
            ..ForceEffect::default()
        };
        let mut draws = Seed { scenario: 3, run: 0 }.stream("load");
        let mut load = ShapedLoad::new(&density, unit, &mut draws).expect("corners");
        let mut squares = Vector::zeros();
        for _ in 0..40_000 {
            load.advance(&mut draws);
            squares += load.effect().force.component_mul(&load.effect().force);
        }
        assert_eq!(squares.y, 0.0);
        assert!((squares.z / squares.x / 4.0 - 1.0).abs() < 0.05, "{squares}");
    }
}
