//! Uncertain keys that are drawn together: a Gaussian copula.

use flexsc_formats::document::ConfigError;
use flexsc_numerics::quantity::Finite;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// Bound of the rounding errors of a zero variance (`[[1, 1], [1, 1]]` is accepted).
const ROUNDING: f64 = 1e-12;

/// Correlated keys of `[uncertain]`. Each key is drawn from a standard normal number; the matrix correlates these numbers,
/// and each key keeps its own distribution. For normal distributions these are the correlations of the keys.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Correlated {
    /// The keys.
    pub keys: Vec<String>,
    /// The correlations: symmetric, with ones on the diagonal, in the order of the keys.
    pub matrix: Vec<Vec<Finite>>,
}

impl Correlated {
    /// Returns the first inconsistency of the correlations.
    pub fn validate(&self) -> Option<ConfigError> {
        let fault = |key: &str, why: String| Some(ConfigError::new(key, why));
        let order = self.keys.len();
        if order < 2 {
            return fault("keys", format!("needs at least two keys, got {order}"));
        }
        if let Some((_, twice)) =
            self.keys.iter().enumerate().find(|(place, key)| self.keys[..*place].contains(key))
        {
            return fault("keys", format!("names `{twice}` twice"));
        }
        if self.matrix.len() != order || self.matrix.iter().any(|row| row.len() != order) {
            return fault("matrix", format!("must have {order} rows of {order} numbers, as many as keys"));
        }
        let correlation_at = |row: usize, column: usize| self.matrix[row][column].get();
        for row in 0..order {
            if correlation_at(row, row) != 1.0 {
                return fault(
                    "matrix",
                    format!("must have ones on its diagonal, got {}", correlation_at(row, row)),
                );
            }
            for column in 0..row {
                if correlation_at(row, column) != correlation_at(column, row) {
                    let (one, other) = (correlation_at(row, column), correlation_at(column, row));
                    return fault("matrix", format!("must be symmetric, got {one} and {other}"));
                }
                if correlation_at(row, column).abs() > 1.0 {
                    let why =
                        format!("must have correlations from -1 to 1, got {}", correlation_at(row, column));
                    return fault("matrix", why);
                }
            }
        }
        if self.factor().is_none() {
            let why = "is impossible: no numbers have all these correlations (it has a negative eigenvalue)";
            return fault("matrix", why.to_owned());
        }
        None
    }

    /// Returns the lower triangle whose product with its transpose is the matrix (Cholesky); `None` if an eigenvalue is
    /// negative.
    fn factor(&self) -> Option<Vec<Vec<f64>>> {
        let order = self.keys.len();
        let mut factor = vec![vec![0.0; order]; order];
        for row in 0..order {
            for column in 0..=row {
                let known: f64 = (0..column).map(|k| factor[row][k] * factor[column][k]).sum();
                let rest = self.matrix[row][column].get() - known;
                if row == column {
                    if rest < -ROUNDING {
                        return None;
                    }
                    factor[row][row] = f64::sqrt(rest.max(0.0));
                } else if factor[column][column] > ROUNDING {
                    factor[row][column] = rest / factor[column][column];
                } else if rest.abs() > 1e-8 {
                    return None;
                }
            }
        }
        Some(factor)
    }

    /// Returns correlated standard normal numbers, one for each key, computed from independent ones.
    pub fn correlate(&self, independent: &[f64]) -> Vec<f64> {
        // The scenario was checked, so the factor exists.
        let factor = self.factor().unwrap_or_default();
        factor.iter().map(|row| row.iter().zip(independent).map(|(a, b)| a * b).sum()).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use flexsc_numerics::random::Seed;

    fn from_matrix(matrix: &[&[f64]]) -> Correlated {
        let row =
            |row: &&[f64]| row.iter().map(|value| Finite::new(*value).expect("finite")).collect::<Vec<_>>();
        let keys = (0..matrix.len()).map(|key| format!("k{key}")).collect();
        Correlated { keys, matrix: matrix.iter().map(row).collect() }
    }

    #[test]
    fn numbers_have_the_correlations() {
        let correlated = from_matrix(&[&[1.0, 0.8, -0.3], &[0.8, 1.0, 0.1], &[-0.3, 0.1, 1.0]]);
        assert_eq!(correlated.validate(), None);
        let mut stream = Seed { scenario: 1, run: 0 }.stream("correlated");
        let count = 100_000;
        let mut sums = [[0.0; 3]; 3];
        for _ in 0..count {
            let z = correlated.correlate(&[stream.normal(), stream.normal(), stream.normal()]);
            for (row, sums) in sums.iter_mut().enumerate() {
                for (column, sum) in sums.iter_mut().enumerate() {
                    *sum += z[row] * z[column] / f64::from(count);
                }
            }
        }
        for (row, sums) in sums.iter().enumerate() {
            for (column, sum) in sums.iter().enumerate() {
                let exact = correlated.matrix[row][column].get();
                // Four standard errors, at most sqrt(2/n).
                assert!((sum - exact).abs() < 0.018, "{row} {column}: {sum}");
            }
        }
    }

    #[test]
    fn what_cannot_be_is_refused() {
        let why =
            |matrix: &[&[f64]]| from_matrix(matrix).validate().map(|fault| fault.why).unwrap_or_default();
        assert!(why(&[&[1.0]]).contains("two keys"));
        assert!(why(&[&[1.0, 0.5], &[0.4, 1.0]]).contains("symmetric"));
        assert!(why(&[&[1.0, 1.5], &[1.5, 1.0]]).contains("from -1 to 1"));
        assert!(why(&[&[1.0, 0.5], &[0.5, 0.9]]).contains("diagonal"));
        assert!(why(&[&[1.0, 0.5], &[0.5]]).contains("as many as keys"));
        let impossible: [&[f64]; 3] = [&[1.0, 0.9, -0.9], &[0.9, 1.0, 0.9], &[-0.9, 0.9, 1.0]];
        assert!(why(&impossible).contains("negative eigenvalue"));
        // Keys with one and the same number.
        assert_eq!(from_matrix(&[&[1.0, 1.0], &[1.0, 1.0]]).validate(), None);
        assert_eq!(from_matrix(&[&[1.0, 1.0], &[1.0, 1.0]]).correlate(&[0.5, 2.0]), [0.5, 0.5]);
    }
}
