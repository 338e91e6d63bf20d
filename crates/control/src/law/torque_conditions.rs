//! Conditions under which the largest torque of a law is estimated before a run.

/// Conditions of a law about an axis for the estimate of its largest torque.
#[derive(Copy, Clone, Debug)]
pub struct TorqueConditions {
    /// Angle error at which the law begins (rad).
    pub angle: f64,
    /// Inertia about the axis (kg m²).
    pub inertia: f64,
    /// Torque per unit of a torque command (N m).
    pub torque_per_command: f64,
    /// Torque of jets that a law fires at their full torque (N m).
    pub jets: f64,
    /// Torque of magnetorquers (N m).
    pub magnetorquers: f64,
    /// Acceleration of the profile that the target follows (rad/s²), if it follows one.
    pub profile_acceleration: Option<f64>,
    /// True if the law's own limit and its stages count; the estimate for one-axis bodies leaves both out.
    pub detailed: bool,
}
