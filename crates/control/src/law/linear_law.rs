//! Linear form of a law: from angles and rates, axis by axis, to its commands, at its samples.

use flexsc_formats::document::ConfigError;
use flexsc_numerics::attitude::tensor;
use flexsc_numerics::time::Span;
use nalgebra::{DMatrix, Matrix3, dmatrix};

use super::compensator_input::CompensatorInput;
use super::{AttitudeLaw, Differentiation, LawKind, OutputQuantity, Pd, StateSpace};
use crate::linear_block::{BlockState, LinearBlock};

/// End of the name of the angle of the sample before, which a differentiator remembers.
pub const LAST_ANGLE: &str = "law_last_angle";

/// Law in the form of a linear block.
#[derive(Clone, Debug, PartialEq)]
pub struct LinearLaw {
    /// Period of the samples.
    pub period: Span,
    /// Block from measured angle (rad) and rate (rad/s) about each axis to the command about each axis.
    pub block: LinearBlock,
    /// True if the law commands accelerations (rad/s²), false if it commands torques or the input of a wheel.
    pub is_acceleration: bool,
    /// Inertia tensor of the law's own model (kg m²), if it has one.
    pub inertia: Option<Matrix3<f64>>,
}

impl LawKind {
    /// Returns the linear form of the law about an axis; the names of its states begin with `prefix`.
    ///
    /// # Errors
    /// A law that is not linear: a key within the law about that axis, and the reason.
    pub fn linear_about(&self, axis: usize, prefix: &str) -> Result<LinearLaw, ConfigError> {
        match self.about(axis) {
            Self::Pd(law) => law.linear(prefix),
            Self::Attitude(law) => Ok(law.linear(prefix)),
            Self::StateSpace(law) => law.linear(prefix),
            _ => {
                let why = "is not linear: a loop has `pd`, `attitude` or `state_space`";
                Err(ConfigError::new("", why))
            }
        }
    }

    /// Returns the linear form of a law about three axes together; `None` for laws about each axis.
    ///
    /// # Errors
    /// A law with an input that is no state of the body: the key within the law, and the reason.
    pub fn linear_about_three_axes(&self) -> Result<Option<LinearLaw>, ConfigError> {
        let Self::StateSpace(law) = self else { return Ok(None) };
        if law.is_three_axis() { law.linear_three_axis().map(Some) } else { Ok(None) }
    }
}

impl Pd {
    fn linear(&self, prefix: &str) -> Result<LinearLaw, ConfigError> {
        if self.extra.is_some() {
            return Err(ConfigError::new("extra", "is not supported in linear loops: leave it out"));
        }
        let (k_p, k_d) = (self.k_p.get(), self.k_d.get());
        let k_d = match self.differentiation {
            Differentiation::Difference => k_d / self.period.seconds(),
            Differentiation::Exact | Differentiation::Raw => k_d,
        };
        let block = match self.differentiation {
            Differentiation::Exact => LinearBlock::from_gain(dmatrix![-k_p, -k_d]),
            // The angle of the sample before is a state.
            Differentiation::Difference | Differentiation::Raw => LinearBlock {
                a: dmatrix![0.0],
                b: dmatrix![1.0, 0.0],
                c: dmatrix![k_d],
                d: dmatrix![-(k_p + k_d), 0.0],
                states: vec![BlockState::new(format!("{prefix}{LAST_ANGLE}"), "rad")],
            },
        };
        Ok(LinearLaw { period: self.period, block, is_acceleration: false, inertia: None })
    }
}

impl AttitudeLaw {
    /// Returns the feedback with its integral, then the filters.
    fn linear(&self, prefix: &str) -> LinearLaw {
        let (period, wn) = (self.period.seconds(), self.bandwidth.get());
        let d = dmatrix![-(wn * wn), -(2.0 * self.damping.get() * wn)];
        let mut block = match &self.integral {
            None => LinearBlock::from_gain(d),
            Some(integral) => LinearBlock {
                a: dmatrix![1.0],
                b: dmatrix![period, 0.0],
                c: dmatrix![-(wn * wn) / integral.time.get()],
                d,
                states: vec![BlockState::new(format!("{prefix}integral"), "rad s")],
            },
        };
        for (index, filter) in self.filters.iter().enumerate() {
            // Filters that cannot be sampled were rejected before.
            let Ok(filter) = filter.sampled(period) else { continue };
            let ([b0, b1, b2], [a1, a2]) = filter.coefficients();
            block = block.then(LinearBlock {
                a: dmatrix![-a1, 1.0; -a2, 0.0],
                b: dmatrix![b1 - a1 * b0; b2 - a2 * b0],
                c: dmatrix![1.0, 0.0],
                d: dmatrix![b0],
                states: (0..2)
                    .map(|k| BlockState::new(format!("{prefix}filter{index}_{k}"), "rad/s²"))
                    .collect(),
            });
        }
        let inertia = self.inertia.as_ref().map(tensor);
        LinearLaw { period: self.period, block, is_acceleration: true, inertia }
    }
}

impl StateSpace {
    fn linear(&self, prefix: &str) -> Result<LinearLaw, ConfigError> {
        let inputs = self.sampled()?.b.ncols();
        // A single input is the angle alone.
        let read = DMatrix::from_fn(inputs, 2, |row, column| f64::from(u8::from(row == column)));
        self.block(prefix, &DMatrix::identity(1, 1), &read)
    }

    fn linear_three_axis(&self) -> Result<LinearLaw, ConfigError> {
        let (inputs, outputs) = (self.named_inputs()?, self.named_outputs()?);
        let mut read = DMatrix::zeros(inputs.len(), 6);
        for (row, input) in inputs.iter().enumerate() {
            match input {
                CompensatorInput::Angle(axis) => read[(row, 2 * axis)] = 1.0,
                // The vector part is half the angle.
                CompensatorInput::VectorPart(axis) => read[(row, 2 * axis)] = 0.5,
                CompensatorInput::Rate(axis) => read[(row, 2 * axis + 1)] = 1.0,
                CompensatorInput::WheelSpeed(_) => {
                    let why =
                        format!("is no state of the body: a linear loop has angles and rates, not `{input}`");
                    return Err(ConfigError::new(format!("inputs[{row}]"), why));
                }
            }
        }
        let mut written = DMatrix::zeros(3, outputs.len());
        for (column, axis) in outputs.iter().enumerate() {
            written[(*axis, column)] = 1.0;
        }
        self.block("", &written, &read)
    }

    /// Returns the compensator between the angles and rates that `read` selects, with the sign of the error, and the
    /// commands that `written` distributes.
    fn block(
        &self,
        prefix: &str,
        written: &DMatrix<f64>,
        read: &DMatrix<f64>,
    ) -> Result<LinearLaw, ConfigError> {
        let sampled = self.sampled()?;
        let gain = self.gain.get();
        let states = (0..sampled.a.nrows()).map(|k| BlockState::new(format!("{prefix}law{k}"), "")).collect();
        let block = LinearBlock {
            b: -(&sampled.b * read),
            c: written * &sampled.c * gain,
            d: -(written * &sampled.d * read) * gain,
            a: sampled.a,
            states,
        };
        let is_acceleration = self.command == OutputQuantity::Acceleration;
        Ok(LinearLaw { period: self.period, block, is_acceleration, inertia: None })
    }
}
