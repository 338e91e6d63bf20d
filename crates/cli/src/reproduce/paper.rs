//! The papers that the studies come from.

use clap::ValueEnum;

/// A paper, or two on the same spacecraft.
#[derive(Copy, Clone, Debug, PartialEq, Eq, ValueEnum)]
pub enum Paper {
    /// Seed paper 1: a relay law adapted to the envelope of the elastic modes
    Relay,
    /// Seed paper 2: finite rotation with vibration suppressed at the end
    Rotation,
    /// Seed papers 3 and 5: wheels, drifting frequencies and a scheduled gain
    Wheel,
    /// Seed paper 4: a space station damped by its own thrusters
    Station,
}

impl Paper {
    /// The template of its page.
    pub fn template(self) -> &'static str {
        match self {
            Self::Relay => include_str!("papers/relay.md"),
            Self::Rotation => include_str!("papers/rotation.md"),
            Self::Wheel => include_str!("papers/wheel.md"),
            Self::Station => include_str!("papers/station.md"),
        }
    }

    /// What the command calls it.
    pub fn name(self) -> String {
        self.to_possible_value().map(|value| value.get_name().to_owned()).unwrap_or_default()
    }
}
