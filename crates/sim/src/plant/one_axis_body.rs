//! One-axis body at the current instant, and the quantities that each of its motions gives to the record.

use flexsc_control::sensor::{Orientation, Truth};
use flexsc_dynamics::axis_model::{AxisModel, AxisOutput};
use flexsc_dynamics::{AngleObservation, AxisState, MotionPiece, is_bounded};
use flexsc_numerics::polynomial::Polynomial;
use flexsc_numerics::time::Instant;
use flexsc_record::{Attitude, ModeMotion, Modes, OutputMotion, Outputs, Rate, Record, RecordError};

use super::AppliedTorque;

/// One-axis body at the current instant.
#[derive(Clone, Debug)]
pub struct OneAxisBody {
    /// State, and (`sensed`) the sensed angle and rate, at `evaluated_at`.
    pub state: AxisState,
    pub sensed: AngleObservation,
    pub evaluated_at: Instant,
    /// Natural frequencies of the modes (rad/s).
    pub frequencies: Vec<f64>,
    /// Observed coordinates.
    pub outputs: Vec<AxisOutput>,
}

/// Quantities of a one-axis motion for the record.
pub trait OneAxisQuantities {
    /// Returns the body at the current instant.
    fn body(&self) -> &OneAxisBody;

    /// Returns the row of the observed coordinates at the current instant; `None` if the body has none.
    fn output_row(&self) -> Option<Outputs> {
        self.body().output_row()
    }

    /// Records the motion of the segment that ends at `now`, piece by piece, if the record wants it.
    fn record_pieces(
        &self,
        _now: Instant,
        _applied: &AppliedTorque,
        _record: &mut dyn Record,
    ) -> Result<(), RecordError> {
        Ok(())
    }

    /// Passes the pieces of the motion between two instants of this segment, and the rigid angle over each, to `take`.
    fn expand(
        &self,
        _span: [Instant; 2],
        _applied: &AppliedTorque,
        _take: &mut dyn FnMut(&MotionPiece, &Polynomial),
    ) {
    }
}

/// Returns the row of the given values and rates; `None` without any.
pub fn output_row(outputs: impl Iterator<Item = (f64, f64)>) -> Option<Outputs> {
    let outputs: Vec<_> = outputs.map(|(value, rate)| OutputMotion { value, rate }).collect();
    (!outputs.is_empty()).then_some(Outputs { outputs })
}

impl OneAxisBody {
    /// Creates the body at the start, with what its sensor measures there.
    pub fn new(body: &AxisModel, state: AxisState, sensed: AngleObservation) -> Self {
        Self {
            state,
            sensed,
            evaluated_at: Instant::START,
            frequencies: body.modes.iter().map(|mode| mode.frequency.get()).collect(),
            outputs: body.outputs.clone(),
        }
    }

    /// Returns the rates of the modes (rad/s).
    pub fn mode_rates(&self) -> impl Iterator<Item = f64> {
        self.frequencies.iter().zip(&self.state.modes).map(|(w, phase)| w * phase.quadrature)
    }

    /// Writes the true state; returns false if it is no longer finite.
    #[inline]
    pub fn write_truth(&self, truth: &mut Truth) -> bool {
        let AngleObservation { angle, rate, .. } = self.sensed;
        if !(is_bounded(angle) && is_bounded(rate)) {
            return false;
        }
        truth.orientation = Orientation::Angle(angle);
        (truth.rate[0], truth.rigid_rate[0], truth.rate_integral[0]) = (rate, self.state.rigid_rate, angle);
        true
    }

    /// Returns the row of the observed coordinates; `None` if the body has none.
    pub fn output_row(&self) -> Option<Outputs> {
        let Self { state, frequencies, outputs, .. } = self;
        output_row(outputs.iter().map(|output| (output.evaluate(state), output.rate_of(state, frequencies))))
    }

    /// Returns the rows of the motion; `measured` is the held measurement of a sampled sensor (rad).
    pub fn motion_rows(&self, measured: Option<f64>) -> (Attitude, Rate, Modes) {
        let Self { state, sensed, frequencies, .. } = self;
        let modes: Vec<_> = state
            .modes
            .iter()
            .zip(frequencies)
            .map(|(phase, w)| ModeMotion {
                displacement_rad: phase.displacement,
                rate_rad_s: w * phase.quadrature,
            })
            .collect();
        (
            Attitude {
                angle_rad: sensed.angle,
                rigid_rad: state.rigid_angle,
                measured_rad: measured.unwrap_or(sensed.angle),
            },
            Rate { rate_rad_s: sensed.rate, rigid_rad_s: state.rigid_rate },
            Modes { elastic_rad: modes.iter().map(|mode| mode.displacement_rad).sum(), modes },
        )
    }
}
