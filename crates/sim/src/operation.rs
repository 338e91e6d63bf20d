//! Modes of operation of a run: their conditions on what the laws know, and the changes of laws, targets, sensors and
//! actuators.

use std::sync::Arc;

use flexsc_control::actuator::ActuatorEvent;
use flexsc_control::flight_quantity::FlightQuantity;
use flexsc_control::operation::{ModeChange, ModeFormula, ModeQuantity, ModeReadings, ModeSequence};
use flexsc_flight::mode_readings::{largest_size, norm};
use flexsc_flight::mode_supervisor::MOST_CHANGES;
use flexsc_numerics::attitude::Vector;
use flexsc_numerics::time::{Instant, Span};
use flexsc_record::{Command, ModeEvent, ModeTargetStart, Record, Report, Sample};

use super::blinding::BlindingState;
use super::mode_sky::ModeSky;
use super::mode_test::TestedConditions;
use super::run_view::{RunView, motion_error, true_rate};
use super::{Simulation, SimulationError};
use flexsc_scenario::Scenario;

/// Modes of operation of a run.
#[derive(Clone, Debug)]
pub struct Operation {
    sequence: Option<ModeSequence>,
    /// For each mode, which sensors are in use.
    in_use: Vec<Vec<bool>>,
    /// Sky of the conditions.
    sky: Arc<ModeSky>,
    /// Last test before a decision from outside.
    pub(super) tested: Option<TestedConditions>,
}

impl Operation {
    /// Creates the modes of a scenario, before its start.
    pub fn new(scenario: &Scenario) -> Self {
        let sky = ModeSky::new(scenario);
        let crossings = |quantity: ModeQuantity, limit: f64| sky.crossings(quantity, limit);
        Self {
            sequence: ModeSequence::new(scenario.mode_tables(), &crossings),
            in_use: (0..scenario.mode.len()).map(|mode| scenario.sensors_in_use(mode)).collect(),
            sky: Arc::new(sky),
            tested: None,
        }
    }

    /// Returns the next instant at which conditions are tested.
    #[inline]
    pub fn due(&self) -> Option<Instant> {
        self.sequence.as_ref().and_then(ModeSequence::due)
    }

    /// Returns true if the conditions were tested at an instant, before a decision from outside.
    #[inline]
    pub fn is_tested(&self, now: Instant) -> bool {
        self.tested.as_ref().is_some_and(|test| test.at == now)
    }

    /// Returns the sky of the conditions.
    pub fn sky(&self) -> &Arc<ModeSky> {
        &self.sky
    }

    /// Returns the sequence of the modes; `None` without modes.
    pub fn sequence(&self) -> Option<&ModeSequence> {
        self.sequence.as_ref()
    }

    /// Returns the row of the first mode, at the start of a run with modes.
    pub fn first_event(&self, now: Instant) -> Option<ModeEvent> {
        let to = self.sequence.as_ref()?.active();
        let change = ModeChange { from: None, to, cause: String::new(), is_chatter: false };
        self.event(now, change)
    }

    /// Returns the error of modes that change without end.
    fn chatter(&self, now: Instant, change: &ModeChange) -> SimulationError {
        let name = |mode: usize| self.sequence.as_ref().map_or("", |sequence| sequence.name(mode)).to_owned();
        SimulationError::ModeChatter {
            at: now,
            count: MOST_CHANGES + 1,
            before: change.from.map_or_else(String::new, name),
            after: name(change.to),
        }
    }

    fn event(&self, now: Instant, change: ModeChange) -> Option<ModeEvent> {
        let sequence = self.sequence.as_ref()?;
        let (time_s, time_whole_s, time_fs) = Command::times(now);
        Some(ModeEvent {
            time_s,
            time_whole_s,
            time_fs,
            index: change.to as u64,
            mode: sequence.name(change.to).to_owned(),
            before: change.from.map_or("", |mode| sequence.name(mode)).to_owned(),
            cause: change.cause,
        })
    }
}

impl Simulation {
    /// Tests the conditions of the mode that are due, and enters the mode that follows: its laws decide at this instant on
    /// its target, with its sensors and actuators.
    pub(super) fn update_mode(&mut self, record: &mut dyn Record) -> Result<(), SimulationError> {
        let now = self.clock.now();
        if self.operation.due() != Some(now) {
            return Ok(());
        }
        let Some(mut sequence) = self.operation.sequence.take() else { return Ok(()) };
        let before = sequence.active();
        let readings = sequence.read(now, &RunView { modes: Some(&sequence), ..self.read_view() });
        let change = sequence.test(now, &readings, self.laws.precision);
        if let Some(test) = self.operation.tested.as_mut().filter(|test| test.at == now) {
            test.readings.clone_from(&readings);
        }
        self.trace_mode(now, sequence.active(), readings);
        self.operation.sequence = Some(sequence);
        let Some(change) = change else { return Ok(()) };
        if change.is_chatter {
            return Err(self.operation.chatter(now, &change));
        }
        let (mode, mut start) = (change.to, None);
        self.laws.enter_mode(mode);
        self.sensors.set_in_use(now, &self.operation.in_use[mode]);
        self.loads.actuator.update(now, ActuatorEvent::Mode(mode));
        let estimates = &self.estimation.estimates;
        let angles = std::array::from_fn(|axis| estimates.get(axis).map_or(0.0, |estimate| estimate.angle));
        let estimated = self.estimation.origin().rotated_by(angles);
        let held = self.guidance.target(now);
        if self.guidance.enter_mode(now, [before, mode], &estimated) {
            self.estimation.move_origin(now, &mut self.guidance);
            // The error of a mode that already holds the target is no distance from it.
            let is_held = self.guidance.is_held(before, now, &held);
            let errors = self.plant.truth().orientation.error_from(&self.guidance.target(now));
            let distance = if is_held { 0.0 } else { norm(&errors) };
            start = Some(ModeTargetStart { mode, distance });
        }
        let Some(event) = self.operation.event(now, change) else { return Ok(()) };
        self.recorder.record_mode(now, &event, record)?;
        if let Some(start) = start {
            let mut report = Report::new();
            report.add_value(start);
            record.record(now, Sample::Report(&report))?;
        }
        Ok(())
    }
}

impl ModeReadings for RunView<'_> {
    fn value(&self, quantity: ModeQuantity) -> f64 {
        let precision = self.laws.precision;
        match quantity.formula() {
            ModeFormula::Norm(vector) => return precision.norm(&self.known(vector)),
            ModeFormula::Distance(one, other) => {
                return precision.distance(&self.known(one), &self.known(other));
            }
            ModeFormula::LargestSize(list) => {
                let values = self.known(list);
                return if values.is_empty() { f64::NAN } else { largest_size(&values) };
            }
            ModeFormula::Single => {}
        }
        match quantity {
            ModeQuantity::Silent(sensor) => self.sensors.silence(self.now, sensor).seconds(),
            ModeQuantity::Entries(mode) => {
                self.modes.map_or(f64::NAN, |sequence| sequence.entries(mode) as f64)
            }
            ModeQuantity::Mode(mode) => {
                f64::from(u8::from(self.modes.is_some_and(|sequence| sequence.active() == mode)))
            }
            ModeQuantity::Blinded(sensor) => {
                let is_blind = |state: BlindingState| state.sensor == sensor && state.is_blinded;
                f64::from(u8::from(self.sensors.blinding_states().any(is_blind)))
            }
            ModeQuantity::TrueRate => norm(&true_rate(self.plant)),
            ModeQuantity::PointingError | ModeQuantity::TrueRateError => {
                let is_rate = quantity == ModeQuantity::TrueRateError;
                norm(&motion_error(self.plant, self.guidance, self.now, is_rate))
            }
            // Only requirements over time read them.
            ModeQuantity::LineOfSight(_) | ModeQuantity::Metric(..) => f64::NAN,
            ModeQuantity::LockLost => {
                f64::from(u8::from(self.estimation.estimator.lock_lost().contains(&true)))
            }
            ModeQuantity::FilterAge | ModeQuantity::FilterInnovation | ModeQuantity::FilterDeviation => {
                let health = self.estimation.estimator.filter_health(self.now);
                health.map_or(f64::NAN, |health| match quantity {
                    ModeQuantity::FilterAge => health.age,
                    ModeQuantity::FilterInnovation => health.innovation,
                    _ => health.deviation,
                })
            }
            ModeQuantity::Sunlight
            | ModeQuantity::Elevation(_)
            | ModeQuantity::TrueSunlight
            | ModeQuantity::TrueElevation(_)
            | ModeQuantity::Fault(_) => self.sky.value(quantity, self.now.seconds()),
            clock => self.clock(clock).seconds(),
        }
    }

    fn clock(&self, quantity: ModeQuantity) -> Span {
        let is_of_mode = matches!(quantity, ModeQuantity::Time | ModeQuantity::TrueTime);
        let entered = self.modes.filter(|_| is_of_mode).map_or(Instant::START, ModeSequence::entered);
        self.now.since(entered)
    }
}

impl RunView<'_> {
    /// Returns a vector or list that the control system knows; nothing for those that no condition reads.
    pub(super) fn known(&self, quantity: FlightQuantity) -> Vec<f64> {
        let estimates = self.estimation.estimates.iter();
        let field = |vector: Option<Vector>| vector.map_or([f64::NAN; 3], Into::into).to_vec();
        match quantity {
            FlightQuantity::Angle => estimates.map(|estimate| estimate.angle).collect(),
            FlightQuantity::Rate => estimates.map(|estimate| estimate.rate).collect(),
            FlightQuantity::ReferenceAngle => self.reference().into_iter().map(|[angle, _]| angle).collect(),
            FlightQuantity::ReferenceRate => self.reference().into_iter().map(|[_, rate]| rate).collect(),
            FlightQuantity::TargetAttitude => {
                let attitude = self.estimation.origin().attitude();
                attitude.map_or_else(Vec::new, |q| vec![q.w, q.i, q.j, q.k])
            }
            FlightQuantity::StoredMomentum => self
                .loads
                .known_momentum(self.now, self.plant.truth().rigid_rate, estimates.as_slice())
                .to_vec(),
            FlightQuantity::WheelSpeed => self.loads.wheel_speeds(self.now, self.plant.truth().rigid_rate),
            FlightQuantity::Field => field(self.sensors.measured_field()),
            FlightQuantity::FieldRate => {
                field(self.sensors.field_rate.filter(|_| !self.sensors.field_is_stale(self.now)))
            }
            _ => Vec::new(),
        }
    }

    /// Returns the angle (rad) of the reference about each axis, from which the estimated angles differ by the error, and
    /// its rate (rad/s).
    fn reference(&self) -> Vec<[f64; 2]> {
        let estimates = &self.estimation.estimates;
        if estimates.len() == 1 {
            let (angle, rate) = self.guidance.manoeuvre_state(self.now);
            return vec![[angle, rate]];
        }
        match self.guidance.reference_motion(self.now, estimates) {
            Some(setpoints) => setpoints.iter().map(|setpoint| [0.0, setpoint.rate]).collect(),
            None => vec![[0.0; 2]; estimates.len()],
        }
    }
}
