//! The modes of a spatial body as a table: what jets excite, and a gyro sees of it.

use serde::Serialize;

use crate::scenario::SpatialLoop;

/// A spatial body's modes, column by column in the order of the modes.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Influences {
    /// Natural frequencies (rad/s).
    pub frequencies_rad_s: Vec<f64>,
    /// Periods (s).
    pub periods_s: Vec<f64>,
    /// Damping ratios.
    pub dampings: Vec<f64>,
    /// Influence of the jets that push to positive rates about each axis: the jump of the elastic rate at the gyro for each
    /// jump of the rigid rate, both about that axis, mu_ia = phi_g,ia Q_ia/m_a. Where it is negative, a feedback of the
    /// gyro's rate drives the mode.
    pub influences: [Vec<f64>; 3],
    /// Energy that a pulse from rest gives, for each squared second of it as long as it is short (J/s²): Q_ia²/2.
    pub energies_j_s2: [Vec<f64>; 3],
    /// Accelerations of the jets about each axis, m_a (rad/s²): plus, minus.
    pub accelerations_rad_s2: [[f64; 2]; 3],
}

impl Influences {
    /// The modes of a loop's body.
    pub fn of(spatial: &SpatialLoop) -> Self {
        let modes = &spatial.body.modes;
        let seen = spatial.body.shapes(&spatial.gyro.point);
        let per_axis = |of: &dyn Fn(usize, usize, f64) -> f64| {
            [0, 1, 2].map(|axis| {
                let forces = spatial.groups[axis][0].forces.iter().enumerate();
                forces.map(|(mode, force)| of(axis, mode, *force)).collect()
            })
        };
        let frequency = |mode: &crate::body::spatial::SpatialMode| mode.frequency.get();
        let signed = |axis: usize| spatial.groups[axis][0].acceleration;
        Self {
            frequencies_rad_s: modes.iter().map(frequency).collect(),
            periods_s: modes.iter().map(|mode| 2.0 * std::f64::consts::PI / frequency(mode)).collect(),
            dampings: modes.iter().map(|mode| mode.damping.get()).collect(),
            influences: per_axis(&|axis, mode, force| seen[mode].1[axis] * force / signed(axis)),
            energies_j_s2: per_axis(&|_, _, force| 0.5 * force * force),
            accelerations_rad_s2: [0, 1, 2]
                .map(|axis| [0, 1].map(|sign| spatial.groups[axis][sign].acceleration)),
        }
    }
}
