//! Axis limits of plots whose values are too small for a viewer's own choice of the axes.

use flexsc_core::record::{Column, Columns, Log, LogError};

use super::Layout;
use super::panel::{LayoutPanel, topic};

/// Magnitude below which a plot may be flat: the steps of a viewer's vertical axis, and its ends, are multiples of
/// 0.001 at least.
const SMALL: f64 = 5e-3;
/// Fraction of the values' range that is left free above and below.
const MARGIN: f64 = 0.05;

impl Layout {
    /// Returns the layout with the vertical axes that the values of a log need.
    pub fn with_limits(&self, log: &Log) -> Result<Self, LogError> {
        let mut fitted = self.clone();
        let panels = || self.tabs.iter().flat_map(|tab| &tab.panels);
        let mut topics: Vec<&str> = panels()
            .flat_map(LayoutPanel::vertical_paths)
            .map(topic)
            .filter(|name| name.starts_with('/'))
            .collect();
        topics.sort_unstable();
        topics.dedup();
        let tables = log.tables(&topics)?;
        let extent = |path: &str| {
            // A path without a topic is a number.
            path.parse().map_or_else(
                |_| {
                    let place = topics.iter().position(|own| *own == topic(path))?;
                    range(tables[place].as_ref()?, path.split_once('.')?.1)
                },
                |value: f64| Some((value, value)),
            )
        };
        for panel in fitted.tabs.iter_mut().flat_map(|tab| &mut tab.panels) {
            let ranges = panel.vertical_paths().into_iter().filter_map(extent);
            let range = ranges.reduce(|(a, b), (c, d)| (a.min(c), b.max(d)));
            panel.limits = range.and_then(limits);
        }
        Ok(fitted)
    }
}

/// Returns the least and the greatest value of a field such as `modes[0].displacement_rad`.
fn range(columns: &Columns, field: &str) -> Option<(f64, f64)> {
    let inner = field.split_once('[').and_then(|(rows, rest)| {
        let (index, inner) = rest.split_once("].")?;
        Some((rows, index.parse::<u32>().ok()?, inner))
    });
    let Some((rows, index, inner)) = inner else { return ends(columns.numbers(field)?.iter().copied()) };
    let Some(Column::Rows(counts, columns)) = columns.get(rows) else { return None };
    let values = columns.numbers(inner)?;
    let mut first = 0;
    let of_row = counts.iter().filter_map(|count| {
        let place = (index < *count).then_some(first + index as usize);
        first += *count as usize;
        values.get(place?).copied()
    });
    ends(of_row)
}

/// Returns the least and the greatest of the values, without NaN.
fn ends(values: impl Iterator<Item = f64>) -> Option<(f64, f64)> {
    let pairs = values.filter(|value| value.is_finite()).map(|value| (value, value));
    pairs.reduce(|(a, b), (c, d)| (a.min(c), b.max(d)))
}

/// Returns the limits of a plot for values in a range, rounded outwards to two digits of the range; `None` if it needs
/// none.
fn limits((least, greatest): (f64, f64)) -> Option<[f64; 2]> {
    let range = greatest - least;
    if !(range > 0.0 && range < SMALL) {
        return None;
    }
    let digits = 1 - libm::floor(libm::log10(range)) as i32;
    let step = libm::pow(10.0, f64::from(-digits));
    let below = libm::floor((least - MARGIN * range) / step) * step;
    let above = libm::ceil((greatest + MARGIN * range) / step) * step;
    // Values that are never negative and begin near 0 are plotted from 0 on.
    let below = if least >= 0.0 && least < 0.5 * range { 0.0 } else { below };
    // The nearest double to the decimal number, so that it is written with few digits.
    let decimal = |value: f64| format!("{value:.*}", digits.unsigned_abs() as usize).parse().unwrap_or(value);
    let limits = [decimal(below), decimal(above)];
    // Values that differ in their last digits alone have no such limits.
    (limits[0] <= least && greatest < limits[1]).then_some(limits)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn small_ranges_have_limits_and_others_not() {
        for (range, expected) in [
            ((-4.4e-4, 5.1e-4), Some([-4.9e-4, 5.6e-4])),
            ((0.0, 1.83e-5), Some([0.0, 2e-5])),
            ((3e-6, 2.5e-5), Some([0.0, 2.7e-5])),
            ((0.60421, 0.60493), Some([0.60417, 0.60497])),
            ((-1.0, 1.0), None),
            ((0.0, 0.005), None),
            ((0.3, 0.3), None),
            ((1.0, 1.0 + 2e-16), None),
        ] {
            assert_eq!(limits(range), expected, "{range:?}");
        }
    }
}
