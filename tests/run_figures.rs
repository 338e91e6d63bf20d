//! Figures of runs as a review document shows them: units of readers, strips of events, limits of requirements, no empty
//! panel, and two logs over each other.

use crate::drawing::{Drawing, RED, near};
use crate::util::Dir;

#[test]
fn a_requirement_is_a_red_line_over_its_window_in_its_unit() {
    let dir = Dir::with(&["earth-observer"]);
    let scenario = dir.text("earth-observer.toml")
        + "\n[[requirement]]\nname = \"quiet\"\nquantity = \"pointing_error\"\nfrom = 220\nlimit = \"0.01 deg\"\n\
           level = 0.95\ninterpretation = \"temporal\"\n";
    dir.write("a.toml", scenario);
    dir.run("simulate a.toml --log full");
    dir.run("plot a.mcap --what pointing --format svg -o figures").exits(0);
    let pointing = Drawing::read(&dir, "a-pointing");
    pointing.shows(&["pointing error (deg)", "quiet: 0.01 deg, 95 % of the time", "time (s)"]);
    let lines = pointing.shapes("polyline", "stroke", RED);
    let [line] = &lines[..] else { panic!("{lines:?}") };
    let times: Vec<f64> = line.iter().map(|(x, _)| pointing.across(*x, ["0", "300"])).collect();
    near(times[0], 220.0, 0.5);
    near(times[times.len() - 1], 300.0, 0.5);
    // The axis is logarithmic: 0.01 is where its number is.
    near(line[0].1, pointing.number("0.01").1, 60.0);
    // 57.6 arcsec are 0.0160 deg.
    assert!(pointing.texts().iter().any(|text| text.starts_with("0.0160 deg at 194 s")));
    // About each axis there are three panels, and no limit of the norm.
    dir.run("plot a.mcap --what pointing --axes --format svg -o figures").exits(0);
    let axes = Drawing::read(&dir, "a-pointing");
    axes.shows(&["roll (arcsec)", "pitch (arcsec)", "yaw (arcsec)"]);
    assert!(axes.shapes("polyline", "stroke", RED).is_empty());
}

#[test]
fn events_are_strips_above_the_axes() {
    let dir = Dir::with(&["safe-mode"]);
    dir.run("simulate safe-mode.toml --set duration=7000 --log full").exits(0);
    dir.run("plot safe-mode.mcap --what rates,pointing --from 1000 --format svg -o figures").exits(0);
    for what in ["rates", "pointing"] {
        let drawing = Drawing::read(&dir, &format!("safe-mode-{what}"));
        drawing.shows(&["mode", "eclipse", "failure"]);
        // The failure of the star tracker: from 5800 to 6400 s.
        let strip = drawing.shapes("polygon", "fill", "#E69F00");
        let wide = |points: &Vec<(f64, f64)>| points.iter().map(|point| point.0).fold(0.0, f64::max);
        let bar = strip.iter().max_by(|a, b| wide(a).total_cmp(&wide(b))).expect("a bar");
        let times: Vec<f64> = bar.iter().map(|(x, _)| drawing.across(*x, ["2000", "6000"])).collect();
        assert!(times.iter().all(|time| (1000.0..=7000.0).contains(time)), "{times:?}");
        // No tint behind the curves: all polygons are above the first axis.
        let plot = drawing.shapes("polyline", "stroke", "#787878");
        let top = plot.iter().filter(|line| line.len() == 5).flatten().map(|point| point.1);
        let top = top.fold(f64::INFINITY, f64::min);
        assert!(bar.iter().all(|(_, y)| *y < top), "{bar:?} {top}");
    }
}

#[test]
fn wheels_are_in_rpm_and_a_far_limit_is_words() {
    let dir = Dir::with(&["earth-observer"]);
    dir.run("simulate earth-observer.toml --set duration=60 --log full").exits(0);
    dir.run("plot earth-observer.mcap --what wheel --format svg -o figures").exits(0);
    let wheel = Drawing::read(&dir, "earth-observer-wheel");
    // 600 rad/s are 5730 rpm.
    wheel.shows(&["wheel speed (rpm)", "limit 5730 rpm", "wheel 1", "wheel 4", "pointing error (arcsec)"]);
    assert!(wheel.shapes("polyline", "stroke", RED).is_empty());
    dir.run("simulate earth-observer.toml --set duration=60 --set actuator.wheels.speed_limit=250 --log full --force")
        .exits(0);
    dir.run("plot earth-observer.mcap --what wheel --format svg -o figures").exits(0);
    let wheel = Drawing::read(&dir, "earth-observer-wheel");
    wheel.shows(&["limit 2387 rpm"]);
    assert_eq!(wheel.shapes("polyline", "stroke", RED).len(), 2);
}

#[test]
fn two_logs_have_a_colour_each_and_their_difference() {
    let dir = Dir::with(&["earth-observer"]);
    for (name, seed) in [("a", 1), ("b", 2)] {
        let options = format!("--set duration=60 --seed {seed} --log full -o {name}.mcap");
        dir.run(&format!("simulate earth-observer.toml {options}")).exits(0);
    }
    dir.run("plot a.mcap b.mcap --what pointing --format svg -o figures").exits(0);
    let both = Drawing::read(&dir, "a-pointing");
    both.shows(&["a", "b", "b − a (arcsec)", "pointing error (arcsec)"]);
    assert_eq!(both.texts().iter().filter(|text| *text == "b").count(), 2, "once in the legend");
}

#[test]
fn time_is_in_seconds_up_to_two_hours() {
    let dir = Dir::with(&["magnetic-unloading"]);
    dir.run("simulate magnetic-unloading.toml --log full").exits(0);
    dir.run("plot magnetic-unloading.mcap --what pointing --format svg -o figures").exits(0);
    Drawing::read(&dir, "magnetic-unloading-pointing").shows(&["time (h)"]);
    dir.run("plot magnetic-unloading.mcap --what pointing --from 10000 --to 17000 --format svg -o figures")
        .exits(0);
    Drawing::read(&dir, "magnetic-unloading-pointing").shows(&["time (s)", "12\u{202f}000"]);
}
