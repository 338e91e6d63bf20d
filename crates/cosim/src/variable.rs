//! Variable of an FMU: name, text and unit, and the quantity of a run that it reads or sets.

use flexsc_core::numerics::time::Span;

/// Direction in which a variable passes values.
#[derive(Copy, Clone, Debug, PartialEq, Eq)]
pub enum Causality {
    /// Time of the simulation.
    Independent,
    /// Value that the run gives.
    Output,
    /// Value that the importer sets at any communication point.
    Input,
    /// Value that the importer sets before the start.
    Parameter,
}

/// Kind of a variable's values.
#[derive(Copy, Clone, Debug, PartialEq, Eq)]
pub enum ValueKind {
    /// Floating-point number.
    Float,
    /// Signed integer.
    Integer,
    /// Unsigned integer of a structural parameter.
    Structural,
    /// Clock.
    Clock(ClockRole),
}

/// Role of a clock.
#[derive(Copy, Clone, Debug, PartialEq, Eq)]
pub enum ClockRole {
    /// Output clock that ticks when a sensor samples.
    Sampled,
    /// Output clock that ticks when a law switches.
    Switched,
    /// Input clock with a constant interval.
    Periodic(Span),
}

/// Quantity of a run that a variable reads or sets.
#[derive(Clone, Debug, PartialEq)]
pub enum Quantity {
    /// Time (s).
    Time,
    /// Value at this index of the observation.
    Observed(usize),
    /// Value at this index of the estimates and references that laws read.
    LawInput(usize),
    /// Value at the second index of the last reading of the sensor at the first index.
    Reading(usize, usize),
    /// Whole seconds of the time at which the last reading of the sensor at this index became available.
    ReadingWhole(usize),
    /// Femtoseconds of that time past the whole second.
    ReadingFemtoseconds(usize),
    /// Output of laws alone at this index.
    LawOutput(usize),
    /// Momentum stored in the rotors about this axis.
    StoredMomentum(usize),
    /// Torque commanded about this axis.
    Commanded(usize),
    /// Mean envelope over the last window.
    WindowMean,
    /// Whole seconds of the current instant.
    TimeWhole,
    /// Femtoseconds of the current instant past the whole second.
    TimeFemtoseconds,
    /// Whole seconds of the last event.
    EventWhole,
    /// Femtoseconds of the last event past the whole second.
    EventFemtoseconds,
    /// Number of events since the start.
    Events,
    /// Number of instants since the start at which a law has switched.
    Switchings,
    /// Input at this index of all inputs.
    Input(usize),
    /// Value of this key of the scenario.
    Key(String),
    /// Seed of the scenario.
    Seed,
    /// Grid (ns) to which communication points are rounded.
    Grid,
    /// Tick of a clock.
    Clock(ClockRole),
}

/// Value of an input or a parameter before the start.
#[derive(Copy, Clone, Debug, PartialEq)]
pub enum VariableStart {
    /// Floating-point number.
    Float(f64),
    /// Integer.
    Integer(i64),
}

/// Variable of an FMU.
#[derive(Clone, Debug, PartialEq)]
pub struct Variable {
    /// Value reference: the index in the table.
    pub reference: u32,
    /// Name, such as `state.modes[1]`.
    pub name: String,
    /// Description.
    pub text: String,
    /// Unit; empty for a dimensionless variable.
    pub unit: String,
    /// Kind of the values.
    pub kind: ValueKind,
    /// Direction.
    pub causality: Causality,
    /// True if the value changes only at events.
    pub is_discrete: bool,
    /// Value before the start, of an input or a parameter.
    pub start: VariableStart,
    /// Quantity that the variable reads or sets.
    pub(crate) quantity: Quantity,
}

impl Variable {
    /// Returns true for a clock.
    pub fn is_clock(&self) -> bool {
        matches!(self.kind, ValueKind::Clock(_))
    }

    /// Returns true if the importer sets the value before the start.
    pub fn is_parameter(&self) -> bool {
        self.causality == Causality::Parameter
    }
}
