//! Linear dynamics: coupled plants x' = A x + B u, y = C x in closed form, by complex poles and residues.
//!
//! A plant is given as [`LinearPlant`] or [`SecondOrderPlant`]; both become a [`SplitPlant`] in which cyclic angles are split
//! off exactly. [`LinearFlow`] is its eigendecomposition, computed once, and [`LinearSegment`] the motion under one
//! input: the residues of the acceleration at each pole, which also bound the derivatives for the certified search
//! for crossings. No equilibrium is ever computed, so that a pole at 0, one at -1e-9 and one at -2 + 30i use the same
//! formulas. Poles that nearly coalesce with their eigenvectors are kept together as a cluster, a small triangular
//! matrix.

mod bounds;
mod cluster;
mod energy_form;
mod extended;
mod flow;
mod phi;
mod poles;
mod schur;
mod search;
mod segment;
mod split_form;

pub use energy_form::SecondOrderPlant;
pub use flow::{LinearFlow, ModalState};
pub use search::OutputGuard;
pub use segment::{LinearOutput, LinearSegment};
pub use split_form::{LinearPlant, SplitPlant};
