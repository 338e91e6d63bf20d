//! Statistics of a campaign: mean, standard deviation and quantiles of every metric.

use crate::metrics::{self, MetricDescription, MetricValue, Metrics, NamedMetric, goal};

/// Quantiles that are reported.
pub const QUANTILES: [f64; 5] = [0.05, 0.25, 0.5, 0.75, 0.95];

/// Statistics of one metric over the runs that have a value of it.
#[derive(Clone, Debug, PartialEq)]
pub struct Statistics {
    /// Name of the metric; of an element of a list, `NAME[i]`.
    pub name: String,
    /// Unit of the metric.
    pub unit: &'static str,
    /// Number of runs with a finite value; all others are left out.
    pub runs: usize,
    /// Number of runs with an infinite value, too large for a double.
    pub infinite: usize,
    /// Mean; NaN without a run.
    pub mean: f64,
    /// Standard deviation, with runs - 1 in the denominator; NaN for a single run, or if it is too large for a double.
    pub sd: f64,
    /// Values of the [`QUANTILES`], interpolated linearly between order statistics; NaN without a run.
    pub quantiles: [f64; 5],
}

/// Numeric metrics of runs, as columns for the statistics.
#[derive(Clone, Debug, Default)]
pub struct MetricColumns {
    runs: usize,
    columns: Vec<(&'static MetricDescription, Option<usize>, Vec<f64>)>,
}

impl MetricColumns {
    /// Adds a run.
    pub fn add(&mut self, run: &Metrics) {
        if self.runs == 0 {
            self.columns = run.0.iter().flat_map(columns_of).collect();
        }
        self.runs += 1;
        for (meaning, element, values) in &mut self.columns {
            values.push(match run.get(meaning.name) {
                Some(list @ (MetricValue::Numbers(_) | MetricValue::Quantities(_))) => {
                    element.and_then(|index| list.numbers().get(index).copied()).unwrap_or(f64::NAN)
                }
                Some(MetricValue::Count(count)) => *count as f64,
                Some(MetricValue::Number(number)) => *number,
                Some(MetricValue::Word(word)) => goal::score(word).unwrap_or(f64::NAN),
                _ => f64::NAN,
            });
        }
    }

    /// Returns the number of runs.
    pub fn runs(&self) -> usize {
        self.runs
    }

    /// Returns the statistics of each metric. A goal or a requirement counts as 1 if it is met and as 0 if it is
    /// missed: the mean is the fraction of runs that meet it.
    pub fn finish(self) -> Vec<Statistics> {
        let columns = self.columns.into_iter();
        columns.map(|(meaning, element, values)| Statistics::from_values(meaning, element, values)).collect()
    }
}

/// Returns empty columns for a metric: one for a number or a verdict, one for each element of a list.
fn columns_of((meaning, value): &NamedMetric) -> Vec<(&'static MetricDescription, Option<usize>, Vec<f64>)> {
    let elements: Vec<Option<usize>> = match value {
        MetricValue::Count(_) | MetricValue::Number(_) => vec![None],
        MetricValue::Word(_) if goal::NAMES.contains(&meaning.name) => vec![None],
        MetricValue::Word(_) | MetricValue::Words(_) => Vec::new(),
        // The elements of one run are those of no other.
        MetricValue::Numbers(_) if metrics::is_event_list(meaning.name) => Vec::new(),
        MetricValue::Numbers(_) | MetricValue::Quantities(_) => {
            (0..value.numbers().len()).map(Some).collect()
        }
    };
    elements.into_iter().map(|element| (*meaning, element, Vec::new())).collect()
}

impl Statistics {
    /// Computes the statistics of a metric, or of an element of a list, from its values, which are NaN for runs without
    /// one.
    pub fn from_values(meaning: &MetricDescription, element: Option<usize>, mut values: Vec<f64>) -> Self {
        values.retain(|v| !v.is_nan());
        let described = values.len();
        values.retain(|v| v.is_finite());
        values.sort_by(f64::total_cmp);
        let (mean, sd) = mean_and_sd(&values);
        Self {
            name: element
                .map_or_else(|| meaning.name.to_owned(), |index| format!("{}[{index}]", meaning.name)),
            unit: meaning.unit,
            runs: values.len(),
            infinite: described - values.len(),
            mean,
            sd,
            quantiles: QUANTILES.map(|q| quantile(&values, q)),
        }
    }
}

/// The 97.5 % quantile of a standard normal number.
const NORMAL_975: f64 = 1.959_963_984_540_054;

/// Returns the 95 % interval of the probability of an outcome that `met` of `trials` trials had: Wilson's score
/// interval. NaN without a trial.
pub fn wilson(successes: u64, trials: u64) -> (f64, f64) {
    if trials == 0 {
        return (f64::NAN, f64::NAN);
    }
    let (n, z2) = (trials as f64, NORMAL_975 * NORMAL_975);
    let part = successes as f64 / n;
    let centre = part + z2 / (2.0 * n);
    let half = NORMAL_975 * f64::sqrt(part * (1.0 - part) / n + z2 / (4.0 * n * n));
    let scale = 1.0 + z2 / n;
    (((centre - half) / scale).max(0.0), ((centre + half) / scale).min(1.0))
}

/// Returns mean and standard deviation of finite values. If sums or squares are too large for a double, the values are
/// scaled: the mean always fits, and the standard deviation is NaN if it does not. Equal values have exactly their
/// value as the mean and no deviation.
fn mean_and_sd(values: &[f64]) -> (f64, f64) {
    if let [first, _, ..] = values
        && values.iter().all(|value| value == first)
    {
        return (*first, 0.0);
    }
    let n = values.len() as f64;
    let statistics_of = |scale: f64| {
        let mean = values.iter().map(|v| v * scale).sum::<f64>() / n;
        let squares: f64 = values.iter().map(|v| (v * scale - mean) * (v * scale - mean)).sum();
        (mean, if values.len() > 1 { f64::sqrt(squares / (n - 1.0)) } else { 0.0 })
    };
    let (mut mean, mut sd) = statistics_of(1.0);
    if mean.is_infinite() || !sd.is_finite() {
        // Scaling by a power of two loses no digits, except of values that are negligible here.
        let scale = libm::exp2(-600.0);
        (mean, sd) = statistics_of(scale);
        (mean, sd) = (mean / scale, sd / scale);
    }
    (mean, if values.len() > 1 && sd.is_finite() { sd } else { f64::NAN })
}

/// Returns the quantile of sorted values, interpolated linearly between order statistics; NaN without values.
pub fn quantile(sorted: &[f64], q: f64) -> f64 {
    let Some(last) = sorted.len().checked_sub(1) else { return f64::NAN };
    let place = q * last as f64;
    let (below, part) = (place as usize, place - libm::floor(place));
    let above = (below + 1).min(last);
    if sorted[below] == sorted[above] {
        return sorted[below];
    }
    sorted[below] * (1.0 - part) + sorted[above] * part
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_mean_of_goals_is_the_fraction_that_is_met() {
        let run = |band: f64, until: f64| {
            let mut verdict = goal::GoalMetrics::new(0.0, band);
            verdict.add_outside(0.0, until);
            Metrics(verdict.finish(10.0).into())
        };
        let runs = [run(1.0, 1.0), run(1.0, 9.5), run(f64::NAN, 0.0), run(1.0, 0.0), run(1.0, 3.0)];
        let mut gathered = MetricColumns::default();
        for run in runs {
            gathered.add(&run);
        }
        let described = gathered.finish();
        assert_eq!((described[0].name.as_str(), described[0].runs, described[0].mean), ("goal", 4, 0.75));
        assert_eq!(
            (described[2].name.as_str(), described[2].runs, described[2].mean),
            ("time_outside_s", 4, 13.5 / 4.0)
        );
    }

    #[test]
    fn intervals_are_those_of_scipy() {
        // scipy.stats.binomtest(met, trials).proportion_ci(0.95, "wilson")
        for (successes, trials, low, high) in [
            (103, 200, 0.446_108_491_927_457_2, 0.583_326_148_281_225),
            (0, 10, 0.0, 0.277_532_799_862_889_2),
            (10, 10, 0.722_467_200_137_110_7, 1.0),
            (7, 20, 0.181_191_824_101_082_06, 0.567_145_723_314_763_9),
            (999, 1000, 0.994_357_441_402_042_1, 0.999_823_453_629_373_9),
        ] {
            let found = wilson(successes, trials);
            assert!((found.0 - low).abs() < 1e-14 && (found.1 - high).abs() < 1e-14, "{found:?}");
        }
        assert!(wilson(0, 0).0.is_nan());
    }

    #[test]
    fn equal_values_do_not_deviate() {
        // Rounded, the sum divided by the number is another double.
        for value in [0.1, 0.1_f64 + 0.2, -1e308, 0.0] {
            assert_eq!(mean_and_sd(&[value; 7]), (value, 0.0));
        }
    }

    #[test]
    fn large_values_have_finite_statistics() {
        // Reference: Python's statistics.fmean and statistics.stdev of the fractions, exact.
        let (mean, sd) = mean_and_sd(&[1e200, 3e200, 5e200]);
        assert!((mean / 3e200 - 1.0).abs() < 1e-15 && (sd / 2e200 - 1.0).abs() < 1e-15, "{mean} {sd}");
        let (mean, sd) = mean_and_sd(&[1.5e308, 1.7e308]);
        assert!((mean / 1.6e308 - 1.0).abs() < 1e-15, "{mean}");
        assert!((sd / 1.414_213_562_373_095e307 - 1.0).abs() < 1e-14, "{sd}");
        let (mean, sd) = mean_and_sd(&[-1.7e308, 1.7e308]);
        assert!(mean == 0.0 && sd.is_nan(), "{mean} {sd}");
        assert!(mean_and_sd(&[2.0]).0 == 2.0 && mean_and_sd(&[2.0]).1.is_nan());
        assert!(mean_and_sd(&[]).0.is_nan() && mean_and_sd(&[]).1.is_nan());
    }

    #[test]
    fn quantiles_interpolate_as_numpy_does() {
        // Reference: numpy.quantile([1, 2, 4, 8], [0.05, 0.25, 0.5, 0.75, 0.95])
        let exact = [1.15, 1.75, 3.0, 5.0, 7.4];
        for (q, exact) in QUANTILES.into_iter().zip(exact) {
            assert!((quantile(&[1.0, 2.0, 4.0, 8.0], q) - exact).abs() < 1e-14);
        }
    }
}
