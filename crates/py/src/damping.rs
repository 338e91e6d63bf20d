//! Active damping by relays, and the observer that it needs.

use flexsc_core::analysis::damping::{Convergence, PulsedDamping, persistence as least_eigenvalue};
use flexsc_core::analysis::identification::IdentificationTrial;
use flexsc_core::control::actuator::PulseTiming;
use flexsc_core::numerics::quantity::NonNegative;
use numpy::PyReadonlyArray2;
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use rayon::prelude::*;
use serde_json::json;

use crate::aside::aside;
use crate::error::allowed;
use crate::sampled::all_positive;

/// Weights W1 to W3, natural frequency (rad/s), period (s), damping ratio.
type Recurrence = ([f64; 3], f64, f64, f64);

fn refused(wrong: Option<(&'static str, String)>) -> PyResult<()> {
    wrong.map_or(Ok(()), |(name, why)| Err(PyValueError::new_err(format!("{name} {why}"))))
}

fn convergence((weights, frequency, period, damping): Recurrence) -> PyResult<Convergence> {
    let convergence = Convergence { frequency, damping, period, weights };
    refused(convergence.inconsistency())?;
    Ok(convergence)
}

#[pyfunction]
pub fn relay_damping_json(
    py: Python<'_>,
    frequencies: Vec<f64>,
    relay: (f64, f64, f64),
    mode: (f64, f64),
    amplitudes: (f64, f64),
) -> PyResult<String> {
    let (period, delay, on_time) = relay;
    let ((damping, acceleration), (amplitude, threshold)) = (mode, amplitudes);
    let timing = PulseTiming { period, delay, on_time };
    let pulsed = PulsedDamping { timing, damping, acceleration, amplitude, threshold };
    refused(pulsed.inconsistency())?;
    all_positive("frequencies", &frequencies)?;
    if let Some(why) = pulsed.beyond(&frequencies) {
        return Err(PyValueError::new_err(format!("a push {why}; see frequencies, period and delay")));
    }
    let rows = aside(py, move |stop| {
        frequencies
            .iter()
            .map_while(|frequency| (!stop.is_requested()).then(|| pulsed.mode(*frequency)))
            .collect::<Vec<_>>()
    })?;
    Ok(json!(rows).to_string())
}

#[pyfunction]
pub fn observer_region_json(observer: Recurrence, kappa: f64, elastic: Vec<f64>) -> PyResult<String> {
    let convergence = convergence(observer)?;
    Ok(json!({"edges": convergence.region(kappa, &elastic), "area": convergence.area(kappa)}).to_string())
}

#[pyfunction]
pub fn observer_margin_json(observer: Recurrence, kappas: Vec<f64>) -> PyResult<String> {
    let convergence = convergence(observer)?;
    let radii: Vec<f64> = kappas.iter().map(|kappa| convergence.spectral_radius(*kappa)).collect();
    Ok(json!({"margin": convergence.margin(), "spectral_radius": radii}).to_string())
}

#[pyfunction]
pub fn identify_json(
    py: Python<'_>,
    modes: Vec<(f64, f64)>,
    off: (f64, f64),
    rate: f64,
    extent: (u64, u32, u64),
    yes: bool,
) -> PyResult<String> {
    let (runs, cycles, seed) = extent;
    let squared = (modes.len() * modes.len()) as f64;
    let mut trial = IdentificationTrial::published(modes, off.0);
    (trial.off[1], trial.cycles, trial.seed) = (off.1, cycles, seed);
    let Some(rate) = NonNegative::new(rate) else {
        return Err(PyValueError::new_err(format!("rate must be 0 or more, got {rate}")));
    };
    trial.observer.rate = rate;
    refused(trial.inconsistency())?;
    if !((1..=1_000_000).contains(&runs) && (1..=1_000_000).contains(&cycles)) {
        return Err(PyValueError::new_err(format!(
            "runs and cycles must be from 1 to 1000000, got {runs} and {cycles}"
        )));
    }
    allowed(&IdentificationTrial::cost(runs as f64, cycles, squared), yes)?;
    let row = aside(py, move |stop| {
        let runs = (0..runs).into_par_iter();
        let found = runs.map(|number| (!stop.is_requested()).then(|| trial.run(number))).while_some();
        trial.row(&found.collect::<Vec<_>>())
    })?;
    Ok(json!(row).to_string())
}

#[pyfunction]
pub fn persistence(sensitivities: PyReadonlyArray2<'_, f64>) -> f64 {
    let rows: Vec<Vec<f64>> = sensitivities.as_array().rows().into_iter().map(|row| row.to_vec()).collect();
    least_eigenvalue(&rows).unwrap_or(f64::NAN)
}
