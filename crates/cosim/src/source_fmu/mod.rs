//! FMU of a control system as sources: its exported C, and an interface around it, which every platform compiles.

mod bindings;
mod calls;
mod variables;

use std::path::Path;

use flexsc_core::Scenario;
use flexsc_export_c::package::{ExportError, ExportOrigin, control_sources};

use crate::archive::archive;
use crate::content::{SCENARIO, token_of};
use crate::description::{FmuInterface, model_description};
use crate::error::CoSimulationError;
use crate::fmi_version::FmiVersion;
use crate::xml::XmlWriter;
use bindings::SourceModel;

/// Licence of the sources.
const LICENCE: &str = "The code under `sources` is translated from or part of flexsc: SPDX-License-Identifier: MIT OR Apache-2.0.\n";

/// Error of an export as sources.
#[derive(Debug)]
pub enum SourceFmuError {
    /// The control system is not exported.
    Export(ExportError),
    /// The archive cannot be written.
    Archive(CoSimulationError),
}

impl From<ExportError> for SourceFmuError {
    fn from(error: ExportError) -> Self {
        Self::Export(error)
    }
}

impl From<CoSimulationError> for SourceFmuError {
    fn from(error: CoSimulationError) -> Self {
        Self::Archive(error)
    }
}

/// Returns the bytes of the FMU of a scenario's control system as sources, with names in C that begin with `prefix`.
///
/// # Errors
/// Fails for a control system without plain code, and if its run fails.
pub fn source_fmu_bytes(
    scenario: &Scenario,
    origin: ExportOrigin<'_>,
    prefix: &str,
    version: FmiVersion,
) -> Result<Vec<u8>, SourceFmuError> {
    if scenario.has_custom_parts() {
        let roles = scenario.custom_parts().each().join(", ");
        let why = format!("{}: has custom parts ({roles}), which no FMU can contain", scenario.name);
        return Err(CoSimulationError::refused(why).into());
    }
    let exported = control_sources(scenario, origin, prefix)?;
    let model = SourceModel::new(scenario, &exported);
    let token = token_of("controller sources", &exported.effective);
    let interface_source = match version {
        FmiVersion::V2 => ("fmi2.c", include_str!("files/fmi2.c")),
        FmiVersion::V3 => ("fmi3.c", include_str!("files/fmi3.c")),
    };
    let mut sources: Vec<(String, Vec<u8>)> =
        exported.files.iter().map(|file| (file.path.clone(), file.bytes.clone())).collect();
    let mut add = |name: &str, text: &str| sources.push((name.to_owned(), text.as_bytes().to_vec()));
    add("fmu_model.h", &calls::model_header(&model, prefix, scenario.flight_precision, &token));
    add("fmu_calls.c", &calls::calls_source(&model, &exported, scenario, prefix));
    add("fmu_instance.h", include_str!("files/fmu_instance.h"));
    add("fmu_instance.c", include_str!("files/fmu_instance.c"));
    add(interface_source.0, interface_source.1);
    let compiled: Vec<String> = sources
        .iter()
        .map(|(name, _)| name.clone())
        .filter(|name| Path::new(name).extension().is_some_and(|own| own == "c"))
        .collect();
    if version == FmiVersion::V3 {
        sources.push(("buildDescription.xml".to_owned(), build_description(prefix, &compiled).into_bytes()));
    }
    let interface = FmuInterface { identifier: prefix, has_events: false, sources: &compiled };
    let description = model_description(scenario, &model.table, &token, version, &interface);
    let mut files = vec![("modelDescription.xml".to_owned(), description.as_bytes())];
    files.extend(sources.iter().map(|(name, bytes)| (format!("sources/{name}"), &bytes[..])));
    files.extend([
        ("documentation/licenses/license.txt".to_owned(), LICENCE.as_bytes()),
        (format!("resources/{SCENARIO}"), exported.effective.as_bytes()),
    ]);
    let packed = |error| CoSimulationError::refused(format!("cannot pack the FMU: {error}"));
    Ok(archive(&files).map_err(packed)?)
}

/// Returns the description of FMI 3.0 by which an importer compiles the sources.
fn build_description(identifier: &str, sources: &[String]) -> String {
    let mut xml = XmlWriter::new();
    let attribute = |name: &'static str, value: &str| (name, value.to_owned());
    xml.open("fmiBuildDescription", &[attribute("fmiVersion", "3.0")]);
    xml.open("BuildConfiguration", &[attribute("modelIdentifier", identifier)]);
    xml.open("SourceFileSet", &[attribute("language", "C99")]);
    for source in sources {
        xml.empty("SourceFile", &[attribute("name", source)]);
    }
    xml.finish()
}
