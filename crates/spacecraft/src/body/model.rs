//! Model of a body, whichever way it is described: assembled once, before a run.

use std::sync::Arc;

use flexsc_dynamics::axis_model::{AxisMode, AxisModel, AxisOutput};
use flexsc_dynamics::chain_model::Chain;
use flexsc_dynamics::three_axis_model::ThreeAxisModel;
use flexsc_numerics::quantity::Finite;

use super::AssembledSpacecraft;

/// Assembled model of a body.
#[derive(Clone, Debug, PartialEq)]
pub enum BodyModel {
    /// One-axis body with modes in closed form.
    OneAxis(Arc<AxisModel>),
    /// One-axis body with panels that bend by any angles, and the modes that it has for small angles.
    Chain(Arc<AxisModel>, Arc<Chain>),
    /// Three-axis body whose modes do not act back on its rotation.
    ThreeAxis(Arc<ThreeAxisModel>),
    /// Three-axis spacecraft whose rotation and modes are coupled in both directions.
    Spacecraft(Arc<AssembledSpacecraft>),
}

/// Body in free modes, by the number of its axes.
#[derive(Copy, Clone, Debug)]
pub enum BodyAxes<'a> {
    /// One-axis body.
    One(&'a AxisModel),
    /// Three-axis body.
    Three(&'a ThreeAxisModel),
}

impl BodyModel {
    /// Returns the body in free modes.
    pub fn axes(&self) -> BodyAxes<'_> {
        match self {
            Self::OneAxis(body) | Self::Chain(body, _) => BodyAxes::One(body),
            Self::ThreeAxis(body) => BodyAxes::Three(body),
            Self::Spacecraft(craft) => BodyAxes::Three(&craft.model),
        }
    }

    /// Returns the body in free modes, if it has one axis.
    pub fn one_axis(&self) -> Option<&AxisModel> {
        if let BodyAxes::One(body) = self.axes() { Some(body) } else { None }
    }

    /// Returns the body in free modes, if it has three axes.
    pub fn three_axis(&self) -> Option<&ThreeAxisModel> {
        if let BodyAxes::Three(body) = self.axes() { Some(body) } else { None }
    }

    /// Returns the body in free modes for a change, if it has three axes.
    pub fn three_axis_mut(&mut self) -> Option<&mut ThreeAxisModel> {
        match self {
            Self::OneAxis(_) | Self::Chain(..) => None,
            Self::ThreeAxis(body) => Some(Arc::make_mut(body)),
            Self::Spacecraft(craft) => Some(&mut Arc::make_mut(craft).model),
        }
    }

    /// Returns the exact chain, if the panels bend by any angles.
    pub fn chain(&self) -> Option<&Chain> {
        if let Self::Chain(_, chain) = self { Some(chain) } else { None }
    }

    /// Returns the spacecraft, if the body is assembled from a hub and appendages.
    pub fn spacecraft(&self) -> Option<&AssembledSpacecraft> {
        if let Self::Spacecraft(craft) = self { Some(craft) } else { None }
    }

    /// Returns true if the modes act back on the rotation, as only those of a spacecraft do.
    pub fn is_two_way(&self) -> bool {
        self.three_axis().is_some_and(|body| body.coupling.is_some())
    }

    /// Returns the number of elastic modes.
    pub fn mode_count(&self) -> usize {
        match self.axes() {
            BodyAxes::One(body) => body.modes.len(),
            BodyAxes::Three(body) => body.modes.len(),
        }
    }

    /// Returns the modes for which commands are planned: frequencies and damping ratios, without gains.
    pub fn free_modes(&self) -> Vec<AxisMode> {
        let free = |(frequency, damping)| AxisMode::at_rest(frequency, Finite::default(), damping);
        match self.axes() {
            BodyAxes::One(body) => {
                body.modes.iter().map(|mode| free((mode.frequency, mode.damping))).collect()
            }
            BodyAxes::Three(body) => {
                body.modes.iter().map(|mode| free((mode.frequency, mode.damping))).collect()
            }
        }
    }

    /// Returns the natural frequencies (rad/s) of the modes.
    pub fn frequencies(&self) -> impl Iterator<Item = f64> {
        self.free_modes().into_iter().map(|mode| mode.frequency.get())
    }

    /// Returns the coordinates that are observed in addition to the hub's angle.
    pub fn outputs(&self) -> &[AxisOutput] {
        self.one_axis().map_or(&[], |body| &body.outputs)
    }

    /// Returns the name of the commanded quantity and its unit.
    pub fn commanded_quantity(&self) -> (&'static str, &'static str) {
        self.one_axis().map_or(("torque", "N m"), AxisModel::commanded)
    }

    /// Returns the unit of a torque on the body.
    pub fn torque_unit(&self) -> &'static str {
        self.one_axis().map_or("N m", AxisModel::torque_unit)
    }

    /// Returns true if the commanded quantity is an acceleration (rad/s²) and not a torque (N m).
    pub fn commands_acceleration(&self) -> bool {
        self.one_axis().is_some_and(AxisModel::commands_acceleration)
    }

    /// Returns true if the inertia is 1, as of a one-axis body that is described without one.
    pub fn has_unit_inertia(&self) -> bool {
        self.one_axis().is_some_and(AxisModel::has_unit_inertia)
    }
}
