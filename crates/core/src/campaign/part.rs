//! Parts of a campaign: ranges of runs, and names of their files.

use std::ops::Range;

/// Multiple of runs that fills the lanes of batches.
const LANES: u64 = 256;
/// Duration of a part on one core (s): the work that a killed worker loses.
pub(super) const WORK_S: f64 = 4.0;
/// Approximate upper limit of the number of parts ...
const MOST_PARTS: u64 = 4096;
/// ... and lower limit for a campaign of many runs, so that several workers have work.
const FEW_PARTS: u64 = 16;

/// Returns the number of runs of a part: a power of two, and for short runs a multiple of 256. Parts begin at its
/// multiples, whichever other runs are wanted.
pub fn part_size(runs: u64, run_s: f64) -> u64 {
    let preferred = (WORK_S / run_s.max(1e-6)).clamp(1.0, 65_536.0) as u64;
    // Rounded down to a power of two; full lanes matter more than equal durations.
    let by_time = 1 << preferred.max(1).ilog2();
    let by_time = if (LANES / 4..LANES).contains(&by_time) { LANES } else { by_time };
    let for_all = (runs / FEW_PARTS).next_power_of_two().max(LANES);
    by_time.min(for_all).max(runs.div_ceil(MOST_PARTS).next_power_of_two())
}

/// Returns the name of the file of a part.
pub fn file_name(runs: &Range<u64>) -> String {
    format!("part-{:010}-{:010}.parquet", runs.start, runs.end)
}

/// Returns the runs of a part, by the name of its file.
pub fn runs_of(name: &str) -> Option<Range<u64>> {
    let (from, to) = name.strip_prefix("part-")?.strip_suffix(".parquet")?.split_once('-')?;
    let number = |text: &str| text.parse().ok().filter(|_| text.len() >= 10);
    let runs = number(from)?..number(to)?;
    (runs.start < runs.end).then_some(runs)
}

/// Splits runs into parts of this size, at its multiples.
pub fn split(runs: Range<u64>, size: u64) -> impl Iterator<Item = Range<u64>> {
    let size = size.max(1);
    let mut next = runs.start;
    std::iter::from_fn(move || {
        let end = (next / size + 1).saturating_mul(size).min(runs.end);
        let part = next..end;
        next = end;
        (!part.is_empty()).then_some(part)
    })
}

/// Returns the runs without those that are present, which must be sorted.
pub fn remove_present(runs: Range<u64>, present: &[Range<u64>]) -> Vec<Range<u64>> {
    let mut missing = Vec::new();
    let mut next = runs.start;
    for part in present {
        if part.start > next {
            missing.push(next..part.start.min(runs.end));
        }
        next = next.max(part.end);
    }
    missing.push(next..runs.end);
    missing.retain(|range| !range.is_empty());
    missing
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn parts_have_sizes_by_the_work() {
        for (runs, run_s, exact) in [
            (1000, 1e-3, 256),
            (10_000, 1e-3, 1024),
            (1_000_000, 1e-3, 2048),
            (1000, 0.03, 256),
            (1000, 0.1, 32),
            (1000, 10.0, 1),
            (100_000_000, 1e-9, 65_536),
        ] {
            assert_eq!(part_size(runs, run_s), exact, "{runs} runs of {run_s} s");
        }
        assert_eq!(part_size(100_000_000, 10.0), 32_768);
    }

    #[test]
    fn names_and_ranges_belong_together() {
        assert_eq!(file_name(&(0..256)), "part-0000000000-0000000256.parquet");
        assert_eq!(runs_of(&file_name(&(5..99_999_999_999))), Some(5..99_999_999_999));
        for other in [
            "part-5-7.parquet",
            "part-0000000005-0000000005.parquet",
            "part-0000000000-0000000256.parquet.partial",
        ] {
            assert_eq!(runs_of(other), None, "{other}");
        }
    }

    #[test]
    #[expect(clippy::single_range_in_vec_init, reason = "one range is what is left")]
    fn what_is_missing_is_cut_at_fixed_places() {
        assert_eq!(split(3..20, 8).collect::<Vec<_>>(), [3..8, 8..16, 16..20]);
        assert_eq!(split(4..4, 8).count(), 0);
        assert_eq!(remove_present(0..20, &[]), [0..20]);
        assert_eq!(remove_present(0..20, &[0..8, 16..24]), [8..16]);
        assert_eq!(remove_present(2..20, &[0..1, 4..6, 5..7]), [2..4, 7..20]);
        assert_eq!(remove_present(2..5, &[0..8]), []);
    }
}
