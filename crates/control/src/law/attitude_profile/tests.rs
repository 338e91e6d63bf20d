//! Profiles through targets: steps, slews and tables in frames that rest or move, and targets that are refused.

use super::*;
use flexsc_numerics::attitude::Vector;
use flexsc_numerics::quantity::{Finite, Frequency, NonNegative};
use flexsc_numerics::time::Span;

fn targets(text: &str) -> Vec<AttitudeTarget> {
    #[derive(serde::Deserialize)]
    struct Of {
        target: Vec<AttitudeTarget>,
    }
    flexsc_formats::document::from_text::<Of>(text).unwrap().target
}

fn at(seconds: f64) -> Instant {
    Instant::START + Span::from_seconds(seconds)
}

#[test]
fn a_target_is_reached_at_once_or_along_a_turn() {
    let two = targets(
        "target = [{ from = 10.0, yaw = 0.5 }, { from = 20.0, yaw = 0.9, acceleration = 2e-3, rate_limit = 0.02 }]",
    );
    let sky = OrbitEnvironment::default();
    assert_eq!(AttitudeProfile::validate(&two, &sky, &[]), None);
    let profile = AttitudeProfile::new(&two, &sky, &[]);
    let yaw = |seconds: f64| flexsc_numerics::attitude::angles(&profile.at(at(seconds)).attitude)[2];
    // The rate is 0.02 rad/s after 10 s; 0.4 rad take 30 s.
    for (seconds, exact) in
        [(9.0, 0.0), (10.0, 0.5), (20.0, 0.5), (30.0, 0.6), (35.0, 0.7), (50.0, 0.9), (90.0, 0.9)]
    {
        assert!((yaw(seconds) - exact).abs() < 1e-15, "{seconds} {}", yaw(seconds));
    }
    assert!((profile.at(at(25.0)).rate.z - 0.01).abs() < 1e-15);
    assert!((profile.at(at(45.0)).acceleration.z + 2e-3).abs() < 1e-15);
    let moving = [9.0, 10.0, 15.0, 20.0, 49.0, 51.0].map(|seconds| profile.is_moving(at(seconds)));
    assert_eq!(moving, [false, false, false, true, true, false]);
}

#[test]
fn targets_that_do_not_fit_are_refused() {
    let fault = |text: &str| {
        AttitudeProfile::validate(&targets(text), &OrbitEnvironment::default(), &[]).unwrap().to_string()
    };
    let soon =
        fault("target = [{ from = 0, yaw = 0.4, acceleration = 2e-3, rate_limit = 0.02 }, { from = 29.0 }]");
    assert!(
        soon.starts_with("`[1].from` must not be before the end of the previous turn, 30.000 s"),
        "{soon}"
    );
    assert!(
        fault("target = [{ from = 0, yaw = 0.4, rate_limit = 0.02 }]").starts_with("`[0].rate_limit` needs")
    );
    assert!(fault("target = [{ from = 0, profile = \"versine\" }]").starts_with("`[0].profile` needs"));
}

#[test]
fn a_target_of_the_orbit_turns_with_it_and_is_reached_from_where_the_body_was() {
    let environment = flexsc_formats::document::from_text(
        "orbit = { semi_major_axis = 8e6, eccentricity = 0.1, inclination = 1.2 }\nsun = [1, 2, 3]",
    );
    let sky = OrbitEnvironment::new(&environment.unwrap(), Span::from_seconds(1e4), None);
    let profile_targets = targets(
        "target = [{ from = 0, frame = \"sun\", yaw = 0.3 }, { from = 50, frame = \"nadir\", roll = 0.2, acceleration = 2e-3 }, \
         { from = 400, frame = \"nadir\", table = [{ time = 0, roll = 0.2 }, { time = 20, pitch = 0.4 }, { time = 60, yaw = -0.3 }] }]",
    );
    assert_eq!(AttitudeProfile::validate(&profile_targets, &sky, &[]), None);
    let profile = AttitudeProfile::new(&profile_targets, &sky, &[]);
    let direction = |seconds: f64, axis: Vector| -> Vector {
        let q = profile.at(at(seconds)).attitude;
        (q * Quaternion::from_imag(axis) * q.conjugate()).vector().into_owned()
    };
    assert!((direction(10.0, Vector::z()) - Vector::new(1.0, 2.0, 3.0).normalize()).norm() < 1e-15);
    assert!(!profile.is_moving(at(10.0)) && profile.is_moving(at(60.0)) && profile.is_moving(at(390.0)));
    // The slew starts at the previous target.
    assert!((profile.at(at(50.0)).attitude - profile.at(at(49.999_999_999)).attitude).norm() < 1e-9);
    // At its end the body's z is 0.2 rad from the nadir about the local x.
    let local = sky.position(390.0).unwrap().local;
    assert!((direction(390.0, Vector::x()) - local[0]).norm() < 1e-14);
    assert!((direction(390.0, Vector::z()).dot(&local[2]) - libm::cos(0.2)).abs() < 1e-14);
    // Rate and acceleration are derivatives: during the slew, along the orbit and through the table.
    let h = 1e-3;
    for seconds in [60.0, 150.0, 390.0, 410.0, 435.0, 470.0] {
        let [before, now, after] = [seconds - h, seconds, seconds + h].map(|t| profile.at(at(t)));
        let turn = (before.attitude.conjugate() * after.attitude).vector() * 2.0;
        assert!((turn / (2.0 * h) - now.rate).norm() < 1e-9, "{seconds}");
        let change = (after.rate - before.rate) / (2.0 * h);
        assert!((change - now.acceleration).norm() < 1e-8, "{seconds}");
    }
    assert!(
        (profile.at(at(390.0)).rate.norm() - sky.position(390.0).unwrap().turning[0].norm()).abs() < 1e-15
    );
}

/// Slews between frames that move begin with the rate of the reference before and end with that of the target, within the
/// acceleration about it.
#[test]
fn a_slew_between_moving_frames_has_no_jump_of_its_rate() {
    let environment = flexsc_formats::document::from_text(
        "orbit = { semi_major_axis = 7e6, eccentricity = 0.01, inclination = 1.2 }\nsun = [1, 2, 3]",
    );
    let sky = OrbitEnvironment::new(&environment.unwrap(), Span::from_seconds(1e4), None);
    for profile in ["trapezoid", "versine"] {
        let slews = targets(&format!(
            "target = [{{ from = 0, frame = \"nadir\" }}, {{ from = 100, frame = \"sun\", acceleration = 2e-3, rate_limit = 0.02, profile = \"{profile}\" }}, \
             {{ from = 500, frame = \"nadir\", roll = 0.2, acceleration = 2e-3, profile = \"{profile}\" }}]"
        ));
        assert_eq!(AttitudeProfile::validate(&slews, &sky, &[]), None);
        let way = AttitudeProfile::new(&slews, &sky, &[]);
        for from in [100.0, 500.0] {
            let begins = at(from);
            let before = way.at(at(from - 1e-6));
            let after = way.at(begins);
            assert!(before.rate.norm() > 1e-3 || from > 100.0);
            assert!((before.rate - after.rate).norm() < 1e-8, "{profile} {from}");
            assert!((before.attitude - after.attitude).norm() < 1e-8, "{profile} {from}");
            let h = 1e-3;
            for k in 1..400 {
                let t = from + 0.37 * f64::from(k);
                let [before, now, after] = [t - h, t, t + h].map(|t| way.at(at(t)));
                let turn = (before.attitude.conjugate() * after.attitude).vector() * 2.0;
                assert!((turn / (2.0 * h) - now.rate).norm() < 2e-6, "{profile} {t}");
                let change = (after.rate - before.rate).norm() / (2.0 * h);
                assert!(change < 2e-3 + 5e-5, "{profile} {t}: {change}");
            }
        }
        // A slew from the rest of one frame to another attitude in it turns as before.
        let same = targets(
            "target = [{ from = 0, frame = \"nadir\" }, { from = 100, frame = \"nadir\", yaw = 0.4, acceleration = 2e-3 }]",
        );
        let way = AttitudeProfile::new(&same, &sky, &[]);
        assert!(matches!(way.legs[1].path, SegmentPath::Turn(_)));
    }
}

/// Slews by commands and through shapers begin with the rate of the reference before, and turn and change as they say.
#[test]
fn a_shaped_slew_between_moving_frames_has_no_jump_of_its_rate() {
    let environment = flexsc_formats::document::from_text(
        "orbit = { semi_major_axis = 7e6, eccentricity = 0.01, inclination = 1.2 }\nsun = [1, 2, 3]",
    );
    let sky = OrbitEnvironment::new(&environment.unwrap(), Span::from_seconds(1e4), None);
    let mode = |frequency| {
        AxisMode::at_rest(Frequency::new(frequency).unwrap(), Finite::default(), NonNegative::default())
    };
    let modes = [mode(0.9), mode(1.7)];
    for (keys, duration) in [
        ("acceleration = 2e-3, rate_limit = 0.02, shaper = { zvd = { modes = [0] } }", None),
        ("duration = 100, command = { cosine = { suppress = 2 } }", Some(200.0)),
    ] {
        let slews = targets(&format!(
            "target = [{{ from = 0, frame = \"nadir\" }}, {{ from = 100, frame = \"sun\", {keys} }}]"
        ));
        assert_eq!(AttitudeProfile::validate(&slews, &sky, &modes), None);
        let way = AttitudeProfile::new(&slews, &sky, &modes);
        let [before, after] = [100.0 - 1e-6, 100.0].map(|t| way.at(at(t)));
        assert!(before.rate.norm() > 1e-3 && (before.rate - after.rate).norm() < 1e-8, "{keys}");
        assert!((before.attitude - after.attitude).norm() < 1e-8, "{keys}");
        let SegmentPath::Shaped(Some(decay), turn) = &way.legs[1].path else { panic!("{keys}") };
        let end = decay.duration() + turn.duration();
        assert!(duration.is_none_or(|duration: f64| (end - duration).abs() < 1e-9), "{keys}: {end}");
        let h = 1e-3;
        for k in 1..600 {
            let t = 100.0 + (end + 10.0) * f64::from(k) / 600.0;
            let [before, now, after] = [t - h, t, t + h].map(|t| way.at(at(t)));
            let turn = (before.attitude.conjugate() * after.attitude).vector() * 2.0;
            assert!((turn / (2.0 * h) - now.rate).norm() < 2e-6, "{keys} {t}");
            assert!((after.rate - before.rate).norm() / (2.0 * h) < 1e-2, "{keys} {t}");
        }
        assert!(way.slews(at(100.0 + 0.999 * end)) && !way.slews(at(100.0 + 1.001 * end)));
        assert!((way.at(at(400.0)).attitude - way.target(at(400.0))).norm() < 1e-15);
    }
}

#[test]
fn a_target_of_the_sun_follows_its_motion() {
    let environment = flexsc_formats::document::from_text("sun = \"epoch\"");
    // Seconds from 1970 to 2027-01-03T12:00:00Z.
    let epoch = Some(1_798_977_600_000_000_000);
    let sky = OrbitEnvironment::new(&environment.unwrap(), Span::from_seconds(1e7), epoch);
    let targets = targets("target = [{ from = 0, frame = \"sun\", yaw = 0.3, pitch = 0.1 }]");
    let profile = AttitudeProfile::new(&targets, &sky, &[]);
    assert!(profile.is_moving(at(1e6)));
    let h = 2e3;
    for seconds in [1e5, 3e6, 9e6] {
        let [before, now, after] = [seconds - h, seconds, seconds + h].map(|t| profile.at(at(t)));
        let turn = (before.attitude.conjugate() * after.attitude).vector() * 2.0;
        // The Sun's rate is 2e-7 rad/s, and the rate of the obliquity, 8e-14 rad/s, is not in that of the axes.
        let off = (turn / (2.0 * h) - now.rate).norm();
        assert!(off < 2e-13, "{seconds} {off:e}");
        assert!(now.rate.norm() > 1.7e-7 && now.rate.norm() < 2.4e-7, "{seconds}");
        let change = (after.rate - before.rate) / (2.0 * h);
        assert!(
            (change - now.acceleration).norm() < 1e-19,
            "{seconds} {:e}",
            (change - now.acceleration).norm()
        );
    }
}

#[test]
fn a_frame_that_is_not_there_is_refused() {
    let fault = |text: &str| {
        AttitudeProfile::validate(&targets(text), &OrbitEnvironment::default(), &[]).unwrap().to_string()
    };
    assert!(
        fault("target = [{ from = 0, frame = \"nadir\" }]").starts_with("`[0].frame` points to the planet")
    );
    assert!(
        fault("target = [{ from = 0, frame = \"sun\" }]")
            .starts_with("`[0].frame` points to `environment.sun`")
    );
    assert!(
        fault("target = [{ from = 0, yaw = 1, table = [{ time = 0 }, { time = 1 }] }]")
            .starts_with("`[0].yaw` must be left out")
    );
    assert!(
        fault("target = [{ from = 0, table = [{ time = 0 }] }]")
            .starts_with("`[0].table` must have at least two")
    );
}
