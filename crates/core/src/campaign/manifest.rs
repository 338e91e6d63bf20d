//! Manifest of a campaign's directory: all that its rows depend on, as TOML.

use std::ops::Range;

use flexsc_formats::document::ScenarioError;
use flexsc_numerics::random::fnv1a;
use flexsc_record::difference;
use serde::{Deserialize, Serialize};
use toml::{Table, Value};

use super::design::Design;
use super::{Campaign, part};
use crate::metrics::Selection;
use flexsc_scenario::Scenario;

/// Version of the directory format that this program writes.
const FORMAT: u32 = 1;
/// First line of the file.
const MARK: &str = "# A campaign of flexsc: what the parts beside it are made from.\n";
/// Largest size of a manifest (bytes).
pub const LARGEST: u64 = 1 << 30;

/// Everything that determines a campaign's rows, and the range of its runs that are wanted.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Manifest {
    /// The form of the directory.
    pub format: u32,
    /// The version of flexsc: another one may compute other digits.
    pub flexsc: String,
    /// Hash of version, scenario, metrics and design, which identifies the campaign.
    pub hash: String,
    /// The first run.
    pub from: u64,
    /// The run after the last.
    pub to: u64,
    /// How many runs a part has, which begins at a multiple of it.
    pub part: u64,
    /// The metrics that the rows have; default: all.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub metrics: Option<Vec<String>>,
    /// The scenario, which needs no file.
    pub scenario: String,
    /// The points.
    pub design: Design,
}

/// Reason why a manifest is not that of a campaign, or not of this one.
pub type ManifestError = String;

impl Manifest {
    /// Returns the manifest of some runs of a campaign.
    ///
    /// # Errors
    /// A campaign that cannot be written as text.
    pub fn new(campaign: &Campaign, runs: Range<u64>, selection: &Selection) -> Result<Self, ManifestError> {
        if campaign.scenario().has_custom_parts() {
            return Err("has parts defined by a program, which a file cannot contain".to_owned());
        }
        Self::in_memory(campaign, runs, selection)
    }

    /// Returns the manifest of a campaign that need not be written as text.
    pub(super) fn in_memory(
        campaign: &Campaign,
        runs: Range<u64>,
        selection: &Selection,
    ) -> Result<Self, ManifestError> {
        let design = campaign.design().clone();
        if design.runs().is_some_and(|all| runs.end > all) {
            let all = design.runs().unwrap_or_default();
            return Err(format!(
                "the design has {all} runs, and runs {} to {} were requested",
                runs.start, runs.end
            ));
        }
        let seconds = campaign.cost(1, None)?.seconds;
        let mut manifest = Self {
            format: FORMAT,
            flexsc: env!("CARGO_PKG_VERSION").to_owned(),
            hash: String::new(),
            from: runs.start,
            to: runs.end,
            part: part::part_size(runs.end - runs.start, seconds),
            metrics: selection.names().map(|names| names.iter().map(|&name| name.to_owned()).collect()),
            scenario: campaign.to_toml(),
            design,
        };
        manifest.hash = manifest.hashed();
        Ok(manifest)
    }

    fn hashed(&self) -> String {
        let design = toml::to_string(&self.design).unwrap_or_default();
        let metrics = self.metrics.as_ref().map_or(String::new(), |names| names.join(","));
        let text =
            [&self.flexsc, &self.scenario, &metrics, &design].map(|text| format!("{}\n{text}", text.len()));
        format!("{:016x}", fnv1a(&text.concat()))
    }

    /// Returns the manifest as text.
    pub fn to_toml(&self) -> String {
        // The manifest contains nothing that TOML cannot express.
        format!("{MARK}{}", toml::to_string(self).unwrap_or_default())
    }

    /// Parses a manifest.
    pub fn parse(text: &str) -> Result<Self, ManifestError> {
        if !text.starts_with(MARK.trim_end()) {
            return Err("is not the manifest of a campaign".to_owned());
        }
        let wrong =
            |error: toml::de::Error| format!("is not the manifest of a campaign: {}", error.message());
        let table: Table = toml::from_str(text).map_err(wrong)?;
        let form = table.get("format");
        if form.and_then(Value::as_integer) != Some(i64::from(FORMAT)) {
            let form = form.map_or("none".to_owned(), Value::to_string);
            return Err(format!("has the form {form}, and this version of flexsc reads form {FORMAT}"));
        }
        let manifest: Self = table.try_into().map_err(wrong)?;
        if manifest.hash != manifest.hashed() {
            return Err("was changed: its hash does not match".to_owned());
        }
        if manifest.from >= manifest.to || manifest.part == 0 || manifest.part > 1 << 24 {
            return Err("has no runs".to_owned());
        }
        Ok(manifest)
    }

    /// Limits the work of a part to about `seconds` (s), for schedulers; existing parts stay.
    pub fn limit_part_size(&mut self, seconds: f64) {
        let part = (self.part as f64 * seconds / part::WORK_S).clamp(1.0, 65_536.0) as u64;
        self.part = part.next_power_of_two();
    }

    /// Returns the runs that are wanted.
    pub fn runs(&self) -> Range<u64> {
        self.from..self.to
    }

    /// Returns the missing runs part by part, given the names of the existing files. Files that are no parts are
    /// ignored.
    pub fn missing<'a>(&self, files: impl IntoIterator<Item = &'a str>) -> Vec<Range<u64>> {
        let mut present: Vec<_> = files.into_iter().filter_map(part::runs_of).collect();
        present.sort_by_key(|runs| (runs.start, runs.end));
        let gaps = part::remove_present(self.runs(), &present);
        gaps.into_iter().flat_map(|gap| part::split(gap, self.part)).collect()
    }

    /// Returns the first difference from the manifest of another campaign; `None` if they differ in their runs alone.
    pub fn first_difference(&self, other: &Self) -> Option<String> {
        if self.hash == other.hash {
            return None;
        }
        if self.flexsc != other.flexsc {
            return Some(format!("flexsc {} before, {} now", self.flexsc, other.flexsc));
        }
        let scenario = difference(&self.scenario, &other.scenario);
        if !scenario.is_empty() {
            return Some(scenario.trim_start_matches(" (").trim_end_matches(')').to_owned());
        }
        if self.metrics != other.metrics {
            let names =
                |manifest: &Self| manifest.metrics.as_ref().map_or("all".to_owned(), |names| names.join(","));
            return Some(format!("metrics {} before, {} now", names(self), names(other)));
        }
        let reported = |manifest: &Self, other: &Self| {
            let (design, other) = (manifest.design.describe(), other.design.describe());
            let line = design.lines().find(|line| !other.lines().any(|present| present == *line));
            line.map_or("nothing".to_owned(), |line| line.trim_start_matches("# ").to_owned())
        };
        Some(format!("{} before, {} now", reported(self, other), reported(other, self)))
    }

    /// Returns the metrics of the rows.
    pub fn selection(&self) -> Result<Selection, ManifestError> {
        self.metrics.as_ref().map_or(Ok(Selection::ALL), Selection::from_names)
    }

    /// Returns the campaign. Its errors name the scenario, and no file: they are equal on every machine.
    pub fn campaign(&self) -> Result<Campaign, ScenarioError> {
        let scenario = Scenario::parse("scenario", &self.scenario)?;
        let name = scenario.name.clone();
        Campaign::from_design(scenario, &name, self.design.clone())
    }
}
