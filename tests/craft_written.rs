//! Written forms of spacecraft from parts: files, tables and texts, `flexsc modes`, and refused ones.

#![expect(clippy::unreadable_literal, reason = "the digits of references are compared as they stand")]

use flexsc_core::Scenario;
use flexsc_core::numerics::attitude::Vector;
use flexsc_core::spacecraft::body::craft::{AssembledSpacecraft, HubRotor};

use crate::craft::{CRAFT, ONE, craft, golden, near, reference, three};
use crate::util::Dir;

/// Modes in a file equal those in the scenario, a scenario that is written again is the same spacecraft, keys can be
/// drawn.
#[test]
fn files_tables_and_texts_are_the_same_spacecraft() {
    let dir = Dir::new();
    let text = std::fs::read_to_string(CRAFT).expect("a scenario");
    let start = text.rfind("modes = [").expect("the second panel's");
    let end = text.find("[law.pd]").expect("a law");
    dir.write("craft.toml", format!("{}modes = \"panel.csv\"\n{}", &text[..start], &text[end..]));
    dir.write(
        "panel.csv",
        "frequency,damping,tx,tz,rx,ry,rz\n# in bending, torsion, bending, in plane\n1.13,0.005,0,4.2887,15.577,0,0\n\
         4.36,0.005,0,0,0,2.1353,0\n7.05,0.005,0,2.3767,2.4866,0,0\n50.0,0.005,4.2887,0,0,0,-15.577\n",
    );
    let table = reference(&[]).expect("valid");
    let file = Scenario::load(&dir.path("craft.toml")).expect("valid");
    assert_eq!(craft(&file), craft(&table));
    assert!(file.to_toml().contains("panel.csv") && !file.self_contained().to_toml().contains("panel.csv"));
    let again = Scenario::parse("again.toml", &file.self_contained().to_toml()).expect("valid");
    assert_eq!(craft(&again), craft(&table));

    // First moments in place of rotations, as they follow for a plate.
    let given = text.replacen(
        "rotation = [15.577, 0.0, 0.0] ",
        "moments = [[0, 0, 0], [0, 0, 15.577], [0, 0, 0]] ",
        1,
    );
    assert_ne!(given, text);
    assert_eq!(craft(&Scenario::parse("moments.toml", &given).expect("valid")), craft(&table));

    dir.write(
        "drawn.toml",
        format!("{text}[uncertain]\n\"appendage[1].modes[0].frequency\" = {{ uniform = [1.0, 1.2] }}\n\"spacecraft.mass\" = {{ relative_normal = 0.1 }}\n"),
    );
    dir.run("simulate drawn.toml --runs 3").exits(0);
}

#[test]
fn modes_shows_parts_and_whole() {
    let dir = Dir::new();
    dir.write("craft.toml", std::fs::read(CRAFT).expect("a scenario"));
    dir.run("check craft.toml").exits(0).says(&["accepted: 100 s, 8 modes"]);
    let words = ["660 kg", "panel -y", "1.148", "242.6429", "tip"];
    dir.run("modes craft.toml --units si").exits(0).says(&words);
    let json = dir.run("modes craft.toml --json").exits(0).json();
    let at = |key: &str| json.pointer(key).and_then(serde_json::Value::as_f64).expect("a number");
    near(at("/clamped/0/effective_mass_kg/2"), 4.2887 * 4.2887, 1e-12);
    near(at("/clamped/4/frequency_rad_s"), 1.13, 0.0);
    let phi = three(&golden("locked")[1], "phi");
    near(at("/frequencies_rad_s/1"), golden("locked")[1]["frequency"], 1e-12);
    // Of the hub: phi² J at its points, and at the sensor, which is there.
    near(at("/points/0/influences/0/1"), phi.x * phi.x * 1112.576592422786, 1e-10);
    near(at("/influences/0/1"), phi.x * phi.x * 1112.576592422786, 1e-10);
    let tip = three(&golden("locked")[1], "tip_turn");
    assert_eq!(json["points"][2]["appendage"], "panel +y");
    near(at("/points/2/influences/0/1"), tip.x * phi.x * 1112.576592422786, 1e-10);
}

/// A spacecraft without modes is rigid.
#[test]
fn appendages_may_be_rigid() {
    let rigid = [("appendage[0].modes", "[]"), ("appendage[1].modes", "[]"), ("appendage[0].points", "[]")];
    let scenario = reference(&rigid).expect("valid");
    assert_eq!(scenario.mode_count(), 0);
    near(
        (craft(&scenario).model.inertia - craft(&reference(&[]).expect("valid")).model.inertia).norm(),
        0.0,
        0.0,
    );
}

/// Case: text that is replaced, its replacement, the line of the file that the error points at, and words of the error.
type Case = (&'static str, &'static str, usize, &'static [&'static str]);

#[rustfmt::skip] // One case a line.
const CASES: &[Case] = &[
    ("mass = 400.0", "mass = 0", 3, &["`spacecraft.mass`", "must be a positive number, got 0"]),
    ("[[300.0, 0.0", "[[300.0, 1.0", 4, &["`spacecraft.inertia` must be symmetric"]),
    ("[[300.0, 0.0", "[[-300.0, 0.0", 4, &["`spacecraft.inertia` must be positive definite"]),
    ("[[300.0, 0.0, 0.0], [0.0, 200.0, 0.0], [0.0, 0.0, 250.0]]", "[[3e8, 0, 0], [0, 2e8, 0], [0, 0, 5e8]]", 4, &["`spacecraft.inertia` must be that of a body within 1000 m", "is it in kg mm²?"]),
    ("mass = 400.0", "mass = 400.0\ncentre = [2000, 0, 0]", 4, &["`spacecraft.centre` must be within 1000 m, got 2000 m: is it in mm?"]),
    ("mass = 400.0", "mass = 400.0\npoints = [{ name = \"tip\" }]", 12, &["`appendage[0].points[0].name` must differ", "got `tip` again"]),
    ("mass = 400.0", "mass = 400.0\npoints = [{ name = \"a\" }, { name = \"a\" }]", 4, &["`spacecraft.points[1].name` must differ", "got `a` again"]),
    ("mass = 400.0", "mass = 400.0\ntensor = 1", 4, &["unknown key `tensor`"]),
    ("mass = 20.0", "mass = -1", 7, &["`appendage[0].mass`", "must be a positive number, got -1"]),
    ("[[30.0, 0.0", "[[30.0, 1.0", 9, &["`appendage[0].inertia` must be symmetric"]),
    ("[[30.0, 0.0", "[[-30.0, 0.0", 9, &["`appendage[0].inertia` must have no negative moment, got one of -30 kg m²"]),
    ("centre = [0.0, 2.0, 0.0]", "centre = [0.0, 2000.0, 0.0]", 8, &["`appendage[0].centre` must be within 1000 m"]),
    ("at = [0.0, 1.0, 0.0]", "at = [0.0, 1500.0, 0.0]", 10, &["`appendage[0].at` must be within 1000 m, got 1500 m: is it in mm?"]),
    ("at = [0.0, 1.0, 0.0]", "turned = { about = [0, 0, 0], by = 1 }", 10, &["`appendage[0].turned.about` must have a length"]),
    ("at = [0.0, 1.0, 0.0]", "turned = [{ about = [0, 1, 0], by = 1 }, { about = [0, 1, 0], by = 25 }]", 10, &["`appendage[0].turned[1].by` must be an angle of -2 pi to 2 pi, in rad, or such as \"30 deg\", got 25"]),
    ("at = [0.0, 1.0, 0.0]", "turned = 25.0", 10, &["`appendage[0].turned`", "a turn `{ about = [x, y, z], by = ANGLE }`, or an array of turns"]),
    ("translation = [0.0, 0.0, 3.5]", "translation = [0.0, 0.0, 4.5]", 13, &["`appendage[0].modes[0].translation` must carry no more than the appendage: its effective mass is 20.25 kg, the appendage's mass 20 kg"]),
    ("translation = [0.0, 0.0, 3.5]", "translation = [0.0, 0.0, 3500]", 13, &["`appendage[0].modes[0].translation`", "mass-normalised, in kg and m?"]),
    ("rotation = [9.0, 0.0, 0.0]", "rotation = [10.6, 0.0, 0.0]", 13, &["`appendage[0].modes[0].rotation` must carry no more than the appendage: its effective inertia about its axis is 112.36 kg m²", "about the root, 110 kg m²"]),
    ("rotation = [9.0, 0.0, 0.0]", "rotation = [9000.0, 0.0, 0.0]", 13, &["`appendage[0].modes[0].rotation`", "is it in sqrt(kg) mm?"]),
    ("rotation = [9.0, 0.0, 0.0]", "moments = [[0, 0, 0], [0, 0, 10.6], [0, 0, 0]]", 13, &["`appendage[0].modes[0].moments` must carry no more"]),
    ("rotation = [9.0, 0.0, 0.0]", "rotation = [-9.0, 0.0, 0.0]", 13, &["`appendage[0].modes[0]` must leave the appendage mass and inertia"]),
    ("rotation = [9.0, 0.0, 0.0]", "rotation = [9.0, 0.0, 0.0], moments = [[0, 0, 0], [0, 0, 8], [0, 0, 0]]", 13, &["`appendage[0].modes[0].rotation` must be that of the first moments, [8.000000, 0.000000, 0.000000], or left out"]),
    ("inertia = [[30.0, 0.0, 0.0], [0.0, 3.0, 0.0], [0.0, 0.0, 33.0]]", "", 13, &["`appendage[0].modes[0].rotation` must be left out", "a point mass"]),
    ("modes = [\n", "modes = [\n{ frequency = 1.0, translation = [0.0, 0.0, 3.0], rotation = [7.0, 0.0, 0.0], shapes.tip = {} },\n", 14, &["`appendage[0].modes[1]` must leave the appendage mass and inertia: with the modes before it carries"]),
    ("shapes = { tip", "shapes = { top", 13, &["`appendage[0].modes[0].shapes.top` must be at one of the appendage's `points`"]),
    ("points = [{ name = \"tip\", position = [0.0, 4.0, 0.0] }]", "points = [{ name = \"tip\" }, { name = \"root\" }]", 13, &["`appendage[0].modes[0].shapes` must have a shape at each point, and `root` is missing"]),
    ("frequency = 2.0", "frequency = 0.0", 13, &["`appendage[0].modes[0].frequency`", "must be a natural frequency"]),
    ("[law.pd]", "[[appendage]]\nname = \"panel\"\nmass = 1\n[law.pd]", 16, &["`appendage[1].name` must differ from the other names, got `panel` again"]),
    ("[law.pd]", "[body.planar]\n[law.pd]", 2, &["`spacecraft` is itself a body: leave out `body`"]),
    ("modes = [", "plate = \"z\"\nmodes = [", 12, &["`appendage[0].plate`", "`x`"]),
];

#[test]
fn impossible_spacecraft_are_refused() {
    let dir = Dir::new();
    for (from, to, line, words) in CASES {
        assert!(ONE.contains(from), "{from}");
        dir.write("bad.toml", ONE.replacen(from, to, 1));
        let place = format!("bad.toml:{line}:");
        dir.run("check bad.toml").exits(2).says(&[&place]).says(words);
    }
    let alone = "duration = 1\n[body.planar]\n[[appendage]]\nname = \"a\"\nmass = 1\n";
    dir.write("alone.toml", alone);
    dir.run("check alone.toml").exits(2).says(&["`appendage` is clamped to the hub of a `[spacecraft]`"]);
    dir.write(
        "file.toml",
        ONE.split("modes = [").next().expect("a part").to_owned()
            + "modes = \"none.csv\"\n[law.pd]\nk_p = 1\nk_d = 1\nperiod = 1\n",
    );
    dir.run("check file.toml").exits(2).says(&["`appendage[0].modes` cannot be used", "none.csv"]);
    dir.write("one.toml", ONE);
    dir.run("cycle one.toml").exits(2).says(&["spacecraft: turns about three axes"]);
}

/// Equal appendages share a file of modes: points of the file have the names of those of the appendage.
#[test]
fn equal_appendages_share_a_file_with_points() {
    let dir = Dir::new();
    dir.write(
        "wing.csv",
        "frequency,damping,tx,ty,tz,rx,ry,rz,tip.tx,tip.ty,tip.tz,tip.rx,tip.ry,tip.rz\n2.0,0.005,0,0,3.5,9.0,0,0,0,0,0.4,0.15,0,0\n",
    );
    let wing = |name: &str, point: &str, at: f64| {
        format!(
            "[[appendage]]\nname = \"{name}\"\nmass = 20.0\ncentre = [0, 2, 0]\ninertia = [[30, 0, 0], [0, 3, 0], [0, 0, 33]]\nat = [0, {at}, 0]\n\
             points = [{{ name = \"{point}\", position = [0, 4, 0] }}]\nmodes = \"wing.csv\"\n"
        )
    };
    let hub = "duration = 1.0\nlaw.attitude = { period = 0.5, bandwidth = 0.01 }\n[spacecraft]\nmass = 400.0\ninertia = [[300, 0, 0], [0, 200, 0], [0, 0, 250]]\n";
    let both = |second: &str| format!("{hub}{}{}", wing("north", "tip", 1.0), wing("south", second, -1.0));
    dir.write("shared.toml", both("south tip"));
    let json = dir.run("modes shared.toml --json").exits(0).json();
    let points: Vec<_> = json["points"].as_array().expect("points").iter().map(|of| &of["point"]).collect();
    assert_eq!(points, ["hub", "tip", "south tip"]);
    for point in 1..3 {
        let largest = json["points"][point]["influences"][0].as_array().expect("modes").iter();
        assert!(largest.filter_map(serde_json::Value::as_f64).any(|part| part.abs() > 0.1), "{json}");
    }
    dir.run("simulate shared.toml --log none --runs 2 --set duration=1").exits(0);
    dir.write("other.toml", both("north tip"));
    dir.run("check other.toml").exits(2).says(&["shapes.tip` must be at one of the appendage's `points`"]);
}

/// Wheels that spin with more inertia than the hub has leave no spacecraft.
#[test]
fn rotors_are_part_of_the_hub() {
    let scenario = reference(&[]).expect("valid");
    let hub = scenario.spacecraft.as_ref().expect("a hub");
    let heavy = [HubRotor { axis: Vector::z(), spin_inertia: 400.0 }];
    let fault =
        AssembledSpacecraft::assemble(hub, &scenario.appendage, &[0.0; 2], &heavy).expect_err("impossible");
    assert_eq!(fault.key, "spacecraft.inertia");
}
