//! Translation of flight code from a subset of Rust to C99. The C evaluates each expression in the order of the Rust, so
//! that both return equal bits under a compiler that keeps IEEE 754.

pub mod translate;

pub use translate::{SourceFile, Translation, TranslationError, translate};
