//! Refinement of a field to a finer grid by monotone cubics, which are smooth and stay within the neighbouring
//! values.

use crate::contour::ScalarField;

impl ScalarField {
    /// Returns the field with each step of the grid divided into `steps`.
    #[must_use]
    pub fn refined(&self, steps: usize) -> Self {
        let rows = self.y.len();
        if steps < 2 || self.x.is_empty() || rows == 0 {
            return Self { x: self.x.clone(), y: self.y.clone(), values: self.values.clone() };
        }
        let columns: Vec<Vec<f64>> = self.values.chunks(rows).map(|column| finer(column, steps)).collect();
        let (x, y) = (even(&self.x, steps), even(&self.y, steps));
        let across: Vec<Vec<f64>> = (0..y.len())
            .map(|row| finer(&columns.iter().map(|column| column[row]).collect::<Vec<_>>(), steps))
            .collect();
        let values = (0..x.len()).flat_map(|column| across.iter().map(move |row| row[column]));
        Self { values: values.collect(), x, y }
    }
}

/// Divides each interval between abscissae into `steps`.
fn even(values: &[f64], steps: usize) -> Vec<f64> {
    between(values, steps, |index, part| values[index] + part * (values[index + 1] - values[index]))
}

/// Interpolates values with `steps` per interval.
fn finer(values: &[f64], steps: usize) -> Vec<f64> {
    let rise: Vec<f64> = values.windows(2).map(|pair| pair[1] - pair[0]).collect();
    // Harmonic mean of the rises on both sides; zero at a peak (Fritsch and Butland).
    let slope = |index: usize| match (index.checked_sub(1).map(|before| rise[before]), rise.get(index)) {
        (Some(before), Some(&after)) if before * after > 0.0 => 2.0 * before * after / (before + after),
        (Some(_), Some(_)) | (None, None) => 0.0,
        (Some(only), None) | (None, Some(&only)) => only,
    };
    between(values, steps, |index, t| {
        let (a, b) = (values[index], values[index + 1]);
        let (da, db) = (slope(index), slope(index + 1));
        if !(a + b + da + db).is_finite() {
            return if t < 0.5 { a } else { b };
        }
        let u = 1.0 - t;
        u * u * (1.0 + 2.0 * t) * a + t * t * (1.0 + 2.0 * u) * b + t * u * (u * da - t * db)
    })
}

fn between(values: &[f64], steps: usize, value_at: impl Fn(usize, f64) -> f64) -> Vec<f64> {
    let inner = (0..values.len().saturating_sub(1))
        .flat_map(|index| (0..steps).map(move |step| (index, step as f64 / steps as f64)));
    let fine = inner.map(|(index, part)| if part == 0.0 { values[index] } else { value_at(index, part) });
    fine.chain(values.last().copied()).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_finer_field_has_the_same_values_and_none_beyond() {
        let values: Vec<f64> =
            (0..5).flat_map(|i| (0..4).map(move |j| f64::from((i * 7 + j * 3) % 5) - f64::from(i))).collect();
        let field = ScalarField { x: vec![0.0, 1.0, 2.0, 4.0, 5.0], y: vec![0.0, 0.5, 1.0, 2.0], values };
        let fine = field.refined(4);
        assert_eq!((fine.x.len(), fine.y.len(), fine.values.len()), (17, 13, 17 * 13));
        let value_at = |field: &ScalarField, i: usize, j: usize| field.values[i * field.y.len() + j];
        for i in 0..5 {
            for j in 0..4 {
                assert_eq!(value_at(&fine, 4 * i, 4 * j), value_at(&field, i, j));
            }
        }
        for i in 0..16 {
            for j in 0..12 {
                let corners =
                    [(0, 0), (1, 0), (0, 1), (1, 1)].map(|(a, b)| value_at(&field, i / 4 + a, j / 4 + b));
                let (low, high) =
                    corners.iter().fold((f64::MAX, f64::MIN), |(l, h), v| (l.min(*v), h.max(*v)));
                assert!((low - 1e-12..=high + 1e-12).contains(&value_at(&fine, i, j)), "{i} {j}");
            }
        }
        assert_eq!(fine.x[13], 4.25);
    }

    #[test]
    fn smooth_fields_are_met_and_infinities_stay_where_they_are() {
        let axis: Vec<f64> = (0..12).map(f64::from).collect();
        let values = axis.iter().flat_map(|x| axis.iter().map(move |y| x * x + 3.0 * y)).collect();
        // Slopes are one-sided at the ends.
        let fine = ScalarField { x: axis.clone(), y: axis.clone(), values }.refined(5);
        for (i, x) in fine.x.iter().enumerate().filter(|(_, x)| **x > 1.0 && **x < 10.0) {
            for (j, y) in fine.y.iter().enumerate() {
                let off = fine.values[i * fine.y.len() + j] - (x * x + 3.0 * y);
                assert!(off.abs() < 0.1, "{x} {y}: {off}");
            }
        }
        let broken =
            ScalarField { x: vec![0.0, 1.0, 2.0], y: vec![0.0], values: vec![1.0, f64::INFINITY, 2.0] }
                .refined(2);
        assert_eq!(broken.values, [1.0, f64::INFINITY, f64::INFINITY, 2.0, 2.0]);
        assert_eq!(ScalarField { x: vec![1.0], y: vec![2.0], values: vec![3.0] }.refined(9).values, [3.0]);
    }
}
