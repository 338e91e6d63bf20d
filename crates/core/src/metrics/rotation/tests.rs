//! Tests of the metrics of stretches against an implementation with 66 digits.

use flexsc_dynamics::polynomial_piece::LinearExpansion;
use nalgebra::{DMatrix, DVector, RowDVector};

use super::*;

/// Metrics of a piece: largest and smallest value, integral, ITAE, time outside a band, zeros.
struct Arc {
    range: Range,
    integral: f64,
    itae: f64,
    outside: f64,
    zeros: usize,
}

fn arc(system: &DMatrix<f64>, push: DVector<f64>, z: &[f64], output: &[f64], end: f64, band: f64) -> Arc {
    let fastest = system.row_iter().map(|row| row.iter().map(|a| a.abs()).sum::<f64>()).fold(0.0, f64::max);
    let mut linear = LinearExpansion::new(system, push, &DVector::from_column_slice(z), fastest);
    let output = RowDVector::from_row_slice(output);
    let mut verdict = GoalMetrics::new(0.0, band);
    let (mut range, mut sums, mut zeros, mut h) = (Range::EMPTY, (0.0, 0.0), Vec::new(), 0.0);
    while h < end {
        let length = linear.expand(h).min(end - h);
        let series = std::array::from_fn(|n| output.iter().zip(linear.series()).map(|(c, z)| c * z[n]).sum());
        let y = Polynomial::from_series(&series, length);
        range.widen(&y);
        y.roots(0.0, &mut zeros);
        verdict.observe(h, length, &y);
        sums = (sums.0 + length * y.integrals(0.0, 1.0)[0], sums.1 + integral(&y, h, length));
        h = if length < end - h { h + length } else { end };
    }
    let [_, _, (_, MetricValue::Number(outside))] = verdict.finish(end) else { panic!("a time outside") };
    Arc { range, integral: sums.0, itae: sums.1, outside, zeros: zeros.len() }
}

fn agrees(arc: &Arc, [max, min, integral, itae, outside]: [f64; 5], zeros: usize) {
    let close = |value: f64, exact: f64| {
        assert!((value - exact).abs() <= 1e-13 * exact.abs().max(1e-9), "{value:e} {exact:e}");
    };
    close(arc.range.1, max);
    close(arc.range.0, min);
    close(arc.integral, integral);
    close(arc.itae, itae);
    assert!((arc.outside - outside).abs() < 2e-12, "{} {outside}", arc.outside);
    assert_eq!(arc.zeros, zeros);
}

/// Returns A and the response to a unit of u for x_r'' = m, x_i'' + w_i² x_i = k_i m with m = u - a y', y = x_r + x_1 +
/// x_2.
fn two_modes(order: usize, back_emf: f64) -> (DMatrix<f64>, DVector<f64>) {
    let (mut system, mut push) = (DMatrix::zeros(order, order), DVector::zeros(order));
    for (x, w, k) in [(0, 0.0, 1.0), (2, 0.44, 0.0213), (4, 0.755, 0.0216)] {
        system[(x, x + 1)] = 1.0;
        system[(x + 1, x)] = -w * w;
        push[x + 1] = k;
        for rate in [1, 3, 5] {
            system[(x + 1, rate)] -= back_emf * k;
        }
    }
    (system, push)
}

// Reference values are those of an implementation with 66 digits (Taylor series of the matrix exponential, certified
// strides).

#[test]
fn a_coast_with_back_emf() {
    let (system, push) = two_modes(6, 2e-4);
    let start = [5e-4, 4e-5, 4e-6, 1e-6, -2e-6, 1e-6];
    let found = arc(&system, push * -1e-6, &start, &[1.0, 0.0, 1.0, 0.0, 1.0, 0.0], 19.0, 4e-4);
    let exact =
        [1.079_838_841_452_594_3e-3, 5.02e-4, 1.558_141_700_035_610_4e-2, 1.654_199_654_189_871e-1, 19.0];
    agrees(&found, exact, 0);
}

#[test]
fn three_axes_with_a_momentum_bias() {
    let (n, h) = (1.1e-3, 20.0);
    let inertia = [900.0, 1000.0, 600.0];
    let delta = [[8.0, 0.5, -1.0], [0.7, 7.0, 2.0], [-0.4, 1.5, 5.0]];
    let (frequency, damping) = ([0.37, 0.62, 1.1], [0.002, 0.003, 0.002]);
    let [j1, j2, j3] = inertia;
    let mut mass = DMatrix::identity(6, 6);
    let (mut stiffness, mut gyro) = (DMatrix::zeros(6, 6), DMatrix::<f64>::zeros(6, 6));
    for i in 0..3 {
        mass[(i, i)] = inertia[i];
        for mode in 0..3 {
            mass[(i, 3 + mode)] = delta[i][mode];
            mass[(3 + mode, i)] = delta[i][mode];
        }
        stiffness[(3 + i, 3 + i)] = frequency[i] * frequency[i];
        gyro[(3 + i, 3 + i)] = 2.0 * damping[i] * frequency[i];
    }
    gyro[(0, 2)] = h - n * (j1 - j2 + j3);
    gyro[(2, 0)] = -gyro[(0, 2)];
    stiffness[(0, 0)] = 4.0 * n * n * (j2 - j3) + n * h;
    stiffness[(1, 1)] = 3.0 * n * n * (j1 - j3);
    stiffness[(2, 2)] = n * n * (j2 - j1) + n * h;
    let inverse = mass.try_inverse().expect("regular");
    let mut system = DMatrix::zeros(12, 12);
    system.view_mut((0, 6), (6, 6)).copy_from(&DMatrix::identity(6, 6));
    system.view_mut((6, 0), (6, 6)).copy_from(&(-&inverse * stiffness));
    system.view_mut((6, 6), (6, 6)).copy_from(&(-&inverse * gyro));
    let mut push = DVector::zeros(12);
    let torque = DVector::from_column_slice(&[1e-4, -2e-4, 1e-4, 0.0, 0.0, 0.0]);
    push.rows_mut(6, 6).copy_from(&(&inverse * torque));
    let start = [1e-5, -2e-5, 3e-5, 0.02, -0.03, 0.02, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0];
    let yaw: [f64; 12] = std::array::from_fn(|index| f64::from(u8::from(index == 2)));
    let found = arc(&system, push, &start, &yaw, 60.0, 5e-5);
    let exact = [
        7.283_159_757_285_736e-4,
        -1.167_052_922_413_150_9e-4,
        1.820_836_446_177_067e-2,
        6.845_346_442_340_301e-1,
        57.437_801_542_955_22,
    ];
    agrees(&found, exact, 2);
}

#[test]
fn an_angle_behind_filters() {
    let (mut system, push) = two_modes(9, 2e-4);
    let notch = 0.755;
    for (column, value) in [(0, 2.0), (2, 2.0), (4, 2.0), (6, -2.0)] {
        system[(6, column)] = value;
    }
    system[(7, 8)] = 1.0;
    (system[(8, 6)], system[(8, 7)], system[(8, 8)]) = (1.0, -notch * notch, -1.4 * notch);
    let start = [1e-4, -1.2e-5, 5e-5, 0.0, 3e-5, 1e-5, 0.0, 0.0, 0.0];
    let output = [0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, -1.3 * notch];
    let found = arc(&system, push * 1e-6, &start, &output, 30.0, 1e-4);
    let exact = [
        1.814_486_010_142_417e-4,
        0.0,
        1.755_608_189_591_963e-3,
        3.105_650_300_898_445e-2,
        3.390_977_317_271_245,
    ];
    agrees(&found, exact, 0);
}
