//! Instants of what repeats, in integer time.

/// Returns the instants (fs) from the first on, one in each period, before an end. An iterator of the standard library that skips
/// by a period counts in `usize`, which a processor of 32 bits overflows.
pub fn repeated(first: i64, period: i64, end: i64) -> impl Iterator<Item = i64> {
    std::iter::successors(Some(first), move |time| Some(time + period)).take_while(move |time| *time < end)
}
