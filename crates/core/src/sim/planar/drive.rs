//! What drives the body: the manoeuvre's waveform and the law's torque, through the actuator, and the disturbances.

use std::collections::VecDeque;
use std::sync::Arc as Shared;

use super::plant::Exerted;
use crate::actuator::{Actuator, Opposes, Pulse, Wheel};
use crate::body::{Drift, Forced, Input};
use crate::disturbance::{Disturbance, Disturbing};
use crate::law::Goal;
use crate::manoeuvre::Waveform;
use crate::quantity::Positive;
use crate::random::Seed;
use crate::record;
use crate::scenario::Scenario;
use crate::time::{Instant, Span};

/// All torques on the body.
#[derive(Clone, Debug)]
pub struct Drive {
    /// The manoeuvre's command, and where it breaks.
    waveform: Option<Shared<Waveform>>,
    /// Angle (rad) and rate (rad/s) at which the manoeuvre begins, and what a unit of its command accelerates (kg m²).
    from: (f64, f64),
    inertia: f64,
    /// Whether the torque is worth telling: it has more to it than switchings.
    pub is_worth_telling: bool,
    disturbances: Vec<Disturbing>,
    /// The instants, latest first, at which the waveform breaks, a disturbance changes or the drift has a kink.
    edges: Vec<Instant>,
    actuator: Actuator,
    next_period: Option<Instant>,
    pulse: Option<Pulse>,
    /// Impulse that the thrusters owe (N m s).
    owed: f64,
    /// The next instant at which the input changes by itself.
    pub due: Option<Instant>,
    /// Torque that the law holds (N m).
    feedback: f64,
    /// Torque of a hold or a pulse; of a wheel, without its back-EMF (N m).
    held: f64,
    /// Commands that a wheel has not yet taken, with the instants at which it does.
    delayed: VecDeque<(Instant, f64)>,
}

impl Drive {
    /// The drive of a scenario, before its start.
    pub fn new(scenario: &Scenario, seed: Seed) -> Self {
        let waveform = scenario.plan.as_ref().map(|plan| Shared::new(plan.waveform.clone()));
        let breaks = waveform.iter().flat_map(|w| w.breaks()).map(|t| Instant::START + Span::from_seconds(t));
        let kinks = scenario.drift.iter().flat_map(Drift::kinks);
        let mut edges: Vec<Instant> = breaks
            .chain(scenario.disturbance.iter().flat_map(Disturbance::edges))
            .chain(kinks.map(|t| Instant::START + Span::from_seconds(t)))
            .collect();
        edges.sort_by(|a, b| b.cmp(a));
        edges.dedup();
        let mut drive = Self {
            waveform,
            from: (scenario.model.angle.get(), scenario.model.rate.get()),
            inertia: scenario.planned_for().commanded_inertia(),
            is_worth_telling: scenario.tells_torque(),
            disturbances: scenario
                .disturbance
                .iter()
                .enumerate()
                .map(|(index, of)| Disturbing::new(of, seed.stream(&format!("disturbance {index}"))))
                .collect(),
            edges,
            next_period: scenario.actuator.period().map(|_| Instant::START),
            actuator: scenario.actuator.clone(),
            pulse: None,
            owed: 0.0,
            due: None,
            feedback: 0.0,
            held: 0.0,
            delayed: VecDeque::new(),
        };
        drive.due = drive.next();
        drive
    }

    fn next(&self) -> Option<Instant> {
        let pulse = self.pulse.map(|pulse| if self.held == 0.0 { pulse.from } else { pulse.to });
        let delayed = self.delayed.front().map(|(at, _)| *at);
        let drawn = self.disturbances.iter().filter_map(Disturbing::due).min();
        [self.edges.last().copied(), self.next_period, pulse, delayed, drawn].into_iter().flatten().min()
    }

    /// Takes over what the law holds from now on, of a body that turns at this rigid rate (rad/s).
    pub fn command(&mut self, now: Instant, feedback: f64, rigid_rate: f64) {
        self.feedback = feedback;
        if let Actuator::Wheel(wheel) = &self.actuator {
            let delay = Span::from_seconds(wheel.delay.get());
            self.delayed.push_back((now + delay, wheel.shaped(feedback)));
            self.turn_wheel(now, rigid_rate);
            self.due = self.next();
        }
    }

    /// Gives the wheel the commands that have come through.
    fn turn_wheel(&mut self, now: Instant, rigid_rate: f64) {
        let Actuator::Wheel(wheel) = &self.actuator else { return };
        while let Some((_, command)) = self.delayed.front().copied().filter(|(at, _)| *at <= now) {
            self.delayed.pop_front();
            let torque = wheel.gain.get() * command;
            // What accelerates the body takes speed from the wheel.
            let spent = self
                .speed(wheel, rigid_rate)
                .is_some_and(|(speed, limit)| speed.abs() >= limit && speed * torque < 0.0);
            self.held = if spent { 0.0 } else { torque };
        }
    }

    /// Speed of a wheel that stores momentum, and its limit (rad/s).
    fn speed(&self, wheel: &Wheel, rigid_rate: f64) -> Option<(f64, f64)> {
        let rotor = wheel.rotor.as_ref()?;
        let gained = self.inertia * (rigid_rate - self.from.1) / rotor.inertia.get();
        let limit = rotor.speed_limit.map_or(f64::INFINITY, Positive::get);
        Some((rotor.speed.get() - gained, limit))
    }

    /// Does what is due now, after the law has decided, for a body that turns at this rigid rate (rad/s).
    pub fn serve(&mut self, now: Instant, rigid_rate: f64) {
        self.turn_wheel(now, rigid_rate);
        while self.edges.last().is_some_and(|edge| *edge <= now) {
            self.edges.pop();
        }
        self.disturbances.iter_mut().for_each(|disturbance| disturbance.serve(now));
        if self.next_period == Some(now) {
            self.begin_period(now);
        }
        if let Some(pulse) = self.pulse {
            let on = pulse.from <= now && now < pulse.to;
            self.held = if on { pulse.torque } else { 0.0 };
            self.pulse = self.pulse.filter(|_| now < pulse.to);
        }
        self.due = self.next();
    }

    fn begin_period(&mut self, now: Instant) {
        let Some(period) = self.actuator.period() else { return };
        self.next_period = Some(now + period);
        let (from, h) = (now.seconds(), period.seconds());
        let planned = self.waveform.as_ref().map_or(0.0, |waveform| waveform.impulse(from, from + h));
        match &self.actuator {
            Actuator::Ideal | Actuator::Wheel(_) | Actuator::Jets(_) => {}
            Actuator::Hold(_) => self.held = self.feedback + planned / h,
            Actuator::Thrusters(thrusters) => {
                self.held = 0.0;
                let (pulse, owed) = thrusters.pulse(now, self.owed + planned + self.feedback * h);
                self.owed = owed;
                self.pulse = (pulse.from < pulse.to).then_some(pulse);
            }
        }
    }

    /// What drives the body from now on.
    pub fn input(&self, now: Instant) -> Input {
        let disturbance = self.disturbance(now);
        match (&self.actuator, &self.waveform) {
            (Actuator::Ideal, waveform) => Input {
                constant: self.feedback + disturbance,
                waveform: waveform
                    .as_ref()
                    .filter(|waveform| now.seconds() < waveform.end())
                    .map(|waveform| Forced::new(Shared::clone(waveform), now.seconds())),
            },
            _ => Input { constant: self.held + disturbance, waveform: None },
        }
    }

    /// Angle (rad) and rate (rad/s) where the body shall be: on the manoeuvre, where it would be if it were rigid.
    pub fn rigid_goal(&self, goal: &Goal, now: Instant) -> (f64, f64) {
        match &self.waveform {
            Some(waveform) if now < goal.from => {
                let ((angle, rate), t) = (self.from, now.seconds());
                let (travel, impulse) = (waveform.travel(0.0, t), waveform.impulse(0.0, t));
                (angle + rate * t + travel / self.inertia, rate + impulse / self.inertia)
            }
            _ => goal.at(now),
        }
    }

    /// The reduced moment that the actuator gives the body now (rad/s²), without a wheel's back-EMF.
    pub fn held_moment(&self) -> f64 {
        let torque = if self.actuator == Actuator::Ideal { self.feedback } else { self.held };
        torque / self.inertia
    }

    /// What torque a command of the law asks for (N m): that of a wheel has a gain.
    pub fn asked(&self, command: f64) -> f64 {
        match &self.actuator {
            Actuator::Wheel(wheel) => wheel.gain.get() * command,
            _ => command,
        }
    }

    /// The torques of the motion that begins now.
    pub fn exerted(&self) -> Exerted {
        Exerted {
            constant: if self.actuator == Actuator::Ideal { self.feedback } else { self.held },
            feedback: self.asked(self.feedback),
            back_emf: match &self.actuator {
                Actuator::Wheel(wheel) => (wheel.back_emf.get(), wheel.opposes == Opposes::BodyRate),
                _ => (0.0, false),
            },
        }
    }

    /// The torques now, as logged, on a body that turns at these rates (rad/s).
    pub fn torque(&self, now: Instant, rate: f64, rigid_rate: f64) -> record::Torque {
        let feedforward_nm = self.waveform.as_ref().map_or(0.0, |waveform| waveform.at(now.seconds()));
        let command = feedforward_nm + self.feedback;
        record::Torque {
            feedforward_nm,
            feedback_nm: self.asked(self.feedback),
            applied_nm: match &self.actuator {
                Actuator::Ideal => command,
                Actuator::Wheel(wheel) => {
                    let felt = if wheel.opposes == Opposes::BodyRate { rate } else { rigid_rate };
                    self.held - wheel.back_emf.get() * felt
                }
                Actuator::Hold(_) | Actuator::Thrusters(_) | Actuator::Jets(_) => self.held,
            },
            disturbance_nm: self.disturbance(now),
        }
    }

    /// The wheel, as logged, of a body that turns at this rigid rate (rad/s); none without one.
    pub fn wheel(&self, rigid_rate: f64) -> Option<record::WheelMotion> {
        let Actuator::Wheel(wheel) = &self.actuator else { return None };
        let (speed, _) = self.speed(wheel, rigid_rate)?;
        let inertia = wheel.rotor.as_ref().map_or(0.0, |rotor| rotor.inertia.get());
        Some(record::WheelMotion { speed_rad_s: speed, momentum_nm_s: inertia * speed })
    }

    fn disturbance(&self, now: Instant) -> f64 {
        self.disturbances.iter().map(|disturbance| disturbance.torque(now)).sum()
    }
}
