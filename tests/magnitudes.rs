//! Numbers without a unit that nobody means: an error where they are impossible, a remark of `check` where they are absurd.

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
        (0..).map(|index| scenario.sensor_key(index)).find(|key| key.ends_with(kind)).expect("a sensor")
    };
    let magnetometer = sensor("magnetometer");
    for (name, set, remark) in [
        ("cubesat-day", format!("{magnetometer}.noise=50"), format!("{magnetometer}.noise` is 50 T: is it meant in another unit, such as \"50 nT\"?")),
        ("cubesat-day", format!("{}.angle_random_walk=0.15", sensor("gyro")), "\"0.15 deg/sqrt(h)\"".to_owned()),
        ("cubesat-day", "appendage[0].modes[0].damping=0.5".to_owned(), "appendage[0].modes[0].damping` is a ratio, and structures have 0.001 to 0.05: is 0.5 a percentage, which is written \"0.5 %\"?".to_owned()),
        ("cubesat-day", "requirement[1].limit=0.1".to_owned(), "requirement[1].limit` is 0.1 rad, 5.730 deg: is it meant in another unit, such as \"0.1 deg\"?".to_owned()),
        ("cubesat-day", "environment.orbit.inclination=97.4".to_owned(), "environment.orbit.inclination` is 97.4 rad: is it meant in another unit, such as \"97.4 deg\"?".to_owned()),
        ("cubesat-day", "environment.orbit.gravity=398600.4418".to_owned(), "environment.orbit.gravity` is that of a planet of 5.49e-6 kg/m³".to_owned()),
        ("cubesat-day", "spacecraft.inertia=[[300000,0,0],[0,300000,0],[0,0,300000]]".to_owned(), "spacecraft.inertia` is that of a mass of".to_owned()),
        ("cubesat-day", "spacecraft.rate=[0,20,0]".to_owned(), "spacecraft.rate[1]` is 20 rad/s: is it meant in another unit, such as \"20 deg/s\"?".to_owned()),
        ("earth-observer", "actuator.wheels.momentum=3000".to_owned(), "actuator.wheels.momentum` is that of a wheel at 7.162e5 rpm, with its inertia of 0.04 kg m²: is it meant as \"3000 mN m s\"?".to_owned()),
        ("earth-observer", "actuator.wheels.speed_limit=60000".to_owned(), "actuator.wheels.speed_limit` is 60000 rad/s: is it meant in another unit, such as \"60000 rpm\"?".to_owned()),
        ("earth-observer", "appendage[1].at=[0,1500,0]".to_owned(), "appendage[1].at[1]` is 1500 m: is it meant in another unit, such as \"1500 mm\"?".to_owned()),
    ] {
        let found = dir.run(&format!("check {name}.toml --set {set}"));
        assert!(found.err.contains(&remark), "{set}: {}", found.err);
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
