//! Copy of the plant for means over time: loads change at segment starts that are not known in advance, so a segment is averaged
//! when it is over. The plant of the run itself is never moved back.

use flexsc_numerics::quadrature;
use flexsc_numerics::time::{Instant, Span};
use flexsc_record::Record;

use super::SimulationError;
use super::plant::Plant;

/// Copy of the plant in the current segment; `averaged` is the instant up to which means are accumulated.
#[derive(Clone, Debug)]
pub struct SegmentCopy {
    copy: Option<Plant>,
    averaged: Instant,
}

impl SegmentCopy {
    /// Creates the place of a copy.
    pub fn new() -> Self {
        Self { copy: None, averaged: Instant::START }
    }

    /// Copies the plant before it advances from `now`, if there is no copy of this segment.
    #[inline]
    pub fn begin(&mut self, now: Instant, plant: &Plant) {
        if self.copy.is_none() {
            (self.copy, self.averaged) = (Some(plant.clone()), now);
        }
    }

    /// Forgets the copy, at the end of its segment or where no mean is open.
    pub fn end(&mut self) {
        self.copy = None;
    }

    /// Calls `add` with the motion at times from the last averaged instant up to `now`, at which the plant of the run is, and
    /// with the parts of the time for which they stand (s).
    #[inline]
    pub fn average(
        &mut self,
        now: Instant,
        plant: &Plant,
        record: &mut dyn Record,
        mut add: impl FnMut(&Plant, Instant, f64),
    ) -> Result<(), SimulationError> {
        let Self { copy, averaged } = self;
        let Some(copy) = copy.as_mut().filter(|_| now > *averaged) else { return Ok(()) };
        let from = std::mem::replace(averaged, now);
        // The copy is at the start of the interval, the plant of the run at its end.
        let fastest = copy.fastest_frequency().max(plant.fastest_frequency());
        for (t, lasts) in quadrature::nodes(now.since(from).seconds(), fastest) {
            let at = from + Span::from_seconds(t);
            copy.advance(at, record)?;
            copy.evaluate(at)?;
            add(copy, at, lasts);
        }
        Ok(())
    }
}
