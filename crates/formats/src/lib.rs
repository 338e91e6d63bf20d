//! Input files of flexsc: TOML documents with errors that point at the value, and structures from files of other
//! programs.

pub mod celestial_frame;
pub mod count;
pub mod density_table;
pub mod document;
pub mod ephemeris;
pub mod harmonic_table;
pub mod read_files;
pub mod reader_units;
pub mod structure;
pub mod text_columns;
