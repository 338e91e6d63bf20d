//! `flexsc layout`: a viewer layout for a log.

use std::path::PathBuf;

use flexsc_core::Scenario;
use flexsc_core::layout::Layout;
use flexsc_core::record::Log;

use crate::failure::Failure;
use crate::print;

#[derive(clap::Args)]
pub struct Args {
    /// The log
    log: PathBuf,
    /// The file to write, such as layout.json [default: stdout]
    #[arg(short, long, value_name = "FILE")]
    out: Option<PathBuf>,
}

pub fn run(args: &Args) -> Result<(), Failure> {
    let log = Log::open(&args.log)?;
    let scenario = Scenario::parse(&args.log.display().to_string(), log.scenario().unwrap_or_default())?;
    let has = |topic: &str| log.topics().iter().any(|own| own == topic);
    let layout = Layout::of(&scenario).of_topics(has).to_json();
    match &args.out {
        Some(path) => flexsc_core::whole::write(path, layout.as_bytes()).map_err(Failure::write(path)),
        None => print(layout.as_bytes()),
    }
}
