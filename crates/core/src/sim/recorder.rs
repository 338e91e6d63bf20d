//! Rows of a run: when they are due, and their content.

use flexsc_control::actuator::Saturation;
use flexsc_control::law::{DecisionCause, Phase};
use flexsc_dynamics::three_axis::SlipDirection;
use flexsc_numerics::time::{Instant, Span};
use flexsc_record::{
    self, AxisRate, Command, Estimates, GoalMotion, Jets, Motion, Rates, Record, RecordError, Sample,
    ThreeAxisCycle, ThreeAxisMotionSample, Torques, Trigger, Wheels,
};

use super::accelerometers::Accelerometers;
use super::failures::Failures;
use super::guidance::Guidance;
use super::journal_events::JournalEvents;
use super::manoeuvre_end::ManoeuvreEnd;
use super::plant::{Plant, ThreeAxisPlant};
use super::{Simulation, SimulationError};
use crate::scenario::Scenario;
use crate::scene::Scene;

/// Schedule and memory of everything that a run writes to its record.
#[derive(Clone, Debug)]
pub struct Recorder {
    /// Detector of state changes for the journal.
    pub events: JournalEvents,
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
    cycle_period: Option<Span>,
    /// Slip states of the wheels as last recorded.
    pub recorded_slips: Vec<SlipDirection>,
    /// Number of jet pulses that are already recorded.
    recorded_pulses: u64,
    next_cycle: Option<Instant>,
    /// How wheels and magnetorquers reach their limits.
    saturation: Saturation,
    /// Pending end of the manoeuvre, if any.
    arrival: Option<ManoeuvreEnd>,
    /// Accelerometers of the run, which only the record reads.
    pub accelerometers: Accelerometers,
    /// Pending beginnings and ends of failures.
    pub failures: Failures,
    /// True if the torque consists of more than the switchings of a law.
    has_torque_rows: bool,
    /// True if jets are the only actuator.
    jets_only: bool,
    stage: JournalStage,
}

/// Stage of the journal: not yet opened, open, or closed.
#[derive(Copy, Clone, Debug, PartialEq, Eq)]
enum JournalStage {
    Before,
    Within,
    After,
}

impl Recorder {
    /// Creates the schedule of a scenario's run, before its start.
    pub fn new(scenario: &Scenario, reference: &Guidance, run: u64) -> Self {
        Self {
            events: JournalEvents::new(scenario, run),
            scene: None,
            next_frames: None,
            log_period: scenario.log_period(),
            next_dense: None,
            firing: [0.0; 3],
            next_law: Instant::START,
            cycle_period: scenario.model.spatial().map(|_| scenario.study.assessment_period),
            recorded_slips: Vec::new(),
            recorded_pulses: 0,
            next_cycle: None,
            saturation: Saturation::new(&scenario.actuator, scenario.duration.seconds()),
            arrival: ManoeuvreEnd::new(scenario, &reference.setpoint),
            accelerometers: Accelerometers::new(scenario, run),
            failures: Failures::new(scenario),
            has_torque_rows: scenario.has_torque_rows(),
            jets_only: scenario.study.jets_alone,
            stage: JournalStage::Before,
        }
    }

    /// Enables drawing of the scenario's scene.
    pub fn draw(&mut self, scenario: &Scenario) {
        self.scene = Some(Box::new(Scene::new(scenario)));
    }

    /// Opens the journal once; returns true if this call opened it.
    pub fn open(&mut self, now: Instant, record: &mut dyn Record) -> Result<bool, RecordError> {
        if self.stage != JournalStage::Before {
            return Ok(false);
        }
        self.stage = JournalStage::Within;
        self.events.begin(now, record)?;
        Ok(true)
    }

    /// Marks the journal as closed; returns true the first time.
    pub fn close(&mut self) -> bool {
        std::mem::replace(&mut self.stage, JournalStage::After) != JournalStage::After
    }

    /// Records the last lines of the run's journal.
    pub fn journal_end(&self, now: Instant, record: &mut dyn Record) -> Result<(), RecordError> {
        if let Some(line) = self.saturation.warning() {
            self.events.warned(now, "actuators", line, record)?;
        }
        self.events.end(now, record)
    }

    /// Returns the instant at which the next row or journal line is due.
    pub fn due(&self) -> Option<Instant> {
        let arrives = self.arrival.as_ref().map(|arrival| arrival.at);
        let reported = earlier(earlier(arrives, self.next_dense), earlier(self.next_frames, self.next_cycle));
        earlier(reported, earlier(self.failures.due(), self.accelerometers.due()))
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
    pub(super) fn record_start(&mut self, record: &mut dyn Record) -> Result<(), SimulationError> {
        let now = self.now;
        if let Plant::OneAxis(_) = self.plant {
            record.record(now, Sample::Begin(&self.law_row()))?;
        }
        if record.wants_motion() {
            self.recorder.next_dense = Some(now);
            self.recorder.next_law = now + Span::from_seconds(1.0);
        }
        self.recorder.next_cycle = self.recorder.cycle_period.map(|_| now);
        self.record_scene(record)
    }

    /// Records the rows that are due at the current instant, after all parts have acted.
    pub(super) fn record_due(&mut self, record: &mut dyn Record) -> Result<(), SimulationError> {
        let now = self.now;
        if self.recorder.next_cycle == Some(now) {
            self.recorder.next_cycle = self.recorder.cycle_period.map(|cycle| now + cycle);
            self.record_cycle(record)?;
        }
        let Some(due) = self.recorder.next_dense else { return Ok(()) };
        // A pulse that begins or ends has a row of its own, or a log could miss it.
        let firing = [0, 1, 2].map(|axis| self.loads.actuator.firing(axis));
        let pulses = std::mem::replace(&mut self.recorder.firing, firing) != firing;
        if due == now {
            self.recorder.next_dense = Some(now + self.recorder.log_period);
        }
        if due == now || pulses {
            self.plant.evaluate(now)?;
            match &self.plant {
                Plant::OneAxis(_) => self.record_motion(record)?,
                Plant::ThreeAxis(plant) => {
                    record.record(now, Sample::SpatialMotion(&self.spatial_motion(plant)))?;
                }
            }
            if due == now && now >= self.recorder.next_law {
                if let Plant::OneAxis(_) = self.plant {
                    record.record(now, Sample::Law(&self.law_row()))?;
                }
                self.recorder.next_law += Span::from_seconds(1.0);
            }
        }
        Ok(())
    }

    /// Records the end of the manoeuvre, if it is at the current instant.
    pub(super) fn record_manoeuvre_end(&mut self, record: &mut dyn Record) -> Result<(), SimulationError> {
        let now = self.now;
        let Some(arrival) = self.recorder.arrival.take_if(|arrival| arrival.at == now) else { return Ok(()) };
        self.plant.evaluate(now)?;
        let row = arrival.row(self.plant.truth(), &self.plant.about_axis(0, &self.angle_origin));
        record.record(now, Sample::Arrival(&row))?;
        Ok(self.recorder.events.manoeuvre_ended(now, &row, record)?)
    }

    /// Records a switching of the one-axis law, if its state was `before` and has changed, with the sensed angle (rad)
    /// and rate (rad/s) and the commanded torque.
    pub(super) fn record_switching(
        &self,
        before: Phase,
        cause: Option<DecisionCause>,
        [angle_rad, rate_rad_s]: [f64; 2],
        record: &mut dyn Record,
    ) -> Result<(), SimulationError> {
        let (now, state) = (self.now, self.controllers.about(0).state());
        let Plant::OneAxis(plant) = &self.plant else { return Ok(()) };
        if before == state {
            return Ok(());
        }
        let (time_s, time_whole_s, time_fs) = Command::times(now);
        let command = Command {
            time_s,
            time_whole_s,
            time_fs,
            state,
            cause: if cause == Some(DecisionCause::Timeout) { Trigger::Timeout } else { Trigger::Guard },
            torque_nm: self.loads.actuator.demanded_torque(0),
            angle_rad,
            rate_rad_s,
            gain: self.controllers.about(0).tuned_value(),
        };
        record.record(now, Sample::Switching(&command, plant.state()))?;
        if record.wants_motion() {
            self.record_motion(record)?;
        }
        Ok(())
    }

    /// Records the estimates after the current sample, and journals losses of lock.
    pub(super) fn record_estimates(&mut self, record: &mut dyn Record) -> Result<(), SimulationError> {
        let now = self.now;
        self.recorder.events.lock_changed(now, self.estimator.lock_lost(), self.estimates.len(), record)?;
        if !record.wants_estimates() {
            return Ok(());
        }
        let truth = self.plant.evaluate(now)?.orientation;
        if let Some(row) = self.estimator.attitude_row(now, &truth, self.sensors.gyro_bias()) {
            record.record(now, Sample::AttitudeEstimate(&row))?;
            let modes = self.estimator.elastic_row();
            return Ok(modes.map_or(Ok(()), |row| record.record(now, Sample::ElasticEstimates(&row)))?);
        }
        let of = |axis: usize| {
            self.estimator.estimate_row(axis, now, &self.plant.about_axis(axis, &self.angle_origin))
        };
        if self.estimates.len() == 1 {
            return Ok(of(0).map_or(Ok(()), |row| record.record(now, Sample::Estimate(&row)))?);
        }
        let axes: Option<Vec<_>> = (0..self.estimates.len()).map(of).collect();
        Ok(axes.map_or(Ok(()), |axes| record.record(now, Sample::Estimates(&Estimates { axes })))?)
    }

    pub(super) fn law_row(&self) -> flexsc_record::Law {
        let law = self.controllers.about(0);
        flexsc_record::Law {
            state: law.state(),
            torque_nm: self.loads.actuator.demanded_torque(0),
            gain: law.tuned_value(),
        }
    }

    /// Records the motion of a one-axis body at the current instant, for a dense record.
    pub(super) fn record_motion(&self, record: &mut dyn Record) -> Result<(), RecordError> {
        let (Plant::OneAxis(plant), now) = (&self.plant, self.now) else { return Ok(()) };
        let sampled = self.sensors.next.is_some();
        let measured = self.sensors.reading.map_or(0.0, |_| self.sensors.measured[0][0]);
        let (attitude, rate, modes) = plant.motion(sampled.then_some(measured));
        let envelope = self.monitor.as_ref().map(|monitor| monitor.envelope(now));
        let (actuator, rates) = (&self.loads.actuator, [rate.rate_rad_s, rate.rigid_rad_s]);
        let drive = self.recorder.has_torque_rows.then(|| {
            let (angle_rad, rate_rad_s) = self.guidance.manoeuvre_state(now);
            let torque = flexsc_record::Torque {
                feedforward_nm: self.guidance.feedforward(now),
                feedback_nm: actuator.demanded_torque(0),
                applied_nm: actuator.applied_torque(now, 0, rates),
                disturbance_nm: self.loads.disturbance(now, 0),
            };
            (GoalMotion { angle_rad, rate_rad_s }, torque)
        });
        let wheel = actuator.wheel(0, rate.rigid_rad_s);
        let motion = Motion { attitude, rate, modes, outputs: plant.outputs(), drive, wheel, envelope };
        record.record(now, Sample::Motion(&motion))
    }

    /// Records the cycle row of a three-axis body and of its estimator; also updates the angle origin and the
    /// adaptation's objective.
    fn record_cycle(&mut self, record: &mut dyn Record) -> Result<(), SimulationError> {
        let now = self.now;
        self.plant.evaluate(now)?;
        // The origin follows the targets also if no law is asked.
        self.update_angle_origin(now);
        let origin = self.angle_origin;
        self.add_cycle();
        if let Plant::ThreeAxis(plant) = &self.plant {
            let truth = plant.viewed();
            let error = truth.orientation.error_from(&origin);
            let (rigid, elastic) = plant.rates();
            let jets = self.loads.actuator.jet_cycle();
            let [roll_on_s, pitch_on_s, yaw_on_s] = jets.as_ref().map_or([0.0; 3], |cycle| cycle.on);
            let fuel_kg = jets.as_ref().map_or(f64::NAN, |cycle| cycle.fuel);
            let fuels_kg = jets.as_ref().map_or_else(Vec::new, |cycle| cycle.fuels.clone());
            let pulses = jets.as_ref().map_or(0, |cycle| cycle.pulses);
            let thrusters = jets.map_or_else(Vec::new, |cycle| cycle.each);
            // Jets may have cycles of their own, which are longer.
            let pulses = pulses - std::mem::replace(&mut self.recorder.recorded_pulses, pulses);
            let (elastic_energy_j, visible_energy_j) = plant.elastic_energies();
            let torquers = self.loads.actuator.magnetorquer_row();
            let moments = torquers.into_iter().flat_map(|torquers| torquers.axes);
            let cycle = ThreeAxisCycle {
                fuels_kg,
                slewing: self.guidance.slews(now),
                wheels: self.loads.actuator.wheels(now, (rigid + elastic).into()),
                moments_am2: moments.map(|axis| axis.moment_am2).collect(),
                jets: Jets { roll_on_s, pitch_on_s, yaw_on_s, fuel_kg },
                thrusters,
                pulses,
                elastic_energy_j,
                visible_energy_j,
                rigid_rate_rad_s: rigid.into(),
                elastic_rate_rad_s: elastic.into(),
                error_rad: error,
                stored_nm_s: self.loads.actuator.stored_momentum(now),
                steered: self.loads.actuator.steering_record(),
                friction_heat_j: plant.friction_heat(),
            };
            self.recorder.saturation.observe(now.seconds(), &cycle);
            record.record(now, Sample::Cycle(&cycle))?;
            if let Some(written) = self.guidance.target_as_written(now) {
                let error = || truth.orientation.error_from(&self.guidance.target(now));
                self.recorder.events.target(now, written, error, record)?;
            }
            if self.has_estimator {
                let damped = || self.controllers.damping_status();
                let Some(tracking) = self.estimator.observer_row(&|| plant.mode_rates().collect(), &damped)
                else {
                    return Ok(());
                };
                record.record(now, Sample::Tracking(&tracking))?;
                let trusted = |axis: usize| self.estimates[axis].elastic_is_trusted;
                self.recorder.events.damping_changed(now, &damped(), [0, 1, 2].map(trusted), record)?;
            }
        }
        Ok(())
    }

    pub(super) fn spatial_motion(&self, plant: &ThreeAxisPlant) -> ThreeAxisMotionSample {
        let truth = plant.viewed();
        let (rigid, elastic) = plant.rates();
        let axis = |axis: usize| AxisRate {
            rate_rad_s: rigid[axis] + elastic[axis],
            rigid_rad_s: rigid[axis],
            elastic_rad_s: elastic[axis],
            measured_rad_s: self.sensors.measured[axis][1],
            believed_rad_s: self.estimates[axis].rate,
        };
        let actuator = &self.loads.actuator;
        let (around, magnetic) = (plant.environment_torque(), plant.magnetic_torque());
        let torque = |axis: usize| flexsc_record::Torque {
            feedforward_nm: 0.0,
            feedback_nm: actuator.demanded_torque(axis),
            applied_nm: magnetic[axis]
                + actuator.applied_torque(self.now, axis, [rigid[axis] + elastic[axis], rigid[axis]]),
            disturbance_nm: {
                let others = self.loads.disturbance(self.now, axis);
                around.map_or(others, |around| others + around[axis])
            },
        };
        let wheels = actuator.wheels(self.now, (rigid + elastic).into());
        // If only jets act, the torques follow from the recorded pulses.
        let alone = self.recorder.jets_only && !plant.has_environment();
        let torques = (!alone).then(|| Torques { axes: [0, 1, 2].map(torque).into() });
        ThreeAxisMotionSample {
            pointing: plant.pointing(truth.orientation.error_from(&self.guidance.origin(self.now))),
            rates: Rates { axes: [0, 1, 2].map(axis).into() },
            vibrations: plant.vibrations(),
            energy: plant.energy(),
            position: plant.position(),
            torques,
            wheels: (!wheels.is_empty()).then_some(Wheels { wheels }),
            gimbals: actuator.gimbal_row(self.now),
            orbit: plant.orbit(),
            magnetorquers: actuator.magnetorquer_row(),
            envelope: self.monitor.as_ref().map(|monitor| monitor.envelope(self.now)),
            bearings: self.bearing_rows(plant),
            drives: plant.drives(),
            hinges: plant.hinges(),
        }
    }
}
