//! Budgets against tables of closed forms: quantiles of SciPy's distributions, and a sum by integration over the phase.

use super::run_sources::{ValueTimes, fit_sources};
use super::*;

fn agree(what: &str, found: f64, expected: f64, part: f64) {
    assert!((found / expected - 1.0).abs() < part, "{what}: {found:.12}, expected {expected}");
}

fn combination(weight: f64, bias: f64, amplitude: f64, noise: f64) -> SourceCombination {
    SourceCombination { weight, bias, amplitudes: vec![amplitude], noise }
}

/// Returns sources with a bias that is uniform between plus and minus a value.
fn sources(largest: f64, amplitude: f64, noise: f64) -> ErrorSources {
    let points = if largest > 0.0 { 1024 } else { 1 };
    let bias = |point: u32| largest * ((2.0 * f64::from(point) + 1.0) / f64::from(points) - 1.0);
    ErrorSources::new((0..points).map(|point| combination(1.0, bias(point), amplitude, noise)).collect())
}

fn level(sources: &ErrorSources, probability: f64, interpretation: Interpretation) -> f64 {
    sources.distribution(interpretation).level(probability)
}

#[test]
fn levels_of_single_distributions() {
    // Levels of the magnitude, per standard deviation, amplitude and half width.
    for (probability, normal, sine, uniform) in [
        (0.683, 1.000_641_829, 0.878_567_152_5, 0.683),
        (0.95, 1.959_963_985, 0.996_917_333_7, 0.95),
        (0.9545, 2.000_002_444, 0.997_447_018_5, 0.9545),
        (0.997, 2.967_737_925, 0.999_988_896_7, 0.997),
        (0.9973, 2.999_976_993, 0.999_991_006_3, 0.9973),
    ] {
        let level = |of: ErrorSources| level(&of, probability, Interpretation::Mixed);
        agree("normal", level(sources(0.0, 0.0, 1.0)), normal, 1e-9);
        let sine = (ErrorSources::new(vec![combination(2.0, 0.0, 1.0, 0.0)]), sine);
        agree("sine", level(sine.0), sine.1, 1e-9);
        agree("uniform", level(sources(1.0, 0.0, 0.0)), uniform, 3e-3);
    }
}

#[test]
fn a_budget_by_convolution_and_by_k_sigma() {
    // A bias within 3, a sine of amplitude 2 and noise of 1: the distribution integrated over the phase of the sine.
    let budget = sources(3.0, 2.0, 1.0);
    let ends = ErrorSources::new([-3.0, 3.0].map(|bias| combination(1.0, bias, 2.0, 1.0)).to_vec());
    for (probability, mixed, temporal, ensemble, mixed_rule, temporal_rule) in [
        (0.683, 2.577_803_019_2, 3.975_144_661_5, 3.115_702_349, 2.449_489_743, 4.732_050_808),
        (0.997, 6.280_152_979_5, 7.117_808_224_6, 6.706_502_175_2, 7.348_469_228, 8.196_152_423),
    ] {
        agree("mixed", level(&budget, probability, Interpretation::Mixed), mixed, 1e-6);
        agree("temporal", level(&ends, probability, Interpretation::Temporal), temporal, 1e-10);
        agree("ensemble", level(&budget, probability, Interpretation::Ensemble), ensemble, 1e-6);
        agree("mixed rule", budget.rule(probability, Interpretation::Mixed), mixed_rule, 1e-6);
        agree("temporal rule", ends.rule(probability, Interpretation::Temporal), temporal_rule, 1e-9);
        let distribution = budget.distribution(Interpretation::Mixed);
        agree("probability", distribution.probability(mixed), probability, 1e-6);
    }
    assert_eq!(level(&ErrorSources::default(), 0.997, Interpretation::Mixed), 0.0);
}

/// A bias that every run has is a constant: mpmath's folded normal distribution.
#[test]
fn a_bias_of_all_runs_is_a_constant() {
    let budget = ErrorSources::new(vec![combination(1.0, -2.0, 0.0, 1.0)]);
    for (probability, exact) in [(0.683, 2.476_115_073_721_2), (0.997, 4.747_781_386_265_4)] {
        agree("mixed", level(&budget, probability, Interpretation::Mixed), exact, 1e-11);
    }
    assert_eq!((budget.bias(), budget.bias_spread(), budget.largest_bias()), (-2.0, 0.0, 2.0));
    agree("rule", budget.rule(0.997, Interpretation::Mixed), 5.0, 1e-12);
}

/// Places of an index at which noise and sines differ, by mpmath.
#[test]
fn places_of_a_window_are_mixed() {
    let noise = ErrorSources::new(vec![combination(1.0, 0.0, 0.0, 1.0), combination(3.0, 0.0, 0.0, 3.0)]);
    let sine = ErrorSources::new(vec![combination(1.0, 0.0, 1.0, 0.0), combination(1.0, 0.0, 2.0, 0.0)]);
    for (probability, of_noise, of_sine) in
        [(0.683, 2.431_491_953_824_7, 1.087_520_965_557_6), (0.997, 8.634_485_217_286_5, 1.999_911_174_218)]
    {
        agree("noise", level(&noise, probability, Interpretation::Mixed), of_noise, 1e-11);
        agree("sine", level(&sine, probability, Interpretation::Mixed), of_sine, 1e-4);
    }
}

/// Runs with a bias, two sines and a random part that is larger at the last two places of a cycle of four.
#[test]
fn runs_show_their_sources() {
    let times = ValueTimes { period: 0.5, window: 1, cycle: 4 };
    let run = |number: u32| {
        let (bias, phase) = (f64::from(number) - 3.0, f64::from(number));
        let value = |index: u32| {
            let (t, sign) = (0.5 * f64::from(index), if (index / 4).is_multiple_of(2) { 1.0 } else { -1.0 });
            let noise = sign * if index % 4 < 2 { 0.1 } else { 0.3 };
            bias + 2.0 * libm::sin(1.3 * t + phase) + 0.5 * libm::cos(0.2 * t) + noise
        };
        IndexRun { values: (0..4000).map(value).collect(), frequencies: vec![1.3, 0.2, 1e-9] }
    };
    let runs: Vec<IndexRun> = (0..10).map(run).collect();
    let found = fit_sources(&runs, times);
    agree("bias", found.bias(), 1.5, 1e-3);
    agree("spread", found.bias_spread(), f64::sqrt(99.0 / 12.0), 1e-3);
    agree("largest", found.largest_bias(), 6.0, 1e-3);
    let amplitudes = found.amplitudes();
    agree("fast", amplitudes[0], 2.0, 1e-2);
    agree("slow", amplitudes[1], 0.5, 1e-2);
    // A sine that takes longer than the run is part of the bias.
    assert_eq!(amplitudes[2], 0.0);
    agree("noise", found.noise(), f64::sqrt(0.05), 2e-2);
    let least = found.combinations.iter().map(|own| own.noise).fold(f64::MAX, f64::min);
    agree("least noise", least, 0.1, 0.1);
}
