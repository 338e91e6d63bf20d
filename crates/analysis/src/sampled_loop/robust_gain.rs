//! Schedule of the gains with the least settling time over a set of perturbed loops.
//!
//! The midpoint of the papers' region centres the gain between its limits; this schedule minimises the settling time
//! itself, over the corners of a box of frequencies, modal gains, the wheel's gain and its delay, and at the centre of
//! the box.

use flexsc_numerics::quantity::{Finite, Frequency};
use rayon::prelude::*;
use serde::Serialize;

use super::{DiscretePlant, Gains, SampledLoop, Scaling, SettlingWindow};

/// Uncertainty of the loop's model.
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct ModelUncertainty {
    /// Relative uncertainty of all natural frequencies.
    pub frequency: f64,
    /// Relative uncertainty of all modal gains.
    pub modal_gain: f64,
    /// Relative uncertainty of the wheel's gain.
    pub authority: f64,
    /// Largest additional delay (s).
    pub delay: f64,
}

/// Quantity that is minimised.
#[derive(Copy, Clone, Debug, Default, PartialEq, Eq)]
pub enum RobustGoal {
    /// Settling time, and among equal ones the integral of time times |angle|.
    #[default]
    Settling,
    /// Integral of time times |angle|: smooth in all parameters.
    Itae,
}

/// Best gain at one frequency of the dominant mode.
#[derive(Copy, Clone, Debug, PartialEq, Serialize)]
pub struct RobustGain {
    /// Frequency of the dominant mode (rad/s).
    pub frequency_rad_s: f64,
    /// Best gain; none if every gain leaves a perturbed loop with too little margin.
    pub gain: Option<f64>,
    /// Settling time of the unperturbed loop (s).
    pub settling_s: Option<f64>,
    /// Requested quantile of the settling times (s); none if too many loops do not settle.
    pub settling_quantile_s: Option<f64>,
    /// Largest spectral radius of all perturbed loops.
    pub spectral_radius: Option<f64>,
    /// Requested quantile of the settling times without the extra loop (s).
    pub settling_without_s: Option<f64>,
}

/// Performance of a gain over the perturbed loops.
#[derive(Copy, Clone)]
struct GainScore {
    settling: f64,
    itae: f64,
    radius: f64,
}

impl ModelUncertainty {
    /// Returns the largest number of perturbed loops.
    pub fn max_loops(&self) -> usize {
        if self.delay > 0.0 { 17 } else { 9 }
    }

    /// Returns the perturbed loops, the unperturbed one first.
    fn loops(&self, sampled_loop: &SampledLoop) -> Vec<SampledLoop> {
        let signs = |part: f64| if part > 0.0 { vec![-1.0, 1.0] } else { vec![0.0] };
        let delays = if self.delay > 0.0 { vec![0.0, self.delay] } else { vec![0.0] };
        let mut loops = vec![sampled_loop.clone()];
        for delay in delays {
            for w in signs(self.frequency) {
                for k in signs(self.modal_gain) {
                    for b in signs(self.authority) {
                        loops.push(self.off(sampled_loop, w, k, b, delay));
                    }
                }
            }
        }
        loops.dedup();
        loops
    }

    fn off(&self, sampled_loop: &SampledLoop, w: f64, k: f64, b: f64, delay: f64) -> SampledLoop {
        let mut off = sampled_loop.clone();
        for mode in &mut off.body.modes {
            let changed = mode.frequency.get() * (1.0 + w * self.frequency);
            mode.frequency = Frequency::new(changed).unwrap_or(mode.frequency);
            mode.gain = Finite::new(mode.gain.get() * (1.0 + k * self.modal_gain)).unwrap_or(mode.gain);
        }
        off.authority *= 1.0 + b * self.authority;
        off.delay += delay;
        off
    }
}

/// Returns the quantile of values: the smallest value that a fraction `part` of them does not exceed.
fn quantile(mut values: Vec<f64>, part: f64) -> f64 {
    values.sort_by(f64::total_cmp);
    let index = libm::ceil(part * values.len() as f64) as usize;
    values[index.clamp(1, values.len()) - 1]
}

/// Returns the performance of a gain; `None` if a loop has too little margin, or if the worst one settles later than
/// `beat` (s).
fn score(held: &[DiscretePlant], gain: f64, search: &RobustSearch, beat: f64) -> Option<GainScore> {
    let (mut radius, mut settled) = (0.0_f64, Vec::with_capacity(held.len()));
    for held in held {
        let closed = held.closed(gain);
        let settling = closed.settle(search.window);
        let time = settling.crossing_s.unwrap_or(f64::INFINITY);
        if search.quantile >= 1.0 && time > beat {
            return None;
        }
        settled.push((time, settling.itae_rad_s2));
        radius = radius.max(closed.spectral_radius());
        if radius.is_nan() || radius >= 1.0 - search.margin {
            return None;
        }
    }
    let settling = quantile(settled.iter().map(|(time, _)| *time).collect(), search.quantile);
    let itae = quantile(settled.iter().map(|(_, itae)| *itae).collect(), search.quantile);
    Some(GainScore { settling, itae, radius })
}

/// Settings of the search for a schedule.
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct RobustSearch {
    /// Gains that are tried.
    pub gains: Gains,
    /// Modes whose frequencies scale with that of the dominant one.
    pub scaling: Scaling,
    /// Settling band and horizon.
    pub window: SettlingWindow,
    /// Uncertainty of the model.
    pub uncertainty: ModelUncertainty,
    /// Quantity that is minimised.
    pub goal: RobustGoal,
    /// Quantile of the goal over the perturbed loops; 1 is the worst loop.
    pub quantile: f64,
    /// Distance by which every spectral radius stays below 1.
    pub margin: f64,
}

/// Returns the best gain at each of these frequencies (rad/s) in order, computed on the threads of the current rayon
/// pool.
pub fn optimize(sampled_loop: &SampledLoop, frequencies: &[f64], search: RobustSearch) -> Vec<RobustGain> {
    let loops = search.uncertainty.loops(sampled_loop);
    let gains = search.gains.values();
    let best = |frequency: &f64| {
        let ratios = sampled_loop.ratios(*frequency, search.scaling);
        let held: Vec<DiscretePlant> =
            loops.iter().map(|sampled_loop| DiscretePlant::new(sampled_loop, &ratios)).collect();
        let key = |score: &GainScore| match search.goal {
            RobustGoal::Settling => (score.settling, score.itae),
            RobustGoal::Itae => (score.itae, score.settling),
        };
        let mut best: Option<(f64, GainScore)> = None;
        for gain in &gains {
            let beat = match (search.goal, &best) {
                (RobustGoal::Settling, Some((_, best))) => best.settling,
                _ => f64::INFINITY,
            };
            let Some(score) = score(&held, *gain, &search, beat) else { continue };
            if best.as_ref().is_none_or(|(_, other)| key(&score) < key(other)) {
                best = Some((*gain, score));
            }
        }
        let finite = |time: f64| time.is_finite().then_some(time);
        RobustGain {
            frequency_rad_s: *frequency,
            gain: best.map(|(gain, _)| gain),
            settling_s: best.and_then(|(gain, _)| held[0].closed(gain).settle(search.window).time_s),
            settling_quantile_s: best.and_then(|(_, score)| finite(score.settling)),
            spectral_radius: best.map(|(_, score)| score.radius),
            settling_without_s: score(&held, 0.0, &search, f64::INFINITY)
                .and_then(|score| finite(score.settling)),
        }
    };
    frequencies.par_iter().map(best).collect()
}
