//! Separate laws about three axes.

use flexsc_numerics::time::Span;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::{Authority, ErrorBand, EstimateNeeds, Law, LawKind, LawSpec, Tunable};
use crate::offers::{LawPlace, Offers};
use crate::requirement::{Requirements, Rule};

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

    /// Returns the shortest period of the laws, at which sensors without their own period are read.
    fn period(&self) -> Option<Span> {
        self.all().into_iter().filter_map(|law| law.period()).min()
    }

    fn is_switching(&self) -> bool {
        self.all().into_iter().all(|law| law.is_switching())
    }

    fn requires(&self, _: &LawPlace, _: &Offers, needs: &mut Requirements) {
        needs.require(Rule::Law, false, "", "must be a law of one axis");
    }

    fn expected_band(&self) -> ErrorBand {
        ErrorBand::None
    }

    fn needs(&self) -> EstimateNeeds {
        let any_law_needs = |needs: EstimateNeeds| self.all().into_iter().any(|law| law.needs() == needs);
        let order = [
            EstimateNeeds::ElasticRates,
            EstimateNeeds::DominantMode,
            EstimateNeeds::Motion,
            EstimateNeeds::Field,
        ];
        order.into_iter().find(|needs| any_law_needs(*needs)).unwrap_or(EstimateNeeds::Nothing)
    }

    fn tunable(&self) -> Vec<Tunable> {
        let law_about = |axis: usize| {
            let place = self.key_prefix(axis);
            self.about(axis).tunable().into_iter().map(move |number| number.nested(&place))
        };
        (0..3).flat_map(law_about).collect()
    }
}
