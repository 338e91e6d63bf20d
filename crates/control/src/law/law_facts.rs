//! Facts about a law of another crate that a log keeps: in figures of the log they are in place of the law, which is not
//! started.

use std::collections::BTreeMap;

use flexsc_numerics::time::Span;
use serde::{Deserialize, Serialize};

use super::{Authority, ErrorBand, EstimateNeeds, Law, LawSpec, Open, Tunable};
use crate::offers::LawOffers;

/// Facts about a custom law.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct LawFacts {
    /// Period (s), if it has one.
    #[serde(skip_serializing_if = "Option::is_none")]
    period_s: Option<f64>,
    /// True if its torque changes only with its state.
    switches: bool,
    /// Half width of the error band that it promises (rad), if it promises one.
    #[serde(skip_serializing_if = "Option::is_none")]
    band_rad: Option<f64>,
    /// Initial values of its tunable parameters, by key.
    #[serde(skip_serializing_if = "BTreeMap::is_empty")]
    tunable: BTreeMap<String, f64>,
}

impl LawFacts {
    /// Collects the facts about a law.
    pub fn from_law(law: &dyn LawSpec) -> Self {
        let offers = law.offers();
        let band = law.expected_band();
        Self {
            period_s: offers.period.map(Span::seconds),
            switches: offers.is_switching,
            band_rad: if let ErrorBand::Absolute(band) = band { Some(band) } else { None },
            tunable: law
                .tunable()
                .into_iter()
                .map(|number| (number.key.into_owned(), number.value))
                .collect(),
        }
    }
}

impl LawSpec for LawFacts {
    fn start(&self, authority: &Authority) -> Box<dyn Law> {
        Open::default().start(authority)
    }

    fn offers(&self) -> LawOffers {
        let period =
            self.period_s.filter(|period| period.is_finite() && *period > 0.0).map(Span::from_seconds);
        LawOffers { is_switching: self.switches, ..LawOffers::new(period, EstimateNeeds::Motion) }
    }

    fn expected_band(&self) -> ErrorBand {
        self.band_rad.map_or(ErrorBand::None, ErrorBand::Absolute)
    }

    fn tunable(&self) -> Vec<Tunable> {
        self.tunable.iter().map(|(key, value)| Tunable::unbounded(key.clone(), *value)).collect()
    }
}
