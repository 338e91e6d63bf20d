//! Order statistics without interpolation, and the confidence that runs give in a level (Clopper-Pearson).

/// Relative rounding error of the product of a level and a number of values.
const LEVEL_ROUNDING: f64 = 4e-16;

/// Returns the rank, from 1, of the order statistic that at least the part `level` of `count` values does not exceed:
/// the least whole number from `level` times `count` on; 0 without values.
pub fn order_rank(level: f64, count: u64) -> u64 {
    let rank = libm::ceil(level * count as f64 * (1.0 - LEVEL_ROUNDING)) as u64;
    rank.max(1).min(count)
}

/// Returns the order statistic of sorted values at a level, without interpolation; NaN without values.
pub fn order_statistic(sorted: &[f64], level: f64) -> f64 {
    let rank = order_rank(level, sorted.len() as u64) as usize;
    rank.checked_sub(1).map_or(f64::NAN, |place| sorted[place])
}

/// Returns the confidence with which `trials` runs, of which `exceeding` exceed a limit, show that the probability not to
/// exceed it is at least `level` (Clopper-Pearson, one-sided): 1 less the probability of so few exceedances at
/// that level.
pub fn confidence(level: f64, exceeding: u64, trials: u64) -> f64 {
    if exceeding >= trials || level <= 0.0 || level >= 1.0 {
        return 0.0;
    }
    let (n, rest) = (trials as f64, libm::log(level / (1.0 - level)));
    // Logarithms of the binomial terms, from none exceeding on.
    let mut term = n * libm::log(level);
    let (mut total, mut carry) = (0.0, 0.0);
    for k in 0..=exceeding {
        if k > 0 {
            term += libm::log((n - (k - 1) as f64) / k as f64) - rest;
        }
        let piece = libm::exp(term) - carry;
        let sum = total + piece;
        carry = (sum - total) - piece;
        total = sum;
    }
    (1.0 - total).clamp(0.0, 1.0)
}

/// Largest number of runs that [`runs_needed`] returns.
const MOST_TRIALS: u64 = 1 << 40;

/// Returns the least number of runs that show a level with this confidence if `exceeding` of them exceed the limit.
pub fn runs_needed(level: f64, wanted: f64, exceeding: u64) -> u64 {
    let shows = |trials: u64| confidence(level, exceeding, trials) >= wanted;
    let mut enough = exceeding + 1;
    while !shows(enough) && enough < MOST_TRIALS {
        enough *= 2;
    }
    let mut few = exceeding;
    while enough - few > 1 {
        let middle = few + (enough - few) / 2;
        if shows(middle) {
            enough = middle;
        } else {
            few = middle;
        }
    }
    enough
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn confidences_are_those_of_clopper_and_pearson() {
        // scipy.stats.beta.cdf(1 - level, exceeding + 1, trials - exceeding)
        for (level, exceeding, trials, expected) in [
            (0.95, 0, 45, 0.900_559_743_012_907_8),
            (0.95, 2, 100, 0.881_737_018_814_879_4),
            (0.9, 7, 120, 0.921_600_800_554_887_7),
            (0.997, 0, 100, 0.259_515_740_460_217_4),
            (0.5, 400, 1000, 0.999_999_999_863_576_8),
        ] {
            let found = confidence(level, exceeding, trials);
            assert!((found - expected).abs() < 1e-13, "{level} {exceeding} {trials}: {found}");
        }
        assert_eq!((confidence(0.9, 5, 5), confidence(1.0, 0, 5)), (0.0, 0.0));
        // 1 - level^n reaches the confidence first at these numbers of runs.
        let needed = [(0.95, 0.9, 0), (0.95, 0.95, 0), (0.997, 0.9, 0), (0.9973, 0.5, 0)];
        assert_eq!(needed.map(|(level, wanted, k)| runs_needed(level, wanted, k)), [45, 59, 767, 257]);
        // scipy.stats.binom.cdf(2, n, 0.05) is at most 0.1 first at n = 105.
        assert_eq!(runs_needed(0.95, 0.9, 2), 105);
    }

    #[test]
    fn order_statistics_are_not_interpolated() {
        let ranks = [(0.95, 20), (0.95, 21), (0.997, 1000), (0.683, 1000), (1.0, 7), (0.1, 1), (0.5, 0)];
        assert_eq!(ranks.map(|(level, count)| order_rank(level, count)), [19, 20, 997, 683, 7, 1, 0]);
        assert_eq!(order_statistic(&[1.0, 2.0, 4.0], 0.5), 2.0);
        assert!(order_statistic(&[], 0.5).is_nan());
    }
}
