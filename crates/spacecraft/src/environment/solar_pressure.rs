//! Pressure of sunlight: a force that is constant in inertial axes at a point of the body, but for the planet's shadow.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::document::Fault;
use crate::quantity::{Finite, Time};
use crate::time::{Instant, Span};

/// Pressure of sunlight.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct SolarPressure {
    /// The force (N), in inertial axes.
    pub force: [Finite; 3],
    /// Centre of pressure (m): from the point O of a spacecraft, or from the centre of mass of a spatial body.
    pub at: [Finite; 3],
    /// Intervals \[from, to\] without sunlight (s), in addition to the shadow of the orbit's planet.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub shadow: Vec<[Time; 2]>,
}

impl SolarPressure {
    /// The instants at which the shadow begins and ends.
    pub(super) fn edges(&self) -> impl Iterator<Item = Instant> {
        self.shadow.iter().flatten().map(|time| at(*time))
    }

    /// Whether the body is in the light at a time since the start (s).
    pub(super) fn is_lit(&self, t: f64) -> bool {
        !self.shadow.iter().any(|[from, to]| at(*from).seconds() <= t && t < at(*to).seconds())
    }

    /// A shadow that ends before it begins.
    pub(super) fn fault(&self) -> Option<Fault> {
        let index = self.shadow.iter().position(|[from, to]| from >= to)?;
        let [from, to] = self.shadow[index].map(Time::get);
        let why = format!("must be [from, to] (s) with `to` later than `from`, got [{from}, {to}]");
        Some(Fault::new(format!("shadow[{index}]"), why))
    }
}

fn at(time: Time) -> Instant {
    Instant::START + Span::from_seconds(time.get())
}
