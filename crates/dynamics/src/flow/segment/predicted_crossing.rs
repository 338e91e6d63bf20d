//! Prediction of the first trip of a guard on a segment: predicted, refined and certified without a search.

use flexsc_numerics::time::Span;

use super::UncoupledSegment;
use crate::axis_model::AxisModel;
use crate::crossing::Crossing;
use crate::damping::{Damped, DampingRule, Undamped};
use crate::guard::Guard;
use crate::predicted_crossing::{
    self, FARTHEST_TURN, PredictedCrossing, PredictedLevel, PredictedMode, SegmentStart,
};
use crate::{AngleObservation, AxisState};

/// Predictor of crossings: the highest frequency (rad/s), and work space for the modes.
#[derive(Clone, Debug)]
pub struct CrossingPredictor {
    fastest: f64,
    modes: PredictorModes,
}

#[derive(Clone, Debug)]
enum PredictorModes {
    Undamped(Vec<PredictedMode<f64>>),
    Damped(Vec<PredictedMode<f64, Damped<f64>>>),
}

impl CrossingPredictor {
    /// Creates the predictor of a body's modes; `None` if one is critically damped or overdamped.
    pub fn new(body: &AxisModel) -> Option<Self> {
        let mode = |(frequency, _): (f64, f64)| oscillator(frequency, Undamped);
        let damped = |(frequency, ratio): (f64, f64)| oscillator(frequency, Damped::new(frequency, ratio));
        let all = || body.modes.iter().map(|mode| (mode.frequency.get(), mode.damping.get()));
        let highest = all().map(|(_, ratio)| ratio).fold(0.0, f64::max);
        let modes = if highest == 0.0 {
            PredictorModes::Undamped(all().map(mode).collect())
        } else {
            PredictorModes::Damped(all().map(damped).collect())
        };
        let fastest = all().map(|(frequency, _)| frequency).fold(0.0, f64::max);
        (highest < 1.0).then_some(Self { fastest, modes })
    }
}

fn oscillator<D>(frequency: f64, damping: D) -> PredictedMode<f64, D> {
    PredictedMode { frequency, equilibrium: 0.0, displacement: 0.0, quadrature: 0.0, damping }
}

impl UncoupledSegment {
    /// Predicts the first trip of one or two guards within `horizon`, without a search, and writes the state there to
    /// `state`. `None` if the prediction is not certain.
    pub fn predict_crossing(
        &mut self,
        guards: &[Guard],
        horizon: Span,
        state: &mut AxisState,
    ) -> Option<Option<Crossing>> {
        if self.forced.is_some() {
            return None;
        }
        let mut guess = self.guess.take()?;
        let fastest = guess.fastest;
        let trip = match &mut guess.modes {
            PredictorModes::Undamped(modes) => self.polish(fastest, modes, guards, horizon, state),
            PredictorModes::Damped(modes) => self.polish(fastest, modes, guards, horizon, state),
        };
        self.guess = Some(guess);
        trip
    }

    #[expect(clippy::option_option, reason = "not certain, or certain that there is none")]
    fn polish<D: DampingRule<f64>>(
        &self,
        fastest: f64,
        modes: &mut [PredictedMode<f64, D>],
        guards: &[Guard],
        horizon: Span,
        state: &mut AxisState,
    ) -> Option<Option<Crossing>> {
        for (mode, swing) in modes.iter_mut().zip(&self.modes) {
            mode.equilibrium = swing.equilibrium;
            (mode.displacement, mode.quadrature) = (swing.from.displacement, swing.from.quadrature);
        }
        let from = SegmentStart {
            angle: self.angle,
            rate: self.rate,
            moment: self.moment,
            fastest,
            longest: FARTHEST_TURN / fastest,
        };
        let level = |guard: &Guard| PredictedLevel { angle: guard.level, towards: guard.side.sign() };
        let found: PredictedCrossing<f64> = match guards {
            [one] => predicted_crossing::predict(&from, &[level(one)], modes),
            [one, other] => predicted_crossing::predict(&from, &[level(one), level(other)], modes),
            _ => return None,
        };
        if !found.certain {
            return None;
        }
        let after = Span::from_femtoseconds(found.ticks as i64);
        if after > horizon {
            return Some(None);
        }
        let h = found.after;
        state.rigid_angle = self.angle + h * (self.rate + 0.5 * self.moment * h);
        state.rigid_rate = self.rate + self.moment * h;
        for (mode, phase) in modes.iter().zip(&mut state.modes) {
            phase.displacement = mode.equilibrium + mode.displacement;
            phase.quadrature = mode.quadrature;
        }
        let [angle, rate, acceleration] = found.observation;
        let guard = usize::from(!found.first);
        Some(Some(Crossing { after, guard, observation: AngleObservation { angle, rate, acceleration } }))
    }
}
