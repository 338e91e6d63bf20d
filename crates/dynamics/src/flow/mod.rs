//! Motion of a body between events: exact flows about one axis, of chains, and about three axes if modes do not act
//! back.
//!
//! - [`UncoupledSegment`]: uncoupled modes in closed form, with the bounds that certify crossings;
//! - [`CoupledFlow`]: modes coupled by a wheel, a damping matrix or a drift ([`DriftingFlow`]), in closed form or as Taylor
//!   series;
//! - [`ChainMotion`]: the exact chain of rigid sections;
//! - [`SmallAngleSegment`]: small rotations about three axes in closed form, with the same bounds;
//! - [`RigidBody`] and [`ElasticModes`] (or [`DriftingModes`]): three axes, with rotation and modes computed separately.
//!
//! The coupled motion about three axes is in [`crate::three_axis`].

mod chain;
mod coupled_flow;
mod coupled_matrices;
mod drifting;
mod drifting_modes;
mod elastic;
#[cfg(test)]
mod guess_tests;
mod mode;
mod modes_simd;
mod rigid;
mod segment;
mod small_angles;
mod taylor_series;
mod three_axis_state;
mod waveform_response;

pub use chain::{ChainExpansion, ChainMotion};
pub use coupled_flow::{CoupledExpansion, CoupledFlow, ExternalMotion, TransitionFlow};
pub use coupled_matrices::CoupledMatrices;
pub use drifting::DriftingFlow;
pub use drifting_modes::DriftingModes;
pub use elastic::ElasticModes;
pub use mode::ModeFlow;
pub use rigid::{LONGEST_TURN, RigidBody, RigidState};
pub use segment::UncoupledSegment;
pub use small_angles::{SmallAngleGuard, SmallAngleSegment, SmallAngleState};
pub use taylor_series::{DriftingEquations, RatioSeries};
pub use three_axis_state::ThreeAxisState;
pub use waveform_response::{ActiveWaveform, SegmentInput};
