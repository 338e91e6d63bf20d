//! Watch of the angle of a one-axis body: its largest distance from the goal, with the instant, from the motion itself.

use flexsc_control::law::Setpoint;
use flexsc_dynamics::MotionPiece;

use super::largest_sample::LargestSample;

/// Name of the metric of the largest distance of the angle from its goal.
pub(super) const PEAK: &str = "angle_error_peak_rad";

/// Watch of the distance from a goal after the manoeuvre.
#[derive(Clone, Debug)]
pub(super) struct AngleWatch {
    goal: Setpoint,
    largest: LargestSample,
}

impl AngleWatch {
    /// Creates a watch of the distance from a goal, from the time of the goal on.
    pub fn new(goal: Setpoint) -> Self {
        Self { goal, largest: LargestSample { value: 0.0, at: f64::NAN, mode: 0 } }
    }

    /// Returns the largest distance (rad) with its instant; `None` before the goal starts.
    pub fn finish(self) -> Option<LargestSample> {
        Some(self.largest).filter(|largest| largest.at.is_finite())
    }

    /// Observes a piece of the motion.
    pub fn observe(&mut self, piece: &MotionPiece) {
        let goal = self.goal.from.seconds();
        let from = ((goal - piece.from) / piece.length).max(0.0);
        if from >= 1.0 {
            return;
        }
        let (start, slope) =
            (self.goal.angle + self.goal.rate * (piece.from - goal), self.goal.rate * piece.length);
        let error = piece.angle.minus_line(start, slope).restrict(from, 1.0);
        let known = self.largest.value;
        if error.magnitude(known) <= known && self.largest.at.is_finite() {
            return;
        }
        let mut places = vec![0.0, 1.0];
        error.derivative().roots(0.0, &mut places);
        for place in places {
            let value = error.at(place).abs();
            if value > self.largest.value || self.largest.at.is_nan() {
                let at = piece.from + piece.length * (from + (1.0 - from) * place);
                self.largest = LargestSample { value, at, mode: 0 };
            }
        }
    }
}
