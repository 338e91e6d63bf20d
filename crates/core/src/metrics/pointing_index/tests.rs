//! Pointing indices of ten runs against direct sums over every window, `tests/golden/pointing_indices_oracle.py`.

use std::f64::consts::TAU;

use super::*;
use flexsc_numerics::order_statistics::order_statistic;
use flexsc_scenario::{PointingIndex, WindowConvention};

const SAMPLES: u64 = 600;

fn error(run: u32, sample: u64) -> Vector {
    let (r, t) = (f64::from(run), sample as f64);
    let wave = (3.0 + 0.4 * r) * 1e-6 * libm::sin(TAU * t / 37.0 + 0.7 * r);
    Vector::new(0.0, (r - 4.5) * 2e-6 + (f64::from(run % 3) - 1.0) * 1e-8 * t + wave, 0.0)
}

/// The values of an index of each run, sorted, and its order statistic at 95 % as the stream keeps it.
fn runs(index: IndexWindow) -> Vec<(Vec<f64>, f64)> {
    let run = |run: u32| {
        let (mut all, mut largest) = (Vec::new(), LargestValues::new(0.95, index.values(SAMPLES)));
        let mut stream = IndexStream::new(index);
        for sample in 0..SAMPLES {
            stream.push(error(run, sample), |value| {
                all.push(value.norm());
                largest.add(value.norm());
            });
        }
        assert_eq!((all.len() as u64, largest.count()), (index.values(SAMPLES), index.values(SAMPLES)));
        assert!(largest.largest.len() < 40, "memory");
        all.sort_by(f64::total_cmp);
        (all, largest.finish())
    };
    (0..10).map(run).collect()
}

#[test]
fn indices_are_those_of_direct_sums() {
    let relative = |convention| IndexWindow::Relative { window: 60, convention };
    let drift = IndexWindow::Difference { window: 60, shift: 300, index: PointingIndex::Drift };
    for (index, expected) in [
        (
            IndexWindow::Absolute,
            [1.724_567_287_820_698e-5, 1.887_333_392_557_536e-5, 1.782_729_689_861_405e-5, 1.418e-5],
        ),
        (
            IndexWindow::Mean { window: 60 },
            [
                1.452_724_950_792_573e-5,
                1.519_157_323_392_09e-5,
                1.362_700_060_344_873e-5,
                1.247_915_722_532_795e-5,
            ],
        ),
        (
            relative(WindowConvention::End),
            [
                7.294_397_322_598_224e-6,
                7.331_944_764_396_158e-6,
                6.905_929_359_468_85e-6,
                6.254_608_568_565_47e-6,
            ],
        ),
        (
            relative(WindowConvention::Middle),
            [
                7.789_029_757_360_907e-6,
                7.796_561_226_530_243e-6,
                7.319_785_771_729_352e-6,
                6.963_480_804_605_929e-6,
            ],
        ),
        (
            relative(WindowConvention::Uniform),
            [
                7.172_144_590_624_965e-6,
                7.784_933_362_871_975e-6,
                7.292_733_462_631_508e-6,
                5.885_141_489_739_773e-6,
            ],
        ),
        (
            drift,
            [
                3.797_752_597_077_72e-6,
                3.800_039_478_792_343e-6,
                3.753_292_172_363_373e-6,
                3.626_771_460_733_629e-6,
            ],
        ),
    ] {
        let runs = runs(index);
        let mut most: Vec<f64> = runs.iter().filter_map(|(all, _)| all.last().copied()).collect();
        most.sort_by(f64::total_cmp);
        let mut pooled: Vec<f64> = runs.iter().flat_map(|(all, _)| all).copied().collect();
        pooled.sort_by(f64::total_cmp);
        let temporal = runs.iter().fold(0.0, |worst: f64, (_, value)| worst.max(*value));
        let ensemble = [0.95, 0.9].map(|level| order_statistic(&most, level));
        let found = [temporal, ensemble[0], ensemble[1], order_statistic(&pooled, 0.95)];
        for (found, expected) in found.into_iter().zip(expected) {
            assert!((found / expected - 1.0).abs() < 1e-12, "{index:?}: {found:e}, {expected:e}");
        }
    }
}

#[test]
fn a_stream_that_ends_early_has_an_order_statistic_too() {
    let mut largest = LargestValues::new(0.9, 1000);
    (1_u32..=20).for_each(|value| largest.add(f64::from(value)));
    assert_eq!(largest.finish(), 18.0);
    assert!(LargestValues::new(0.9, 10).finish().is_nan());
    // A window that is never whole has no value.
    let mut stream = IndexStream::new(IndexWindow::Mean { window: 3 });
    (0..2).for_each(|sample| stream.push(error(0, sample), |_| panic!("no whole window")));
}

#[test]
fn rounding_errors_of_a_sliding_mean_do_not_grow() {
    let mut stream = IndexStream::new(IndexWindow::Mean { window: 7 });
    let mut last = 0.0;
    for sample in 0..20_000_u32 {
        // A large value once in a while would leave its rounding error in a plain running sum.
        let value = if sample % 1000 == 0 { 1e9 } else { 0.1 };
        stream.push(Vector::new(value, 0.0, 0.0), |mean| last = mean.x);
    }
    assert!((last - 0.1).abs() < 1e-15, "{last:e}");
}

/// Each value of a stream is the sum of its samples with the weights of the index.
#[test]
fn values_are_weighted_sums_of_samples() {
    let relative = |window, convention| IndexWindow::Relative { window, convention };
    for index in [
        IndexWindow::Absolute,
        IndexWindow::Mean { window: 5 },
        relative(2, WindowConvention::End),
        relative(4, WindowConvention::Middle),
        relative(5, WindowConvention::Middle),
        relative(3, WindowConvention::Uniform),
        IndexWindow::Difference { window: 2, shift: 3, index: PointingIndex::Drift },
    ] {
        let errors: Vec<Vector> = (0..60).map(|sample| error(7, sample)).collect();
        let mut stream = IndexStream::new(index);
        let mut found = Vec::new();
        for error in &errors {
            stream.push(*error, |value| found.push(value));
        }
        assert_eq!(found.len() as u64, index.values(60));
        for (number, value) in found.iter().enumerate() {
            let (set, place) = (number as u64 / index.places(), number as u64 % index.places());
            let weights = index.weights(place);
            assert_eq!(weights.len() as u64, index.reach());
            let samples = &errors[(set * index.places()) as usize..];
            let sum = samples
                .iter()
                .zip(&weights)
                .fold(Vector::zeros(), |sum, (error, weight)| sum + error * *weight);
            assert!((sum - value).norm() < 1e-18, "{index:?} {number}");
        }
    }
}
