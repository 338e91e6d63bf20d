//! Modes of a one-axis body as a table: the content of `flexsc modes` and of Python's `Scenario.modes`.

use flexsc_dynamics::axis_model::{AxisMode, AxisModel, AxisOutput};
use flexsc_spacecraft::body::{Drive, clamped_frequencies, free_frequencies};
use serde::Serialize;

/// Modes of a one-axis body as columns, in the order of the modes.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct OneAxisModes {
    /// Moment of inertia (kg m²).
    pub inertia_kg_m2: f64,
    /// Commanded quantity: with a torque the modes are those of the free body, with a motion those of the clamped one.
    pub drive: Drive,
    /// Natural frequencies (rad/s).
    pub frequencies_rad_s: Vec<f64>,
    /// Periods (s).
    pub periods_s: Vec<f64>,
    /// Damping ratios.
    pub dampings: Vec<f64>,
    /// Modal gains.
    pub gains: Vec<f64>,
    /// Excitabilities k/w² (s²).
    pub excitabilities_s2: Vec<f64>,
    /// Effective moments of inertia J k at the hub (kg m²): J² X_n\[theta\]² of a free body, m_n² of a clamped one.
    pub effective_inertias_kg_m2: Vec<f64>,
    /// Natural frequencies with the hub free (rad/s); none if this body does not exist.
    pub free_frequencies_rad_s: Option<Vec<f64>>,
    /// Natural frequencies with the hub held (rad/s); none if this body does not exist.
    pub clamped_frequencies_rad_s: Option<Vec<f64>>,
    /// Observed coordinates.
    pub outputs: Vec<OutputWeights>,
}

/// Observed coordinate: `rigid` times the rigid angle plus `weights` times the modes' displacements.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct OutputWeights {
    /// Name of the coordinate.
    pub name: String,
    /// Unit of the coordinate.
    pub unit: String,
    /// Weight of the rigid angle.
    pub rigid: f64,
    /// Weight of each mode.
    pub weights: Vec<f64>,
}

impl OneAxisModes {
    /// Returns the modes of a body.
    pub fn from_body(body: &AxisModel) -> Self {
        let column =
            |value: &dyn Fn(&AxisMode) -> f64| -> Vec<f64> { body.modes.iter().map(value).collect() };
        let inertia = body.inertia.get();
        let weighted = |output: &AxisOutput| OutputWeights {
            name: output.name.clone(),
            unit: output.unit.clone(),
            rigid: output.rigid.get(),
            weights: output.modes.iter().map(|weight| weight.get()).collect(),
        };
        Self {
            inertia_kg_m2: inertia,
            drive: body.drive.into(),
            frequencies_rad_s: column(&|mode| mode.frequency.get()),
            periods_s: column(&|mode| 2.0 * std::f64::consts::PI / mode.frequency.get()),
            dampings: column(&|mode| mode.damping.get()),
            gains: column(&|mode| mode.gain.get()),
            excitabilities_s2: column(&AxisMode::excitability),
            effective_inertias_kg_m2: column(&|mode| inertia * mode.hub_gain.get()),
            free_frequencies_rad_s: free_frequencies(body),
            clamped_frequencies_rad_s: clamped_frequencies(body),
            outputs: body.outputs.iter().map(weighted).collect(),
        }
    }
}
