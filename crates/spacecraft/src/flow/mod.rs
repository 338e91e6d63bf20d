//! Motion of a body between events: exact flows about one axis, of chains, and about three axes if modes do not act
//! back.
//!
//! - [`Segment`]: uncoupled modes in closed form, with the bounds that certify crossings;
//! - [`Coupling`]: modes coupled by a wheel, a damping matrix or a drift ([`Drifting`]), in closed form or as Taylor
//!   series;
//! - [`ChainMotion`]: the exact chain of rigid sections;
//! - [`Rigid`] and [`Elastic`] (or [`DriftingModes`]): three axes, with rotation and modes computed separately.
//!
//! The coupled motion about three axes is in `motion::turning`.

mod abreast;
mod chain;
mod coupled;
mod drifting;
mod drifting_modes;
mod elastic;
mod forced;
#[cfg(test)]
mod guess_tests;
mod mode;
mod rigid;
mod segment;
mod series;
mod spatial_state;
mod wheeled;

pub use chain::{ChainMotion, Flown};
pub use coupled::Coupled;
pub use drifting::Drifting;
pub use drifting_modes::DriftingModes;
pub use elastic::Elastic;
pub use forced::{Forced, ForcedInput};
pub use mode::ModeFlow;
pub use rigid::{LONGEST_TURN, Rigid, RigidTurn};
pub use segment::Segment;
pub use series::{Ratio, Springs};
pub use spatial_state::SpatialState;
pub use wheeled::{Constant, Coupling, Lent, Unfolding};
