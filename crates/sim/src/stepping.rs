//! Runs in pieces: to an instant or to the next event of a kind, stopped between sensing and the response, with
//! external commands.

use flexsc_control::actuator::Demand;
use flexsc_control::law::{Command, Event};
use flexsc_numerics::time::Instant;
use flexsc_record::Record;

use super::{Simulation, SimulationError};

/// Kind of event at which a run can be stopped.
#[derive(Copy, Clone, Debug, PartialEq, Eq)]
pub enum StopAt {
    /// A sensor has measured; estimates are updated, and the laws have not responded yet.
    Sample,
    /// A law is about to decide.
    Decision,
    /// A law has changed its state.
    Switching,
    /// A window of the envelope's mean has ended; the laws have not responded yet.
    Window,
    /// Any of the events of [`Simulation::next_event`], or a wheel sticks or slips; the laws have not responded yet.
    Any,
}

impl Simulation {
    /// Sets external commands about each axis, which replace those of the scenario's laws until the next call; the
    /// scenario's actuator executes them. A law's pending decision at the current instant is dropped.
    ///
    /// ```
    /// use flexsc_control::law::Command;
    /// use flexsc_numerics::time::{Instant, Span};
    /// use flexsc_scenario::Scenario;
    /// use flexsc_sim::Simulation;
    ///
    /// let text = "duration = 10.0\n[law.open]\n[body.planar]\ninertia = 2.0";
    /// let mut simulation = Simulation::new(&Scenario::parse("steered.toml", text)?, 0);
    /// simulation.set_external_command([Command::Torque(0.5); 3]);
    /// simulation.run_up_to(Instant::START + Span::from_seconds(4.0), &mut ())?;
    /// assert_eq!(simulation.state().map(|state| state.rigid_rate), Some(1.0));
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn set_external_command(&mut self, commands: [Command; 3]) {
        self.laws.set_external(commands);
    }

    /// Returns the first axis about which none of the actuators in use executes an external command of its quantity, such as a
    /// magnetic moment about an axis of wheels.
    pub fn unexecuted_axis(&self, commands: &[Command; 3]) -> Option<usize> {
        let demands = commands.map(|command| match command {
            Command::Torque(value) | Command::Acceleration(value) => Demand::Torque(value),
            Command::Change(value) => Demand::Change(value),
            Command::Moment(value) => Demand::Moment(value),
        });
        let (now, axes) = (self.clock.now(), self.axis_count());
        (0..axes).find(|axis| self.loads.actuator.ignores(now, *axis, &demands[..axes]))
    }

    /// Sets an external torque about each axis of the body (N m; rad/s² on a body without inertia), which acts in
    /// addition to all other loads from the current instant until the next call.
    ///
    /// ```
    /// use flexsc_numerics::time::{Instant, Span};
    /// use flexsc_scenario::Scenario;
    /// use flexsc_sim::Simulation;
    ///
    /// let text = "duration = 10.0\n[law.open]\n[body.planar]\ninertia = 2.0";
    /// let mut simulation = Simulation::new(&Scenario::parse("pushed.toml", text)?, 0);
    /// simulation.set_external_torque([0.5, 0.0, 0.0]);
    /// simulation.run_up_to(Instant::START + Span::from_seconds(4.0), &mut ())?;
    /// assert_eq!(simulation.state().map(|state| state.rigid_rate), Some(1.0));
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn set_external_torque(&mut self, torque: [f64; 3]) {
        self.loads.set_external_torque(self.clock.now(), torque);
    }

    /// Returns the torque commanded about each axis by the law or from outside (N m); for a wheel, its gain times the
    /// command.
    pub fn commanded_torque(&self) -> [f64; 3] {
        [0, 1, 2].map(
            |axis| if axis < self.axis_count() { self.loads.actuator.effort(axis).demanded } else { 0.0 },
        )
    }

    /// Returns the number of axes.
    fn axis_count(&self) -> usize {
        self.estimation.axis_count()
    }

    /// Returns the next instant at which a sensor samples, a law decides, a mode of operation is tested, a load changes
    /// or a window closes, as far as it is known now: a wheel in bearings may stick or slip earlier. Instants at which
    /// only rows are due are no events.
    pub fn next_event(&self) -> Option<Instant> {
        let due = [
            self.laws.next_event(),
            self.operation.due(),
            self.loads.due,
            self.sensors.next_event(),
            self.estimation.window_closes(),
        ];
        due.into_iter().flatten().min()
    }

    /// Returns the next instant at which a sensor samples, or an exposure opens or closes; `None` with a continuous sensor.
    pub fn next_sample(&self) -> Option<Instant> {
        self.sensors.next_event()
    }

    /// Returns the end of the run.
    pub fn end(&self) -> Instant {
        self.clock.end()
    }

    /// Completes the instant at which the run was stopped: the response to its event, and everything else that is due.
    /// Returns true if a law has switched.
    ///
    /// # Errors
    /// Fails like [`Simulation::run_until`].
    pub fn complete_instant(&mut self, record: &mut dyn Record) -> Result<bool, SimulationError> {
        self.open(record)?;
        let (now, axes) = (self.clock.now(), self.axis_count());
        let before = self.laws.phases(axes);
        self.resume(None, record)?;
        while self.advance_to_next(now, record)? {
            self.process_instant(record)?;
        }
        self.finish(record)?;
        Ok(self.laws.phases(axes) != before)
    }

    /// Returns the current instant of the run.
    pub fn time(&self) -> Instant {
        self.clock.now()
    }

    /// Returns true if the run is at its end.
    pub fn is_finished(&self) -> bool {
        self.clock.now() == self.clock.end()
    }

    /// Reads the sensors for the first sample, if the run has not begun, so that measurements and estimates exist.
    ///
    /// # Errors
    /// Fails like [`Simulation::run_until`].
    pub fn open(&mut self, record: &mut dyn Record) -> Result<(), SimulationError> {
        if let Some(key) = self.loads.measured_path() {
            return Err(SimulationError::MeasuredPath { key: key.clone() });
        }
        let now = self.clock.now();
        if self.recorder.open(now, record)? {
            self.plant.evaluate(now)?;
            self.sensors.begin_blinding(&self.plant);
            self.take_sample(record)?;
            self.laws.pending_event = Some(Event::Start);
        }
        Ok(())
    }

    /// Runs to `until`, or to the end of the scenario if that is earlier. Samples that are due there are taken; the
    /// response follows when the run goes on, so commands set in between act from this instant. Stopping a run does not
    /// change its results.
    ///
    /// # Errors
    /// Fails like [`Simulation::run_until`].
    pub fn run_up_to(&mut self, until: Instant, record: &mut dyn Record) -> Result<(), SimulationError> {
        self.run_pieces(until, None, record).map(|_| ())
    }

    /// Runs to the next event of a kind, at most to `until`; returns true if it occurred.
    ///
    /// # Errors
    /// Fails like [`Simulation::run_until`].
    pub fn run_to_next(
        &mut self,
        occasion: StopAt,
        until: Instant,
        record: &mut dyn Record,
    ) -> Result<bool, SimulationError> {
        self.run_pieces(until, Some(occasion), record)
    }

    /// Completes the record of the current segment when the run is abandoned before its end.
    ///
    /// # Errors
    /// Fails if the record cannot be written.
    pub fn record_interruption(&self, record: &mut dyn Record) -> Result<(), SimulationError> {
        if !self.is_finished() {
            let now = self.clock.now();
            self.plant.record_pieces(now, &self.loads.applied, record)?;
            self.recorder.journal_interruption(now, record)?;
        }
        Ok(())
    }

    fn run_pieces(
        &mut self,
        until: Instant,
        occasion: Option<StopAt>,
        record: &mut dyn Record,
    ) -> Result<bool, SimulationError> {
        let until = until.min(self.clock.end());
        self.open(record)?;
        if until <= self.clock.now() && !self.is_finished() {
            return Ok(false);
        }
        let mut came = self.resume(occasion, record)?;
        while !came && self.advance_to_next(until, record)? {
            let now = self.clock.now();
            let closes = self.estimation.window_closes() == Some(now);
            let is_event = self.next_event() == Some(now) || self.clock.has_bearing_event();
            let event = self.sense(record)?;
            came = match occasion {
                Some(StopAt::Sample) => event == Event::Due { sampled: true },
                Some(StopAt::Decision) => self.must_decide(event),
                Some(StopAt::Window) => closes,
                Some(StopAt::Any) => is_event,
                Some(StopAt::Switching) | None => false,
            };
            self.laws.pending_event = Some(event);
            if (came || now == until) && !self.is_finished() {
                return Ok(came);
            }
            // At the end of the run, the response follows immediately.
            came |= self.resume(occasion, record)?;
            if came && self.is_finished() {
                return self.run_until(until, record).map(|()| true);
            }
        }
        if !came {
            self.finish(record)?;
        }
        Ok(came)
    }

    /// Responds to the event at which the run was stopped, or to external commands set since; returns true if
    /// `occasion` is a switching and a law has switched.
    pub(super) fn resume(
        &mut self,
        occasion: Option<StopAt>,
        record: &mut dyn Record,
    ) -> Result<bool, SimulationError> {
        let event = self.laws.pending_event.take();
        let is_external = self.laws.external_command_pending;
        let Some(event) = event.or(is_external.then_some(Event::Due { sampled: false })) else {
            return Ok(false);
        };
        let before = self.laws.phases(self.axis_count());
        if event == Event::Start {
            self.begin(record)?;
            return Ok(false);
        }
        if is_external {
            // No law has decided here, for which the target would have been set.
            self.estimation.update_angle_origin(self.clock.now(), &mut self.guidance);
        }
        self.respond(event, record)?;
        let after = self.laws.phases(self.axis_count());
        Ok(occasion == Some(StopAt::Switching) && after != before)
    }
}
