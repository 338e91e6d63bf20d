//! Co-simulation: a run of a scenario behind the variables of an FMU (Functional Mock-up Unit), advanced from one
//! communication point to the next, and the archive that other simulators import.
//!
//! ```
//! use flexsc_core::Scenario;
//! use flexsc_cosim::{CoSimulation, FmuContent, FmuPart};
//!
//! let text = "duration = 10.0\n[law.open]\n[body.planar]\ninertia = 2.0\nrate = 0.5";
//! let content = FmuContent::new(&Scenario::parse("turning.toml", text)?, FmuPart::Loop)?;
//! let mut run = CoSimulation::new(content)?;
//! run.begin(None)?;
//! run.step(0.0, 4.0, false)?;
//! let angle = run.table().find("state.angle").expect("an output").reference;
//! assert_eq!(run.get(angle)?, 2.0);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod applied_inputs;
mod archive;
mod communication_point;
mod content;
mod controller_run;
mod controller_table;
mod cosimulation;
mod description;
mod error;
mod flight_laws;
mod fmi_version;
mod fmu_run;
mod journal;
mod journal_values;
mod library;
mod moment;
mod parameters;
mod platform;
mod source_fmu;
mod units;
mod variable;
mod variable_table;
mod xml;

pub use archive::fmu_bytes;
pub use content::{FmuContent, FmuPart};
pub use controller_run::ControllerRun;
pub use cosimulation::{CoSimulation, StepResult};
pub use error::CoSimulationError;
pub use fmi_version::FmiVersion;
pub use fmu_run::FmuRun;
pub use library::find_library;
pub use platform::Platform;
pub use source_fmu::{SourceFmuError, source_fmu_bytes};
pub use variable::{Causality, ClockRole, ValueKind, Variable, VariableStart};
pub use variable_table::VariableTable;
