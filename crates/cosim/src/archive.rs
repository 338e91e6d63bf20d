//! Archive of an FMU: the model description, the library of each platform, its licences and the scenario, with equal bytes at each export.

use std::borrow::Cow;
use std::io::{Cursor, Read, Write};

use zip::result::ZipError;
use zip::write::SimpleFileOptions;
use zip::{CompressionMethod, DateTime, ZipArchive, ZipWriter};

use crate::content::{FmuContent, PART, SCENARIO};
use crate::description::{FmuInterface, model_description};
use crate::error::CoSimulationError;
use crate::fmi_version::{FmiVersion, MODEL_IDENTIFIER};
use crate::fmu_run::FmuRun;
use crate::platform::Platform;

/// Licences of flexsc and of the crates in its library, which release/licences.py writes.
const LICENCES: &str = include_str!("../licences.txt");

/// First bytes of a ZIP archive.
const ZIP: &[u8] = b"PK\x03\x04";
/// Largest size of a library (bytes).
const MOST_BYTES: u64 = 1 << 30;

/// Returns the bytes of an FMU with these libraries, each for a platform; one may be the only file of a ZIP archive, as packages have
/// it.
///
/// # Errors
/// Fails for a platform without a name in this version of FMI, for two libraries of one platform, or an archive that cannot be read.
pub fn fmu_bytes(
    content: &FmuContent,
    libraries: &[(&Platform, Vec<u8>)],
    version: FmiVersion,
) -> Result<Vec<u8>, CoSimulationError> {
    let run = FmuRun::new(content.clone())?;
    let interface = FmuInterface { identifier: MODEL_IDENTIFIER, has_events: true, sources: &[] };
    let description = model_description(run.scenario(), run.table(), &content.token(), version, &interface);
    let mut binaries: Vec<(String, Cow<'_, [u8]>)> = Vec::new();
    for (platform, library) in libraries {
        let folder = platform.folder(version)?;
        let path = format!("binaries/{folder}/{MODEL_IDENTIFIER}{}", platform.suffix);
        if binaries.iter().any(|(other, _)| *other == path) {
            return Err(CoSimulationError::refused(format!("there are two libraries for {folder}")));
        }
        let packed =
            |error| CoSimulationError::refused(format!("cannot unpack the library of FMUs: {error}"));
        binaries.push((path, unpacked(library).map_err(packed)?));
    }
    let mut files = vec![("modelDescription.xml".to_owned(), description.as_bytes())];
    files.extend(binaries.iter().map(|(path, library)| (path.clone(), &library[..])));
    files.extend([
        ("documentation/licenses/license.txt".to_owned(), LICENCES.as_bytes()),
        (format!("resources/{PART}"), content.part.name().as_bytes()),
        (format!("resources/{SCENARIO}"), content.toml.as_bytes()),
    ]);
    archive(&files).map_err(|error| CoSimulationError::refused(format!("cannot pack the FMU: {error}")))
}

/// Returns a library, out of its archive if it is in one.
fn unpacked(library: &[u8]) -> Result<Cow<'_, [u8]>, ZipError> {
    if !library.starts_with(ZIP) {
        return Ok(library.into());
    }
    let mut bytes = Vec::new();
    ZipArchive::new(Cursor::new(library))?.by_index(0)?.take(MOST_BYTES).read_to_end(&mut bytes)?;
    Ok(bytes.into())
}

/// Packs files with the date 1980-01-01 and the permissions of a library.
pub(crate) fn archive(files: &[(String, &[u8])]) -> Result<Vec<u8>, ZipError> {
    let mut zip = ZipWriter::new(Cursor::new(Vec::new()));
    let options = SimpleFileOptions::default()
        .compression_method(CompressionMethod::Deflated)
        .compression_level(Some(6))
        .last_modified_time(DateTime::default())
        .unix_permissions(0o755);
    for (name, bytes) in files {
        zip.start_file(name.as_str(), options)?;
        zip.write_all(bytes)?;
    }
    Ok(zip.finish()?.into_inner())
}
