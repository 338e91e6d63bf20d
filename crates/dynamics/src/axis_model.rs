//! Model of a body about one axis: one angle, any number of elastic modes, driven by one moment.
//!
//! x_r'' = m, x_i'' + 2 zeta_i w_i x_i' + w_i² x_i = k_i m, x = x_r + sum x_i, with m = torque / inertia (\[Silaev\],
//! equation (1); hybrid coordinates, \[Likins70\]). Under a constant torque the rigid part is a parabola and every mode
//! turns about its shifted equilibrium, so that no step size is needed.

use flexsc_numerics::quantity::{Finite, Frequency, NonNegative, Positive};

use crate::{AxisState, ModeState};

/// Model of a body about one axis.
#[derive(Clone, Debug, PartialEq)]
pub struct AxisModel {
    /// Moment of inertia (kg m²); 1 if every torque is a reduced moment (rad/s²).
    pub inertia: Positive,
    /// Rigid angle at the start (rad).
    pub angle: Finite,
    /// Rigid rate at the start (rad/s).
    pub rate: Finite,
    /// Quantity that the actuator commands.
    pub drive: CommandedQuantity,
    /// Damping that couples the modes (1/s): it adds -sum_j `damping_matrix`\[i\]\[j\] x_j' to x_i''; empty without coupling.
    pub damping_matrix: Vec<Vec<Finite>>,
    /// Elastic modes.
    pub modes: Vec<AxisMode>,
    /// Coordinates that are observed in addition to the hub's angle.
    pub outputs: Vec<AxisOutput>,
}

/// Quantity that the actuator of a one-axis body commands.
#[derive(Copy, Clone, Debug, Default, PartialEq, Eq)]
pub enum CommandedQuantity {
    /// Torque (N m): the modes are those of the free body and contribute to the hub's angle.
    #[default]
    Torque,
    /// Acceleration of the hub (rad/s²): the modes are those of the body clamped at the hub and do not contribute to the
    /// hub's angle (\[Rotation\], equations (17) and (18)).
    Motion,
}

/// Elastic mode about one axis, x'' + 2 zeta w x' + w² x = k m.
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct AxisMode {
    /// Natural frequency w (rad/s).
    pub frequency: Frequency,
    /// Modal gain k: modal acceleration per unit of the rigid acceleration by the commanded torque.
    pub gain: Finite,
    /// Modal gain of a torque on the hub, which differs from `gain` if the commanded torque acts elsewhere. The modal mass is
    /// the inertia divided by it.
    pub hub_gain: Finite,
    /// Damping ratio zeta: 0 undamped, 1 critical.
    pub damping: NonNegative,
    /// Displacement at the start (rad).
    pub displacement: Finite,
    /// Rate at the start (rad/s).
    pub rate: Finite,
}

/// Coordinate that is observed in addition to the hub's angle: y = rigid x_r + sum modes\[i\] x_i.
#[derive(Clone, Debug, PartialEq)]
pub struct AxisOutput {
    /// Name, such as `tip`.
    pub name: String,
    /// Unit.
    pub unit: String,
    /// Weight of the rigid angle.
    pub rigid: Finite,
    /// Weight of each mode's displacement, in the order of the modes.
    pub modes: Vec<Finite>,
}

impl Default for AxisModel {
    /// Returns a rigid body of unit inertia at rest.
    fn default() -> Self {
        Self {
            inertia: Positive::ONE,
            angle: Finite::default(),
            rate: Finite::default(),
            drive: CommandedQuantity::default(),
            damping_matrix: Vec::new(),
            modes: Vec::new(),
            outputs: Vec::new(),
        }
    }
}

impl AxisModel {
    /// Returns true if the damping matrix couples the modes.
    pub fn is_coupled(&self) -> bool {
        !self.damping_matrix.is_empty()
    }

    /// Returns the ratio of the command to the rigid acceleration (kg m²): 1 if the motion itself is commanded.
    pub fn commanded_inertia(&self) -> f64 {
        match self.drive {
            CommandedQuantity::Torque => self.inertia.get(),
            CommandedQuantity::Motion => 1.0,
        }
    }

    /// Returns true if the inertia is 1, as of a body that is described without one.
    pub fn has_unit_inertia(&self) -> bool {
        self.inertia == Positive::ONE
    }

    /// Returns true if the command is an acceleration (rad/s²) and not a torque (N m): the motion of the hub, or the
    /// reduced moment of a body without inertia.
    pub fn commands_acceleration(&self) -> bool {
        self.drive == CommandedQuantity::Motion || self.has_unit_inertia()
    }

    /// Returns the unit of a torque on the body.
    pub fn torque_unit(&self) -> &'static str {
        if self.has_unit_inertia() { "rad/s²" } else { "N m" }
    }

    /// Returns the name of the commanded quantity and its unit.
    pub fn commanded(&self) -> (&'static str, &'static str) {
        if self.commands_acceleration() { ("acceleration", "rad/s²") } else { ("torque", "N m") }
    }

    /// Returns the state at the start of a run.
    pub fn initial_state(&self) -> AxisState {
        AxisState {
            rigid_angle: self.angle.get(),
            rigid_rate: self.rate.get(),
            modes: self.modes.iter().map(AxisMode::start).collect(),
        }
    }
}

impl AxisMode {
    /// Creates a mode that starts at rest, under a torque on the hub.
    pub fn at_rest(frequency: Frequency, gain: Finite, damping: NonNegative) -> Self {
        let rest = Finite::default();
        Self { frequency, gain, hub_gain: gain, damping, displacement: rest, rate: rest }
    }

    /// Returns the excitability k/w²: the static displacement for each unit of reduced moment (s²).
    pub fn excitability(&self) -> f64 {
        self.gain.get() / (self.frequency.get() * self.frequency.get())
    }

    /// Returns the amplitude (rad) of the free vibration from a phase: without damping the largest displacement, else
    /// the absolute value of the phasor x + i (x' + zeta w x)/w_d. NaN at critical damping and above.
    pub fn amplitude(&self, phase: ModeState) -> f64 {
        let zeta = self.damping.get();
        let ModeState { displacement: x, quadrature: y } = phase;
        let imaginary = (y + zeta * x) / f64::sqrt((1.0 - zeta) * (1.0 + zeta));
        f64::sqrt(x * x + imaginary * imaginary)
    }

    /// Returns the kinetic and strain energy (J) of the mode on a body of this inertia (kg m²). 0 for a mode without
    /// gain at the hub, which no torque there moves and whose energy is therefore unknown.
    pub fn energy(&self, phase: ModeState, inertia: f64) -> f64 {
        let (w, gain) = (self.frequency.get(), self.hub_gain.get().abs());
        let ModeState { displacement: x, quadrature: y } = phase;
        if gain > 0.0 { 0.5 * inertia / gain * w * w * (x * x + y * y) } else { 0.0 }
    }

    /// Returns the phase at the start of a run.
    pub fn start(&self) -> ModeState {
        ModeState {
            displacement: self.displacement.get(),
            quadrature: self.rate.get() / self.frequency.get(),
        }
    }
}

impl AxisOutput {
    /// Returns the coordinate in a state.
    pub fn evaluate(&self, state: &AxisState) -> f64 {
        let modes = self.modes.iter().zip(&state.modes);
        modes.fold(self.rigid.get() * state.rigid_angle, |sum, (w, mode)| sum + w.get() * mode.displacement)
    }

    /// Returns the rate of the coordinate in a state, for modes of the given frequencies (rad/s).
    pub fn rate_of(&self, state: &AxisState, frequencies: &[f64]) -> f64 {
        let modes = self.modes.iter().zip(&state.modes).zip(frequencies);
        modes.fold(self.rigid.get() * state.rigid_rate, |sum, ((weight, mode), w)| {
            sum + weight.get() * w * mode.quadrature
        })
    }
}
