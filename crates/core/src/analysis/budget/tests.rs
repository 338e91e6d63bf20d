//! Budgets against tables of closed forms: quantiles of SciPy's distributions, a sum by integration over the phase, and
//! variances by quadrature over time and over frequency.

use nalgebra::{Complex, ComplexField};

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

#[test]
fn variances_of_windows() {
    // A first-order error of 3 s and a sine of 2 rad/s, over 10 s and 60 s apart.
    let real = |value: f64| Complex::new(value, 0.0);
    let slow = AutocovarianceTerm { residue: real(1.0), pole: real(-1.0 / 3.0) };
    let found = IndexVariances::new(&[slow], 10.0, 60.0);
    agree("MPE", found.mean, 0.426_421_318_802_5, 1e-12);
    agree("RPE uniform", found.relative_uniform, 0.573_578_681_197_5, 1e-12);
    agree("RPE end", found.relative_end, 0.847_825_714_810_9, 1e-12);
    agree("RPE middle", found.relative_middle, 0.453_072_042_207_6, 1e-12);
    agree("PDE", found.difference, 0.852_842_627_933_8, 1e-12);
    let found = IndexVariances::new(&[AutocovarianceTerm::sine(1.0, 2.0)], 10.0, 60.0);
    agree("sine MPE", found.mean.sqrt(), 0.038_468_101_661_9, 1e-11);
    agree("sine RPE", found.relative_uniform.sqrt(), 0.706_059_632_86, 1e-11);
    agree("sine PDE", found.difference.sqrt(), 0.023_450_971_920_2, 1e-11);
}

#[test]
fn series_and_closed_form_meet() {
    // On both sides of the change, and of a pole at zero, whose error is a constant.
    for size in [0.099_999, 0.100_001] {
        let z: Complex<f64> = Complex::new(-0.6, 0.8) * size;
        let closed = (z.exp() - 1.0 - z) / (z * z);
        assert!((window_variance_second(z) - closed).modulus() < 1e-13, "{size}");
    }
    let constant = AutocovarianceTerm { residue: Complex::new(4.0, 0.0), pole: Complex::new(0.0, 0.0) };
    let found = IndexVariances::new(&[constant], 10.0, 60.0);
    assert_eq!((found.mean, found.relative_uniform, found.difference), (4.0, 0.0, 0.0));
}

/// The function of the mean's variance, through a term of unit residue and a window of 1 s.
fn window_variance_second(z: Complex<f64>) -> Complex<f64> {
    let part = |residue: Complex<f64>| {
        IndexVariances::new(&[AutocovarianceTerm { residue, pole: z }], 1.0, 1.0).mean / 2.0
    };
    Complex::new(part(Complex::new(1.0, 0.0)), part(Complex::new(0.0, -1.0)))
}
