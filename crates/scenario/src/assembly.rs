//! Assembly of the body's model from its description.

use std::path::Path;
use std::sync::Arc;

use flexsc_control::law::AttitudeProfile;
use flexsc_formats::document::{ConfigError, Document, ScenarioError};
use flexsc_numerics::time::Instant;
use flexsc_spacecraft::body::craft::{AssembledSpacecraft, Spacecraft};
use flexsc_spacecraft::body::{Body, BodyModel, Load};

use super::{Scenario, ScenarioSpec};

impl ScenarioSpec {
    /// Assembles the model from the description of the body, with modes read from files relative to `directory`. Files
    /// and models that are unchanged from `parent` are reused.
    pub(super) fn assemble(
        &mut self,
        document: &Document,
        parent: Option<&Scenario>,
        directory: &Path,
    ) -> Result<BodyModel, ScenarioError> {
        let refused = |fault: ConfigError| document.at_key(&fault);
        let key = self.body_key();
        let load = self.load();
        let mut model = match (&mut self.body, self.spacecraft.clone()) {
            (_, None) if !self.appendage.is_empty() => {
                let why = "is clamped to the hub of a `[spacecraft]`, and there is none";
                Err(refused(ConfigError::new("appendage", why)))
            }
            (None, None) => Err(document.missing("body")),
            (Some(_), Some(_)) => {
                Err(refused(ConfigError::new("spacecraft", "is itself a body: leave out `body`")))
            }
            (Some(body), None) => single_body(body, load.as_ref(), parent, directory).map_err(|fault| {
                let of_load = fault.key == "load" || fault.key.starts_with("load.");
                refused(fault.within(if of_load { "manoeuvre" } else { &key }))
            }),
            (None, Some(spacecraft)) => self.craft(&spacecraft, parent, directory).map_err(refused),
        }?;
        self.place_at_start(&mut model);
        Ok(model)
    }

    /// Returns the load of the manoeuvre of a one-axis body.
    fn load(&self) -> Option<Load> {
        self.manoeuvre.as_ref().filter(|_| self.axis_count() == 1)?.load.clone()
    }

    /// Sets the attitude and the rates of a three-axis model at the start, which can be those of the target.
    fn place_at_start(&self, model: &mut BodyModel) {
        let spatial = || match self.body.as_ref()? {
            Body::Spatial(body) => Some(body.initial_motion()),
            _ => None,
        };
        let Some(initial) = self.spacecraft.as_ref().map(Spacecraft::initial_motion).or_else(spatial) else {
            return;
        };
        if !initial.depends_on_target() {
            return;
        }
        let profile = AttitudeProfile::new(self.targets(), &self.orbit_environment(), &model.free_modes());
        let target = profile.at(Instant::START);
        let motion = initial.resolve(&target.attitude, &target.rate);
        if let Some(body) = model.three_axis_mut() {
            (body.attitude, body.rate) = motion;
        }
    }

    /// Assembles the model of a spacecraft; in its written data the wheels are locked in the hub, in the model they
    /// turn freely.
    fn craft(
        &mut self,
        spacecraft: &Spacecraft,
        parent: Option<&Scenario>,
        directory: &Path,
    ) -> Result<BodyModel, ConfigError> {
        for (index, appendage) in self.appendage.iter_mut().enumerate() {
            let others = parent.and_then(|parent| parent.appendage.get(index));
            let read = appendage.read_modes(directory, others);
            read.map_err(|fault| fault.within(&format!("appendage[{index}]")))?;
        }
        let angles = self.start_angles()?;
        let rotors = match self.actuator.wheels() {
            Some((wheels, key)) => wheels.rotors().map_err(|fault| fault.within(&key))?,
            None => Vec::new(),
        };
        Ok(BodyModel::Spacecraft(Arc::new(AssembledSpacecraft::assemble(
            spacecraft,
            &self.appendage,
            &angles,
            &rotors,
        )?)))
    }
}

/// Assembles the model of a body that is described in one table, under a torque on the hub or under a load.
fn single_body(
    body: &mut Body,
    load: Option<&Load>,
    parent: Option<&Scenario>,
    directory: &Path,
) -> Result<BodyModel, ConfigError> {
    let other = parent.and_then(|parent| parent.body.as_ref());
    body.locate(directory);
    body.read(other)?;
    let is_same = |parent: &&Scenario| other == Some(&*body) && parent.load().as_ref() == load;
    match parent.filter(is_same) {
        Some(parent) => Ok(parent.model.clone()),
        None => body.assemble(load),
    }
}
