//! What the rows of a campaign come to: the statistics of the metrics that are numbers.

use super::directory::Work;
use super::rows::{Column, Kind};
use crate::metrics::{self, Meaning, goal};
use crate::statistics::Statistics;

impl Work {
    /// The metrics that have statistics: numbers, and whether goals are met.
    pub fn numeric(&self) -> Vec<(&str, &'static Meaning)> {
        let keys: Vec<&str> = self.campaign.keys().collect();
        let fields = self.fields().iter().filter(|field| !keys.contains(&field.name.as_str()));
        let numeric = fields.filter(|field| match field.kind {
            Kind::Integers | Kind::Numbers => true,
            Kind::Words => goal::NAMES.contains(&field.name.as_str()),
            Kind::Lists => false,
        });
        let scenario = Some(self.campaign.scenario());
        let meaning = |name: &str| metrics::meaning(name, scenario);
        numeric.filter_map(|field| Some((field.name.as_str(), meaning(&field.name)?))).collect()
    }

    /// The statistics of all of them; `columns` gives some columns by their names, nothing for one that is not there.
    ///
    /// No more than so many numbers are `held` at once, or those of one metric.
    pub fn statistics<E>(
        &self,
        runs: usize,
        held: usize,
        columns: impl Fn(&[&str]) -> Result<Vec<Option<Column>>, E>,
    ) -> Result<Vec<Statistics>, E> {
        let mut all = Vec::new();
        for some in self.numeric().chunks((held / runs.max(1)).max(1)) {
            let names: Vec<&str> = some.iter().map(|(name, _)| *name).collect();
            for (&(_, meaning), column) in some.iter().zip(columns(&names)?) {
                all.push(Statistics::of(meaning, column.map_or_else(Vec::new, |column| column.numbers())));
            }
        }
        Ok(all)
    }
}
