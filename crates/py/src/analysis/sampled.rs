//! Analyses of a scenario's sampled loop.

use flexsc_core::analysis::sampled_loop::{
    Gains, ModelUncertainty, RobustGoal, RobustSearch, SampledLoop, Scaling, SettlingWindow, map, optimize,
    regions,
};
use flexsc_core::control::law::Pd;
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use serde_json::json;

use super::{Answer, Scenario, Subject};
use crate::aside::aside;
use crate::error::allowed;

/// Band (rad; 5 % of the angle at the start if there is none), horizon (s), whether the dominant mode alone changes, and
/// whether long work is wanted.
type Settled = (Option<f64>, f64, bool, bool);

/// Refuses to close a loop so often, with this shortest period (s) and up to this delay more (s), if that is more than can be
/// done, or more than is wanted.
fn allow(
    of: &SampledLoop,
    times: usize,
    shortest: f64,
    delay: f64,
    (_, horizon, _, yes): Settled,
) -> PyResult<()> {
    let cost = of.simulation_cost(times as f64, horizon, shortest, delay);
    allowed(&cost.map_err(PyValueError::new_err)?, yes)
}

fn sampled(scenario: &Scenario, settled: Settled) -> PyResult<(SampledLoop, &Pd, SettlingWindow, Scaling)> {
    let refused = |fault| scenario.key_error(fault);
    let (band, horizon, single, _) = settled;
    let (sampled_loop, law) = SampledLoop::from_scenario(&scenario.inner).map_err(refused)?;
    if !(horizon.is_finite() && horizon > 0.0) {
        return Err(PyValueError::new_err(format!("horizon must be a positive number, got {horizon}")));
    }
    let window = sampled_loop.settling_window(band, horizon).map_err(refused)?;
    Ok((sampled_loop, law, window, if single { Scaling::First } else { Scaling::All }))
}

pub fn all_positive(name: &str, values: &[f64]) -> PyResult<()> {
    match values.iter().find(|value| !(value.is_finite() && **value > 0.0)) {
        Some(value) => Err(PyValueError::new_err(format!("{name} must be positive numbers, got {value}"))),
        None => Ok(()),
    }
}

fn stepped((low, high, step): (f64, f64, f64)) -> PyResult<Gains> {
    if low.is_finite() && low <= high && step > 0.0 && (high - low) / step < 1e5 {
        return Ok(Gains { low, high, step });
    }
    let why = format!("gains must be (low, high, step) with at most 1e5 steps, got ({low}, {high}, {step})");
    Err(PyValueError::new_err(why))
}

/// Gains of the extra loop that are stable and settle in time, at each frequency of the dominant mode.
#[derive(FromPyObject)]
#[pyo3(from_item_all)]
pub struct GainRegion {
    frequencies: Vec<f64>,
    gains: (f64, f64, f64),
    limit: f64,
    settled: Settled,
}

impl GainRegion {
    pub fn run(self, on: &Subject<'_, '_>) -> PyResult<Answer> {
        let Self { frequencies, gains, limit, settled } = self;
        let (sampled_loop, _, window, scaling) = sampled(on.scenario()?, settled)?;
        all_positive("frequencies", &frequencies)?;
        let gains = stepped(gains)?;
        allow(&sampled_loop, frequencies.len() * gains.values().len(), sampled_loop.period, 0.0, settled)?;
        let rows =
            aside(on.py, move |_| regions(&sampled_loop, &frequencies, scaling, gains, window, limit))?;
        Ok(json!(rows).into())
    }
}

/// Gains that settle fastest with an uncertain model, at each frequency of the dominant mode.
#[derive(FromPyObject)]
#[pyo3(from_item_all)]
pub struct RobustGains {
    frequencies: Vec<f64>,
    gains: (f64, f64, f64),
    off: f64,
    delay: f64,
    itae: bool,
    quantile: f64,
    margin: f64,
    settled: Settled,
}

impl RobustGains {
    pub fn run(self, on: &Subject<'_, '_>) -> PyResult<Answer> {
        let Self { frequencies, gains, off, delay, itae, quantile, margin, settled } = self;
        let (sampled_loop, _, window, scaling) = sampled(on.scenario()?, settled)?;
        all_positive("frequencies", &frequencies)?;
        for (name, value, fits) in [
            ("off", off, (0.0..1.0).contains(&off)),
            ("delay", delay, delay.is_finite() && delay >= 0.0),
            ("quantile", quantile, quantile > 0.0 && quantile <= 1.0),
            ("margin", margin, (0.0..1.0).contains(&margin)),
        ] {
            if !fits {
                return Err(PyValueError::new_err(format!("{name} is out of its range, got {value}")));
            }
        }
        let search = RobustSearch {
            gains: stepped(gains)?,
            scaling,
            window,
            uncertainty: ModelUncertainty { frequency: off, modal_gain: off, authority: off, delay },
            goal: if itae { RobustGoal::Itae } else { RobustGoal::Settling },
            quantile,
            margin,
        };
        let closed = frequencies.len() * search.gains.values().len() * search.uncertainty.max_loops();
        allow(&sampled_loop, closed, sampled_loop.period, delay, settled)?;
        Ok(json!(aside(on.py, move |_| optimize(&sampled_loop, &frequencies, search))?).into())
    }
}

/// Stability and settling over frequencies of the dominant mode and sampling periods.
#[derive(FromPyObject)]
#[pyo3(from_item_all)]
pub struct StabilityMap {
    frequencies: Vec<f64>,
    periods: Vec<f64>,
    gain: Option<f64>,
    settled: Settled,
}

impl StabilityMap {
    pub fn run(self, on: &Subject<'_, '_>) -> PyResult<Answer> {
        let Self { frequencies, periods, gain, settled } = self;
        let (sampled_loop, law, window, scaling) = sampled(on.scenario()?, settled)?;
        all_positive("frequencies", &frequencies)?;
        all_positive("periods", &periods)?;
        let shortest = periods.iter().copied().fold(f64::INFINITY, f64::min);
        allow(&sampled_loop, frequencies.len() * periods.len(), shortest, 0.0, settled)?;
        let law = law.clone();
        let cells = aside(on.py, move |_| {
            let gain = |frequency: f64| gain.unwrap_or_else(|| law.extra_gain(frequency));
            map(&sampled_loop, &frequencies, &periods, scaling, gain, window)
        })?;
        Ok(json!(cells).into())
    }
}
