//! The modes of a spatial body as a table: what jets excite, and a gyro sees of it.

use serde::Serialize;

use crate::body::Spatial;
use crate::scenario::Scenario;

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
    /// The modes of a scenario's body with three axes. Actuators that are no jets give a torque of 1 N m.
    pub fn of(scenario: &Scenario, body: &Spatial) -> Self {
        let study = &scenario.study;
        let measured = study.measured(body);
        let per_axis = |of: &dyn Fn(usize, usize, f64) -> f64| {
            [0, 1, 2].map(|axis| {
                let forces = measured.inputs[axis].forces.iter().enumerate();
                forces.map(|(mode, force)| of(axis, mode, *force)).collect()
            })
        };
        let frequencies: Vec<f64> = measured.frequencies.iter().map(|frequency| frequency.get()).collect();
        let own = |axis: usize| measured.inputs[axis].acceleration;
        Self {
            periods_s: frequencies.iter().map(|frequency| 2.0 * std::f64::consts::PI / frequency).collect(),
            frequencies_rad_s: frequencies,
            dampings: body.modes.iter().map(|mode| mode.damping.get()).collect(),
            influences: per_axis(&|axis, mode, force| measured.seen[axis][mode] * force / own(axis)),
            energies_j_s2: per_axis(&|_, _, force| 0.5 * force * force),
            accelerations_rad_s2: [0, 1, 2].map(|axis| {
                study
                    .groups
                    .as_ref()
                    .filter(|_| study.fired[axis])
                    .map_or([own(axis); 2], |groups| [0, 1].map(|sign| groups[axis][sign].acceleration))
            }),
        }
    }
}
