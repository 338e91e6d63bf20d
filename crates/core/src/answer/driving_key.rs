//! Uncertain keys that drive a requirement: rank correlations, and the deviations within which all runs meet it.

use flexsc_formats::reader_units::{number, percent};
use serde::Serialize;

use crate::campaign::UncertainValues;

/// Least size of a correlation, and multiple of its standard deviation without one, from which on a key is named.
const LEAST: [f64; 2] = [0.25, 3.3];
/// Least number of runs from which keys are named.
const FEWEST: usize = 10;

/// Uncertain key that a requirement depends on.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct DrivingKey {
    /// Key.
    pub key: String,
    /// Rank correlation of the value of the requirement with the key, over the runs (Spearman).
    pub rank_correlation: f64,
    /// Rank correlation with the size of the key's deviation from its value in the scenario.
    pub deviation_correlation: f64,
    /// Largest deviation within which every run meets the requirement: relative to the value in the scenario, or, if that
    /// is 0, in the unit of the key; absent if all runs meet it, or none.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub met_within: Option<f64>,
    /// Largest deviation of a run that meets the requirement; absent if runs that miss it deviate less.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub none_beyond: Option<f64>,
    /// Words.
    pub text: String,
}

/// Returns the keys that drive a requirement, the one with the largest correlation first, from its value in each run and
/// whether the run meets it; `worst` is the row of the worst run with its number, and `quantity` the text of a key's value.
pub(super) fn driving_keys(
    keys: &[UncertainValues],
    values: &[f64],
    met: &[bool],
    worst: Option<(usize, u64)>,
    quantity: impl Fn(&str, f64) -> String,
) -> Vec<DrivingKey> {
    let count = values.iter().filter(|value| !value.is_nan()).count();
    if count < FEWEST {
        return Vec::new();
    }
    let least = LEAST[0].max(LEAST[1] / ((count - 1) as f64).sqrt());
    let mut found: Vec<DrivingKey> = keys
        .iter()
        .filter(|own| own.values.len() == values.len())
        .map(|own| driving_key(own, (values, met), worst, |size| quantity(&own.key, size)))
        .filter(|own| own.size() >= least)
        .collect();
    found.sort_by(|a, b| b.size().total_cmp(&a.size()));
    found
}

impl DrivingKey {
    fn size(&self) -> f64 {
        self.rank_correlation.abs().max(self.deviation_correlation.abs())
    }
}

fn driving_key(
    own: &UncertainValues,
    (values, met): (&[f64], &[bool]),
    worst: Option<(usize, u64)>,
    quantity: impl Fn(f64) -> String,
) -> DrivingKey {
    let is_relative = own.design != 0.0;
    let deviation = |value: &f64| if is_relative { (value - own.design) / own.design } else { *value };
    let deviations: Vec<f64> = own.values.iter().map(deviation).collect();
    let sizes: Vec<f64> = deviations.iter().map(|own| own.abs()).collect();
    let rank_correlation = rank_correlation(&own.values, values);
    let deviation_correlation = self::rank_correlation(&sizes, values);
    let sizes_where =
        |wanted: bool| sizes.iter().zip(met).filter(move |(_, met)| **met == wanted).map(|(size, _)| *size);
    let nearest_missed = sizes_where(false).fold(f64::NAN, f64::min);
    let met_within = sizes_where(true).filter(|size| *size < nearest_missed).reduce(f64::max);
    let farthest_met = sizes_where(true).fold(f64::NAN, f64::max);
    let largest = sizes.iter().copied().fold(0.0, f64::max);
    let none_beyond = met_within.and(Some(farthest_met)).filter(|size| *size < largest);
    let shown = |size: f64| if is_relative { percent_of(size) } else { quantity(size) };
    let within = match (met_within, none_beyond) {
        _ if deviation_correlation.abs() < rank_correlation.abs() => None,
        (Some(within), Some(beyond)) if is_relative => Some(format!(
            "met in every run within ±{} of its value, in none beyond ±{}",
            shown(within),
            shown(beyond)
        )),
        (Some(within), Some(beyond)) => {
            Some(format!("met in every run within ±{}, in none beyond ±{}", shown(within), shown(beyond)))
        }
        (Some(within), None) => Some(format!("met in every run within ±{}", shown(within))),
        (None, _) => None,
    };
    let correlation = if deviation_correlation.abs() > rank_correlation.abs() {
        format!("rank correlation {deviation_correlation:.2} with its deviation")
    } else {
        format!("rank correlation {rank_correlation:.2}")
    };
    let worst = worst.map_or_else(String::new, |(row, run)| {
        let sign = if deviations[row] < 0.0 { "-" } else { "+" };
        format!("; run {run} has {sign}{}", shown(sizes[row]))
    });
    DrivingKey {
        text: format!("{}: {}{worst}", own.key, within.unwrap_or(correlation)),
        key: own.key.clone(),
        rank_correlation,
        deviation_correlation,
        met_within,
        none_beyond,
    }
}

/// Returns a deviation in per cent with three digits.
fn percent_of(share: f64) -> String {
    let text = number(100.0 * share);
    if text == "0" { percent(share) } else { format!("{text} %") }
}

/// Returns Spearman's rank correlation of two lists, without the pairs that have NaN; 0 if one of them does not vary.
fn rank_correlation(one: &[f64], other: &[f64]) -> f64 {
    let pairs: Vec<[f64; 2]> = one
        .iter()
        .zip(other)
        .map(|(one, other)| [*one, *other])
        .filter(|pair| pair.iter().all(|value| !value.is_nan()))
        .collect();
    let ranks = |which: usize| ranks(&pairs.iter().map(|pair| pair[which]).collect::<Vec<_>>());
    let (a, b) = (ranks(0), ranks(1));
    let mean = f64::midpoint(pairs.len() as f64, 1.0);
    let product =
        |a: &[f64], b: &[f64]| -> f64 { a.iter().zip(b).map(|(a, b)| (a - mean) * (b - mean)).sum() };
    let size = (product(&a, &a) * product(&b, &b)).sqrt();
    if size > 0.0 { product(&a, &b) / size } else { 0.0 }
}

/// Returns the ranks of values from 1; equal ones share their mean rank.
fn ranks(values: &[f64]) -> Vec<f64> {
    let mut order: Vec<usize> = (0..values.len()).collect();
    order.sort_by(|a, b| values[*a].total_cmp(&values[*b]));
    let mut ranks = vec![0.0; values.len()];
    for group in order.chunk_by(|a, b| values[*a] == values[*b]) {
        let before = order.partition_point(|index| values[*index] < values[group[0]]);
        for index in group {
            ranks[*index] = before as f64 + f64::midpoint(group.len() as f64, 1.0);
        }
    }
    ranks
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn correlations_are_those_of_scipy() {
        // scipy.stats.spearmanr([1, 2, 3, 4, 5, 5], [2, 1, 4, 3, 7, 6]) and of the same without the pair of NaN.
        let found =
            rank_correlation(&[1.0, 2.0, 3.0, 4.0, 5.0, 5.0, f64::NAN], &[2.0, 1.0, 4.0, 3.0, 7.0, 6.0, 0.0]);
        assert!((found - 0.869_656_553_478_672_7).abs() < 1e-12, "{found}");
        assert_eq!(rank_correlation(&[1.0, 1.0], &[1.0, 2.0]), 0.0);
    }

    #[test]
    fn a_key_that_matters_by_its_size_has_a_range() {
        let values: Vec<f64> = (-10..=10).map(f64::from).collect();
        let errors: Vec<f64> = values.iter().map(|value| value * value).collect();
        let key =
            |key: &str, values: Vec<f64>| UncertainValues { key: key.to_owned(), design: 100.0, values };
        let keys = [
            key("idle", values.iter().map(|value| 100.0 + (7.0 * value).rem_euclid(5.0)).collect()),
            key("mass", values.iter().map(|value| 100.0 + value).collect()),
        ];
        let met: Vec<bool> = errors.iter().map(|error| *error <= 20.0).collect();
        let found = driving_keys(&keys, &errors, &met, Some((0, 40)), |_, size| size.to_string());
        assert_eq!(found.len(), 1);
        let first = &found[0];
        assert!(first.rank_correlation.abs() < 1e-12 && (first.deviation_correlation - 1.0).abs() < 1e-12);
        // 4² is met and 5² is not.
        assert!((first.met_within.unwrap_or(0.0) - 0.04).abs() < 1e-12, "{first:?}");
        assert!((first.none_beyond.unwrap_or(0.0) - 0.04).abs() < 1e-12, "{first:?}");
        assert!(
            first.text.starts_with("mass: met in every run within ±4 % of its value, in none beyond ±4 %"),
            "{}",
            first.text
        );
        assert!(first.text.ends_with("; run 40 has -10 %"), "{}", first.text);
    }
}
