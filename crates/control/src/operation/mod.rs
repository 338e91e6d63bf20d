//! Modes of operation: a law each, with the target, sensors and actuators in use, and the conditions that end it.

mod condition;
mod mode_condition;
mod mode_tables;
mod operating_mode;
mod parser;
mod quantity;
mod sequence;

pub use condition::{
    Comparison, ConditionFault, Expression, ModeReadings, RequirementNames, TimeWindow, Timed, Vocabulary,
};
pub use mode_condition::ModeCondition;
pub use mode_tables::{ModeReading, ModeTables, WrittenExit};
pub use operating_mode::{ModeExit, ModeTarget, OperatingMode, SlewStart};
pub use parser::{index_of_kind, parse_instant, parse_trigger};
pub use quantity::{ModeFormula, ModeQuantity};
pub use sequence::{ModeChange, ModeSequence};
