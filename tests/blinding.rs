//! Star trackers that Sun, Moon and limb blind, in whole scenarios.

use flexsc_core::Scenario;
use flexsc_core::metrics::MetricValue;
use flexsc_core::record::{Detail, Trace};

use crate::drawing::{Drawing, near};
use crate::traces::{column, flown, traced, within};
use crate::util::Dir;

/// A rigid body that an ideal actuator holds in the local axes of an orbit, with sensors that are almost exact, and a star
/// tracker whose boresight is (0, -0.6, -0.8).
const LOCAL: &str = "duration = 5800.0\nepoch = 2026-11-24T00:00:00Z\n\
    [spacecraft]\nmass = 100.0\ninertia = [[20, 0, 0], [0, 20, 0], [0, 0, 20]]\nattitude = \"target\"\nrate = \"target\"\n\
    [environment]\norbit = { semi_major_axis = 6.978e6, eccentricity = 0.01, inclination = 1.7, node = 0.4, perigee = 0.3, anomaly = 0.2 }\n\
    sun = [0.9, 0.4, 0.17]\n\
    [[sensor]]\nstar_tracker = { period = 20.0, noise = [1e-9, 1e-9, 1e-9], axes = [0.31622776601683794, 0.9486832980505138, 0, 0], exclusion = EXCLUSION }\n\
    [[sensor]]\ngyro = { period = 0.5, angle_random_walk = 1e-13 }\n\
    [estimator.attitude]\ninitial = { angle = 1e-9, bias = 1e-14 }\n\
    [law.attitude]\nperiod = 0.5\nbandwidth = 0.3\n\
    [[target]]\nfrom = 0\nframe = \"nadir\"\n";

fn scenario(exclusion: &str) -> Scenario {
    Scenario::parse("blinded.toml", &LOCAL.replace("EXCLUSION", exclusion)).expect("a scenario")
}

fn events(scenario: &Scenario) -> Vec<f64> {
    let trace = traced(scenario);
    trace.topic("/blinding").map_or_else(Vec::new, |_| column(&trace, "/blinding", "time_s").to_vec())
}

/// Entry and exit of a visit of 279 s to the Sun's exclusion, with a least angle of 39.156 degrees: own computation of 30
/// digits.
#[test]
fn a_short_visit_of_the_sun_is_found_where_it_is() {
    let found = events(&scenario("{ sun = 0.6981317007977318 }"));
    assert_eq!(found.len(), 2, "{found:?}");
    for (found, expected) in found.iter().zip([5_356.646_926_884, 5_635.876_754_175]) {
        assert!((found - expected).abs() < 1e-5, "{found} {expected}");
    }
    assert!(events(&scenario("{ sun = 0.68 }")).is_empty());
}

/// Angle to the limb, against rows of the log: boresight (0, -0.6, -0.8), so that its angle to nadir is constant, and the
/// limb's moves with the distance alone. With the Moon, against a scan of its direction.
#[test]
fn limb_and_moon_blind_within_their_angles() {
    // acos(-0.8) less asin(R/r), with r from 6908 to 7048 km.
    let limit = (-0.8_f64).acos() - (6378.137_f64 / 6978.0).asin();
    let found = events(&scenario(&format!("{{ limb = {limit} }}")));
    // Near the perigee, at the start, the limb is nearer.
    assert!(found.len() == 3 && found[0] == 0.0, "{found:?}");
    let trace = traced(&scenario("{ limb = 0.0, moon = 1.5 }"));
    let positions = within(&trace, "/orbit", "axes", "position_m");
    let inside = |row: &[f64]| row.iter().map(|part| part * part).sum::<f64>().sqrt() < 6.978e6;
    let rows: Vec<bool> = positions.chunks(3).map(inside).collect();
    let times = crate::traces::times(&trace, "/orbit");
    for at in &found[1..] {
        let after = times.iter().position(|time| time > at).expect("a row");
        assert!(rows[after] != rows[after - 1], "{at}");
    }
    // The Moon, from its published direction of this date (ERFA): 1.5 rad about (0, -0.6, -0.8) of the local axes.
    let events = column(&trace, "/blinding", "time_s");
    let nadir = within(&trace, "/orbit", "axes", "nadir");
    assert!(nadir.chunks(3).all(|row| row[2] > 1.0 - 1e-12));
    let moon = [0.598_916, 0.695_693, 0.396_625];
    let velocity = within(&trace, "/orbit", "axes", "velocity_m_s");
    let angle = |row: usize| {
        let vector = |of: &[f64]| nalgebra::Vector3::new(of[3 * row], of[3 * row + 1], of[3 * row + 2]);
        let (place, speed) = (vector(positions), vector(velocity));
        let (nadir, normal) = (-place.normalize(), place.cross(&speed).normalize());
        let boresight = normal * 0.6 - nadir * 0.8;
        boresight.dot(&(nalgebra::Vector3::from(moon) * 3.62e8 - place).normalize()).acos()
    };
    // The Moon moves by 0.017 rad in this time.
    for (row, time) in times.iter().enumerate() {
        let blinded = events.iter().filter(|at| *at <= time).count() % 2 == 1;
        let angle = angle(row);
        assert!(blinded == (angle < 1.5) || (angle - 1.5).abs() < 0.025, "{time} {angle} {events:?}");
    }
    assert!(!events.is_empty());
}

/// Moon and limb silence a tracker as the Sun does.
#[test]
fn each_body_silences_a_tracker() {
    for exclusion in ["{ moon = 1.5 }", "{ limb = 1.3459 }"] {
        let trace = traced(&scenario(exclusion));
        let events = column(&trace, "/blinding", "time_s");
        let blinded = |time: f64| events.iter().filter(|at| **at <= time).count() % 2 == 1;
        let used = times_used(&trace);
        assert!(events.len() > 1 && used.len() > 50, "{exclusion}: {events:?}");
        let wrong: Vec<_> = used.into_iter().filter(|time| blinded(*time)).collect();
        assert!(wrong.is_empty(), "{exclusion}: {wrong:?}");
    }
}

/// While it is blinded, a star tracker gives no sample, and the metric is the time between the events.
#[test]
fn a_blinded_tracker_gives_no_sample() {
    let scenario = scenario("{ sun = 0.6981317007977318 }");
    let (metrics, trace): (_, Trace) = flown(&scenario, 0, Detail::Full);
    let used = times_used(&trace);
    let within = |from: f64, to: f64| used.iter().filter(|time| (from..to).contains(*time)).count();
    // The visit holds the exposures from 5360 to 5620 s.
    assert_eq!([within(5200.0, 5341.0), within(5341.0, 5636.0), within(5636.0, 5701.0)], [8, 0, 4]);
    let MetricValue::Numbers(times) = metrics.get("tracker_blinded_s").expect("a metric") else { panic!() };
    assert!((times[0] - 279.229_827_3).abs() < 1e-4, "{times:?}");
}

fn times_used(trace: &Trace) -> Vec<f64> {
    let times = crate::traces::times(trace, "/attitude_filter");
    let nis = column(trace, "/attitude_filter", "nis");
    times.into_iter().zip(nis).filter(|(_, nis)| **nis > 0.0).map(|(time, _)| time).collect()
}

#[test]
fn exclusions_without_their_bodies_are_refused() {
    let refused = |changes: &[(&str, &str)], exclusion: &str, words: &[&str]| {
        let mut text = LOCAL.replace("EXCLUSION", exclusion);
        for (from, to) in changes {
            assert!(text.contains(from), "{from}");
            text = text.replace(from, to);
        }
        let error = Scenario::parse("bad.toml", &text).expect_err(words[0]).to_string();
        assert!(words.iter().all(|word| error.contains(word)), "{error}");
    };
    let (sun, epoch) = ("sun = [0.9, 0.4, 0.17]\n", "epoch = 2026-11-24T00:00:00Z\n");
    refused(&[(sun, "")], "{ sun = 0.7 }", &["star_tracker.exclusion.sun`", "`environment.sun`"]);
    refused(&[(epoch, "")], "{ moon = 0.7 }", &["star_tracker.exclusion.moon`", "`epoch`"]);
    refused(&[("6.978e6", "3e8")], "{ moon = 0.7 }", &["exclusion.moon`", "1e8 m"]);
    refused(&[], "{ limb = 3.2 }", &["exclusion.limb`", "below pi"]);
    for bad in
        ["{ sun = nan }", "{ sun = -0.1 }", "{ sun = 1e300 }", "{ stars = 0.1 }", "0.5", "{ limb = \"0.1\" }"]
    {
        refused(&[], bad, &["exclusion"]);
    }
}

/// The example's comment: the Sun blinds the tracker for half an hour, and the goal is met.
#[test]
fn the_filter_lives_through_the_gap_of_the_example() {
    let dir = Dir::with(&["blinded-tracker"]);
    dir.run("simulate blinded-tracker.toml")
        .exits(0)
        .says(&["goal met: each axis within", "blinded for 1665 s, 28 % of the time"]);
}

/// Every figure over time shows eclipses and blinding, where a run has them.
#[test]
fn figures_show_eclipses_and_blinding() {
    let dir = Dir::with(&["blinded-tracker", "earth-observer"]);
    dir.run("simulate blinded-tracker.toml --log full").exits(0);
    dir.run("plot blinded-tracker.mcap --format svg -o figures").exits(0);
    let path = dir.path("blinded-tracker.toml");
    let found = events(&Scenario::load(&path).expect("a scenario"));
    assert_eq!(found.len(), 2, "{found:?}");
    for name in ["pointing", "wheel", "consistency", "orbit"] {
        let drawing = Drawing::read(&dir, &format!("blinded-tracker-{name}"));
        drawing.shows(&["eclipse", "tracker blinded"]);
        let strip = &drawing.shapes("polygon", "fill", "#8E5AA0")[0];
        let times: Vec<f64> = strip.iter().map(|(x, _)| drawing.across(*x, ["2000", "6000"])).collect();
        let ends = [f64::INFINITY, f64::NEG_INFINITY];
        let [from, to] = times.iter().fold(ends, |[from, to], time| [from.min(*time), to.max(*time)]);
        near(from, found[0], 10.0);
        near(to, found[1], 10.0);
    }
    dir.run("simulate earth-observer.toml --log full --set duration=20").exits(0);
    dir.run("plot earth-observer.mcap --format svg --what pointing -o figures").exits(0);
    let texts = Drawing::read(&dir, "earth-observer-pointing").texts();
    assert!(!texts.iter().any(|text| text.contains("eclipse") || text.contains("blinded")), "{texts:?}");
}
