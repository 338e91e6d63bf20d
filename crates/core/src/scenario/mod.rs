//! The scenario: everything that a user writes about a study, and nothing that moves.

mod adapting;
mod assignment;
mod authority;
mod consistency;
mod cost;
mod coupled;
mod drifting;
mod drives;
mod epoch;
mod failing;
mod known;
mod learning;
mod log;
mod own;
mod parts;
mod plain;
mod reference;
mod sensing;
mod sky;
mod spacecraft;
mod study;

use std::collections::BTreeMap;
use std::path::Path;
use std::sync::{Arc, OnceLock};

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use toml::{Table, value::Datetime};

use crate::actuator::Assigned;
use crate::adaptation::Adaptation;
use crate::body::craft::{Appendage, Spacecraft};
use crate::body::{Body, Chain, Drift, Planar};
use crate::disturbance::Disturbance;
use crate::document::{Document, Fault, ScenarioError};
use crate::environment::Environment;
use crate::estimator::Estimator;
use crate::law::{Goal, Law, Promise, Target};
use crate::manoeuvre::{Manoeuvre, Plan};
use crate::motion::linear::Linear;
use crate::parts::Parts;
use crate::sensor::Sensor;
use crate::time::{Instant, Span};
use crate::uncertain::{Correlated, Distribution};

use epoch::nanoseconds_since_1970;

pub use cost::{Cost, MOST_RUNS};
pub use drives::{Courses, Drives};
pub use failing::Failing;
pub use log::{Log, SceneSpec};
pub use own::OwnParts;
pub use reference::{Pointing, Reference};
pub use study::Study;

/// A scenario.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Scenario {
    /// Name of the study; default: the name of its file.
    #[serde(default)]
    pub name: String,
    /// Description of the study.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub about: String,
    /// Seed of all random numbers.
    #[serde(default)]
    pub seed: u64,
    /// Simulated time (s).
    pub duration: Span,
    /// Date and time of the start; a log counts its time from here.
    #[serde(default, skip_serializing_if = "Option::is_none", deserialize_with = "epoch::read")]
    #[schemars(with = "Option<String>")]
    pub epoch: Option<Datetime>,
    /// The controlled body, unless it is a `spacecraft`.
    #[serde(default, skip_serializing_if = "Body::is_spacecraft")]
    pub body: Body,
    /// The hub of a controlled spacecraft, which is built from its parts.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub spacecraft: Option<Spacecraft>,
    /// Appendages clamped to the hub of the spacecraft.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub appendage: Vec<Appendage>,
    /// The body with its modes, as it moves: solved from `body`. Of a spatial body it is empty: see `study`.
    #[serde(skip)]
    pub model: Planar,
    /// Drift of the natural frequencies; default: none.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub drift: Option<Drift>,
    /// The sensor, or an array of several.
    #[serde(default)]
    pub sensor: Parts<Sensor>,
    /// The estimator.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub estimator: Option<Estimator>,
    /// The adaptation.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub adaptation: Option<Adaptation>,
    /// The planned manoeuvre.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub manoeuvre: Option<Manoeuvre>,
    /// The plan of the manoeuvre.
    #[serde(skip)]
    pub plan: Option<Plan>,
    /// The control law. Only a scenario with a manoeuvre can omit it.
    #[serde(default)]
    pub law: Law,
    /// The actuator, which executes the commanded torque, or an array of several.
    #[serde(default)]
    pub actuator: Parts<Assigned>,
    /// Disturbance torques and forces.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub disturbance: Vec<Disturbance>,
    /// Environment of a body with three axes; default: none.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub environment: Option<Environment>,
    /// Contents of a full log.
    #[serde(default)]
    pub log: Log,
    /// Target attitudes of a body with three axes, in the order of their times; before the first one, the target is the
    /// inertial axes. A law `phase_plane` may have targets of its own.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub target: Vec<Target>,
    /// Reference values for the metrics.
    #[serde(default, skip_serializing_if = "Reference::is_empty")]
    pub reference: Reference,
    /// Distributions of keys from which a campaign draws a value for each run.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub uncertain: BTreeMap<String, Distribution>,
    /// Correlated keys of `uncertain`.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub correlated: Vec<Correlated>,
    /// The exact flow of a body whose modes are coupled, where the motion is in closed form.
    #[serde(skip)]
    pub linear: Option<Arc<Linear>>,
    /// The exact chain, where the scenario asks for it.
    #[serde(skip)]
    pub chain: Option<Chain>,
    /// What the parts come to together.
    #[serde(skip)]
    pub study: Study,
}

impl Scenario {
    /// Reads a scenario file.
    pub fn load(path: &Path) -> Result<Self, ScenarioError> {
        Self::from_document(&Document::load(path)?)
    }

    /// Reads a scenario from a text. `origin` is what errors call it.
    pub fn parse(origin: &str, text: &str) -> Result<Self, ScenarioError> {
        Self::from_document(&Document::parse(origin, text.to_owned())?)
    }

    /// Reads a scenario from a document.
    pub fn from_document(document: &Document) -> Result<Self, ScenarioError> {
        Self::solved(document, None, &OwnParts::default(), true)
    }

    /// Reads a scenario from a document that differs from another scenario in some keys. If the body is not among them,
    /// its modes are taken over.
    pub fn from_document_like(document: &Document, parent: &Self) -> Result<Self, ScenarioError> {
        Self::solved(document, Some(parent), &parent.own_parts(), true)
    }

    /// The same of a document that differs in the values of numbers alone: every key of it is known.
    pub(crate) fn from_numbers_like(document: &Document, parent: &Self) -> Result<Self, ScenarioError> {
        Self::solved(document, Some(parent), &parent.own_parts(), false)
    }

    fn solved(
        document: &Document,
        parent: Option<&Self>,
        own: &OwnParts,
        new_keys: bool,
    ) -> Result<Self, ScenarioError> {
        let document = &*document.in_si(units)?;
        let mut scenario: Self = document.read()?;
        if let Some(error) = new_keys.then(|| document.unread(&scenario.to_table())).flatten() {
            return Err(error);
        }
        scenario.take_own_parts(own, document);
        if scenario.name.is_empty() {
            let stem = Path::new(document.origin()).file_stem();
            scenario.name = stem.unwrap_or_default().to_string_lossy().into_owned();
        }
        let directory = Path::new(document.origin()).parent().unwrap_or(Path::new(""));
        scenario.body.locate(directory);
        scenario.put_together(document, parent, directory)?;
        let key = scenario.body.key();
        let in_body = |fault: Fault| document.inconsistent(&fault.within(&key));
        scenario.body.read(parent.map(|parent| &parent.body)).map_err(in_body)?;
        scenario.model = match parent.filter(|parent| parent.body == scenario.body) {
            Some(parent) => parent.model.clone(),
            None => scenario.body.solve().map_err(in_body)?,
        };
        scenario.chain = scenario.body.chain(&scenario.model);
        if matches!(scenario.law, Law::Open(_)) && !document.has("law") && scenario.manoeuvre.is_none() {
            return Err(document.missing("law"));
        }
        let inconsistent = |fault: Fault| document.inconsistent(&fault);
        scenario.fit().map_err(inconsistent)?;
        match scenario.inconsistency() {
            None => {
                scenario.plan = scenario.planned().map_err(inconsistent)?;
                scenario.linear = scenario.flow().map_err(inconsistent)?;
            }
            Some(problem) => return Err(inconsistent(problem)),
        }
        Ok(scenario)
    }

    /// The scenario's body of one angle, for what is an analysis of such bodies.
    ///
    /// # Errors
    /// The body is a spatial one.
    pub fn one_angle(&self) -> Result<&Planar, ScenarioError> {
        match &self.body {
            Body::Planar(_) | Body::Matrices(_) | Body::Panels(_) => Ok(&self.model),
            Body::Spatial(_) | Body::Spacecraft(_) => Err(ScenarioError::Key {
                origin: self.name.clone(),
                key: self.body.key(),
                why: "turns about three axes, and this is done for bodies with one angle".to_owned(),
            }),
        }
    }

    /// How many elastic modes the body has.
    pub fn mode_count(&self) -> usize {
        self.body.spatial().map_or(self.model.modes.len(), |body| body.modes.len())
    }

    /// The attitudes that a body with three axes shall turn to.
    pub fn targets(&self) -> &[Target] {
        match &self.law {
            Law::PhasePlane(law) if !law.targets.is_empty() => &law.targets,
            _ => &self.target,
        }
    }

    /// The key of the law about an axis.
    pub fn law_key(&self, axis: usize) -> String {
        match &self.law {
            Law::PerAxis(laws) => {
                format!("law.per_axis.{}.{}", crate::attitude::AXES[axis], laws.about(axis).kind())
            }
            law => format!("law.{}", law.kind()),
        }
    }

    /// The plan of the manoeuvre, if there is one.
    fn planned(&self) -> Result<Option<Plan>, Fault> {
        let Some(manoeuvre) = &self.manoeuvre else { return Ok(None) };
        let body = self.planned_for();
        if body.drive != self.model.drive {
            let why = "must be the same as the body's".to_owned();
            return Err(Fault::new("manoeuvre.model.drive", why));
        }
        let (start, rate) = (manoeuvre.start_rate.get(), self.model.rate.get());
        if start != rate {
            let why = format!("must be the body's rate at the start, {rate}, got {start}");
            return Err(Fault::new("manoeuvre.start_rate", why));
        }
        manoeuvre.plan(body).map(Some).map_err(|fault| fault.within("manoeuvre"))
    }

    /// The scenario with all its defaults, as a table.
    pub fn to_table(&self) -> Table {
        // A scenario holds nothing that TOML cannot express.
        Table::try_from(self).unwrap_or_default()
    }

    /// The scenario with all its defaults, as TOML.
    pub fn to_toml(&self) -> String {
        toml::to_string(&self.to_table()).unwrap_or_default()
    }

    /// The body that the manoeuvre is planned for.
    pub fn planned_for(&self) -> &Planar {
        self.manoeuvre.as_ref().and_then(|manoeuvre| manoeuvre.model.as_ref()).unwrap_or(&self.model)
    }

    /// Where the law shall bring the body: the end of the manoeuvre, or angle 0 from the start on.
    pub fn goal(&self) -> Goal {
        self.plan.as_ref().map_or_else(Goal::default, |plan| Goal {
            from: Instant::START + Span::from_seconds(plan.time),
            angle: self.model.angle.get() + plan.angle,
            rate: plan.end_rate,
            acceleration: 0.0,
        })
    }

    /// Period at which a full log holds the motion.
    pub fn log_period(&self) -> Span {
        self.log.period_for(self.duration)
    }

    /// How near to its goal the body has to stay: by the scenario, else as its manoeuvre or its law promises.
    pub fn promise(&self) -> Promise {
        match (self.reference.band, &self.plan) {
            (Some(band), _) => Promise::Within(band.get()),
            (None, Some(plan)) => Promise::Within(plan.band()),
            (None, None) => match self.study.bands.first() {
                Some(Some(band)) if self.axis_count() == 1 => Promise::Within(*band),
                _ => self.law.promise(),
            },
        }
    }

    /// The scenario without need of any file: the matrices of a structure give way to the modes that they came to, the path
    /// of a file of modes to the modes.
    #[must_use]
    pub fn self_contained(&self) -> Self {
        let mut scenario = self.clone().with_own_modes();
        if matches!(self.body, Body::Matrices(_)) {
            scenario.body = Body::Planar(self.model.clone());
            let of_matrices = |key: &String| key.starts_with("body.matrices");
            scenario.uncertain.retain(|key, _| !of_matrices(key));
            scenario.correlated.retain(|group| !group.keys.iter().any(of_matrices));
        }
        scenario
    }

    /// The scenario with the modes of three axes in itself, where they have keys, and not in a file.
    #[must_use]
    pub fn with_own_modes(mut self) -> Self {
        if let Body::Spatial(spatial) = &mut self.body {
            spatial.modes.forget_file();
        }
        self.appendage.iter_mut().for_each(Appendage::forget_file);
        self
    }

    /// The date of the start in nanoseconds since 1970 UTC; 0 without one.
    pub fn epoch_ns(&self) -> u64 {
        self.epoch.as_ref().and_then(nanoseconds_since_1970).unwrap_or(0)
    }

    /// The JSON Schema of scenarios.
    pub fn schema() -> serde_json::Value {
        schemars::schema_for!(Scenario).to_value()
    }

    /// The unit of a key, such as rad/s of `body.planar.rate`; none of a ratio.
    pub fn unit_of(&self, key: &str) -> Option<&'static str> {
        let unit = crate::document::unit_at(units(), key)?;
        let reduced = self.axis_count() == 1 && self.model.has_unit_inertia();
        Some(if unit == "N m" && reduced { "rad/s²" } else { unit })
    }

    /// Whether the torque is more than the switchings of a law.
    pub fn tells_torque(&self) -> bool {
        !self.law.switches() || !self.disturbance.is_empty() || !self.actuator.is_ideal()
    }
}

/// The schema, whose descriptions say the units of keys.
fn units() -> &'static serde_json::Value {
    static SCHEMA: OnceLock<serde_json::Value> = OnceLock::new();
    SCHEMA.get_or_init(Scenario::schema)
}
