//! Compensators against SciPy, Kalman filters against textbook formulas, both by bits against the matrix library; B-dot laws, and
//! numbers that are not finite.

use flexsc_flight::attitude_law::AttitudeFeedback;
use flexsc_flight::axis_motion::{AxisMotion, AxisReference};
use flexsc_flight::b_dot::{FieldRate, limited_moment, opposing_moment};
use flexsc_flight::biquad::BiquadFilter;
use flexsc_flight::compensator::{
    CompensatorQuantity, CompensatorRange, CompensatorSource, advance, read_sources,
};
use flexsc_flight::error_measure::ErrorMeasure;
use flexsc_flight::jet_pulses::JetPair;
use flexsc_flight::kalman::{self, KalmanInnovation, KalmanSample};
use flexsc_flight::kalman_axis::{KalmanAxis, KalmanFeed};
use flexsc_flight::magnetorquers::{moment_of_torque, torque_of_moment};
use flexsc_flight::momentum_unloading::MomentumUnloading;
use flexsc_flight::pd::{ErrorDerivative, PdLaw};
use flexsc_flight::pulse_width::PulseQuantum;
use flexsc_flight::rigid_rate::RigidRateFilter;
use flexsc_flight::ticks::Ticks;
use flexsc_flight::vector3::Vector3;
use flexsc_flight::wheel_momentum::stored;
use nalgebra::{DMatrix, DVector};

/// Rows of [A B] and of [C D], the samples of the inputs, and 0.8 times the outputs by `scipy.signal.dlsim`:
/// `tests/golden/flight_laws.py`.
const MATRICES: [f64; 12] = [0.9, 0.2, 0.5, 0.1, -0.1, 0.7, 0.0, 0.3, 1.5, -2.0, 0.25, -0.5];
const INPUTS: [[f64; 2]; 4] = [[1.0, 0.5], [-2.0, 0.25], [0.5, 1.0], [0.0, -1.0]];
const OUTPUTS: [f64; 4] = [0.0, -0.08, -1.04, -0.328];

/// Steps the compensator of `MATRICES`, and returns its outputs.
fn outputs(range: &CompensatorRange) -> Vec<f64> {
    let (mut state, mut next, mut output) = ([0.0; 2], [0.0; 2], [0.0; 1]);
    let step = |inputs: &[f64; 2]| {
        advance(&MATRICES, inputs, &mut state, &mut next, range, &mut output);
        output[0]
    };
    INPUTS.iter().map(step).collect()
}

#[test]
fn a_compensator_has_the_outputs_of_scipy() {
    let all = outputs(&CompensatorRange { gain: 0.8, limit: f64::INFINITY });
    for (found, expected) in all.iter().zip(OUTPUTS) {
        assert!((found - expected).abs() < 1e-15, "{found} {expected}");
    }
    let limited = outputs(&CompensatorRange { gain: 0.8, limit: 0.25 });
    assert_eq!(limited[2..], [-0.25, -0.25], "the limit does not change the state");
}

#[test]
fn a_compensator_has_the_bits_of_the_matrix_library() {
    let mut state = 0x9e37_79b9_u64;
    let mut draw = || {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 11) as f64 / 9e15 - 0.5
    };
    let (order, inputs, outputs) = (9, 7, 3);
    let mut random = |rows: usize, columns: usize| DMatrix::from_fn(rows, columns, |_, _| draw());
    let (a, b) = (random(order, order), random(order, inputs));
    let (c, d) = (random(outputs, order), random(outputs, inputs));
    let row = |left: &DMatrix<f64>, right: &DMatrix<f64>, row: usize| -> Vec<f64> {
        left.row(row).iter().chain(right.row(row).iter()).copied().collect()
    };
    let lower = (0..outputs).map(|index| row(&c, &d, index));
    let matrices: Vec<f64> = (0..order).map(|index| row(&a, &b, index)).chain(lower).flatten().collect();
    let mut x = DVector::zeros(order);
    let (mut own, mut next, mut found) = (vec![0.0; order], vec![0.0; order], vec![0.0; outputs]);
    let range = CompensatorRange { gain: 1.0, limit: f64::INFINITY };
    for _ in 0..50 {
        let error = DVector::from(random(inputs, 1).as_slice().to_vec());
        advance(&matrices, error.as_slice(), &mut own, &mut next, &range, &mut found);
        let output = &c * &x + &d * &error;
        x = &a * &x + &b * &error;
        assert_eq!((found.as_slice(), own.as_slice()), (output.as_slice(), x.as_slice()));
    }
}

#[test]
fn inputs_about_three_axes_are_read_by_their_name() {
    let sources = [
        (CompensatorQuantity::Rate, 2),
        (CompensatorQuantity::VectorPart, 0),
        (CompensatorQuantity::WheelSpeed, 1),
        (CompensatorQuantity::Angle, 1),
        (CompensatorQuantity::WheelSpeed, 7),
    ]
    .map(|(quantity, index)| CompensatorSource { quantity, index });
    let mut inputs = [1.0; 5];
    let (angle, rate) = (Vector3::new(0.0, 0.6, 0.8), Vector3::new(1.0, 2.0, 3.0));
    read_sources(&sources, &angle, &rate, &[10.0, 20.0], &mut inputs);
    assert_eq!(inputs, [3.0, 0.0, 20.0, 0.6, 0.0]);
    read_sources(&sources, &Vector3::new(0.6, 0.0, 0.8), &rate, &[10.0], &mut inputs);
    // Of a rotation by 1 rad about (0.6, 0, 0.8), the vector part is 0.6 sin(1/2).
    assert!((inputs[1] - 0.6 * 0.479_425_538_604_203).abs() < 1e-15 && inputs[2] == 0.0);
}

/// Model of a rigid angle and a mode, by `tests/golden/flight_laws.py`.
const MODEL: [f64; 36] = [
    1.0,
    0.0,
    0.0,
    0.0,
    0.1,
    1.0,
    0.0,
    0.0,
    0.0,
    0.0,
    0.980_093_111_454_595_5,
    -0.396_545_043_485_648_8,
    0.0,
    0.0,
    0.099_136_260_871_412_21,
    0.976_127_661_019_739,
    0.005,
    0.1,
    0.001_493_016_640_905_337_3,
    0.029_740_878_261_423_662,
    0.0,
    0.0,
    0.0,
    0.0,
    0.0,
    1e-10,
    0.0,
    3e-11,
    0.0,
    0.0,
    0.0,
    0.0,
    0.0,
    3e-11,
    0.0,
    9e-12,
];
/// Measured angle and rate, and the mean moment before.
const SAMPLES: [[f64; 3]; 3] = [[1.4e-3, -1.5e-4, 0.0], [1.35e-3, -1.2e-3, 1e-3], [1.1e-3, -2.4e-3, -5e-4]];
/// Mean of the state after each sample, the normalised squared innovation, and the standard deviations.
const EXPECTED: [([f64; 4], f64, [f64; 4]); 3] = [
    (
        [
            9.997_506_296_601_083e-4,
            -1.986_486_815_185_577e-4,
            4.002_518_640_432_907e-4,
            4.864_746_533_192_438e-5,
        ],
        0.009_250_295_806_129_459,
        [
            9.987_523_700_102_455e-5,
            9.863_942_570_651_723e-5,
            1.003_721_163_054_152e-4,
            9.868_256_994_092_036e-5,
        ],
    ),
    (
        [
            -1.304_806_951_454_431_5e-3,
            -3.067_811_398_616_792e-4,
            2.659_787_493_521_894_6e-3,
            -8.880_619_832_458_66e-4,
        ],
        586.033_846_536_193,
        [
            3.320_242_309_266_941e-5,
            9.877_123_367_509_687e-5,
            3.231_125_727_357_418_5e-5,
            9.879_796_308_425_583e-5,
        ],
    ),
    (
        [
            -1.503_522_927_976_151e-3,
            -4.776_261_030_652_108_6e-4,
            2.654_487_115_678_345e-3,
            -1.919_962_520_127_952_7e-3,
        ],
        69.410_910_851_043_54,
        [
            2.488_409_374_650_985e-5,
            9.677_726_871_212_68e-5,
            2.385_554_904_750_080_8e-5,
            9.671_626_470_328_204e-5,
        ],
    ),
];
const SAMPLE: KalmanSample = KalmanSample {
    is_measured: true,
    angle: 0.0,
    rate: 0.0,
    angle_noise: 1e-5,
    has_rate: true,
    rate_noise: 3e-6,
    motion: 4,
    is_gated: false,
};

/// Mean and covariance at the start.
fn start() -> ([f64; 4], [f64; 16]) {
    let mut covariance = [0.0; 16];
    for (index, deviation) in [1e-4, 1e-4, 2e-3, 6e-4].into_iter().enumerate() {
        covariance[5 * index] = deviation * deviation;
    }
    ([1e-3, -2e-4, 5e-4, 0.0], covariance)
}

#[test]
fn a_filter_has_the_means_and_deviations_of_textbook_formulas() {
    let ((mut mean, mut covariance), mut buffer) = (start(), [0.0; 36]);
    for (index, ([angle, rate, moment], (expected, square, deviations))) in
        SAMPLES.into_iter().zip(EXPECTED).enumerate()
    {
        if index > 0 {
            assert!(kalman::predict(&MODEL, moment, &mut mean, &mut covariance, &mut buffer));
        }
        let sample = KalmanSample { angle, rate, ..SAMPLE };
        let found = kalman::update(&sample, &mut mean, &mut covariance, &mut buffer);
        assert!(found.is_accepted && (found.square / square - 1.0).abs() < 1e-9, "{found:?}");
        for state in 0..4 {
            let deviation = covariance[5 * state].sqrt();
            assert!((mean[state] - expected[state]).abs() < 1e-14, "{index} {state}: {mean:?}");
            assert!((deviation / deviations[state] - 1.0).abs() < 1e-8, "{index} {state}: {deviation}");
        }
    }
}

#[test]
fn a_prediction_has_the_bits_of_the_matrix_library() {
    let ((mut mean, mut covariance), mut buffer) = (start(), [0.0; 36]);
    let transition = DMatrix::from_column_slice(4, 4, &MODEL[..16]);
    let push = DVector::from_column_slice(&MODEL[16..20]);
    let noise = DMatrix::from_column_slice(4, 4, &MODEL[20..]);
    for _ in 0..20 {
        let (x, p) = (DVector::from_column_slice(&mean), DMatrix::from_column_slice(4, 4, &covariance));
        let expected = (&transition * x + &push * 1e-3, &transition * p * transition.transpose() + &noise);
        assert!(kalman::predict(&MODEL, 1e-3, &mut mean, &mut covariance, &mut buffer));
        assert_eq!(mean.as_slice(), expected.0.as_slice());
        for column in 0..4 {
            for row in 0..=column {
                let entry = expected.1[(row, column)];
                assert_eq!([covariance[4 * column + row], covariance[4 * row + column]], [entry; 2]);
            }
        }
    }
}

#[test]
fn a_sample_that_is_no_number_or_far_away_changes_nothing() {
    let ((mut mean, mut covariance), mut buffer) = (start(), [0.0; 36]);
    let none = KalmanInnovation { angle: 0.0, is_accepted: false, square: 0.0 };
    let cases = [(f64::NAN, 0.0), (0.0, f64::NAN), (1e9, 0.0), (0.0, f64::INFINITY)];
    for (angle, rate) in cases {
        let sample = KalmanSample { angle, rate, ..SAMPLE };
        let found = kalman::update(&sample, &mut mean, &mut covariance, &mut buffer);
        assert!(!found.is_accepted && (mean, covariance) == start(), "{angle} {rate}");
    }
    let sample = KalmanSample { is_measured: false, ..SAMPLE };
    assert_eq!(kalman::update(&sample, &mut mean, &mut covariance, &mut buffer), none);
}

#[test]
fn a_filter_without_measurements_loses_lock_after_its_window() {
    let ((mut mean, mut covariance), mut buffer) = (start(), [0.0; 36]);
    let mut axis = KalmanAxis::new(KalmanFeed::Hub, 4, 0, 2);
    let silent = KalmanSample { is_measured: false, ..SAMPLE };
    for index in 1..=50 {
        axis.take(&MODEL, 0.0, &silent, &mut mean, &mut covariance, &mut buffer);
        assert_eq!(axis.has_lost_lock(), index == 50, "{index}");
    }
    assert_eq!((axis.displacement, axis.angle), (0.0, mean[0] + mean[2]));
    let before = axis.angle;
    axis.shift(0.5, &mut mean);
    assert!(axis.angle == before + 0.5 && mean[0] > 0.4);
    let shifted = (axis.angle, mean);
    axis.shift(f64::NAN, &mut mean);
    axis.shift(f64::INFINITY, &mut mean);
    assert!((axis.angle, mean) == shifted, "a shift that is not finite changes nothing");
}

#[test]
fn the_rate_of_the_field_is_that_of_the_last_two_samples() {
    let mut field = FieldRate::new(Ticks { whole: 3, part: 0 });
    let at = |milliseconds: i64| Ticks { whole: 0, part: milliseconds * 1_000_000_000_000 };
    field.take(at(100), &Vector3::new(1e-5, 2e-5, -3e-5));
    assert!(!field.has_rate && field.rate == Vector3::ZERO);
    field.take(at(600), &Vector3::new(2e-5, 2e-5, -4e-5));
    assert!((field.rate.x - 2e-5).abs() < 1e-19 && field.rate.y == 0.0);
    let (x, before) = (opposing_moment(8e5, field.rate.x), field.rate);
    assert!((x + 16.0).abs() < 1e-12 && limited_moment(x, 1.5) == -1.5);
    field.take(at(600), &Vector3::new(3e-5, 2e-5, -4e-5));
    assert!(!field.has_rate && field.rate == before, "a second sample at one time gives no rate");
}

#[test]
fn a_rate_of_the_field_is_not_older_than_three_periods() {
    let at = |whole: i64| Ticks { whole, part: 0 };
    let mut field = FieldRate::new(at(3));
    for second in 0..2 {
        field.take(at(second), &Vector3::new(1e-5 * second as f64, 0.0, 0.0));
    }
    assert!(field.rate_at(at(4)).x == 1e-5 && field.rate_at(at(5)) == Vector3::ZERO);
    // Without a number there is no reading, and after the gap none gives a rate with one before it.
    field.take(at(4), &Vector3::new(f64::NAN, 0.0, 0.0));
    field.take(at(6), &Vector3::new(9e-5, 0.0, 0.0));
    assert!(!field.has_rate && field.rate_at(at(6)) == Vector3::ZERO);
    field.take(at(7), &Vector3::new(8e-5, 0.0, 0.0));
    assert!((field.rate_at(at(7)).x + 1e-5).abs() < 1e-19);
    assert_eq!(field.rate_at(at(6)), Vector3::ZERO, "a clock that was set back");
}

#[test]
fn the_momentum_of_wheels_is_that_of_their_speeds_and_of_the_rate() {
    let axes = [Vector3::new(1.0, 0.0, 0.0), Vector3::new(0.0, 0.6, 0.8)];
    let rate = Vector3::new(1.0, 2.0, 3.0);
    // 0.5 (10 + 1) = 5.5 about x, and 0.5 (-4 + 3.6) = -0.2 about the other axis.
    let momentum = stored(&axes, 0.5, &[10.0, -4.0], &rate);
    assert!(momentum.minus(&Vector3::new(5.5, -0.12, -0.16)).norm() < 1e-15, "{momentum:?}");
    // A tachometer without a number counts as a wheel at rest: 0.5 * 3.6.
    let momentum = stored(&axes, 0.5, &[10.0, f64::NAN], &rate);
    assert!(momentum.minus(&Vector3::new(5.5, 1.08, 1.44)).norm() < 1e-15, "{momentum:?}");
}

#[test]
fn jets_fire_for_the_time_that_a_demand_takes() {
    let pair = JetPair {
        acceleration_plus: 2e-4,
        acceleration_minus: 1e-4,
        torque_plus: 8.0,
        torque_minus: 4.0,
        period: 2.0,
        quantum: PulseQuantum { minimum: 0.1, quantum: 0.05 },
    };
    // (demanded change, on-time): 1e-4 rad/s takes 0.5 s one way and 1 s the other.
    for (change, on) in [(1e-4, 0.5), (-1e-4, -1.0), (1.0, 2.0), (-1e-6, -0.0), (0.0, 0.0), (1.63e-4, 0.8)] {
        assert!((pair.on_time_of_change(change) - on).abs() < 1e-12, "{change}");
    }
    for (torque, on) in [(2.0, 0.5), (-2.0, -1.0), (100.0, 2.0), (0.1, 0.0), (-3.29, -1.65)] {
        assert!((pair.on_time_of_torque(torque) - on).abs() < 1e-12, "{torque}");
    }
    assert!(pair.on_time_of_torque(f64::NAN) == 0.0 && pair.on_time_of_change(f64::NAN) == 0.0);
}

#[test]
fn a_filter_of_the_rate_follows_its_two_equations() {
    let mut filter = RigidRateFilter { correction: 0.1, rate: 1e-3, drift: 0.0 };
    filter.take(true, 2e-3, 5e-4);
    // Predicted 1.5e-3: a tenth of 5e-4 corrects the rate, and 0.0025 of it the drift.
    assert!((filter.rate - 1.55e-3).abs() < 1e-18 && (filter.drift - 1.25e-6).abs() < 1e-20);
    filter.take(false, f64::NAN, 0.0);
    assert!((filter.rate - 1.551_25e-3).abs() < 1e-18 && (filter.drift - 1.25e-6).abs() < 1e-20);
}

#[test]
fn numbers_that_are_not_finite_leave_no_trace() {
    let range = CompensatorRange { gain: 1.0, limit: 1.0 };
    let (mut state, mut next, mut output) = ([0.5, -0.25], [0.0; 2], [0.0; 1]);
    advance(&MATRICES, &[f64::NAN, 1.0], &mut state, &mut next, &range, &mut output);
    assert_eq!(state, [0.5, -0.25]);
    let mut filter =
        BiquadFilter { numerator: [1.0, 0.5, 0.25], denominator: [-0.5, 0.1], state: [0.1, 0.2] };
    let before = filter;
    assert!(filter.filter(f64::NAN).is_nan());
    assert_eq!(filter, before);
    let mut rate = RigidRateFilter { correction: 0.1, rate: 1e-3, drift: 0.0 };
    rate.take(true, f64::NAN, f64::NAN);
    assert_eq!(rate, RigidRateFilter { correction: 0.1, rate: 1e-3, drift: 0.0 });
    let mut law = AttitudeFeedback {
        bandwidth: 0.1,
        damping: 0.8,
        measure: ErrorMeasure::Quaternion,
        period: 0.5,
        has_rate_limit: false,
        rate_limit: 0.0,
        has_integral: true,
        integral_time: 20.0,
        integral_limit: 0.5,
        acceleration_plus: 1.0,
        acceleration_minus: 1.0,
        integral: 0.01,
    };
    let motion = AxisMotion { angle: f64::NAN, ..AxisMotion::default() };
    assert!(law.step(&motion, &AxisReference::default(), &mut []).is_nan());
    let motion = AxisMotion { angle: f64::INFINITY, ..AxisMotion::default() };
    assert!(law.step(&motion, &AxisReference::default(), &mut []).is_infinite());
    assert_eq!(law.integral, 0.01);
}

#[test]
fn a_difference_starts_again_after_an_error_that_is_not_finite() {
    for (derivative, per_second) in [(ErrorDerivative::Difference, 2.0), (ErrorDerivative::Raw, 1.0)] {
        let mut law = PdLaw {
            k_p: 0.0,
            k_d: 1.0,
            limit: 100.0,
            period: 0.5,
            measure: ErrorMeasure::Quaternion,
            derivative,
            has_last: false,
            last: 0.0,
        };
        let mut step = |angle: f64| {
            law.step(&AxisMotion { angle, ..AxisMotion::default() }, &AxisReference::default(), &[])
        };
        // Twice the vector part of a quaternion: with the total angle 0 the angle itself.
        step(0.1);
        assert!((step(0.3) + 0.2 * per_second).abs() < 1e-15);
        for none in [f64::NAN, f64::INFINITY] {
            step(none);
            assert_eq!(step(0.3), 0.0);
            assert!((step(0.4) + 0.1 * per_second).abs() < 1e-15);
        }
    }
}

#[test]
fn unloading_begins_above_one_momentum_and_ends_below_another() {
    let mut law = MomentumUnloading {
        above: 1.0,
        below: 0.25,
        is_magnetic: true,
        gain: 0.5,
        period: 1.0,
        most: f64::INFINITY,
        is_active: false,
    };
    let along_x = |x: f64| Vector3 { x, y: 0.0, z: 0.0 };
    let stored = [0.5, 1.5, 0.5, 0.25, 0.5, f64::NAN, f64::INFINITY];
    let torques = stored.map(|x| law.torque(&along_x(x)).x);
    assert_eq!(torques, [0.0, -0.75, -0.25, 0.0, 0.0, 0.0, 0.0]);
    // Jets remove it in a period, all axes alike within their torque.
    (law.is_magnetic, law.period, law.most) = (false, 2.0, 0.25);
    assert_eq!(law.torque(&Vector3 { x: 2.0, y: -1.0, z: 0.0 }), Vector3 { x: -0.25, y: 0.125, z: -0.0 });
    // Across the field, a torque is given exactly; along it none is.
    let (field, limits) = (Vector3 { x: 0.0, y: 0.0, z: 2.0 }, Vector3 { x: 1.0, y: 1.0, z: 1.0 });
    let moment = moment_of_torque(&Vector3 { x: 1.0, y: -3.0, z: 7.0 }, &field, &limits);
    assert_eq!(moment, Vector3 { x: 1.0, y: 1.0 / 3.0, z: 0.0 });
    assert_eq!(torque_of_moment(&moment, &field), Vector3 { x: 2.0 / 3.0, y: -2.0, z: 0.0 });
    for field in [Vector3::ZERO, along_x(f64::NAN), along_x(f64::INFINITY)] {
        assert_eq!(moment_of_torque(&along_x(1.0), &field, &limits), Vector3::ZERO);
        assert_eq!(torque_of_moment(&moment, &field), Vector3::ZERO);
    }
}
