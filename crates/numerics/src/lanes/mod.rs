//! SIMD over many runs: one number of each run in the lanes of a processor's registers.
//!
//! Code written once over [`LaneFloat`] serves a single run, with `f64`, and many runs, in lanes. A lane does exactly what
//! `f64` does, to the bit: only IEEE additions, subtractions, products, quotients and roots, comparisons and
//! selections; no product is fused with a sum, no reciprocal is approximate. So no number depends on the processor,
//! the width or the other lanes.
//!
//! Code over lanes must be inlined into the function that [`Processor::run`] compiles for the processor: every
//! function on the way is `#[inline(always)]` and has plain loops. Closures, iterator adaptors and `array::from_fn`
//! are separate functions that lack the instructions: they are correct, and ten times as slow. [`LaneFloat::run_outlined`]
//! creates a separate function that has them.

mod float;
mod processor;
mod register;
#[cfg(test)]
mod tests;
mod width4;

pub use float::{LaneFloat, Mask, SimdTask};
pub use processor::Processor;
pub use width4::SimdWidth4;
