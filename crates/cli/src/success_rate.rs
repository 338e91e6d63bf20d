//! Number of runs that meet a goal, as text with its confidence interval.

use flexsc_core::statistics::wilson;

/// Formats the number of runs that meet a goal, given their fraction.
pub fn success_rate(runs: u64, fraction: f64) -> String {
    let successes = (fraction * runs as f64).round() as u64;
    let (low, high) = wilson(successes, runs);
    let [part, low, high] = [fraction, low, high].map(|part| format!("{:.0}", 100.0 * part));
    format!("{successes} of {runs} met ({part} %, 95 % interval {low} to {high})")
}

#[cfg(test)]
mod tests {
    use super::success_rate;

    #[test]
    fn verdicts_are_counted() {
        // scipy.stats.binomtest(103, 200).proportion_ci(0.95, "wilson"): 0.4461 to 0.5833.
        assert_eq!(success_rate(200, 0.515), "103 of 200 met (52 %, 95 % interval 45 to 58)");
        assert_eq!(success_rate(8, 1.0), "8 of 8 met (100 %, 95 % interval 68 to 100)");
    }
}
