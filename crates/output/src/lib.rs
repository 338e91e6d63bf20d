//! What flexsc writes: rows and topics declared once, traces, MCAP logs, columns; files that are whole or not there.

pub mod label;
pub mod record;
pub mod whole;

use flexsc_motion::{self as motion, time};
