//! The record: the only way out of a simulation.

mod bounds;
mod budget;
mod columns;
mod combined;
pub mod description;
mod descriptor;
pub mod foxglove;
mod log;
mod mcap;
pub mod measured;
mod message;
mod origin;
mod proto;
mod recover;
pub mod row;
mod shape;
mod spatial;
mod states;
mod summary;
mod table;
mod topics;
mod trace;
mod wire;

use std::io;

use thiserror::Error;

use crate::motion::{State, Stretch};
use crate::time::Instant;

pub use columns::{Column, Columns};
pub use log::{Log, LogError};
pub use mcap::{LogBytes, LogFile};
pub use message::{Attachment, COMMANDS, Encode, Message, Messages, Provenance, RunEnd};
pub use origin::{There, difference, there};
pub use recover::recover;
pub use spatial::{SpatialCycle, SpatialMotion, Steered};
pub use states::{Gate, Latch, Light, Lock, Onset, Phase, Trust, Use, Watch};
pub use topics::{
    Acceleration, Accelerations, Adaptation, Arrival, Attitude, AttitudeEstimate, AxisEstimate, AxisRate,
    BearingMotion, Bearings, ChannelState, Command, ControlMomentGyro, ControlMomentGyros, Decision,
    DriveMotion, DrivenMode, DrivesMotion, ElasticEstimate, ElasticEstimates, Energy, Envelope, Estimate,
    Estimates, FaultEvent, GoalMotion, HingeMotion, Hinges, Jets, Law, Magnetorquer, Magnetorquers, Metric,
    MetricLine, MetricPage, Metrics, ModeEnvelope, ModeEstimate, ModeMotion, Modes, Objective, Orbit,
    OrbitAxis, OutputMotion, OutputName, Outputs, Params, Pointing, Position, Rate, Rates, Residual, Sliding,
    Summary, TOPICS, ThrusterPulse, Thrusters, Torque, Torques, TrackedMode, Tracking, Trigger, Vibration,
    Vibrations, Wheel, WheelEvent, WheelMotion, Wheels, WindowMean,
};
pub use trace::Trace;

/// What a simulation reports while it runs.
#[derive(Copy, Clone, Debug)]
pub enum Sample<'a> {
    /// The run begins with the law in this state.
    Begin(&'a Law),
    /// The law switched, with the body in this state.
    Switching(&'a Command, &'a State),
    /// The motion at one instant: at each period of a dense record, and at every switching.
    Motion(&'a Motion),
    /// What the law does, once a second of a dense record.
    Law(&'a Law),
    /// A window of the envelope's mean ended.
    Window(&'a WindowMean),
    /// A window of the adaptation's objective ended.
    Objective(&'a Objective),
    /// The adaptation took a step.
    Adaptation(&'a Adaptation),
    /// The manoeuvre ended.
    Arrival(&'a Arrival),
    /// A filter took a sample.
    Estimate(&'a Estimate),
    /// Filters of three axes took a sample.
    Estimates(&'a Estimates),
    /// An attitude filter took a sample.
    AttitudeEstimate(&'a AttitudeEstimate),
    /// What that filter then knew of elastic modes.
    ElasticEstimates(&'a ElasticEstimates),
    /// A wheel passed through zero speed, stuck, or slipped again.
    WheelEvent(&'a WheelEvent),
    /// An accelerometer told a sample.
    Accelerations(&'a Accelerations),
    /// A failure of a sensor or an actuator began or ended.
    Fault(&'a FaultEvent),
    /// A cycle of a body with three axes began.
    Cycle(&'a SpatialCycle),
    /// What adaptive observers know after a cycle's sample.
    Tracking(&'a Tracking),
    /// The motion of a spatial body at one instant, at each period of a dense record.
    SpatialMotion(&'a SpatialMotion),
    /// A line for people: what happened.
    Log(&'a foxglove::Log),
    /// What a scene consists of, once.
    Scene(&'a foxglove::SceneUpdate),
    /// Where the parts of the scene are.
    Frames(&'a foxglove::FrameTransforms),
    /// The plumes of the scene, at each change.
    Plumes(&'a foxglove::Plumes),
}

impl Sample<'_> {
    /// The least detail of a record that wants it.
    pub fn detail(self) -> Detail {
        match self {
            Self::Motion(_)
            | Self::Law(_)
            | Self::Estimate(_)
            | Self::Estimates(_)
            | Self::AttitudeEstimate(_)
            | Self::ElasticEstimates(_)
            | Self::Tracking(_)
            | Self::Accelerations(_)
            | Self::SpatialMotion(_) => Detail::Full,
            Self::Scene(_) | Self::Frames(_) | Self::Plumes(_) => Detail::Scene,
            _ => Detail::Events,
        }
    }
}

/// The motion at one instant.
#[derive(Clone, Debug, PartialEq)]
pub struct Motion {
    /// Angles.
    pub attitude: Attitude,
    /// Rates.
    pub rate: Rate,
    /// Modes.
    pub modes: Modes,
    /// Observed coordinates, if the body has any.
    pub outputs: Option<Outputs>,
    /// Goal and torques, of a scenario with more than a law.
    pub drive: Option<(GoalMotion, Torque)>,
    /// The wheel, if there is one that stores momentum.
    pub wheel: Option<WheelMotion>,
    /// Envelope, if the scenario has an observer.
    pub envelope: Option<Envelope>,
}

/// Which motions a record wants whole, stretch by stretch.
#[derive(Copy, Clone, Debug, PartialEq)]
pub enum Course {
    /// None.
    None,
    /// Those on which the angle may be farther from 0 than this (rad).
    Beyond(f64),
    /// All.
    All,
}

impl Course {
    /// What satisfies both.
    #[must_use]
    pub fn and(self, other: Self) -> Self {
        match (self, other) {
            (Self::None, course) | (course, Self::None) => course,
            (Self::Beyond(a), Self::Beyond(b)) => Self::Beyond(a.min(b)),
            _ => Self::All,
        }
    }
}

/// An observer of a simulation.
pub trait Record {
    /// Whether the record wants the motion at each period of the scenario's log.
    fn dense(&self) -> bool {
        false
    }

    /// Whether the record takes a filter's estimate at each sample.
    fn estimates(&self) -> bool {
        self.dense()
    }

    /// Whether the record takes switchings.
    fn switchings(&self) -> bool {
        true
    }

    /// Which motions of a body with one angle the record wants whole: each from one change of its input to the next, when
    /// it has ended, whatever instants other records look at.
    fn course(&self) -> Course {
        Course::None
    }

    /// Takes a stretch of a motion that ends now.
    fn stretch(&mut self, _now: Instant, _stretch: &Stretch) -> Result<(), RecordError> {
        Ok(())
    }

    /// Whether the record wants the scene, which a simulation has once it was asked to draw it.
    fn scene(&self) -> bool {
        false
    }

    /// Takes a sample.
    fn record(&mut self, now: Instant, sample: Sample<'_>) -> Result<(), RecordError>;

    /// Whether the run may go on: asked at every event, and now and then in long searches and integrations between two.
    ///
    /// # Errors
    /// [`RecordError::Interrupted`] to end the run.
    fn poll(&mut self) -> Result<(), RecordError> {
        Ok(())
    }
}

/// A record could not be kept.
#[derive(Debug, Error)]
pub enum RecordError {
    /// The log could not be written.
    #[error(transparent)]
    Io(#[from] io::Error),
    /// The user asked to stop.
    #[error("interrupted")]
    Interrupted,
}

/// How much of a run is recorded.
#[derive(Copy, Clone, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
pub enum Detail {
    /// Switchings, window means, adaptation: all that changes.
    #[default]
    Events,
    /// Also the motion at each period of the scenario's log, and at every switching.
    Full,
    /// Also the scene: frames and shapes for viewers in three dimensions.
    Scene,
}

/// A thing that takes rows of any topic: messages, or columns in memory.
trait TakeRow {
    fn take<R: row::TopicRow>(&mut self, now: Instant, row: &R) -> Result<(), RecordError>;

    /// Takes the rows that a sample consists of.
    fn take_sample(&mut self, now: Instant, sample: Sample<'_>) -> Result<(), RecordError> {
        match sample {
            Sample::Begin(law) | Sample::Law(law) => self.take(now, law),
            Sample::Switching(command, _) => self.take(now, command),
            Sample::Window(mean) => self.take(now, mean),
            Sample::Objective(row) => self.take(now, row),
            Sample::Adaptation(step) => self.take(now, step),
            Sample::Arrival(arrival) => self.take(now, arrival),
            Sample::Estimate(estimate) => self.take(now, estimate),
            Sample::Estimates(estimates) => self.take(now, estimates),
            Sample::AttitudeEstimate(estimate) => self.take(now, estimate),
            Sample::ElasticEstimates(estimates) => self.take(now, estimates),
            Sample::Tracking(tracking) => self.take(now, tracking),
            Sample::WheelEvent(event) => self.take(now, event),
            Sample::Fault(event) => self.take(now, event),
            Sample::Accelerations(row) => self.take(now, row),
            Sample::Log(line) => self.take(now, line),
            Sample::Scene(scene) => self.take(now, scene),
            Sample::Frames(frames) => self.take(now, frames),
            Sample::Plumes(plumes) => self.take(now, plumes),
            Sample::Cycle(SpatialCycle { pulses: 0, .. }) => Ok(()),
            Sample::Cycle(cycle) => {
                self.take(now, &cycle.jets)?;
                if cycle.thrusters.is_empty() {
                    return Ok(());
                }
                let thrusters = cycle.thrusters.iter().map(|on_s| ThrusterPulse { on_s: *on_s }).collect();
                self.take(now, &Thrusters { thrusters })
            }
            Sample::SpatialMotion(motion) => {
                self.take(now, &motion.pointing)?;
                self.take(now, &motion.rates)?;
                self.take(now, &motion.vibrations)?;
                self.take(now, &motion.energy)?;
                if let Some(position) = &motion.position {
                    self.take(now, position)?;
                }
                if let Some(torques) = &motion.torques {
                    self.take(now, torques)?;
                }
                if let Some(orbit) = &motion.orbit {
                    self.take(now, orbit)?;
                }
                if let Some(magnetorquers) = &motion.magnetorquers {
                    self.take(now, magnetorquers)?;
                }
                motion.envelope.as_ref().map_or(Ok(()), |envelope| self.take(now, envelope))?;
                motion.drives.as_ref().map_or(Ok(()), |drives| self.take(now, drives))?;
                motion.hinges.as_ref().map_or(Ok(()), |hinges| self.take(now, hinges))?;
                motion.bearings.as_ref().map_or(Ok(()), |bearings| self.take(now, bearings))?;
                motion.gimbals.as_ref().map_or(Ok(()), |gimbals| self.take(now, gimbals))?;
                motion.wheels.as_ref().map_or(Ok(()), |wheels| self.take(now, wheels))
            }
            Sample::Motion(motion) => {
                self.take(now, &motion.attitude)?;
                self.take(now, &motion.rate)?;
                self.take(now, &motion.modes)?;
                if let Some(outputs) = &motion.outputs {
                    self.take(now, outputs)?;
                }
                if let Some((goal, torque)) = &motion.drive {
                    self.take(now, goal)?;
                    self.take(now, torque)?;
                }
                if let Some(wheel) = &motion.wheel {
                    self.take(now, wheel)?;
                }
                motion.envelope.as_ref().map_or(Ok(()), |envelope| self.take(now, envelope))
            }
        }
    }
}
