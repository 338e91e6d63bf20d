//! The run loop, for one-axis and three-axis bodies: one instant after the other, in the nine steps of
//! `docs/events.md`.
//!
//! Each part of a run has a file of its own and reaches another part only through the arguments of its methods. Between
//! two instants every input is constant or a waveform, and the motion is exact.

mod batch_hooks;
mod blinding;
mod clock;
mod control_trace;
mod controllers;
mod error;
mod estimation;
mod exposures;
mod fine_mirrors;
mod guidance;
mod loads;
mod mode_sky;
mod mode_test;
mod motion_limits;
mod mounted_lines;
mod objective;
mod operation;
mod own_disturbance;
mod plant;
mod quantities;
mod quantity_reader;
mod recorder;
mod relay_kernel;
pub mod relay_setup;
mod requirement_monitors;
mod run_to;
mod run_view;
mod segment_copy;
mod sensor_schedule;
mod sensors;
mod start_finish;
mod stepping;
mod telemetry;

use flexsc_control::estimator::AdaptationRun;
use flexsc_control::law::Event;
use flexsc_control::part::Part;
use flexsc_numerics::random::Seed;
use flexsc_numerics::time::{Instant, Span};
use flexsc_record::Record;

use flexsc_scenario::Scenario;
use relay_setup::RunSetup;
use requirement_monitors::RequirementMonitors;

pub use control_trace::{ControlCall, ControlDecision, KnownRotors, ModeTrial, SensorSample, UnloadingCall};
pub use error::SimulationError;
pub use plant::AppliedTorque;
pub use quantities::{QuantityField, QuantityGroup};
pub use stepping::StopAt;
pub use telemetry::{SensorTelemetry, Telemetry, TelemetryLayout, TelemetrySensor};

use clock::Clock;
use controllers::ControlLaws;
use estimation::Estimation;
use fine_mirrors::FineMirrors;
use guidance::Guidance;
use loads::Loads;
use operation::Operation;
use plant::Plant;
use recorder::Recorder;
use run_view::RunView;
use sensors::Sensors;

/// State of one run.
#[derive(Clone, Debug)]
pub struct Simulation {
    clock: Clock,
    plant: Plant,
    sensors: Sensors,
    estimation: Estimation,
    guidance: Guidance,
    laws: ControlLaws,
    operation: Operation,
    loads: Loads,
    mirrors: FineMirrors,
    recorder: Recorder,
    requirements: RequirementMonitors,
    /// True if the scenario has custom parts.
    has_custom_parts: bool,
    /// Initial setup for the relay kernel, if it can simulate this run.
    kernel_setup: Option<Box<RunSetup>>,
}

impl Simulation {
    /// Creates the run number `run` of a scenario, before its start.
    pub fn new(scenario: &Scenario, run: u64) -> Self {
        let seed = Seed { scenario: scenario.seed, run };
        let (guidance, operation) = (Guidance::new(scenario, seed), Operation::new(scenario));
        let requirements = RequirementMonitors::new(scenario, operation.sky());
        Self {
            clock: Clock::new(scenario),
            plant: Plant::new(scenario),
            sensors: Sensors::new(scenario, seed),
            estimation: Estimation::new(scenario, &guidance, seed),
            laws: ControlLaws::new(scenario, seed),
            operation,
            loads: Loads::new(scenario, seed),
            mirrors: FineMirrors::new(scenario, seed),
            recorder: Recorder::new(scenario, &guidance, run),
            guidance,
            has_custom_parts: scenario.has_custom_parts(),
            // The kernel has no pieces of the motion.
            kernel_setup: relay_setup::single(scenario).filter(|_| requirements.is_empty()).map(Box::new),
            requirements,
        }
    }

    /// Runs to the end of the scenario.
    pub fn run(&mut self, record: &mut dyn Record) -> Result<(), SimulationError> {
        self.run_until(Instant::END, record)
    }

    /// Runs to `until`, or to the end of the scenario if that is earlier, including everything that is due at that
    /// instant.
    pub fn run_until(&mut self, until: Instant, record: &mut dyn Record) -> Result<(), SimulationError> {
        let until = until.min(self.clock.end());
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
        let now = self.clock.now();
        let due = self.next_due();
        let blinded = self.sensors.next_blinding([now, due.min(until)], &self.plant, &self.loads);
        let mut next = blinded.unwrap_or(due);
        self.sensors.copy_plant(now, &self.plant);
        self.mirrors.copy_plant(now, &self.plant);
        if let Some(at) = self.plant.advance(next.min(until), record)? {
            next = at;
            self.clock.count_bearing_event(at)?;
        }
        let now = next.min(until);
        self.loads.update_rotor_states(now, &self.plant);
        self.clock.advance_to(now);
        if next > until {
            self.plant.evaluate(until)?;
        }
        Ok(next <= until)
    }

    /// Returns the next instant at which anything is due.
    #[inline]
    fn next_due(&self) -> Instant {
        let end = self.clock.end() + Span::TICK;
        let or_earlier = |next: Instant, due: Option<Instant>| due.map_or(next, |due| next.min(due));
        let next = or_earlier(end, self.laws.next_event());
        let next = or_earlier(next, self.operation.due());
        let next = or_earlier(next, self.loads.due);
        let next = or_earlier(next, self.sensors.next_event());
        let next = or_earlier(next, self.estimation.window_closes());
        let next = or_earlier(next, self.clock.next_cycle());
        let next = or_earlier(next, self.mirrors.due());
        or_earlier(next, self.recorder.due())
    }

    /// Processes everything that is due at the current instant, in the numbered steps of `docs/events.md`.
    pub fn process_instant(&mut self, record: &mut dyn Record) -> Result<(), SimulationError> {
        let event = self.sense(record)?;
        self.respond(event, record)
    }

    /// Performs steps 1 to 5 of an instant, after which a run can be stopped; returns the event for the laws. Inlined: an
    /// event that is returned through memory stalls every instant.
    #[inline(always)]
    fn sense(&mut self, record: &mut dyn Record) -> Result<Event, SimulationError> {
        let now = self.clock.now();
        // 1. State of the body.
        self.plant.evaluate(now)?;
        // 2. Star trackers that bright bodies blind, exposures that end, and the target of this instant.
        self.sensors.update_blinding(now);
        self.sensors.update_exposures(now, &self.plant, record)?;
        self.mirrors.update(now, &self.plant, &self.guidance, record)?;
        let is_sampled = self.sensors.sample_is_due(now);
        let event = self.laws.event(now, is_sampled);
        if is_sampled || self.clock.cycle_is_due() || self.must_decide(event) {
            self.estimation.update_angle_origin(now, &mut self.guidance);
        }
        // 2. and 3. The sensors measure, and the estimator takes the sample.
        if is_sampled {
            self.take_sample(record)?;
        }
        // 4. Windows of the envelope and of other objectives, and the adaptation.
        let envelope = self.estimation.close_window(now, &self.plant, &mut self.laws);
        self.recorder.record_envelope_window(now, envelope.as_ref(), record)?;
        let objective = self.laws.close_objective_window(now, &self.plant, &self.loads);
        self.recorder.record_objective_window(now, objective.as_ref(), record)?;
        // 5. End of a manoeuvre.
        let (run, recorder) = self.view();
        recorder.record_manoeuvre_end(&run, record)?;
        Ok(event)
    }

    /// Performs steps 6 to 9 of an instant, in which the laws respond to `event`.
    fn respond(&mut self, event: Event, record: &mut dyn Record) -> Result<(), SimulationError> {
        let now = self.clock.now();
        // 6. and 7. The estimates are predicted, the laws decide, the actuator takes the commands: a new segment.
        let decides = self.laws.external_command_pending || self.must_decide(event);
        if decides {
            self.control_step(event, record)?;
        }
        // 8. Bearings, disturbances and the actuator's own periods: a new segment.
        if self.clock.take_bearing_event() || self.loads.due == Some(now) {
            self.end_requirement_segment();
            self.loads.set_magnetic_field(now, self.sensors.magnetic_field(self.plant.truth()));
            self.loads.apply_due_changes(now, self.plant.truth(), &self.estimation.estimates);
            self.trace_unloading(now);
            self.begin_segment(record)?;
        }
        self.check_custom_parts()?;
        let has_sampled = decides || self.sensors.has_sampled(now);
        self.update_requirements(|requirements, run| requirements.observe(run, has_sampled));
        // 9. Cycle of three axes, and the rows of the record.
        let is_cycle = self.clock.cycle_is_due();
        if is_cycle {
            self.clock.end_cycle();
            self.add_cycle();
        }
        let (run, recorder) = self.view();
        Ok(recorder.record_instant(&run, is_cycle, record)?)
    }

    /// Returns true if the laws have to decide on `event`, or the conditions of the mode are tested.
    #[inline]
    fn must_decide(&self, event: Event) -> bool {
        let now = self.clock.now();
        self.laws.must_decide(now, event, &self.estimation.estimates)
            || self.operation.due() == Some(now)
            || self.operation.is_tested(now)
    }

    /// Takes the sample of the current instant, and updates the estimates with it.
    fn take_sample(&mut self, record: &mut dyn Record) -> Result<(), SimulationError> {
        let now = self.clock.now();
        let measured = self.sensors.sample(now, &self.plant, self.estimation.origin());
        let lead_time = self.laws.lead_time();
        self.estimation.update(now, measured, &self.sensors, &self.plant, &self.loads, lead_time);
        self.trace_sample(now, measured);
        let (run, recorder) = self.view();
        Ok(recorder.record_estimates(&run, record)?)
    }

    /// Lets the laws decide on `event`, and begins a motion segment under their commands.
    fn control_step(&mut self, event: Event, record: &mut dyn Record) -> Result<(), SimulationError> {
        let now = self.clock.now();
        self.clock.count_decision()?;
        self.end_requirement_segment();
        if self.operation.tested.take().is_none_or(|test| test.at != now) {
            self.estimation.predict(now, &self.plant, &self.sensors);
            self.update_mode(record)?;
        }
        let speeds = || self.loads.wheel_speeds(now, self.plant.truth().rigid_rate);
        let decision = self.laws.decide(now, event, &self.guidance, &mut self.estimation.estimates, &speeds);
        if decision.is_switching() || matches!(event, Event::Guard { axis: 1.., .. }) {
            self.clock.count_switching()?;
        }
        self.command_actuator();
        self.begin_segment(record)?;
        let (run, recorder) = self.view();
        Ok(recorder.record_switching(&run, decision, record)?)
    }

    /// Hands the laws' commands to the actuator.
    fn command_actuator(&mut self) {
        let truth = self.plant.truth();
        self.loads.set_magnetic_field(self.clock.now(), self.sensors.magnetic_field(truth));
        let (outputs, estimates) = (self.laws.outputs(), &self.estimation.estimates);
        self.loads.command(self.clock.now(), outputs, estimates, truth.rigid_rate);
        self.trace_decision(self.clock.now());
    }

    /// Begins a motion segment under the loads from the current instant on, and finds its first guard crossing.
    fn begin_segment(&mut self, record: &mut dyn Record) -> Result<(), SimulationError> {
        let (now, axes) = (self.clock.now(), self.estimation.axis_count());
        self.plant.record_pieces(now, &self.loads.applied, record)?;
        self.sensors.end_segment(now, &self.plant, record)?;
        self.mirrors.end_segment();
        self.laws.objective.add_motion(now, &self.plant, &self.loads);
        self.loads.set_applied_torque();
        self.estimation.begin_segment(now, &self.plant, &self.loads);
        self.plant.begin_segment(self.loads.wrench(now));
        self.laws.objective.add_torque(now, axes, &self.loads);
        self.update_requirements(RequirementMonitors::begin_segment);
        self.find_crossing(record)
    }

    /// Hands the motion up to the current instant to the requirements over time, before anything of it changes.
    #[inline]
    fn end_requirement_segment(&mut self) {
        if !self.requirements.is_empty() {
            let Self { clock, plant, guidance, loads, requirements, .. } = self;
            requirements.end_segment(clock.now(), plant, guidance, loads);
        }
    }

    /// Updates the requirements over time, if there are any, from the parts of the run at the current instant.
    #[inline]
    fn update_requirements(&mut self, update: impl FnOnce(&mut RequirementMonitors, &RunView<'_>)) {
        if !self.requirements.is_empty() {
            let mut requirements = std::mem::take(&mut self.requirements);
            update(&mut requirements, &self.read_view());
            self.requirements = requirements;
        }
    }

    /// Finds the first guard crossing of the segment that begins; with a sampled sensor, guards are tested at the
    /// samples.
    fn find_crossing(&mut self, record: &mut dyn Record) -> Result<(), SimulationError> {
        self.laws.discard_crossing();
        if self.sensors.is_continuous() {
            let end = self.loads.due.into_iter().fold(self.clock.end(), Instant::min);
            self.laws.find_crossing([self.clock.now(), end], &mut self.plant, record)?;
        }
        Ok(())
    }

    /// Adds the motion at the start of a cycle of three axes to the envelope and to the adaptation's objective.
    fn add_cycle(&mut self) {
        let (now, plant, loads) = (self.clock.now(), &self.plant, &self.loads);
        self.estimation.add_cycle(now, plant);
        let (origin, estimates) = (self.estimation.origin(), &self.estimation.estimates);
        self.laws.objective.add_cycle(now, plant, origin, estimates, &self.guidance, loads);
    }

    /// Fails if a custom part cannot go on.
    #[inline]
    fn check_custom_parts(&self) -> Result<(), SimulationError> {
        if !self.has_custom_parts {
            return Ok(());
        }
        let search = self.estimation.search().or(self.laws.objective.search());
        let all: [(&str, Option<&dyn Part>); 5] = [
            ("sensor", Some(&self.sensors)),
            ("estimator", Some(&*self.estimation.estimator)),
            ("adaptation", search.map(AdaptationRun::part)),
            ("law", Some(&self.laws)),
            ("actuator", Some(&*self.loads.actuator)),
        ];
        let disturbances = self.loads.own.iter().map(|own| ("disturbance", Some(&*own.run as &dyn Part)));
        let guidance = self.guidance.own(self.clock.now()).map(|own| own as &dyn Part);
        let mut all = all.into_iter().chain(disturbances).chain([("guidance", guidance)]);
        let failed = all.find_map(|(role, part)| Some((role, part?.failure()?)));
        match failed {
            Some((role, source)) => Err(SimulationError::Own { at: self.clock.now(), role, source }),
            None => Ok(()),
        }
    }

    /// Returns the parts of the run for reading, and the recorder, which reads them.
    fn view(&mut self) -> (RunView<'_>, &mut Recorder) {
        let Self {
            clock,
            plant,
            sensors,
            estimation,
            guidance,
            laws,
            loads,
            mirrors,
            operation,
            recorder,
            ..
        } = self;
        let (now, modes, sky) = (clock.now(), operation.sequence(), &**operation.sky());
        let tested = operation.tested.as_ref();
        let run =
            RunView { now, plant, sensors, estimation, guidance, laws, loads, mirrors, modes, sky, tested };
        (run, recorder)
    }

    /// Returns the parts of the run for reading.
    fn read_view(&self) -> RunView<'_> {
        let Self { clock, plant, sensors, estimation, guidance, laws, loads, mirrors, operation, .. } = self;
        let (now, modes, sky) = (clock.now(), operation.sequence(), &**operation.sky());
        let tested = operation.tested.as_ref();
        RunView { now, plant, sensors, estimation, guidance, laws, loads, mirrors, modes, sky, tested }
    }
}
