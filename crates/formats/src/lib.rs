//! What flexsc reads: TOML documents with errors that point at the very value, and structures from the files of other programs.

pub mod count;
pub mod document;
pub mod structure;
