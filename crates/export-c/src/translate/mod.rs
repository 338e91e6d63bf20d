//! Translator: from files of Rust and the names of root functions to declarations and definitions of C99.

mod aggregates;
mod branches;
mod calls;
mod comments;
mod constants;
mod error;
mod evaluation;
mod expressions;
mod functions;
mod helpers;
mod inference;
mod items;
mod literals;
mod loops;
mod methods;
mod names;
mod operators;
mod order;
mod paths;
mod prelude;
mod pruning;
mod reach;
mod refusals;
mod scopes;
mod statements;
mod translation;
mod types;
mod writer;

pub use error::TranslationError;
pub use literals::float_literal;
pub use pruning::ConstantChoices;
pub use translation::{SourceFile, Translation, translate, translate_library};
