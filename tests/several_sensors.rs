//! Several sensors: each has its own period, their measurements are combined, and incompatible ones are refused.

use flexsc_core::Scenario;

use crate::study::pairs;
use crate::traces::{column, nested, traced};

const BODY: &str = "duration = 40.0\nseed = 3\n[law.pd]\nk_p = 4.0\nk_d = 60.0\nperiod = 0.5\n[body.spatial]\n\
    inertia = [[100, 0, 0], [0, 80, 0], [0, 0, 60]]\nrate = [1e-3, -2e-3, 2e-3]\n\
    points = [{ name = \"hub\" }, { name = \"bench\" }]\n\
    modes = [{ frequency = 1.3, damping = 0.02, displacement = 0.1, shapes.hub = { rotation = [0.02, 0.01, 0.03] }, \
    shapes.bench = { rotation = [0.05, -0.02, 0.01] } }]\n[log]\nperiod = 0.125\n";
const CAMERA: &str = "{ sampled = { period = 1.0, point = \"bench\" } }";
const GYRO: &str = "{ gyro = { period = 0.25, point = \"hub\" } }";

/// The angle error and the measured rate about the first axis, at each log period.
fn seen(sensors: &str) -> (Vec<f64>, Vec<f64>) {
    let scenario = Scenario::parse("s.toml", &format!("sensor = {sensors}\n{BODY}")).expect("a scenario");
    let trace = traced(&scenario);
    let measured = nested(&trace, "/rates", ["axes", "measured_rad_s"], (0, 3));
    (column(&trace, "/pointing", "roll_error_rad").to_vec(), measured)
}

#[test]
fn a_list_of_one_is_that_one() {
    for sensor in [CAMERA, GYRO] {
        assert_eq!(seen(sensor), seen(&format!("[{sensor}]")));
    }
}

/// The camera alone differentiates angles once a second; with a gyro the rates are the gyro's, four times a second,
/// whatever the order.
#[test]
fn each_is_read_at_its_own_period() {
    let changes = |values: &[f64]| values.windows(2).filter(|pair| pair[0] != pair[1]).count();
    let (_, alone) = seen(CAMERA);
    let (errors, both) = seen(&format!("[{CAMERA}, {GYRO}]"));
    assert_eq!((changes(&alone), changes(&both)), (40, 160));
    let (other, turned) = seen(&format!("[{GYRO}, {CAMERA}]"));
    // The one that is first decides on the last digits.
    let apart = |a: &[f64], b: &[f64]| pairs(a, b).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
    assert!(apart(&errors, &other) < 1e-15 && apart(&both, &turned) < 1e-15);
    // The loop is closed by both, and stands in the end where the camera's bench says so.
    assert!(errors.last().expect("rows").abs() < 2e-3, "{:?}", errors.last());
    assert_ne!(errors, seen(GYRO).0, "a gyro alone knows the attitude");
}

#[test]
fn what_nothing_combines_is_refused() {
    let refused = |sensors: &str, rest: &str, why: &str| {
        let text = format!("sensor = {sensors}\n{BODY}{rest}");
        let error = Scenario::parse("s.toml", &text).expect_err(sensors).to_string();
        assert!(error.contains(why), "{error}");
    };
    refused("[]", "", "one part or more");
    refused(&format!("[{GYRO}, {GYRO}]"), "", "sensor[1].gyro");
    refused(&format!("[{CAMERA}, {CAMERA}]"), "", "sensor[1].sampled");
    refused(&format!("[{CAMERA}, \"continuous\"]"), "", "sensor[1].continuous");
    refused(
        &format!("[{CAMERA}, {GYRO}]"),
        "[estimator.kalman]\nangle_noise = 1e-4\nmoment_noise = 1e-9\n",
        "estimator.kalman",
    );
}
