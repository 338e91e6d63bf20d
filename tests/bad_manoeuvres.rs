//! Manoeuvres that cannot be planned: each is refused with one error at its key.

use crate::spacecraft::{text, with};
use crate::util::Dir;

/// A good manoeuvre, of which one key is set otherwise: the key, its value, the key that the error names, and words that
/// it holds.
type Case = (&'static str, &'static str, &'static str, &'static [&'static str]);

#[rustfmt::skip] // One case a line.
const CASES: &[Case] = &[
    ("manoeuvre.time", "0.0", "", &["must be a time of 1e-15 s", "got 0"]),
    ("manoeuvre.time", "-12.0", "", &["must be a time of 1e-15 s", "got -12"]),
    ("manoeuvre.time", "nan", "", &["got NaN"]),
    ("manoeuvre.angle", "inf", "", &["must be a finite number", "got inf"]),
    ("manoeuvre.angle", "0.0", "manoeuvre.angle", &["must not be 0", "rates before and after are the same"]),
    ("manoeuvre.start_rate", "0.1", "manoeuvre.start_rate", &["must be the body's rate at the start, 0", "got 0.1"]),
    ("manoeuvre.peak_torque", "521.08", "manoeuvre.peak_torque", &["must be at least 718.275171 N m", "got 521.08", "it takes 14.278"]),
    ("manoeuvre.peak_torque", "0.0", "", &["must be a positive number", "got 0"]),
    ("manoeuvre.command.sine.suppress", "5", "manoeuvre.command.sine.suppress", &["at most the number of the body's modes, 4", "got 5"]),
    ("manoeuvre.command.sine.suppress", "-1", "", &["-1"]),
    ("manoeuvre.command.sine.zeros", "[{ mode = 4 }]", "manoeuvre.command.sine.zeros[0].mode", &["must be the index of a mode, 0 to 3", "got 4"]),
    ("manoeuvre.command.sine.zeros", "[{ mode = 0, shift = -1.0 }]", "manoeuvre.command.sine.zeros[0].shift", &["must be above -1", "got -1"]),
    ("manoeuvre.command.sine.zeros", "[{ mode = 0, times = 0 }]", "manoeuvre.command.sine.zeros[0].times", &["must be 1 or more", "got 0"]),
    ("manoeuvre.command.sine.zeros", "[{ mode = 0, times = 4000000000 }]", "manoeuvre.command.sine.zeros", &["at most 40 zeros", "got 4000000002"]),
    ("manoeuvre.command.sine.zeros", "[{ mode = 0, tims = 2 }]", "", &["tims"]),
    ("manoeuvre.command", "{ polynomial = { degree = 4 } }", "manoeuvre.command.polynomial.degree", &["must be 3, 5, 7, 9, 11 or 13", "got 4"]),
    ("manoeuvre.command", "{ minimum_peak = { suppress = 9 } }", "manoeuvre.command.minimum_peak.suppress", &["number of the body's modes, 4", "got 9"]),
    ("manoeuvre.command", "{ tangent = {} }", "", &["tangent"]),
    ("manoeuvre.shaper", "{ zv = { modes = [0, 4] } }", "manoeuvre.shaper.zv.modes[1]", &["must be the index of a mode, 0 to 3", "got 4"]),
    ("manoeuvre.shaper", "{ zvd = { modes = [] } }", "manoeuvre.shaper.zvd.modes", &["must hold the index of a mode", "got none"]),
    ("manoeuvre.shaper", "{ ei = { vibration = 1.0 } }", "", &["must be a number between 0 and 1", "got 1"]),
    ("body.planar.modes[1].damping", "1.0", "manoeuvre.command", &["needs modes that oscillate", "damping of mode 1 is 1"]),
    ("body.planar.modes", "[]", "manoeuvre.command.sine.suppress", &["number of the body's modes, 0", "got 2"]),
];

const GOOD: &str = "angle = 1.5707963267948966\ntime = 12.0\n[manoeuvre.command]\nsine = { suppress = 2 }";

#[test]
fn what_cannot_be_planned() {
    for (key, value, named, words) in CASES {
        let mut set = vec![(*key, (*value).to_owned())];
        if *key == "body.planar.modes" {
            set.push(("body.planar.outputs", "[]".to_owned()));
        }
        let error = with(&text("torque", 0.0, GOOD), &set).expect_err(value).to_string();
        for word in words.iter().chain([named]) {
            assert!(error.contains(word), "{key} = {value}: no `{word}` in {error}");
        }
        for jargon in ["u32", "usize", "struct", "variant"] {
            assert!(!error.contains(jargon), "{key} = {value}: {error}");
        }
    }
}

#[test]
fn what_is_impossible_in_its_time() {
    let refused =
        |manoeuvre: &str| with(&text("torque", 0.0, manoeuvre), &[]).expect_err(manoeuvre).to_string();
    let command = "[manoeuvre.command]\nbang_bang = {}\n";
    let error = refused(&format!("angle = 1.0\n{command}"));
    assert!(error.contains("`manoeuvre` needs a `time`, a `peak_torque` or both"), "{error}");
    let error = refused(&format!("angle = 1.0\ntime = 0.9\n{command}[manoeuvre.shaper]\nzv = {{}}"));
    assert!(error.contains("`manoeuvre.time` must be longer than the shaper, which takes 0.943"), "{error}");
    // Too little time for the modes: the constraints are dependent to rounding.
    for command in ["minimum_energy", "minimum_peak"] {
        let error = refused(&format!(
            "angle = 1.0\ntime = 1e-3\n[manoeuvre.command]\n{command} = {{ suppress = 4 }}"
        ));
        assert!(error.contains("`manoeuvre.time` must be longer"), "{error}");
    }
    let error = refused(
        "angle = 1.0\ntime = 1e-12\n[manoeuvre.command]\nsine = { zeros = [{ mode = 0, times = 40 }] }",
    );
    assert!(error.contains("`manoeuvre.time`"), "{error}");
}

#[test]
fn the_command_points_at_the_key() {
    let dir =
        Dir::holding("turn.toml", text("torque", 0.0, &GOOD.replace("12.0", "12.0\npeak_torque = 521.08")));
    let wanted = [
        "`manoeuvre.peak_torque` must be at least 718.275171 N m for a time of 12 s",
        "peak_torque = 521.08",
        "^^^^^^",
    ];
    dir.run("plan turn.toml").exits(2).says(&wanted);
    dir.run("check turn.toml").exits(2).says(&wanted[..1]);
    let bare = text("torque", 0.0, GOOD).split("[manoeuvre]").next().expect("a part").to_owned();
    dir.write("bare.toml", format!("{bare}\n[law.open]\n"));
    dir.run("plan bare.toml").exits(2).says(&["there is no `[manoeuvre]` to plan"]);
}
