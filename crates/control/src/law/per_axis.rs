//! Separate laws about three axes.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::{Authority, Control, Law, Promise, Reads, Rule, Tunable};
use crate::time::Span;

/// A law of one angle for each of three axes.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct PerAxis {
    /// About x.
    pub roll: Law,
    /// About y.
    pub pitch: Law,
    /// About z.
    pub yaw: Law,
}

impl PerAxis {
    /// Returns the law about an axis.
    pub fn about(&self, axis: usize) -> &Law {
        [&self.roll, &self.pitch, &self.yaw][axis.min(2)]
    }

    /// Returns the key prefix of the law about an axis: `roll.pd.` and the like.
    pub fn place(&self, axis: usize) -> String {
        format!("{}.{}.", ["roll", "pitch", "yaw"][axis.min(2)], self.about(axis).kind())
    }

    fn all(&self) -> [&Law; 3] {
        [&self.roll, &self.pitch, &self.yaw]
    }
}

impl Rule for PerAxis {
    fn start(&self, authority: &Authority) -> Box<dyn Control> {
        self.roll.start(authority)
    }

    /// Returns the shortest period of the laws, at which sensors without their own period are read.
    fn period(&self) -> Option<Span> {
        self.all().into_iter().filter_map(|law| law.period()).min()
    }

    fn switches(&self) -> bool {
        self.all().into_iter().all(|law| law.switches())
    }

    fn promise(&self) -> Promise {
        Promise::Nothing
    }

    fn reads(&self) -> Reads {
        let of = |wanted: Reads| self.all().into_iter().any(|law| law.reads() == wanted);
        let order = [Reads::ElasticRates, Reads::DominantMode, Reads::Motion, Reads::Field];
        order.into_iter().find(|wanted| of(*wanted)).unwrap_or(Reads::Nothing)
    }

    fn tunable(&self) -> Vec<Tunable> {
        let of = |axis: usize| {
            let place = self.place(axis);
            self.about(axis).tunable().into_iter().map(move |number| number.within(&place))
        };
        (0..3).flat_map(of).collect()
    }
}
