//! Input files of flexsc: TOML documents with errors that point at the value, and structures from files of other
//! programs.

pub mod calendar_date;
pub mod celestial_frame;
pub mod chosen_units;
pub mod count;
pub mod csv_table;
pub mod density_table;
pub mod document;
pub mod element_message;
pub mod ephemeris;
pub mod foreign_file;
pub mod harmonic_table;
pub mod load_density_table;
pub mod load_table;
pub mod number;
pub mod read_files;
pub mod reader_units;
pub mod response_table;
pub mod structure;
pub mod text_columns;
pub mod text_file;
