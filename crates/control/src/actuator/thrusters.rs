//! A pair of thrusters for each direction: one pulse per period, centred in it, with the impulse of a zero-order hold.

use flexsc_numerics::quantity::{NonNegative, Positive, Time};
use flexsc_numerics::time::{Instant, Span};
use flexsc_spacecraft::axes::PerAxis;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::{
    Actuator, ActuatorAuthority, ActuatorPlacement, ActuatorSpec, AxisActuator, AxisActuatorContext,
    AxisActuators, AxisTorques, Failure, PulseWidth,
};
use crate::offers::{ActuatorOffers, ActuatorPlace, Offers};
use crate::part::Part;
use crate::requirement::{ONE_NUMBER, Requirements};

/// A pair of thrusters for each direction, with pulse-width modulation.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Thrusters {
    /// Torque of a pulse (N m): one number for all axes, or a list of three. Each period has one pulse, centred in
    /// it, with the impulse of a hold; what it cannot give carries over, up to one whole period.
    pub torque: PerAxis<Positive>,
    /// Period of the pulses (s).
    pub period: Span,
    /// Time of the first period (s); default: 0.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub phase: Option<Time>,
    /// Shortest pulse (s).
    #[serde(default)]
    pub minimum_on: NonNegative,
    /// Quantum of a pulse's length (s); 0 for none.
    #[serde(default)]
    pub quantum: NonNegative,
    /// Intervals in which the thrusters fail.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub faults: Vec<Failure>,
}

/// Pulse of constant torque (N m) between two times.
#[derive(Copy, Clone, Debug, PartialEq)]
struct ThrusterPulse {
    torque: f64,
    from: Instant,
    to: Instant,
}

impl Thrusters {
    /// Returns the quantisation of pulse lengths.
    pub fn width(&self) -> PulseWidth {
        PulseWidth { minimum: self.minimum_on, quantum: self.quantum }
    }
}

impl ActuatorSpec for Thrusters {
    fn start(&self, settings: &[AxisActuatorContext], _: &ActuatorPlacement<'_>) -> Box<dyn Actuator> {
        AxisActuators::start(settings, &self.faults, |setting| ThrustersState {
            most: self.torque.about(setting.axis).get(),
            period: self.period,
            width: self.width(),
            setting: setting.clone(),
            next: super::first(self.phase),
            feedback: 0.0,
            held: 0.0,
            pulse: None,
            remainder: 0.0,
        })
    }

    fn authority(&self, axis: usize, inertia: f64, _: &ActuatorPlacement<'_>) -> ActuatorAuthority {
        let most = self.torque.about(axis).get() / inertia;
        ActuatorAuthority { width: self.width(), ..ActuatorAuthority::constant(most) }
    }

    fn offers(&self) -> ActuatorOffers {
        ActuatorOffers { pulses: true, ..ActuatorOffers::default() }
    }

    fn requires(&self, _: &ActuatorPlace<'_>, offers: &Offers, needs: &mut Requirements) {
        let is_one = offers.body.axes == 3 || !self.torque.is_three();
        needs.require_axes(is_one, "torque", ONE_NUMBER);
        let period = self.period.seconds();
        for (key, value) in [("minimum_on", self.minimum_on.get()), ("quantum", self.quantum.get())] {
            needs.require_with(value <= period, key, || {
                format!("must be at most the period of {period} s, got {value}")
            });
        }
    }

    fn period(&self) -> Option<Span> {
        Some(self.period)
    }

    fn phase(&self) -> Option<Time> {
        self.phase
    }

    fn failures(&self) -> &[Failure] {
        &self.faults
    }

    fn expected_torque(&self, _: f64, _: f64) -> f64 {
        self.torque.about(0).get()
    }
}

/// Run-time state of the thrusters.
#[derive(Clone, Debug)]
pub struct ThrustersState {
    most: f64,
    period: Span,
    width: PulseWidth,
    setting: AxisActuatorContext,
    next: Instant,
    feedback: f64,
    held: f64,
    pulse: Option<ThrusterPulse>,
    /// Impulse left over for the next period (N m s).
    remainder: f64,
}

impl ThrustersState {
    fn begin_period(&mut self, now: Instant) {
        self.next = now + self.period;
        let h = self.period.seconds();
        let planned = self.setting.planned_impulse(now, h);
        self.held = 0.0;
        let (pulse, remainder) = self.pulse(now, self.remainder + planned + self.feedback * h);
        self.remainder = remainder;
        self.pulse = (pulse.from < pulse.to).then_some(pulse);
    }

    /// Returns the pulse of the period that begins at `now` for this impulse (N m s), and the remaining impulse (N m
    /// s), at most that of one period, which is added to the next one.
    fn pulse(&self, now: Instant, impulse: f64) -> (ThrusterPulse, f64) {
        let period = self.period.seconds();
        let on = self.width.on_time(impulse.abs() / self.most, period);
        let torque = self.most.copysign(impulse);
        let most = self.most * period;
        let from = now + Span::from_seconds(0.5 * (period - on));
        let pulse = ThrusterPulse { torque, from, to: from + Span::from_seconds(on) };
        (pulse, (impulse - torque * on).clamp(-most, most))
    }
}

impl Part for ThrustersState {
    fn due(&self) -> Option<Instant> {
        let pulse = self.pulse.map(|pulse| if self.held == 0.0 { pulse.from } else { pulse.to });
        Some(pulse.map_or(self.next, |pulse| pulse.min(self.next)))
    }
}

impl AxisActuator for ThrustersState {
    fn command(&mut self, _: Instant, command: f64, _: f64) {
        self.feedback = command;
    }

    fn serve(&mut self, now: Instant, _: f64) {
        if self.next == now {
            self.begin_period(now);
        }
        if let Some(pulse) = self.pulse {
            let on = pulse.from <= now && now < pulse.to;
            self.held = if on { pulse.torque } else { 0.0 };
            self.pulse = self.pulse.filter(|_| now < pulse.to);
        }
    }

    fn torques(&self) -> AxisTorques {
        let held = self.held;
        AxisTorques { demanded: self.feedback, held, nominal: held, firing: held }
    }

    fn copy(&self) -> Box<dyn AxisActuator> {
        Box::new(self.clone())
    }
}
