//! `flexsc export`: a topic of a log as a table, or the whole run in a format of other programs.

mod frames;
mod handover;
mod metrics;
mod table;
#[cfg_attr(not(feature = "handover"), path = "export/whole_run/unavailable.rs")]
mod whole_run;

use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};

use clap::ValueEnum;
use flexsc_core::record::{Log, LogError};

use crate::error::{CliError, for_terminal};
use crate::{files, out};

#[derive(clap::Args)]
pub struct ExportArgs {
    /// Log file; for fret also a scenario
    log: PathBuf,
    /// Topic, such as /command [default: list the topics of the log]
    #[arg(long, value_name = "TOPIC")]
    topic: Option<String>,
    /// Format: csv and jsonl of a topic, the others of the whole run [default: by the ending of FILE, else csv]
    #[arg(long, value_enum)]
    format: Option<ExportFormat>,
    /// File to write: FILE.csv, .jsonl, .aem, .oem, .glb, .bin for Vizard, or .json for FRET [default: stdout]
    #[arg(short, long, value_name = "FILE")]
    out: Option<PathBuf>,
    /// Replace a FILE of other content
    #[arg(long, requires = "out")]
    force: bool,
    #[command(flatten)]
    frames: frames::FrameArgs,
    #[command(flatten)]
    handover: handover::HandoverArgs,
}

#[derive(Copy, Clone, PartialEq, Eq, ValueEnum)]
enum ExportFormat {
    /// Comma-separated values with a header
    Csv,
    /// One JSON object for each row
    Jsonl,
    /// CCSDS attitude ephemeris message
    Aem,
    /// CCSDS orbit ephemeris message
    Oem,
    /// glTF: an animated scene in one file
    Glb,
    /// Messages for Vizard, the viewer of Basilisk
    Vizard,
    /// Requirements of the run's scenario as sentences of FRET, for monitors by Copilot
    Fret,
}

impl ExportFormat {
    /// All formats with the file extension of each.
    const ENDINGS: [(&'static str, Self); 7] = [
        ("csv", Self::Csv),
        ("jsonl", Self::Jsonl),
        ("aem", Self::Aem),
        ("oem", Self::Oem),
        ("glb", Self::Glb),
        ("bin", Self::Vizard),
        ("json", Self::Fret),
    ];

    /// Returns true if the format holds one topic, and false if it holds the whole run.
    fn is_table(self) -> bool {
        matches!(self, Self::Csv | Self::Jsonl)
    }
}

impl ExportArgs {
    /// Returns the format, by the option or the file's extension.
    fn form(&self) -> Result<ExportFormat, CliError> {
        let Some(path) = &self.out else { return Ok(self.format.unwrap_or(ExportFormat::Csv)) };
        let endings = ExportFormat::ENDINGS.map(|(ending, _)| ending);
        let ending = out::file(path, &endings, &[&self.log])?;
        let from_ending = ExportFormat::ENDINGS.into_iter().find(|(own, _)| *own == ending);
        let from_ending = from_ending.map_or(ExportFormat::Csv, |(_, format)| format);
        match self.format {
            Some(format) if format != from_ending && out::ending(path).is_some() => {
                Err(CliError::Arguments(format!(
                    "--format: {} has the ending of another format\n\nhint: leave out --format",
                    path.display()
                )))
            }
            format => Ok(format.unwrap_or(from_ending)),
        }
    }
}

pub fn run(args: &ExportArgs) -> Result<(), CliError> {
    let format = args.form()?;
    if !format.is_table() {
        if args.topic.is_some() {
            let why = "--topic: this format holds the whole run, and only csv and jsonl hold one topic";
            return Err(CliError::Arguments(why.to_owned()));
        }
        if args.frames.request().is_some() {
            let why = "--frames: a table of frames is csv or jsonl";
            return Err(CliError::Arguments(why.to_owned()));
        }
        return whole_run::run(args, format);
    }
    args.handover.refuse()?;
    if let Some(request) = args.frames.request() {
        return frames::run(args, format == ExportFormat::Jsonl, request);
    }
    if args.out.is_some() && args.topic.is_none() {
        let why = "-o: a table is of one topic\n\nhint: --topic names it, and `flexsc export LOG` lists them";
        return Err(CliError::Arguments(why.to_owned()));
    }
    let log = Log::open(&args.log)?;
    let Some(topic) = &args.topic else {
        return write_output(args, |out| writeln!(out, "{}", for_terminal(&log.topics().join("\n"))));
    };
    // Programs and pages write topics without their slash, too.
    let topic = &if topic.starts_with('/') { topic.clone() } else { format!("/{topic}") };
    let columns = log.columns(topic)?;
    if topic == metrics::TOPIC
        && let Some(table) = metrics::table(&columns, format == ExportFormat::Jsonl)
    {
        let table = table.map_err(|why| unreadable(&args.log, topic, why.to_string()))?;
        return write_output(args, |out| out.write_all(&table));
    }
    let flat = table::flat(&columns).map_err(|why| unreadable(&args.log, topic, why))?;
    write_output(args, |out| {
        if format == ExportFormat::Jsonl {
            table::jsonl(&flat, columns.len(), out)
        } else {
            table::csv(&flat, columns.len(), out)
        }
    })
}

fn unreadable(path: &Path, topic: &str, why: String) -> CliError {
    LogError::Undecodable { path: path.to_owned(), topic: topic.to_owned(), why }.into()
}

/// Writes the exported table to the file or to stdout.
fn write_output(args: &ExportArgs, write: impl Fn(&mut dyn Write) -> io::Result<()>) -> Result<(), CliError> {
    let Some(path) = &args.out else {
        let mut out = BufWriter::with_capacity(1 << 16, io::stdout().lock());
        return write(&mut out).and_then(|()| out.flush()).map_err(CliError::Stdout);
    };
    let mut bytes = Vec::new();
    write(&mut bytes).map_err(CliError::write(path))?;
    files::write(path, &bytes, args.force)
}
