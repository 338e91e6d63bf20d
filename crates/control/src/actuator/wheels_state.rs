//! Run-time state of reaction wheels: motor torques and stored momenta.
//!
//! A wheel's momentum about its axis is h = I (Omega + a.w), absolute: only the torque of its motor changes it, h' = u,
//! whatever the motion of the body (Euler's third equation of a rotor). So it is known exactly at every instant, and
//! with it the time at which it reaches its limit. The speed Omega also depends on the body's rate.

use std::collections::VecDeque;

use flexsc_dynamics::three_axis::{Rotor, RotorObservation};
use flexsc_dynamics::wrench::Wrench;
use flexsc_numerics::attitude::Vector;
use flexsc_numerics::quantity::Positive;
use flexsc_numerics::random::Seed;
use flexsc_numerics::time::{Instant, Span};

use super::failure::ActiveFailures;
use super::wheel_allocation::Allocation;
use super::wheels::{FrictionCompensation, SpeedBias, Wheels};
use super::{Actuator, ActuatorEvent, AxisActuatorContext, AxisEffort, AxisResponse, Capabilities, Demand};
use crate::sensor::{Tachometer, TachometerState};

/// Relative distance from its limit at which a wheel with friction counts as being at the limit.
const AT_LIMIT: f64 = 1e-12;

/// Shortest time (s) to the next check of a wheel with friction on its way to its limit.
const SOONEST: f64 = 1e-6;

/// Run-time state of the wheels of a body.
#[derive(Clone, Debug)]
pub struct WheelsState {
    allocation: Allocation,
    /// Moment of inertia of each wheel about its axis (kg m²).
    inertia: f64,
    /// Largest torque (N m), momentum (N m s) and speed (rad/s) of each wheel.
    torque_limit: f64,
    momentum_limit: f64,
    speed_limit: f64,
    bias: Option<SpeedBias>,
    settings: Vec<AxisActuatorContext>,
    /// Torque on the body that laws demand, and torque of other sources that the wheels counteract (N m).
    demanded: Vector,
    against: Vector,
    /// Time from a command to its execution, and commands that wait for it (N m).
    delay: Span,
    waiting: VecDeque<(Instant, Vector)>,
    wheels: Vec<WheelState>,
    /// Time from which on the wheels' momenta are propagated.
    since: Instant,
    /// State of wheels in bearings, as computed by the motion.
    observations: Vec<RotorObservation>,
    /// Tachometer that provides the speeds to the drives; without one they are exact.
    tachometer: Option<TachometerState>,
    compensation: Option<Box<FrictionCompensation>>,
    /// Commanded torque of each drive (N m), and its failures.
    commanded: Vec<f64>,
    failing: Vec<Option<ActiveFailures>>,
}

/// State of a wheel.
#[derive(Copy, Clone, Debug)]
struct WheelState {
    /// Momentum at the last change of the torque (N m s).
    momentum: f64,
    /// Torque of the motor on the wheel (N m).
    torque: f64,
    /// Time at which the wheel reaches a limit.
    full: Option<Instant>,
}

impl WheelState {
    fn momentum_at(&self, seconds: f64) -> f64 {
        self.momentum + self.torque * seconds
    }
}

impl WheelsState {
    /// Creates the wheels before their first command, on a body with these settings.
    pub fn new(wheels: &Wheels, allocation: &Allocation, settings: &[AxisActuatorContext]) -> Self {
        let speeds = wheels.speeds(allocation.axes().len());
        let inertia = wheels.inertia.get();
        let rate = Vector::from_fn(|axis, _| settings.get(axis).map_or(0.0, |setting| setting.rate));
        let spin = |(axis, speed): (&Vector, &f64)| WheelState {
            momentum: inertia * (speed + axis.dot(&rate)),
            torque: 0.0,
            full: None,
        };
        let limit = |limit: Option<Positive>| limit.map_or(f64::INFINITY, Positive::get);
        Self {
            wheels: allocation.axes().iter().zip(&speeds).map(spin).collect(),
            allocation: allocation.clone(),
            inertia,
            torque_limit: limit(wheels.torque),
            momentum_limit: limit(wheels.momentum),
            speed_limit: limit(wheels.speed_limit),
            bias: wheels.speed_bias,
            settings: settings.to_vec(),
            demanded: Vector::zeros(),
            against: Vector::zeros(),
            delay: Span::from_seconds(wheels.delay.get()),
            waiting: VecDeque::new(),
            since: Instant::START,
            observations: Vec::new(),
            tachometer: None,
            compensation: wheels.compensation.clone(),
            commanded: vec![0.0; speeds.len()],
            failing: (0..speeds.len()).map(|wheel| wheels.wheel_failures(wheel)).collect(),
        }
    }

    /// Makes the drives use the tachometer's speeds only.
    #[must_use]
    pub fn with_tachometer(mut self, tachometer: Option<(&Tachometer, Seed)>) -> Self {
        let rate = Vector::from_fn(|axis, _| self.settings.get(axis).map_or(0.0, |setting| setting.rate));
        let speeds = (0..self.wheels.len()).map(|index| self.known_speed(index, &rate)).collect();
        self.tachometer = tachometer.map(|(tachometer, seed)| TachometerState::new(tachometer, speeds, seed));
        self
    }

    fn elapsed(&self, now: Instant) -> f64 {
        now.since(self.since).seconds()
    }

    /// Propagates the momenta to `now`.
    fn turn(&mut self, now: Instant) {
        let seconds = self.elapsed(now);
        for wheel in &mut self.wheels {
            wheel.momentum = wheel.momentum_at(seconds);
        }
        self.since = now;
    }

    /// Returns the speed of a wheel relative to a body with this rate (rad/s), as available to its drive.
    fn known_speed(&self, index: usize, rate: &Vector) -> f64 {
        match &self.tachometer {
            Some(tachometer) => tachometer.speeds()[index],
            None => self.speed(index, rate),
        }
    }

    /// Returns the speed of a wheel relative to a body with this rate (rad/s).
    fn speed(&self, index: usize, rate: &Vector) -> f64 {
        match self.observations.get(index) {
            Some(wheel) => wheel.speed,
            None => self.wheels[index].momentum / self.inertia - self.allocation.axes()[index].dot(rate),
        }
    }

    /// Adds to the torques of the motors those that bring the wheels towards the speed of the bias and cancel on the body,
    /// which has this rate (rad/s).
    fn bias_speeds(&mut self, rate: &Vector) {
        let (Some(bias), Some(null)) = (self.bias, self.allocation.null_vector().copied()) else { return };
        let square: f64 = null.iter().map(|part| part * part).sum();
        let known = null.iter().enumerate().map(|(index, part)| part * self.known_speed(index, rate));
        let speed = known.sum::<f64>() / square;
        let mut part = bias.gain.get() * (bias.speed.get() - speed) * self.inertia;
        let wheels = self.allocation.flight_wheels_mut();
        for (wheel, null) in wheels.iter().zip(null).filter(|(_, null)| *null != 0.0) {
            let ends = [self.torque_limit, -self.torque_limit].map(|limit| (limit - wheel.torque) / null);
            part = part.clamp(ends[0].min(ends[1]).min(0.0), ends[0].max(ends[1]).max(0.0));
        }
        wheels.iter_mut().zip(null).for_each(|(wheel, null)| wheel.torque += part * null);
    }

    /// Returns the torque within the limits of a wheel at this speed, and the time until the wheel reaches a limit (s).
    /// With friction that is a time before the limit, at which the rest is computed again.
    fn within_limits(&self, index: usize, speed: f64, torque: f64) -> (f64, f64) {
        let ahead = libm::copysign(1.0, torque);
        let momentum = self.wheels[index].momentum;
        let room =
            (self.momentum_limit - ahead * momentum).min((self.speed_limit - ahead * speed) * self.inertia);
        let Some(wheel) = self.observations.get(index) else {
            return if room <= 0.0 { (0.0, f64::INFINITY) } else { (torque, room / torque.abs()) };
        };
        let limit = self.momentum_limit.min(self.speed_limit * self.inertia);
        if limit.is_finite() && room <= AT_LIMIT * limit {
            return (0.0, f64::INFINITY);
        }
        let net = ahead * (torque - wheel.friction);
        (torque, if net > 0.0 { (room / net).max(SOONEST) } else { f64::INFINITY })
    }

    /// Commands all wheels with the torques that give the body the demanded torque, within the torque limit.
    fn drive_all(&mut self, now: Instant, rigid: &Vector) {
        self.allocation.allocate(&(self.against - self.demanded), self.torque_limit);
        self.bias_speeds(rigid);
        for index in 0..self.wheels.len() {
            let torque = self.compensated(index, self.allocation.flight_wheels()[index].torque, rigid);
            self.drive(now, index, torque, rigid);
        }
    }

    /// Sets the torque of a wheel from `now` on, subject to its failures and limits, on a body with this rate (rad/s).
    fn drive(&mut self, now: Instant, index: usize, torque: f64, rigid: &Vector) {
        self.commanded[index] = torque;
        let turned = self.observations.get(index).map(|wheel| wheel.speed);
        let speed = turned.unwrap_or_else(|| self.known_speed(index, rigid));
        let torque = self.failing[index].as_ref().map_or(torque, |failing| failing.output(torque));
        let (torque, seconds) = self.within_limits(index, speed, torque);
        let full = seconds.is_finite().then(|| now + Span::from_seconds(seconds));
        (self.wheels[index].torque, self.wheels[index].full) = (torque, full);
    }

    /// Starts and ends failures, which change the torques of the drives.
    fn fail(&mut self, now: Instant, rigid: &Vector) {
        let mut any = false;
        for (failing, commanded) in self.failing.iter_mut().zip(&self.commanded) {
            any |= failing.as_mut().is_some_and(|failing| failing.update(now, *commanded));
        }
        if any {
            self.turn(now);
            for index in 0..self.wheels.len() {
                self.drive(now, index, self.commanded[index], rigid);
            }
        }
    }

    /// Returns the torque of a drive (N m) as estimators assume it: without failures.
    fn assumed_torque(&self, index: usize) -> f64 {
        if self.failing[index].is_some() { self.commanded[index] } else { self.wheels[index].torque }
    }

    /// Returns the torque of a drive (N m) with the compensation of the friction, on a body with this rate (rad/s).
    fn compensated(&self, index: usize, torque: f64, rate: &Vector) -> f64 {
        let Some(FrictionCompensation { coulomb, viscous }) = self.compensation.as_deref() else {
            return torque;
        };
        let speed = self.known_speed(index, rate);
        // A wheel at rest is expected to move with the torque.
        let direction = if speed == 0.0 { torque } else { speed };
        let coulomb =
            if direction == 0.0 { 0.0 } else { libm::copysign(coulomb.for_wheel(index).get(), direction) };
        let added = torque + coulomb + viscous.for_wheel(index).get() * speed;
        added.clamp(-self.torque_limit, self.torque_limit)
    }
}

impl WheelsState {
    /// Executes due commands. A wheel at its limit stays there until the next command; tachometers are read, and
    /// compensation follows.
    fn serve(&mut self, now: Instant, rigid: [f64; 3]) {
        self.fail(now, &rigid.into());
        while let Some((due, demanded)) = self.waiting.front().copied()
            && due <= now
        {
            self.waiting.pop_front();
            self.execute(now, demanded, rigid);
        }
        let observations = self.observations.iter().map(|wheel| [wheel.angle, wheel.speed]);
        if let Some(tachometer) = self.tachometer.as_mut().filter(|tachometer| tachometer.due() == now) {
            tachometer.read(now, observations);
            if self.compensation.is_some() {
                self.turn(now);
                self.drive_all(now, &rigid.into());
                return;
            }
        }
        if self.wheels.iter().any(|wheel| wheel.full == Some(now)) {
            self.turn(now);
            let full: Vec<usize> =
                (0..self.wheels.len()).filter(|index| self.wheels[*index].full == Some(now)).collect();
            for index in full {
                if self.observations.is_empty() {
                    (self.wheels[index].torque, self.wheels[index].full) = (0.0, None);
                } else {
                    self.drive(now, index, self.commanded[index], &rigid.into());
                }
            }
        }
    }

    /// Gives the body a torque (N m) from now on.
    fn execute(&mut self, now: Instant, demanded: Vector, rigid: [f64; 3]) {
        self.turn(now);
        self.demanded = demanded;
        self.drive_all(now, &rigid.into());
    }

    /// Returns the torque held about an axis (N m).
    fn held_torque(&self, axis: usize) -> f64 {
        let wheels = self.allocation.axes().iter().zip(&self.wheels);
        -wheels.map(|(about, wheel)| about[axis] * wheel.torque).sum::<f64>()
    }
}

impl Actuator for WheelsState {
    fn command(&mut self, now: Instant, demands: &[Demand], rigid: [f64; 3]) {
        let mut demanded = self.waiting.back().map_or(self.demanded, |(_, last)| *last);
        for (axis, (demand, setting)) in demands.iter().zip(&self.settings).enumerate().take(3) {
            demanded[axis] = setting.demanded_torque(demand);
        }
        if self.delay > Span::ZERO {
            self.waiting.push_back((now + self.delay, demanded));
        } else {
            self.execute(now, demanded, rigid);
        }
    }

    fn apply(&self, now: Instant, onto: &mut Wrench) {
        let seconds = self.elapsed(now);
        let rotor = |(axis, wheel): (&Vector, &WheelState)| Rotor {
            axis: *axis,
            momentum: wheel.momentum_at(seconds),
            torque: wheel.torque,
        };
        onto.rotors.extend(self.allocation.axes().iter().zip(&self.wheels).map(rotor));
    }

    fn update(&mut self, now: Instant, event: ActuatorEvent<'_>) {
        match event {
            ActuatorEvent::CounterTorque(torque) => self.against = torque,
            ActuatorEvent::Due(rigid) => self.serve(now, rigid),
            ActuatorEvent::Rotors(rotors) => {
                self.turn(now);
                for (wheel, rotor) in self.wheels.iter_mut().zip(rotors) {
                    wheel.momentum = rotor.momentum;
                }
                self.observations.clear();
                self.observations.extend_from_slice(rotors);
            }
            ActuatorEvent::MagneticField(_) | ActuatorEvent::EstimatedRate(_) | ActuatorEvent::Mode(_) => {}
        }
    }

    fn effort(&self, axis: usize) -> AxisEffort {
        let believed = self.allocation.axes().iter().enumerate();
        let torque = -believed.map(|(index, about)| about[axis] * self.assumed_torque(index)).sum::<f64>();
        AxisEffort {
            demanded: self.demanded[axis],
            held: self.held_torque(axis),
            firing: 0.0,
            reduced_moment: torque / self.settings[axis].inertia,
        }
    }

    fn response(&self, _: Instant, axis: usize, _: [f64; 2]) -> AxisResponse {
        let held = self.held_torque(axis);
        let friction = self.observations.iter().zip(self.allocation.axes());
        let applied = match &self.observations[..] {
            [] => held,
            _ => held + friction.map(|(wheel, about)| about[axis] * wheel.friction).sum::<f64>(),
        };
        AxisResponse { applied, rotor: None }
    }

    fn capabilities(&self) -> Capabilities<'_> {
        Capabilities { momentum: Some(self), ..Capabilities::default() }
    }

    fn copy(&self) -> Box<dyn Actuator> {
        Box::new(self.clone())
    }
}

mod rows;
#[cfg(test)]
mod tests;
