//! Running means of a filter's consistency, and their axis.

use flexsc_figure::{FigureAxis, Point};

/// Value above which an axis is logarithmic.
const FAR: f64 = 10.0;

/// Returns the moving averages over `window` samples, each at its last sample. Samples without a value are skipped.
pub fn averages(values: &[Point], window: usize) -> Vec<Point> {
    let mean = |row: &[Point]| {
        let finite = || row.iter().map(|point| point.1).filter(|value| value.is_finite());
        (row[row.len() - 1].0, finite().sum::<f64>() / finite().count() as f64)
    };
    values.windows(window).map(mean).collect()
}

/// Returns the axis of a ratio that is about 1: logarithmic if it is far above it.
pub fn ratio_axis(name: &str, values: impl Iterator<Item = f64> + Clone) -> FigureAxis {
    if values.clone().any(|value| value > FAR) {
        FigureAxis::decades(name, "", values)
    } else {
        FigureAxis::from_zero(name, "", values)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn dropped_samples_do_not_count() {
        let values = [(0.0, 1.0), (1.0, f64::NAN), (2.0, 3.0), (3.0, 5.0)];
        assert_eq!(averages(&values, 3), [(2.0, 2.0), (3.0, 4.0)]);
        assert!(averages(&[], 3).is_empty());
    }
}
