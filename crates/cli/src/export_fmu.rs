//! `flexsc export-fmu`: a scenario as a Functional Mock-up Unit, which other simulators import.

use std::env;
use std::fmt::Display;
use std::fs;
use std::io::Write;
use std::path::{Path, PathBuf};

use clap::ValueEnum;
use flexsc_core::Scenario;
use flexsc_cosim::{
    CoSimulationError, FmiVersion, FmuContent, FmuPart, Platform, SourceFmuError, find_library, fmu_bytes,
    source_fmu_bytes,
};
use flexsc_export_c::package::ExportOrigin;

use crate::error::CliError;
use crate::{export_c, files, out, say, scenario};

/// Environment variable with the path of the library, which the Python package sets.
const LIBRARY: &str = "FLEXSC_FMI_LIBRARY";

#[derive(clap::Args)]
pub struct ExportFmuArgs {
    /// Scenario file
    scenario: PathBuf,
    /// Set a key of the scenario, such as law.relay.k_t=0.34
    #[arg(long, value_name = "KEY=VALUE")]
    set: Vec<String>,
    /// Mode of operation that acts throughout, of a scenario with several
    #[arg(long, value_name = "NAME")]
    mode: Option<String>,
    /// Version of FMI
    #[arg(long, value_enum, default_value = "3")]
    fmi: Fmi,
    /// Part of the scenario that the FMU simulates
    #[arg(long, value_enum, default_value = "loop")]
    part: Part,
    /// Libraries of FMUs, such as linux64=a.so win64=b.dll; without a platform that of this program [default: the one beside this
    /// program]
    #[arg(long, value_name = "[PLATFORM=]FILE", num_args = 1.., value_parser = library_of_platform)]
    library: Vec<StatedLibrary>,
    /// The exported C of the controller, with attitude filter and modes, in place of a library: for any platform
    #[arg(long, conflicts_with = "library")]
    sources: bool,
    /// File to write: FILE.fmu
    #[arg(short, long, value_name = "FILE")]
    out: PathBuf,
    /// Replace a FILE of other content
    #[arg(long)]
    force: bool,
}

#[derive(Copy, Clone, PartialEq, Eq, ValueEnum)]
enum Fmi {
    /// FMI 2.0
    #[value(name = "2")]
    V2,
    /// FMI 3.0
    #[value(name = "3")]
    V3,
}

#[derive(Copy, Clone, PartialEq, Eq, ValueEnum)]
enum Part {
    /// The closed loop
    Loop,
    /// The spacecraft with its sensors and actuators
    Plant,
    /// The laws, whose estimates and references are inputs
    Controller,
}

impl From<CoSimulationError> for CliError {
    fn from(error: CoSimulationError) -> Self {
        match error {
            CoSimulationError::Scenario(error) => Self::Scenario(error),
            CoSimulationError::Run { name, source } => Self::Run { name, source },
            CoSimulationError::Refused(why) => Self::Arguments(why),
        }
    }
}

/// Library with its platform; `None` is that of this program.
type StatedLibrary = (Option<&'static Platform>, PathBuf);

/// Parses a library, with a platform or without.
fn library_of_platform(text: &str) -> Result<StatedLibrary, String> {
    match text.split_once('=') {
        // A path may have the sign too.
        Some((name, path)) if !name.contains(['/', '\\', '.']) => Platform::from_name(name)
            .map(|of| (Some(of), PathBuf::from(path)))
            .map_err(|error| error.to_string()),
        _ => Ok((None, PathBuf::from(text))),
    }
}

/// Returns the content of a library.
fn read_library(path: &Path) -> Result<Vec<u8>, CliError> {
    let unread = |why: &dyn Display| {
        CliError::Arguments(format!("cannot read the library of FMUs, {}: {why}", path.display()))
    };
    // A device may never end.
    if !fs::metadata(path).map_err(|error| unread(&error))?.is_file() {
        return Err(unread(&"not a file"));
    }
    fs::read(path).map_err(|error| unread(&error))
}

/// Returns the path of the library beside this program.
fn library() -> Result<PathBuf, CliError> {
    if let Some(path) = env::var_os(LIBRARY).map(PathBuf::from).filter(|path| path.is_file()) {
        return Ok(path);
    }
    let program = env::current_exe().ok();
    let found = find_library(program.as_deref().and_then(Path::parent));
    found.map_err(|error| CliError::Arguments(format!("{error} with --library")))
}

/// Returns the FMU of a scenario's control system as sources.
fn source_bytes(args: &ExportFmuArgs, scenario: &Scenario, version: FmiVersion) -> Result<Vec<u8>, CliError> {
    let path = &args.scenario;
    if args.part != Part::Controller {
        return Err(CliError::Arguments("--sources: is for `--part controller`".to_owned()));
    }
    let (file, changes) =
        (export_c::file_name(path), export_c::stated_changes(&args.set, args.mode.as_deref()));
    let origin = ExportOrigin { file: &file, changes: &changes };
    source_fmu_bytes(scenario, origin, &export_c::default_name(path), version).map_err(|error| match error {
        SourceFmuError::Export(error) => export_c::refused(path, error),
        SourceFmuError::Archive(error) => error.into(),
    })
}

pub fn run(args: &ExportFmuArgs) -> Result<(), CliError> {
    let libraries = args.library.iter().map(|(_, path)| path);
    let inputs: Vec<&Path> = [&args.scenario].into_iter().chain(libraries).map(PathBuf::as_path).collect();
    out::file(&args.out, &["fmu"], &inputs)?;
    let part = FmuPart::from_name(match args.part {
        Part::Loop => "loop",
        Part::Plant => "plant",
        Part::Controller => "controller",
    })?;
    let version = match args.fmi {
        Fmi::V2 => FmiVersion::V2,
        Fmi::V3 => FmiVersion::V3,
    };
    let scenario = scenario::load(&args.scenario, &args.set, None)?;
    let scenario = match &args.mode {
        Some(name) => scenario.in_mode(name)?,
        None => scenario,
    };
    if args.sources {
        let bytes = source_bytes(args, &scenario, version)?;
        files::write(&args.out, &bytes, args.force)?;
        say!("{}", args.out.display());
        return Ok(());
    }
    let content = FmuContent::new(&scenario, part)?;
    let stated = if args.library.is_empty() { vec![(None, library()?)] } else { args.library.clone() };
    let read = |(platform, path): (Option<&'static Platform>, PathBuf)| {
        Ok((platform.map_or_else(Platform::host, Ok)?, read_library(&path)?))
    };
    let libraries: Vec<_> = stated.into_iter().map(read).collect::<Result<_, CliError>>()?;
    let bytes = fmu_bytes(&content, &libraries, version)?;
    files::write(&args.out, &bytes, args.force)?;
    say!("{}", args.out.display());
    Ok(())
}
