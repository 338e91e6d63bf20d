//! Selection of the modes that a command leaves at rest.

use flexsc_dynamics::axis_model::AxisMode;
use flexsc_formats::document::ConfigError;
use flexsc_numerics::phasor::Phasor;
use flexsc_numerics::quantity::Finite;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Largest number of zeros of a command.
const MOST: usize = 40;

/// Modes that a command leaves at rest. Both keys add up.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Suppression {
    /// Number of modes left at rest, lowest frequencies first.
    #[serde(default)]
    pub suppress: usize,
    /// Further zeros.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub zeros: Vec<SuppressedMode>,
}

/// A zero of the command's spectrum, at a mode or near it.
#[derive(Copy, Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(rename = "Target")]
pub struct SuppressedMode {
    /// Index of the mode.
    pub mode: usize,
    /// Shift of the zero from the mode's frequency, relative to that frequency.
    #[serde(default)]
    pub shift: Finite,
    /// Multiplicity of the zero: each additional one makes one more derivative of the spectrum vanish there.
    #[serde(default = "once")]
    pub times: u32,
}

fn once() -> u32 {
    1
}

/// Zero of a command: a frequency and damping ratio of modes that it leaves at rest.
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct Zero {
    /// Natural frequency (rad/s).
    pub frequency: f64,
    /// Damping ratio, below 1.
    pub damping: f64,
}

impl Zero {
    /// Returns the pole -zeta w + i w_d of a mode (1/s).
    pub fn pole(&self) -> Phasor {
        let Self { frequency: w, damping: zeta } = *self;
        Phasor::new(-zeta * w, w * f64::sqrt((1.0 - zeta) * (1.0 + zeta)))
    }

    /// Returns the zero at a mode.
    pub fn at_mode(mode: &AxisMode) -> Self {
        Self { frequency: mode.frequency.get(), damping: mode.damping.get() }
    }
}

impl Suppression {
    /// Returns the zeros, by frequency. `place` is the key of the table, for faults.
    pub fn zeros(&self, modes: &[AxisMode], place: &str) -> Result<Vec<Zero>, ConfigError> {
        let mut zeros = lowest(self.suppress, modes, place)?;
        let extra_zeros: usize = self.zeros.iter().map(|target| target.times as usize).sum();
        if zeros.len() + extra_zeros > MOST {
            let why = format!(
                "must make at most {MOST} zeros together with `suppress`, got {}",
                zeros.len() + extra_zeros
            );
            return Err(ConfigError::new(format!("{place}.zeros"), why));
        }
        for (index, target) in self.zeros.iter().enumerate() {
            let key = |name: &str| format!("{place}.zeros[{index}].{name}");
            let Some(mode) = modes.get(target.mode) else {
                return Err(ConfigError::new(key("mode"), index_error(target.mode, modes)));
            };
            let factor = 1.0 + target.shift.get();
            if factor <= 0.0 {
                let why = format!("must be above -1, for a frequency above 0, got {}", target.shift.get());
                return Err(ConfigError::new(key("shift"), why));
            }
            if target.times == 0 {
                return Err(ConfigError::new(key("times"), "must be 1 or more, got 0"));
            }
            let zero = Zero { frequency: factor * mode.frequency.get(), damping: mode.damping.get() };
            zeros.extend(std::iter::repeat_n(zero, target.times as usize));
        }
        zeros.sort_by(|a, b| a.frequency.total_cmp(&b.frequency));
        Ok(zeros)
    }
}

/// Returns the zeros at the `count` modes of the lowest frequencies. `place` is the key of the table that has the
/// number.
pub fn lowest(count: usize, modes: &[AxisMode], place: &str) -> Result<Vec<Zero>, ConfigError> {
    let key = || format!("{place}.suppress");
    if count > modes.len() {
        let why = format!("must be at most the number of the body's modes, {}, got {count}", modes.len());
        return Err(ConfigError::new(key(), why));
    }
    if count > MOST {
        return Err(ConfigError::new(key(), format!("must be at most {MOST}, got {count}")));
    }
    let mut zeros: Vec<Zero> = modes.iter().map(Zero::at_mode).collect();
    zeros.sort_by(|a, b| a.frequency.total_cmp(&b.frequency));
    zeros.truncate(count);
    Ok(zeros)
}

/// Returns the message about an index that belongs to no mode.
pub fn index_error(index: usize, modes: &[AxisMode]) -> String {
    match modes.len() {
        0 => format!("must be the index of a mode, and the body has none, got {index}"),
        count => format!("must be the index of a mode, 0 to {}, got {index}", count - 1),
    }
}
