//! `flexsc export-c` and `flexsc vectors`: the control system of a scenario as C99, and the calls of its run.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

use flexsc_core::formats::document::ConfigError;
use flexsc_export_c::control_system::NotExportable;
use flexsc_export_c::package::{self, ExportError, ExportOrigin, Guest};
use flexsc_export_c::vectors::{self, VectorError};

use crate::error::CliError;
use crate::{files, out, scenario};

/// Largest number of calls in a file of vectors.
const MOST_CALLS: u64 = 10_000_000;
/// Longest prefix of names in C.
const LONGEST_NAME: usize = 32;
/// Words that Cargo refuses as the name of a crate: those of Rust, of its libraries, and of directories that builds write.
const WORDS_OF_RUST: &str = "abstract alloc as async await become box break build const continue core crate deps do dyn else enum examples \
    extern false final fn for gen if impl in incremental let loop macro match mod move mut override priv proc_macro pub ref return self \
    static std struct super test trait true try type typeof unsafe unsized use virtual where while yield";

#[derive(clap::Args)]
pub struct ExportCArgs {
    /// Scenario file
    scenario: PathBuf,
    /// Set a key of the scenario, such as law.relay.k_t=0.34
    #[arg(long, value_name = "KEY=VALUE")]
    set: Vec<String>,
    /// Precision in which the code, and the study, compute [default: that of the scenario]
    #[arg(long, value_name = "PRECISION")]
    precision: Option<PrecisionName>,
    /// Mode of operation whose law is exported, of a scenario with several
    #[arg(long, value_name = "NAME")]
    mode: Option<String>,
    /// Directory to write
    #[arg(short, long, value_name = "DIR")]
    out: PathBuf,
    /// Prefix of all names in C [default: the scenario's file name]
    #[arg(long, value_name = "NAME")]
    name: Option<String>,
    /// Most calls of the run to export as vectors
    #[arg(long, value_name = "N", default_value_t = 20_000, value_parser = clap::value_parser!(u64).range(1..=MOST_CALLS))]
    calls: u64,
    /// Language of the code
    #[arg(long = "as", value_name = "LANGUAGE", default_value = "c")]
    language: LanguageName,
    /// Add the control system as an app of cFS or a component of F Prime; may be given twice
    #[arg(long, value_name = "GUEST")]
    guest: Vec<GuestName>,
    /// Fail if a part of the control loop is not in the code; guidance and ephemerides are inputs
    #[arg(long)]
    complete: bool,
    /// Replace files of other content in DIR
    #[arg(long)]
    force: bool,
}

/// Framework of flight software in which the control system runs.
#[derive(Copy, Clone, clap::ValueEnum)]
pub enum GuestName {
    /// NASA's core Flight System
    Cfs,
    /// F Prime
    Fprime,
}

/// Language of the exported code.
#[derive(Copy, Clone, PartialEq, clap::ValueEnum)]
pub enum LanguageName {
    /// C99
    C,
    /// Crate of Rust without the standard library
    Rust,
}

/// Precision of the flight computer.
#[derive(Copy, Clone, PartialEq, clap::ValueEnum)]
pub enum PrecisionName {
    /// Doubles, of 64 bits
    Double,
    /// Floats, of 32 bits
    Single,
}

impl PrecisionName {
    /// Returns the change of a scenario.
    fn set(self) -> String {
        format!("flight_precision={}", if self == Self::Double { "double" } else { "single" })
    }
}

impl From<GuestName> for Guest {
    fn from(name: GuestName) -> Self {
        match name {
            GuestName::Cfs => Self::Cfs,
            GuestName::Fprime => Self::FPrime,
        }
    }
}

#[derive(clap::Args)]
pub struct VectorsArgs {
    /// Scenario file
    scenario: PathBuf,
    /// Set a key of the scenario, such as law.relay.k_t=0.34
    #[arg(long, value_name = "KEY=VALUE")]
    set: Vec<String>,
    /// File to write, such as vectors.bin
    #[arg(short, long, value_name = "FILE")]
    out: PathBuf,
    /// Most calls to record
    #[arg(long, value_name = "N", default_value_t = 1_000_000, value_parser = clap::value_parser!(u64).range(1..=MOST_CALLS))]
    calls: u64,
    /// Replace a FILE of other content
    #[arg(long)]
    force: bool,
}

/// Exports the control system of a scenario.
pub fn run(args: &ExportCArgs) -> Result<(), CliError> {
    if args.out.exists() && !args.out.is_dir() {
        let path = args.out.display();
        return Err(CliError::Arguments(format!("-o {path}: must be a directory, and is a file")));
    }
    let set: Vec<String> = args.set.iter().cloned().chain(args.precision.map(PrecisionName::set)).collect();
    let scenario = scenario::load(&args.scenario, &set, None)?;
    let scenario = match &args.mode {
        Some(name) => scenario.in_mode(name)?,
        None => scenario,
    };
    let origin = file_name(&args.scenario);
    let prefix = match &args.name {
        Some(name) => checked_name(name)?,
        None => default_name(&args.scenario),
    };
    let guests: BTreeSet<Guest> = args.guest.iter().map(|name| Guest::from(*name)).collect();
    let guests: Vec<Guest> = guests.into_iter().collect();
    let changes = stated_changes(&set, args.mode.as_deref());
    let origin = ExportOrigin { file: &origin, changes: &changes };
    if !scenario.flight_precision.is_double() && !guests.is_empty() {
        let reason = "must be `double` for a `--guest`, whose messages have doubles";
        let fault = NotExportable::new("flight_precision", reason);
        return Err(refused(&args.scenario, ExportError::Vectors(VectorError::NotExportable(fault))));
    }
    let is_rust = args.language == LanguageName::Rust;
    if is_rust && WORDS_OF_RUST.split_whitespace().any(|word| word == prefix) {
        let reason = "is a word of Rust or Cargo, which no crate has as its name: give another";
        return Err(CliError::Arguments(format!("--name {prefix}: {reason}")));
    }
    if is_rust && !guests.is_empty() {
        return Err(CliError::Arguments(
            "--guest: must be left out with `--as rust`: guests are in C".to_owned(),
        ));
    }
    let package = if is_rust {
        package::export_rust(&scenario, origin, &prefix, args.calls as usize)
    } else {
        package::export(&scenario, origin, &prefix, args.calls as usize, &guests)
    };
    let package = package.map_err(|error| refused(&args.scenario, error))?;
    if args.complete
        && let Some(part) = package.excluded_parts.iter().find(|part| !part.is_supplied)
    {
        let reason = format!(
            "is not part of the exported code, and you would have to {}: without `--complete` the rest is exported",
            part.duty
        );
        let fault = NotExportable::new(part.key.clone(), reason);
        return Err(refused(&args.scenario, ExportError::Vectors(VectorError::NotExportable(fault))));
    }
    let written: Vec<(PathBuf, Vec<u8>)> =
        package.files.iter().map(|file| (args.out.join(&file.path), file.bytes.clone())).collect();
    for (path, bytes) in &written {
        files::refuse_other(path, bytes, args.force)?;
    }
    files::write_within(&written)?;
    let name_of = |name: &str| if is_rust { name.to_owned() } else { format!("{prefix}_{name}") };
    eprintln!(
        "{}: {} with {}; {} calls of the run as vectors",
        args.out.display(),
        if is_rust { format!("crate {prefix}") } else { format!("{prefix}.c") },
        package.calls.iter().map(|call| name_of(call.name)).collect::<Vec<_>>().join(", "),
        package.vectors
    );
    for own in &package.accuracy {
        let output = format!("{} of {}", own.output, own.function);
        eprintln!("{output}: at most {:.1e} {} from double precision", own.difference, own.unit);
    }
    for part in &package.excluded_parts {
        let what = if part.is_supplied { "input of it" } else { "not part of it" };
        eprintln!("{what}: {}; you must {}", part.key, part.duty);
    }
    if is_rust {
        let manifest = args.out.join("Cargo.toml");
        eprintln!("`cargo test --manifest-path {}` compares them by bits", manifest.display());
    } else {
        eprintln!("`make -C {} check` compares them by bits", args.out.display());
    }
    for guest in guests {
        let directory = args.out.join(guest.directory());
        eprintln!("`make -C {} check` replays them through the {}", directory.display(), guest.about());
    }
    Ok(())
}

/// Writes the calls of a run.
pub fn run_vectors(args: &VectorsArgs) -> Result<(), CliError> {
    out::file(&args.out, &["bin"], &[&args.scenario])?;
    let scenario = scenario::load(&args.scenario, &args.set, None)?;
    let vectors = vectors::record(&scenario, args.calls as usize)
        .map_err(|error| refused(&args.scenario, ExportError::Vectors(error)))?;
    files::write(&args.out, &vectors::to_bytes(&vectors), args.force)?;
    eprintln!("{}: {} calls", args.out.display(), vectors.len());
    Ok(())
}

/// Returns the changes of a scenario as options.
pub(crate) fn stated_changes(set: &[String], mode: Option<&str>) -> Vec<String> {
    let mode = mode.map(|name| format!("--mode {name}"));
    set.iter().map(|set| format!("--set {set}")).chain(mode).collect()
}

/// Returns the file name of a scenario.
pub(crate) fn file_name(path: &Path) -> String {
    path.file_name().map_or_else(|| "scenario".to_owned(), |name| name.to_string_lossy().into_owned())
}

/// Returns the error of a scenario that is not exported.
pub(crate) fn refused(path: &Path, error: ExportError) -> CliError {
    match error {
        ExportError::Vectors(VectorError::NotExportable(fault)) => match scenario::document(path) {
            Ok(document) => document.at_key(&ConfigError::new(fault.key, fault.reason)).into(),
            Err(error) => error,
        },
        ExportError::Vectors(VectorError::Simulation(source)) => {
            CliError::run(&path.display().to_string(), source)
        }
        error => CliError::Arguments(format!("{}: {error}", path.display())),
    }
}

/// Returns a name that C accepts, or an error.
fn checked_name(name: &str) -> Result<String, CliError> {
    let is_valid = name.len() <= LONGEST_NAME
        && name.starts_with(|first: char| first.is_ascii_lowercase())
        && name.chars().all(|letter| letter.is_ascii_lowercase() || letter.is_ascii_digit() || letter == '_');
    if is_valid {
        return Ok(name.to_owned());
    }
    Err(CliError::Arguments(format!(
        "--name {name}: must be 1 to {LONGEST_NAME} lower-case letters, digits and underscores that begin with a letter"
    )))
}

/// Returns the prefix that a scenario's file name gives.
pub(crate) fn default_name(path: &Path) -> String {
    let stem = path.file_stem().map(|stem| stem.to_string_lossy().to_ascii_lowercase()).unwrap_or_default();
    let mut name: String = stem
        .chars()
        .map(|letter| if letter.is_ascii_alphanumeric() { letter } else { '_' })
        .take(LONGEST_NAME)
        .collect();
    if !name.starts_with(|first: char| first.is_ascii_lowercase()) {
        name = format!("control_{name}").chars().take(LONGEST_NAME).collect();
    }
    name
}
