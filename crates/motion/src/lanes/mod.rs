//! Many runs side by side: one number of each in the lanes of a processor's registers.
//!
//! What is written once over [`Real`] serves one run, with `f64`, and many, in lanes. A lane does what `f64` does, to
//! the bit: nothing but IEEE additions, subtractions, products, quotients and roots, comparisons and selections; no product
//! is fused with a sum, no reciprocal approximate. So no number depends on the processor, the width or the neighbours.
//!
//! Code over lanes must be inlined into the function that [`Processor::run`] compiles for the processor: every function on the way
//! is `#[inline(always)]` and has plain loops. Closures, iterators' adaptors and `array::from_fn` are functions of their own
//! that lack the instructions: they are right, and ten times as slow. [`Real::apart`] makes a function that has them.

mod four;
mod processor;
mod real;
mod register;
#[cfg(test)]
mod tests;

pub use four::Four;
pub use processor::Processor;
pub use real::{LaneWork, Mask, Real};
