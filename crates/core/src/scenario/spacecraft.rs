//! A scenario's spacecraft, put together from the parts that are written.

use std::path::Path;

use super::Scenario;
use crate::body::Body;
use crate::body::craft::Craft;
use crate::document::{Document, Fault, ScenarioError};

impl Scenario {
    /// Reads the modes of the appendages, and makes the body of them and the hub.
    pub(super) fn put_together(
        &mut self,
        document: &Document,
        parent: Option<&Self>,
        directory: &Path,
    ) -> Result<(), ScenarioError> {
        let refused = |fault: Fault| document.inconsistent(&fault);
        if self.spacecraft.is_none() {
            if !self.appendage.is_empty() {
                let why = "is clamped to the hub of a `[spacecraft]`, and there is none";
                return Err(refused(Fault::new("appendage", why)));
            }
            // Nothing that was read is a spacecraft.
            return if self.body.is_spacecraft() { Err(document.missing("body")) } else { Ok(()) };
        }
        if !self.body.is_spacecraft() {
            let why = "is itself a body: leave out `body`";
            return Err(refused(Fault::new("spacecraft", why)));
        }
        for (index, appendage) in self.appendage.iter_mut().enumerate() {
            let others = parent.and_then(|parent| parent.appendage.get(index));
            let read = appendage.read_modes(directory, others);
            read.map_err(|fault| refused(fault.within(&format!("appendage[{index}]"))))?;
        }
        self.turn_drives().map_err(refused)?;
        let Some(spacecraft) = &self.spacecraft else { return Ok(()) };
        // Wheels are locked in the hub as it is written, and turn freely.
        let rotors = match self.actuator.wheels() {
            Some((wheels, key)) => wheels.rotors().map_err(|fault| refused(fault.within(&key)))?,
            None => Vec::new(),
        };
        let craft = Craft::assemble(spacecraft, &self.appendage, &rotors);
        self.body = Body::Spacecraft(Box::new(craft.map_err(refused)?));
        Ok(())
    }
}
