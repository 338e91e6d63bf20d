//! Tests of control moment gyros: steering against numpy, limits, failures, and singular angles.

#![expect(clippy::unreadable_literal, reason = "the digits of references are compared as they stand")]

use super::*;

fn start(keys: &str) -> ControlMomentGyrosState {
    let text = format!("arrangement = \"pyramid\"\nmomentum = 15.0\n{keys}");
    let gyros: ControlMomentGyros = flexsc_formats::document::from_text(&text).unwrap();
    let setting = |axis| AxisActuatorContext {
        axis,
        inertia: 100.0,
        planned_inertia: 100.0,
        rate: 0.0,
        cycle: Some(Span::from_seconds(0.1)),
        waveform: None,
        share: 1.0,
    };
    ControlMomentGyrosState::new(&gyros, &gyros.axes().unwrap(), &[0, 1, 2].map(setting))
}

fn at(seconds: f64) -> Instant {
    Instant::START + Span::from_seconds(seconds)
}

fn demand(gimbals: &mut ControlMomentGyrosState, now: Instant, torque: [f64; 3]) {
    gimbals.command(now, &torque.map(Demand::Torque), [0.0; 3]);
}

fn applied(gimbals: &ControlMomentGyrosState, now: Instant) -> Vector {
    Vector::from_fn(|axis, _| gimbals.response(now, axis, [0.0; 2]).applied)
}

#[track_caller]
fn assert_near(found: &[f64], exact: [f64; 4]) {
    for (found, exact) in found.iter().zip(exact) {
        assert!((found - exact).abs() < 1e-13, "{found} {exact}");
    }
}

const PINV: [f64; 4] =
    [-0.009349141950470142, -0.02481092697800475, -0.06377975399654681, 0.01807774420097417];
const MEASURE: f64 = 1.0766153543531032;
const ROBUST: [f64; 4] =
    [0.1130976971218693, -0.056545230395430746, -0.10656330684802393, -0.03665637066559981];
const NULL: [f64; 4] =
    [0.16140742798757168, -0.11707490226411993, 0.002353839873293649, -0.06890176965680123];
const ANGLES: &str = "angles = [0.2, -0.4, 0.1, 0.7]";
const TORQUE: [f64; 3] = [0.5, -0.25, 1.0];

/// Checks against numpy.linalg.pinv(A) @ (-T/h), with A = ACROSS cos d - SPIN sin d by columns, and sqrt(det(A A')).
#[test]
fn the_pseudo_inverse_is_that_of_numpy() {
    let mut gimbals = start(&format!("steering = \"pseudo_inverse\"\n{ANGLES}"));
    demand(&mut gimbals, at(0.0), TORQUE);
    assert_near(&gimbals.rates, PINV);
    assert!((applied(&gimbals, at(0.0)) - Vector::from(TORQUE)).norm() < 1e-14);
    let row = gimbals.gyros(at(0.0)).unwrap();
    assert!((row.singularity - MEASURE).abs() < 1e-14, "{}", row.singularity);
    // Far from singular angles the robust rule gives nearly the same rates.
    let mut robust = start(ANGLES);
    demand(&mut robust, at(0.0), TORQUE);
    for (robust, exact) in robust.rates.iter().zip(&gimbals.rates) {
        assert!((robust - exact).abs() < 1e-6 && robust != exact, "{robust} {exact}");
    }
}

/// Checks against A' (A A' + w E)^-1 (-T/h) at 0.3 s, by numpy.linalg.solve.
#[test]
fn near_singular_angles_the_robust_rates_are_those_of_numpy() {
    let angles = "angles = [-1.4, 0.1, 1.5, -0.05]";
    let mut gimbals = start(angles);
    demand(&mut gimbals, at(0.0), [0.0; 3]);
    assert_eq!(gimbals.rates, [0.0; 4]);
    demand(&mut gimbals, at(0.3), TORQUE);
    assert_near(&gimbals.rates, ROBUST);
    let mut other = start(&format!("{angles}\nrobust = {{ dither = 0.0 }}"));
    demand(&mut other, at(0.3), TORQUE);
    assert!(other.rates.iter().zip(ROBUST).any(|(rate, with)| (rate - with).abs() > 1e-4));
}

#[test]
fn the_torque_is_the_rate_of_the_momentum_while_gimbals_turn() {
    let mut gimbals = start(ANGLES);
    demand(&mut gimbals, at(0.0), [5.0, -2.5, 10.0]);
    let stored = |t: f64| Vector::from(gimbals.stored_momentum(at(t)));
    for t in [0.3, 0.9] {
        // Difference quotient of order 4.
        let step = 1e-3;
        let near = (stored(t + step) - stored(t - step)) * (8.0 / (12.0 * step));
        let far = (stored(t + 2.0 * step) - stored(t - 2.0 * step)) / (12.0 * step);
        assert!((applied(&gimbals, at(t)) + near - far).norm() < 1e-9, "{t}");
    }
    assert!((applied(&gimbals, at(0.9)) - applied(&gimbals, at(0.0))).norm() > 1.0);
    let mut wrench = Wrench::default();
    gimbals.apply(at(0.9), &mut wrench);
    let sum = wrench
        .gimbals
        .iter()
        .map(|gimbal| gimbal.at(0.0))
        .fold(Vector::zeros(), |sum, gimbal| sum + gimbal.1);
    assert!((applied(&gimbals, at(0.9)) + sum).norm() < 1e-13);
}

#[test]
fn a_torque_that_is_too_large_keeps_its_axis() {
    let mut gimbals = start(&format!("rate_limit = 0.02\nsteering = \"pseudo_inverse\"\n{ANGLES}"));
    demand(&mut gimbals, at(0.0), TORQUE);
    let largest = gimbals.rates.iter().map(|rate| rate.abs()).fold(0.0, f64::max);
    let torque = applied(&gimbals, at(0.0));
    assert!((largest - 0.02).abs() < 1e-16);
    assert!(
        torque.cross(&Vector::from(TORQUE)).norm() < 1e-14
            && torque.norm() < 0.9 * Vector::from(TORQUE).norm()
    );
    let steered = gimbals.steered;
    assert!((steered.largest_rate_rad_s - 0.02).abs() < 1e-16);
    assert!((steered.largest_error_nm - (torque - Vector::from(TORQUE)).norm()).abs() < 1e-14);
    // The torque they counteract is part of their torque.
    let mut gimbals = start(&format!("steering = \"pseudo_inverse\"\n{ANGLES}"));
    gimbals.update(Instant::START, ActuatorEvent::CounterTorque(Vector::new(0.1, 0.2, -0.3)));
    demand(&mut gimbals, at(0.0), TORQUE);
    let torque = applied(&gimbals, at(0.0));
    assert!((torque - Vector::from(TORQUE) + Vector::new(0.1, 0.2, -0.3)).norm() < 1e-14);
}

/// Drives gimbals by a constant torque along -x, so that their momentum along x grows, for `updates` of 0.05 s. Returns
/// the largest momentum along x, in units of a rotor's, and the largest rate.
fn driven(keys: &str, updates: u32) -> (f64, f64) {
    let mut gimbals = start(&format!("rate_limit = 2.0\nperiod = 0.05\n{keys}"));
    demand(&mut gimbals, at(0.0), [-1.5, 0.0, 0.0]);
    let mut most = 0.0_f64;
    for _ in 1..updates {
        let now = gimbals.due().expect("an update");
        gimbals.update(now, ActuatorEvent::Due([0.0; 3]));
        most = most.max(gimbals.stored_momentum(now)[0] / 15.0);
    }
    (most, gimbals.steered.largest_rate_rad_s)
}

/// Checks steering from angles of 0: the momentum along x ends at -90, 0, 90 and 0 degrees, an elliptic singularity
/// within the envelope: 2 cos(cant) = 1.155 of 2 + 2 cos(cant) = 3.155. Null motion cannot leave it.
#[test]
fn the_robust_rule_passes_a_singularity_at_which_the_pseudo_inverse_stays() {
    let (stays, saturated) = driven("steering = \"pseudo_inverse\"", 400);
    assert!((stays - 1.1547).abs() < 1e-3, "{stays}");
    assert!(saturated > 1.99, "{saturated}");
    let (passes, _) = driven("", 1200);
    assert!(passes > 3.15, "{passes}");
    // Without its time-varying part, the weight alone locks the gimbals.
    let (locked, slow) = driven("robust = { dither = 0.0 }", 1200);
    assert!(locked < 1.16 && slow < 1.9, "{locked} {slow}");
}

/// Checks angles of -90, 0, 90 and 0 degrees, where A A' is diag(0, 2 + 2 cos², 2 sin²) of the cant, diag(0, 8/3, 4/3):
/// with u = -T/h the rates of the first and the third are 3 u_y/8, those of the others -+ cos 3 u_y/8 + sin 3 u_z/4.
#[test]
fn at_singular_angles_the_torques_that_can_be_are_given_without_null_motion() {
    let angles = "angles = [-1.5707963267948966, 0, 1.5707963267948966, 0]";
    let keys = format!("steering = \"pseudo_inverse\"\n{angles}");
    let mut gimbals = start(&keys);
    demand(&mut gimbals, at(0.0), [30.0, -15.0, 45.0]);
    let (cos, sin) = ((1.0_f64 / 3.0).sqrt(), (2.0_f64 / 3.0).sqrt());
    let exact = [0.375, -0.375 * cos - 2.25 * sin, 0.375, 0.375 * cos - 2.25 * sin];
    for (rate, exact) in gimbals.rates.iter().zip(exact) {
        assert!((rate - exact).abs() < 1e-6, "{rate} {exact}");
    }
    assert!((applied(&gimbals, at(0.0)) - Vector::new(0.0, -15.0, 45.0)).norm() < 1e-5);
    let mut null = start(&format!("{keys}\nnull_motion = {{ angles = [0, 0, 0, 0], gain = 1.0 }}"));
    demand(&mut null, at(0.0), [30.0, -15.0, 45.0]);
    assert_eq!(null.rates, gimbals.rates);
}

/// Checks the largest torques: at angles of 0 A A' is diag(2 cos², 2 cos², 4 sin²) of the cant, and they are 2 h cos
/// and 4 h sin times the rate limit. At others they are h times the limit over the largest number in a column of
/// numpy.linalg.pinv(A).
#[test]
fn the_largest_torques_are_those_of_the_rate_limit() {
    let most = |keys: &str| {
        let text = format!("arrangement = \"pyramid\"\nmomentum = 15.0\n{keys}");
        let gyros: ControlMomentGyros = flexsc_formats::document::from_text(&text).unwrap();
        let axes = gyros.axes().unwrap();
        [0, 1, 2].map(|axis| gyros.largest_torque(&axes, axis))
    };
    let (cos, sin) = ((1.0_f64 / 3.0).sqrt(), (2.0_f64 / 3.0).sqrt());
    for (keys, exact) in [
        ("rate_limit = 0.5".to_owned(), [15.0 * cos, 15.0 * cos, 30.0 * sin]),
        (format!("rate_limit = 0.5\n{ANGLES}"), [9.353895941280454, 7.448828416037603, 11.939013825410136]),
    ] {
        for (found, exact) in most(&keys).into_iter().zip(exact) {
            assert!((found / exact - 1.0).abs() < 1e-13, "{found} {exact}");
        }
    }
    assert_eq!(most(ANGLES), [f64::INFINITY; 3]);
}

/// Checks that a change of 2e-3 rad/s within the law's 0.1 s is 2 N m on 100 kg m².
#[test]
fn a_change_of_the_rate_takes_a_period_of_the_law() {
    let mut gimbals = start(&format!("steering = \"pseudo_inverse\"\n{ANGLES}"));
    let demands = [Demand::Change(2e-3), Demand::Torque(-0.5), Demand::Moment(3.0)];
    gimbals.command(at(0.0), &demands, [0.0; 3]);
    assert!((applied(&gimbals, at(0.0)) - Vector::new(2.0, -0.5, 0.0)).norm() < 1e-13);
}

#[test]
fn null_motion_gives_no_torque_and_goes_where_it_shall() {
    let keys = "steering = \"pseudo_inverse\"\nnull_motion = { angles = [0.5, -0.6, 0.2, 1.1], gain = 1.0 }";
    let mut gimbals = start(&format!("{keys}\n{ANGLES}"));
    demand(&mut gimbals, at(0.0), [0.0; 3]);
    assert_near(&gimbals.rates, NULL);
    assert!(applied(&gimbals, at(0.0)).norm() < 1e-14);
    // The torque has priority: null motion uses what is left of the limit.
    let mut gimbals = start(&format!("{keys}\nrate_limit = 0.08\n{ANGLES}"));
    demand(&mut gimbals, at(0.0), TORQUE);
    assert!((applied(&gimbals, at(0.0)) - Vector::from(TORQUE)).norm() < 1e-13);
    let largest = gimbals.rates.iter().map(|rate| rate.abs()).fold(0.0, f64::max);
    assert!((largest - 0.08).abs() < 1e-15, "{largest}");
}

#[test]
fn a_gimbal_that_fails_stands_still_and_nobody_knows() {
    let faults = "faults = [{ dead = { gimbal = 2, from = 1.0, to = 2.0 } }]";
    let mut gimbals = start(&format!("{faults}\nsteering = \"pseudo_inverse\"\n{ANGLES}"));
    demand(&mut gimbals, at(0.0), TORQUE);
    assert_eq!(gimbals.due(), Some(at(1.0)));
    gimbals.update(at(1.0), ActuatorEvent::Due([0.0; 3]));
    assert_eq!(gimbals.rates[1], 0.0);
    assert!(gimbals.rates[0] != 0.0);
    let believed = [0, 1, 2].map(|axis| gimbals.effort(axis).reduced_moment * 100.0);
    let torque = applied(&gimbals, at(1.0));
    assert!((torque - Vector::from(believed)).norm() > 0.1);
    let held = gimbals.angles_at(at(1.9))[1];
    assert_eq!(held, gimbals.angles_at(at(1.0))[1]);
    gimbals.update(at(2.0), ActuatorEvent::Due([0.0; 3]));
    assert_eq!(gimbals.rates[1], gimbals.commanded[1]);
}

#[test]
fn axes_that_are_given_make_the_same_pyramid() {
    let (sin, cos) = libm::sincos(0.9);
    let text = format!(
        "momentum = 1.0\ngimbal_axes = [[{sin}, 0, {cos}], [0, {sin}, {cos}], [-{sin}, 0, {cos}], [0, -{sin}, {cos}]]\n\
         spin_axes = [[0, 2, 0], [-1, 0, 0], [0, -1, 0], [1, 0, 0]]"
    );
    let from_axes: ControlMomentGyros = flexsc_formats::document::from_text(&text).unwrap();
    let named: ControlMomentGyros =
        flexsc_formats::document::from_text("momentum = 1.0\narrangement = \"pyramid\"\ncant = 0.9").unwrap();
    for (from_axes, named) in from_axes.axes().unwrap().iter().zip(named.axes().unwrap()) {
        assert!(
            (from_axes.spin - named.spin).norm() < 1e-15 && (from_axes.across - named.across).norm() < 1e-15
        );
    }
}

#[test]
fn keys_that_do_not_fit_are_refused() {
    let cases = [
        ("gimbal_axes = [[1,0,0],[0,1,0]]\nspin_axes = [[0,1,0],[1,0,0]]", "gimbal_axes"),
        ("gimbal_axes = [[1,0,0],[0,1,0],[0,0,1]]\nspin_axes = [[0,1,0],[1,0,0]]", "spin_axes"),
        ("gimbal_axes = [[1,0,0],[0,1,0],[0,0,1]]\nspin_axes = [[0,1,0],[1,0,0],[1,0,1]]", "spin_axes[2]"),
        ("gimbal_axes = [[0,0,1],[0,0,-2],[0,0,1]]\nspin_axes = [[0,1,0],[1,0,0],[1,1,0]]", "gimbal_axes"),
        ("arrangement = \"pyramid\"\ncant = 0.0", "cant"),
        ("arrangement = \"pyramid\"\nspin_axes = [[1,0,0]]", "spin_axes"),
        ("arrangement = \"pyramid\"\nangles = [0.0]", "angles"),
        ("arrangement = \"pyramid\"\nnull_motion = { angles = [0.0], gain = 1.0 }", "null_motion.angles"),
        ("arrangement = \"pyramid\"\nrobust = { dither = 0.5 }", "robust.dither"),
        ("arrangement = \"pyramid\"\nrobust = {}\nsteering = \"pseudo_inverse\"", "robust"),
    ];
    for (keys, key) in cases {
        let gyros: ControlMomentGyros =
            flexsc_formats::document::from_text(&format!("momentum = 1.0\n{keys}")).unwrap();
        let fault = gyros.axes().unwrap_err();
        assert_eq!(fault.key, key, "{}", fault.why);
    }
}
