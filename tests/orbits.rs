//! Orbits by two-line elements and by ephemerides, and atmospheres, in whole scenarios.

use std::fmt::Write as _;

use flexsc_core::Scenario;
use flexsc_core::numerics::time::Instant;

use crate::traces::{column, times, traced, within};
use crate::util::Dir;

pub const TLE: &str = "{ tle = [\"1 28057U 03049A   06177.78615833  .00000060  00000-0  35940-4 0  1836\", \
                   \"2 28057  98.4283 247.6961 0000884  88.1964 271.9322 14.35478080140550\"] }";

pub const KEPLER: &str = "{ semi_major_axis = 6.978e6, eccentricity = 0.01, inclination = 1.7, node = 0.4, perigee = 0.3, anomaly = 0.2 }";

/// A rigid body under an open law, which only the environment moves.
pub fn drifting(orbit: &str, rest: &str) -> String {
    format!(
        "duration = 7200.0\nlaw = {{ open = {{}} }}\nlog = {{ period = 60.0 }}\n\
         [spacecraft]\nmass = 100.0\ninertia = [[20, 0, 0], [0, 24, 0], [0, 0, 28]]\nrate = [0, -1e-3, 0]\n\
         [environment]\norbit = {orbit}\n{rest}"
    )
}

pub fn scenario(text: &str) -> Scenario {
    Scenario::parse("orbit.toml", text).expect("a scenario")
}

/// Published states of the verification of SGP4 (AIAA 2006-6753) in a log; the epoch is that of the elements.
#[test]
fn a_log_has_the_states_of_two_line_elements() {
    let scenario = scenario(&drifting(TLE, "sun = \"epoch\"\nmagnetic_field = {}\ngravity_gradient = {}\n"));
    assert_eq!(scenario.date_ns(), Some(1_151_347_924_079_712_000));
    let trace = traced(&scenario);
    let row = times(&trace, "/orbit").iter().position(|time| *time == 7200.0).expect("a row");
    let [position, velocity] = ["position_m", "velocity_m_s"]
        .map(|name| within(&trace, "/orbit", "axes", name)[3 * row..3 * row + 3].to_vec());
    for (axis, (place, speed)) in [
        (-1_816_879.209_42, 2_325.140_071),
        (-1_835_787.621_32, 6_655.669_329),
        (6_661_079.264_65, 2_463.394_512),
    ]
    .into_iter()
    .enumerate()
    {
        // Lagrange polynomials of eight rows a minute apart; the velocity of SGP4 is not quite the rate of its position.
        assert!((position[axis] - place).abs() < 3e-5, "{axis}: {}", position[axis] - place);
        assert!((velocity[axis] - speed).abs() < 0.05, "{axis}: {}", velocity[axis] - speed);
    }
}

/// An ephemeris of a Kepler orbit has the motion, shadows and torques of that orbit.
#[test]
fn an_ephemeris_of_a_kepler_orbit_is_that_orbit() {
    let dir = Dir::with(&[]);
    let rest = "sun = [0.9, 0.4, 0.17]\ngravity_gradient = {}\n\
                solar_pressure = { force = [1e-4, 2e-4, 0], at = [0.1, 0, 0.2] }\n\
                drag = { density = 1e-12, altitude = 6e5, scale_height = 6e4, plates = [{ area = 1.0, normal = [-1, 0, 0], at = [0, 0.1, 0.2] }] }\n\
                magnetic_field = {}\ndipole = { moment = [1, 0, 0.5] }\n";
    let kepler = scenario(&drifting(KEPLER, rest));
    let sky = kepler.orbit_environment();
    let (mut table, mut message) = ("t,x,y,z\n".to_owned(), String::new());
    message.push_str("CCSDS_OEM_VERS = 2.0\nMETA_START\nCENTER_NAME = EARTH\nREF_FRAME = TOD\nTIME_SYSTEM = UTC\nMETA_STOP\n");
    for row in -5..=126_i32 {
        let t = 60.0 * f64::from(row);
        let place = sky.position(t).expect("an orbit").position;
        writeln!(table, "{t},{},{},{}", place.x, place.y, place.z).expect("text");
        let (minute, hour) = ((row + 60) % 60, (row + 60) / 60);
        let km = place / 1e3;
        writeln!(message, "2026-11-24T{:02}:{minute:02}:00 {} {} {} 0 0 0", hour + 11, km.x, km.y, km.z)
            .expect("text");
    }
    dir.write("orbit.csv", &table);
    dir.write("orbit.oem", &message);
    let exact = traced(&kepler);
    for (name, epoch) in [("orbit.csv", ""), ("orbit.oem", "epoch = 2026-11-24T12:00:00Z\n")] {
        let text = format!("{epoch}{}", drifting(&format!("{{ ephemeris = \"{name}\" }}"), rest))
            .replace("magnetic_field = {}", "magnetic_field = { model = \"dipole\", meridian = 0 }");
        dir.write("study.toml", &text);
        let found = Scenario::load(&dir.path("study.toml")).expect("a scenario");
        let trace = traced(&found);
        for (topic, rows, name, tolerance) in [
            ("/orbit", "axes", "position_m", 1e-3),
            ("/orbit", "axes", "velocity_m_s", 1e-5),
            ("/orbit", "axes", "field_t", 1e-14),
            ("/torques", "axes", "disturbance_nm", 1e-12),
        ] {
            let [found, exact] = [&trace, &exact].map(|trace| within(trace, topic, rows, name));
            assert_eq!(found.len(), exact.len());
            for (found, exact) in found.iter().zip(exact) {
                assert!((found - exact).abs() < tolerance, "{name}: {found} {exact}");
            }
        }
        let [lit, expected] = [&trace, &exact].map(|trace| column(trace, "/orbit", "sunlight"));
        assert!(lit.iter().zip(expected).all(|(lit, expected)| (lit - expected).abs() < 1e-6));
        let edges = |scenario: &Scenario| -> Vec<f64> {
            scenario
                .orbit_environment()
                .shadow_edges()
                .map(Instant::seconds)
                .filter(|t| *t < 7200.0)
                .collect()
        };
        let (found_edges, exact_edges) = (edges(&found), edges(&kepler));
        assert!(found_edges.len() == exact_edges.len() && exact_edges.len() >= 4, "{found_edges:?}");
        assert!(
            found_edges.iter().zip(&exact_edges).all(|(a, b)| (a - b).abs() < 1e-6),
            "{found_edges:?} {exact_edges:?}"
        );
        // A log repeats without the file.
        let alone = found.self_contained().to_toml();
        assert!(!alone.contains(name) || alone.contains("ephemeris"), "{alone}");
        let again = traced(&Scenario::parse("alone.toml", &alone).expect("self-contained"));
        assert_eq!(column(&again, "/pointing", "q_x"), column(&trace, "/pointing", "q_x"));
    }
}

#[test]
fn an_altitude_and_a_local_time_are_an_orbit() {
    // The inclination computed apart (cos i = -w/(1.5 n J2 (Re/a)²), w of the mean Sun), the node from the mean longitude.
    let node = (280.460 + 0.985_647_4 * 9824.0 - 22.5_f64).rem_euclid(360.0);
    let written = format!(
        "{{ semi_major_axis = 6903137, inclination = \"97.49694207306622 deg\", node = \"{node} deg\", j2 = true }}"
    );
    let at = |orbit: &str, t: f64| {
        let text = drifting(orbit, "").replacen("duration", "epoch = 2026-11-24T12:00:00Z\nduration", 1);
        scenario(&text).orbit_environment().position(t).expect("an orbit").position
    };
    for t in [0.0, 3000.0, 80_000.0] {
        let [own, by_hand] =
            ["{ altitude = \"525 km\", ltan = \"10:30\" }", &written].map(|orbit| at(orbit, t));
        assert!((own - by_hand).norm() < 1e-2, "{t}: {own} {by_hand}");
    }
    // Logs and campaigns hold the scenario as it was written.
    let text = drifting("{ altitude = \"525 km\", ltan = \"10:30\" }", "");
    let whole = scenario(&text.replacen("duration", "epoch = 2026-11-24T12:00:00Z\nduration", 1));
    let again = scenario(&whole.to_toml());
    assert_eq!(again.environment, whole.environment);
}

#[test]
fn orbits_that_do_not_hold_are_refused() {
    let refused = |text: &str, words: &[&str]| {
        let error = Scenario::parse("bad.toml", text).expect_err(words[0]).to_string();
        assert!(words.iter().all(|word| error.contains(word)), "{error}");
    };
    let orbit = |orbit: &str| drifting(orbit, "");
    refused(&orbit("{}"), &["`environment.orbit`", "`semi_major_axis`", "`tle`", "`ephemeris`"]);
    let both = |keys: &str, other: &str| {
        refused(&orbit(&format!("{{ altitude = 5e5, {keys} }}")), &["environment.orbit", other]);
    };
    both("semi_major_axis = 7e6", "`altitude`");
    both("ltan = \"6 h\", node = 1", "`ltan`");
    both("ltan = \"6 h\"", "`epoch`");
    both("ltan = \"25:00\"", "\"10:30\"");
    both("tle = [\"1\", \"2\"]", "`tle`");
    refused(&orbit("{ ltan = \"6 h\" }"), &["environment.orbit", "`altitude`"]);
    let inside = ["`environment.orbit.semi_major_axis`", "the orbit is inside the planet"];
    refused(
        &orbit("{ semi_major_axis = \"525 km\" }"),
        &[inside[0], inside[1], "write `altitude` for 525000 m above the surface, where it is 6903137"],
    );
    refused(&orbit("{ semi_major_axis = 6903 }"), &[inside[0], inside[1], "is it meant as \"6903 km\"?"]);
    let nadir = "[[target]]\nfrom = 0\nprimary = { body = [0, 0, 1], along = \"nadir\" }\nsecondary = { body = [1, 0, 0], along = \"velocity\" }\n";
    refused(&drifting("{ semi_major_axis = 6903 }", nadir), &inside);
    refused(&orbit("{ tle = [\"1\", \"2\"] }"), &["`environment.orbit.tle[0]`", "69 characters", "got 1"]);
    refused(&orbit("{ tle = [\"1\"] }"), &["environment.orbit"]);
    refused(&orbit(&TLE.replace("tle =", "node = 0.1, tle =")), &["`node`", "`tle`"]);
    refused(&orbit(&TLE.replace("06177", "06178")), &["checksum"]);
    let rows = |count: usize| {
        let row = |k: usize| format!("[{}, 7e6, {}, 0]", 100 * k, 75_000 * k);
        format!("{{ ephemeris = [{}] }}", (0..count).map(row).collect::<Vec<_>>().join(", "))
    };
    refused(&orbit(&rows(7)), &["`environment.orbit.ephemeris`", "at least 8 rows, got 7"]);
    refused(
        &orbit(&rows(20)),
        &["`environment.orbit.ephemeris`", "rows from 0 to 7200 s of the run, got 0 to 1900 s"],
    );
    refused(&orbit(&rows(80).replace("7e6, 0, 0]", "nan, 0, 0]")), &["environment.orbit"]);
    refused(&orbit(&rows(80).replace("7e6", "6e6")), &["above the planet's radius"]);
    refused(&orbit("{ ephemeris = \"missing.csv\" }"), &["`environment.orbit.ephemeris`", "missing.csv"]);
    refused(&orbit("{ ephemeris = 5 }"), &["environment.orbit"]);
    refused(
        &drifting(TLE, "").replace("duration = 7200.0", "duration = 1e9"),
        &["`environment.orbit.tle`", "rows"],
    );
    // Sixty years after its epoch the elements are no orbit.
    refused(
        &format!(
            "epoch = 2090-01-01T00:00:00Z\n{}",
            orbit(&TLE.replace("35940-4 0  1836", "35940-1 0  1833"))
        ),
        &["`environment.orbit.tle`"],
    );
}

#[test]
fn densities_of_every_model_scale_and_are_refused_where_they_are_unknown() {
    let drag = |keys: &str| {
        drifting(
            KEPLER,
            &format!(
                "sun = [0.9, 0.4, 0.17]\ndrag = {{ {keys}, plates = [{{ area = 1.0, normal = [-1, 0, 0], at = [0, 0.1, 0.2] }}] }}\n"
            ),
        )
    };
    let torque = |keys: &str| {
        // A body that hardly moves, whatever the density.
        let heavy = drag(keys)
            .replace("[[20, 0, 0], [0, 24, 0], [0, 0, 28]]", "[[2e7, 0, 0], [0, 2e7, 0], [0, 0, 2e7]]");
        let trace = traced(&scenario(&heavy));
        within(&trace, "/torques", "axes", "disturbance_nm")
            .iter()
            .map(|torque| torque.abs())
            .fold(0.0, f64::max)
    };
    let table = "model = \"table\", table = [[4e5, 2e-12], [8e5, 2e-14]]";
    for keys in ["density = 1e-12", "model = \"harris_priester\"", table] {
        let ratio = torque(&format!("{keys}, scale = 1.5")) / torque(keys);
        assert!((ratio - 1.5).abs() < 1e-5, "{keys}: {ratio}");
    }
    let scaled = drag(&format!("{table}, scale = 1"));
    let campaign = format!("{scaled}[uncertain]\n\"environment.drag.scale\" = {{ uniform = [0.5, 2.0] }}\n");
    assert_eq!(
        Scenario::parse("campaign.toml", &campaign).map(|_| ()).map_err(|error| error.to_string()),
        Ok(())
    );
    let refused = |keys: &str, words: &[&str]| {
        let error = Scenario::parse("bad.toml", &drag(keys)).expect_err(words[0]).to_string();
        assert!(words.iter().all(|word| error.contains(word)), "{error}");
    };
    refused("scale_height = 6e4", &["`environment.drag.density`", "must be given"]);
    refused("model = \"table\"", &["`environment.drag.table`", "must be given"]);
    refused("model = \"table\", density = 1e-12", &["`environment.drag.density`", "exponential"]);
    refused(
        "model = \"table\", table = [[6e5, 1e-12], [8e5, 1e-14]]",
        &["`environment.drag.table`", "heights from"],
    );
    refused("model = \"table\", table = [[4e5, 1e-12], [8e5, -1.0]]", &["row 2", "positive density"]);
    refused("model = \"table\", table = \"missing.csv\"", &["`environment.drag.table`", "missing.csv"]);
    refused("model = \"harris_priester\", bulge_exponent = 50", &["`environment.drag.bulge_exponent`"]);
    refused("model = \"msis\"", &["environment.drag", "harris_priester"]);
    refused("density = 1e-12, scale = 0", &["environment.drag"]);
    let no_sun = drag("model = \"harris_priester\"").replace("sun = [0.9, 0.4, 0.17]\n", "");
    let error = Scenario::parse("bad.toml", &no_sun).expect_err("no Sun").to_string();
    assert!(error.contains("environment.sun"), "{error}");
    let tle = drag("density = 1e-12").replace(KEPLER, TLE);
    assert!(
        Scenario::parse("bad.toml", &tle)
            .expect_err("no height")
            .to_string()
            .contains("`environment.drag.altitude`")
    );
}

/// Published states of the verification of SGP4 in deep space (AIAA 2006-6753, `tcppver.out`) in a log.
#[test]
fn a_log_has_the_states_of_an_orbit_of_half_a_day() {
    let molniya = "{ tle = [\"1 08195U 75081A   06176.33215444  .00000099  00000-0  11873-3 0   813\", \
                   \"2 08195  64.1586 279.0717 6877146 264.7651  20.2257  2.00491383225656\"] }";
    let trace = traced(&scenario(&drifting(molniya, "sun = \"epoch\"\ngravity_gradient = {}\n")));
    for (t, exact) in [
        (0.0, [2_349_894.833_50, -14_785_938.115_62, 21.193_78]),
        (7200.0, [15_223_917.136_58, -17_852_958.817_13, 25_280_395.582_24]),
    ] {
        let row = times(&trace, "/orbit").iter().position(|time| *time == t).expect("a row");
        let position = &within(&trace, "/orbit", "axes", "position_m")[3 * row..3 * row + 3];
        for (found, exact) in position.iter().zip(exact) {
            assert!((found - exact).abs() < 1e-3, "{t}: {found} {exact}");
        }
    }
}

#[test]
fn the_examples_meet_their_goals() {
    let dir = Dir::with(&["two-line-orbit", "molniya", "field-aligned"]);
    for (name, said) in [
        ("two-line-orbit", "goal met: each axis within"),
        ("molniya", "goal met: each axis within"),
        ("field-aligned", "1 of 1 requirement met"),
    ] {
        dir.run(&format!("simulate {name}.toml")).exits(0).says(&[said]);
    }
}
