//! Inputs and outputs of a call of the control system: arrays of numbers with names, as members of a C struct.

use flexsc_core::control::flight_quantity::{FlightDeclaration, FlightQuantity};

/// Type of the numbers of a channel.
#[derive(Copy, Clone, Debug, PartialEq, Eq)]
pub enum NumberKind {
    /// Doubles.
    Real,
    /// True or false.
    Flag,
    /// Integers of 64 bits, from 0 up to the given number, which is excluded; 0 for any.
    Integer(u64),
}

/// Array of numbers of one kind, which is a member of the struct of inputs or outputs.
#[derive(Clone, Debug, PartialEq)]
pub struct Channel {
    /// Name of the member.
    pub name: String,
    /// Meaning with its unit.
    pub about: String,
    /// Number of elements; a member with one element is no array.
    pub count: usize,
    /// Type of the elements.
    pub kind: NumberKind,
    /// Typical size of the numbers, for calls with random inputs.
    pub scale: f64,
    /// Quantity of the run that the channel passes; `None` of one that only flight code has.
    pub quantity: Option<FlightQuantity>,
    /// True for the components of a unit vector or quaternion, of which random inputs have unit length.
    pub is_unit: bool,
    /// Largest size of the numbers; infinite if there is no limit.
    pub largest: f64,
}

impl Channel {
    /// Creates a channel of doubles of this typical size.
    pub fn real(name: &str, about: &str, count: usize, scale: f64) -> Self {
        let (name, about) = (name.to_owned(), about.to_owned());
        Self {
            name,
            about,
            count,
            kind: NumberKind::Real,
            scale,
            quantity: None,
            is_unit: false,
            largest: f64::INFINITY,
        }
    }

    /// Creates a channel of doubles of this typical size that passes a quantity of the run.
    pub fn from_quantity(quantity: FlightQuantity, count: usize, scale: f64) -> Self {
        let FlightDeclaration { channel, unit, meaning, .. } = quantity.declaration();
        let mut about = if unit.is_empty() { meaning.to_owned() } else { format!("{meaning} ({unit})") };
        about[..1].make_ascii_uppercase();
        let is_unit = quantity == FlightQuantity::TargetAttitude;
        Self { quantity: Some(quantity), is_unit, ..Self::real(channel, &about, count, scale) }
    }

    /// Returns the channel with a limit of the size of its numbers.
    #[must_use]
    pub fn within(self, largest: f64) -> Self {
        Self { largest, ..self }
    }

    /// Returns the unit, which the meaning has in parentheses; empty for a number without one.
    pub fn unit_of_numbers(&self) -> &str {
        let inside = self.about.rsplit_once('(').and_then(|(_, rest)| rest.split_once(')'));
        inside.map_or("", |(unit, _)| unit)
    }

    /// Returns the frame of a vector or a quaternion; `None` of other numbers, such as those of three wheels.
    pub fn frame(&self) -> Option<&'static str> {
        match (self.kind, self.count) {
            (NumberKind::Real, 4) if self.name.ends_with("attitude") => Some("body axes to inertial axes"),
            (NumberKind::Real, 3) if self.name.ends_with("_reference") => Some("inertial axes"),
            (NumberKind::Real, 3)
                if matches!(self.name.as_str(), "wheel_torque" | "wheel_speed" | "mean") =>
            {
                None
            }
            (NumberKind::Real, 3) => Some("body axes"),
            _ => None,
        }
    }

    /// Returns the channel with another meaning.
    #[must_use]
    pub fn with_about(self, about: &str) -> Self {
        Self { about: about.to_owned(), ..self }
    }

    /// Creates a channel of the components of a unit quaternion, or with three of a unit vector.
    pub fn unit(name: &str, about: &str, count: usize) -> Self {
        Self { is_unit: true, ..Self::real(name, about, count, 1.0) }
    }

    /// Creates a channel of truth values.
    pub fn flag(name: &str, about: &str, count: usize) -> Self {
        Self { kind: NumberKind::Flag, ..Self::real(name, about, count, 1.0) }
    }

    /// Creates a channel of integers below a limit.
    pub fn integer(name: &str, about: &str, count: usize, below: u64) -> Self {
        Self { kind: NumberKind::Integer(below), ..Self::real(name, about, count, 1.0) }
    }
}

/// Function of the control system, with its inputs and outputs.
#[derive(Clone, Debug, PartialEq)]
pub struct CallLayout {
    /// Name of the function.
    pub name: &'static str,
    /// Meaning of the call.
    pub about: &'static str,
    /// True if the function is called once, before the others.
    pub is_start: bool,
    /// Period of the calls (s), if it is another than that of the laws.
    pub period: Option<f64>,
    /// Inputs.
    pub inputs: Vec<Channel>,
    /// Outputs.
    pub outputs: Vec<Channel>,
}

impl CallLayout {
    /// Returns a function of this name and meaning without inputs and outputs.
    pub fn new(name: &'static str, about: &'static str) -> Self {
        Self { name, about, is_start: false, period: None, inputs: Vec::new(), outputs: Vec::new() }
    }

    /// Returns the number of words of the inputs.
    pub fn input_words(&self) -> usize {
        self.inputs.iter().map(|channel| channel.count).sum()
    }

    /// Returns the number of words of the outputs.
    pub fn output_words(&self) -> usize {
        self.outputs.iter().map(|channel| channel.count).sum()
    }
}

/// Reader of words, in the order of the channels.
#[derive(Debug)]
pub struct WordReader<'a>(&'a [u64]);

impl<'a> WordReader<'a> {
    /// Creates a reader of these words.
    pub fn new(words: &'a [u64]) -> Self {
        Self(words)
    }

    /// Returns the next word; 0 after the last one.
    pub fn word(&mut self) -> u64 {
        let Some((first, rest)) = self.0.split_first() else { return 0 };
        self.0 = rest;
        *first
    }

    /// Returns the next number.
    pub fn real(&mut self) -> f64 {
        f64::from_bits(self.word())
    }

    /// Returns the next `N` numbers.
    pub fn reals<const N: usize>(&mut self) -> [f64; N] {
        let mut numbers = [0.0; N];
        for number in &mut numbers {
            *number = self.real();
        }
        numbers
    }

    /// Returns the next `count` numbers.
    pub fn list(&mut self, count: usize) -> Vec<f64> {
        (0..count).map(|_| self.real()).collect()
    }

    /// Returns the next truth value.
    pub fn flag(&mut self) -> bool {
        self.word() != 0
    }
}
