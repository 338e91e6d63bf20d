//! A flywheel on a motor with back-EMF; commands have a delay, a dead zone, a quantum and a limit.

use std::collections::VecDeque;

use flexsc_numerics::quantity::{Finite, NonNegative, Positive, Time};
use flexsc_numerics::time::{Instant, Span};
use flexsc_record::{Report, WheelMotion};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::{
    Actuator, ActuatorAuthority, ActuatorPlacement, ActuatorSpec, AxisActuator, AxisActuatorContext,
    AxisActuators, AxisProperties, AxisResponse, AxisTorques, Failure, LinearDrive,
};
use crate::offers::{ActuatorOffers, ActuatorPlace, Offers, TorqueLimit};
use crate::part::{Occasion, Part, ReportContext};
use crate::requirement::Requirements;

/// A flywheel on a motor with back-EMF: the body's torque is gain u - `back_emf` times a rate of the body.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Wheel {
    /// Torque per unit of the law's command (N m; k'_u of \[Wheel11, Sukhanov\] times the body's inertia).
    pub gain: Positive,
    /// Back-EMF torque per unit of the rate (N m s; k'_omega times the body's inertia).
    #[serde(default)]
    pub back_emf: NonNegative,
    /// The rate that the back-EMF opposes.
    #[serde(default)]
    pub opposes: BackEmfRate,
    /// The wheel, whose speed and momentum `/wheel` then logs; it must be the only actuator.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub rotor: Option<FlywheelRotor>,
    /// Commands smaller than this are not executed.
    #[serde(default)]
    pub dead_zone: NonNegative,
    /// Quantum of the command; 0 for none.
    #[serde(default)]
    pub quantum: NonNegative,
    /// Largest command, in units of the command; no limit by default.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub limit: Option<Positive>,
    /// Time from a sample to the execution of the command computed from it (s).
    #[serde(default)]
    pub delay: Time,
    /// Intervals in which the motor fails to execute commands; its back-EMF still acts.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub faults: Vec<Failure>,
}

/// The rate that the back-EMF opposes.
#[derive(Copy, Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
#[schemars(rename = "Opposes")]
pub enum BackEmfRate {
    /// The measured rate, elastic part included, as in the papers; it overstates the damping of the modes.
    #[default]
    BodyRate,
    /// The rigid rate; the momentum of the wheel then agrees exactly with the torque on the body, which damps the
    /// modes far less.
    RigidRate,
}

/// A wheel that stores momentum.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(rename = "Rotor")]
pub struct FlywheelRotor {
    /// Moment of inertia (kg m²).
    pub inertia: Positive,
    /// Speed at the start (rad/s).
    #[serde(default)]
    pub speed: Finite,
    /// Largest speed (rad/s), beyond which the motor cannot accelerate it, and with which a `[law.relay]` needs a
    /// sampled sensor; no limit by default.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub speed_limit: Option<Positive>,
}

impl Wheel {
    /// Returns the executed value of a command: limited, quantised, and 0 within the dead zone.
    pub fn execute_command(&self, command: f64) -> f64 {
        let limit = self.limit.map_or(f64::INFINITY, Positive::get);
        let (dead_zone, quantum) = (self.dead_zone.get(), self.quantum.get());
        let command = command.clamp(-limit, limit);
        if command.abs() < dead_zone {
            0.0
        } else if quantum > 0.0 {
            libm::round(command / quantum) * quantum
        } else {
            command
        }
    }
}

/// Run-time state of the wheel.
#[derive(Clone, Debug)]
pub struct FlywheelState {
    wheel: Wheel,
    setting: AxisActuatorContext,
    /// Command of the law, and motor torque without back-EMF (N m).
    feedback: f64,
    held: f64,
    /// Commands not yet executed, with the times of their execution.
    delayed: VecDeque<(Instant, f64)>,
    /// Time of the next feedforward update, unless the law commands earlier.
    next: Option<Instant>,
}

impl ActuatorSpec for Wheel {
    fn start(&self, settings: &[AxisActuatorContext], _: &ActuatorPlacement<'_>) -> Box<dyn Actuator> {
        AxisActuators::start(settings, &self.faults, |setting| FlywheelState {
            wheel: self.clone(),
            setting: setting.clone(),
            feedback: 0.0,
            held: 0.0,
            delayed: VecDeque::new(),
            next: None,
        })
    }

    fn authority(&self, _: usize, inertia: f64, _: &ActuatorPlacement<'_>) -> ActuatorAuthority {
        let most = self.limit.map_or(f64::INFINITY, Positive::get) * self.gain.get() / inertia;
        ActuatorAuthority { delay: self.delay.get(), ..ActuatorAuthority::constant(most) }
    }

    fn offers(&self) -> ActuatorOffers {
        let limit = self.limit.map_or(TorqueLimit::Unlimited, |_| TorqueLimit::Constant);
        ActuatorOffers {
            limits: [limit; 3],
            is_delayed: self.delay.get() > 0.0,
            has_wheel_speeds: self.rotor.is_some(),
            ..ActuatorOffers::default()
        }
    }

    fn requires(&self, place: &ActuatorPlace<'_>, offers: &Offers, needs: &mut Requirements) {
        let is_passive = self.back_emf.get() <= 0.0;
        needs.require(
            is_passive || offers.body.axes == 1,
            "back_emf",
            "couples the modes of one angle: leave it out for a body with three axes",
        );
        needs.require(
            self.rotor.is_none() || place.members <= 1,
            "rotor",
            "gets its speed from the rate of the body, which other actuators change too: leave it out, or use \
             `[actuator.wheels]` on a body with three axes",
        );
        if place.meets_twin {
            place.require_single(needs, "an axis has one flywheel: give it the gain of both");
        }
        let is_limited = self.rotor.as_ref().is_some_and(|rotor| rotor.speed_limit.is_some());
        let crosses =
            offers.sample_period.is_none() && offers.laws.iter().any(|law| law.offers.finds_crossings);
        needs.require(
            !(is_limited && crosses),
            "rotor.speed_limit",
            "is checked at the law's commands: with a law `relay` it needs a `[sensor.sampled]`",
        );
        needs.require(
            is_passive || offers.estimator.is_none_or(|of| !of.is_envelope),
            "back_emf",
            "must be 0 with an `[estimator.envelope]`, which follows each mode on its own",
        );
    }

    fn failures(&self) -> &[Failure] {
        &self.faults
    }

    fn expected_torque(&self, planned: f64, command: f64) -> f64 {
        planned.max(self.gain.get() * self.execute_command(command))
    }

    fn command_gain(&self) -> Option<f64> {
        Some(self.gain.get())
    }

    fn linear_drive(&self) -> Option<LinearDrive<'_>> {
        Some(LinearDrive {
            gain: self.gain.get(),
            back_emf: self.back_emf.get(),
            opposes_body_rate: self.opposes == BackEmfRate::BodyRate,
            delay: self.delay.get(),
            wheel: Some(self),
        })
    }
}

impl FlywheelState {
    /// Queues the sum of the law's command and the feedforward of the manoeuvre.
    fn drive(&mut self, now: Instant) {
        let delay = Span::from_seconds(self.wheel.delay.get());
        let whole = self.feedback + self.feedforward(now);
        self.delayed.push_back((now + delay, self.wheel.execute_command(whole)));
    }

    /// Returns the feedforward command for the wheel's share of the waveform over the law's next period, or until the
    /// waveform ends: its mean torque, and the back-EMF at the mean rate.
    fn feedforward(&mut self, now: Instant) -> f64 {
        let (Some(waveform), Some(cycle)) = (&self.setting.waveform, self.setting.cycle) else { return 0.0 };
        let end = Instant::START + Span::from_seconds(waveform.end());
        let next = if now < end { end.min(now + cycle) } else { now + cycle };
        self.next = Some(next);
        let (from, to, inertia) = (now.seconds(), next.seconds(), self.setting.planned_inertia);
        let span = next.since(now).seconds();
        let rate =
            self.setting.rate + (waveform.impulse(0.0, from) + waveform.travel(from, to) / span) / inertia;
        (self.setting.share * waveform.impulse(from, to) / span + self.wheel.back_emf.get() * rate)
            / self.wheel.gain.get()
    }

    /// Executes the commands whose delay has elapsed.
    fn turn(&mut self, now: Instant, rigid_rate: f64) {
        while let Some((_, command)) = self.delayed.front().copied().filter(|(due, _)| *due <= now) {
            self.delayed.pop_front();
            let torque = self.wheel.gain.get() * command;
            // A torque that accelerates the body decelerates the wheel.
            let is_at_speed_limit = self
                .speed(rigid_rate)
                .is_some_and(|(speed, limit)| speed.abs() >= limit && speed * torque < 0.0);
            self.held = if is_at_speed_limit { 0.0 } else { torque };
        }
    }

    /// Returns speed and speed limit (rad/s) of a wheel that stores momentum.
    fn speed(&self, rigid_rate: f64) -> Option<(f64, f64)> {
        let rotor = self.wheel.rotor.as_ref()?;
        let gained = self.setting.inertia * (rigid_rate - self.setting.rate) / rotor.inertia.get();
        let limit = rotor.speed_limit.map_or(f64::INFINITY, Positive::get);
        Some((rotor.speed.get() - gained, limit))
    }

    /// Returns the rotor of a body with this rigid rate (rad/s), if it stores momentum.
    fn rotor(&self, rigid_rate: f64) -> Option<WheelMotion> {
        let (speed, _) = self.speed(rigid_rate)?;
        let inertia = self.wheel.rotor.as_ref().map_or(0.0, |rotor| rotor.inertia.get());
        Some(WheelMotion { speed_rad_s: speed, momentum_nm_s: inertia * speed })
    }
}

impl Part for FlywheelState {
    fn due(&self) -> Option<Instant> {
        let delayed = self.delayed.front().map(|(at, _)| *at);
        [delayed, self.next].into_iter().flatten().min()
    }

    fn report(&self, at: &ReportContext<'_>, report: &mut Report) {
        if at.occasion == Occasion::Period && at.axes == 1 {
            let [_, rigid_rates] = at.truth.rates();
            self.rotor(rigid_rates[0]).into_iter().for_each(|row| report.add(row));
        }
    }
}

impl AxisActuator for FlywheelState {
    fn command(&mut self, now: Instant, command: f64, rigid_rate: f64) {
        self.feedback = command;
        self.drive(now);
        self.turn(now, rigid_rate);
    }

    /// Updates the feedforward when due, also under a law that gives no command during the manoeuvre, and executes
    /// delayed commands.
    fn serve(&mut self, now: Instant, rigid_rate: f64) {
        if self.next == Some(now) {
            self.drive(now);
        }
        self.turn(now, rigid_rate);
    }

    fn torques(&self) -> AxisTorques {
        let (demanded, held) = (self.wheel.gain.get() * self.feedback, self.held);
        AxisTorques { demanded, held, nominal: held, firing: 0.0 }
    }

    fn response(&self, _: Instant, [rate, rigid_rate]: [f64; 2]) -> AxisResponse {
        let sensed = if self.wheel.opposes == BackEmfRate::BodyRate { rate } else { rigid_rate };
        let applied = self.held - self.wheel.back_emf.get() * sensed;
        AxisResponse { applied, rotor: self.rotor(rigid_rate) }
    }

    fn properties(&self) -> AxisProperties {
        AxisProperties {
            torque_per_unit: self.wheel.gain.get(),
            back_emf: (self.wheel.back_emf.get(), self.wheel.opposes == BackEmfRate::BodyRate),
            ..AxisProperties::default()
        }
    }

    fn copy(&self) -> Box<dyn AxisActuator> {
        Box::new(self.clone())
    }
}
