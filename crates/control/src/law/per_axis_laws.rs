//! Separate laws about three axes.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::{Authority, EstimateNeeds, Law, LawKind, LawSpec, Tunable};
use crate::offers::{LawOffers, LawPlace, Offers};
use crate::requirement::Requirements;

/// A law of one angle for each of three axes.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
#[schemars(rename = "PerAxis")]
pub struct PerAxisLaws {
    /// About x.
    pub roll: LawKind,
    /// About y.
    pub pitch: LawKind,
    /// About z.
    pub yaw: LawKind,
}

impl PerAxisLaws {
    /// Returns the law about an axis.
    pub fn about(&self, axis: usize) -> &LawKind {
        [&self.roll, &self.pitch, &self.yaw][axis.min(2)]
    }

    /// Returns the key prefix of the law about an axis: `roll.pd.` and the like.
    pub fn key_prefix(&self, axis: usize) -> String {
        format!("{}.{}.", ["roll", "pitch", "yaw"][axis.min(2)], self.about(axis).kind())
    }

    fn all(&self) -> [&LawKind; 3] {
        [&self.roll, &self.pitch, &self.yaw]
    }
}

impl LawSpec for PerAxisLaws {
    fn start(&self, authority: &Authority) -> Box<dyn Law> {
        self.roll.start(authority)
    }

    /// Returns the shortest period of the laws, at which sensors without their own period are read, and the most that
    /// one of them reads.
    fn offers(&self) -> LawOffers {
        let laws = self.all();
        let period = laws.iter().filter_map(|law| law.period()).min();
        let needs = EstimateNeeds::most(laws.iter().map(|law| law.needs()));
        let is_switching = laws.iter().all(|law| law.is_switching());
        LawOffers { is_switching, ..LawOffers::new(period, needs) }
    }

    fn requires(&self, _: &LawPlace, _: &Offers, needs: &mut Requirements) {
        needs.require(false, "", "must be a law of one axis");
    }

    fn tunable(&self) -> Vec<Tunable> {
        let law_about = |axis: usize| {
            let place = self.key_prefix(axis);
            self.about(axis).tunable().into_iter().map(move |number| number.nested(&place))
        };
        (0..3).flat_map(law_about).collect()
    }
}
