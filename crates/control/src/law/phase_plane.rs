//! The phase-plane law: settings, target attitudes, and the law in a run, whose arithmetic is that of
//! [`flexsc_flight::phase_plane`].

use std::f64::consts::TAU;

use flexsc_flight::phase_plane::PhasePlaneLaw;
use flexsc_formats::document::ConfigError;
use flexsc_numerics::attitude::from_yaw_pitch_roll;
use flexsc_numerics::quantity::{Finite, Fraction, Positive, Time};
use flexsc_numerics::time::{Instant, Span};
use flexsc_spacecraft::manoeuvre::{AttitudeRow, ManoeuvreCommand as Planned, Shaper, SlewProfile};
use schemars::JsonSchema;
use serde::de::Error as _;
use serde::{Deserialize, Deserializer, Serialize};

use super::active_damping::ActiveDamping;
use super::switching_lines::switching_lines;
use super::{
    Authority, Command, ControlOutput, DecisionCause, DirectionPair, EstimateNeeds, Frame, Guards, Law,
    LawSpec, LawState, Phase, PointedAxis, ReferenceNeeds, Setpoint, TargetFrame, TorqueConditions, Tunable,
};
use crate::offers::{LawOffers, LawPlace, Offers, TorqueLimit};
use crate::part::Part;
use crate::requirement::Requirements;
use crate::state_estimate::{DampingStatus, StateEstimate};

/// The phase-plane law.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct PhasePlane {
    /// Cycle of law and jets, and of gyro and estimator if they have no period of their own (s).
    pub period: Span,
    /// Half width of the dead zone (rad).
    pub dead_zone: Positive,
    /// Largest rate at which the law turns the body (rad/s).
    pub rate_limit: Positive,
    /// Largest return rate per unit of the angle beyond the dead zone (1/s).
    #[serde(default = "slope")]
    pub slope: Positive,
    /// Fraction of the jets' acceleration used for slowing down.
    #[serde(default = "half")]
    pub braking: Fraction,
    /// Rate error above which the jets begin to fire (rad/s); near and beyond the edges of the dead zone they begin at a
    /// smaller one.
    pub switch_on: Positive,
    /// Rate error below which the jets stop (rad/s); it is also the smallest return rate.
    pub switch_off: Positive,
    /// Target attitudes, in the order of their times; before the first one, the target is the inertial axes.
    #[serde(default)]
    pub targets: Vec<AttitudeTarget>,
    /// Active damping of elastic motion while the rigid motion needs no jets; none by default.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub damping: Option<ActiveDamping>,
}

fn slope() -> Positive {
    Positive::new(0.05).unwrap_or(Positive::ONE)
}

fn half() -> Fraction {
    Fraction::HALF
}

/// A target attitude: yaw, then pitch about the rotated y axis, then roll about the twice rotated x axis.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(rename = "Target")]
pub struct AttitudeTarget {
    /// Start time (s), later than that of the target before.
    pub from: Time,
    /// Frame relative to which the attitude is given; default: inertial.
    #[serde(default, skip_serializing_if = "is_inertial")]
    pub frame: Frame,
    /// Axis of the body that is exactly along a direction: with `secondary`, roll, pitch and yaw are relative to the attitude
    /// that these two give.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub primary: Option<PointedAxis>,
    /// Axis of the body that is as near to a direction as `primary` lets it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub secondary: Option<PointedAxis>,
    /// Roll (rad), like pitch and yaw from -2π to 2π: yaw comes first, then pitch about the turned axis, then roll.
    #[serde(default, deserialize_with = "within_a_turn")]
    pub roll: Finite,
    /// Pitch (rad).
    #[serde(default, deserialize_with = "within_a_turn")]
    pub pitch: Finite,
    /// Yaw (rad).
    #[serde(default, deserialize_with = "within_a_turn")]
    pub yaw: Finite,
    /// Largest acceleration of the slew about one axis to it (rad/s²); default: the reference jumps.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub acceleration: Option<Positive>,
    /// Largest rate of the slew (rad/s); no limit by default.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub rate_limit: Option<Positive>,
    /// How the rate of the slew rises and falls; default: trapezoid.
    #[serde(default, skip_serializing_if = "is_trapezoid")]
    pub profile: SlewProfile,
    /// Command planned for the slew, in place of `acceleration`; it may leave modes at rest.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub command: Option<Planned>,
    /// Duration of the slew by that command (s), without what a shaper adds and without the decay of a rate before
    /// it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub duration: Option<Positive>,
    /// Shaper that suppresses modes: the acceleration of the slew is convolved with impulses.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub shaper: Option<Shaper>,
    /// Table of attitudes over time in place of a single one: splines of roll, pitch and yaw, at rest at both ends.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub table: Vec<AttitudeRow>,
}

/// Reads an angle of at most a whole turn: what is more is in degrees.
fn within_a_turn<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Finite, D::Error> {
    let angle = Finite::deserialize(deserializer)?;
    if angle.get().abs() <= TAU {
        return Ok(angle);
    }
    let value = angle.get();
    Err(D::Error::custom(format!(
        "must be an angle of -2 pi to 2 pi, in rad, or such as \"30 deg\", got {value}"
    )))
}

#[expect(clippy::trivially_copy_pass_by_ref, reason = "serde asks for a reference")]
fn is_inertial(frame: &Frame) -> bool {
    *frame == Frame::Inertial
}

#[expect(clippy::trivially_copy_pass_by_ref, reason = "serde asks for a reference")]
fn is_trapezoid(profile: &SlewProfile) -> bool {
    *profile == SlewProfile::Trapezoid
}

impl AttitudeTarget {
    /// Inertial attitude, from the start on.
    pub const INERTIAL: Self = Self {
        from: Time::ZERO,
        frame: Frame::Inertial,
        primary: None,
        secondary: None,
        roll: Finite::ZERO,
        pitch: Finite::ZERO,
        yaw: Finite::ZERO,
        acceleration: None,
        rate_limit: None,
        profile: SlewProfile::Trapezoid,
        command: None,
        duration: None,
        shaper: None,
        table: Vec::new(),
    };

    /// Returns the frame relative to which the attitude is given.
    pub fn target_frame(&self) -> TargetFrame {
        match (self.primary, self.secondary) {
            (Some(primary), Some(secondary)) => TargetFrame::Directions(DirectionPair { primary, secondary }),
            _ => TargetFrame::Named(self.frame),
        }
    }

    /// Returns the attitude of the target in its frame.
    pub fn attitude(&self) -> nalgebra::Quaternion<f64> {
        from_yaw_pitch_roll(self.roll.get(), self.pitch.get(), self.yaw.get())
    }

    /// Returns the start time of the target.
    pub fn starts(&self) -> Instant {
        Instant::START + Span::from_seconds(self.from.get())
    }

    /// Checks the order of targets; returns the index of the first one not later than the one before, and the reason.
    pub fn validate_order(targets: &[Self]) -> Option<(usize, String)> {
        let late = targets.windows(2).position(|pair| pair[0].from >= pair[1].from)? + 1;
        Some((late, format!("must be later than the one before, got {}", targets[late].from.get())))
    }
}

impl PhasePlane {
    /// Adds the requirements on the actuator about an axis, whose largest torque the switching lines depend on.
    fn require_torque(&self, axis: usize, offers: &Offers, needs: &mut Requirements) {
        let Some(actuator) = offers.serving(axis).map(|member| member.offers) else { return };
        if actuator.pulses {
            let is_met = actuator.period.is_none_or(|own| own == self.period);
            return needs.require(is_met, "", "needs thrusters with the law's own period");
        }
        needs.require(
            !actuator.is_delayed,
            "",
            "needs a wheel without delay, whose commands it does not see",
        );
        let limit = actuator.limits[axis];
        needs.require(
            limit != TorqueLimit::Varying,
            "",
            "needs a largest torque that is constant, and that of control moment gyros changes with their gimbal angles",
        );
        needs.require(
            limit != TorqueLimit::Unlimited,
            "",
            "needs the largest torque, on which its switching lines depend: thrusters, jets, a wheel with a \
             `limit`, or wheels with a `torque`",
        );
    }
}

impl LawSpec for PhasePlane {
    fn expected_torque(&self, conditions: &TorqueConditions) -> f64 {
        conditions.jets
    }

    fn start(&self, authority: &Authority) -> Box<dyn Law> {
        let period = self.period.seconds();
        let lead_time = self.damping.as_ref().map_or(0.0, |damping| damping.lead_time(period, authority));
        Box::new(PhasePlaneState {
            law: self.flight_law(authority),
            lead_time,
            spec: self.clone(),
            authority: *authority,
            tuned: f64::NAN,
        })
    }

    fn offers(&self) -> LawOffers {
        let needs = if self.damping.is_some() { EstimateNeeds::ElasticRates } else { EstimateNeeds::Motion };
        LawOffers { plans_pulses: true, has_states: true, ..LawOffers::new(Some(self.period), needs) }
    }

    fn validate(&self) -> Option<ConfigError> {
        let (on, off) = (self.switch_on.get(), self.switch_off.get());
        if off >= on {
            return Some(ConfigError::new(
                "switch_off",
                format!("must be below `switch_on`, {on}, got {off}"),
            ));
        }
        let (late, why) = AttitudeTarget::validate_order(&self.targets)?;
        Some(ConfigError::new(format!("targets[{late}].from"), why))
    }

    fn requires(&self, place: &LawPlace, offers: &Offers, needs: &mut Requirements) {
        let has_targets = !self.targets.is_empty();
        needs.require_axes(
            !has_targets || offers.body.axes == 3,
            "targets",
            "are for a body with three axes: a `[manoeuvre]` turns a body with one angle",
        );
        needs.require(
            !has_targets || !place.is_per_axis,
            "targets",
            "are those of all axes: write them as `[[target]]`",
        );
        self.require_torque(place.axis, offers, needs);
        needs.require(
            self.damping.is_none() || offers.estimator.is_some_and(|of| of.elastic_rates),
            "damping",
            "needs the elastic rates of an `[estimator.adaptive]`, and there is none",
        );
    }

    fn tunable(&self) -> Vec<Tunable> {
        vec![
            Tunable::positive("dead_zone", self.dead_zone),
            Tunable::positive("rate_limit", self.rate_limit),
            Tunable::positive("slope", self.slope),
            Tunable::fraction("braking", self.braking),
            Tunable::positive("switch_on", self.switch_on).with_lower(self.switch_off.get()),
            Tunable::positive("switch_off", self.switch_off).with_upper(self.switch_on.get()),
        ]
    }
}

impl PhasePlane {
    /// Returns the law about an axis at the start, as flight code has it.
    pub fn flight_law(&self, authority: &Authority) -> PhasePlaneLaw {
        let [acceleration_plus, acceleration_minus] = authority.accelerations;
        let period = self.period.seconds();
        PhasePlaneLaw {
            lines: switching_lines(self, authority),
            period,
            acceleration_plus,
            acceleration_minus,
            quantum: authority.width.flight(),
            firing: false,
            has_damping: self.damping.is_some(),
            damping: self.damping.clone().unwrap_or_default().start(period, authority),
            damped: DampingStatus::default(),
        }
    }
}

/// Run-time state of the law about an axis.
#[derive(Clone, Debug)]
struct PhasePlaneState {
    law: PhasePlaneLaw,
    spec: PhasePlane,
    authority: Authority,
    /// Lead time after a sample for which the law reads predicted elastic rates (s).
    lead_time: f64,
    /// Value of the parameter tuned last.
    tuned: f64,
}

impl Part for PhasePlaneState {}

impl Law for PhasePlaneState {
    /// Commands the change of the rate by the pulses of the cycle.
    fn decide(
        &mut self,
        now: Instant,
        _: DecisionCause,
        goal: &Setpoint,
        state_estimate: &StateEstimate,
    ) -> ControlOutput {
        if now < goal.from {
            return ControlOutput { until: Some(goal.from), ..ControlOutput::NONE };
        }
        let (motion, reference) = (state_estimate.flight_motion(), goal.flight_reference(now));
        let (modes, is_trusted) = (&state_estimate.elastic, state_estimate.elastic_is_trusted);
        let change = self.law.step(&motion, &reference, modes, is_trusted);
        ControlOutput {
            command: Command::Change(change),
            until: Some(now + self.spec.period),
            guards: Guards::NONE,
        }
    }

    fn state(&self) -> LawState<'_> {
        let phase = if self.law.firing { Phase::Firing } else { Phase::Coasting };
        let damping = self.law.has_damping.then_some(&self.law.damped);
        LawState { phase, tuned: self.tuned, damping }
    }

    fn reference_needs(&self) -> ReferenceNeeds {
        ReferenceNeeds { lead_time: self.lead_time, ..ReferenceNeeds::default() }
    }

    fn copy(&self) -> Box<dyn Law> {
        Box::new(self.clone())
    }

    fn tune(&mut self, key: &str, value: f64) {
        let (spec, positive) = (&mut self.spec, Positive::new(value));
        let number = match key {
            "dead_zone" => &mut spec.dead_zone,
            "rate_limit" => &mut spec.rate_limit,
            "slope" => &mut spec.slope,
            "switch_on" => &mut spec.switch_on,
            "switch_off" => &mut spec.switch_off,
            "braking" => {
                spec.braking = Fraction::new(value).unwrap_or(spec.braking);
                return self.draw(value);
            }
            _ => return,
        };
        *number = positive.unwrap_or(*number);
        self.draw(value);
    }
}

impl PhasePlaneState {
    /// Recomputes the switching lines after a parameter was tuned.
    fn draw(&mut self, tuned: f64) {
        self.tuned = tuned;
        self.law.lines = switching_lines(&self.spec, &self.authority);
    }
}
