//! Model of the body in a filter: coupled modes whose frequencies are those at the start, times ratios.
//!
//! The state is (x_r, x_r', x_1, x_1', ..., theta_1, theta_1', ...). Between back-EMF and free motion the flow is split
//! (Strang): each half is exact, whatever the damping of the modes, and so is the derivative of the split flow. The
//! ratios change linearly, and each substep has those of its middle.

use flexsc_dynamics::axis_model::AxisMode;
use flexsc_dynamics::flow::ModeFlow;
use nalgebra::DMatrix;

/// Model of the body in a Kalman filter.
#[derive(Clone, Debug)]
pub struct FilterModel {
    pub(super) modes: Vec<KalmanMode>,
    /// Number of ratios in the state: none, one for all modes, or one for each.
    ratios: usize,
    /// Back-EMF a (1/s); true if it opposes the total rate, not the rigid one.
    pub(super) back_emf: (f64, bool),
    pub(super) substeps: u32,
    /// Bounds of the ratios.
    pub(super) bounds: [f64; 2],
}

#[derive(Clone, Debug)]
pub(super) struct KalmanMode {
    pub(super) flow: ModeFlow,
    pub(super) frequency: f64,
    pub(super) gain: f64,
    pub(super) drag: f64,
}

/// Free flow of one mode over a substep: x+ = a x + b x' + shift[0], x'+ = c x + d x' + shift[1].
struct ModeTransition {
    matrix: [f64; 4],
    shift: [f64; 2],
    /// Derivative of (x+, x'+) with respect to the ratio.
    slope: [f64; 2],
}

impl FilterModel {
    /// Creates the model of a body with these modes. `back_emf` (1/s) opposes the total rate if true, else the rigid
    /// rate alone.
    pub fn new(
        modes: &[AxisMode],
        ratios: usize,
        back_emf: (f64, bool),
        substeps: u32,
        bounds: [f64; 2],
    ) -> Self {
        let kalman_mode = |mode: &AxisMode| KalmanMode {
            flow: ModeFlow::new(mode),
            frequency: mode.frequency.get(),
            gain: mode.gain.get(),
            drag: 2.0 * mode.damping.get(),
        };
        Self { modes: modes.iter().map(kalman_mode).collect(), ratios, back_emf, substeps, bounds }
    }

    /// Returns the number of motion states: rigid angle and rate, and two for each mode.
    pub fn motion_states(&self) -> usize {
        2 + 2 * self.modes.len()
    }

    /// Returns the number of states.
    pub fn order(&self) -> usize {
        self.motion_states() + 2 * self.ratios
    }

    /// Returns the index of a mode's ratio in the state; `None` if the frequencies are constant.
    pub fn ratio_of(&self, mode: usize) -> Option<usize> {
        let index = if self.ratios == 1 { 0 } else { mode };
        (index < self.ratios).then(|| self.motion_states() + 2 * index)
    }

    /// Returns the ratio of a mode in a state.
    pub fn ratio(&self, mode: usize, state: &[f64]) -> f64 {
        self.ratio_of(mode).map_or(1.0, |index| state[index])
    }

    /// Returns the natural frequency of a mode in a state (rad/s).
    pub fn frequency(&self, mode: usize, state: &[f64]) -> f64 {
        self.modes[mode].frequency * self.ratio(mode, state)
    }

    /// Returns the number of modes.
    pub fn modes(&self) -> usize {
        self.modes.len()
    }

    /// Returns the excitability k/w² of a mode in a state (s²).
    pub fn excitability(&self, mode: usize, state: &[f64]) -> f64 {
        let w = self.frequency(mode, state);
        self.modes[mode].gain / (w * w)
    }

    /// Returns the derivative of a state component's rate by the reduced moment: 1 for the rigid rate, k_i for that of
    /// a mode, else 0.
    pub fn input(&self, component: usize) -> f64 {
        match component {
            1 => 1.0,
            odd if odd % 2 == 1 && odd < self.motion_states() => self.modes[odd / 2 - 1].gain,
            _ => 0.0,
        }
    }

    /// Propagates a state over `h` (s) under a constant reduced moment (rad/s²). `tangent` holds the derivative of the
    /// state with respect to some variables, transposed: column i is the gradient of component i.
    pub fn propagate(&self, h: f64, moment: f64, state: &mut [f64], mut tangent: Option<&mut DMatrix<f64>>) {
        let step = h / f64::from(self.substeps);
        for substep in 0..self.substeps {
            let middle = (f64::from(substep) + 0.5) * step;
            if self.back_emf.0 > 0.0 {
                self.coast(0.5 * step, middle, moment, state, tangent.as_deref_mut());
                self.brake(step, state, tangent.as_deref_mut());
                self.coast(0.5 * step, middle, moment, state, tangent.as_deref_mut());
            } else {
                self.coast(step, middle, moment, state, tangent.as_deref_mut());
            }
        }
        for index in (self.motion_states()..self.order()).step_by(2) {
            state[index] += h * state[index + 1];
            if let Some(tangent) = tangent.as_deref_mut() {
                add_column(tangent, index, index + 1, h);
            }
        }
    }

    /// Propagates the free motion, with the ratios that the state has `middle` (s) after the start of the period.
    fn coast(
        &self,
        h: f64,
        middle: f64,
        moment: f64,
        state: &mut [f64],
        mut tangent: Option<&mut DMatrix<f64>>,
    ) {
        state[0] += h * (state[1] + 0.5 * h * moment);
        state[1] += h * moment;
        if let Some(tangent) = tangent.as_deref_mut() {
            add_column(tangent, 0, 1, h);
        }
        for (index, mode_model) in self.modes.iter().enumerate() {
            let (x, v, ratio_index) = (2 + 2 * index, 3 + 2 * index, self.ratio_of(index));
            let [low, high] = self.bounds;
            let ratio = ratio_index.map_or(1.0, |ratio_index| {
                (state[ratio_index] + middle * state[ratio_index + 1]).clamp(low, high)
            });
            let turn = mode_model.turn(
                h,
                ratio,
                moment,
                (state[x], state[v]),
                tangent.is_some() && ratio_index.is_some(),
            );
            let [a, b, c, d] = turn.matrix;
            (state[x], state[v]) =
                (a * state[x] + b * state[v] + turn.shift[0], c * state[x] + d * state[v] + turn.shift[1]);
            let Some(tangent) = tangent.as_deref_mut() else { continue };
            mix_columns(tangent, x, turn.matrix);
            if let Some(ratio_index) = ratio_index {
                // Gradient of the ratio at `middle`: that of the ratio at the period's start, and that of its rate
                // times `middle`.
                add_column(tangent, x, ratio_index, turn.slope[0]);
                add_column(tangent, x, ratio_index + 1, turn.slope[0] * middle);
                add_column(tangent, v, ratio_index, turn.slope[1]);
                add_column(tangent, v, ratio_index + 1, turn.slope[1] * middle);
            }
        }
    }

    /// Returns the number of modes whose rates the back-EMF opposes.
    pub(super) fn set_back_emf_modes(&self) -> usize {
        if self.back_emf.1 { self.modes.len() } else { 0 }
    }

    /// Returns the factor of the total rate that back-EMF subtracts from the rigid rate in `h` (s).
    pub(super) fn back_emf_fraction(&self, h: f64) -> f64 {
        let a = self.back_emf.0;
        let s = 1.0 + self.modes[..self.set_back_emf_modes()].iter().map(|mode| mode.gain).sum::<f64>();
        if s == 0.0 { a * h } else { -libm::expm1(-a * h * s) / s }
    }

    /// Applies back-EMF alone: z' = -a g c z, of rank one, with the exponential z - g (1 - exp(-a s h))/s c z, s = c g.
    fn brake(&self, h: f64, state: &mut [f64], tangent: Option<&mut DMatrix<f64>>) {
        let (mode_count, part) = (self.set_back_emf_modes(), self.back_emf_fraction(h));
        let rate = (0..=mode_count).map(|i| state[1 + 2 * i]).sum::<f64>();
        state[1] -= part * rate;
        for (index, mode_model) in self.modes.iter().enumerate() {
            state[3 + 2 * index] -= mode_model.gain * part * rate;
        }
        if let Some(tangent) = tangent {
            let mut rate = tangent.column(1).into_owned();
            for index in 1..=mode_count {
                rate += tangent.column(1 + 2 * index);
            }
            for index in 0..=self.modes.len() {
                let gain = if index == 0 { 1.0 } else { self.modes[index - 1].gain };
                tangent.column_mut(1 + 2 * index).axpy(-gain * part, &rate, 1.0);
            }
        }
    }
}

impl KalmanMode {
    fn turn(&self, h: f64, ratio: f64, moment: f64, (x, v): (f64, f64), with_slope: bool) -> ModeTransition {
        // The flow in (x, x'/w) depends on w h alone, so a different frequency is equivalent to a different time.
        let [a, b, c, d] = self.flow.transition(ratio * h);
        let w = ratio * self.frequency;
        let (b, c) = (b / w, c * w);
        let centre = self.gain * moment / (w * w);
        let mut turn = ModeTransition {
            matrix: [a, b, c, d],
            shift: [centre * (1.0 - a), -centre * c],
            slope: [0.0; 2],
        };
        if with_slope {
            // With the generator A and E = diag(0, 1): dR/dw = (h A R + E R - R E)/w, and the equilibrium scales with
            // 1/w².
            let (p, q) = (a * (x - centre) + b * v, c * (x - centre) + d * v);
            let slope = [
                h * q - b * v - 2.0 * centre * (1.0 - a),
                -h * w * (w * p + self.drag * q) + q - d * v + 2.0 * centre * c,
            ];
            turn.slope = slope.map(|by_frequency| by_frequency / ratio);
        }
        turn
    }
}

/// Adds a multiple of a column to another one.
fn add_column(matrix: &mut DMatrix<f64>, to: usize, from: usize, factor: f64) {
    let rows = matrix.nrows();
    let all = matrix.as_mut_slice();
    for row in 0..rows {
        all[to * rows + row] += factor * all[from * rows + row];
    }
}

/// Transforms a column and the one after it by a 2 x 2 matrix.
fn mix_columns(matrix: &mut DMatrix<f64>, first: usize, [a, b, c, d]: [f64; 4]) {
    let rows = matrix.nrows();
    let pair = &mut matrix.as_mut_slice()[first * rows..(first + 2) * rows];
    let (first, second) = pair.split_at_mut(rows);
    for (x, v) in first.iter_mut().zip(second) {
        (*x, *v) = (a * *x + b * *v, c * *x + d * *v);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use flexsc_dynamics::axis_model::AxisModel;
    use flexsc_dynamics::flow::CoupledMatrices;
    use flexsc_spacecraft::body::Planar;

    const WIDE: [f64; 2] = [0.1, 3.0];

    /// Returns a body with four modes: the third is damped, the last overdamped.
    fn body() -> AxisModel {
        let text = "modes = [{ frequency = 0.3, gain = 1.44 }, \
                    { frequency = 0.8, gain = 0.21 }, { frequency = 1.0, gain = 0.165, damping = 0.02 }, \
                    { frequency = 2.0, gain = 0.72, damping = 1.5 }]";
        let body: Planar = flexsc_formats::document::from_text(text).expect("valid");
        AxisModel::from(&body)
    }

    const STATE: [f64; 10] = [0.06, -1e-3, 4e-3, 2e-3, -1e-3, 3e-4, 2e-4, -5e-4, 1e-4, 7e-4];

    /// Returns the exact motion at a constant ratio, by the matrix exponential.
    fn exact(back_emf: (f64, bool), ratio: f64, moment: f64, h: f64) -> Vec<f64> {
        let (transition, input) =
            CoupledMatrices::new(&body(), back_emf.0, back_emf.1, &[ratio; 4]).discrete(h);
        (transition * nalgebra::DVector::from_row_slice(&STATE) + input * moment).as_slice().to_vec()
    }

    fn split(
        back_emf: (f64, bool),
        ratio: f64,
        moment: f64,
        h: f64,
        substeps: u32,
    ) -> (Vec<f64>, DMatrix<f64>) {
        let model = FilterModel::new(&body().modes, 1, back_emf, substeps, WIDE);
        let mut state = STATE.to_vec();
        state.extend([ratio, 0.0]);
        let mut tangent = DMatrix::identity(12, 12);
        model.propagate(h, moment, &mut state, Some(&mut tangent));
        (state, tangent.transpose())
    }

    #[test]
    fn without_back_emf_the_flow_is_the_matrix_exponential() {
        let (state, tangent) = split((0.0, true), 0.7, 3e-5, 0.3, 1);
        for (value, exact) in state.iter().zip(exact((0.0, true), 0.7, 3e-5, 0.3)) {
            assert!((value - exact).abs() < 1e-15, "{value} {exact}");
        }
        let (transition, _) = CoupledMatrices::new(&body(), 0.0, true, &[0.7; 4]).discrete(0.3);
        assert!((tangent.view((0, 0), (10, 10)) - transition).amax() < 1e-14);
    }

    #[test]
    fn splitting_is_of_second_order() {
        for total in [true, false] {
            let error = |substeps| {
                let (transition, _) = CoupledMatrices::new(&body(), 0.05, total, &[0.7; 4]).discrete(0.3);
                (split((0.05, total), 0.7, 3e-5, 0.3, substeps).1.view((0, 0), (10, 10)) - transition).amax()
            };
            let (coarse, fine) = (error(8), error(16));
            assert!(coarse > 1e-6 && (coarse / fine - 4.0).abs() < 0.02, "{total}: {coarse} {fine}");
        }
    }

    #[test]
    fn derivative_by_the_ratio_is_that_of_the_exact_motion() {
        let (back_emf, moment, h, step) = ((1e-3, true), 3e-5, 0.3, 1e-5);
        let (_, tangent) = split(back_emf, 0.7, moment, h, 100);
        let (above, below) = (exact(back_emf, 0.7 + step, moment, h), exact(back_emf, 0.7 - step, moment, h));
        for (row, (a, b)) in above.iter().zip(&below).enumerate() {
            let slope = (a - b) / (2.0 * step);
            assert!((tangent[(row, 10)] - slope).abs() < 2e-11, "{row}: {} {slope}", tangent[(row, 10)]);
        }
    }

    #[test]
    fn derivative_by_the_rate_is_that_of_the_flow_itself() {
        for ratios in [1, 4] {
            let model = FilterModel::new(&body().modes, ratios, (1e-3, true), 3, WIDE);
            let mut start = STATE.to_vec();
            (0..ratios).for_each(|_| start.extend([0.7, -3e-3]));
            let order = model.order();
            let mut tangent = DMatrix::identity(order, order);
            model.propagate(0.3, 3e-5, &mut start.clone(), Some(&mut tangent));
            for column in 0..order {
                let shifted = |by: f64| {
                    let mut state = start.clone();
                    state[column] += by;
                    model.propagate(0.3, 3e-5, &mut state, None);
                    state
                };
                let (above, below) = (shifted(1e-4), shifted(-1e-4));
                for row in 0..order {
                    let slope = (above[row] - below[row]) / 2e-4;
                    assert!((tangent[(column, row)] - slope).abs() < 1e-9, "{ratios} {row} {column}");
                }
            }
        }
    }
}
