//! Metrics of a run: named values with units, as JSON and as rows of a log.

use serde_json::{Map, Value as Json, json};

use super::{Metric, Metrics as Row};

/// Description of a metric.
#[derive(Copy, Clone, Debug, PartialEq, Eq)]
pub struct MetricDescription {
    /// Name of the metric.
    pub name: &'static str,
    /// Unit; empty for a count, a ratio or a word.
    pub unit: &'static str,
    /// Explanation of the metric.
    pub doc: &'static str,
}

/// Value of a metric.
#[derive(Clone, Debug, PartialEq)]
pub enum MetricValue {
    /// Integer count.
    Count(u64),
    /// Number; NaN if there is none.
    Number(f64),
    /// List of numbers.
    Numbers(Vec<f64>),
    /// List of numbers, each with its own unit.
    Quantities(Vec<NumberWithUnit>),
    /// Word.
    Word(&'static str),
    /// List of words or descriptions.
    Words(Vec<String>),
}

/// Number with its unit.
#[derive(Clone, Debug, PartialEq)]
pub struct NumberWithUnit {
    /// Number; NaN if there is none.
    pub value: f64,
    /// Unit of the number.
    pub unit: String,
}

/// Metric with its value.
pub type NamedMetric = (&'static MetricDescription, MetricValue);

/// Metrics of one run.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Metrics(pub Vec<NamedMetric>);

impl Metrics {
    /// Returns the value of a metric.
    pub fn get(&self, name: &str) -> Option<&MetricValue> {
        self.0.iter().find(|(meaning, _)| meaning.name == name).map(|(_, value)| value)
    }

    /// Returns a view of the metrics for queries in about their order.
    pub fn in_order(&self) -> OrderedMetrics<'_> {
        OrderedMetrics { metrics: self, next: 0 }
    }

    /// Returns the value of a metric that is a number or a count.
    pub fn number(&self, name: &str) -> Option<f64> {
        match self.get(name)? {
            MetricValue::Number(number) => Some(*number),
            MetricValue::Count(count) => Some(*count as f64),
            _ => None,
        }
    }

    /// Returns the value of a metric that is a word; those that were read from a table or a log are lists of one.
    pub fn word(&self, name: &str) -> Option<&str> {
        match self.get(name)? {
            MetricValue::Word(word) => Some(word),
            MetricValue::Words(words) => words.first().map(String::as_str).filter(|_| words.len() == 1),
            _ => None,
        }
    }

    /// Returns the metrics as a JSON object, with null for NaN.
    pub fn to_json(&self) -> Json {
        let object = self.0.iter().map(|(meaning, value)| (meaning.name.to_owned(), value.to_json()));
        Json::Object(object.collect::<Map<_, _>>())
    }

    /// Returns the metrics as a row of a log.
    pub fn to_row(&self) -> Row {
        let mut metrics = Vec::new();
        for (meaning, value) in &self.0 {
            let mut push = |index: usize, value: f64, text: &str, unit: &str| {
                metrics.push(Metric {
                    name: meaning.name.to_owned(),
                    unit: unit.to_owned(),
                    index: index as u64,
                    value,
                    text: text.to_owned(),
                });
            };
            match value {
                MetricValue::Count(count) => push(0, *count as f64, "", meaning.unit),
                MetricValue::Number(number) => push(0, *number, "", meaning.unit),
                MetricValue::Word(word) => push(0, f64::NAN, word, meaning.unit),
                MetricValue::Words(words) => {
                    let each = words.iter().enumerate();
                    each.for_each(|(index, word)| push(index, f64::NAN, word, meaning.unit));
                }
                MetricValue::Numbers(numbers) => {
                    let each = numbers.iter().enumerate();
                    each.for_each(|(index, number)| push(index, *number, "", meaning.unit));
                }
                MetricValue::Quantities(quantities) => {
                    let each = quantities.iter().enumerate();
                    each.for_each(|(index, quantity)| push(index, quantity.value, "", &quantity.unit));
                }
            }
        }
        Row { metrics }
    }
}

/// View of metrics for queries in about their order: each search begins after the last result.
#[derive(Copy, Clone, Debug)]
pub struct OrderedMetrics<'a> {
    metrics: &'a Metrics,
    next: usize,
}

impl<'a> OrderedMetrics<'a> {
    /// Returns the value of a metric.
    pub fn get(&mut self, name: &str) -> Option<&'a MetricValue> {
        let all = &self.metrics.0;
        let is_it = |place: &usize| all[*place].0.name == name;
        let place = (self.next..all.len()).find(is_it).or_else(|| (0..self.next).find(is_it))?;
        self.next = place + 1;
        Some(&all[place].1)
    }
}

impl MetricValue {
    /// Returns the numbers of a metric that has several; empty for others.
    pub fn numbers(&self) -> Vec<f64> {
        match self {
            Self::Numbers(numbers) => numbers.clone(),
            Self::Quantities(quantities) => quantities.iter().map(|quantity| quantity.value).collect(),
            Self::Count(_) | Self::Number(_) | Self::Word(_) | Self::Words(_) => Vec::new(),
        }
    }

    /// Returns the words of a metric that has several; empty for others.
    pub fn words(&self) -> &[String] {
        if let Self::Words(words) = self { words } else { &[] }
    }

    /// Returns the value as JSON, with null for NaN.
    pub fn to_json(&self) -> Json {
        match self {
            Self::Count(count) => json!(count),
            Self::Number(number) => json!(number),
            Self::Numbers(numbers) => json!(numbers),
            Self::Quantities(_) => json!(self.numbers()),
            Self::Word(word) => json!(word),
            Self::Words(words) => json!(words),
        }
    }
}
