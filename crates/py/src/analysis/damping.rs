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

use super::sampled::all_positive;
use super::{Answer, Subject};
use crate::aside::aside;
use crate::error::allowed;

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

/// Damping of modes by a relay that acts against their elastic rate.
#[derive(FromPyObject)]
#[pyo3(from_item_all)]
pub struct RelayDamping {
    frequencies: Vec<f64>,
    acceleration: f64,
    period: f64,
    delay: f64,
    on_time: f64,
    damping: f64,
    amplitude: f64,
    threshold: f64,
}

impl RelayDamping {
    pub fn run(self, on: &Subject<'_, '_>) -> PyResult<Answer> {
        let Self { frequencies, acceleration, period, delay, on_time, damping, amplitude, threshold } = self;
        let timing = PulseTiming { period, delay, on_time };
        let pulsed = PulsedDamping { timing, damping, acceleration, amplitude, threshold };
        refused(pulsed.inconsistency())?;
        all_positive("frequencies", &frequencies)?;
        if let Some(why) = pulsed.beyond(&frequencies) {
            return Err(PyValueError::new_err(format!("a push {why}; see frequencies, period and delay")));
        }
        let rows = aside(on.py, move |stop| {
            frequencies
                .iter()
                .map_while(|frequency| (!stop.is_requested()).then(|| pulsed.mode(*frequency)))
                .collect::<Vec<_>>()
        })?;
        Ok(json!(rows).into())
    }
}

/// Region of convergence of the recurrence observer.
#[derive(FromPyObject)]
#[pyo3(from_item_all)]
pub struct ObserverRegion {
    observer: Recurrence,
    kappa: f64,
    elastic: Vec<f64>,
}

impl ObserverRegion {
    pub fn run(self, _: &Subject<'_, '_>) -> PyResult<Answer> {
        let convergence = convergence(self.observer)?;
        let edges = convergence.region(self.kappa, &self.elastic);
        Ok(json!({"edges": edges, "area": convergence.area(self.kappa)}).into())
    }
}

/// Identification rate that the recurrence observer allows.
#[derive(FromPyObject)]
#[pyo3(from_item_all)]
pub struct ObserverMargin {
    observer: Recurrence,
    kappas: Vec<f64>,
}

impl ObserverMargin {
    pub fn run(self, _: &Subject<'_, '_>) -> PyResult<Answer> {
        let convergence = convergence(self.observer)?;
        let radii: Vec<f64> = self.kappas.iter().map(|kappa| convergence.spectral_radius(*kappa)).collect();
        Ok(json!({"margin": convergence.margin(), "spectral_radius": radii}).into())
    }
}

/// Success rate and convergence time of the gradient observer, from initial errors.
#[derive(FromPyObject)]
#[pyo3(from_item_all)]
pub struct Identify {
    modes: Vec<(f64, f64)>,
    off: f64,
    influence_off: f64,
    rate: f64,
    runs: u64,
    cycles: u32,
    seed: u64,
    yes: bool,
}

impl Identify {
    pub fn run(self, on: &Subject<'_, '_>) -> PyResult<Answer> {
        let Self { modes, off, influence_off, rate, runs, cycles, seed, yes } = self;
        let squared = (modes.len() * modes.len()) as f64;
        let mut trial = IdentificationTrial::published(modes, off);
        (trial.off[1], trial.cycles, trial.seed) = (influence_off, cycles, seed);
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
        let row = aside(on.py, move |stop| {
            let runs = (0..runs).into_par_iter();
            let found = runs.map(|number| (!stop.is_requested()).then(|| trial.run(number))).while_some();
            trial.row(&found.collect::<Vec<_>>())
        })?;
        Ok(json!(row).into())
    }
}

#[pyfunction]
pub fn persistence(sensitivities: PyReadonlyArray2<'_, f64>) -> f64 {
    let rows: Vec<Vec<f64>> = sensitivities.as_array().rows().into_iter().map(|row| row.to_vec()).collect();
    least_eigenvalue(&rows).unwrap_or(f64::NAN)
}
