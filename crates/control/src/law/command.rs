//! Commands of laws about one axis, and their quantities.

/// Command about one axis.
#[derive(Copy, Clone, Debug, PartialEq)]
pub enum Command {
    /// Torque (N m), or reduced moment (rad/s²) on a body without inertia; for a wheel, units of its command.
    Torque(f64),
    /// Change of the rigid rate within the law's period (rad/s), which the actuator converts to a pulse.
    Change(f64),
    /// Angular acceleration (rad/s²); those about all axes are converted to a torque by the inertia.
    Acceleration(f64),
    /// Magnetic moment along the axis (A m²).
    Moment(f64),
}

/// Quantity of a command, in the order of its codes in packets.
#[derive(Copy, Clone, Debug, PartialEq, Eq)]
pub enum CommandQuantity {
    /// Torque.
    Torque,
    /// Change of the rigid rate.
    Change,
    /// Angular acceleration.
    Acceleration,
    /// Magnetic moment.
    Moment,
}

impl Command {
    /// Returns the quantity that is commanded.
    pub fn quantity(&self) -> CommandQuantity {
        match self {
            Self::Torque(_) => CommandQuantity::Torque,
            Self::Change(_) => CommandQuantity::Change,
            Self::Acceleration(_) => CommandQuantity::Acceleration,
            Self::Moment(_) => CommandQuantity::Moment,
        }
    }

    /// Returns the commanded value, in the unit of its quantity.
    pub fn value(&self) -> f64 {
        let (Self::Torque(value) | Self::Change(value) | Self::Acceleration(value) | Self::Moment(value)) =
            *self;
        value
    }
}

impl CommandQuantity {
    /// All quantities, in the order of their codes.
    pub const ALL: [Self; 4] = [Self::Torque, Self::Change, Self::Acceleration, Self::Moment];

    /// Words of all quantities, in the order of their codes.
    pub const LABELS: [&str; 4] =
        [Self::ALL[0].label(), Self::ALL[1].label(), Self::ALL[2].label(), Self::ALL[3].label()];

    /// Returns the quantity of a word.
    pub fn from_label(label: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|quantity| quantity.label() == label)
    }

    /// Returns the word of the quantity in files and packets.
    pub const fn label(self) -> &'static str {
        match self {
            Self::Torque => "torque",
            Self::Change => "rate_change",
            Self::Acceleration => "acceleration",
            Self::Moment => "moment",
        }
    }

    /// Returns the SI unit of the quantity.
    pub fn unit(self) -> &'static str {
        match self {
            Self::Torque => "N m",
            Self::Change => "rad/s",
            Self::Acceleration => "rad/s²",
            Self::Moment => "A m²",
        }
    }

    /// Returns the command of this value.
    pub fn command(self, value: f64) -> Command {
        match self {
            Self::Torque => Command::Torque(value),
            Self::Change => Command::Change(value),
            Self::Acceleration => Command::Acceleration(value),
            Self::Moment => Command::Moment(value),
        }
    }
}
