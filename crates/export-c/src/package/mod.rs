//! Files of an exported control system: header, source, driver, start-up code of boards, Makefile, vectors and a description.

mod accuracy;
mod choices;
mod driver;
mod guests;
mod header;
mod interface;
mod main_loop;
mod rust_crate;
mod source;
mod static_files;

use flexsc_core::Scenario;
use flexsc_flight_precision::Precision;
use sha2::{Digest, Sha256};

use crate::control_system::{CallLayout, ControlSystem, ExcludedPart};
use crate::flight_sources::sources_in;
use crate::glue::{self, ModulePlan};
use crate::self_test::self_tests;
use crate::translate::{SourceFile, Translation, TranslationError, translate_library};
use crate::vectors::{self, CallVector, VectorError};

pub use crate::glue::FlightParameter;
pub use accuracy::OutputAccuracy;
pub use guests::Guest;
pub use rust_crate::export_rust;

/// Numbers of cycles for which the hash of the self-test is exported.
pub const HASHED_CYCLES: [u64; 3] = [1000, 20_000, 1_000_000];

/// File of an exported control system.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct PackageFile {
    /// Path within the directory.
    pub path: String,
    /// Content.
    pub bytes: Vec<u8>,
}

/// Exported control system.
#[derive(Clone, Debug)]
pub struct Package {
    /// Files, in the order of their paths.
    pub files: Vec<PackageFile>,
    /// Functions.
    pub calls: Vec<CallLayout>,
    /// Number of vectors.
    pub vectors: usize,
    /// Parts of the control loop that are not in the code.
    pub excluded_parts: Vec<ExcludedPart>,
    /// Outputs in single precision beside those in double precision; none in double precision.
    pub accuracy: Vec<OutputAccuracy>,
}

/// Reason for which a control system is not exported.
#[derive(Debug)]
pub enum ExportError {
    /// No vectors, because the control system has no plain code, the run fails, or the laws differ.
    Vectors(VectorError),
    /// The plain code is outside the subset that is translated.
    Translation(TranslationError),
}

impl std::fmt::Display for ExportError {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Vectors(error) => error.fmt(f),
            Self::Translation(error) => error.fmt(f),
        }
    }
}

impl std::error::Error for ExportError {}

/// Origin of a control system, by which an export can be traced.
#[derive(Copy, Clone, Debug)]
pub struct ExportOrigin<'a> {
    /// File name of the scenario.
    pub file: &'a str,
    /// Changes of it for the export, such as a key and its value.
    pub changes: &'a [String],
}

/// Data from which the files are written.
struct Plan<'a> {
    /// Prefix of all names in C.
    prefix: &'a str,
    /// Scenario, and what was changed of it.
    origin: ExportOrigin<'a>,
    /// SHA-256 of the scenario with these changes and all defaults.
    digest: &'a str,
    /// Parts of the control loop that are not in the code.
    excluded_parts: &'a [ExcludedPart],
    module: ModulePlan<'a>,
}

impl<'a> std::ops::Deref for Plan<'a> {
    type Target = ModulePlan<'a>;

    fn deref(&self) -> &ModulePlan<'a> {
        &self.module
    }
}

impl Plan<'_> {
    /// Returns the version of the control system: the program, and the digits of the scenario's hash.
    fn version(&self) -> String {
        format!("flexsc {}, scenario {}", env!("CARGO_PKG_VERSION"), self.digest)
    }

    /// Returns the name of the numbers in which the code computes.
    fn numbers(&self) -> &'static str {
        if self.precision.is_double() { "doubles" } else { "floats" }
    }
}

/// Control system of a scenario with what its files state beside the functions.
struct Prepared {
    system: ControlSystem,
    calls: Vec<CallLayout>,
    vectors: Vec<CallVector>,
    excluded_parts: Vec<ExcludedPart>,
    /// Scenario with all defaults, and its SHA-256.
    effective: String,
    digest: String,
    parameters: Vec<FlightParameter>,
    precision: Precision,
}

impl Prepared {
    /// Prepares the control system of a scenario with at most `most` vectors of its run.
    fn new(scenario: &Scenario, most: usize) -> Result<Self, ExportError> {
        let system = ControlSystem::new(scenario).map_err(|error| ExportError::Vectors(error.into()))?;
        let vectors = vectors::record(scenario, most).map_err(ExportError::Vectors)?;
        let effective = scenario.to_toml();
        let digest =
            Sha256::digest(&effective).iter().map(|byte| format!("{byte:02x}")).collect::<Vec<_>>().concat();
        Ok(Self {
            calls: system.calls(),
            vectors,
            excluded_parts: system.excluded_parts(scenario),
            effective,
            digest,
            parameters: glue::parameters(&system),
            precision: scenario.flight_precision,
            system,
        })
    }

    /// Returns the data of the files with names that begin with `prefix`.
    fn plan<'a>(&'a self, origin: ExportOrigin<'a>, prefix: &'a str) -> Plan<'a> {
        Plan {
            prefix,
            origin,
            digest: &self.digest,
            excluded_parts: &self.excluded_parts,
            module: ModulePlan {
                system: &self.system,
                calls: &self.calls,
                parameters: &self.parameters,
                run_start: glue::find_run_start(&self.calls, &self.vectors),
                precision: self.precision,
            },
        }
    }
}

/// Code of a control system in C.
struct Code {
    header: String,
    source: String,
    translation: Translation,
}

impl Code {
    /// Writes the code of a control system.
    fn new(plan: &Plan<'_>) -> Result<Self, ExportError> {
        let module = plan.module();
        let mut sources = sources_in(plan.precision);
        sources.push(SourceFile { path: "control_system.rs", module: "control_system", text: &module.text });
        let choices = choices::constant_choices(plan.system);
        let translation =
            translate_library(&sources, plan.prefix, &choices).map_err(ExportError::Translation)?;
        Ok(Self {
            header: header::header(plan, &translation),
            source: source::source(plan, &translation),
            translation,
        })
    }
}

/// Exports the control system of a scenario, with names that begin with `prefix`, at most `most` vectors of its run, and these
/// guests.
///
/// # Errors
/// An [`ExportError`] if a part of the control system has no plain code, or if its run fails.
pub fn export(
    scenario: &Scenario,
    origin: ExportOrigin<'_>,
    prefix: &str,
    most: usize,
    guests: &[Guest],
) -> Result<Package, ExportError> {
    let prepared = Prepared::new(scenario, most)?;
    let plan = prepared.plan(origin, prefix);
    let Code { header, source, translation } = Code::new(&plan)?;
    let vectors = &prepared.vectors;
    let accuracy =
        accuracy::output_accuracies(scenario, vectors).map_err(|fault| ExportError::Vectors(fault.into()))?;
    let hashes: Vec<(u64, u64)> =
        HASHED_CYCLES.into_iter().zip(self_tests(&prepared.system, HASHED_CYCLES)).collect();
    let mut files: Vec<PackageFile> =
        guests.iter().flat_map(|guest| guest.files(&plan, &header, &source)).collect();
    files.extend([
        text(format!("{prefix}.h"), header),
        text(format!("{prefix}.c"), source),
        text("driver.c".to_owned(), driver::driver(&plan, &translation.guards)),
        text(format!("{prefix}.icd.json"), interface::interface(&plan, scenario)),
        text("main_loop.c".to_owned(), main_loop::main_loop(&plan)),
        text("Makefile".to_owned(), static_files::makefile(prefix, &hashes)),
        text("README.md".to_owned(), static_files::readme(&plan, &hashes, vectors.len(), &accuracy)),
        PackageFile { path: "vectors.bin".to_owned(), bytes: vectors::to_bytes(vectors) },
    ]);
    files
        .extend(static_files::board_files().map(|(path, content)| text(path.to_owned(), content.to_owned())));
    let Prepared { calls, vectors, excluded_parts, effective, .. } = prepared;
    files.push(text("scenario.toml".to_owned(), effective));
    files.sort_by(|a, b| a.path.cmp(&b.path));
    Ok(Package { files, calls, vectors: vectors.len(), excluded_parts, accuracy })
}

/// Control system as C alone, for a program around it that another part of flexsc writes.
#[derive(Clone, Debug)]
pub struct ControlSources {
    /// Header and sources, the header first.
    pub files: Vec<PackageFile>,
    /// Control system at the start of a run.
    pub system: ControlSystem,
    /// Functions.
    pub calls: Vec<CallLayout>,
    /// Numbers that are tuned in flight.
    pub parameters: Vec<FlightParameter>,
    /// Words of the inputs with which estimators start in run 0; none without an estimator.
    pub run_start: Vec<u64>,
    /// True if the functions read the time.
    pub has_time: bool,
    /// Scenario with all defaults, whose hash is in the header.
    pub effective: String,
}

/// Writes the control system of a scenario as C alone, with names that begin with `prefix`.
///
/// # Errors
/// An [`ExportError`] if a part of the control system has no plain code, or if its run fails.
pub fn control_sources(
    scenario: &Scenario,
    origin: ExportOrigin<'_>,
    prefix: &str,
) -> Result<ControlSources, ExportError> {
    // The start of the estimators is among the first calls.
    let prepared = Prepared::new(scenario, 64)?;
    let plan = prepared.plan(origin, prefix);
    let Code { header, source, .. } = Code::new(&plan)?;
    let files = vec![text(format!("{prefix}.h"), header), text(format!("{prefix}.c"), source)];
    let (has_time, run_start) = (plan.has_time(), plan.run_start.unwrap_or_default().to_vec());
    let Prepared { system, calls, parameters, effective, .. } = prepared;
    Ok(ControlSources { files, system, calls, parameters, run_start, has_time, effective })
}

fn text(path: String, content: String) -> PackageFile {
    PackageFile { path, bytes: content.into_bytes() }
}
