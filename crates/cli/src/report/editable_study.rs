//! Blocks of a report one by one, for a page on which the scenario is edited.

use std::path::{Path, PathBuf};

use flexsc_core::formats::document::ConfigError;
use flexsc_core::uncertain::UncertainKey;
use flexsc_core::worst_case::uncertain_box;
use flexsc_core::{Document, Scenario};
use serde_json::{Value as Json, json};

use super::study::Study;
use super::{craft_block, html, loop_blocks};
use crate::check;
use crate::error::CliError;

/// Scenario of a page that edits it, with the blocks of its report.
pub struct EditableStudy {
    study: Study,
    document: Document,
}

impl EditableStudy {
    /// Style of the blocks.
    pub const STYLE: &str = super::page::STYLE;

    /// Reads the text of a scenario, which messages and commands call `file`.
    ///
    /// # Errors
    /// A scenario with mistakes: the object with them that `flexsc check --json` prints.
    pub fn read(file: &str, text: String) -> Result<Self, Json> {
        let path = PathBuf::from(file);
        let read = || -> Result<Self, CliError> {
            let document = Document::read_bytes(&path, text.into_bytes())?;
            let study = Study::from_document(&path, document.clone(), &[])?;
            Ok(Self { study, document })
        };
        read().map_err(|failure| match failure {
            CliError::Scenario(error) => check::refused_object(&path, &error),
            other => json!({"file": file, "accepted": false, "mistakes": [{"message": other.to_string()}]}),
        })
    }

    /// Returns the scenario.
    pub fn scenario(&self) -> &Scenario {
        &self.study.scenario
    }

    /// Returns the object that `flexsc check --json` prints of the scenario, with the ranges of its uncertain keys.
    pub fn checked(&self) -> Json {
        let mut object = check::accepted_object(&self.study.path, &self.study.scenario);
        object["uncertain"] = json!(self.uncertain());
        object
    }

    /// Returns the range of each uncertain key, in SI units, with the place of its value in the text.
    fn uncertain(&self) -> Vec<Json> {
        let keys = uncertain_box(&self.study.scenario).map_or_else(|_| Vec::new(), |ranges| ranges.keys);
        let range = |own: &UncertainKey| {
            let error = self.document.at_key(&ConfigError::new(own.key.clone(), ""));
            let mistakes = error.mistakes();
            let place = mistakes.first().and_then(|own| own.place.as_ref());
            json!({
                "key": own.key, "range": own.limits(), "nominal": own.nominal_number(),
                "line": place.map(|place| place.line), "column": place.map(|place| place.column),
            })
        };
        keys.iter().map(range).collect()
    }

    /// Returns the block of the spacecraft.
    pub fn spacecraft(&self) -> String {
        html::numbered(&craft_block::block(&self.study, None))
    }

    /// Returns the block of the margins, without a search for the worst.
    ///
    /// # Errors
    /// An interruption.
    pub fn margins(&self) -> Result<String, String> {
        let block = loop_blocks::margins(&self.study, false).map_err(|failure| failure.to_string())?;
        Ok(html::numbered(&block.html))
    }

    /// Returns the block of the noise.
    ///
    /// # Errors
    /// An interruption.
    pub fn noise(&self) -> Result<String, String> {
        let block = loop_blocks::noise(&self.study).map_err(|failure| failure.to_string())?;
        Ok(html::numbered(&block.html))
    }

    /// Returns the path by which messages and commands call the scenario.
    pub fn path(&self) -> &Path {
        &self.study.path
    }
}
