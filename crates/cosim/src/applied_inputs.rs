//! Inputs that an importer has applied, in the order of time: each entry holds those that changed, and copies share all full blocks.

use std::sync::Arc;

use serde::de::Error as _;
use serde::ser::SerializeSeq as _;
use serde::{Deserialize, Deserializer, Serialize, Serializer};

use crate::moment::Moment;

/// Number of entries of a full block.
const BLOCK: usize = 256;

/// Inputs that were applied, as changes. A copy shares the full blocks, so that its cost hardly grows with the run.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct AppliedInputs {
    blocks: Vec<Arc<Block>>,
    /// Bits of all inputs after the last entry; empty before the first.
    last: Vec<u64>,
}

/// Successive entries, with their changes one after the other.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
struct Block {
    moments: Vec<Moment>,
    /// Number of changes of each entry.
    counts: Vec<u16>,
    /// Index of each changed input.
    indices: Vec<u16>,
    /// Bits of each changed input.
    bits: Vec<u64>,
}

/// Inputs that changed at a moment. Before the first entry all inputs are zero.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct InputChange {
    /// Moment at which the inputs were applied.
    pub from: Moment,
    /// Index of each changed input, and the bits of its value.
    pub changes: Vec<(u16, u64)>,
}

impl InputChange {
    /// Applies the change to the bits of all inputs.
    pub fn apply(&self, inputs: &mut [u64]) {
        for (index, bits) in &self.changes {
            if let Some(input) = inputs.get_mut(usize::from(*index)) {
                *input = *bits;
            }
        }
    }
}

impl AppliedInputs {
    /// Returns the bits of the inputs that were applied last; `None` if none were.
    pub fn last(&self) -> Option<&[u64]> {
        (!self.blocks.is_empty()).then_some(&*self.last)
    }

    /// Returns true if no inputs were applied.
    pub fn is_empty(&self) -> bool {
        self.blocks.is_empty()
    }

    /// Adds an entry: the bits of all inputs from a moment on.
    pub fn add(&mut self, from: Moment, inputs: &[u64]) {
        self.last.resize(inputs.len(), 0);
        let pairs = (0_u16..).zip(inputs).zip(&self.last);
        let changes = pairs.filter(|((_, new), old)| new != old).map(|((index, new), _)| (index, *new));
        let change = InputChange { from, changes: changes.collect() };
        change.apply(&mut self.last);
        self.append(&change);
    }

    fn append(&mut self, change: &InputChange) {
        if self.blocks.last().is_none_or(|block| block.moments.len() == BLOCK) {
            self.blocks.push(Arc::default());
        }
        // A block that a copy shares is copied, which takes at most the time of its entries.
        let Some(block) = self.blocks.last_mut().map(Arc::make_mut) else { return };
        block.moments.push(change.from);
        block.counts.push(u16::try_from(change.changes.len()).unwrap_or(u16::MAX));
        block.indices.extend(change.changes.iter().map(|(index, _)| *index));
        block.bits.extend(change.changes.iter().map(|(_, bits)| *bits));
        if block.moments.len() == BLOCK {
            block.indices.shrink_to_fit();
            block.bits.shrink_to_fit();
        }
    }

    /// Returns the entries in the order of time.
    pub fn changes(&self) -> impl Iterator<Item = InputChange> {
        self.blocks.iter().flat_map(|block| {
            let mut all = block.indices.iter().copied().zip(block.bits.iter().copied());
            block.moments.iter().zip(&block.counts).map(move |(from, count)| InputChange {
                from: *from,
                changes: all.by_ref().take(usize::from(*count)).collect(),
            })
        })
    }

    /// Sets the number of inputs of a history that was read from bytes.
    ///
    /// # Errors
    /// Fails for an index beyond the inputs, and for a value that is not finite.
    pub fn fit(&mut self, inputs: usize) -> Result<(), &'static str> {
        let blocks = || self.blocks.iter();
        if blocks().flat_map(|block| &block.indices).any(|index| usize::from(*index) >= inputs) {
            return Err("an input that the FMU does not have was applied");
        }
        if blocks().flat_map(|block| &block.bits).any(|bits| !f64::from_bits(*bits).is_finite()) {
            return Err("inputs must be finite");
        }
        let mut last = vec![0; inputs];
        self.changes().for_each(|change| change.apply(&mut last));
        self.last = last;
        Ok(())
    }
}

impl Serialize for AppliedInputs {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let mut entries = serializer.serialize_seq(None)?;
        self.changes().try_for_each(|change| entries.serialize_element(&change))?;
        entries.end()
    }
}

impl<'de> Deserialize<'de> for AppliedInputs {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let mut history = Self::default();
        for change in Vec::<InputChange>::deserialize(deserializer)? {
            if change.changes.len() > usize::from(u16::MAX) {
                return Err(D::Error::custom("too many inputs changed at once"));
            }
            history.append(&change);
        }
        Ok(history)
    }
}

#[cfg(test)]
mod tests {
    use flexsc_core::numerics::time::{Instant, Span};

    use super::*;

    fn moment(tick: i64) -> Moment {
        Moment::new(Instant::START + Span::from_femtoseconds(tick), true)
    }

    /// Returns the inputs of an entry: the second input changes at each, the third at each seventh.
    fn inputs(entry: u64) -> [u64; 3] {
        [0, (entry as f64).to_bits(), ((entry / 7) as f64).to_bits()]
    }

    #[test]
    fn entries_are_those_that_were_added() {
        let mut history = AppliedInputs::default();
        assert!(history.is_empty() && history.last().is_none());
        for entry in 0..1000 {
            history.add(moment(entry), &inputs(entry as u64));
        }
        let bytes = serde_json::to_vec(&history).expect("bytes");
        let mut again: AppliedInputs = serde_json::from_slice(&bytes).expect("a history");
        again.fit(3).expect("three inputs");
        assert_eq!(again, history);
        let mut values = [0; 3];
        for (entry, change) in again.changes().enumerate() {
            change.apply(&mut values);
            assert_eq!((change.from, values), (moment(entry as i64), inputs(entry as u64)));
        }
        assert_eq!((again.changes().count(), again.last()), (1000, Some(&inputs(999)[..])));
        assert!(again.clone().fit(2).is_err());
    }

    #[test]
    fn copies_share_full_blocks_and_keep_their_own_end() {
        let mut history = AppliedInputs::default();
        for entry in 0..=BLOCK {
            history.add(moment(entry as i64), &inputs(entry as u64));
        }
        let copy = history.clone();
        history.add(moment(900), &inputs(900));
        assert!(Arc::ptr_eq(&copy.blocks[0], &history.blocks[0]));
        assert_eq!((copy.changes().count(), history.changes().count()), (BLOCK + 1, BLOCK + 2));
        assert_eq!(copy.last(), Some(&inputs(BLOCK as u64)[..]));
    }
}
