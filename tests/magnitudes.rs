//! Numbers in another unit than that of their key: an error where they are impossible, a remark of `check` where they are absurd.

use std::fs;

use flexsc_core::Scenario;

use crate::util::{Dir, SCENARIOS};

#[test]
fn places_beyond_the_poles_are_refused() {
    let dir = Dir::with(&["ground-pass"]);
    let site = "target[1].primary.along.site";
    for (key, value, words) in [
        ("latitude", "67.9", ["a latitude of -pi/2 to pi/2 rad", "\"67.9 deg\", got 67.9"]),
        ("longitude", "21.1", ["a longitude of -2 pi to 2 pi rad", "\"21.1 deg\", got 21.1"]),
    ] {
        dir.run(&format!("check ground-pass.toml --set {site}.{key}={value}"))
            .exits(2)
            .says(&[key, words[0], words[1]]);
        let text = dir.text("ground-pass.toml").replace(&format!("{key} = 0."), &format!("{key} = {value}0"));
        dir.write("far.toml", text);
        dir.run("check far.toml").exits(2).says(&["far.toml:", key, words[0]]);
    }
    dir.run(&format!("check ground-pass.toml --set {site}.latitude=0.8 --set {site}.longitude=-6.2"))
        .exits(0);
}

/// Each key with a number that is meant in another unit, and the unit that is proposed.
#[test]
fn numbers_that_are_meant_in_another_unit_are_remarked() {
    let dir = Dir::with(&["cubesat-day", "earth-observer"]);
    let sensor = |kind: &str| {
        let scenario = Scenario::load(&dir.path("cubesat-day.toml")).expect("shipped");
        (0..20).map(|index| scenario.sensor_key(index)).find(|key| key.ends_with(kind)).expect("a sensor")
    };
    let [field, gyro] = ["magnetometer", "gyro"].map(sensor);
    for (name, set, remark) in [
        (
            "cubesat-day",
            format!("{field}.noise=50"),
            "noise` is 50 T: is it meant in another unit, such as \"50 nT\"?",
        ),
        ("cubesat-day", format!("{gyro}.angle_random_walk=0.15"), "\"0.15 deg/sqrt(h)\""),
        ("cubesat-day", "appendage[0].modes[0].damping=0.5".to_owned(), "written \"0.5 %\"?"),
        ("cubesat-day", "requirement[1].limit=0.1".to_owned(), "limit` is 0.1 rad, 5.730 deg"),
        ("cubesat-day", "environment.orbit.inclination=97.4".to_owned(), "such as \"97.4 deg\"?"),
        ("cubesat-day", "environment.orbit.gravity=398600.4418".to_owned(), "planet of 5.49e-6 kg/m³"),
        (
            "cubesat-day",
            "spacecraft.inertia=[[3e5,0,0],[0,3e5,0],[0,0,3e5]]".to_owned(),
            "inertia` is that of a mass",
        ),
        (
            "earth-observer",
            "actuator.wheels.momentum=3000".to_owned(),
            "a wheel at 7.162e5 rpm, with its inertia of 0.04",
        ),
        ("earth-observer", "actuator.wheels.speed_limit=60000".to_owned(), "such as \"60000 rpm\"?"),
        ("earth-observer", "appendage[1].at=[0,500,0]".to_owned(), "at[1]` is 500 m: is it meant"),
    ] {
        let key = set.split('=').next().unwrap_or_default();
        let found = dir.run(&format!("check {name}.toml --set {set}"));
        assert!(found.err.contains(remark), "{set}: {}", found.err);
        assert!(found.err.contains(&format!("remark: `{key}")), "{set}: {}", found.err);
    }
    // A mode that takes part in nothing.
    let text =
        dir.text("cubesat-day.toml").replacen("translation = [0, 0, 0.96], rotation = [0.348, 0, 0]", "", 1);
    dir.write("apart.toml", text.replacen("damping = 0.01,  }", "damping = 0.01 }", 1));
    dir.run("check apart.toml")
        .exits(0)
        .says(&["remark: `appendage[0].modes[0]` takes part in no translation and no rotation"]);
}

#[test]
fn shipped_scenarios_have_no_remark() {
    let mut count = 0;
    for entry in fs::read_dir(SCENARIOS).expect("a directory").flatten() {
        let path = entry.path();
        if path.extension().is_some_and(|extension| extension == "toml") {
            let remarks = Scenario::load(&path).expect("shipped").remarks();
            let told: Vec<String> = remarks.iter().map(ToString::to_string).collect();
            assert!(told.is_empty(), "{}: {told:?}", path.display());
            count += 1;
        }
    }
    assert!(count > 60, "{count}");
}
