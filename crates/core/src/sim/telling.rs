//! Rows of a run: when they are due, and their content.

use super::accelerometers::Accelerometers;
use super::arrival::Arrival;
use super::events::Events;
use super::failing::Failures;
use super::plant::{Plant, SpatialPlant};
use super::reference::Reference;
use super::{Simulation, SimulationError};
use crate::actuator::Saturation;
use crate::law::{Cause, Phase};
use crate::motion::turning::Slip;
use crate::record::{
    self, AxisRate, Command, Estimates, GoalMotion, Jets, Motion, Rates, Record, RecordError, Sample,
    SpatialCycle, SpatialMotion, Torques, Trigger, Wheels,
};
use crate::scenario::Scenario;
use crate::scene::Scene;
use crate::time::{Instant, Span};

/// Schedule and memory of everything that a run writes to its record.
#[derive(Clone, Debug)]
pub struct Telling {
    /// Detector of state changes for the journal.
    pub events: Events,
    /// Scene of the run; `None` if it is not drawn.
    pub scene: Option<Box<Scene>>,
    /// Instant at which the frames of the scene are due next.
    pub next_frames: Option<Instant>,
    /// Period of the rows of a dense record.
    pub log_period: Span,
    next_dense: Option<Instant>,
    /// Torques of the pulses of thrusters that were on at the last row (N m).
    firing: [f64; 3],
    next_law: Instant,
    /// Period of the cycle rows of a three-axis body.
    cycle: Option<Span>,
    /// Slip states of the wheels as last recorded.
    pub slips: Vec<Slip>,
    /// Number of jet pulses that are already recorded.
    pulses: u64,
    next_cycle: Option<Instant>,
    /// How wheels and magnetorquers reach their limits.
    saturation: Saturation,
    /// Pending end of the manoeuvre, if any.
    arrival: Option<Arrival>,
    /// Accelerometers of the run, which only the record reads.
    pub accelerometers: Accelerometers,
    /// Pending beginnings and ends of failures.
    pub failures: Failures,
    /// True if the torque consists of more than the switchings of a law.
    tells_torque: bool,
    /// True if jets are the only actuator.
    jets_alone: bool,
    stage: Stage,
}

/// Stage of the journal: not yet opened, open, or closed.
#[derive(Copy, Clone, Debug, PartialEq, Eq)]
enum Stage {
    Before,
    Within,
    After,
}

impl Telling {
    /// Creates the schedule of a scenario's run, before its start.
    pub fn new(scenario: &Scenario, reference: &Reference, run: u64) -> Self {
        Self {
            events: Events::new(scenario, run),
            scene: None,
            next_frames: None,
            log_period: scenario.log_period(),
            next_dense: None,
            firing: [0.0; 3],
            next_law: Instant::START,
            cycle: scenario.model.spatial().map(|_| scenario.study.tick),
            slips: Vec::new(),
            pulses: 0,
            next_cycle: None,
            saturation: Saturation::new(&scenario.actuator, scenario.duration.seconds()),
            arrival: Arrival::new(scenario, &reference.goal),
            accelerometers: Accelerometers::new(scenario, run),
            failures: Failures::new(scenario),
            tells_torque: scenario.tells_torque(),
            jets_alone: scenario.study.jets_alone,
            stage: Stage::Before,
        }
    }

    /// Enables drawing of the scenario's scene.
    pub fn draw(&mut self, scenario: &Scenario) {
        self.scene = Some(Box::new(Scene::new(scenario)));
    }

    /// Opens the journal once; returns true if this call opened it.
    pub fn open(&mut self, now: Instant, record: &mut dyn Record) -> Result<bool, RecordError> {
        if self.stage != Stage::Before {
            return Ok(false);
        }
        self.stage = Stage::Within;
        self.events.begin(now, record)?;
        Ok(true)
    }

    /// Marks the journal as closed; returns true the first time.
    pub fn close(&mut self) -> bool {
        std::mem::replace(&mut self.stage, Stage::After) != Stage::After
    }

    /// The last lines of the journal.
    pub fn journal_end(&self, now: Instant, record: &mut dyn Record) -> Result<(), RecordError> {
        if let Some(line) = self.saturation.warning() {
            self.events.warned(now, "actuators", line, record)?;
        }
        self.events.end(now, record)
    }

    /// Returns the instant at which the next row or journal line is due.
    pub fn due(&self) -> Option<Instant> {
        let arrives = self.arrival.as_ref().map(|arrival| arrival.at);
        let told = earlier(earlier(arrives, self.next_dense), earlier(self.next_frames, self.next_cycle));
        earlier(told, earlier(self.failures.due(), self.accelerometers.due()))
    }
}

/// Returns the earlier of two optional instants.
fn earlier(a: Option<Instant>, b: Option<Instant>) -> Option<Instant> {
    match (a, b) {
        (Some(a), Some(b)) => Some(a.min(b)),
        _ => a.or(b),
    }
}

impl Simulation {
    /// Records the rows of the start.
    pub(super) fn tell_begin(&mut self, record: &mut dyn Record) -> Result<(), SimulationError> {
        let now = self.now;
        if let Plant::Planar(_) = self.plant {
            record.record(now, Sample::Begin(&self.law_row()))?;
        }
        if record.dense() {
            self.telling.next_dense = Some(now);
            self.telling.next_law = now + Span::from_seconds(1.0);
        }
        self.telling.next_cycle = self.telling.cycle.map(|_| now);
        self.set_the_scene(record)
    }

    /// Records the rows that are due at the current instant, after all parts have acted.
    pub(super) fn tell(&mut self, record: &mut dyn Record) -> Result<(), SimulationError> {
        let now = self.now;
        if self.telling.next_cycle == Some(now) {
            self.telling.next_cycle = self.telling.cycle.map(|cycle| now + cycle);
            self.tell_cycle(record)?;
        }
        let Some(due) = self.telling.next_dense else { return Ok(()) };
        // A pulse that begins or ends has a row of its own, or a log could miss it.
        let firing = [0, 1, 2].map(|axis| self.drive.actuator.firing(axis));
        let pulses = std::mem::replace(&mut self.telling.firing, firing) != firing;
        if due == now {
            self.telling.next_dense = Some(now + self.telling.log_period);
        }
        if due == now || pulses {
            self.plant.view(now)?;
            match &self.plant {
                Plant::Planar(_) => self.tell_motion(record)?,
                Plant::Spatial(plant) => {
                    record.record(now, Sample::SpatialMotion(&self.spatial_motion(plant)))?;
                }
            }
            if due == now && now >= self.telling.next_law {
                if let Plant::Planar(_) = self.plant {
                    record.record(now, Sample::Law(&self.law_row()))?;
                }
                self.telling.next_law += Span::from_seconds(1.0);
            }
        }
        Ok(())
    }

    /// Records the end of the manoeuvre, if it is at the current instant.
    pub(super) fn tell_arrival(&mut self, record: &mut dyn Record) -> Result<(), SimulationError> {
        let now = self.now;
        let Some(arrival) = self.telling.arrival.take_if(|arrival| arrival.at == now) else { return Ok(()) };
        self.plant.view(now)?;
        let row = arrival.row(self.plant.viewed(), &self.plant.about(0, &self.origin));
        record.record(now, Sample::Arrival(&row))?;
        Ok(self.telling.events.arrived(now, &row, record)?)
    }

    /// Records a switching of the one-axis law, if its state was `before` and has changed, with the sensed angle (rad)
    /// and rate (rad/s) and the commanded torque.
    pub(super) fn tell_switching(
        &self,
        before: Phase,
        cause: Option<Cause>,
        [angle_rad, rate_rad_s]: [f64; 2],
        record: &mut dyn Record,
    ) -> Result<(), SimulationError> {
        let (now, state) = (self.now, self.laws.about(0).state());
        let Plant::Planar(plant) = &self.plant else { return Ok(()) };
        if before == state {
            return Ok(());
        }
        let (time_s, time_whole_s, time_fs) = Command::times(now);
        let command = Command {
            time_s,
            time_whole_s,
            time_fs,
            state,
            cause: if cause == Some(Cause::Timeout) { Trigger::Timeout } else { Trigger::Guard },
            torque_nm: self.drive.actuator.asked(0),
            angle_rad,
            rate_rad_s,
            gain: self.laws.about(0).tuned(),
        };
        record.record(now, Sample::Switching(&command, plant.state()))?;
        if record.dense() {
            self.tell_motion(record)?;
        }
        Ok(())
    }

    /// Records the estimates after the current sample, and journals losses of lock.
    pub(super) fn tell_estimates(&mut self, record: &mut dyn Record) -> Result<(), SimulationError> {
        let now = self.now;
        self.telling.events.lost(now, self.estimator.lost(), self.beliefs.len(), record)?;
        if !record.estimates() {
            return Ok(());
        }
        let truth = self.plant.view(now)?.orientation;
        if let Some(row) = self.estimator.attitude(now, &truth, self.sensing.bias()) {
            record.record(now, Sample::AttitudeEstimate(&row))?;
            let modes = self.estimator.elastic();
            return Ok(modes.map_or(Ok(()), |row| record.record(now, Sample::ElasticEstimates(&row)))?);
        }
        let of = |axis: usize| self.estimator.estimate(axis, now, &self.plant.about(axis, &self.origin));
        if self.beliefs.len() == 1 {
            return Ok(of(0).map_or(Ok(()), |row| record.record(now, Sample::Estimate(&row)))?);
        }
        let axes: Option<Vec<_>> = (0..self.beliefs.len()).map(of).collect();
        Ok(axes.map_or(Ok(()), |axes| record.record(now, Sample::Estimates(&Estimates { axes })))?)
    }

    pub(super) fn law_row(&self) -> record::Law {
        let law = self.laws.about(0);
        record::Law { state: law.state(), torque_nm: self.drive.actuator.asked(0), gain: law.tuned() }
    }

    /// Records the motion of a one-axis body at the current instant, for a dense record.
    pub(super) fn tell_motion(&self, record: &mut dyn Record) -> Result<(), RecordError> {
        let (Plant::Planar(plant), now) = (&self.plant, self.now) else { return Ok(()) };
        let sampled = self.sensing.next.is_some();
        let measured = self.sensing.reading.map_or(0.0, |_| self.sensing.measured[0][0]);
        let (attitude, rate, modes) = plant.motion(sampled.then_some(measured));
        let envelope = self.monitor.as_ref().map(|monitor| monitor.envelope(now));
        let (actuator, rates) = (&self.drive.actuator, [rate.rate_rad_s, rate.rigid_rad_s]);
        let drive = self.telling.tells_torque.then(|| {
            let (angle_rad, rate_rad_s) = self.reference.at(now);
            let torque = record::Torque {
                feedforward_nm: self.reference.feedforward(now),
                feedback_nm: actuator.asked(0),
                applied_nm: actuator.applied(now, 0, rates),
                disturbance_nm: self.drive.disturbance(now, 0),
            };
            (GoalMotion { angle_rad, rate_rad_s }, torque)
        });
        let wheel = actuator.wheel(0, rate.rigid_rad_s);
        let motion = Motion { attitude, rate, modes, outputs: plant.outputs(), drive, wheel, envelope };
        record.record(now, Sample::Motion(&motion))
    }

    /// Records the cycle row of a three-axis body and of its estimator; also updates the angle origin and the
    /// adaptation's objective.
    fn tell_cycle(&mut self, record: &mut dyn Record) -> Result<(), SimulationError> {
        let now = self.now;
        self.plant.view(now)?;
        // The origin follows the targets also if no law is asked.
        self.turn_to_target(now);
        let origin = self.origin;
        self.measure_cycle();
        if let Plant::Spatial(plant) = &self.plant {
            let truth = plant.viewed();
            let error = truth.orientation.beyond(&origin);
            let (rigid, elastic) = plant.rates();
            let jets = self.drive.actuator.cycle();
            let [roll_on_s, pitch_on_s, yaw_on_s] = jets.as_ref().map_or([0.0; 3], |cycle| cycle.on);
            let fuel_kg = jets.as_ref().map_or(f64::NAN, |cycle| cycle.fuel);
            let fuels_kg = jets.as_ref().map_or_else(Vec::new, |cycle| cycle.fuels.clone());
            let pulses = jets.as_ref().map_or(0, |cycle| cycle.pulses);
            let thrusters = jets.map_or_else(Vec::new, |cycle| cycle.each);
            // Jets may have cycles of their own, which are longer.
            let pulses = pulses - std::mem::replace(&mut self.telling.pulses, pulses);
            let (elastic_energy_j, visible_energy_j) = plant.elastic_energies();
            let torquers = self.drive.actuator.magnetic();
            let moments = torquers.into_iter().flat_map(|torquers| torquers.axes);
            let cycle = SpatialCycle {
                fuels_kg,
                slewing: self.reference.slews(now),
                wheels: self.drive.actuator.wheels(now, (rigid + elastic).into()),
                moments_am2: moments.map(|axis| axis.moment_am2).collect(),
                jets: Jets { roll_on_s, pitch_on_s, yaw_on_s, fuel_kg },
                thrusters,
                pulses,
                elastic_energy_j,
                visible_energy_j,
                rigid_rate_rad_s: rigid.into(),
                elastic_rate_rad_s: elastic.into(),
                error_rad: error,
                stored_nm_s: self.drive.actuator.stored(now),
                steered: self.drive.actuator.steered(),
                friction_heat_j: plant.friction_heat(),
            };
            self.telling.saturation.see(now.seconds(), &cycle);
            record.record(now, Sample::Cycle(&cycle))?;
            if let Some(written) = self.reference.written(now) {
                let error = || truth.orientation.beyond(&self.reference.target(now));
                self.telling.events.target(now, written, error, record)?;
            }
            if self.estimates {
                let damped = || self.laws.damped();
                let Some(tracking) = self.estimator.tracking(&|| plant.mode_rates().collect(), &damped)
                else {
                    return Ok(());
                };
                record.record(now, Sample::Tracking(&tracking))?;
                let trusted = |axis: usize| self.beliefs[axis].trusted;
                self.telling.events.damping(now, &damped(), [0, 1, 2].map(trusted), record)?;
            }
        }
        Ok(())
    }

    pub(super) fn spatial_motion(&self, plant: &SpatialPlant) -> SpatialMotion {
        let truth = plant.viewed();
        let (rigid, elastic) = plant.rates();
        let axis = |axis: usize| AxisRate {
            rate_rad_s: rigid[axis] + elastic[axis],
            rigid_rad_s: rigid[axis],
            elastic_rad_s: elastic[axis],
            measured_rad_s: self.sensing.measured[axis][1],
            believed_rad_s: self.beliefs[axis].rate,
        };
        let actuator = &self.drive.actuator;
        let (around, magnetic) = (plant.surroundings(), plant.magnetic());
        let torque = |axis: usize| record::Torque {
            feedforward_nm: 0.0,
            feedback_nm: actuator.asked(axis),
            applied_nm: magnetic[axis]
                + actuator.applied(self.now, axis, [rigid[axis] + elastic[axis], rigid[axis]]),
            disturbance_nm: {
                let others = self.drive.disturbance(self.now, axis);
                around.map_or(others, |around| others + around[axis])
            },
        };
        let wheels = actuator.wheels(self.now, (rigid + elastic).into());
        // If only jets act, the torques follow from the recorded pulses.
        let alone = self.telling.jets_alone && !plant.is_surrounded();
        let torques = (!alone).then(|| Torques { axes: [0, 1, 2].map(torque).into() });
        SpatialMotion {
            pointing: plant.pointing(truth.orientation.beyond(&self.reference.origin(self.now))),
            rates: Rates { axes: [0, 1, 2].map(axis).into() },
            vibrations: plant.vibrations(),
            energy: plant.energy(),
            position: plant.position(),
            torques,
            wheels: (!wheels.is_empty()).then_some(Wheels { wheels }),
            gimbals: actuator.gimbals(self.now),
            orbit: plant.orbit(),
            magnetorquers: actuator.magnetic(),
            envelope: self.monitor.as_ref().map(|monitor| monitor.envelope(self.now)),
            bearings: self.bearings(plant),
            drives: plant.drives(),
            hinges: plant.hinges(),
        }
    }
}
