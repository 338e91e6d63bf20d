//! `flexsc log`: answer and scenario of a log, and repair of torn logs.

use std::io::Write;
use std::path::PathBuf;
use std::time::Instant;

use clap::Subcommand;
use flexsc_core::formats::count::counted;
use flexsc_core::record::{Log, recover};
use serde_json::json;

use crate::answer::AnswerArgs;
use crate::error::{CliError, without_controls};
use crate::logged_answer::answer_of_log;
use crate::{files, out, print, say};

#[derive(clap::Args)]
pub struct LogArgs {
    #[command(subcommand)]
    verb: Verb,
}

#[derive(Subcommand)]
enum Verb {
    /// Print the answer of a log: its run is repeated, or, where that is impossible, its rows are read
    Answer {
        /// The log
        log: PathBuf,
        /// Print one JSON object on stdout
        #[arg(long)]
        json: bool,
        #[command(flatten)]
        answer: AnswerArgs,
    },
    /// Recover the complete part of the log of a killed run
    Recover {
        /// The incomplete log, such as relay.mcap.partial
        torn: PathBuf,
        /// The log to write [default: the incomplete log's name with -recovered.mcap]
        #[arg(short, long, value_name = "FILE")]
        out: Option<PathBuf>,
        /// Replace a log of other content
        #[arg(long)]
        force: bool,
        /// Print one JSON object on stdout
        #[arg(long)]
        json: bool,
    },
    /// Print the scenario that a log was made from, with all its defaults
    Scenario {
        /// The log
        log: PathBuf,
    },
}

pub fn run(args: &LogArgs) -> Result<(), CliError> {
    match &args.verb {
        Verb::Recover { torn, out, force, json } => {
            let name = torn.display().to_string();
            let stem = name.trim_end_matches(".partial").trim_end_matches(".mcap");
            let whole = out.clone().unwrap_or_else(|| PathBuf::from(format!("{stem}-recovered.mcap")));
            out::file(&whole, &["mcap"], &[torn])?;
            let (log, saved) = recover(torn)?;
            files::write(&whole, &log, *force)?;
            if *json {
                let object = json!({"file": whole.display().to_string(), "messages": saved});
                return print(format!("{object}\n").as_bytes());
            }
            say!("{} saved in {}", counted(saved, "message"), whole.display());
            Ok(())
        }
        Verb::Answer { log: path, json, answer: args } => {
            let (began, log) = (Instant::now(), Log::open(path)?);
            let (scenario, answer) = answer_of_log(&log, path, args.units.units.into())?;
            if *json {
                let object = json!({"file": path.display().to_string(), "answer": answer});
                print(format!("{object}\n").as_bytes())?;
            } else {
                args.print(&answer, began.elapsed().as_secs_f64(), None);
            }
            args.validate(&[(scenario.name.clone(), answer)])
        }
        Verb::Scenario { log } => print(without_controls(Log::open(log)?.require_scenario()?).as_bytes()),
    }
}
