//! The body as it moves, from whichever way it is written: assembled once, before anything moves.

use std::sync::Arc;

use super::{Chain, Craft, Mode, Output, Planar, Spatial};
use crate::motion::turning::Flexible;
use crate::quantity::Finite;

/// A body as it moves.
#[derive(Clone, Debug, PartialEq)]
pub enum Model {
    /// One angle, and modes in closed form.
    Planar(Arc<Planar>),
    /// One angle, and panels that bend by any angles, beside the modes that they have for small angles.
    Chain(Arc<Planar>, Arc<Chain>),
    /// Three axes, and modes that do not act back on them.
    Spatial(Arc<Spatial>),
    /// Three axes and modes, coupled in both directions.
    Craft(Arc<Craft>),
}

/// The free modes of a body, by the number of its axes.
#[derive(Copy, Clone, Debug)]
pub enum Axes<'a> {
    /// One angle.
    One(&'a Planar),
    /// Three axes.
    Three(&'a Spatial),
}

impl Model {
    /// The body in free modes.
    pub fn axes(&self) -> Axes<'_> {
        match self {
            Self::Planar(body) | Self::Chain(body, _) => Axes::One(body),
            Self::Spatial(body) => Axes::Three(body),
            Self::Craft(craft) => Axes::Three(&craft.spatial),
        }
    }

    /// The body in free modes, if it has one angle.
    pub fn planar(&self) -> Option<&Planar> {
        if let Axes::One(body) = self.axes() { Some(body) } else { None }
    }

    /// The body in free modes, if it has three axes.
    pub fn spatial(&self) -> Option<&Spatial> {
        if let Axes::Three(body) = self.axes() { Some(body) } else { None }
    }

    /// The exact chain, if its panels bend by any angles.
    pub fn chain(&self) -> Option<&Chain> {
        if let Self::Chain(_, chain) = self { Some(chain) } else { None }
    }

    /// The spacecraft, if it is put together from parts.
    pub fn craft(&self) -> Option<&Craft> {
        if let Self::Craft(craft) = self { Some(craft) } else { None }
    }

    /// The coupling of rotation and modes in both directions, where the body has it: of a spacecraft.
    pub fn flexible(&self) -> Option<&Flexible> {
        self.craft().map(|craft| &craft.flexible)
    }

    /// How many elastic modes it has.
    pub fn mode_count(&self) -> usize {
        match self.axes() {
            Axes::One(body) => body.modes.len(),
            Axes::Three(body) => body.modes.len(),
        }
    }

    /// Its modes as a command is planned for them: frequencies and damping ratios.
    pub fn free_modes(&self) -> Vec<Mode> {
        let free = |(frequency, damping)| Mode::at_rest(frequency, Finite::default(), damping);
        match self.axes() {
            Axes::One(body) => body.modes.iter().map(|mode| free((mode.frequency, mode.damping))).collect(),
            Axes::Three(body) => body.modes.iter().map(|mode| free((mode.frequency, mode.damping))).collect(),
        }
    }

    /// Natural frequencies (rad/s).
    pub fn frequencies(&self) -> impl Iterator<Item = f64> {
        self.free_modes().into_iter().map(|mode| mode.frequency.get())
    }

    /// Coordinates that are observed in addition to the hub's angle.
    pub fn outputs(&self) -> &[Output] {
        self.planar().map_or(&[], |body| &body.outputs)
    }

    /// What is commanded, and its unit.
    pub fn commanded(&self) -> (&'static str, &'static str) {
        self.planar().map_or(("torque", "N m"), Planar::commanded)
    }

    /// The unit of a torque on it.
    pub fn torque_unit(&self) -> &'static str {
        self.planar().map_or("N m", Planar::torque_unit)
    }

    /// Whether what is commanded is an acceleration (rad/s²) and no torque (N m).
    pub fn commands_acceleration(&self) -> bool {
        self.planar().is_some_and(Planar::commands_acceleration)
    }

    /// Whether its inertia is 1, as of a body with one angle that is described without one.
    pub fn has_unit_inertia(&self) -> bool {
        self.planar().is_some_and(Planar::has_unit_inertia)
    }
}
