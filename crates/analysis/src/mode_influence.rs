//! Modes of a three-axis body as a table: excitation by the jets, and the response that a gyro measures.

use flexsc_dynamics::three_axis_model::ThreeAxisModel;
use serde::Serialize;

use flexsc_scenario::Scenario;

/// Modes of a three-axis body as columns, in the order of the modes.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ModeInfluences {
    /// Natural frequencies (rad/s).
    pub frequencies_rad_s: Vec<f64>,
    /// Periods (s).
    pub periods_s: Vec<f64>,
    /// Damping ratios.
    pub dampings: Vec<f64>,
    /// Influence of the jets that push to positive rates about each axis: the jump of the elastic rate at the gyro for
    /// each unit jump of the rigid rate, both about that axis, mu_ia = phi_g,ia Q_ia/m_a. Where it is negative, a
    /// feedback of the gyro's rate drives the mode.
    pub influences: [Vec<f64>; 3],
    /// Energy that a short pulse gives to a mode at rest, divided by the squared duration of the pulse (J/s²): Q_ia²/2.
    pub energies_j_s2: [Vec<f64>; 3],
    /// Accelerations of the jets about each axis, m_a (rad/s²): plus, minus.
    pub accelerations_rad_s2: [[f64; 2]; 3],
}

impl ModeInfluences {
    /// Returns the modes of a scenario's three-axis body. Actuators other than jets count as a torque of 1 N m.
    pub fn from_scenario(scenario: &Scenario, body: &ThreeAxisModel) -> Self {
        let settings = &scenario.study;
        let measured = settings.measured_rates(body);
        let per_axis = |value_of: &dyn Fn(usize, usize, f64) -> f64| {
            [0, 1, 2].map(|axis| {
                let forces = measured.inputs[axis].forces.iter().enumerate();
                forces.map(|(mode, force)| value_of(axis, mode, *force)).collect()
            })
        };
        let frequencies: Vec<f64> = measured.frequencies.iter().map(|frequency| frequency.get()).collect();
        let own = |axis: usize| measured.inputs[axis].acceleration;
        Self {
            periods_s: frequencies.iter().map(|frequency| 2.0 * std::f64::consts::PI / frequency).collect(),
            frequencies_rad_s: frequencies,
            dampings: body.modes.iter().map(|mode| mode.damping.get()).collect(),
            influences: per_axis(&|axis, mode, force| measured.visibilities[axis][mode] * force / own(axis)),
            energies_j_s2: per_axis(&|_, _, force| 0.5 * force * force),
            accelerations_rad_s2: [0, 1, 2].map(|axis| {
                settings
                    .groups
                    .as_ref()
                    .filter(|_| settings.jet_only_axes[axis])
                    .map_or([own(axis); 2], |groups| [0, 1].map(|sign| groups[axis][sign].acceleration))
            }),
        }
    }
}
