//! Scenario as written in a file.

use std::collections::BTreeMap;
use std::path::Path;

use flexsc_control::actuator::AssignedActuator;
use flexsc_control::adaptation::AdaptationKind;
use flexsc_control::custom::Custom;
use flexsc_control::disturbance::DisturbanceSpec;
use flexsc_control::estimator::EstimatorKind;
use flexsc_control::guidance::GuidanceSpec;
use flexsc_control::law::{AttitudeTarget, LawKind, Stages};
use flexsc_control::one_or_many::OneOrMany;
use flexsc_control::operation::{ModeTarget, OperatingMode};
use flexsc_control::sensor::SensorKind;
use flexsc_flight_precision::Precision;
use flexsc_formats::document::ConfigError;
use flexsc_numerics::quantity::Positive;
use flexsc_numerics::time::{Instant, Span};
use flexsc_spacecraft::body::craft::{Appendage, Spacecraft};
use flexsc_spacecraft::body::{Body, Drift};
use flexsc_spacecraft::disturbance::Disturbance;
use flexsc_spacecraft::environment::Environment;
use flexsc_spacecraft::manoeuvre::Manoeuvre;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use toml::{Table, Value, value::Datetime};

use super::fault::{AddedFailures, Fault};
use super::{BoundSpec, LineOfSight, LogSpec, Reference, Requirement, TitleBlock, epoch};
use crate::uncertain::{Correlated, Distribution};

/// A scenario as it is written.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, rename = "Scenario")]
#[schemars(description = "A scenario.")]
pub struct ScenarioSpec {
    /// Name of the study, whose log is `NAME.mcap`; default: the name of its file.
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
    /// Date and time of the start, such as `2026-03-20T14:46:00Z`, from which a log counts its time; a second 60 is a leap
    /// second, at the end of June or December. Default: none.
    #[serde(default, skip_serializing_if = "Option::is_none", deserialize_with = "epoch::parse")]
    #[schemars(with = "Option<String>")]
    pub epoch: Option<Datetime>,
    /// Title block of the page that `flexsc report` writes.
    #[serde(default, skip_serializing_if = "TitleBlock::is_empty")]
    pub document: TitleBlock,
    /// The controlled body, unless it is a `spacecraft`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    #[schemars(with = "Body")]
    pub body: Option<Body>,
    /// The hub of a controlled spacecraft, which is built from its parts.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub spacecraft: Option<Spacecraft>,
    /// Appendages clamped to the hub of the spacecraft.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub appendage: Vec<Appendage>,
    /// Drift of the natural frequencies; default: none.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub drift: Option<Drift>,
    /// The sensor, or an array of several.
    #[serde(default)]
    pub sensor: OneOrMany<SensorKind>,
    /// The estimator.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub estimator: Option<EstimatorKind>,
    /// The adaptation.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub adaptation: Option<AdaptationKind>,
    /// The planned manoeuvre.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub manoeuvre: Option<Manoeuvre>,
    /// The control law. Only a scenario with a manoeuvre or with modes can omit it.
    #[serde(default, skip_serializing_if = "LawKind::is_of_modes")]
    pub law: LawKind,
    /// Modes of operation, each with a law of its own; a run begins in the first.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub mode: Vec<OperatingMode>,
    /// Target of the first mode, at the start of the run.
    #[serde(skip)]
    pub(super) mode_targets: Vec<AttitudeTarget>,
    /// Precision of the flight computer: its estimator, its laws and the distribution of their commands.
    #[serde(default, skip_serializing_if = "Precision::is_double")]
    pub flight_precision: Precision,
    /// The actuator, which executes the commanded torque, or an array of several.
    #[serde(default)]
    pub actuator: OneOrMany<AssignedActuator>,
    /// Disturbance torques and forces.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub disturbance: Vec<Disturbance>,
    /// Disturbances that a program provides, in addition to those above, each with its index among them.
    #[serde(skip)]
    pub own_disturbances: Vec<(usize, Custom<dyn DisturbanceSpec>)>,
    /// Guidance that a program provides in place of targets: with the name of its mode of operation, or with an empty name
    /// for the whole run.
    #[serde(skip)]
    pub own_guidance: Vec<(String, Custom<dyn GuidanceSpec>)>,
    /// Environment of a body with three axes; default: none.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub environment: Option<Environment>,
    /// Contents of a full log.
    #[serde(default)]
    pub log: LogSpec,
    /// Target attitudes of a body with three axes, in the order of their times; before the first one, the target is the
    /// inertial axes. A law `phase_plane` may have targets of its own.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub target: Vec<AttitudeTarget>,
    /// Lines of sight of instruments on a body with three axes, which are recorded and assessed.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub line_of_sight: Vec<LineOfSight>,
    /// Claims about outputs of the linear body, for `flexsc bound`.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub bound: Vec<BoundSpec>,
    /// Reference values for the metrics.
    #[serde(default, skip_serializing_if = "Reference::is_empty")]
    pub reference: Reference,
    /// Requirements, each a limit on a pointing index or on a metric.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub requirement: Vec<Requirement>,
    /// Faults, of which a run has the `active_fault`.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub fault: Vec<Fault>,
    /// Name of the fault that occurs, or `none`, the default.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub active_fault: Option<String>,
    /// Failures of the active fault among those of the parts.
    #[serde(skip)]
    pub(super) added_failures: Vec<AddedFailures>,
    /// Distributions of keys from which a campaign draws a value for each run.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub uncertain: BTreeMap<String, Distribution>,
    /// Correlated keys of `uncertain`.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub correlated: Vec<Correlated>,
}

impl ScenarioSpec {
    /// Returns the number of axes of the body.
    pub fn axis_count(&self) -> usize {
        self.body.as_ref().map_or(3, Body::axis_count)
    }

    /// Returns the kind of the body.
    pub fn body_kind(&self) -> &'static str {
        self.body.as_ref().map_or("spacecraft", Body::kind)
    }

    /// Returns the key of the body.
    pub fn body_key(&self) -> String {
        self.body.as_ref().map_or_else(|| "spacecraft".to_owned(), |body| format!("body.{}", body.kind()))
    }

    /// Returns the key of the damping matrix.
    pub(super) fn damping_key(&self) -> String {
        format!("body.{}.damping_matrix", self.body_kind())
    }

    /// Takes the laws, and the first target, from the modes of operation, if there are any.
    ///
    /// # Errors
    /// A law besides those of the modes, which a program has set.
    pub(super) fn adopt_modes(&mut self) -> Result<(), ConfigError> {
        if self.mode.is_empty() {
            return Ok(());
        }
        let is_other = !self.law.is_of_modes() && self.law != LawKind::default();
        self.law = LawKind::Stages(Stages::for_modes(self.mode.iter().map(OperatingMode::stage).collect()));
        let first = self.mode.first().and_then(|mode| mode.target.as_ref());
        self.mode_targets = first.map(ModeTarget::at_start).into_iter().collect();
        match self.stage_choice().filter(|_| is_other) {
            Some(why) => Err(ConfigError::new("law", why)),
            None => Ok(()),
        }
    }

    /// Writes out the factors on natural frequencies that are uncertain.
    pub(super) fn write_uncertain_factors(&mut self) {
        let keys: Vec<String> = self.uncertain.keys().cloned().collect();
        self.write_frequency_factors(&keys);
    }

    /// Writes out those of some keys that are factors on natural frequencies: without a value of their own they are 1.
    pub fn write_frequency_factors(&mut self, keys: &[String]) {
        for key in keys {
            let Some(table) = key.strip_suffix(".frequency_factor") else { continue };
            let index = table.strip_prefix("appendage[").and_then(|index| index.strip_suffix(']'));
            let factor = match index.and_then(|index| index.parse::<usize>().ok()) {
                Some(index) => self.appendage.get_mut(index).map(|own| &mut own.frequency_factor),
                None => self.spacecraft.as_mut().map(|own| &mut own.frequency_factor),
            };
            if let Some(factor @ None) = factor.filter(|_| index.is_some() || table == "spacecraft") {
                *factor = Some(Positive::ONE);
            }
        }
    }

    /// Returns true if the estimator is a set of adaptive observers.
    pub fn has_adaptive_observers(&self) -> bool {
        self.estimator.as_ref().is_some_and(|estimator| estimator.adaptive().is_some())
    }

    /// Returns true if modes have targets, which replace those of the scenario.
    pub fn has_mode_targets(&self) -> bool {
        self.mode.iter().any(|mode| mode.target.is_some())
    }

    /// Returns the target attitudes of a three-axis body whose times are known before the run.
    pub fn targets(&self) -> &[AttitudeTarget] {
        if self.has_mode_targets() {
            return &self.mode_targets;
        }
        let own = self.law.own_targets();
        if own.is_empty() { &self.target } else { own }
    }

    /// Returns the start of the last target that begins before `before`; the start of the run if there is none.
    pub fn last_target_start(&self, before: Instant) -> Instant {
        let begins = self.targets().iter().rev().map(AttitudeTarget::starts);
        begins.into_iter().find(|from| *from < before).unwrap_or(Instant::START)
    }

    /// Returns the scenario with all its defaults, as a table.
    pub fn to_table(&self) -> Table {
        // Every scenario can be expressed in TOML.
        let mut table = self.without_added_failures(Table::try_from(self).unwrap_or_default());
        // serde knows no dates: `toml` makes a marked table of one.
        if let Some(epoch) = self.epoch {
            table.insert("epoch".to_owned(), Value::Datetime(epoch));
        }
        table
    }

    /// Returns the scenario with all its defaults, as TOML.
    pub fn to_toml(&self) -> String {
        toml::to_string(&self.to_table()).unwrap_or_default()
    }

    /// Returns the sampling period of the motion in a full log.
    pub fn log_period(&self) -> Span {
        self.log.period_for(self.duration)
    }

    /// Replaces references to files of modes, orbits, fields, densities and disturbances by what was read from them.
    pub fn inline_files(&mut self) {
        if let Some(Body::Spatial(spatial)) = &mut self.body {
            spatial.modes.inline();
        }
        self.appendage.iter_mut().for_each(Appendage::inline_modes);
        self.disturbance.iter_mut().for_each(Disturbance::inline);
        let paths = self.line_of_sight.iter_mut().flat_map(|line| &mut line.measured);
        paths.for_each(|path| path.table.inline());
        let date = self.date_ns();
        if let Some(around) = &mut self.environment {
            around.inline_files(date);
        }
    }

    /// The date of the start in nanoseconds since 1970 UTC, if it has one.
    pub fn date_ns(&self) -> Option<u64> {
        self.epoch.as_ref().and_then(epoch::nanoseconds_since_1970)
    }

    /// The instant in nanoseconds since 1970 UTC from which a log counts: the date of the start, 0 without one.
    pub fn epoch_ns(&self) -> u64 {
        self.date_ns().unwrap_or(0)
    }

    /// Reads the files of the tables of disturbances.
    pub(super) fn read_disturbances(&mut self, directory: &Path) -> Option<ConfigError> {
        let disturbances = self.disturbance.iter_mut().enumerate();
        let mut faults = disturbances
            .filter_map(|(index, own)| Some(own.read(directory)?.within(&format!("disturbance[{index}]"))));
        faults.next()
    }

    /// Reads the files of the measured paths to lines of sight.
    pub(super) fn read_measured_paths(&mut self, directory: &Path) -> Option<ConfigError> {
        let lines = self.line_of_sight.iter_mut().enumerate();
        let paths =
            lines.flat_map(|(line, own)| own.measured.iter_mut().enumerate().map(move |path| (line, path)));
        paths.into_iter().find_map(|(line, (index, path))| {
            Some(path.read(directory)?.within(&format!("line_of_sight[{line}].measured[{index}]")))
        })
    }

    /// Returns the key of the first measured path, with which a scenario has no run.
    pub fn measured_path(&self) -> Option<String> {
        let line = self.line_of_sight.iter().position(|line| !line.measured.is_empty())?;
        Some(format!("line_of_sight[{line}].measured"))
    }

    /// Returns true if the scenario has disturbances.
    pub fn is_disturbed(&self) -> bool {
        !self.disturbance.is_empty() || !self.own_disturbances.is_empty()
    }

    /// Iterates over the keys of the disturbances, `disturbance[0]` first; those of a program follow.
    pub(super) fn disturbance_keys(&self) -> impl Iterator<Item = String> {
        let count = self.disturbance.len() + self.own_disturbances.len();
        (0..count).map(|index| format!("disturbance[{index}]"))
    }

    /// Returns the guidance that a program provides for a mode of operation, or for the whole run, whose name is empty.
    pub fn guidance(&self, mode: &str) -> Option<&Custom<dyn GuidanceSpec>> {
        self.own_guidance.iter().find(|(name, _)| name == mode).map(|(_, guidance)| guidance)
    }

    /// Returns the guidance that a program provides for the start of a run.
    pub fn first_guidance(&self) -> Option<&Custom<dyn GuidanceSpec>> {
        self.guidance(self.mode.first().map_or("", |mode| &mode.name)).or_else(|| self.guidance(""))
    }

    /// Returns true if the torque consists of more than the switchings of a law.
    pub fn has_torque_rows(&self) -> bool {
        !self.law.is_switching() || self.is_disturbed() || !self.actuator.is_ideal()
    }
}
