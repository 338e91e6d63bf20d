//! Linear dynamics: coupled plants x' = A x + B u, y = C x in closed form, by complex poles and residues.
//!
//! A plant is given as [`System`] or [`SecondOrder`]; both become a [`StateForm`] in which cyclic angles are split
//! off exactly. [`LinearFlow`] is its eigendecomposition, computed once, and [`LinearSegment`] the motion under one
//! input: the residues of the acceleration at each pole, which also bound the derivatives for the certified search
//! for crossings. No equilibrium is ever computed, so that a pole at 0, one at -1e-9 and one at -2 + 30i use the same
//! formulas. Poles that nearly coalesce with their eigenvectors are kept together as a cluster, a small triangular
//! matrix.

mod bounds;
mod cluster;
mod energy;
mod extended;
mod flow;
mod form;
mod phi;
mod poles;
mod schur;
mod search;
mod segment;

pub use energy::SecondOrder;
pub use flow::{LinearFlow, Modal};
pub use form::{StateForm, System};
pub use search::GuardLevel;
pub use segment::{LinearSegment, LinearSight};
