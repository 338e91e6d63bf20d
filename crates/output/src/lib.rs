//! Output of flexsc: rows and topics declared once, traces, MCAP logs, columns, and files that are written atomically.

pub mod label;
pub mod record;
pub mod whole;

use flexsc_motion::{self as motion, time};
