//! Plant of a one-axis body: its motion segment since the last event, and the current state.

mod pieces;

use flexsc_control::sensor::{Orientation, Truth};
use flexsc_dynamics::axis_model::{AxisModel, AxisOutput};
use flexsc_dynamics::crossing::first_crossing;
use flexsc_dynamics::guard::Guard;
use flexsc_dynamics::{AngleObservation, AxisState};
use flexsc_numerics::time::{Instant, Span};
use flexsc_record::{Attitude, ModeMotion, Modes, OutputMotion, Outputs, Rate, Record, RecordError};
use flexsc_spacecraft::flow::{ChainMotion, CoupledFlow, ExternalMotion, SegmentInput, UncoupledSegment};
use flexsc_spacecraft::wrench::Wrench;

use super::INITIAL_TRUTH;
use super::external_motion::ExternalSegment;
use crate::scenario::Scenario;

/// One-axis body with its motion segment and the next guard crossing.
#[derive(Clone, Debug)]
pub struct OneAxisPlant {
    motion: OneAxisFlow,
    departed: Instant,
    /// State and sensed angle and rate at `seen`.
    state: AxisState,
    sight: AngleObservation,
    evaluated_at: Instant,
    /// True state at the last evaluation.
    truth: Truth,
    /// State, sensed motion and instant of the next guard crossing, computed in advance.
    next_crossing: (AxisState, AngleObservation, Instant),
    frequencies: Vec<f64>,
    outputs: Vec<AxisOutput>,
}

/// Motion under one input.
#[derive(Clone, Debug)]
enum OneAxisFlow {
    /// Uncoupled modes, in closed form.
    Uncoupled(UncoupledSegment),
    /// Chain of panels, integrated numerically.
    Chain(Box<ChainMotion>),
    /// Coupled or drifting modes.
    Coupled(Box<CoupledFlow>),
    /// Drifting modes whose motion a batch computes.
    External(ExternalSegment),
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

impl OneAxisPlant {
    /// Creates the plant of a scenario at the start, without input.
    pub fn new(scenario: &Scenario, body: &AxisModel) -> Self {
        let state = body.initial_state();
        let mut arc = UncoupledSegment::new(body);
        arc.depart(&state, &SegmentInput::default());
        let vector_measurement = arc.initial_output();
        let motion = match (scenario.model.chain(), scenario.coupling(body)) {
            (Some(chain), _) => OneAxisFlow::Chain(Box::new(ChainMotion::new(
                chain,
                vector_measurement.angle,
                vector_measurement.rate,
            ))),
            (None, Some(coupling)) => OneAxisFlow::Coupled(Box::new(coupling)),
            (None, None) => OneAxisFlow::Uncoupled(arc),
        };
        Self {
            motion,
            departed: Instant::START,
            sight: vector_measurement,
            evaluated_at: Instant::START,
            truth: INITIAL_TRUTH,
            next_crossing: (state.clone(), AngleObservation::default(), Instant::START),
            frequencies: body.modes.iter().map(|mode| mode.frequency.get()).collect(),
            outputs: body.outputs.clone(),
            state,
        }
    }

    /// Returns the state at the current instant.
    pub fn state(&self) -> &AxisState {
        &self.state
    }

    /// Returns the rates of the modes at the current instant (rad/s).
    pub fn mode_rates(&self) -> impl Iterator<Item = f64> {
        self.frequencies.iter().zip(&self.state.modes).map(|(w, phase)| w * phase.quadrature)
    }

    /// Integrates motions without a closed form up to `now`, unless the record fails, so that evaluating the body there
    /// is cheap.
    pub fn approach(&mut self, now: Instant, record: &mut dyn Record) -> Result<(), RecordError> {
        record.poll()?;
        if matches!(self.motion, OneAxisFlow::Uncoupled(_) | OneAxisFlow::External(_)) {
            return Ok(());
        }
        let h = now.since(self.departed).seconds();
        loop {
            let is_there = match &mut self.motion {
                OneAxisFlow::Uncoupled(_) | OneAxisFlow::External(_) => true,
                OneAxisFlow::Chain(flight) => flight.approach(h),
                OneAxisFlow::Coupled(coupling) => coupling.approach(h),
            };
            if is_there {
                return Ok(());
            }
            record.poll()?;
        }
    }

    /// Advances the body to `now` and returns the sensed angle and rate.
    pub fn view(&mut self, now: Instant) -> AngleObservation {
        if self.evaluated_at != now {
            self.evaluated_at = now;
            let (ahead, sight, at) = &mut self.next_crossing;
            if *at == now {
                std::mem::swap(&mut self.state, ahead);
                self.sight = *sight;
            } else {
                let h = now.since(self.departed).seconds();
                self.sight = match &mut self.motion {
                    OneAxisFlow::Uncoupled(arc) => arc.at(h, &mut self.state),
                    OneAxisFlow::Chain(flight) => flight.at(h, &mut self.state),
                    OneAxisFlow::Coupled(coupling) => coupling.at(h, &mut self.state),
                    // The batch that computes the motion has already set the state at `now`.
                    OneAxisFlow::External(_) => self.sight,
                };
            }
        }
        self.sight
    }

    /// Advances the body to `now` and returns its true state; `None` if the motion is no longer finite.
    pub fn evaluate(&mut self, now: Instant) -> Option<&Truth> {
        let AngleObservation { angle, rate, .. } = self.view(now);
        if !(angle.is_finite() && rate.is_finite()) {
            return None;
        }
        let truth = &mut self.truth;
        truth.orientation = Orientation::Angle(angle);
        (truth.rate[0], truth.rigid[0], truth.turned[0]) = (rate, self.state.rigid_rate, angle);
        Some(truth)
    }

    /// Returns the true state of the last evaluation.
    pub fn viewed(&self) -> &Truth {
        &self.truth
    }

    /// Hands the motion to a batch from now on; `None` unless the modes are coupled or drift, between segment starts.
    pub fn take_motion(&mut self) -> Option<ExternalMotion> {
        let OneAxisFlow::Coupled(coupling) = &self.motion else { return None };
        let (motion, mobility) = coupling.take_motion()?;
        self.motion = OneAxisFlow::External(ExternalSegment::new(mobility));
        Some(motion)
    }

    /// Sets the motion that a batch has computed at `now`: angle and rate of each coordinate.
    pub fn set_motion(&mut self, now: Instant, motion: impl Iterator<Item = [f64; 2]>) {
        (self.evaluated_at, self.sight) = (now, AngleObservation::default());
        for (index, [angle, rate]) in motion.enumerate() {
            if index == 0 {
                (self.state.rigid_angle, self.state.rigid_rate) = (angle, rate);
            } else {
                let mode = &mut self.state.modes[index - 1];
                (mode.displacement, mode.quadrature) = (angle, rate / self.frequencies[index - 1]);
            }
            self.sight.angle += angle;
            self.sight.rate += rate;
        }
    }

    /// Returns the start of the last segment of a motion that a batch computes, and its reduced moment (rad/s²), once
    /// per segment.
    pub fn take_segment_start(&mut self) -> Option<(Instant, f64)> {
        if let OneAxisFlow::External(lent) = &mut self.motion { lent.departed() } else { None }
    }

    /// Begins a motion segment at the current instant, under the wrench from now on.
    pub fn depart(&mut self, wrench: &Wrench) {
        let input = SegmentInput { constant: wrench.hub[0], waveform: wrench.waveform.clone() };
        self.begin(&input);
    }

    /// Begins a motion segment at the current instant, under a constant torque alone (N m).
    pub fn begin_under_torque(&mut self, constant: f64) {
        self.begin(&SegmentInput { constant, waveform: None });
    }

    /// Sets the state at `now` by `change`.
    pub fn set_state(&mut self, now: Instant, change: impl FnOnce(&mut AxisState)) {
        change(&mut self.state);
        let rate = self.mode_rates().fold(self.state.rigid_rate, |sum, rate| sum + rate);
        (self.evaluated_at, self.sight) =
            (now, AngleObservation { angle: self.state.angle(), rate, acceleration: 0.0 });
        // A crossing that was found in advance belongs to the previous motion.
        self.next_crossing.2 = Instant::START;
    }

    fn begin(&mut self, input: &SegmentInput) {
        match &mut self.motion {
            OneAxisFlow::Uncoupled(arc) => arc.depart(&self.state, input),
            OneAxisFlow::Chain(flight) => flight.depart(input),
            OneAxisFlow::Coupled(coupling) => coupling.depart(self.evaluated_at.seconds(), input.constant),
            OneAxisFlow::External(lent) => lent.depart(self.evaluated_at, input.constant),
        }
        self.departed = self.evaluated_at;
    }

    /// Returns the instant and index of the first guard crossing of this segment within `horizon`.
    #[inline]
    pub fn trip(
        &mut self,
        guards: &[Guard],
        horizon: Span,
        record: &mut dyn Record,
    ) -> Result<Option<(Instant, usize)>, RecordError> {
        let departed = self.departed;
        let arc = match &mut self.motion {
            OneAxisFlow::Uncoupled(arc) => arc,
            OneAxisFlow::Coupled(coupling) => {
                let trip = coupling.trip(guards, horizon, || record.poll())?;
                return Ok(trip.map(|trip| (departed + trip.after, trip.guard)));
            }
            // No law with guards acts on these bodies.
            OneAxisFlow::Chain(_) | OneAxisFlow::External(_) => return Ok(None),
        };
        let trip = match arc.predict_crossing(guards, horizon, &mut self.next_crossing.0) {
            Some(trip) => trip,
            None => first_crossing(arc, guards, horizon, &mut self.next_crossing.0, || record.poll())?,
        };
        Ok(trip.map(|trip| {
            let at = departed + trip.after;
            (self.next_crossing.1, self.next_crossing.2) = (trip.sight, at);
            (at, trip.guard)
        }))
    }

    /// Returns the rows of the motion at the current instant; `measured` is the held measurement of a sampled sensor
    /// (rad).
    pub fn motion(&self, measured: Option<f64>) -> (Attitude, Rate, Modes) {
        let Self { state, sight, frequencies, .. } = self;
        let modes: Vec<_> = state
            .modes
            .iter()
            .zip(frequencies)
            .map(|(phase, w)| ModeMotion {
                displacement_rad: phase.displacement,
                rate_rad_s: w * phase.quadrature,
            })
            .collect();
        (
            Attitude {
                angle_rad: sight.angle,
                rigid_rad: state.rigid_angle,
                measured_rad: measured.unwrap_or(sight.angle),
            },
            Rate { rate_rad_s: sight.rate, rigid_rad_s: state.rigid_rate },
            Modes { elastic_rad: modes.iter().map(|mode| mode.displacement_rad).sum(), modes },
        )
    }

    /// Returns the row of the observed coordinates at the current instant; `None` if the body has none.
    pub fn outputs(&self) -> Option<Outputs> {
        let motion = |(value, rate)| OutputMotion { value, rate };
        let outputs: Vec<_> = match &self.motion {
            OneAxisFlow::Uncoupled(_) | OneAxisFlow::Coupled(_) | OneAxisFlow::External(_) => {
                let of = |output: &AxisOutput| {
                    (output.evaluate(&self.state), output.rate_of(&self.state, &self.frequencies))
                };
                self.outputs.iter().map(of).map(motion).collect()
            }
            OneAxisFlow::Chain(flight) => flight.outputs().map(motion).collect(),
        };
        (!outputs.is_empty()).then_some(Outputs { outputs })
    }
}
