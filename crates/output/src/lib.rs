//! Output of flexsc: rows and topics declared once, traces, MCAP logs, columns, and files that are written atomically.

pub mod atomic_file;
pub mod enum_label;
pub mod record;

use flexsc_motion::{self as motion, time};
