//! `flexsc new --cubesat`: a scenario from size, mass, wheels and orbit, which is accepted, runs and varies.

use crate::util::Dir;

#[test]
fn a_cubesat_from_its_data() {
    let dir = Dir::new();
    dir.run("new mine --cubesat --size 12U --mass 20 --wheel-momentum 0.015 --altitude 5e5 --ltan 06:00")
        .exits(0)
        .says(&["flexsc simulate mine.toml"]);
    let text = dir.text("mine.toml");
    for line in
        ["A CubeSat of 12U and 20 kg", "altitude = \"500 km\", ltan = \"06:00\"", "momentum = \"15 mN m s\""]
    {
        assert!(text.contains(line), "{line}: {text}");
    }
    // By hand: two wings of 4.5 kg/m² and 0.1118 m² leave a box of 18.99 kg, 0.366 x 0.2263 x 0.2263 m: m (y² + z²)/12.
    assert!(text.contains("inertia = [[0.162,") && text.contains("mass = 19 "), "{text}");
    let ran = dir.run("check mine.toml").exits(0);
    assert!(!ran.err.contains("are not accepted"), "{}", ran.err);
    dir.run("simulate mine.toml --set duration=100 --set requirement=[] --runs 2").exits(0);
    dir.run("new mine --cubesat").exits(2).says(&["already exists"]);
}

#[test]
fn a_cubesat_that_cannot_be_is_refused() {
    let dir = Dir::new();
    for (options, told) in [
        ("--cubesat --size 7", "must be 1, 2, 3, 6, 12, 16 or 27 units, got `7`"),
        ("--cubesat --mass=-2", "--mass must be above 0"),
        ("--cubesat --altitude 525", "must be from 150 km to 2000 km, got 525 m"),
        ("--cubesat --ltan 25:00", "\"10:30\""),
        ("--cubesat --ltan noon", "\"10:30\""),
        ("--cubesat --like half-turn", "cannot be used with"),
        ("--mass 2", "--cubesat"),
    ] {
        dir.run(&format!("new mine {options}")).exits(2).says(&[told]);
        assert!(!dir.path("mine.toml").exists(), "{options}");
    }
}
