//! Flow of a one-axis body that the run computes itself: in closed form with certified crossings where there is one.

mod pieces;

use std::borrow::Cow;

use flexsc_control::estimator::WindowedEnvelope;
use flexsc_control::sensor::{Orientation, Truth};
use flexsc_dynamics::axis_model::AxisModel;
use flexsc_dynamics::crossing::first_crossing;
use flexsc_dynamics::flow::{ChainMotion, CoupledFlow, ExternalMotion, SegmentInput, UncoupledSegment};
use flexsc_dynamics::guard::{AxisGuards, Guard, GuardCrossing};
use flexsc_dynamics::wrench::Wrench;
use flexsc_dynamics::{AngleObservation, AxisState};
use flexsc_numerics::time::{Instant, Span};
use flexsc_record::{Record, RecordError};

use super::external::ExternalFlow;
use super::flow::{Flow, FlowQuantities};
use super::one_axis_body::OneAxisBody;
use flexsc_scenario::Scenario;

/// One-axis body with its motion segment and the next guard crossing.
#[derive(Clone, Debug)]
pub struct OneAxisFlow {
    body: OneAxisBody,
    motion: OneAxisMotion,
    /// Start of the motion segment.
    departed: Instant,
    /// State, sensed motion and instant of the next guard crossing, computed in advance.
    next_crossing: (AxisState, AngleObservation, Instant),
}

/// Motion under one input.
#[derive(Clone, Debug)]
enum OneAxisMotion {
    /// Uncoupled modes, in closed form.
    Uncoupled(UncoupledSegment),
    /// Chain of panels, integrated numerically.
    Chain(Box<ChainMotion>),
    /// Coupled or drifting modes.
    Coupled(Box<CoupledFlow>),
}

/// Torques of one motion segment, for the metrics.
#[derive(Copy, Clone, Debug, Default)]
pub struct AppliedTorque {
    /// Constant part of the actuator's torque, without the waveform of the command and the back-EMF (N m).
    pub constant: f64,
    /// Torque that the law commands (N m).
    pub feedback: f64,
    /// Back-EMF torque per unit of the rate (N m s), and whether the rate is that of the elastic body.
    pub back_emf: (f64, bool),
}

impl OneAxisFlow {
    /// Creates the flow of a scenario at the start, without input.
    pub fn new(scenario: &Scenario, body: &AxisModel) -> Self {
        let state = body.initial_state();
        let mut arc = UncoupledSegment::new(body);
        arc.depart(&state, &SegmentInput::default());
        let sensed = arc.initial_output();
        let motion = match (scenario.model.chain(), scenario.coupling(body)) {
            (Some(chain), _) => {
                OneAxisMotion::Chain(Box::new(ChainMotion::new(chain, sensed.angle, sensed.rate)))
            }
            (None, Some(coupling)) => OneAxisMotion::Coupled(Box::new(coupling)),
            (None, None) => OneAxisMotion::Uncoupled(arc),
        };
        Self {
            motion,
            departed: Instant::START,
            next_crossing: (state.clone(), AngleObservation::default(), Instant::START),
            body: OneAxisBody::new(body, state, sensed),
        }
    }

    /// Returns the state at the current instant.
    pub fn state(&self) -> &AxisState {
        &self.body.state
    }

    /// Advances the body to `now` and returns the sensed angle and rate.
    #[inline]
    pub fn view(&mut self, now: Instant) -> AngleObservation {
        let body = &mut self.body;
        if body.evaluated_at != now {
            body.evaluated_at = now;
            let (ahead, sensed, at) = &mut self.next_crossing;
            if *at == now {
                std::mem::swap(&mut body.state, ahead);
                body.sensed = *sensed;
            } else {
                let h = now.since(self.departed).seconds();
                body.sensed = match &mut self.motion {
                    OneAxisMotion::Uncoupled(arc) => arc.at(h, &mut body.state),
                    OneAxisMotion::Chain(flight) => flight.at(h, &mut body.state),
                    OneAxisMotion::Coupled(coupling) => coupling.at(h, &mut body.state),
                };
            }
        }
        body.sensed
    }

    /// Returns the motion for a batch, and the flow that stands for it from now on; `None` unless the modes are coupled
    /// or drift, between segment starts.
    pub fn take_motion(&self) -> Option<(ExternalMotion, ExternalFlow)> {
        let OneAxisMotion::Coupled(coupling) = &self.motion else { return None };
        let (motion, mobility) = coupling.take_motion()?;
        Some((motion, ExternalFlow::new(self.body.clone(), mobility)))
    }

    /// Begins a motion segment at the current instant, under a constant torque alone (N m).
    pub fn begin_under_torque(&mut self, constant: f64) {
        self.begin(&SegmentInput { constant, waveform: None });
    }

    /// Sets the state at `now` by `change`.
    pub fn set_state(&mut self, now: Instant, change: impl FnOnce(&mut AxisState)) {
        let body = &mut self.body;
        change(&mut body.state);
        let rate = body.mode_rates().fold(body.state.rigid_rate, |sum, rate| sum + rate);
        (body.evaluated_at, body.sensed) =
            (now, AngleObservation { angle: body.state.angle(), rate, acceleration: 0.0 });
        // A crossing that was found in advance belongs to the previous motion.
        self.next_crossing.2 = Instant::START;
    }

    /// Returns the instant and index of the first guard that trips within `horizon` in this segment.
    pub fn first_trip(
        &mut self,
        guards: &[Guard],
        horizon: Span,
        record: &mut dyn Record,
    ) -> Result<Option<(Instant, usize)>, RecordError> {
        let departed = self.departed;
        let arc = match &mut self.motion {
            OneAxisMotion::Uncoupled(arc) => arc,
            OneAxisMotion::Coupled(coupling) => {
                let trip = coupling.trip(guards, horizon, || record.poll())?;
                return Ok(trip.map(|trip| (departed + trip.after, trip.guard)));
            }
            // No law with guards acts on this body.
            OneAxisMotion::Chain(_) => return Ok(None),
        };
        let trip = match arc.predict_crossing(guards, horizon, &mut self.next_crossing.0) {
            Some(trip) => trip,
            None => first_crossing(arc, guards, horizon, &mut self.next_crossing.0, || record.poll())?,
        };
        Ok(trip.map(|trip| {
            let at = departed + trip.after;
            (self.next_crossing.1, self.next_crossing.2) = (trip.observation, at);
            (at, trip.guard)
        }))
    }

    fn begin(&mut self, input: &SegmentInput) {
        let now = self.body.evaluated_at;
        match &mut self.motion {
            OneAxisMotion::Uncoupled(arc) => arc.depart(&self.body.state, input),
            OneAxisMotion::Chain(flight) => flight.depart(input),
            OneAxisMotion::Coupled(coupling) => coupling.depart(now.seconds(), input.constant),
        }
        self.departed = now;
    }
}

impl Flow for OneAxisFlow {
    fn begin_segment(&mut self, wrench: &Wrench) {
        self.begin(&SegmentInput { constant: wrench.hub[0], waveform: wrench.waveform.clone() });
    }

    fn advance(&mut self, now: Instant, record: &mut dyn Record) -> Result<Option<Instant>, RecordError> {
        record.poll()?;
        let h = now.since(self.departed).seconds();
        loop {
            let is_there = match &mut self.motion {
                OneAxisMotion::Uncoupled(_) => true,
                OneAxisMotion::Chain(flight) => flight.approach(h),
                OneAxisMotion::Coupled(coupling) => coupling.approach(h),
            };
            if is_there {
                return Ok(None);
            }
            record.poll()?;
        }
    }

    #[inline]
    fn evaluate(&mut self, now: Instant, truth: &mut Truth) -> bool {
        self.view(now);
        self.body.write_truth(truth)
    }

    fn crossing(
        &mut self,
        [guards, ..]: AxisGuards<'_>,
        horizon: Span,
        record: &mut dyn Record,
    ) -> Result<Option<GuardCrossing>, RecordError> {
        let found = self.first_trip(guards, horizon, record)?;
        Ok(found.map(|(at, guard)| GuardCrossing { at, axis: 0, guard }))
    }

    fn about_axis(&self, _axis: usize, _target: &Orientation) -> Cow<'_, AxisState> {
        Cow::Borrowed(&self.body.state)
    }

    fn modal_state(&self) -> Cow<'_, AxisState> {
        Cow::Borrowed(&self.body.state)
    }

    fn update_monitor(
        &self,
        monitor: &mut WindowedEnvelope,
        now: Instant,
        torque: f64,
        _commanded: &dyn Fn() -> Wrench,
    ) {
        monitor.command(now, &self.body.state, torque);
    }

    fn quantities(&self) -> FlowQuantities<'_> {
        FlowQuantities::OneAxis(self)
    }

    fn copy(&self) -> Box<dyn Flow> {
        Box::new(self.clone())
    }
}
