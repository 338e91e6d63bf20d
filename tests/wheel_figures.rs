//! Figures of wheels, filters and sampled loops: the right curves at the right places.

use std::f64::consts::{PI, TAU};

use flexsc_core::record::Log;

use crate::drawing::{BLACK, BLUE, Drawing, Point, RED, SKY, VERMILLION, near};
use crate::util::Dir;
use crate::wheel::FITTED_OPTIONS;

#[test]
fn the_angle_is_drawn_with_its_band_and_when_it_has_settled() {
    let dir = Dir::with(&["wheel-scheduled-gain", "wheel-slow-mode"]);
    dir.run("simulate wheel-scheduled-gain.toml").exits(0);
    dir.run("plot wheel-scheduled-gain.mcap --format svg -o figures").exits(0);
    let names = ["angle", "extra", "modes", "torque"].map(|what| format!("wheel-scheduled-gain-{what}.svg"));
    assert_eq!(dir.names("figures"), names);
    let angle = Drawing::read(&dir, "wheel-scheduled-gain-angle");
    angle.shows(&["angle (deg)", "time (s)", "within ±0.172 deg", "settled at 180.4 s"]);
    let settled = angle.shapes("polyline", "stroke", VERMILLION);
    let times: Vec<f64> = settled.iter().flatten().map(|(x, _)| angle.across(*x, ["0", "600"])).collect();
    // One dash is the legend's.
    assert!(times.iter().filter(|t| (*t - 180.4).abs() < 0.1).count() > 40, "{times:?}");
    // 3 mrad up and down: 0.171887 deg.
    let band = &angle.shapes("polygon", "fill", "#009E73")[1];
    let heights = band.iter().map(|(_, y)| angle.up(*y, ["1", "3"]));
    near(heights.clone().fold(f64::INFINITY, f64::min), -0.171_887, 0.003);
    near(heights.fold(f64::NEG_INFINITY, f64::max), 0.171_887, 0.003);

    // A run that ends outside the band has not settled.
    dir.run("simulate wheel-slow-mode.toml --set duration=100").exits(0);
    dir.run("plot wheel-slow-mode.mcap --format svg --what angle -o figures").exits(0);
    let texts = Drawing::read(&dir, "wheel-slow-mode-angle").texts();
    assert!(!texts.iter().any(|text| text.contains("settled")), "{texts:?}");
}

#[test]
fn the_extra_gain_follows_the_frequency() {
    let dir = Dir::with(&["wheel-scheduled-gain"]);
    dir.run("simulate wheel-scheduled-gain.toml --set duration=250").exits(0);
    dir.run("plot wheel-scheduled-gain.mcap --format svg --what extra -o figures").exits(0);
    let extra = Drawing::read(&dir, "wheel-scheduled-gain-extra");
    extra.shows(&["gain k_d", "frequency read (Hz)"]);
    // 0.3 rad/s at the start, 0.2 after 99 s, 0.1 from 200 s on: gains 1.2, 0.025 and -0.775.
    let lines = extra.shapes("polyline", "stroke", BLUE);
    // The first is that of the legend.
    let gain = lines.iter().find(|line| line.len() > 2).expect("a line");
    for (t, k) in [(0.0, 1.2), (99.0, 0.0275), (225.0, -0.775)] {
        let at = gain.iter().min_by(|a, b| {
            let off = |p: &Point| (extra.across(p.0, ["0", "200"]) - t).abs();
            off(a).total_cmp(&off(b))
        });
        near(extra.up(at.expect("a point").1, ["−0.5", "1.0"]), k, 0.02);
    }
}

#[test]
fn filters_have_figures_from_events_and_from_full_logs() {
    let draw = |detail: &str| {
        let dir = Dir::with(&["wheel-settling-fit"]);
        dir.run(&format!("simulate wheel-settling-fit.toml --log {detail}")).exits(0);
        dir.run("plot wheel-settling-fit.mcap --format svg -o figures").exits(0);
        dir
    };
    let (events, full) = (draw("events"), draw("full"));
    let names =
        ["angle", "consistency", "estimate", "extra", "frequency", "modes", "torque", "wheel"].map(|what| {
            let name = format!("wheel-settling-fit-{what}");
            assert!(Drawing::read(&events, &name).0 == Drawing::read(&full, &name).0, "{what}");
            format!("{name}.svg")
        });
    assert_eq!(full.names("figures"), names);

    let frequency = Drawing::read(&full, "wheel-settling-fit-frequency");
    frequency.shows(&["± 2 standard deviations", "estimated", "true", "filter gated", "held for the law"]);
    frequency.shows(&["frequency (Hz)", "error (Hz)"]);
    let log = Log::open(&full.path("wheel-settling-fit.mcap")).expect("a log");
    let estimator = log.columns("/estimator").expect("a topic");
    let column = |name: &str| estimator.numbers(name).expect("a column");
    let lines = frequency.shapes("polyline", "stroke", BLUE);
    let estimated = lines.iter().filter(|line| line.len() > 100).min_by(|a, b| a[0].1.total_cmp(&b[0].1));
    let (x, y) = estimated.expect("a line")[0];
    near(frequency.across(x, ["0", "600"]), 0.0, 0.1);
    near(TAU * frequency.up(y, ["0.02", "0.04"]), column("frequency_rad_s")[0], 1e-3);
    // The band is four standard deviations wide: at the start 2 x 2 x 3 % of 0.3 rad/s.
    let band = &frequency.shapes("polygon", "fill", SKY)[1];
    let first = band.iter().filter(|p| p.0 < x + 1.0).map(|p| TAU * frequency.up(p.1, ["0.02", "0.04"]));
    let (low, high) = first.fold((1.0, 0.0), |(low, high): Point, f| (low.min(f), high.max(f)));
    near(high - low, 4.0 * column("frequency_sd_rad_s")[0], 1e-3);

    let consistency = Drawing::read(&full, "wheel-settling-fit-consistency");
    consistency.shows(&["NIS / measurements", "NEES / states", "mean of the last 50 samples"]);
    consistency.shows(&["95 % of chi-square, 50 samples", "95 % of chi-square, one sample"]);
    // 50 samples of one measurement: 32.36 to 71.42.
    let band = &consistency.shapes("polygon", "fill", "#009E73")[1];
    let heights: Vec<f64> = band.iter().map(|p| consistency.up(p.1, ["0.5", "1.0"])).collect();
    near(heights.iter().copied().fold(f64::INFINITY, f64::min), 0.6472, 5e-3);
    near(heights.iter().copied().fold(0.0, f64::max), 1.4284, 5e-3);
    // The last of them is the mean NIS of the last 50 samples.
    let nis = column("nis");
    let mean = nis[nis.len() - 50..].iter().sum::<f64>() / 50.0;
    let line = consistency.shapes("polyline", "stroke", BLUE);
    let line = line.iter().find(|line| line.len() > 100).expect("a line");
    near(consistency.up(line[line.len() - 1].1, ["0.5", "1.0"]), mean, 5e-3);

    // The error of the displacement is small beside the displacement.
    let estimate = Drawing::read(&full, "wheel-settling-fit-estimate");
    estimate.shows(&["displacement (deg)", "error (arcsec)", "estimated, as the law reads it", "true"]);
}

#[test]
fn a_filter_that_has_lost_the_body_is_marked() {
    let dir = Dir::with(&["wheel-ekf"]);
    let wrong = "--set estimator.extended_kalman.ratio=0.5 --set estimator.extended_kalman.ratio_sd=0.001";
    dir.run(&format!("simulate wheel-ekf.toml --set duration=100 {wrong}")).exits(0);
    dir.run("plot wheel-ekf.mcap --format svg --what frequency,consistency -o figures").exits(0);
    for what in ["frequency", "consistency"] {
        let drawing = Drawing::read(&dir, &format!("wheel-ekf-{what}"));
        drawing.shows(&["lock lost"]);
        assert!(!drawing.shapes("polygon", "fill", VERMILLION).is_empty(), "{what}");
    }
}

#[test]
fn a_wheel_is_drawn_with_its_limits() {
    let dir = Dir::with(&["wheel-fast-mode"]);
    let rotor = "--set actuator.wheel.rotor={inertia=1e-4,speed=10.0,speed_limit=40.0}";
    dir.run(&format!("simulate wheel-fast-mode.toml --set duration=60 {rotor}")).exits(0);
    dir.run("plot wheel-fast-mode.mcap --format svg --what wheel -o figures").exits(0);
    let wheel = Drawing::read(&dir, "wheel-fast-mode-wheel");
    wheel.shows(&["speed (rpm)", "limit 382 rpm"]);
    let (_, start) = wheel.line(BLUE)[0];
    near(wheel.up(start, ["−200", "200"]), 10.0 * 30.0 / PI, 2.0);
    let limits = wheel.shapes("polyline", "stroke", RED);
    let highest = limits.iter().flatten().map(|p| p.1);
    near(wheel.up(highest.fold(f64::INFINITY, f64::min), ["−200", "200"]), 40.0 * 30.0 / PI, 2.0);
    // A wheel without a rotor stores nothing.
    dir.run("simulate wheel-fast-mode.toml --set duration=10 --force").exits(0);
    dir.run("plot wheel-fast-mode.mcap --what wheel,frequency")
        .exits(2)
        .says(&["it has torque, angle, modes"]);
}

#[test]
#[cfg_attr(not(feature = "full"), ignore = "not in a light build")]
fn tuned_gains_are_drawn() {
    let dir = Dir::with(&["wheel-scheduled-gain"]);
    let options = "--frequency 0.2:0.3:2 --gain -2:4:121 --robust 0.1 --figures figures --format svg --json";
    dir.run(&format!(
        "tune wheel-scheduled-gain.toml {options} {FITTED_OPTIONS} --set sensor.sampled.period=0.3"
    ))
    .exits(0);
    let region = Drawing::read(&dir, "wheel-scheduled-gain-tune-region");
    region.shows(&["gain k_d of the extra loop", "frequency of the dominant mode (Hz)", "middle"]);
    region.shows(&["stable, settles within 200 s", "of the scenario", "robust against 10 %"]);
    // From -0.8 to 1 at 0.2 rad/s, from -0.9 to 3.7 at 0.3 rad/s.
    let corners = &region.shapes("polygon", "fill", SKY)[1];
    let found: Vec<f64> = corners.iter().map(|p| region.up(p.1, ["−1.0", "3.0"])).collect();
    assert!(found.len() >= 4, "{found:?}");
    for (found, exact) in found.iter().zip([-0.8, -0.9, 3.7, 1.0]) {
        near(*found, exact, 0.02);
    }
    let middle = region.shapes("polyline", "stroke", BLUE);
    // The first is the legend's.
    near(region.up(middle[1][0].1, ["−1.0", "3.0"]), 0.1, 0.02);
    let settling = Drawing::read(&dir, "wheel-scheduled-gain-tune-settling");
    settling.shows(&["settling time (s)", "at most 200 s", "without the extra loop", "the same, perturbed"]);
    let without = settling.shapes("polyline", "stroke", BLACK);
    near(settling.up(without[1][0].1, ["20", "160"]), 180.3, 0.5);

    // A region that ends at the highest gain is reported as such, and without --robust there is no such gain.
    dir.run(&format!(
        "tune wheel-scheduled-gain.toml --frequency 0.2:0.3:2 --gain -1:2:31 --figures figures --units si {FITTED_OPTIONS} --set sensor.sampled.period=0.3"
    ))
    .exits(0)
    .says(&["wheel-scheduled-gain-tune-region.png", "0.3    -0.9"]);
    let region = Drawing::read(&dir, "wheel-scheduled-gain-tune-region");
    region.shows(&["highest gain tried"]);
    assert!(!region.texts().iter().any(|text| text.contains("robust")));
}

#[test]
#[cfg_attr(not(feature = "full"), ignore = "not in a light build")]
fn the_map_is_drawn_with_the_limit_of_stability() {
    let dir = Dir::with(&["wheel-fast-mode"]);
    let grid = "--frequency 0.05:0.35:31 --period 0.1:2:39";
    dir.run(&format!("map wheel-fast-mode.toml {grid} {FITTED_OPTIONS} --figures figures -o map.csv"))
        .exits(0);
    assert!(dir.read("figures/wheel-fast-mode-map.png").starts_with(b"\x89PNG\r\n\x1a\n"));
    let map = Drawing::read(&dir, "wheel-fast-mode-map");
    assert!(map.0.len() < 100_000, "{}", map.0.len());
    map.shows(&["spectral radius", "limit of stability", "period of the samples (s)", "0.999", "1.001"]);
    // The longest periods: 1.75, 1.4, 1.1 and 0.75 s at 0.1, 0.15, 0.2 and 0.3 rad/s.
    let limit = map.line(BLACK);
    for (w, longest) in [(0.1, 1.75), (0.15, 1.4), (0.2, 1.1), (0.3, 0.75)] {
        let place = |p: &Point| TAU * map.across(p.0, ["0.02", "0.04"]) - w;
        let around =
            limit.windows(2).find(|pair| place(&pair[0]) * place(&pair[1]) <= 0.0).expect("w is met");
        let part = place(&around[0]) / (place(&around[0]) - place(&around[1]));
        let height = around[0].1 + part * (around[1].1 - around[0].1);
        near(map.up(height, ["0.4", "1.4"]), longest, 0.03);
    }
    dir.run(&format!("map wheel-fast-mode.toml {grid} --format svg")).exits(2);
}
