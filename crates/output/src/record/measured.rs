//! What the metrics of a run are: named values with units, as JSON and as rows of a log.

use serde_json::{Map, Value as Json, json};

use super::{Metric, Metrics as Row};

/// What a metric means.
#[derive(Copy, Clone, Debug, PartialEq, Eq)]
pub struct Meaning {
    /// Name.
    pub name: &'static str,
    /// Unit; empty for a count, a ratio or a word.
    pub unit: &'static str,
    /// What it tells.
    pub doc: &'static str,
}

/// The value of a metric.
#[derive(Clone, Debug, PartialEq)]
pub enum Value {
    /// A count.
    Count(u64),
    /// A number; NaN where there is none.
    Number(f64),
    /// Numbers.
    Numbers(Vec<f64>),
    /// Numbers, each with its own unit.
    Quantities(Vec<Quantity>),
    /// A word.
    Word(&'static str),
}

/// A number with its unit.
#[derive(Clone, Debug, PartialEq)]
pub struct Quantity {
    /// The number; NaN where there is none.
    pub value: f64,
    /// Its unit.
    pub unit: String,
}

/// A metric and its value.
pub type MetricValue = (&'static Meaning, Value);

/// The metrics of one run.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Metrics(pub Vec<MetricValue>);

impl Metrics {
    /// The value of a metric.
    pub fn get(&self, name: &str) -> Option<&Value> {
        self.0.iter().find(|(meaning, _)| meaning.name == name).map(|(_, value)| value)
    }

    /// The same metrics, to be asked for in about their order.
    pub fn in_order(&self) -> InOrder<'_> {
        InOrder { metrics: self, next: 0 }
    }

    /// The value of a metric that is a number or a count.
    pub fn number(&self, name: &str) -> Option<f64> {
        match self.get(name)? {
            Value::Number(number) => Some(*number),
            Value::Count(count) => Some(*count as f64),
            _ => None,
        }
    }

    /// The metrics as a JSON object. What is not a number is null.
    pub fn to_json(&self) -> Json {
        let object = self.0.iter().map(|(meaning, value)| (meaning.name.to_owned(), value.to_json()));
        Json::Object(object.collect::<Map<_, _>>())
    }

    /// The metrics as a log holds them.
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
                Value::Count(count) => push(0, *count as f64, "", meaning.unit),
                Value::Number(number) => push(0, *number, "", meaning.unit),
                Value::Word(word) => push(0, f64::NAN, word, meaning.unit),
                Value::Numbers(numbers) => {
                    let each = numbers.iter().enumerate();
                    each.for_each(|(index, number)| push(index, *number, "", meaning.unit));
                }
                Value::Quantities(quantities) => {
                    let each = quantities.iter().enumerate();
                    each.for_each(|(index, of)| push(index, of.value, "", &of.unit));
                }
            }
        }
        Row { metrics }
    }
}

/// Metrics that are asked for in about their order: each is looked for behind the last one first.
#[derive(Copy, Clone, Debug)]
pub struct InOrder<'a> {
    metrics: &'a Metrics,
    next: usize,
}

impl<'a> InOrder<'a> {
    /// The value of a metric.
    pub fn get(&mut self, name: &str) -> Option<&'a Value> {
        let all = &self.metrics.0;
        let is_it = |place: &usize| all[*place].0.name == name;
        let place = (self.next..all.len()).find(is_it).or_else(|| (0..self.next).find(is_it))?;
        self.next = place + 1;
        Some(&all[place].1)
    }
}

impl Value {
    /// The numbers of a metric that has several; none of another.
    pub fn numbers(&self) -> Vec<f64> {
        match self {
            Self::Numbers(numbers) => numbers.clone(),
            Self::Quantities(quantities) => quantities.iter().map(|of| of.value).collect(),
            Self::Count(_) | Self::Number(_) | Self::Word(_) => Vec::new(),
        }
    }

    /// The value as JSON; NaN is null.
    pub fn to_json(&self) -> Json {
        match self {
            Self::Count(count) => json!(count),
            Self::Number(number) => json!(number),
            Self::Numbers(numbers) => json!(numbers),
            Self::Quantities(_) => json!(self.numbers()),
            Self::Word(word) => json!(word),
        }
    }
}
