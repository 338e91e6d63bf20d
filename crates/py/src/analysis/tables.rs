//! Tables: estimated work, limit cycles in closed form, and descriptions of keys, metrics and topics.

#![expect(clippy::unnecessary_wraps, reason = "an analysis may fail")]

use flexsc_core::analysis::rigid_cycle::{cycles, resonances};
use flexsc_core::campaign::Campaign;
use flexsc_core::metrics;
use flexsc_core::record::description;
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use serde_json::{Value as Json, json};

use super::{Answer, Subject};
use crate::detail;
use crate::error::scenario_error;

/// Estimated work of runs as a campaign has them, or of one run whose log of this detail stays in memory.
#[derive(FromPyObject)]
#[pyo3(from_item_all)]
pub struct Estimate {
    runs: u64,
    log: String,
}

impl Estimate {
    pub fn run(self, on: &Subject<'_, '_>) -> PyResult<Answer> {
        let scenario = on.scenario()?;
        let detail = detail(&self.log)?;
        let cost = if self.runs > 1 {
            let campaign = Campaign::new(scenario.inner.clone(), &scenario.origin, []);
            let cost = campaign.map_err(scenario_error)?.cost(self.runs, detail);
            cost.map_err(|why| PyValueError::new_err(format!("runs {why}")))?
        } else {
            scenario.inner.cost(detail, true)
        };
        let (key, steps) = &cost.most;
        let object = json!({
            "seconds": cost.seconds, "steps": steps, "key": key.trim_matches('`'), "memory_bytes": cost.memory,
            "needs_yes": cost.limit_exceeded().is_some(),
        });
        Ok(object.into())
    }
}

/// Limit cycles of the relay law on the body without modes.
pub fn rigid_cycles(on: &Subject<'_, '_>) -> PyResult<Answer> {
    let scenario = on.scenario()?;
    let body = scenario.inner.one_angle().map_err(scenario_error)?;
    let Some(law) = scenario.inner.law.relay() else {
        return Err(scenario.error(&"limit cycles are computed for a law `relay`"));
    };
    if scenario.inner.actuator.flywheel().is_some() {
        return Err(scenario.error(&"limit cycles are computed for an ideal torque, not for a wheel"));
    }
    let (cycles, resonances) = (cycles(law, body, law.k_t.get()), resonances(law, body));
    Ok(json!({"cycles": cycles, "resonances": resonances}).into())
}

/// JSON Schema of scenarios.
pub fn schema(_: &Subject<'_, '_>) -> PyResult<Answer> {
    Ok(json!(flexsc_core::Scenario::schema()).into())
}

/// Meanings of the metrics: of all, or as a scenario has them, whose body without inertia gives some other units.
pub fn metric_descriptions(on: &Subject<'_, '_>) -> PyResult<Answer> {
    let inner = on.scenario.map(|scenario| &scenario.inner);
    let meanings =
        metrics::ALL.iter().filter_map(|m| Some((m.name.to_owned(), metrics::meaning(m.name, inner)?)));
    let object = meanings.map(|(name, m)| (name, json!({"unit": m.unit, "doc": m.doc})));
    Ok(Json::Object(object.collect()).into())
}

/// Topics of logs, with their fields.
pub fn topics(_: &Subject<'_, '_>) -> PyResult<Answer> {
    Ok(description::topics().into())
}
