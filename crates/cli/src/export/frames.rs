//! Lines of sight of a run as frames of a camera: a table, and where lines of the spectrum land.

use std::io::Write;

use flexsc_core::formats::reader_units::{ReaderUnits, time_span};
use flexsc_core::frames::{FrameFault, FrameLine, FrameRequest, Frames};
use flexsc_core::record::Log;
use serde_json::{Value as Json, json};

use super::{ExportArgs, table, write_output};
use crate::error::CliError;
use crate::human::Units;
use crate::quantity::in_unit;
use crate::row_table::{Column, column, print_rows};
use crate::say;

/// Number of lines that are printed.
const SHOWN: usize = 12;

#[derive(clap::Args)]
pub struct FrameArgs {
    /// Frames per second of a camera (Hz): lines of sight as means over exposures
    #[arg(long, value_name = "RATE", value_parser = in_unit("Hz"), conflicts_with = "topic")]
    frames: Option<f64>,
    /// Length of each exposure, at the start of its frame (s) [default: the whole frame]
    #[arg(long, value_name = "TIME", requires = "frames", value_parser = in_unit("s"))]
    exposure: Option<f64>,
}

/// Columns of the lines.
const LINES: [Column<'_>; 6] = [
    column("line", "line of\nsight"),
    column("source", "source"),
    column("frequency_hz", "line at"),
    column("lands_at_hz", "lands at"),
    column("amplitude_rad", "amplitude\nin the run"),
    column("in_frames_rad", "in the\nframes"),
];

impl FrameArgs {
    /// Returns what is asked for, if frames are.
    pub fn request(&self) -> Option<FrameRequest> {
        self.frames.map(|rate| FrameRequest { rate, exposure: self.exposure })
    }
}

/// Writes the frames of a log, and prints where lines land if the table is in a file.
pub fn run(args: &ExportArgs, is_jsonl: bool, request: FrameRequest) -> Result<(), CliError> {
    let log = Log::open(&args.log)?;
    let Frames { columns, lines } = Frames::from_log(&log, request).map_err(|fault| match fault {
        FrameFault::Log(error) => CliError::Log(error),
        FrameFault::Scenario(error) => CliError::Scenario(error),
        FrameFault::Request(why) => CliError::Arguments(format!("--{why}")),
    })?;
    let flat = table::flat(&columns).map_err(CliError::Arguments)?;
    write_output(args, |out| {
        if is_jsonl { table::jsonl(&flat, columns.len(), out) } else { table::csv(&flat, columns.len(), out) }
    })?;
    let Some(path) = &args.out else { return Ok(()) };
    let exposure = time_span(request.exposure.unwrap_or(1.0 / request.rate));
    say!("{}: {} frames with exposures of {exposure}", path.display(), columns.len());
    if !lines.is_empty() {
        say!("  where lines land, those that are largest in the frames first");
        let rows: Vec<Json> = lines.iter().take(SHOWN).map(|own: &FrameLine| json!(own)).collect();
        print_rows(&rows, &LINES, Units(ReaderUnits::Engineering));
    }
    Ok(())
}
