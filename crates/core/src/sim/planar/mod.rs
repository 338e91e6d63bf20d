//! A run of a body with one angle.
//!
//! At one instant, in this order: the body arrives, the sensor samples, the estimator takes the sample or closes its window, the
//! adaptation learns, the law decides once, the record is told. Between events the input is constant and the
//! body's flow exact. `docs/events.md` states the rules.

mod arrival;
mod drive;
mod plant;
mod show;
mod track;
mod watch;

use super::SimulationError;
use super::journal::{Journal, opening};
use crate::belief::Belief;
use crate::body::{Sight, State};
use crate::law::{Cause, Goal, Hold, Law};
use crate::random::{Seed, Stream};
use crate::record::foxglove::Level;
use crate::record::{self, Command, Course, GoalMotion, Motion, Record, RecordError, Sample, Trigger};
use crate::scenario::Scenario;
use crate::scene::PlanarScene;
use crate::sensor::{Measurement, Sensor};
use crate::time::{Instant, Span};

use arrival::Arrival;
use drive::Drive;
use plant::{Exerted, Plant};
use track::Track;
use watch::Watch;

/// More decisions than this at one instant are chatter: no scenario's law needs more than a few.
const MOST_DECISIONS: u32 = 32;

/// All that moves in a run of a body with one angle.
#[derive(Clone, Debug)]
pub struct PlanarRun {
    now: Instant,
    end: Instant,
    body: Plant,
    sensor: Sensor,
    noise: Stream,
    /// The last measurement.
    measured: Option<Measurement>,
    watch: Option<Watch>,
    track: Option<Track>,
    law: Law,
    drive: Drive,
    /// The torques of the present motion.
    exerted: Exerted,
    /// The end of the manoeuvre that lies ahead, if any.
    arrival: Option<Arrival>,
    goal: Goal,
    /// What the law reads. The adaptation writes its gain.
    pub belief: Belief,
    hold: Hold,
    /// The instant and index of the guard that trips next, as long as the hold lasts.
    trip: Option<(Instant, usize)>,
    next_sample: Option<Instant>,
    log_period: Span,
    next_dense: Option<Instant>,
    next_law: Instant,
    /// The scene, and when its frames are due.
    scene: Option<Box<PlanarScene>>,
    next_frames: Option<Instant>,
    decisions: u32,
    journal: Journal,
    /// The journal's first line, until it is written.
    opening: Option<String>,
    ended: bool,
}

impl PlanarRun {
    /// A run of a scenario, before its start.
    pub fn new(scenario: &Scenario, run: u64) -> Self {
        let seed = Seed { scenario: scenario.seed, run };
        Self {
            now: Instant::START,
            end: Instant::START + scenario.duration,
            body: Plant::new(scenario),
            sensor: scenario.sensor.clone(),
            noise: seed.stream("sensor"),
            measured: None,
            watch: Watch::new(scenario, seed),
            track: Track::new(scenario, seed),
            law: scenario.law.clone(),
            drive: Drive::new(scenario, seed),
            exerted: Exerted::default(),
            arrival: Arrival::new(scenario),
            goal: scenario.goal(),
            belief: Belief { gain: scenario.law.gain(), ..Belief::default() },
            hold: Hold::NONE,
            trip: None,
            next_sample: scenario.sensor.period().map(|period| Instant::START + period),
            log_period: scenario.log_period(),
            next_dense: None,
            next_law: Instant::START,
            scene: None,
            next_frames: None,
            decisions: 0,
            journal: Journal::new(scenario),
            opening: Some(opening(scenario, run)),
            ended: false,
        }
    }

    /// Draws this scene for records that want one.
    pub fn draw(&mut self, scene: PlanarScene) {
        self.scene = Some(Box::new(scene));
    }

    /// Runs to an instant, or to the end of the scenario if that is earlier, everything that is due then included.
    pub fn run_until(&mut self, until: Instant, record: &mut impl Record) -> Result<(), SimulationError> {
        let until = until.min(self.end);
        if let Some(opening) = self.opening.take() {
            self.journal.tell(self.now, (Level::Info, "run"), opening, record)?;
            self.begin(record)?;
        }
        loop {
            let next = self.next();
            self.body.approach(next.min(until), record)?;
            if next > until {
                self.now = until;
                self.view()?;
                return self.end(record);
            }
            if next > self.now {
                self.now = next;
                self.decisions = 0;
            }
            self.serve(record)?;
        }
    }

    /// The mean of the total envelope over the window that was closed last (rad).
    pub fn window_mean(&self) -> Option<f64> {
        self.watch.as_ref().map(|watch| watch.mean)
    }

    /// The state of the body now.
    pub fn state(&self) -> &State {
        self.body.state()
    }

    fn begin(&mut self, record: &mut impl Record) -> Result<(), SimulationError> {
        let sight = self.view()?;
        let measured = self.sensor.measure(self.now, (sight.angle, sight.rate), None, &mut self.noise);
        self.measured = measured;
        self.belief.angle = measured.map_or(0.0, |measured| measured.angle);
        self.belief.rate = measured.map_or(0.0, |measured| measured.rate.unwrap_or(sight.rate));
        self.estimate(measured.is_some(), record)?;
        self.hold = self.law.decide(self.now, Cause::Start, &self.goal, &self.belief);
        let rigid_rate = self.body.state().rigid_rate;
        self.drive.command(self.now, self.hold.torque, rigid_rate);
        self.drive.serve(self.now, rigid_rate);
        self.depart(record)?;
        record.record(self.now, Sample::Begin(&self.law_row()))?;
        if record.dense() {
            self.next_dense = Some(self.now);
            self.next_law = self.now + Span::from_seconds(1.0);
        }
        self.set_the_scene(record)?;
        Ok(())
    }

    /// Ends the run, if this is its end and it has not ended yet.
    fn end(&mut self, record: &mut impl Record) -> Result<(), SimulationError> {
        if self.now == self.end && !std::mem::replace(&mut self.ended, true) {
            self.tell_course(record)?;
            let line = "the end of the run".to_owned();
            self.journal.tell(self.now, (Level::Info, "run"), line, record)?;
        }
        Ok(())
    }

    /// The next instant at which anything is due.
    fn next(&self) -> Instant {
        let trip = self.trip.map(|(at, _)| at);
        let closes = self.watch.as_ref().map(|watch| watch.closes);
        let arrives = self.arrival.as_ref().map(|arrival| arrival.at);
        let (hold, drive, sample) = (self.hold.until, self.drive.due, self.next_sample);
        let due = [trip, hold, drive, sample, closes, arrives, self.next_dense, self.next_frames];
        due.into_iter().fold(self.end + Span::TICK, |next, due| due.map_or(next, |due| next.min(due)))
    }

    /// Does what is due now.
    fn serve(&mut self, record: &mut impl Record) -> Result<(), SimulationError> {
        let now = self.now;
        let mut tripped = self.trip.filter(|(at, _)| *at == now).map(|(_, guard)| guard);
        if self.next_sample == Some(now) {
            self.sample(record)?;
            tripped = self.hold.guards.iter().position(|guard| guard.holds(self.belief.angle));
        }
        if self.watch.as_ref().is_some_and(|watch| watch.closes == now) {
            self.view()?;
            if let Some(watch) = &mut self.watch {
                watch.close(now, self.body.state(), &mut self.belief.gain, record)?;
            }
        }
        if let Some(arrival) = self.arrival.take_if(|arrival| arrival.at == now) {
            let sight = self.view()?;
            let row = arrival.row(sight, self.body.state());
            record.record(now, Sample::Arrival(&row))?;
            let line = format!(
                "the manoeuvre ends {:.3e} rad from its goal, with a vibration of {:.3e} rad",
                row.angle_error_rad, row.angle_residual_rad
            );
            self.journal.tell(now, (Level::Info, "manoeuvre"), line, record)?;
        }
        let timeout = self.hold.until.filter(|until| *until == now).map(|_| Cause::Timeout);
        if let Some(cause) = tripped.map(Cause::Guard).or(timeout) {
            self.decide(cause, record)?;
        }
        if self.drive.due == Some(now) {
            self.view()?;
            self.drive.serve(now, self.body.state().rigid_rate);
            self.depart(record)?;
        }
        if self.next_dense == Some(now) {
            self.view()?;
            record.record(now, Sample::Motion(&self.motion()))?;
            self.next_dense = Some(now + self.log_period);
            if now >= self.next_law {
                record.record(now, Sample::Law(&self.law_row()))?;
                self.next_law += Span::from_seconds(1.0);
            }
        }
        self.show(record)
    }

    /// Takes the sample of a sampled sensor, which the estimator follows.
    fn sample(&mut self, record: &mut impl Record) -> Result<(), SimulationError> {
        let Some(period) = self.sensor.period() else { return Ok(()) };
        let sight = self.view()?;
        let before = self.measured;
        let measured = self.sensor.measure(self.now, (sight.angle, sight.rate), before, &mut self.noise);
        // Without a measurement the belief stays what it was.
        if let Some(measured) = measured {
            let difference = (measured.angle - self.belief.angle) / period.seconds();
            self.belief.rate = measured.rate.unwrap_or(difference);
            self.belief.angle = measured.angle;
            self.measured = Some(measured);
        }
        self.next_sample = Some(self.now + period);
        self.estimate(measured.is_some(), record)?;
        Ok(())
    }

    /// Lets the estimator take the sample that was measured last, if there was one.
    fn estimate(&mut self, measured: bool, record: &mut impl Record) -> Result<(), RecordError> {
        let Self { track, body, belief, now, .. } = self;
        track.as_mut().map_or(Ok(()), |track| track.sample(*now, body.state(), belief, measured, record))
    }

    fn decide(&mut self, cause: Cause, record: &mut impl Record) -> Result<(), SimulationError> {
        let now = self.now;
        self.decisions += 1;
        if self.decisions > MOST_DECISIONS {
            return Err(SimulationError::Chatter { at: now, count: self.decisions });
        }
        let sight = self.view()?;
        if self.next_sample.is_none() {
            (self.belief.angle, self.belief.rate) = (sight.angle, sight.rate);
        }
        let before = self.law.state();
        self.hold = self.law.decide(now, cause, &self.goal, &self.belief);
        self.drive.command(now, self.hold.torque, self.body.state().rigid_rate);
        self.depart(record)?;
        if before == self.law.state() {
            return Ok(());
        }
        let (time_s, time_whole_s, time_fs) = Command::times(now);
        let command = Command {
            time_s,
            time_whole_s,
            time_fs,
            state: self.law.state(),
            cause: if cause == Cause::Timeout { Trigger::Timeout } else { Trigger::Guard },
            torque_nm: self.drive.asked(self.hold.torque),
            angle_rad: sight.angle,
            rate_rad_s: sight.rate,
            gain: self.belief.gain,
        };
        record.record(now, Sample::Switching(&command, self.body.state()))?;
        if record.dense() {
            record.record(now, Sample::Motion(&self.motion()))?;
        }
        Ok(())
    }

    /// Tells the motion that ends now, stretch by stretch, where the record wants it.
    fn tell_course(&self, record: &mut impl Record) -> Result<(), RecordError> {
        let (body, now) = (&self.body, self.now);
        match record.course() {
            Course::None => Ok(()),
            Course::Beyond(band) if body.stays_within(band, now, record)? => Ok(()),
            _ => body.walk(now, &self.exerted, |stretch| record.stretch(now, stretch)),
        }
    }

    /// Begins a motion under what drives the body from now on, and finds the next trip.
    fn depart(&mut self, record: &mut impl Record) -> Result<(), RecordError> {
        self.tell_course(record)?;
        self.exerted = self.drive.exerted();
        if let Some(watch) = &mut self.watch {
            watch.command(self.now, self.body.state(), self.hold.torque);
        }
        if let Some(track) = &mut self.track {
            track.command(self.now, self.drive.held_moment());
        }
        self.body.depart(&self.drive.input(self.now));
        self.trip = None;
        // A sampled sensor trips its guards at samples.
        if self.next_sample.is_none() && !self.hold.guards.is_empty() {
            let ends = [self.hold.until, self.drive.due].into_iter().flatten().fold(self.end, Instant::min);
            self.trip = self.body.trip(&self.hold.guards, ends.since(self.now), record)?;
        }
        Ok(())
    }

    /// What a sensor would see now.
    fn view(&mut self) -> Result<Sight, SimulationError> {
        let sight = self.body.view(self.now);
        if sight.angle.is_finite() && sight.rate.is_finite() {
            Ok(sight)
        } else {
            Err(SimulationError::NonFinite { at: self.now })
        }
    }

    fn law_row(&self) -> record::Law {
        let torque_nm = self.drive.asked(self.hold.torque);
        record::Law { state: self.law.state(), torque_nm, gain: self.belief.gain }
    }

    /// The motion now, for a dense record.
    fn motion(&self) -> Motion {
        let measured = self.next_sample.map(|_| self.belief.angle);
        let (attitude, rate, modes) = self.body.motion(measured);
        let envelope = self.watch.as_ref().map(|watch| watch.envelope(self.now));
        let drive = self.drive.is_worth_telling.then(|| {
            let (angle_rad, rate_rad_s) = self.drive.rigid_goal(&self.goal, self.now);
            let (rate, rigid) = (rate.rate_rad_s, rate.rigid_rad_s);
            (GoalMotion { angle_rad, rate_rad_s }, self.drive.torque(self.now, rate, rigid))
        });
        let wheel = self.drive.wheel(rate.rigid_rad_s);
        Motion { attitude, rate, modes, outputs: self.body.outputs(), drive, wheel, envelope }
    }
}
