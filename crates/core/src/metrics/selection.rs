//! Selection of the metrics that are wanted: all, or those that are named.

use flexsc_formats::document::nearest;

use super::{
    ALL, MetricDescription, Metrics, REQUIREMENT, REQUIREMENT_SHARES, REQUIREMENT_TIMES, REQUIREMENT_VALUES,
    list_element,
};

/// Metrics of requirements, which are never left out.
const OF_REQUIREMENTS: [&str; 4] =
    [REQUIREMENT.name, REQUIREMENT_VALUES.name, REQUIREMENT_SHARES.name, REQUIREMENT_TIMES.name];

/// Metrics in a campaign's table.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Selection(Option<Vec<&'static str>>);

impl Selection {
    /// Selection of all metrics.
    pub const ALL: Self = Self(None);

    /// Returns the selection of metrics by their names; an element `NAME[i]` of a list selects the list.
    ///
    /// # Errors
    /// A name that is not a metric's.
    pub fn from_names<S: AsRef<str>>(names: impl IntoIterator<Item = S>) -> Result<Self, String> {
        let mut selected = Vec::new();
        for name in names {
            let name = name.as_ref().trim();
            let whole = list_element(name).map_or(name, |(list, _)| list);
            let Some(meaning) = ALL.iter().find(|meaning| meaning.name == whole) else {
                let names: Vec<&str> = ALL.iter().map(|meaning| meaning.name).collect();
                let close = nearest(name, &names);
                let hint = close.map_or_else(
                    || "`flexsc schema --metrics` lists them".to_owned(),
                    |close| format!("did you mean `{close}`?"),
                );
                return Err(format!("there is no metric `{name}`\n\nhint: {hint}"));
            };
            if !selected.contains(&meaning.name) {
                selected.push(meaning.name);
            }
        }
        Ok(Self(Some(selected)))
    }

    /// Returns true if a metric is wanted; those of requirements always are.
    pub fn wants(&self, name: &str) -> bool {
        self.0.as_ref().is_none_or(|names| names.contains(&name) || OF_REQUIREMENTS.contains(&name))
    }

    /// Returns the selection with other metrics.
    #[must_use]
    pub fn with(&self, others: impl Iterator<Item = &'static str>) -> Self {
        Self(self.0.as_ref().map(|names| names.iter().copied().chain(others).collect()))
    }

    /// Returns true if any of some metrics is wanted.
    pub fn wants_any(&self, metrics: &[MetricDescription]) -> bool {
        metrics.iter().any(|meaning| self.wants(meaning.name))
    }

    /// Returns the names of the metrics that are wanted; `None` for all.
    pub fn names(&self) -> Option<&[&'static str]> {
        self.0.as_deref()
    }

    /// Returns those metrics of a run that are wanted, in the order in which all are reported.
    #[must_use]
    pub fn select(&self, metrics: Metrics) -> Metrics {
        match self.0 {
            None => metrics,
            Some(_) => {
                Metrics(metrics.0.into_iter().filter(|(meaning, _)| self.wants(meaning.name)).collect())
            }
        }
    }
}
