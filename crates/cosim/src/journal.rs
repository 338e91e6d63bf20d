//! Journal of a co-simulation: everything that an importer has set, and when. Scenario and journal determine the run, so
//! that a serialised state is a journal.

use flexsc_core::numerics::time::Span;
use flexsc_core::{Document, Scenario};
use serde::{Deserialize, Serialize};

use crate::applied_inputs::AppliedInputs;
use crate::content::{FmuContent, SCENARIO};
use crate::error::CoSimulationError;
use crate::moment::Moment;

/// Counts of a run that a repetition does not renew.
#[derive(Copy, Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Counts {
    /// Number of events.
    pub events: u64,
    /// Number of instants at which a law has switched.
    pub switchings: u64,
    /// Whole seconds and femtoseconds of the last event.
    pub last_event: (u64, u64),
    /// True if a sensor has sampled at the current event.
    pub has_sampled: bool,
    /// True if a law has switched at the current event.
    pub has_switched: bool,
}

/// Everything that an importer has set, and the moment that the run has reached.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct InputJournal {
    /// Token of the FMU.
    pub token: String,
    /// Keys that differ from the scenario, with the bits of their values.
    pub keys: Vec<(String, u64)>,
    /// Seed.
    pub seed: u64,
    /// Grid of communication points (ns).
    pub grid_ns: u64,
    /// Bits of the requested stop time (s).
    pub stop_time: Option<u64>,
    /// Bits of the inputs that are set.
    pub inputs: Vec<u64>,
    /// Inputs that were applied, in the order of time.
    pub applied: AppliedInputs,
    /// Moment that the run has reached; `None` before its start.
    pub reached: Option<Moment>,
    /// Counts at that moment.
    pub counts: Counts,
}

impl InputJournal {
    /// Creates the journal of an FMU's content before the start, with this number of inputs.
    pub fn new(content: &FmuContent, seed: u64, inputs: usize) -> Self {
        Self {
            token: content.token(),
            keys: Vec::new(),
            seed,
            grid_ns: 0,
            stop_time: None,
            inputs: vec![0; inputs],
            applied: AppliedInputs::default(),
            reached: None,
            counts: Counts::default(),
        }
    }

    /// Returns the scenario of an FMU's content with the keys, the seed and the stop time that are set. A stop time before the
    /// scenario's end has no effect.
    ///
    /// # Errors
    /// Fails for invalid keys, and for a stop time that is no duration.
    pub fn scenario(&self, content: &FmuContent) -> Result<Scenario, CoSimulationError> {
        let mut scenario = content.scenario()?;
        let mut document = Document::parse(SCENARIO, content.toml.clone())?;
        for (key, bits) in &self.keys {
            document.set(key, f64::from_bits(*bits).into())?;
        }
        if !self.keys.is_empty() {
            scenario = Scenario::from_document(&document)?;
        }
        let stop = self.stop_time.map(|bits| Span::from_seconds(f64::from_bits(bits)));
        if let Some(stop) = stop.filter(|stop| *stop > scenario.duration) {
            document.set("duration", stop.seconds().into())?;
            scenario = Scenario::from_document(&document)?;
        }
        scenario.written.seed = self.seed;
        Ok(scenario)
    }

    /// Returns the journal as bytes.
    pub fn to_bytes(&self) -> Vec<u8> {
        // A journal consists of texts and integers, which JSON can hold.
        serde_json::to_vec(self).unwrap_or_default()
    }

    /// Reads a journal of the FMU with this token and this number of inputs.
    ///
    /// # Errors
    /// Fails for bytes of another FMU, and for damaged ones.
    pub fn from_bytes(bytes: &[u8], token: &str, inputs: usize) -> Result<Self, CoSimulationError> {
        let damaged =
            |why: &str| CoSimulationError::refused(format!("the serialised state is damaged: {why}"));
        let mut journal: Self = serde_json::from_slice(bytes).map_err(|error| damaged(&error.to_string()))?;
        if journal.token != token {
            return Err(CoSimulationError::refused("the serialised state is that of another FMU"));
        }
        let is_finite = |bits: &u64| f64::from_bits(*bits).is_finite();
        if journal.inputs.len() != inputs || !journal.inputs.iter().all(is_finite) {
            return Err(damaged("inputs must be finite and as many as those of the FMU"));
        }
        journal.applied.fit(inputs).map_err(damaged)?;
        let moments = journal.applied.changes().map(|applied| applied.from).chain(journal.reached);
        let moments: Vec<Moment> = moments.collect();
        if !moments.is_sorted() || !moments.iter().all(|moment| moment.is_valid()) {
            return Err(damaged("times must increase"));
        }
        if journal.reached.is_none() && !journal.applied.is_empty() {
            return Err(damaged("inputs were applied before the start"));
        }
        Ok(journal)
    }
}
