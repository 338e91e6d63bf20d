//! Drive angles as functions of time.

use flexsc_dynamics::three_axis::DriveAngles;
use flexsc_numerics::attitude::Vector;
use flexsc_spacecraft::environment::to_body;

use super::*;
use crate::Scenario;

/// Returns a spacecraft on an orbit whose panel tracks the Sun from the local axes.
fn tracker(extra: &str) -> Scenario {
    sun_tracker("", "[0.3, 1.0, 0.2]", extra)
}

/// Returns the spacecraft of [`tracker`] with keys of the run, under a Sun.
fn sun_tracker(keys: &str, sun: &str, extra: &str) -> Scenario {
    let text = format!(
        r#"
duration = 3000.0
{keys}
[spacecraft]
mass = 500.0
inertia = [[250, 0, 0], [0, 300, 0], [0, 0, 220]]
[[appendage]]
name = "panel"
mass = 30.0
at = [0, 1, 0]
centre = [0, 2.5, 0]
inertia = [[62.5, 0, 0], [0, 5.6, 0], [0, 0, 68.1]]
plate = "y"
modes = [{{ frequency = 1.1, translation = [0, 0, 4.0], rotation = [15.0, 0, 0] }}]
drive = {{ about = [0, 1, 0], track = "sun" }}
[[target]]
from = 0
frame = "nadir"
[law.open]
[environment]
orbit = {{ semi_major_axis = 6.878e6, eccentricity = 0.01, inclination = 1.7 }}
sun = {sun}
{extra}
"#
    );
    Scenario::parse("tracker.toml", &text).expect("a scenario")
}

/// Checks that the panel's normal faces the Sun as far as the drive can turn it, and that rates are derivatives of
/// angles.
#[test]
fn a_drive_that_follows_the_sun_faces_it() {
    check_facing(&tracker(""));
    // Under a Sun that moves, at 2e-7 rad/s.
    check_facing(&sun_tracker("epoch = 2026-06-21T08:24:00Z", "\"epoch\"", ""));
}

fn check_facing(scenario: &Scenario) {
    let courses = &scenario.study.drives.as_ref().expect("drives").courses;
    let DriveProfile::Sun(following) = &courses.each[0] else { panic!("follows the Sun") };
    for t in [0.0, 100.0, 777.0, 2999.0] {
        let [angle, rate] = courses.at(0, t);
        let pose = scenario.study.profile.at(Instant::START + Span::from_seconds(t));
        let sun: Vector = to_body(&pose.attitude, &following.sun.direction(t));
        let turned = scenario.appendage[0].drive.as_ref().expect("one").rotation(angle);
        let across = Vector::y().cross(&(turned * Vector::z()));
        assert!(sun.dot(&across).abs() < 1e-14 && sun.dot(&(turned * Vector::z())) > 0.0, "{t}");
        let h = 1e-2;
        let slope = (courses.at(0, t + h)[0] - courses.at(0, t - h)[0]) / (2.0 * h);
        assert!((slope - rate).abs() < 1e-9, "{t} {slope} {rate}");
        assert!(rate.abs() <= courses.fastest());
    }
}

/// Checks that the panels turn by at most 1/32 rad between two sets of modes, whose intervals are in order.
#[test]
fn modes_change_often_enough() {
    let scenario = tracker("");
    let courses = &scenario.study.drives.as_ref().expect("drives").courses;
    assert_eq!(courses.changes[0].0, Instant::START);
    for pair in courses.changes.windows(2) {
        let [a, b] = [pair[0].0.seconds(), pair[1].0.seconds()];
        assert!(a < pair[0].1 && pair[0].1 < b);
        let turned = courses.at(0, b)[0] - courses.at(0, a)[0];
        assert!(libm::remainder(turned, std::f64::consts::TAU).abs() <= APART, "{a} to {b}: {turned}");
    }
}
