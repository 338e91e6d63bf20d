//! Speeds of unbalanced wheels at which a sampled loop resonates.
//!
//! The line of a harmonic at the frequency w excites a resonance of the closed loop, whose angle in a period T is theta, where w T =
//! +-theta + 2 pi k. For k = 0 or the turns of a mode that is what moves, else it is an alias, far above the resonance. All are at
//! known speeds, and narrow: steps over the speed pass most of them by.
//!
//! A wheel that a point of the structure carries changes the modes with its speed W: A = A0 + W A1. Its harmonic h meets one where j h W
//! is an eigenvalue of A: W is one of (j h - A1)^-1 A0, whose imaginary part is the half width of the peak.

use std::f64::consts::TAU;

use flexsc_formats::document::ConfigError;
use flexsc_scenario::Scenario;
use nalgebra::{Complex, DMatrix};
use rayon::prelude::*;

use crate::eigenvalues::eigenvalues;
use crate::linear_model::LinearModel;
use crate::margins::{resonances, steady_change};
use crate::open_loop::{LoopParts, OpenLoop};
use crate::state_space::StateSpaceModel;

/// Largest number of speeds that are examined beside the steps: those of the modes, then aliases of the lowest frequencies.
const MOST_EXAMINED: usize = 400;
/// Distance of two resonances, relative to the half width of the narrower one, below which one speed shows both.
const APART: f64 = 0.5;
/// Angle (rad) within which the resonance of a mode has the angle of its natural frequency, relative to that frequency.
const OWN: f64 = 0.1;

/// Speed at which a harmonic meets a resonance.
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct ResonantSpeed {
    /// Speed of the wheel (rad/s).
    pub speed: f64,
    /// Half width of the peak (rad/s).
    pub width: f64,
}

/// Returns the speeds between two (rad/s) at which harmonics of these orders meet resonances of a loop that are narrower than
/// `step`, in increasing order: at most [`MOST_EXAMINED`].
///
/// # Errors
/// See [`OpenLoop::from_scenario`].
pub fn resonant_speeds(
    parts: &LoopParts<'_>,
    orders: &[f64],
    [least, largest]: [f64; 2],
    step: f64,
) -> Result<Vec<ResonantSpeed>, ConfigError> {
    let opened = OpenLoop::from_parts(parts)?;
    let closed = opened.transfer.sensitivity().and_then(|closed| eigenvalues(&closed.a)).unwrap_or_default();
    let own: Vec<f64> =
        eigenvalues(&parts.body.a).unwrap_or_default().iter().map(|pole| pole.im.abs()).collect();
    let mut found: Vec<(f64, ResonantSpeed)> = Vec::new();
    // A motion without damping has no peak of a finite height.
    let damped = |resonance: &(f64, f64)| resonance.1 > steady_change(opened.period);
    for (angle, width) in resonances(&closed, APART).into_iter().filter(damped) {
        for order in orders {
            let turns = libm::ceil(order * largest * opened.period / TAU) as i64;
            for turned in (0..=turns).flat_map(|turn| [angle, -angle].map(|own| own + TAU * turn as f64)) {
                let frequency = turned / opened.period;
                let peak = ResonantSpeed { speed: frequency / order, width: width / (opened.period * order) };
                if peak.width > 0.5 * step || !(least..=largest).contains(&peak.speed) {
                    continue;
                }
                let is_own = own.iter().any(|own| *own > 0.0 && (frequency / own - 1.0).abs() < OWN);
                found.push((if is_own { 0.0 } else { angle }, peak));
            }
        }
    }
    found.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.speed.total_cmp(&b.1.speed)));
    found.truncate(MOST_EXAMINED);
    let mut peaks: Vec<ResonantSpeed> = found.into_iter().map(|(_, peak)| peak).collect();
    peaks.sort_by(|a, b| a.speed.total_cmp(&b.speed));
    peaks.dedup_by(|later, kept| later.speed - kept.speed <= APART * later.width.min(kept.width));
    Ok(peaks)
}

/// Returns the speeds between two (rad/s) at which harmonics of these orders meet modes of a scenario's body, with the whirl of its wheels,
/// that are narrower than `step`.
///
/// # Errors
/// See [`OpenLoop::from_scenario`].
pub fn whirl_speeds(
    scenario: &Scenario,
    orders: &[f64],
    [least, largest]: [f64; 2],
    step: f64,
) -> Result<Vec<ResonantSpeed>, ConfigError> {
    let rates = |speed: f64| -> Result<DMatrix<f64>, ConfigError> {
        let a = StateSpaceModel::from(LinearModel::at_wheel_speed(scenario, speed)?).matrices.a;
        // Without the rigid angles, on which nothing depends.
        Ok(a.view_range(3.., 3..).into_owned())
    };
    let constant = rates(0.0)?;
    let growing = rates(1.0)? - &constant;
    let order = constant.nrows();
    let meets = |harmonic: &f64| {
        let mut factor = growing.map(|entry| Complex::new(-entry, 0.0));
        for place in 0..order {
            factor[(place, place)].im += harmonic;
        }
        let product = factor.lu().solve(&constant.map(Complex::from));
        // A complex matrix as a real one of twice the order, which has the conjugate eigenvalues too.
        let real = product.map(|product| {
            DMatrix::from_fn(2 * order, 2 * order, |row, column| {
                let entry = product[(row % order, column % order)];
                match (row < order, column < order) {
                    (true, false) => -entry.im,
                    (false, true) => entry.im,
                    _ => entry.re,
                }
            })
        });
        let speeds = real.as_ref().and_then(eigenvalues).unwrap_or_default();
        let peak = |speed: Complex<f64>| ResonantSpeed { speed: speed.re, width: speed.im };
        let is_met = |peak: &ResonantSpeed| {
            (least..=largest).contains(&peak.speed) && peak.width > 0.0 && peak.width <= 0.5 * step
        };
        speeds.into_iter().map(peak).filter(is_met).collect::<Vec<_>>()
    };
    let mut found: Vec<ResonantSpeed> = orders.par_iter().map(meets).collect::<Vec<_>>().concat();
    found.sort_by(|a, b| a.speed.total_cmp(&b.speed));
    Ok(found)
}
