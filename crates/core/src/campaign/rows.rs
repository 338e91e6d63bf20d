//! Rows of a campaign's table, one for each run, held as typed columns.

use std::borrow::Cow;
use std::ops::Range;
use std::sync::Arc;

use toml::Value as Drawn;

use super::{Campaign, RunOutcome};
use crate::metrics::{MetricValue, Metrics, MetricsCollector, Selection, list_element};

/// Name of the column with the numbers of the runs, the first of every table.
pub const RUN: &str = "run";
/// Name of the column with the scenario's seed.
pub const SEED: &str = "seed";
/// Name of the column with the duration of a run's computation (s), which differs between equal campaigns.
pub const SECONDS: &str = "seconds";
/// Name of the column with the reason why a run failed.
pub const ERROR: &str = "error";

/// Separator of the words of a list in a cell.
pub const WORD_SEPARATOR: &str = "; ";

/// Type of a column. Cells without a value are null.
#[derive(Copy, Clone, Debug, PartialEq, Eq)]
pub enum ColumnKind {
    /// Integers.
    Integers,
    /// Numbers.
    Numbers,
    /// Text.
    Text,
    /// Lists of numbers.
    Lists,
}

/// Name, unit and type of a column.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ColumnHeading {
    /// Name: of a key, of a metric, or of a column about the run.
    pub name: String,
    /// Unit of a metric.
    pub unit: &'static str,
    /// Type of the cells.
    pub kind: ColumnKind,
}

/// Cells of a column. Two are equal if all bits are; null cells are equal.
#[derive(Clone, Debug)]
pub enum ColumnCells {
    /// Integers.
    Integers(Vec<Option<i64>>),
    /// Numbers; NaN for null.
    Numbers(Vec<f64>),
    /// Text.
    Text(Vec<Option<String>>),
    /// Lists of numbers, with NaN for null.
    Lists(Vec<Option<Vec<f64>>>),
}

impl PartialEq for ColumnCells {
    fn eq(&self, other: &Self) -> bool {
        let bits = |number: &f64| if number.is_nan() { u64::MAX } else { number.to_bits() };
        let list =
            |cell: &Option<Vec<f64>>| cell.as_ref().map(|list| list.iter().map(bits).collect::<Vec<_>>());
        match (self, other) {
            (Self::Integers(one), Self::Integers(other)) => one == other,
            (Self::Numbers(one), Self::Numbers(other)) => one.iter().map(bits).eq(other.iter().map(bits)),
            (Self::Text(one), Self::Text(other)) => one == other,
            (Self::Lists(one), Self::Lists(other)) => one.iter().map(list).eq(other.iter().map(list)),
            _ => false,
        }
    }
}

/// Rows of consecutive runs.
#[derive(Clone, Debug, PartialEq)]
pub struct RunRows {
    /// Headings of the columns.
    pub fields: Arc<[ColumnHeading]>,
    /// Cells of the columns.
    pub columns: Vec<ColumnCells>,
}

impl Campaign {
    /// Returns the headings of the campaign's table, which are fixed before any run.
    pub fn fields(&self, selection: &Selection) -> Arc<[ColumnHeading]> {
        let heading = |name: &str, kind, unit| ColumnHeading { name: name.to_owned(), unit, kind };
        let key = |name: &str| heading(name, self.kind_of_key(name), "");
        let reported = selection.select(MetricsCollector::new(self.scenario()).finish(self.scenario()));
        let metric = |(meaning, value): &(&'static crate::metrics::MetricDescription, MetricValue)| {
            let kind = match value {
                MetricValue::Count(_) => ColumnKind::Integers,
                MetricValue::Number(_) => ColumnKind::Numbers,
                MetricValue::Word(_) | MetricValue::Words(_) => ColumnKind::Text,
                MetricValue::Numbers(_) | MetricValue::Quantities(_) => ColumnKind::Lists,
            };
            heading(meaning.name, kind, meaning.unit)
        };
        let mut fields = vec![heading(RUN, ColumnKind::Integers, "")];
        if self.keys().all(|key| key != SEED) {
            fields.push(heading(SEED, ColumnKind::Integers, ""));
        }
        fields.extend(self.keys().map(key));
        fields.extend(reported.0.iter().map(metric));
        fields.extend([heading(SECONDS, ColumnKind::Numbers, "s"), heading(ERROR, ColumnKind::Text, "")]);
        fields.into()
    }

    /// Returns the type of the column of a varied key.
    fn kind_of_key(&self, key: &str) -> ColumnKind {
        let is_number = |value: &Drawn| value.is_float() || value.is_integer();
        let is_list = |value: &Drawn| value.as_array().is_some_and(|list| list.iter().all(is_number));
        if let Some(Drawn::String(_)) = self.scenario().uncertain.get(key).map(|_| self.nominal(key)) {
            return ColumnKind::Text;
        }
        let is_all = |is_kind: &dyn Fn(&Drawn) -> bool| {
            self.design().values_of(key).is_none_or(|mut values| values.all(is_kind))
        };
        match () {
            () if is_all(&is_number) && self.is_integer(key) => ColumnKind::Integers,
            () if is_all(&is_number) => ColumnKind::Numbers,
            () if is_all(&is_list) => ColumnKind::Lists,
            () => ColumnKind::Text,
        }
    }
}

/// Returns a number as a float; NaN for a value of another type.
fn number(value: &Drawn) -> f64 {
    value.as_float().or_else(|| Some(value.as_integer()? as f64)).unwrap_or(f64::NAN)
}

impl ColumnCells {
    /// Creates an empty column.
    pub fn empty(kind: ColumnKind) -> Self {
        match kind {
            ColumnKind::Integers => Self::Integers(Vec::new()),
            ColumnKind::Numbers => Self::Numbers(Vec::new()),
            ColumnKind::Text => Self::Text(Vec::new()),
            ColumnKind::Lists => Self::Lists(Vec::new()),
        }
    }

    /// Returns the number of cells.
    pub fn len(&self) -> usize {
        match self {
            Self::Integers(cells) => cells.len(),
            Self::Numbers(cells) => cells.len(),
            Self::Text(cells) => cells.len(),
            Self::Lists(cells) => cells.len(),
        }
    }

    /// Returns true if there is no cell.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Returns the cells of these rows; none beyond the last one.
    #[must_use]
    pub fn slice(self, rows: Range<usize>) -> Self {
        fn cut<T>(cells: Vec<T>, rows: Range<usize>) -> Vec<T> {
            cells.into_iter().skip(rows.start).take(rows.len()).collect()
        }
        match self {
            Self::Integers(cells) => Self::Integers(cut(cells, rows)),
            Self::Numbers(cells) => Self::Numbers(cut(cells, rows)),
            Self::Text(cells) => Self::Text(cut(cells, rows)),
            Self::Lists(cells) => Self::Lists(cut(cells, rows)),
        }
    }

    /// Returns the number of cells that are not null.
    pub fn non_null_count(&self) -> usize {
        match self {
            Self::Integers(cells) => cells.iter().flatten().count(),
            Self::Numbers(cells) => cells.iter().filter(|cell| !cell.is_nan()).count(),
            Self::Text(cells) => cells.iter().flatten().count(),
            Self::Lists(cells) => cells.iter().flatten().count(),
        }
    }

    /// Returns the cells as numbers: integers by their value, verdicts by their score, and NaN for other words, lists
    /// and null.
    pub fn numbers(&self) -> Vec<f64> {
        match self {
            Self::Integers(cells) => cells.iter().map(|cell| cell.map_or(f64::NAN, |i| i as f64)).collect(),
            Self::Numbers(cells) => cells.clone(),
            Self::Text(cells) => {
                let score =
                    |cell: &Option<String>| crate::metrics::goal::score(cell.as_deref().unwrap_or(""));
                cells.iter().map(|cell| score(cell).unwrap_or(f64::NAN)).collect()
            }
            Self::Lists(cells) => vec![f64::NAN; cells.len()],
        }
    }

    /// Returns the elements of lists at an index, null where a list has none; `None` for another column.
    pub fn element(&self, index: usize) -> Option<Self> {
        let Self::Lists(cells) = self else { return None };
        let at = |cell: &Option<Vec<f64>>| cell.as_ref().and_then(|list| list.get(index).copied());
        Some(Self::Numbers(cells.iter().map(|cell| at(cell).unwrap_or(f64::NAN)).collect()))
    }

    /// Returns the length of the longest list; 0 for another column.
    pub fn elements(&self) -> usize {
        let Self::Lists(cells) = self else { return 0 };
        cells.iter().flatten().map(Vec::len).max().unwrap_or(0)
    }

    fn push_null(&mut self) {
        match self {
            Self::Integers(cells) => cells.push(None),
            Self::Numbers(cells) => cells.push(f64::NAN),
            Self::Text(cells) => cells.push(None),
            Self::Lists(cells) => cells.push(None),
        }
    }

    fn push_drawn(&mut self, value: &Drawn) {
        match (self, value) {
            (Self::Integers(cells), Drawn::Integer(integer)) => cells.push(Some(*integer)),
            (Self::Numbers(cells), Drawn::Float(number)) => cells.push(*number),
            (Self::Numbers(cells), Drawn::Integer(integer)) => cells.push(*integer as f64),
            (Self::Lists(cells), Drawn::Array(list)) => cells.push(Some(list.iter().map(number).collect())),
            (Self::Text(cells), Drawn::String(word)) => cells.push(Some(word.clone())),
            // As TOML.
            (Self::Text(cells), other) => cells.push(Some(other.to_string())),
            (column, _) => column.push_null(),
        }
    }

    /// Appends the value of a metric, or null without one.
    pub(super) fn push_metric(&mut self, value: Option<&MetricValue>) {
        match value {
            Some(value) => self.push(value),
            None => self.push_null(),
        }
    }

    /// Returns the value of a metric in a row; `None` for null. Words are a list.
    pub(super) fn metric_value(&self, row: usize) -> Option<MetricValue> {
        Some(match self {
            Self::Integers(cells) => MetricValue::Count((*cells.get(row)?)?.cast_unsigned()),
            Self::Numbers(cells) => MetricValue::Number(*cells.get(row)?),
            Self::Text(cells) => {
                let words = cells.get(row)?.as_ref()?.split(WORD_SEPARATOR);
                MetricValue::Words(words.filter(|word| !word.is_empty()).map(str::to_owned).collect())
            }
            Self::Lists(cells) => MetricValue::Numbers(cells.get(row)?.clone()?),
        })
    }

    fn push(&mut self, value: &MetricValue) {
        match (self, value) {
            (Self::Integers(cells), MetricValue::Count(count)) => cells.push(i64::try_from(*count).ok()),
            (Self::Numbers(cells), MetricValue::Number(number)) => cells.push(*number),
            (Self::Text(cells), MetricValue::Word(word)) => cells.push(Some((*word).to_owned())),
            (Self::Text(cells), MetricValue::Words(words)) => cells.push(Some(words.join(WORD_SEPARATOR))),
            (Self::Lists(cells), MetricValue::Numbers(_) | MetricValue::Quantities(_)) => {
                cells.push(Some(value.numbers()));
            }
            (column, _) => column.push_null(),
        }
    }

    /// Appends the cells of another column of the same type.
    pub fn append(&mut self, other: Self) {
        match (self, other) {
            (Self::Integers(cells), Self::Integers(mut more)) => cells.append(&mut more),
            (Self::Numbers(cells), Self::Numbers(mut more)) => cells.append(&mut more),
            (Self::Text(cells), Self::Text(mut more)) => cells.append(&mut more),
            (Self::Lists(cells), Self::Lists(mut more)) => cells.append(&mut more),
            // Cells of another type become null.
            (column, other) => (0..other.len()).for_each(|_| column.push_null()),
        }
    }
}

impl RunRows {
    /// Creates an empty table.
    pub fn new(fields: Arc<[ColumnHeading]>) -> Self {
        let columns = fields.iter().map(|field| ColumnCells::empty(field.kind)).collect();
        Self { fields, columns }
    }

    /// Returns the number of rows.
    pub fn len(&self) -> usize {
        self.columns.first().map_or(0, ColumnCells::len)
    }

    /// Returns true if there is no row.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Returns a column by its name, or the elements `NAME[i]` of a column of lists.
    pub fn column(&self, name: &str) -> Option<Cow<'_, ColumnCells>> {
        let named = |name: &str| {
            let place = self.fields.iter().position(|field| field.name == name)?;
            self.columns.get(place)
        };
        named(name).map(Cow::Borrowed).or_else(|| {
            let (list, index) = list_element(name)?;
            named(list)?.element(index).map(Cow::Owned)
        })
    }

    /// Appends the row of a run.
    pub fn push(&mut self, campaign: &Campaign, outcome: &RunOutcome) {
        let keys = outcome.drawn.len();
        let first = self.fields.iter().take_while(|field| [RUN, SEED].contains(&field.name.as_str())).count();
        // The seed may be a key of the campaign.
        let first = if campaign.keys().next() == Some(SEED) { 1 } else { first };
        let mut metrics = outcome.metrics.as_ref().ok().map(Metrics::in_order);
        for (place, (field, column)) in self.fields.iter().zip(&mut self.columns).enumerate() {
            match (field.name.as_str(), column) {
                (RUN, ColumnCells::Integers(cells)) => cells.push(i64::try_from(outcome.number).ok()),
                (SEED, ColumnCells::Integers(cells)) if place < first => {
                    cells.push(i64::try_from(campaign.scenario().seed).ok());
                }
                (_, column) if place < first + keys => column.push_drawn(&outcome.drawn[place - first]),
                (SECONDS, ColumnCells::Numbers(cells)) => cells.push(outcome.seconds),
                (ERROR, ColumnCells::Text(cells)) => {
                    cells.push(outcome.metrics.as_ref().err().map(ToString::to_string));
                }
                (name, column) => column.push_metric(metrics.as_mut().and_then(|metrics| metrics.get(name))),
            }
        }
    }
}
