//! Scenario of one mode of operation alone, or of one stage of the law, for analyses of its loop.

use std::collections::BTreeMap;

use flexsc_control::actuator::AssignedActuator;
use flexsc_control::estimator::EstimatorKind;
use flexsc_control::law::Stage;
use flexsc_control::operation::ModeTarget;
use flexsc_formats::document::{ConfigError, ScenarioError};

use super::{Scenario, ScenarioSpec};

impl Scenario {
    /// Returns the scenario in which one of the modes acts throughout: with its law, target, sensors and actuators. Of a law with
    /// stages it is that of the stage with this index. An attitude filter that the law does not read goes on unread.
    ///
    /// # Errors
    /// Fails without a mode of this name, and if the parts of the mode are inconsistent without the others.
    pub fn in_mode(&self, name: &str) -> Result<Self, ScenarioError> {
        let fault = |why| ScenarioError::Key { origin: self.name.clone(), key: "mode".to_owned(), why };
        let index = self.stage_index(name).map_err(fault)?;
        if self.mode.is_empty() {
            return self.clone().with(|written| written.keep_stage(index));
        }
        self.clone().with(|written| written.keep_mode(index))
    }

    /// Returns the scenario in which the law of one stage acts throughout, with its actuators.
    ///
    /// # Errors
    /// Fails without a stage of this index, and if the parts of the stage are inconsistent without the others.
    pub fn in_stage(&self, index: usize) -> Result<Self, ScenarioError> {
        let Some(stage) = self.law.stages().get(index).cloned() else {
            let why = format!("has no stage {index}");
            return Err(ScenarioError::Key { origin: self.name.clone(), key: "law.stages".to_owned(), why });
        };
        self.clone().with(|written| {
            let acts =
                |_: usize, of: &AssignedActuator| of.unloads.is_some() || stage.selects(of.kind.kind());
            written.actuator.retain(acts);
            written.law = stage.law;
            written.leave_filter_unread();
            written.uncertain.clear();
            written.correlated.clear();
        })
    }

    /// Returns the error of an analysis of one loop, for a scenario with several, one in each mode.
    pub fn mode_choice_fault(&self) -> Option<ConfigError> {
        let names: Vec<String> = self.mode.iter().map(|mode| format!("`{}`", mode.name)).collect();
        (!names.is_empty()).then(|| {
            let why = format!(
                "has several loops, one in each mode: choose one with `--mode`, in Python `in_mode`: {}",
                names.join(", ")
            );
            ConfigError::new("mode", why)
        })
    }

    /// Returns the error of an analysis of one loop, for a scenario whose laws act one after another.
    pub fn stage_choice_fault(&self) -> Option<ConfigError> {
        (!self.law.stages().is_empty() && self.mode.is_empty()).then(|| {
            let why = format!(
                "has several loops, one in each stage: choose one with `--mode`, in Python `in_mode`: {}",
                self.listed_stages()
            );
            ConfigError::new("law.stages", why)
        })
    }
}

impl ScenarioSpec {
    /// Returns the stages of the law as a text: their numbers, laws and start times.
    pub(super) fn listed_stages(&self) -> String {
        let stage = |(index, stage): (usize, &Stage)| {
            format!("`{index}`, {} from {} s", stage.law.kind(), stage.from.get())
        };
        let stages: Vec<String> = self.law.stages().iter().enumerate().map(stage).collect();
        stages.join("; ")
    }

    /// Replaces the modes by the parts of one of them.
    fn keep_mode(&mut self, index: usize) {
        let in_use = self.sensors_in_use(index);
        let has_targets = self.has_mode_targets();
        let mode = self.mode[index].clone();
        if has_targets {
            self.target = mode.target.iter().map(ModeTarget::at_start).collect();
        }
        if let Some(names) = &mode.actuators {
            let acts = |_: usize, of: &AssignedActuator| {
                of.unloads.is_some() || names.iter().any(|name| name.as_str() == of.kind.kind())
            };
            self.actuator.retain(acts);
        }
        self.sensor.retain(|place, _| in_use[place]);
        let own = self.guidance(&mode.name).or_else(|| self.guidance("")).cloned();
        self.own_guidance = own.map(|own| (String::new(), own)).into_iter().collect();
        self.law = mode.law;
        self.leave_filter_unread();
        self.mode.clear();
        self.mode_targets.clear();
        self.keep_uncertain(&format!("mode[{index}].law."), "mode[", &in_use);
    }

    /// Replaces the stages of the law by one of them.
    fn keep_stage(&mut self, index: usize) {
        let stage = self.law.stages()[index].clone();
        self.actuator.retain(|_, of| of.unloads.is_some() || stage.selects(of.kind.kind()));
        self.law = stage.law;
        self.leave_filter_unread();
        self.keep_uncertain(&format!("law.stages[{index}].law."), "law.stages[", &[]);
    }

    /// Marks an attitude filter as unread if the law reads no estimates of the motion.
    fn leave_filter_unread(&mut self) {
        let is_read = (0..3).any(|axis| self.law.about(axis).offers().reads_motion());
        if let Some(EstimatorKind::Attitude(filter)) = &mut self.estimator {
            filter.watch_only |= !is_read;
        }
    }

    /// Renames the uncertain keys of the law of a mode or stage, and leaves out those of others, and of sensors and actuators
    /// whose places may have changed.
    fn keep_uncertain(&mut self, own: &str, others: &str, in_use: &[bool]) {
        let moved = |key: &str| {
            key.starts_with("actuator[") || (key.starts_with("sensor[") && in_use.contains(&false))
        };
        let renamed = |key: String| match key.strip_prefix(own) {
            Some(rest) => Some(format!("law.{rest}")),
            None if key.starts_with(others) || moved(&key) => None,
            None => Some(key),
        };
        let kept = std::mem::take(&mut self.uncertain);
        self.uncertain = kept
            .into_iter()
            .filter_map(|(key, distribution)| Some((renamed(key)?, distribution)))
            .collect::<BTreeMap<_, _>>();
        self.correlated.iter_mut().for_each(|group| {
            group.keys = std::mem::take(&mut group.keys).into_iter().filter_map(renamed).collect();
        });
        self.correlated.retain(|group| group.keys.len() > 1);
    }
}
