//! Summaries of runs and modes: digits, units, and nothing that does not apply.

use std::fmt::Write as _;

use crate::frozen::is_frozen;
use crate::util::Dir;

fn summary(name: &str, more: &str) -> String {
    let dir = Dir::with(&[name]);
    dir.run(&format!("simulate {name}.toml --log none {more}")).exits(0).err
}

fn holds(text: &str, words: &[&str], without: &[&str]) {
    for word in words {
        assert!(text.contains(word), "no `{word}` in\n{text}");
    }
    for word in without {
        assert!(!text.contains(word), "`{word}` in\n{text}");
    }
}

#[test]
fn summaries_hold_what_applies_to_the_run() {
    holds(
        &summary("half-turn", "--all"),
        &["over the whole run", "slew ", "rms from "],
        &["last 200 s", "wheels", "propellant"],
    );
    holds(
        &summary("wheel-ekf", "--all"),
        &["per state", "from 30 to 200 s", "95 % of", "Hz rms"],
        &["after the manoeuvre", "but for", "off the goal"],
    );
    // Its frequencies are known.
    holds(&summary("slew-wheel-lqg", ""), &["manoeuvre   30 deg in 60 s"], &["frequency"]);
    holds(
        &summary("thruster-phase-plane", ""),
        &["at most 10 N m; the law asks for up to 40.0 N m"],
        &["manoeuvre"],
    );
    holds(
        &summary("iss-ringdown", "--all"),
        &["Hz (identified / true)", "active damping   on in"],
        &["as estimated"],
    );
    // What an adaptation tunes has the unit of its key.
    holds(
        &summary("adaptive-bandwidth", "--set duration=1000"),
        &["bandwidth   0.0200 -> ", " rad/s, not frozen", "objective   pointing error rms "],
        &[],
    );
    holds(
        &summary("wheels-and-jets", ""),
        &["propellant   0.369 g, all yaw; 106 pulses\n"],
        &["in 106 cycles"],
    );
    holds(
        &summary("relay-fixed", ""),
        &["period 44.1 s, stable: deviations shrink to 0.795 in a period"],
        &["largest multiplier"],
    );
}

#[test]
fn units_are_those_that_are_asked_for() {
    holds(&summary("earth-observer", "--all"), &["arcsec", "rpm", " nJ"], &["e-"]);
    holds(&summary("earth-observer", "--units si"), &["rad/s", "e-"], &["arcsec", "rpm", "deg"]);
    let dir = Dir::with(&["earth-observer"]);
    dir.run("modes earth-observer.toml").exits(0).says(&["Hz"]);
    dir.run("modes earth-observer.toml --units si").exits(0).says(&["rad/s"]);
    dir.run("modes earth-observer.toml --units mHz").exits(0).says(&["mHz"]);
    dir.run("modes earth-observer.toml --units feet").exits(2).says(&["feet", "engineering", "si"]);
}

#[test]
fn analyses_print_the_units_that_are_asked_for() {
    let dir = Dir::with(&["rotation-sine", "relay-fixed", "wheel-fixed-gain", "wheel-scheduled-gain"]);
    let (map, tune) = ("--frequency 0.5:2:2 --period 0.1:1:2", "--frequency 0.2:0.3:2 --gain 0:2:3");
    let verbs = [
        "plan rotation-sine.toml".to_owned(),
        "plan rotation-sine.toml --compare".to_owned(),
        "cycle relay-fixed.toml".to_owned(),
        format!("tune wheel-scheduled-gain.toml {tune}"),
        format!("map wheel-fixed-gain.toml {map}"),
    ];
    let mut text = String::new();
    for verb in verbs {
        let plain = dir.run(&verb).exits(0);
        holds(&plain.err, &[], &["1.571 rad", " rad/s "]);
        let other = dir.run(&format!("{verb} --units si")).exits(0);
        holds(&other.err, &[], &["90 deg", "deg/s", "arcsec", "Hz", "kN", "µ"]);
        // The table of a comparison ends in digits of rounding.
        if !verb.ends_with("--compare") {
            writeln!(text, "### {verb}\n{}\n### {verb} --units si\n{}", plain.err, other.err)
                .expect("memory");
        }
        // The table of a map is in SI units always.
        assert_eq!(plain.out, other.out, "{verb}");
        let json = |units: &str| dir.run(&format!("{verb} --json --units {units}")).printed();
        assert_eq!(json("engineering"), json("si"), "{verb}");
        dir.run(&format!("{verb} --units feet")).exits(2).says(&["feet", "engineering", "si"]);
    }
    is_frozen("analyses", &text);
    let schedule = |units: &str| {
        let tune = format!("tune wheel-scheduled-gain.toml {tune} --schedule --units {units}");
        dir.run(&tune).printed()
    };
    assert_eq!(schedule("engineering"), schedule("si"));
}

/// Columns stay apart whatever the size of the numbers.
#[test]
fn tables_of_modes_keep_their_columns_apart() {
    let heavy = "duration = 10\n[spacecraft]\nmass = 3000.0\ninertia = [[3500, 0, 0], [0, 2800, 0], [0, 0, 4000]]\n\
        [[appendage]]\nname = \"wing\"\nmass = 187.5\ncentre = [12.5, 0, 0]\n\
        inertia = [[9.0, 0, 0], [0, 9766, 0], [0, 0, 9775]]\nat = [0, 1.2, 0]\n\
        modes = [{ frequency = 0.5, damping = 0.005, translation = [0, 0, 10.0], rotation = [0, -190.0, 0] }]\n\
        [law.pd]\nk_p = 1.0\nk_d = 10.0\nperiod = 0.5\n";
    let dir = Dir::holding("a.toml", heavy);
    let reported = dir.run("modes a.toml").exits(0).err;
    let row = reported.lines().find(|line| line.contains("wing, without first moments")).expect("a mode");
    // Mode, frequency, period, damping, three masses, three inertias, and four words of the appendage.
    assert_eq!(row.split_whitespace().count(), 14, "{reported}");
    let damped = dir.run("damping --frequency 0.1:100000:3 --acceleration 0.1 --period 1e-6").exits(0).err;
    for row in damped.lines().skip(3) {
        assert_eq!(row.split_whitespace().count(), 9, "{damped}");
    }
}

/// A spacecraft without appendages has no modes, and no tables of them.
#[test]
fn modes_of_a_rigid_spacecraft_have_no_empty_tables() {
    let dir = Dir::with(&["detumble-and-point"]);
    let reported = dir.run("modes detumble-and-point.toml").exits(0).err;
    holds(
        &reported,
        &["centre of mass", "acceleration of the hub"],
        &["influence", "clamped", "hub free", "period, s"],
    );
}

#[test]
fn a_log_of_other_settings_is_refused_in_plain_words() {
    let dir = Dir::with(&["wheel-ekf"]);
    dir.run("simulate wheel-ekf.toml").exits(0);
    let other = "simulate wheel-ekf.toml --set sensor.sampled.faults=[{stuck={from=60}}]";
    let reported = dir.run(other).exits(2).err;
    holds(
        &reported,
        &["holds a run with other settings (`sensor.sampled.faults`: added)"],
        &["a longer value"],
    );
}

#[test]
fn a_check_estimates_the_time() {
    let dir = Dir::with(&["earth-observer"]);
    dir.run("check earth-observer.toml").exits(0).says(&["accepted", "a run takes about", "ms on one core"]);
    let object = dir.run("check earth-observer.toml --json").exits(0).json();
    assert!(object["estimate_s"].as_f64().expect("a time") > 0.0);
}

/// A drift couples the modes: 1.8e10 s take days, and are not begun without a yes.
#[cfg(target_os = "linux")]
#[test]
fn a_run_of_days_needs_a_yes() {
    let dir = Dir::with(&["wheel-fast-mode"]);
    let reported =
        dir.run_bounded("simulate wheel-fast-mode.toml --log none --set duration=1.8e10").exits(2).err;
    holds(&reported, &["must be confirmed", "--yes"], &[]);
}
