//! The sampled attitude law: the acceleration about an axis that gives its error a bandwidth and a damping ratio.
//!
//! With e the angle and w the rate relative to the reference, it commands -(wn² (e + z/t) + 2 zeta wn w), with z the
//! integral of e, applies its filters, and adds the reference's acceleration. The accelerations about three axes are
//! converted to one torque by the full inertia (\[Wie08\], quaternion feedback).

use flexsc_flight::attitude_law::AttitudeFeedback;
use flexsc_flight::biquad::BiquadFilter;
use flexsc_flight_precision::Precision;
use flexsc_formats::document::ConfigError;
use flexsc_numerics::attitude::{asymmetry, tensor};
use flexsc_numerics::quantity::{Finite, Positive};
use flexsc_numerics::time::{Instant, Span};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::filter::Filter;
use super::{
    AttitudeErrorMeasure, Authority, Command, ControlOutput, DecisionCause, ErrorBand, EstimateNeeds, Guards,
    Law, LawSpec, LawState, Phase, ReferenceNeeds, Setpoint, TorqueConditions, Tunable,
};
use crate::offers::{LawOffers, LawPlace, Offers};
use crate::part::Part;
use crate::requirement::Requirements;
use crate::state_estimate::StateEstimate;

/// The attitude law.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct AttitudeLaw {
    /// Period of its samples (s).
    pub period: Span,
    /// Bandwidth wn (rad/s): the natural frequency of the error of a rigid body.
    pub bandwidth: Positive,
    /// Damping ratio zeta of the error.
    #[serde(default = "damping")]
    pub damping: Positive,
    /// Inertia tensor in the law's model of a body with three axes (kg m²), row by row; default: the body's own in
    /// each run, so write it out to study its errors.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub inertia: Option<[[Finite; 3]; 3]>,
    /// How a rotation is converted into an error, on a body with three axes; default: `quaternion`.
    #[serde(default, skip_serializing_if = "AttitudeErrorMeasure::is_default")]
    pub error: AttitudeErrorMeasure,
    /// Integral of the error; none by default.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub integral: Option<Integral>,
    /// Largest rate at which an error is corrected (rad/s); no limit by default.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub rate_limit: Option<Positive>,
    /// Filters of the fed-back acceleration, applied in this order.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub filters: Vec<Filter>,
}

/// The integral of the error.
#[derive(Copy, Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Integral {
    /// Time constant t of the integral (s).
    pub time: Positive,
    /// Largest integral (rad s). The integral also stops while the torque or the rate is at its limit and the error would
    /// increase it.
    pub limit: Positive,
}

fn damping() -> Positive {
    Positive::new(0.7).unwrap_or(Positive::ONE)
}

impl LawSpec for AttitudeLaw {
    fn start(&self, authority: &Authority) -> Box<dyn Law> {
        Box::new(AttitudeLawState {
            law: self.flight_law(authority),
            filters: self.flight_filters(),
            precision: authority.precision,
            tuned: f64::NAN,
            spec: self.clone(),
        })
    }

    fn offers(&self) -> LawOffers {
        let offers = LawOffers::new(Some(self.period), EstimateNeeds::Motion);
        LawOffers { has_single_precision: true, ..offers }
    }

    /// Returns the usual 5 % of a step.
    fn expected_band(&self) -> ErrorBand {
        ErrorBand::Fraction(0.05)
    }

    /// Returns the torque on a body at rest; along a profile, whose angle error is small, the torque of its acceleration.
    fn expected_torque(&self, conditions: &TorqueConditions) -> f64 {
        let (inertia, wn) = (conditions.inertia, self.bandwidth.get());
        let at_rest = inertia * wn * wn * conditions.angle.abs();
        conditions.profile_acceleration.map_or(at_rest, |acceleration| inertia * acceleration)
    }

    fn validate(&self) -> Option<ConfigError> {
        if let Some(inertia) = &self.inertia {
            let inertia = tensor(inertia);
            if let Some(why) = asymmetry(&inertia) {
                return Some(ConfigError::new("inertia", why));
            }
            if inertia.cholesky().is_none() {
                return Some(ConfigError::new("inertia", "must be positive definite"));
            }
        }
        let wrong = |(index, filter): (usize, &Filter)| {
            let fault = filter.sampled(self.period.seconds()).err()?;
            Some(fault.within(&format!("filters[{index}]")))
        };
        self.filters.iter().enumerate().find_map(wrong)
    }

    fn requires(&self, place: &LawPlace, offers: &Offers, needs: &mut Requirements) {
        needs.require(
            self.inertia.is_none() || offers.body.axes == 3 && !place.is_per_axis,
            "inertia",
            "is the tensor for one law about three axes: it needs a `[law.attitude]` for all of them",
        );
        super::requirements::require_measure(self.error, offers, needs);
    }

    fn tunable(&self) -> Vec<Tunable> {
        let mut numbers =
            vec![Tunable::positive("bandwidth", self.bandwidth), Tunable::positive("damping", self.damping)];
        numbers.extend(self.integral.map(|integral| Tunable::positive("integral.time", integral.time)));
        numbers.extend(self.rate_limit.map(|limit| Tunable::positive("rate_limit", limit)));
        let period = self.period.seconds();
        let filters = self.filters.iter().enumerate();
        numbers.extend(filters.filter_map(|(index, filter)| {
            let number = filter.tunable(period)?;
            Some(number.nested(&format!("filters[{index}].")))
        }));
        numbers
    }
}

impl AttitudeLaw {
    /// Returns the law about an axis at the start, as flight code has it.
    pub fn flight_law(&self, authority: &Authority) -> AttitudeFeedback {
        let [acceleration_plus, acceleration_minus] = authority.accelerations;
        AttitudeFeedback {
            bandwidth: self.bandwidth.get(),
            damping: self.damping.get(),
            measure: self.error.flight(),
            period: self.period.seconds(),
            has_rate_limit: self.rate_limit.is_some(),
            rate_limit: self.rate_limit.map_or(f64::INFINITY, Positive::get),
            has_integral: self.integral.is_some(),
            integral_time: self.integral.map_or(1.0, |integral| integral.time.get()),
            integral_limit: self.integral.map_or(0.0, |integral| integral.limit.get()),
            acceleration_plus,
            acceleration_minus,
            integral: 0.0,
        }
    }

    /// Returns the filters at the start, as flight code has them.
    pub fn flight_filters(&self) -> Vec<BiquadFilter> {
        let period = self.period.seconds();
        let filters = self.filters.iter().filter_map(|filter| filter.sampled(period).ok());
        filters.map(|filter| filter.flight()).collect()
    }
}

/// Run-time state of the law about an axis.
#[derive(Clone, Debug)]
struct AttitudeLawState {
    law: AttitudeFeedback,
    filters: Vec<BiquadFilter>,
    precision: Precision,
    /// Value of the parameter tuned last.
    tuned: f64,
    spec: AttitudeLaw,
}

impl AttitudeLawState {
    /// Changes the frequency of a filter and keeps its state.
    fn retune(&mut self, key: &str, value: f64) {
        let period = self.spec.period.seconds();
        for (index, (filter, state)) in self.spec.filters.iter().zip(&mut self.filters).enumerate() {
            let numbers = filter.tunable(period).map(|number| number.nested(&format!("filters[{index}].")));
            if numbers.is_some_and(|number| number.key == key)
                && let Some(Ok(tuned)) = filter.at(value).map(|filter| filter.sampled(period))
            {
                *state = BiquadFilter { state: state.state, ..tuned.flight() };
            }
        }
    }
}

impl Part for AttitudeLawState {}

impl Law for AttitudeLawState {
    fn decide(
        &mut self,
        now: Instant,
        _: DecisionCause,
        goal: &Setpoint,
        state_estimate: &StateEstimate,
    ) -> ControlOutput {
        let (motion, reference) = (state_estimate.flight_motion(), goal.flight_reference(now));
        let acceleration = self.precision.feedback(&mut self.law, &motion, &reference, &mut self.filters);
        ControlOutput {
            command: Command::Acceleration(acceleration),
            until: Some(now + self.spec.period),
            guards: Guards::NONE,
        }
    }

    fn state(&self) -> LawState<'_> {
        LawState::with_tuned(Phase::Feedback, self.tuned)
    }

    fn reference_needs(&self) -> ReferenceNeeds {
        // The reference has an acceleration to follow.
        ReferenceNeeds { tracks_manoeuvre: true, ..ReferenceNeeds::default() }
    }

    fn copy(&self) -> Box<dyn Law> {
        Box::new(self.clone())
    }

    fn tune(&mut self, key: &str, value: f64) {
        match key {
            "bandwidth" => self.law.bandwidth = value,
            "damping" => self.law.damping = value,
            "integral.time" => self.law.integral_time = value,
            "rate_limit" => {
                self.law.has_rate_limit = true;
                self.law.rate_limit = value;
            }
            _ => self.retune(key, value),
        }
        self.tuned = value;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::actuator::PulseWidth;

    const PERIOD: f64 = 0.25;

    fn start(keys: &str, most: f64) -> Box<dyn Law> {
        let text = format!("period = {PERIOD}\nbandwidth = 0.1\ndamping = 0.8\n{keys}");
        let law: AttitudeLaw = flexsc_formats::document::from_text(&text).unwrap();
        assert_eq!(law.validate(), None);
        let width = PulseWidth::default();
        let precision = Precision::Double;
        law.start(&Authority {
            axis: 0,
            accelerations: [most; 2],
            width,
            delay: 0.0,
            threshold: 0.0,
            precision,
        })
    }

    fn command(law: &mut dyn Law, angle: f64, rate: f64, acceleration: f64) -> f64 {
        let goal = Setpoint { acceleration, ..Setpoint::default() };
        let estimate = StateEstimate { angle, rate, ..StateEstimate::default() };
        match law.decide(Instant::START, DecisionCause::Timeout, &goal, &estimate).command {
            Command::Acceleration(acceleration) => acceleration,
            other => panic!("{other:?}"),
        }
    }

    #[test]
    fn the_error_of_a_rigid_body_has_the_bandwidth_and_damping_that_are_asked_for() {
        // Feedback held over a period, on e'' = u: the sampled poles are near exp((-zeta +- i sqrt(1 - zeta²)) wn T).
        let mut law = start("", f64::INFINITY);
        let (mut angle, mut rate) = (1e-3, 0.0);
        let mut peak = 0.0_f64;
        for _ in 0..400 {
            let u = command(&mut *law, angle, rate, 0.0);
            angle += rate * PERIOD + 0.5 * u * PERIOD * PERIOD;
            rate += u * PERIOD;
            peak = peak.min(angle);
        }
        // The overshoot is exp(-pi zeta/sqrt(1 - zeta²)) of the step, 1.52 %; the sampling adds a little.
        assert!((peak / -1e-3 - 0.0152).abs() < 2e-3, "{peak}");
        assert!(angle.abs() < 1e-6 && rate.abs() < 1e-7);
    }

    #[test]
    fn what_the_reference_accelerates_passes_the_filters_by() {
        let mut law = start("filters = [{ notch = { frequency = 1.1475, depth = 0.05 } }]", f64::INFINITY);
        assert_eq!(command(&mut *law, 0.0, 0.0, 2e-4), 2e-4);
        let biquad = flexsc_formats::document::from_text::<AttitudeLaw>(
            "period = 0.25\nbandwidth = 0.1\nfilters = [{ low_pass = { frequency = 20.0 } }]",
        );
        let fault = biquad.unwrap().validate().unwrap();
        assert_eq!(fault.key, "filters[0].low_pass.frequency");
    }

    #[test]
    fn an_error_is_taken_back_at_the_rate_limit() {
        let mut law = start("rate_limit = 0.002", f64::INFINITY);
        // At this rate nothing is left to do, whatever the angle.
        assert!(command(&mut *law, 1.0, -0.002, 0.0).abs() < 1e-18);
        let mut free = start("", f64::INFINITY);
        let [limited, free] = [&mut law, &mut free].map(|law| command(&mut **law, 1e-3, 1e-4, 0.0));
        assert!((limited / free - 1.0).abs() < 1e-14, "{limited} {free}");
    }

    #[test]
    fn the_integral_takes_a_constant_torque_away_and_does_not_wind_up() {
        let keys = "integral = { time = 30.0, limit = 0.5 }";
        let mut law = start(keys, f64::INFINITY);
        let (mut angle, mut rate) = (0.0, 0.0);
        for _ in 0..4000 {
            let u = command(&mut *law, angle, rate, 0.0) + 1e-5;
            angle += rate * PERIOD + 0.5 * u * PERIOD * PERIOD;
            rate += u * PERIOD;
        }
        // Without the integral the angle would be 1e-5/wn² = 1e-3.
        assert!(angle.abs() < 1e-9, "{angle}");
        // At the actuator's limit the integral stops; otherwise it grows to its own limit.
        for (most, integral) in [(1e-4, PERIOD), (f64::INFINITY, 0.5)] {
            let mut law = start(keys, most);
            for _ in 0..10 {
                command(&mut *law, 1.0, 0.0, 0.0);
            }
            let found = command(&mut *law, 0.0, 0.0, 0.0);
            assert!((found + 0.01 * integral / 30.0).abs() < 1e-18, "{found}");
        }
    }
}
