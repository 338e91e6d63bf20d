//! Figures of verbs: their options, and axes in the units of readers.

use crate::drawing::{Drawing, RED};
use crate::util::Dir;

/// Draws the figures of a verb.
fn draw(dir: &Dir, line: &str) {
    dir.run(&format!("{line} -o figures --format svg")).exits(0);
}

#[test]
#[cfg_attr(not(feature = "full"), ignore = "not in a light build")]
fn axes_have_the_units_of_readers() {
    let dir = Dir::with(&[
        "earth-observer",
        "wheel-run-up",
        "slew-wheel-lqg",
        "wheel-settling-fit",
        "rotation-sine",
        "bounded-jitter",
    ]);
    dir.run("simulate slew-wheel-lqg.toml --runs 4 --log none -o campaign").exits(3);
    let sweep = "--vary law.attitude.bandwidth=0.1:0.2:2 --vary law.attitude.damping=0.6:0.8:2";
    dir.run(&format!("sweep earth-observer.toml {sweep} -o sweep")).exits(0);
    for (line, code) in [
        ("margins earth-observer.toml -o figures", 0),
        ("spectrum earth-observer.toml -o figures", 0),
        ("spectrum wheel-run-up.toml --window 0.02 -o figures", 0),
        ("worst slew-wheel-lqg.toml -o figures", 0),
        ("budget slew-wheel-lqg.toml --runs 4 -o figures", 3),
        ("tune earth-observer.toml --vary law.attitude.bandwidth=0.05:0.3 -o figures", 0),
        ("map wheel-settling-fit.toml --frequency 0.1:0.4:4 --period 0.1:1:4 --figures figures", 0),
        ("plan rotation-sine.toml -o figures", 0),
        ("damping --frequency 0.5:8:16 --acceleration 5.9e-5 --delay 0.2 -o figures", 0),
        ("observer --frequency 1.2566 -o figures", 0),
        ("identify --modes 1.556:2.89 --off 0.1 --runs 4 -o figures", 0),
        ("bound bounded-jitter.toml -o figures", 0),
        ("plot campaign -o figures", 0),
        ("plot sweep -o figures", 0),
    ] {
        let _ = std::fs::remove_dir_all(dir.path("figures"));
        dir.run(&format!("{line} --format svg")).exits(code);
        let names = dir.names("figures");
        assert!(!names.is_empty(), "{line}");
        for name in names {
            for text in Drawing::at(&dir, &format!("figures/{name}")).texts() {
                // A frequency that a file has as a number is in rad/s.
                let is_key =
                    ["bandwidth (rad/s)", "].frequency (rad/s)"].iter().any(|end| text.ends_with(end));
                let unit = if is_key { "" } else { &text }.split_once('(').map_or("", |(_, unit)| unit);
                assert!(!unit.contains("rad"), "{line}, {name}: {text}");
            }
        }
    }
}

#[test]
fn figures_are_chosen_by_name_and_have_a_size_and_a_title() {
    let dir = Dir::with(&["earth-observer"]);
    draw(&dir, "margins earth-observer.toml --what bode,root-locus --width 85 --font 7 --title Loop");
    assert_eq!(dir.names("figures"), ["earth-observer-bode.svg", "earth-observer-root-locus.svg"]);
    let bode = Drawing::read(&dir, "earth-observer-bode");
    assert!(bode.0.starts_with("<svg width=\"85.000mm\""), "{}", &bode.0[..80]);
    // With two samples of the law in a period, the margins are those of `flexsc margins`.
    let margins = ["+21.3 dB at 1.34 Hz", "67.9 deg at 0.0269 Hz"];
    bode.shows(&["Loop", "frequency (Hz)", "magnitude (dB)", margins[0], margins[1]]);
    dir.run("margins earth-observer.toml --what boden -o figures")
        .exits(2)
        .says(&["no figure `boden`", "bode, nichols, nyquist, singular-values, root-locus"]);
    for option in ["--what bode", "--width 85", "--font 7", "--title Loop"] {
        dir.run(&format!("margins earth-observer.toml {option}"))
            .exits(2)
            .says(&["no figure is drawn", "-o"]);
    }
    dir.run("margins earth-observer.toml --width 2 -o figures").exits(2).says(&["30 to 400 mm"]);
}

#[test]
fn axes_have_the_units_that_are_asked_for() {
    let dir = Dir::with(&["earth-observer", "relay-fixed"]);
    dir.run("simulate earth-observer.toml --log full -o run.mcap").exits(0);
    // A rate of the body is not a speed of a wheel.
    dir.run("plot run.mcap --what wheel,rates -o figures --format svg --units mrad,rpm,min").exits(0);
    Drawing::read(&dir, "run-wheel").shows(&["wheel speed (rpm)", "pointing error (mrad)", "time (min)"]);
    Drawing::read(&dir, "run-rates").shows(&["roll (deg/s)", "time (min)"]);
    dir.run("plot run.mcap --what rates -o figures --format svg --units si").exits(0);
    Drawing::read(&dir, "run-rates").shows(&["roll (rad/s)", "time (s)"]);
    draw(&dir, "margins earth-observer.toml --what singular-values --units mHz");
    Drawing::read(&dir, "earth-observer-singular-values").shows(&["frequency (mHz)"]);
    // A text has them too, and a key that of the file.
    let tune = "tune earth-observer.toml --nominal --vary law.attitude.bandwidth=0.05:0.3";
    dir.run(tune).exits(0).says(&["law.attitude.bandwidth  0.1 rad/s"]);
    dir.run(&format!("{tune} --units mHz")).exits(0).says(&["law.attitude.bandwidth  15.92 mHz"]);
    let written = format!("{tune} --set law.attitude.bandwidth=0.02Hz");
    dir.run(&written).exits(0).says(&["law.attitude.bandwidth  0.02 Hz"]);
    dir.run(&format!("{tune} --units parsec"))
        .exits(2)
        .says(&["`parsec` is not a unit", "`engineering`, `si` or units"]);
    let line = "plot run.mcap --what rates -o figures --units deg,mN";
    dir.run(line).exits(2).says(&["no axis can be in `deg`", "hint: the axes are in s, deg/s"]);
}

#[test]
fn a_mask_is_drawn_and_kept_or_violated() {
    let dir = Dir::with(&["earth-observer"]);
    let line = "margins earth-observer.toml --what nichols -o figures --format svg --mask";
    dir.run(&format!("{line} 6dB,30deg")).exits(0).says(&["kept"]);
    let nichols = Drawing::read(&dir, "earth-observer-nichols");
    nichols.shows(&["mask 6 dB, 30 deg"]);
    assert!(!nichols.shapes("polygon", "fill", RED).is_empty());
    // The phase margin of about 60 deg is within 80 deg.
    dir.run(&format!("{line} 6dB,80deg")).exits(3).says(&["violated at", "within the mask"]);
    let json = dir.run("margins earth-observer.toml --json --mask 6dB,80deg").exits(3).json();
    assert_eq!(json["mask"]["met"], false);
    dir.run("margins earth-observer.toml --mask 6,30").exits(2).says(&["`6 dB, 30 deg`"]);
}
