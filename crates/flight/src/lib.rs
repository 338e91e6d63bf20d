//! Control laws, filters and their mathematics, which the engine calls and `flexsc export-c` translates to C99: no standard
//! library, no heap, no unsafe code, no panic. Each file directly in `src`, apart from this one, is written in the subset
//! of Rust that is translated. Functions of mathematics return the bits of the crate `libm` on every processor that rounds
//! as IEEE 754 prescribes; NaN counts as one value.

#![no_std]

#[cfg(any(test, feature = "std"))]
extern crate std;

pub mod argument_reduction;
pub mod binary64;
pub mod exponentials;
pub mod hypotenuse;
pub mod integer_square_root;
pub mod inverse_trigonometry;
pub mod maths;
pub mod payne_hanek;
// The translator takes `square_root.rs`.
#[cfg_attr(feature = "std", path = "processor/square_root.rs")]
pub mod square_root;
pub mod trigonometry;

#[cfg(test)]
mod comparison;
