//! The relay law with dead zone, hysteresis and a timed brake (\[Silaev\], equation (2), corrected): settings, and the law in
//! a run, whose states and torques are those of [`flexsc_flight::relay`].
//!
//! As printed, equation (2) cannot be executed: the brake's condition has the wrong sign, and its OR and AND clauses are a state
//! machine's memory.

use flexsc_flight::relay::{RelayCommand, RelayEvent, RelayLaw, RelayState};
use flexsc_formats::document::ConfigError;
use flexsc_numerics::quantity::{Fraction, NonNegative, Positive};
use flexsc_numerics::time::Instant;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::{
    Authority, Command, ControlOutput, DecisionCause, ErrorBand, EstimateNeeds, Guards, Law, LawSpec,
    LawState, Phase, Setpoint, TorqueConditions, Tunable,
};
use crate::offers::{LawOffers, LawPlace, Offers};
use crate::part::Part;
use crate::requirement::Requirements;
use crate::state_estimate::StateEstimate;

/// Steps of the crossing search per radian of the fastest mode, for the estimate of computing time. Runs in batches need half
/// as many, single runs with damped modes twice as many.
const SEARCH_STEPS: f64 = 0.1;
/// Steps of the crossing search per radian of the fastest mode with a one-sided law, for the estimate of computing time: long
/// motions outside the dead zone are searched.
const ONE_SIDED_STEPS: f64 = 0.7;

/// The relay law.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Relay {
    /// Half width of the dead zone, eps (rad).
    pub dead_zone: Positive,
    /// Hysteresis, gamma (rad): how far back inside a boundary the brake begins.
    pub hysteresis: Positive,
    /// Strong torque `m_u` (N m; rad/s² on a body without inertia).
    pub strong: Positive,
    /// Weak torque `m_eps` in the dead zone (N m; rad/s² on a body without inertia).
    pub weak: NonNegative,
    /// Braking gain, between 0 and 1: duration of the brake per second of the push.
    pub k_t: Fraction,
    /// Which boundaries of the dead zone push back.
    #[serde(default)]
    pub sides: RelaySides,
}

/// Which boundaries of the dead zone push back.
#[derive(Copy, Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
#[schemars(rename = "Sides")]
pub enum RelaySides {
    /// Both (equation (2)).
    #[default]
    Two,
    /// The right one only (the paper's first, unnumbered law).
    One,
}

impl Relay {
    /// Returns the number of steps per radian of the fastest mode in which crossings are searched.
    pub fn search_steps(&self, is_coupled: bool) -> f64 {
        if self.sides == RelaySides::One && !is_coupled { ONE_SIDED_STEPS } else { SEARCH_STEPS }
    }

    /// Returns an estimate of the mean time between switchings in the limit cycle of a rigid body (s).
    ///
    /// The push over the hysteresis gives back the speed that the brake takes. Then the body crosses the dead zone, or
    /// the weak torque returns it to the boundary that it left.
    pub fn switching_interval(&self, inertia: f64) -> f64 {
        let (push, weak) = (self.strong.get() / inertia, self.weak.get() / inertia);
        let (zone, back, k_t) = (self.dead_zone.get(), self.hysteresis.get(), self.k_t.get());
        // The overshoot of `expected_band`. Without a brake it grows: switchings are most frequent at half the dead zone.
        let overshoot = (back * (1.0 - k_t) * (1.0 - k_t) / (4.0 * k_t)).min(0.5 * zone);
        let speed = f64::sqrt(2.0 * push * overshoot);
        let pushed = (speed + f64::sqrt(2.0 * push * (overshoot + back))) / push;
        let discriminant = speed * speed - 4.0 * weak * zone;
        let coasted = if self.sides == RelaySides::Two && discriminant > 0.0 {
            4.0 * zone / (speed + f64::sqrt(discriminant))
        } else if weak > 0.0 {
            2.0 * speed / weak
        } else {
            f64::INFINITY
        };
        ((1.0 + k_t) * pushed + coasted) / 3.0
    }
}

impl LawSpec for Relay {
    fn start(&self, _: &Authority) -> Box<dyn Law> {
        Box::new(RelayRun { law: self.flight_law() })
    }

    fn offers(&self) -> LawOffers {
        let offers = LawOffers::new(None, EstimateNeeds::Motion);
        LawOffers { is_switching: true, finds_crossings: true, has_states: true, ..offers }
    }

    fn validate(&self) -> Option<ConfigError> {
        let (width, gamma) = (2.0 * self.dead_zone.get(), self.hysteresis.get());
        let why = || format!("must be less than the dead zone's width of {width}, got {gamma}");
        (gamma >= width).then(|| ConfigError::new("hysteresis", why()))
    }

    fn requires(&self, _: &LawPlace, offers: &Offers, needs: &mut Requirements) {
        let (body, is_continuous) = (&offers.body, offers.sample_period.is_none());
        needs.require(
            body.axes == 1 || body.has_small_angles || !offers.sensors.is_continuous,
            "",
            "finds its crossings in closed form, which three axes have only as `small_angles` of the body: give it those, or a \
             `[sensor.sampled]`",
        );
        needs.require(
            !body.has_manoeuvre,
            "",
            "holds the angle at 0: with a `[manoeuvre]` use the law `pd`, or none",
        );
        needs.require_elsewhere(
            !(body.is_chain && is_continuous),
            "body.panels.kinematics",
            "must be \"linear\" for a law `relay`, whose crossings are found in closed form; or use a `[sensor.sampled]`",
        );
        needs.require(
            !(body.drifts && is_continuous),
            "",
            "finds its crossings in closed form: with a drift it needs a `[sensor.sampled]`",
        );
    }

    /// Returns the dead zone plus the hysteresis, as a margin for the overshoot. In the cycle of a rigid body under a
    /// small weak torque the overshoot is (1 - k_t)²/(4 k_t) times the hysteresis: less than once for k_t from 0.172
    /// on.
    fn expected_band(&self) -> ErrorBand {
        ErrorBand::Absolute(self.dead_zone.get() + self.hysteresis.get())
    }

    fn expected_torque(&self, conditions: &TorqueConditions) -> f64 {
        conditions.torque_per_command * self.strong.get()
    }

    fn tunable(&self) -> Vec<Tunable> {
        let (zone, hysteresis) = (self.dead_zone.get(), self.hysteresis.get());
        vec![
            Tunable::fraction("k_t", self.k_t),
            Tunable::positive("dead_zone", self.dead_zone).with_lower(0.5 * hysteresis),
            Tunable::positive("hysteresis", self.hysteresis).with_upper(2.0 * zone),
            Tunable::positive("strong", self.strong),
            Tunable::not_negative("weak", self.weak),
        ]
    }
}

impl Relay {
    /// Returns the law at the start, as flight code has it.
    pub fn flight_law(&self) -> RelayLaw {
        RelayLaw {
            dead_zone: self.dead_zone.get(),
            hysteresis: self.hysteresis.get(),
            strong: self.strong.get(),
            weak: self.weak.get(),
            braking_gain: self.k_t.get(),
            is_two_sided: self.sides == RelaySides::Two,
            state: RelayState::Start,
            pushed_at: Instant::START.ticks(),
        }
    }
}

/// Relay law in a run.
#[derive(Clone, Debug)]
pub struct RelayRun {
    law: RelayLaw,
}

impl Part for RelayRun {}

impl Law for RelayRun {
    fn decide(
        &mut self,
        now: Instant,
        cause: DecisionCause,
        _: &Setpoint,
        state_estimate: &StateEstimate,
    ) -> ControlOutput {
        let event = match cause {
            DecisionCause::Start => RelayEvent::Start,
            DecisionCause::Guard(0) => RelayEvent::FirstGuard,
            DecisionCause::Guard(_) => RelayEvent::SecondGuard,
            DecisionCause::Timeout => RelayEvent::Timeout,
        };
        output(&self.law.decide(now.ticks(), event, state_estimate.angle))
    }

    fn state(&self) -> LawState<'_> {
        // Limit cycles are judged by k_t, whatever parameter is tuned.
        LawState::with_tuned(phase(self.law.state), self.law.braking_gain)
    }

    fn copy(&self) -> Box<dyn Law> {
        Box::new(self.clone())
    }

    fn as_relay(&mut self) -> Option<&mut RelayRun> {
        Some(self)
    }

    fn tune(&mut self, key: &str, value: f64) {
        match key {
            "k_t" => self.law.braking_gain = value,
            "dead_zone" => self.law.dead_zone = value,
            "hysteresis" => self.law.hysteresis = value,
            "strong" => self.law.strong = value,
            "weak" => self.law.weak = value,
            _ => {}
        }
    }
}

impl RelayRun {
    /// Starts a state at `now`, after a push that started at `pushed`, and returns its output.
    pub fn set_state(&mut self, phase: Phase, now: Instant, pushed: Instant) -> ControlOutput {
        self.law.state = match phase {
            Phase::PushFromRight => RelayState::PushFromRight,
            Phase::BrakeFromRight => RelayState::BrakeFromRight,
            Phase::WeakRight => RelayState::WeakRight,
            Phase::PushFromLeft => RelayState::PushFromLeft,
            Phase::BrakeFromLeft => RelayState::BrakeFromLeft,
            Phase::WeakLeft => RelayState::WeakLeft,
            _ => RelayState::Start,
        };
        self.law.pushed_at = pushed.ticks();
        output(&self.law.command(now.ticks()))
    }
}

/// Returns the state of a relay as logs name it.
fn phase(state: RelayState) -> Phase {
    match state {
        RelayState::Start => Phase::Start,
        RelayState::PushFromRight => Phase::PushFromRight,
        RelayState::BrakeFromRight => Phase::BrakeFromRight,
        RelayState::WeakRight => Phase::WeakRight,
        RelayState::PushFromLeft => Phase::PushFromLeft,
        RelayState::BrakeFromLeft => Phase::BrakeFromLeft,
        RelayState::WeakLeft => Phase::WeakLeft,
    }
}

/// Returns a command of the relay as the output of a law.
fn output(command: &RelayCommand) -> ControlOutput {
    let [first, second] = command.guards;
    let guards = match command.guard_count {
        0 => Guards::NONE,
        1 => Guards::one(first),
        _ => Guards::two(first, second),
    };
    let until = command.has_timeout.then_some(Instant::from_ticks(command.until));
    ControlOutput { command: Command::Torque(command.torque), until, guards }
}
