//! The planar body as one linear system, z' = A z + g m, if a wheel's back-EMF or damping couples its modes.
//!
//! z = (x_r, x_r', x_1, x_1', x_2, x_2', ...); x_r'' = m - a r z, x_i'' + 2 zeta_i w_i x_i' + w_i² x_i = k_i (m - a r
//! z), where r picks the rate that acts on the wheel (\[Wheel11, Sukhanov\], equations (4) and (6), corrected).

use flexsc_numerics::exponential::{exponential, exponentials};
use nalgebra::{DMatrix, DVector, RowDVector};

use crate::axis_model::AxisModel;
use crate::linear::{LinearFlow, LinearPlant};

/// System matrices of a body at constant frequencies.
#[derive(Clone, Debug, PartialEq)]
pub struct CoupledMatrices {
    /// System matrix A.
    pub system: DMatrix<f64>,
    /// Input vector g: acceleration per unit of the reduced moment (rad/s²).
    pub input: DVector<f64>,
    /// Row vector whose product with z is the measured angle.
    pub angle: RowDVector<f64>,
    /// Row vector whose product with z is the measured rate.
    pub rate: RowDVector<f64>,
}

impl CoupledMatrices {
    /// Creates the system of a body whose wheel has the back-EMF a (1/s), proportional to the total rate if `total` is
    /// true, else to the rigid rate. Each natural frequency is multiplied by a ratio.
    pub fn new(body: &AxisModel, back_emf: f64, total: bool, ratios: &[f64]) -> Self {
        let order = 2 + 2 * body.modes.len();
        let every = |first: usize| RowDVector::from_fn(order, |_, j| if j % 2 == first { 1.0 } else { 0.0 });
        let (angle, rate) = (every(0), every(1));
        let mut input = DVector::zeros(order);
        input[1] = 1.0;
        let mut system = DMatrix::zeros(order, order);
        system[(0, 1)] = 1.0;
        for (i, (mode, ratio)) in body.modes.iter().zip(ratios).enumerate() {
            let (x, v, w) = (2 + 2 * i, 3 + 2 * i, mode.frequency.get() * ratio);
            input[v] = mode.gain.get();
            system[(x, v)] = 1.0;
            system[(v, x)] = -w * w;
            system[(v, v)] = -2.0 * mode.damping.get() * w;
        }
        for (i, row) in body.damping_matrix.iter().enumerate() {
            for (j, damping) in row.iter().enumerate() {
                system[(3 + 2 * i, 3 + 2 * j)] -= damping.get();
            }
        }
        let sensed =
            if total { rate.clone() } else { RowDVector::from_fn(order, |_, j| f64::from(u8::from(j == 1))) };
        system -= &input * sensed * back_emf;
        Self { system, input, angle, rate }
    }

    /// Returns the exact flow of the system, with the measured angle as its output; `None` if its numbers leave the
    /// range of doubles.
    pub fn flow(&self) -> Option<LinearFlow> {
        let order = self.system.nrows();
        let system = LinearPlant {
            matrix: self.system.clone(),
            input: DMatrix::from_column_slice(order, 1, self.input.as_slice()),
            output: DMatrix::from_row_slice(1, order, self.angle.clone_owned().as_slice()),
        };
        LinearFlow::new(system.split())
    }

    /// Returns the transition matrix over `h` seconds, and the response to a constant unit of the reduced moment.
    pub fn discrete(&self, h: f64) -> (DMatrix<f64>, DVector<f64>) {
        apart(&exponential(&self.whole(h)))
    }

    /// Computes [`CoupledMatrices::discrete`] for several systems of one order, each over its own time span (s).
    pub fn discrete_many(all: &[(&Self, f64)]) -> Vec<(DMatrix<f64>, DVector<f64>)> {
        let wholes: Vec<_> = all.iter().map(|(system, h)| system.whole(*h)).collect();
        exponentials(&wholes).iter().map(apart).collect()
    }

    /// Returns the generator over `h` seconds, augmented by the input.
    fn whole(&self, h: f64) -> DMatrix<f64> {
        let order = self.system.nrows();
        let mut whole = DMatrix::zeros(order + 1, order + 1);
        whole.view_mut((0, 0), (order, order)).copy_from(&(&self.system * h));
        whole.view_mut((0, order), (order, 1)).copy_from(&(&self.input * h));
        whole
    }
}

/// Splits an augmented transition into the transition matrix and the response to a unit of the input.
fn apart(whole: &DMatrix<f64>) -> (DMatrix<f64>, DVector<f64>) {
    let order = whole.nrows() - 1;
    (
        whole.view((0, 0), (order, order)).into_owned(),
        whole.view((0, order), (order, 1)).column(0).into_owned(),
    )
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::axis_model::AxisMode;
    use flexsc_numerics::quantity::{Finite, Frequency, NonNegative};

    #[test]
    fn the_discrete_system_of_the_third_paper() {
        let modes = [(0.3, 1.44), (0.8, 0.21), (1.0, 0.165), (2.0, 0.72)].map(|(frequency, gain)| {
            let frequency = Frequency::new(frequency).expect("in range");
            AxisMode::at_rest(frequency, Finite::new(gain).expect("finite"), NonNegative::default())
        });
        let body = AxisModel { modes: modes.to_vec(), ..AxisModel::default() };
        let (ad, bd) = CoupledMatrices::new(&body, 1e-4, true, &[1.0; 4]).discrete(0.3);
        // Reference: SciPy's expm of the same system.
        let close = |value: f64, exact: f64| assert!((value / exact - 1.0).abs() < 1e-12, "{value} {exact}");
        close(5e-4 * bd[0], 2.249_920_797_089e-05);
        close(5e-4 * bd[1], 1.499_921_017_754e-04);
        close(5e-4 * bd[2], 3.237_699_584_497e-05);
        close(5e-4 * bd[3], 2.156_971_523_391e-04);
        close(ad[(0, 1)], 0.299_995_500_158_4);
        close(ad[(2, 2)], 0.995_952_791_283_2);
        close(ad[(2, 3)], 0.299_588_692_965_7);
        close(ad[(3, 2)], -0.026_962_982_366_9);
        close(ad[(3, 3)], 0.995_909_651_852_7);
    }
}
