//! Budgets against tables of closed forms: quantiles of SciPy's distributions, and a sum by integration over the phase.

use super::*;

fn agree(what: &str, found: f64, expected: f64, part: f64) {
    assert!((found / expected - 1.0).abs() < part, "{what}: {found:.12}, expected {expected}");
}

fn sources(bias: f64, amplitude: f64, noise: f64) -> ErrorSources {
    let list = |value: f64| if value > 0.0 { vec![value] } else { Vec::new() };
    ErrorSources { biases: list(bias), amplitudes: list(amplitude), noise }
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
        let level = |of: ErrorSources| of.level(probability, Interpretation::Mixed);
        agree("normal", level(sources(0.0, 0.0, 1.0)), normal, 1e-9);
        agree("sine", level(sources(0.0, 1.0, 0.0)), sine, 1e-9);
        agree("uniform", level(sources(1.0, 0.0, 0.0)), uniform, 1e-12);
    }
}

#[test]
fn a_budget_by_convolution_and_by_k_sigma() {
    // A bias within 3, a sine of amplitude 2 and noise of 1: the distribution integrated over the phase of the sine.
    let budget = sources(3.0, 2.0, 1.0);
    for (probability, mixed, temporal, ensemble, mixed_rule, temporal_rule) in [
        (0.683, 2.577_803_019_2, 3.975_144_661_5, 3.115_702_349, 2.449_489_743, 4.732_050_808),
        (0.997, 6.280_152_979_5, 7.117_808_224_6, 6.706_502_175_2, 7.348_469_228, 8.196_152_423),
    ] {
        agree("mixed", budget.level(probability, Interpretation::Mixed), mixed, 1e-10);
        agree("temporal", budget.level(probability, Interpretation::Temporal), temporal, 1e-10);
        agree("ensemble", budget.level(probability, Interpretation::Ensemble), ensemble, 1e-10);
        agree("mixed rule", budget.rule(probability, Interpretation::Mixed), mixed_rule, 1e-9);
        agree("temporal rule", budget.rule(probability, Interpretation::Temporal), temporal_rule, 1e-9);
        agree("probability", budget.probability(mixed, Interpretation::Mixed), probability, 1e-10);
    }
    // Two uniform parts of 1 make a triangle: P(|e| <= x) = x - x²/4.
    let two = ErrorSources { biases: vec![1.0, 1.0], ..ErrorSources::default() };
    agree("triangle", two.level(0.75, Interpretation::Mixed), 1.0, 1e-8);
    assert_eq!(ErrorSources::default().level(0.997, Interpretation::Mixed), 0.0);
}
