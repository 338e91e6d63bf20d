//! Names that most programs need: `use flexsc_core::prelude::*;`.

pub use flexsc_control::actuator::{Actuator, ActuatorSpec};
pub use flexsc_control::adaptation::AdaptationSpec;
pub use flexsc_control::custom::Custom;
pub use flexsc_control::estimator::{Estimator, EstimatorSpec};
pub use flexsc_control::law::{Command, ControlOutput, Law, LawSpec};
pub use flexsc_control::sensor::{Sensor, SensorSpec};
pub use flexsc_control::state_estimate::StateEstimate;
pub use flexsc_formats::document::{Document, ScenarioError};
pub use flexsc_numerics::time::{Instant, Span};
pub use flexsc_record::{Detail, LogFile, Record, RecordError, Trace};

pub use flexsc_scenario::Scenario;
pub use flexsc_sim::{Simulation, SimulationError};
