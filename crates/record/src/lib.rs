//! Output of flexsc: rows and topics declared once, traces, MCAP logs, columns, and files that are written atomically.
//!
//! A [`Record`] receives everything that a simulation reports.

pub mod atomic_file;
mod columns;
mod composite;
mod decoder;
pub mod description;
mod descriptor;
pub mod enum_label;
pub mod foxglove;
mod log_file;
mod mcap;
mod mcap_reader;
mod memory_budget;
mod message;
pub mod metrics;
mod proto;
mod provenance_check;
mod recover;
pub mod row;
mod scene_source;
mod states;
mod summary;
mod three_axis;
mod topic_table;
mod topics;
mod trace;
mod wire;

use std::io;

use flexsc_dynamics::{AxisState, MotionPiece};
use flexsc_numerics::time::Instant;
use thiserror::Error;

pub use columns::{Column, Columns};
pub use log_file::{Log, LogError};
pub use mcap::{LogBytes, LogFile};
pub use message::{Attachment, COMMANDS, Message, MessageEncoder, MessageSink, Provenance, RunEnd};
pub use provenance_check::{ExistingLog, difference, existing_log};
pub use recover::recover;
pub use scene_source::{OneAxisPose, ScenePose, SceneSource, SceneThrust, ThreeAxisPose};
pub use states::{Gate, Latch, Light, Lock, Onset, Phase, Trust, Use, Watch};
pub use three_axis::{SteeringRecord, ThreeAxisCycle, ThreeAxisMotionSample};
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

/// Samples that a simulation reports while it runs.
#[derive(Copy, Clone, Debug)]
pub enum Sample<'a> {
    /// Start of the run, with the law in this state.
    Begin(&'a Law),
    /// Switching of the law, with the body in this state.
    Switching(&'a Command, &'a AxisState),
    /// Motion at one instant: at each period of a dense record, and at every switching.
    Motion(&'a Motion),
    /// State of the law, once a second in a dense record.
    Law(&'a Law),
    /// End of a window of the envelope's mean.
    Window(&'a WindowMean),
    /// End of a window of the adaptation's objective.
    Objective(&'a Objective),
    /// Step of the adaptation.
    Adaptation(&'a Adaptation),
    /// End of the manoeuvre.
    Arrival(&'a Arrival),
    /// Estimate of a filter after a sample.
    Estimate(&'a Estimate),
    /// Estimates of the filters of three axes after a sample.
    Estimates(&'a Estimates),
    /// Estimate of an attitude filter after a sample.
    AttitudeEstimate(&'a AttitudeEstimate),
    /// Estimates of elastic modes by an attitude filter after a sample.
    ElasticEstimates(&'a ElasticEstimates),
    /// Wheel that passed through zero speed, stuck, or slipped again.
    WheelEvent(&'a WheelEvent),
    /// Sample of an accelerometer.
    Accelerations(&'a Accelerations),
    /// Start or end of a failure of a sensor or an actuator.
    Fault(&'a FaultEvent),
    /// Start of a cycle of a three-axis body.
    Cycle(&'a ThreeAxisCycle),
    /// Estimates of adaptive observers after a cycle's sample.
    Tracking(&'a Tracking),
    /// Motion of a spatial body at one instant, at each period of a dense record.
    SpatialMotion(&'a ThreeAxisMotionSample),
    /// Log line for people.
    Log(&'a foxglove::Log),
    /// Contents of the scene, once.
    Scene(&'a foxglove::SceneUpdate),
    /// Poses of the parts of the scene.
    Frames(&'a foxglove::FrameTransforms),
    /// Plumes of the scene, at each change.
    Plumes(&'a foxglove::Plumes),
}

impl Sample<'_> {
    /// Returns the least detail of a record that needs the sample.
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

/// Motion at one instant.
#[derive(Clone, Debug, PartialEq)]
pub struct Motion {
    /// Angle of the body.
    pub attitude: Attitude,
    /// Rate of the body.
    pub rate: Rate,
    /// Motion of the elastic modes.
    pub modes: Modes,
    /// Observed coordinates, if the body has any.
    pub outputs: Option<Outputs>,
    /// Goal and torques, if the scenario has more than a law.
    pub drive: Option<(GoalMotion, Torque)>,
    /// Motion of the wheel, if there is one that stores momentum.
    pub wheel: Option<WheelMotion>,
    /// Envelope of the modes, if the scenario has an observer.
    pub envelope: Option<Envelope>,
}

/// Selection of the pieces of motion that a record needs as a whole.
#[derive(Copy, Clone, Debug, PartialEq)]
pub enum PieceDemand {
    /// No piece.
    None,
    /// Pieces on which the angle may be farther from 0 than this (rad).
    Beyond(f64),
    /// All pieces.
    All,
}

impl PieceDemand {
    /// Returns the smallest selection that contains both.
    #[must_use]
    pub fn and(self, other: Self) -> Self {
        match (self, other) {
            (Self::None, course) | (course, Self::None) => course,
            (Self::Beyond(a), Self::Beyond(b)) => Self::Beyond(a.min(b)),
            _ => Self::All,
        }
    }
}

/// Observer of a simulation.
pub trait Record {
    /// Returns true if the record needs the motion at each period of the scenario's log.
    fn wants_motion(&self) -> bool {
        false
    }

    /// Returns true if the record needs a filter's estimate at each sample.
    fn wants_estimates(&self) -> bool {
        self.wants_motion()
    }

    /// Returns true if the record needs switchings.
    fn wants_switchings(&self) -> bool {
        true
    }

    /// Returns the selection of pieces of a one-axis motion that the record needs as a whole. A piece lasts from one
    /// change of the input to the next, whatever instants other records observe.
    fn piece_demand(&self) -> PieceDemand {
        PieceDemand::None
    }

    /// Observes a piece of motion that ends now.
    fn piece(&mut self, _now: Instant, _stretch: &MotionPiece) -> Result<(), RecordError> {
        Ok(())
    }

    /// Returns the scene that the run records for viewers; `None` if the record supplies none. Called at the start.
    fn scene(&self) -> Option<Box<dyn SceneSource>> {
        None
    }

    /// Records a sample.
    fn record(&mut self, now: Instant, sample: Sample<'_>) -> Result<(), RecordError>;

    /// Checks that the run may continue; called at every event, and at intervals in long searches and integrations.
    ///
    /// # Errors
    /// [`RecordError::Interrupted`] to end the run.
    fn poll(&mut self) -> Result<(), RecordError> {
        Ok(())
    }
}

/// Error of a record.
#[derive(Debug, Error)]
pub enum RecordError {
    /// Log that could not be written.
    #[error(transparent)]
    Io(#[from] io::Error),
    /// Request of the user to stop.
    #[error("interrupted")]
    Interrupted,
}

/// Detail in which a run is recorded.
#[derive(Copy, Clone, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
pub enum Detail {
    /// Switchings, window means, adaptation: all changes.
    #[default]
    Events,
    /// In addition the motion at each period of the scenario's log, and at every switching.
    Full,
    /// In addition the scene: frames and shapes for three-dimensional viewers.
    Scene,
}

/// Destination of rows of any topic: messages, or columns in memory.
trait RowTaker {
    fn take_row<R: row::TopicRow>(&mut self, now: Instant, row: &R) -> Result<(), RecordError>;

    /// Records the rows of which a sample consists.
    fn take_sample_rows(&mut self, now: Instant, sample: Sample<'_>) -> Result<(), RecordError> {
        match sample {
            Sample::Begin(law) | Sample::Law(law) => self.take_row(now, law),
            Sample::Switching(command, _) => self.take_row(now, command),
            Sample::Window(mean) => self.take_row(now, mean),
            Sample::Objective(row) => self.take_row(now, row),
            Sample::Adaptation(step) => self.take_row(now, step),
            Sample::Arrival(arrival) => self.take_row(now, arrival),
            Sample::Estimate(estimate) => self.take_row(now, estimate),
            Sample::Estimates(estimates) => self.take_row(now, estimates),
            Sample::AttitudeEstimate(estimate) => self.take_row(now, estimate),
            Sample::ElasticEstimates(estimates) => self.take_row(now, estimates),
            Sample::Tracking(tracking) => self.take_row(now, tracking),
            Sample::WheelEvent(event) => self.take_row(now, event),
            Sample::Fault(event) => self.take_row(now, event),
            Sample::Accelerations(row) => self.take_row(now, row),
            Sample::Log(line) => self.take_row(now, line),
            Sample::Scene(scene) => self.take_row(now, scene),
            Sample::Frames(frames) => self.take_row(now, frames),
            Sample::Plumes(plumes) => self.take_row(now, plumes),
            Sample::Cycle(ThreeAxisCycle { pulses: 0, .. }) => Ok(()),
            Sample::Cycle(cycle) => {
                self.take_row(now, &cycle.jets)?;
                if cycle.thrusters.is_empty() {
                    return Ok(());
                }
                let thrusters = cycle.thrusters.iter().map(|on_s| ThrusterPulse { on_s: *on_s }).collect();
                self.take_row(now, &Thrusters { thrusters })
            }
            Sample::SpatialMotion(motion) => {
                self.take_row(now, &motion.pointing)?;
                self.take_row(now, &motion.rates)?;
                self.take_row(now, &motion.vibrations)?;
                self.take_row(now, &motion.energy)?;
                if let Some(position) = &motion.position {
                    self.take_row(now, position)?;
                }
                if let Some(torques) = &motion.torques {
                    self.take_row(now, torques)?;
                }
                if let Some(orbit) = &motion.orbit {
                    self.take_row(now, orbit)?;
                }
                if let Some(magnetorquers) = &motion.magnetorquers {
                    self.take_row(now, magnetorquers)?;
                }
                motion.envelope.as_ref().map_or(Ok(()), |envelope| self.take_row(now, envelope))?;
                motion.drives.as_ref().map_or(Ok(()), |drives| self.take_row(now, drives))?;
                motion.hinges.as_ref().map_or(Ok(()), |hinges| self.take_row(now, hinges))?;
                motion.bearings.as_ref().map_or(Ok(()), |bearings| self.take_row(now, bearings))?;
                motion.gimbals.as_ref().map_or(Ok(()), |gimbals| self.take_row(now, gimbals))?;
                motion.wheels.as_ref().map_or(Ok(()), |wheels| self.take_row(now, wheels))
            }
            Sample::Motion(motion) => {
                self.take_row(now, &motion.attitude)?;
                self.take_row(now, &motion.rate)?;
                self.take_row(now, &motion.modes)?;
                if let Some(outputs) = &motion.outputs {
                    self.take_row(now, outputs)?;
                }
                if let Some((goal, torque)) = &motion.drive {
                    self.take_row(now, goal)?;
                    self.take_row(now, torque)?;
                }
                if let Some(wheel) = &motion.wheel {
                    self.take_row(now, wheel)?;
                }
                motion.envelope.as_ref().map_or(Ok(()), |envelope| self.take_row(now, envelope))
            }
        }
    }
}
