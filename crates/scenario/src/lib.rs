//! Scenario: everything that a user writes about a study, and the data that follow from it before a run.

mod actuator_checks;
mod adaptation_checks;
mod appendage_drives;
mod assembly;
mod assessed_requirement;
mod authority;
mod bound;
mod compatibility;
mod consistency;
mod contrast_requirement;
mod cost;
mod coupling;
mod custom_parts;
mod drift_checks;
mod environment_checks;
mod epoch;
mod estimator_context;
mod failures;
mod fast_path;
mod fault;
mod file_name;
mod fine_mirror;
mod formula_checks;
mod line_of_sight;
mod log;
mod logged_scenario;
mod magnitudes;
mod meant;
mod measured_path;
pub mod metric_descriptions;
mod mode_checks;
mod motion_estimate;
mod one_mode;
mod optics;
mod pace;
mod plate_mounts;
mod precision_checks;
mod quantity_names;
mod reference_values;
mod remarks;
mod requirement;
mod requirement_checks;
mod resolved;
mod saturation;
mod sensor_checks;
mod small_angle_checks;
mod spec;
mod title_block;
pub mod uncertain;
mod written_units;

use std::ops::Deref;
use std::path::Path;
use std::sync::{Arc, OnceLock};

use flexsc_control::law::{ErrorBand, Setpoint};
use flexsc_control::operation::ModeTables;
use flexsc_control::sensor::SensorKind;
use flexsc_dynamics::axis_model::AxisModel;
use flexsc_dynamics::linear::LinearFlow;
use flexsc_formats::document::{ConfigError, Document, ScenarioError};
use flexsc_formats::reader_units::{ReaderUnit, ReaderUnits};
use flexsc_numerics::time::{Instant, Span};
use flexsc_spacecraft::body::{Body, BodyModel};
use flexsc_spacecraft::manoeuvre::Plan;

pub use appendage_drives::AppendageDrives;
pub use assessed_requirement::{
    AssessedRequirement, IndexWindow, RequirementFormula, RequirementSource, SampledError, SampledQuantity,
    mode_of,
};
pub use bound::BoundSpec;
pub use contrast_requirement::ContrastRequirement;
pub use cost::{Cost, MOST_RUNS};
pub use custom_parts::{CustomLaw, CustomParts};
pub use epoch::date_from_text;
pub use failures::FailureInterval;
pub use fault::{ACTIVE_FAULT, Fault, NO_FAULT, PartFailures};
pub use fine_mirror::FineMirror;
pub use line_of_sight::LineOfSight;
pub use log::{LogSpec, SceneSpec};
pub use measured_path::{MeasuredPath, PATH_HAS_NO_RUN};
pub use optics::{LineSensitivity, OpticalElement};
pub use reference_values::{Pointing, Reference};
pub use requirement::{ErrorAxis, Interpretation, Limit, PointingIndex, Requirement, WindowConvention};
pub use resolved::ResolvedScenario;
pub use spec::ScenarioSpec;
pub use title_block::TitleBlock;
use written_units::WrittenUnits;

/// A validated scenario: the keys as written, and the data resolved from them.
#[derive(Clone, Debug, PartialEq)]
pub struct Scenario {
    /// Keys as written, with defaults.
    pub written: ScenarioSpec,
    /// Model of the body.
    pub model: BodyModel,
    /// Plan of the manoeuvre, if there is one.
    pub plan: Option<Plan>,
    /// Exact flow of a one-axis body with coupled modes, where the motion has a closed form.
    pub linear: Option<Arc<LinearFlow>>,
    /// Data resolved from all parts together.
    pub study: ResolvedScenario,
    units: WrittenUnits,
}

impl Deref for Scenario {
    type Target = ScenarioSpec;

    fn deref(&self) -> &ScenarioSpec {
        &self.written
    }
}

impl Scenario {
    /// Reads a scenario file.
    pub fn load(path: &Path) -> Result<Self, ScenarioError> {
        Self::from_document(&Document::load(path)?)
    }

    /// Reads a scenario from a text. `origin` is its name in error messages.
    pub fn parse(origin: &str, text: &str) -> Result<Self, ScenarioError> {
        Self::from_document(&Document::parse(origin, text.to_owned())?)
    }

    /// Reads a scenario from a document.
    pub fn from_document(document: &Document) -> Result<Self, ScenarioError> {
        Self::solved(document, None, &CustomParts::default())
    }

    /// Reads a scenario from a document that differs from `parent` in some keys. If the body is not among them, its
    /// modes are reused.
    pub fn from_document_reusing(document: &Document, parent: &Self) -> Result<Self, ScenarioError> {
        Self::solved(document, Some(parent), &parent.custom_parts())
    }

    fn solved(document: &Document, parent: Option<&Self>, own: &CustomParts) -> Result<Self, ScenarioError> {
        let units_written =
            parent.map_or_else(|| WrittenUnits::from_table(document.table()), |parent| parent.units.clone());
        let document = &*document.in_si::<ScenarioSpec>(units)?;
        let (written, model) = Self::assembled(document, parent, own)?;
        let fitted = Self::fitted(written, model).map_err(|errors| document.at_keys(&errors))?;
        Ok(Self { units: units_written, ..fitted })
    }

    /// Returns the keys of a document in SI units, with custom parts, and the model of the body.
    fn assembled(
        document: &Document,
        parent: Option<&Self>,
        own: &CustomParts,
    ) -> Result<(ScenarioSpec, BodyModel), ScenarioError> {
        if let Some(fault) = law_beside_modes(document) {
            return Err(document.at_key(&fault));
        }
        let mut written: ScenarioSpec = document.read()?;
        written.write_uncertain_factors();
        written.inherit_custom_parts(own, document);
        written.adopt_modes().map_err(|fault| document.at_key(&fault))?;
        if written.name.is_empty() {
            let stem = Path::new(document.origin()).file_stem();
            written.name = stem.unwrap_or_default().to_string_lossy().into_owned();
        }
        let directory = Path::new(document.origin()).parent().unwrap_or(Path::new(""));
        let fault =
            epoch::validate(written.epoch.as_ref()).or_else(|| written.read_environment(parent, directory));
        let fault = fault.or_else(|| written.read_disturbances(directory));
        let fault = fault.or_else(|| written.read_measured_paths(directory));
        if let Some(fault) = fault {
            return Err(document.at_key(&fault));
        }
        let model = written.assemble(document, parent, directory)?;
        if written.law.offers().is_open
            && !document.has("law")
            && written.manoeuvre.is_none()
            && written.mode.is_empty()
        {
            return Err(document.missing("law"));
        }
        Ok((written, model))
    }

    /// Completes a scenario from its keys and its model: checks that they are consistent, resolves the data, and plans
    /// the manoeuvre.
    ///
    /// # Errors
    /// All errors of the keys and of their combination; of data that are resolved from consistent keys, the first.
    fn fitted(mut written: ScenarioSpec, model: BodyModel) -> Result<Self, Vec<ConfigError>> {
        let only = |error| vec![error];
        written.adopt_modes().map_err(only)?;
        written.activate_fault().map_err(only)?;
        let errors = written.conflicts(&model, &written.offers(&model));
        if !errors.is_empty() {
            return Err(errors);
        }
        let scenario = Self::resolved(written, model).map_err(only)?;
        match scenario.conflicts_of_motion() {
            errors if errors.is_empty() => scenario.planned().map_err(only),
            errors => Err(errors),
        }
    }

    /// Resolves the data of all parts together, but for the plan.
    fn resolved(written: ScenarioSpec, model: BodyModel) -> Result<Self, ConfigError> {
        let mut study = ResolvedScenario::resolve(&written, &model)?;
        let mut errors = Vec::new();
        let checked = requirement_checks::assessed(&written, &model, study.assessment_period, &mut errors);
        (study.requirements, study.contrasts) = (checked.of_runs, checked.of_contrast);
        match errors.into_iter().next() {
            None => {
                Ok(Self { written, model, plan: None, linear: None, study, units: WrittenUnits::default() })
            }
            Some(error) => Err(error),
        }
    }

    /// Plans the manoeuvre, and adds the exact flow.
    fn planned(mut self) -> Result<Self, ConfigError> {
        self.plan = self.plan()?;
        self.linear = self.linear_flow()?;
        Ok(self)
    }

    /// Returns the one-axis body, for analyses that need one.
    ///
    /// # Errors
    /// Fails for a three-axis body.
    pub fn one_angle(&self) -> Result<&AxisModel, ScenarioError> {
        self.model.one_axis().ok_or_else(|| ScenarioError::Key {
            origin: self.name.clone(),
            key: self.body_key(),
            why: "turns about three axes, and this is done for bodies with one angle".to_owned(),
        })
    }

    /// Returns the number of elastic modes of the body.
    pub fn mode_count(&self) -> usize {
        self.model.mode_count()
    }

    /// Plans the manoeuvre, if there is one.
    fn plan(&self) -> Result<Option<Plan>, ConfigError> {
        let (Some(manoeuvre), Some(own)) = (&self.manoeuvre, self.model.one_axis()) else { return Ok(None) };
        let body = manoeuvre.planned_for(own);
        if body.drive != own.drive {
            let why = "must be the same as the body's".to_owned();
            return Err(ConfigError::new("manoeuvre.model.drive", why));
        }
        let (start, rate) = (manoeuvre.start_rate.get(), own.rate.get());
        if start != rate {
            let why = format!("must be the body's rate at the start, {rate}, got {start}");
            return Err(ConfigError::new("manoeuvre.start_rate", why));
        }
        manoeuvre.plan(&body).map(Some).map_err(|fault| fault.within("manoeuvre"))
    }

    /// Returns the setpoint of a one-axis body: the end of the manoeuvre, or angle 0 from the start on.
    pub fn goal(&self) -> Setpoint {
        let planned = self.plan.as_ref().zip(self.model.one_axis());
        planned.map_or_else(Setpoint::default, |(plan, body)| Setpoint {
            from: Instant::START + Span::from_seconds(plan.time),
            angle: body.angle.get() + plan.angle,
            rate: plan.end_rate,
            acceleration: 0.0,
        })
    }

    /// Returns the error band about the goal: as written in the scenario, else as the manoeuvre or the law promises.
    pub fn expected_band(&self) -> ErrorBand {
        match (self.reference.band, &self.plan) {
            (Some(band), _) => ErrorBand::Absolute(band.get()),
            (None, Some(plan)) => ErrorBand::Absolute(plan.band()),
            (None, None) => match self.study.expected_bands.first() {
                Some(Some(band)) if self.axis_count() == 1 => ErrorBand::Absolute(*band),
                _ => self.law.expected_band(),
            },
        }
    }

    /// Returns true if runs are judged by a goal: the scenario gives its band, or no requirement takes its place. A requirement
    /// on a metric that depends on the band of the goal leaves it there.
    pub fn has_goal(&self) -> bool {
        let limits_goal = |requirement: &AssessedRequirement| match &requirement.source {
            RequirementSource::Metric(name, _) => metric_descriptions::needs_goal(name),
            RequirementSource::Error(_) | RequirementSource::Formula(_) => false,
        };
        self.reference.band.is_some()
            || self.requirement.iter().all(Requirement::is_of_contrast)
            || self.study.requirements.iter().any(limits_goal)
    }

    /// Returns the key of the quantity that a requirement with this name limits, such as `requirement[0].holds`.
    pub fn requirement_key(&self, name: &str) -> String {
        match self.requirement.iter().enumerate().find(|(_, own)| own.name == name) {
            Some((index, own)) => {
                format!("requirement[{index}].{}", if own.holds.is_some() { "holds" } else { "quantity" })
            }
            None => "reference.pointing.rms".to_owned(),
        }
    }

    /// Returns the keys without references to files: matrices of a structure are replaced by their modes, paths of mode
    /// files by the modes.
    #[must_use]
    pub fn self_contained(&self) -> ScenarioSpec {
        let mut written = self.written.clone();
        written.inline_files();
        if let (Some(Body::Matrices(_)), Some(body)) = (&written.body, self.model.one_axis()) {
            written.body = Some(Body::Planar(body.into()));
            // The gains of the modes are those of the load.
            if let Some(manoeuvre) = &mut written.manoeuvre {
                manoeuvre.load = None;
            }
            let of_matrices =
                |key: &String| key.starts_with("body.matrices") || key.starts_with("manoeuvre.load");
            written.uncertain.retain(|key, _| !of_matrices(key));
            written.correlated.retain(|group| !group.keys.iter().any(of_matrices));
        }
        written
    }

    /// Returns the modes of operation as lists of numbers, before a run.
    pub fn mode_tables(&self) -> ModeTables {
        let kinds: Vec<&str> = self.sensor.iter().map(SensorKind::kind).collect();
        ModeTables::from_modes(&self.mode, &kinds, self.study.assessment_period)
    }

    /// Returns the JSON Schema of scenarios.
    pub fn schema() -> serde_json::Value {
        schemars::schema_for!(ScenarioSpec).to_value()
    }

    /// Returns true if a scenario of these kinds has a key, also one that is not written and has its default.
    pub fn has_key(&self, key: &str) -> bool {
        Document::from_table(&self.name, self.table_without_custom_parts()).knows::<ScenarioSpec>(key)
    }

    /// Checks the names in a key, which a scenario of these kinds must have; elements of arrays are not checked.
    ///
    /// # Errors
    /// A name that does not exist, with the near ones.
    pub fn validate_key(&self, key: &str) -> Result<(), ScenarioError> {
        if self.has_key(key) {
            return Ok(());
        }
        let mut document = Document::from_table(&self.name, self.table_without_custom_parts());
        // Where an array has no such element, the user of the key gives the reason.
        if document.set(key, toml::Value::Float(1.0)).is_err() {
            return Ok(());
        }
        document.read::<ScenarioSpec>().map(drop)
    }

    /// Returns the number that a text is as the value of a key, in the unit of the key: `2 deg` of an angle, or `0.02`.
    ///
    /// # Errors
    /// A unit that does not fit the key, and a text that is no number. Whether there is such a key is not checked.
    pub fn number_of(&self, key: &str, text: &str) -> Result<f64, ScenarioError> {
        if let Some(number) = text.trim().parse::<f64>().ok().filter(|number| number.is_finite()) {
            return Ok(number);
        }
        let mut document = Document::from_table(&self.name, self.table_without_custom_parts());
        document.set(key, text.trim().into())?;
        let document = document.in_si::<ScenarioSpec>(units)?;
        let value = flexsc_formats::document::key::get(document.table(), key).and_then(toml::Value::as_float);
        let why = || format!("must be a number, or a number with a unit, got `{text}`");
        value.ok_or_else(|| document.at_key(&ConfigError::new(key, why())))
    }

    /// Returns the number that a key has, in its SI unit; `None` for a key that is not written or is no number.
    pub fn number_at(&self, key: &str) -> Option<f64> {
        let table = self.table_without_custom_parts();
        let value = flexsc_formats::document::key::get(&table, key)?;
        value.as_float().or_else(|| value.as_integer().map(|whole| whole as f64))
    }

    /// Returns the unit of a key, such as rad/s of `body.planar.rate`; `None` for a dimensionless key.
    pub fn unit_of(&self, key: &str) -> Option<&'static str> {
        let unit = flexsc_formats::document::unit_at(units(), key)?;
        Some(if unit == "N m" && self.model.has_unit_inertia() { "rad/s²" } else { unit })
    }

    /// Returns the unit in which a key is written, such as Hz; `None` for a plain number.
    pub fn written_unit(&self, key: &str) -> Option<&str> {
        self.units.get(key)
    }

    /// Returns the unit in which people read values of a key, the largest of which is given.
    pub fn reader_unit(&self, key: &str, largest: f64, units: ReaderUnits) -> ReaderUnit {
        units.for_key(key, self.written_unit(key), largest, self.unit_of(key).unwrap_or_default())
    }
}

/// Returns the error of a law beside modes of operation, which have laws of their own.
fn law_beside_modes(document: &Document) -> Option<ConfigError> {
    let modes = document.table().get("mode")?.as_array().filter(|modes| !modes.is_empty())?;
    let named = |(index, mode): (usize, &toml::Value)| {
        let kind = mode.get("law")?.as_table()?.keys().next()?;
        let name = mode.get("name").and_then(toml::Value::as_str).unwrap_or_default();
        Some(format!("`mode[{index}].law.{kind}` ({name})"))
    };
    let laws: Vec<String> = modes.iter().enumerate().filter_map(named).collect();
    let laws = if laws.is_empty() { String::new() } else { format!(": {}", laws.join(", ")) };
    let why = format!("must be left out with `[[mode]]`: each mode has a law of its own{laws}");
    document.has("law").then(|| ConfigError::new("law", why))
}

/// Returns the JSON Schema, whose descriptions contain the units of the keys.
fn units() -> &'static serde_json::Value {
    static SCHEMA: OnceLock<serde_json::Value> = OnceLock::new();
    SCHEMA.get_or_init(Scenario::schema)
}
