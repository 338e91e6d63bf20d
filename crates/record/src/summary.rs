//! Metrics of a run as texts, for the tables of viewers.

use super::metrics::{MetricValue, Metrics, NamedMetric};
use super::{MetricLine, MetricPage, Summary};

/// Largest number of values that are written of a list.
const MOST_VALUES: usize = 6;

impl Summary {
    /// Number of rows in Lichtblick's tables.
    pub const PAGE: usize = 10;

    /// Creates the summary of metrics.
    pub fn from_metrics(metrics: &Metrics) -> Self {
        let page = |page: &[NamedMetric]| MetricPage { metrics: page.iter().map(line).collect() };
        Self { pages: metrics.0.chunks(Self::PAGE).map(page).collect() }
    }
}

fn line((meaning, value): &NamedMetric) -> MetricLine {
    let value = match value {
        MetricValue::Count(count) => count.to_string(),
        MetricValue::Number(value) => number(*value),
        MetricValue::Word(word) => (*word).to_owned(),
        MetricValue::Words(words) => list(words, String::clone),
        MetricValue::Numbers(numbers) => list(numbers, |value| number(*value)),
        MetricValue::Quantities(quantities) => list(quantities, |quantity| {
            format!("{} {}", number(quantity.value), quantity.unit).trim_end().to_owned()
        }),
    };
    MetricLine { name: meaning.name.to_owned(), value, unit: meaning.unit.to_owned() }
}

/// Returns the first values of a list as a text.
fn list<T>(values: &[T], text: impl Fn(&T) -> String) -> String {
    if values.is_empty() {
        return "none".to_owned();
    }
    let mut texts: Vec<String> = values.iter().take(MOST_VALUES).map(text).collect();
    if values.len() > MOST_VALUES {
        texts.push(format!("… ({} in all)", values.len()));
    }
    texts.join(", ")
}

/// Formats a number with five digits.
fn number(value: f64) -> String {
    let size = value.abs();
    if value.is_nan() {
        "none".to_owned()
    } else if libm::trunc(value) == value && size < 1e9 {
        value.to_string()
    } else if (1e-3..1e5).contains(&size) {
        let digits = 4 - libm::floor(libm::log10(size)) as i32;
        format!("{value:.*}", digits.unsigned_abs() as usize)
    } else {
        format!("{value:.4e}")
    }
}

#[cfg(test)]
mod tests {
    use super::super::metrics::MetricDescription;
    use super::*;

    static MEANING: MetricDescription = MetricDescription { name: "a", unit: "s", doc: "" };

    #[test]
    fn lists_are_one_line_and_pages_have_ten() {
        let list = |count: usize| MetricValue::Numbers((0..count).map(|i| 0.5 + i as f64).collect());
        let mut values = vec![
            MetricValue::Number(718.275_4),
            MetricValue::Number(-1.5e-7),
            MetricValue::Number(12.0),
            MetricValue::Number(f64::NAN),
            MetricValue::Count(3),
            list(0),
            list(2),
            list(7),
        ];
        values.extend([0.0; 3].map(MetricValue::Number));
        let pages =
            Summary::from_metrics(&Metrics(values.into_iter().map(|value| (&MEANING, value)).collect()))
                .pages;
        assert_eq!(pages.iter().map(|page| page.metrics.len()).collect::<Vec<_>>(), [10, 1]);
        let values: Vec<&str> = pages[0].metrics[..8].iter().map(|line| &line.value[..]).collect();
        let long = "0.50000, 1.5000, 2.5000, 3.5000, 4.5000, 5.5000, … (7 in all)";
        assert_eq!(values, ["718.28", "-1.5000e-7", "12", "none", "3", "none", "0.50000, 1.5000", long]);
    }
}
