//! Conditions of modes on the sky, numbers of conditions as keys, starts of slews, and bands of the goal, against closed
//! forms.

use flexsc_core::Scenario;
use flexsc_core::metrics::MetricValue;
use flexsc_core::record::{Detail, Trace};

use crate::study::pairs;
use crate::traces::{self, column, flown, traced};
use crate::util::{Dir, table};

fn scenario(text: &str) -> Scenario {
    Scenario::parse("modes.toml", text).unwrap_or_else(|error| panic!("{error}"))
}

fn refused(text: &str) -> String {
    match Scenario::parse("modes.toml", text) {
        Ok(_) => panic!("accepted: {text}"),
        Err(error) => error.to_string(),
    }
}

/// Returns the times at which modes begin (s).
fn starts(trace: &Trace) -> Vec<f64> {
    traces::times(trace, "/mode")
}

/// Gravitational parameter of the Earth (m³/s²), its equatorial radius (m) and its rate (rad/s).
const EARTH: [f64; 3] = [3.986_004_418e14, 6_378_137.0, 7.292_115e-5];
/// Radius of the orbit (m).
const ORBIT: f64 = 7.2e6;
const LAW: &str = "law.attitude = { period = 4.0, bandwidth = 0.05 }";
const SITE: &str = "target = { primary = { body = [0, 0, 1], along = { site = { latitude = 0.0, longitude = 1.4 } } }, \
                    secondary = { body = [0, 1, 0], along = \"orbit_normal\" } }";

/// A body on a circular orbit over the equator, in these modes.
fn on_the_equator(duration: f64, modes: &str) -> String {
    format!(
        "duration = {duration:?}\n[body.spatial]\ninertia = [[10.0, 0.0, 0.0], [0.0, 8.0, 0.0], [0.0, 0.0, 6.0]]\n\
         [log]\nperiod = 10.0\n[sensor.sampled]\nperiod = 4.0\n\
         [environment]\norbit = {{ semi_major_axis = {ORBIT:?}, inclination = 0.0 }}\nsun = [1, 0, 0]\n{modes}"
    )
}

fn mean_motion() -> f64 {
    (EARTH[0] / ORBIT.powi(3)).sqrt()
}

/// On a circular orbit in the plane of the Sun, half of its disc is in view where the limb of the planet crosses its centre.
#[test]
fn sunlight_is_passed_at_exact_instants() {
    let modes = |quantity: &str| {
        format!(
            "[[mode]]\nname = \"day\"\n{LAW}\nleave = [{{ to = \"night\", when = \"{quantity} < 0.5\" }}]\n\
             [[mode]]\nname = \"night\"\n{LAW}\nleave = [{{ to = \"day\", when = \"{quantity} >= 0.5\" }}]\n"
        )
    };
    let exact = starts(&traced(&scenario(&on_the_equator(7000.0, &modes("truth.sunlight")))));
    let (n, dip) = (mean_motion(), (EARTH[1] / ORBIT).asin());
    // The Sun is at a distance of an astronomical unit, and a chord of its disc along the curved limb is not quite a diameter.
    let [enter, leave] = [std::f64::consts::PI - dip, std::f64::consts::PI + dip].map(|angle| angle / n);
    assert_eq!(exact.len(), 3, "{exact:?}");
    for (found, expected) in pairs(&exact[1..], [enter, leave]) {
        assert!((found - expected).abs() < 0.2, "{found} {expected}");
    }
    // What the law knows is tested at its samples, 4 s apart.
    let sampled = starts(&traced(&scenario(&on_the_equator(7000.0, &modes("sunlight")))));
    for (sampled, exact) in pairs(&sampled[1..], &exact[1..]) {
        assert_eq!(*sampled, (exact / 4.0).ceil() * 4.0);
    }
    // In a cylinder's shadow the edges are those of the closed form.
    let cylinder = on_the_equator(7000.0, &modes("truth.sunlight"))
        .replace("sun = [1, 0, 0]", "sun = [1, 0, 0]\nshadow = \"cylinder\"");
    let found = starts(&traced(&scenario(&cylinder)));
    for (found, expected) in pairs(&found[1..], [enter, leave]) {
        assert!((found - expected).abs() < 2e-8, "{found} {expected}");
    }
    // A condition that the sky meets from the start on is met at once.
    let dark = modes("truth.sunlight").replace("< 0.5", "> 0.5").replace(">= 0.5", "> 2");
    let found = starts(&traced(&scenario(&on_the_equator(100.0, &dark))));
    assert!(found.len() > 1 && found[1] == 1e-15, "{found:?}");
}

/// Over the equator the elevation at a site on it follows from a plane triangle.
#[test]
fn elevation_is_passed_at_exact_instants() {
    let modes = |quantity: &str| {
        format!(
            "[[mode]]\nname = \"rest\"\n{LAW}\ntarget = {{ frame = \"sun\" }}\n\
             leave = [{{ to = \"pass\", when = \"{quantity}(pass) > 10 deg\" }}]\n\
             [[mode]]\nname = \"pass\"\n{LAW}\n{SITE}\nleave = [{{ to = \"rest\", when = \"{quantity}(pass) < horizon\", \
             numbers = {{ horizon = 0.1 }} }}]\n"
        )
    };
    let exact = starts(&traced(&scenario(&on_the_equator(2500.0, &modes("truth.elevation")))));
    let relative = mean_motion() - EARTH[2];
    let angle = |elevation: f64| (EARTH[1] * elevation.cos() / ORBIT).acos() - elevation;
    let expected = [1.4 - angle(10f64.to_radians()), 1.4 + angle(0.1)].map(|angle| angle / relative);
    assert_eq!(exact.len(), 3, "{exact:?}");
    for (found, expected) in pairs(&exact[1..], expected) {
        assert!((found - expected).abs() < 1e-7, "{found} {expected}");
    }
    let sampled = starts(&traced(&scenario(&on_the_equator(2500.0, &modes("elevation")))));
    assert_eq!(sampled[1], (exact[1] / 4.0).ceil() * 4.0);
}

/// A number of a condition is a key: a campaign draws it, and a command sets it.
#[test]
fn numbers_of_conditions_are_keys() {
    let dir = Dir::new();
    let text = "duration = 30.0\n[body.planar]\ninertia = 100.0\nangle = 2e-3\n[[mode]]\nname = \"a\"\n\
                law.pd = { k_p = 4.0, k_d = 30.0, period = 0.5 }\n\
                leave = [{ to = \"b\", when = \"truth.run_time >= after or truth.run_time > last\", numbers = { after = 4.0, last = 20.0 } }]\n\
                [[mode]]\nname = \"b\"\nlaw.open = {}\n\
                [uncertain.\"mode[0].leave[0].numbers.after\"]\nuniform = [3.0, 9.0]\n";
    dir.write("two.toml", text);
    dir.run("simulate two.toml --runs 4 --table csv -o out").exits(0);
    let rows = table(&dir, "out/runs.csv");
    let mut drawn = Vec::new();
    for row in &rows {
        let value: f64 = row["mode[0].leave[0].numbers.after"].parse().expect("a number");
        let starts = row["mode_starts_s"].trim_matches(['[', ']']);
        let (_, second) = starts.split_once(',').expect("two starts");
        let start: f64 = second.parse().expect("a number");
        assert!((start - value).abs() < 1e-12 && value > 3.0 && value < 9.0, "{row:?}");
        drawn.push(value.to_bits());
    }
    drawn.dedup();
    assert_eq!(drawn.len(), 4);
    let json = dir.run("simulate two.toml --set mode[0].leave[0].numbers.after=6.5 --json").exits(0).json();
    assert!(json.to_string().contains("6.5"), "{json}");
    dir.run("sweep two.toml --vary mode[0].leave[0].numbers.after=3:9:3 --table csv -o swept").exits(0);
    let starts: Vec<_> =
        table(&dir, "swept/runs.csv").iter().map(|row| row["mode_starts_s"].clone()).collect();
    assert_eq!(starts, ["[0.0,3.0]", "[0.0,6.0]", "[0.0,9.0]"]);
    let tuned = dir.run("tune two.toml --mode a --vary mode[0].leave[0].numbers.after=3:9").exits(2);
    tuned.says(&["one mode acts throughout, and its law is `law`"]);
    for (from, to, words) in [
        ("after = 4.0", "soon = 4.0", "`mode[0].leave[0].numbers.soon` is not in the condition"),
        ("> last", "> last or truth.time > lately", "`mode[0].leave[0].when`"),
        ("after = 4.0", "after = -4.0", "compares a time with -4, which is negative"),
        ("after = 4.0", "\"a-b\" = 4.0, after = 4.0", "must have a name of letters"),
    ] {
        let found = refused(&text.replace(from, to));
        assert!(found.contains(words), "{words}: {found}");
    }
}

/// A body that turns about z at 0.01 rad/s before a slew to a yaw of 1 rad begins at 5 s.
fn before_a_slew(first: &str, slew: &str) -> String {
    format!(
        "duration = 9.0\n[body.spatial]\ninertia = [[10.0, 0.0, 0.0], [0.0, 8.0, 0.0], [0.0, 0.0, 6.0]]\nrate = [0.0, 0.0, 0.01]\n\
         [log]\nperiod = 1.0\n[[mode]]\nname = \"a\"\n{first}\nleave = [{{ to = \"b\", when = \"time >= 5\" }}]\n\
         [[mode]]\nname = \"b\"\nlaw.attitude = {{ period = 0.5, bandwidth = 1e-6 }}\n\
         target = {{ yaw = 1.0, acceleration = 1e-6{slew} }}\n"
    )
}

/// A slew starts at the estimated attitude after a law that leaves the attitude anywhere, and at the reference after others.
#[test]
fn slews_start_at_the_estimate_or_at_the_reference() {
    let (open, weak) = ("law.open = {}", "law.attitude = { period = 0.5, bandwidth = 1e-6 }");
    for (first, slew, from_estimate) in [
        (open, "", true),
        (weak, "", false),
        (open, ", slew_from = \"reference\"", false),
        (weak, ", slew_from = \"estimate\"", true),
    ] {
        let trace = traced(&scenario(&before_a_slew(first, slew)));
        let yaw = column(&trace, "/pointing", "yaw_error_rad");
        let at = |time: f64| {
            let row = traces::times(&trace, "/pointing").iter().rposition(|row| *row == time).expect("a row");
            yaw[row]
        };
        // The reference moves by 1e-6 rad/s² only, and the law does next to nothing.
        let expected = if from_estimate { 0.02 } else { 0.07 };
        assert!((at(7.0) - expected).abs() < 1e-4, "{first} {slew}: {}", at(7.0));
    }
    let jump = before_a_slew(open, ", slew_from = \"estimate\"").replace(", acceleration = 1e-6", "");
    assert!(refused(&jump).contains("`mode[1].target.slew_from` needs an `acceleration`"));
}

/// Without `reference.band` the band is that of the law of the mode whose target is the goal.
#[test]
fn the_band_is_that_of_the_last_law() {
    let text = "duration = 400.0\n[body.spatial]\ninertia = [[100.0, 0.0, 0.0], [0.0, 80.0, 0.0], [0.0, 0.0, 60.0]]\n\
                [actuator.thrusters]\ntorque = 0.5\nperiod = 0.5\n";
    let plane = |zone: f64| {
        format!(
            "law.phase_plane = {{ period = 0.5, dead_zone = {zone:?}, rate_limit = 1e-2, switch_on = 1e-4, switch_off = 3e-5 }}"
        )
    };
    let band = |text: &str| {
        let (metrics, _) = flown(&scenario(text), 0, Detail::Events);
        (metrics.number("goal_band_rad").unwrap_or(f64::NAN), metrics.get("goal").cloned())
    };
    let (alone, _) = band(&format!("{}\n{text}[[target]]\nfrom = 0.0\nyaw = 0.1\n", plane(2e-3)));
    let moded = format!(
        "{text}[[mode]]\nname = \"a\"\n{}\ntarget = {{ yaw = 0.05 }}\nleave = [{{ to = \"b\", when = \"time >= 20\" }}]\n\
         [[mode]]\nname = \"b\"\n{}\ntarget = {{ yaw = 0.1 }}\n",
        plane(5e-4),
        plane(2e-3)
    );
    let (found, goal) = band(&moded);
    assert!(found == alone && found >= 2e-3, "{found} {alone}");
    assert_eq!(goal, Some(MetricValue::Word("met")));
    // A law with a band of 5 % counts the rotation from the attitude at the start of its mode: 0.2 rad from rest.
    let step = format!(
        "{}[[mode]]\nname = \"a\"\nlaw.open = {{}}\nleave = [{{ to = \"b\", when = \"time >= 20\" }}]\n\
         [[mode]]\nname = \"b\"\nlaw.attitude = {{ period = 0.5, bandwidth = 0.05 }}\ntarget = {{ yaw = 0.2 }}\n",
        text.replace("[actuator.thrusters]\ntorque = 0.5\nperiod = 0.5\n", "")
    );
    let (found, goal) = band(&step);
    assert!((found - 0.01).abs() < 1e-15, "{found}");
    assert_eq!(goal, Some(MetricValue::Word("met")));
    let (given, _) = band(&format!("reference.band = 0.03\n{step}"));
    assert_eq!(given, 0.03);
    // A mode without a target that ends the run leaves the goal of the mode before.
    let kept = step
        .replace("yaw = 0.2 }\n", "yaw = 0.2 }\nleave = [{ to = \"c\", when = \"time >= 100\" }]\n")
        + "[[mode]]\nname = \"c\"\nlaw.attitude = { period = 0.5, bandwidth = 0.04 }\n";
    assert!((band(&kept).0 - 0.01).abs() < 1e-15);
    // On one axis it is the band of the last mode.
    let one = format!(
        "duration = 60.0\n[body.planar]\ninertia = 100.0\nangle = 2e-3\n[actuator.thrusters]\ntorque = 0.5\nperiod = 0.5\n\
         [[mode]]\nname = \"a\"\nlaw.open = {{}}\nleave = [{{ to = \"b\", when = \"time >= 2\" }}]\n[[mode]]\nname = \"b\"\n{}\n",
        plane(5e-4)
    );
    let alone = one.split("[[mode]]").next().expect("a text").to_owned();
    assert_eq!(band(&one).0, band(&format!("{}\n{alone}", plane(5e-4))).0);
}

#[test]
fn conditions_on_the_sky_that_do_not_fit_are_refused() {
    let when = |condition: &str| {
        on_the_equator(
            10.0,
            &format!(
                "[[mode]]\nname = \"rest\"\n{LAW}\ntarget = {{ frame = \"sun\" }}\n\
                 leave = [{{ to = \"pass\", when = \"{condition}\" }}]\n[[mode]]\nname = \"pass\"\n{LAW}\n{SITE}\n"
            ),
        )
    };
    scenario(&when("elevation(pass) > 0.1"));
    for (text, words) in [
        (
            when("elevation(rest) > 0.1"),
            "`mode[0].leave[0].when` reads the elevation at the `site` in the target",
        ),
        (when("elevation > 0.1"), "needs a mode in brackets after `elevation`"),
        (when("truth.elevation(day) > 0.1"), "must name one of the modes, `rest`, `pass`, got `day`"),
        (when("truth.sunlight < 0.5 and rate < 1"), "joins the truth"),
        (when("truth.rate < 1"), "`truth.sunlight` and `truth.elevation(MODE)` have exact instants"),
        (
            when("truth.sunlight < 0.5").replace("sun = [1, 0, 0]", "").replace("\"sun\"", "\"nadir\""),
            "reads the light",
        ),
    ] {
        let found = refused(&text);
        assert!(found.contains(words), "{words}: {found}");
    }
}
