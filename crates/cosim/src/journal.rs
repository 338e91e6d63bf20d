//! Journal of a co-simulation: everything that an importer has set, and when. Scenario and journal determine the run, so
//! that a serialised state is a journal.

use flexsc_core::numerics::time::Instant;
use serde::{Deserialize, Serialize};

use crate::error::CoSimulationError;

/// Instant of a run, and whether the response to its event has been given.
#[derive(Copy, Clone, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
pub struct Moment {
    /// Whole seconds.
    whole: u64,
    /// Femtoseconds past the whole second.
    part: u64,
    /// True if everything that is due at the instant has been done.
    pub is_complete: bool,
}

impl Moment {
    /// Creates the moment of an instant.
    pub fn new(at: Instant, is_complete: bool) -> Self {
        let (whole, part) = at.parts();
        Self { whole, part, is_complete }
    }

    /// Returns the instant.
    pub fn at(self) -> Instant {
        Instant::from_parts(self.whole, self.part)
    }

    fn is_valid(self) -> bool {
        self.whole < 1 << 60 && self.part < 1_000_000_000_000_000
    }
}

/// Inputs that were applied at a moment, as the bits of their values.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct AppliedInputs {
    /// Moment at which the inputs were applied.
    pub from: Moment,
    /// Bits of the values.
    pub bits: Vec<u64>,
}

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
    pub applied: Vec<AppliedInputs>,
    /// Moment that the run has reached; `None` before its start.
    pub reached: Option<Moment>,
    /// Counts at that moment.
    pub counts: Counts,
}

impl InputJournal {
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
        let journal: Self = serde_json::from_slice(bytes).map_err(|error| damaged(&error.to_string()))?;
        if journal.token != token {
            return Err(CoSimulationError::refused("the serialised state is that of another FMU"));
        }
        let is_finite = |bits: &u64| f64::from_bits(*bits).is_finite();
        let fits = |bits: &[u64]| bits.len() == inputs && bits.iter().all(is_finite);
        if !fits(&journal.inputs) || !journal.applied.iter().all(|applied| fits(&applied.bits)) {
            return Err(damaged("inputs must be finite and as many as those of the FMU"));
        }
        let moments = journal.applied.iter().map(|applied| applied.from).chain(journal.reached);
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
