//! The run loop, for one-axis and three-axis bodies.
//!
//! Order at one instant: the body is advanced, the sensors measure, the estimator processes the sample, the monitor
//! closes its window and the adaptation learns, the laws decide once, the actuator acts, the record gets its rows.
//! Between events every input is constant or a waveform, and the motion is exact. `docs/events.md` states the rules.

mod accelerometers;
mod batch_hooks;
mod control_step;
mod custom_parts;
mod error;
mod estimation;
mod exposures;
mod failures;
mod guidance;
mod journal;
mod journal_events;
mod loads;
mod manoeuvre_end;
mod motion_segments;
mod objectives;
mod observation;
mod plant;
mod recorder;
mod relay_kernel;
mod reports;
mod run_to;
mod scene_frames;
mod sensors;
mod start_finish;
mod stepping;
mod wheel_bearings;

use flexsc_control::estimator::{self, Estimator, ObjectiveMeter, WindowedEnvelope};
use flexsc_control::law::{Controllers, Event};
use flexsc_control::sensor::Orientation;
use flexsc_control::state_estimate::StateEstimate;
use flexsc_numerics::random::Seed;
use flexsc_numerics::time::{Instant, Span};
use flexsc_record::Record;

use crate::relay_setup::{self, RunSetup};
use crate::scenario::Scenario;

pub use error::SimulationError;
use exposures::Exposures;
use loads::Loads;
pub use observation::{ObservationField, ObservationGroup};
pub(crate) use plant::AppliedTorque;
pub use stepping::StopAt;

use guidance::Guidance;
use plant::Plant;
use recorder::Recorder;
use sensors::Sensors;

/// Largest number of decisions at one instant; more are chatter, because no scenario's law needs more than a few.
const MOST_DECISIONS: u32 = 32;

/// State of one run.
#[derive(Clone, Debug)]
#[expect(clippy::struct_excessive_bools, reason = "each is a fact of its own")]
pub struct Simulation {
    now: Instant,
    end: Instant,
    plant: Plant,
    sensors: Sensors,
    exposures: Exposures,
    estimator: Box<dyn Estimator>,
    /// True if the scenario has an estimator.
    has_estimator: bool,
    /// Instant up to which the estimator knows the impulse of the waveform.
    inputs_known_until: Instant,
    monitor: Option<WindowedEnvelope>,
    /// Meter of the adaptation's objective, unless the objective is the envelope.
    meter: Option<ObjectiveMeter>,
    guidance: Guidance,
    /// Attitude or angle from which the angles are counted, and (`next_target`) the instant at which it changes next.
    angle_origin: Orientation,
    next_origin_change: Option<Instant>,
    estimates: Vec<StateEstimate>,
    controllers: Controllers,
    loads: Loads,
    /// Torques during the current motion segment.
    applied: AppliedTorque,
    /// Instant and index of the next guard crossing, as long as the inputs do not change before.
    crossing: Option<(Instant, usize)>,
    decisions_at_now: u32,
    /// How often the law has switched since the last window of switchings ended, and when that was; how long one lasts (s) at least.
    switchings: (u64, Instant),
    shortest_window: f64,
    /// True if a wheel in bearings has stuck or let go at the current instant; `slips`: number of such events within a
    /// nanosecond, and the first's instant.
    bearing_event: bool,
    recent_bearing_events: (u32, Instant),
    recorder: Recorder,
    /// True if the sample that was read ahead for the current instant has a measurement; `None` if none was read ahead.
    sample_read_ahead: Option<bool>,
    /// Event at the current instant to which the laws have not responded yet, because the run was stopped before.
    pending_event: Option<Event>,
    /// True if there are external commands that the actuator does not have yet.
    external_command_pending: bool,
    /// True if the scenario has custom parts.
    has_custom_parts: bool,
    /// Initial setup for the relay kernel, if it can simulate this run.
    kernel_setup: Option<Box<RunSetup>>,
}

impl Simulation {
    /// Creates the run number `run` of a scenario, before its start.
    pub fn new(scenario: &Scenario, run: u64) -> Self {
        let seed = Seed { scenario: scenario.seed, run };
        let (study, reference) = (&scenario.study, Guidance::new(scenario));
        let axes = study.axes.len();
        Self {
            now: Instant::START,
            end: Instant::START + scenario.duration,
            plant: Plant::new(scenario),
            sensors: Sensors::new(scenario, seed),
            exposures: Exposures::new(scenario),
            estimator: estimator::start(&scenario.estimator_context(), seed),
            has_estimator: scenario.estimator.is_some(),
            inputs_known_until: Instant::START,
            monitor: scenario.monitor(seed),
            meter: scenario.objective_meter(seed),
            angle_origin: reference.origin(Instant::START),
            next_origin_change: reference.next_change(Instant::START),
            estimates: vec![StateEstimate::default(); axes],
            controllers: Controllers::new(&scenario.law, &study.authorities),
            loads: Loads::new(scenario, seed),
            applied: AppliedTorque::default(),
            crossing: None,
            decisions_at_now: 0,
            switchings: (0, Instant::START),
            shortest_window: relay_setup::shortest_window(scenario.model.frequencies().fold(0.0, f64::max)),
            bearing_event: false,
            recent_bearing_events: (0, Instant::START),
            sample_read_ahead: None,
            pending_event: None,
            external_command_pending: false,
            has_custom_parts: scenario.has_custom_parts(),
            kernel_setup: relay_setup::single(scenario).map(Box::new),
            recorder: Recorder::new(scenario, &reference, run),
            guidance: reference,
        }
    }

    /// Runs to the end of the scenario.
    pub fn run(&mut self, record: &mut dyn Record) -> Result<(), SimulationError> {
        self.run_until(Instant::END, record)
    }

    /// Runs to `until`, or to the end of the scenario if that is earlier, including everything that is due at that
    /// instant.
    pub fn run_until(&mut self, until: Instant, record: &mut dyn Record) -> Result<(), SimulationError> {
        let until = until.min(self.end);
        self.open(record)?;
        self.resume(None, record)?;
        self.run_in_kernel(until, record)?;
        while self.advance_to_next(until, record)? {
            self.process_instant(record)?;
        }
        self.finish(record)
    }

    /// Advances the body to the next instant at which anything is due, at most to `until`; returns true if anything is
    /// due there.
    fn advance_to_next(&mut self, until: Instant, record: &mut dyn Record) -> Result<bool, SimulationError> {
        let mut next = self.next();
        self.exposures.copy_plant(self.now, &self.plant);
        if let Some(at) = self.plant.advance(next.min(until), record)? {
            next = at;
            self.handle_bearing_event(at)?;
        }
        let now = next.min(until);
        self.update_rotor_states(now);
        if now > self.now {
            self.now = now;
            self.decisions_at_now = 0;
        }
        if next > until {
            self.plant.evaluate(until)?;
        }
        Ok(next <= until)
    }

    /// Returns the next instant at which anything is due.
    #[inline]
    fn next(&self) -> Instant {
        let trip = self.crossing.map(|(at, _)| at);
        let closes = self.monitor.as_ref().map(|monitor| monitor.closes);
        let measured = self.meter.as_ref().map(|meter| meter.closes);
        let due = [
            trip,
            self.controllers.next_timeout(),
            self.loads.due,
            self.sensors.next,
            self.exposures.due(),
            closes,
            measured,
            self.recorder.due(),
        ];
        due.into_iter().fold(self.end + Span::TICK, |next, due| due.map_or(next, |due| next.min(due)))
    }

    /// Processes everything that is due at the current instant, in the numbered steps of docs/events.md. Step 1, the state
    /// of the body, is evaluated by `advance_to_next`.
    pub(crate) fn process_instant(&mut self, record: &mut dyn Record) -> Result<(), SimulationError> {
        let event = self.law_event();
        self.sense_and_estimate(record)?;
        self.control_and_actuate(event, record)
    }

    /// Returns the event at the current instant for the laws.
    fn law_event(&self) -> Event {
        match self.crossing {
            _ if self.sample_is_due() || self.sample_read_ahead.is_some() => Event::Due { sampled: true },
            Some((at, guard)) if at == self.now => Event::Guard(guard),
            _ => Event::Due { sampled: false },
        }
    }

    /// Performs steps 2 to 5 of an instant: sensors, estimates, windows of the adaptation, and the end of a manoeuvre.
    fn sense_and_estimate(&mut self, record: &mut dyn Record) -> Result<(), SimulationError> {
        let now = self.now;
        // Steps 2 and 3: exposures that end, sensors, and the estimator.
        self.update_exposures(record)?;
        if self.sample_is_due() || self.sample_read_ahead.is_some() {
            self.update_estimates(record)?;
        }
        // Step 4: windows of the envelope and of other objectives, and the adaptation.
        if self.monitor.as_ref().is_some_and(|monitor| monitor.closes == now) {
            self.close_envelope_window(record)?;
        }
        self.close_objective_window(record)?;
        // Step 5.
        self.record_manoeuvre_end(record)
    }

    /// Performs steps 6 to 9 of an instant: laws, which decide on `event`, actuators, loads, and the record's rows.
    fn control_and_actuate(&mut self, event: Event, record: &mut dyn Record) -> Result<(), SimulationError> {
        let now = self.now;
        // Steps 6 and 7: the laws, and the actuator's commands.
        if self.external_command_pending || self.laws_must_decide(event) {
            self.control_step(event, record)?;
        }
        // Step 8: bearings, disturbances and the actuator's own periods.
        let met = std::mem::take(&mut self.bearing_event);
        if met || self.loads.due == Some(now) {
            self.plant.evaluate(now)?;
            self.set_magnetic_field();
            self.loads.serve(now, self.plant.truth().rigid);
            self.begin_segment(record)?;
        }
        self.check_custom_parts()?;
        // Step 9.
        self.record_bearing_events(record)?;
        self.record_failures(record)?;
        self.record_accelerations(record)?;
        self.record_due(record)?;
        self.record_frames(record)
    }
}
