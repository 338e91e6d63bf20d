//! The linear flow: coupled plants x' = A x + B u, y = C x in closed form, by complex poles and residues.
//!
//! [`System`] or [`SecondOrder`] is what is given; both become a [`StateForm`] in which angles that nothing feels are split off
//! exactly. [`LinearFlow`] is its eigen decomposition, computed once, and [`LinearSegment`] the motion under one input: the
//! residues of the acceleration at each pole, which also bound the derivatives for the certified search for crossings.
//! No equilibrium is ever formed, so that a pole at 0, one at -1e-9 and one at -2 + 30i go through the same formulas.
//! Poles that nearly coalesce with their eigenvectors are kept together as a cluster, a small triangular matrix.

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
