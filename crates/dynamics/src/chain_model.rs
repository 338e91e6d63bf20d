//! Exact planar chain: the hub and the sections of its panels as rigid bodies at any angles.
//!
//! In the absolute angles psi (hub first) the linear model's inertia A and stiffness K become
//!
//! ```text
//! sum_j A_ij cos(psi_i - psi_j) psi_j'' + A_ij sin(psi_i - psi_j) psi_j'² + K_ij psi_j + C_ij psi_j' = Q_i
//! ```
//!
//! with the torques Q, of which a torque at the hub is Q_0 alone. There is no closed form: the motion is integrated to a tolerance. The steps depend on the
//! events of the run alone, not on the instants at which the state is read.

use nalgebra::{DMatrix, DVector};

use crate::axis_model::{AxisMode, AxisModel};

/// Equations of motion of a chain.
#[derive(Clone, Debug, PartialEq)]
pub struct Chain {
    /// Inertia matrix A of the module's equation; `stiffness` is K and `damping` is C.
    pub(crate) inertia: DMatrix<f64>,
    pub(crate) stiffness: DMatrix<f64>,
    pub(crate) damping: DMatrix<f64>,
    /// Rows that give the rigid angle and the displacement of each linear mode for small angles.
    pub(crate) modal: DMatrix<f64>,
    pub(crate) frequencies: Vec<f64>,
    pub(crate) tolerance: f64,
    /// Torque on each angle per unit of the commanded one: 1 on the hub if it acts there.
    pub(crate) load: Vec<f64>,
}

impl Chain {
    /// Creates a chain of sections of the given lengths (m) whose linear model has these matrices, in the coordinates
    /// \[hub angle, displacement of each node in the hub's frame\], with the modes of `model`.
    pub fn new(
        lengths: &[f64],
        mass: &DMatrix<f64>,
        stiffness: &DMatrix<f64>,
        model: &AxisModel,
        tolerance: f64,
    ) -> Self {
        let n = lengths.len() + 1;
        // v_k = sum over j <= k of l_j (psi_j - psi_0).
        let to_nodes = DMatrix::from_fn(n, n, |k, j| match (k, j) {
            (0, 0) => 1.0,
            (0, _) => 0.0,
            (k, 0) => -lengths[..k].iter().sum::<f64>(),
            (k, j) if j <= k => lengths[j - 1],
            _ => 0.0,
        });
        let modal = modal(lengths, mass, model) * &to_nodes;
        let mut damping = DMatrix::zeros(n, n);
        for (mode, row) in model.modes.iter().zip(modal.row_iter().skip(1)) {
            // A mode's damping force J/k 2 zeta w x' acts on each coordinate in proportion to its row.
            let strength = 2.0 * mode.damping.get() * mode.frequency.get() * model.inertia.get();
            if mode.hub_gain.get() > 0.0 {
                damping += row.transpose() * row * (strength / mode.hub_gain.get());
            }
        }
        Self {
            inertia: to_nodes.transpose() * mass * &to_nodes,
            stiffness: to_nodes.transpose() * stiffness * &to_nodes,
            damping,
            modal,
            frequencies: model.modes.iter().map(|mode| mode.frequency.get()).collect(),
            tolerance,
            load: (0..n).map(|k| if k == 0 { 1.0 } else { 0.0 }).collect(),
        }
    }

    /// Distributes the commanded torque: `load` is the torque on the hub and on each section per unit of it.
    #[must_use]
    pub fn with_load(self, load: Vec<f64>) -> Self {
        Self { load, ..self }
    }

    /// Returns the angles, then the rates, of a straight chain.
    pub(crate) fn start(&self, angle: f64, rate: f64) -> Vec<f64> {
        let n = self.inertia.nrows();
        [vec![angle; n], vec![rate; n]].concat()
    }
}

/// Computes the rows that give the rigid angle and the displacement of each mode from hub angle and node displacements:
/// x_n = k_n/J r_n^T M q, where r_n is the shape of a mode whose hub angle is 1.
fn modal(lengths: &[f64], mass: &DMatrix<f64>, model: &AxisModel) -> DMatrix<f64> {
    let (n, inertia) = (lengths.len() + 1, model.inertia.get());
    let shape = |mode: usize| {
        let mut displacement = 0.0;
        DVector::from_fn(n, |k, _| {
            if k == 0 {
                return 1.0;
            }
            displacement += lengths[k - 1] * model.outputs[k - 1].modes[mode].get();
            displacement
        })
    };
    let rigid = mass.row(0) / inertia;
    let effective_shape = |(index, mode): (usize, &AxisMode)| {
        (shape(index).transpose() * mass) * (mode.hub_gain.get() / inertia)
    };
    let rows: Vec<_> = std::iter::once(rigid.into_owned())
        .chain(model.modes.iter().enumerate().map(effective_shape))
        .collect();
    DMatrix::from_rows(&rows)
}
