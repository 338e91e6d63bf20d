//! Outcome of a reading in an estimator.

/// Outcome of a reading in a filter.
#[derive(Copy, Clone, Debug, PartialEq, Eq)]
pub enum ReadingStatus {
    /// There was no reading.
    None,
    /// It propagated or corrected the filter.
    Accepted,
    /// It was improbable, but so were several before it, or none had corrected the filter for long: it corrected the filter after
    /// the covariance was inflated.
    Reaccepted,
    /// It waits for the gyro reading of its exposure.
    Waiting,
    /// Refused: not finite, not of unit length, or a rate above the largest.
    Unsound,
    /// Refused: its innovation is above the gate.
    Improbable,
    /// Refused: older than the filter's recent past, or there is no room for it.
    Untimely,
}

impl ReadingStatus {
    /// Returns true if a measurement corrected the filter.
    #[inline]
    pub fn has_corrected(self) -> bool {
        matches!(self, ReadingStatus::Accepted | ReadingStatus::Reaccepted)
    }

    /// Returns true if the filter refused the reading.
    #[inline]
    pub fn is_refusal(self) -> bool {
        matches!(self, ReadingStatus::Unsound | ReadingStatus::Improbable | ReadingStatus::Untimely)
    }
}
