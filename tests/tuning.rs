//! Gains of the extra loop: their region, the robust ones, and the command's report on them.

use flexsc_core::Scenario;
use flexsc_core::analysis::sampled_loop::{
    Gains, ModelUncertainty, RobustGoal, RobustSearch, SampledLoop, Scaling, SettlingWindow, midpoints,
    optimize, regions,
};

use crate::loops::{FITTED, GAINS, WINDOW, at, fitted};
use crate::study::{close, pairs};
use crate::util::{Dir, table};

#[test]
fn the_region_of_the_extra_gain() {
    let of = fitted();
    let found = regions(&of, &[0.1, 0.15, 0.2, 0.25, 0.3, 0.35], Scaling::All, GAINS, WINDOW, 200.0);
    let exact = [
        None,
        Some((-0.75, 0.1)),
        Some((-0.8, 1.0)),
        Some((-0.85, 2.25)),
        Some((-0.9, 3.7)),
        Some((-0.95, 5.45)),
    ];
    for (region, exact) in pairs(&found, exact) {
        match (region.gain, exact) {
            (Some((low, high)), Some((lowest, highest))) => {
                assert!((low - lowest).abs() < 1e-9 && (high - highest).abs() < 1e-9, "{region:?}");
                assert!(region.settling_s.expect("settled") <= 200.0);
            }
            (None, None) => {}
            _ => panic!("{region:?}"),
        }
    }
    assert_eq!(found[2].settling_without_s.map(|time| (time * 10.0).round()), Some(1803.0));
    let schedule = midpoints(&found);
    assert_eq!(schedule.len(), 5);
    assert!((schedule[3].1 - 1.4).abs() < 1e-9 && (schedule[0].1 + 0.325).abs() < 1e-9);
}

#[test]
fn robust_gains() {
    let of = fitted();
    let part = 0.05;
    let search = RobustSearch {
        gains: Gains { step: 0.1, ..GAINS },
        scaling: Scaling::All,
        window: SettlingWindow { horizon: 600.0, ..WINDOW },
        uncertainty: ModelUncertainty { frequency: part, modal_gain: part, authority: part, delay: 0.3 },
        goal: RobustGoal::Settling,
        quantile: 1.0,
        margin: 1e-4,
    };
    let frequencies = [0.1, 0.2, 0.3];
    let found = optimize(&of, &frequencies, search);
    // The worst of the corners, by hand: no gain of the grid is better than the one found.
    let worst = |frequency: f64, gain: f64| {
        let mut worst: f64 = 0.0;
        for corner in 0..16 {
            let sign = |bit: u32| if corner >> bit & 1 == 0 { 0.95 } else { 1.05 };
            let text = FITTED
                .replace("gain = 1.44", &format!("gain = {}", 1.44 * sign(0)))
                .replace("gain = 0.21", &format!("gain = {}", 0.21 * sign(0)))
                .replace("gain = 0.165", &format!("gain = {}", 0.165 * sign(0)))
                .replace("gain = 0.72", &format!("gain = {}", 0.72 * sign(0)))
                .replace(
                    "gain = 5e-4",
                    &format!("gain = {}\ndelay = {}", 5e-4 * sign(1), 0.3 * f64::from(corner >> 3)),
                );
            let loop_ = SampledLoop::from_scenario(&Scenario::parse("corner.toml", &text).expect("valid"))
                .expect("a loop")
                .0;
            let closed = at(&loop_, frequency * sign(2)).closed(gain);
            let settling = closed.settle(search.window).crossing_s.unwrap_or(f64::INFINITY);
            worst = worst.max(if closed.spectral_radius() < 1.0 - 1e-4 { settling } else { f64::INFINITY });
        }
        worst
    };
    for robust in &found {
        let gain = robust.gain.expect("a gain");
        let ours = robust.settling_quantile_s.expect("settled");
        assert!((worst(robust.frequency_rad_s, gain) - ours).abs() < 1e-6, "{robust:?}");
        for other in [-0.7, -0.4, 0.0, 0.5, 1.2] {
            assert!(ours <= worst(robust.frequency_rad_s, other) + 1e-9, "{robust:?} {other}");
        }
        assert!(robust.spectral_radius.expect("a radius") < 1.0 - 1e-4);
        assert!(ours <= robust.settling_without_s.unwrap_or(f64::INFINITY));
    }
    // No loop is that quick.
    assert_eq!(optimize(&of, &[0.2], RobustSearch { margin: 0.5, ..search })[0].gain, None);
}

#[test]
fn the_command_tells_regions_schedules_and_maps() {
    let dir = Dir::holding("fitted.toml", FITTED);
    let few = "--frequency 0.15:0.3:4";
    let reported = dir.run(&format!("tune fitted.toml --json {few}")).exits(0).json();
    let rows = reported["rows"].as_array().expect("rows");
    assert_eq!(rows.len(), 4);
    assert!((rows[1]["midpoint"].as_f64().expect("a gain") - 0.1).abs() < 1e-9);
    assert_eq!(reported["schedule"][1]["gain"], rows[1]["midpoint"]);
    assert_eq!(reported["schedule"][1]["frequency"], rows[1]["frequency_rad_s"]);
    let words = ["rad/s", "0.2    -0.8        1     0.1       183", "180.3"];
    dir.run(&format!("tune fitted.toml {few} --units si")).exits(0).says(&words);
    // The schedule is one that a scenario takes.
    let known = "[sensor.sampled]\nperiod = 0.3\n[estimator.truth]\n";
    let schedule =
        dir.run(&format!("tune fitted.toml --schedule {few}")).exits(0).prints(&["[law.pd.extra]"]);
    let scheduled = Scenario::parse("scheduled.toml", &format!("{FITTED}{known}{schedule}")).expect("valid");
    let law = SampledLoop::from_scenario(&scheduled).expect("a loop").1;
    assert!((law.extra_gain(0.2) - 0.1).abs() < 1e-9 && (law.extra_gain(1.0) - 1.4).abs() < 1e-9);
    let sure =
        dir.run(&format!("tune fitted.toml --robust 0.05 --gain -1:2:13 --json {few}")).exits(0).json();
    assert!(sure["rows"][0]["gain"].is_number());
    assert_eq!(sure["schedule"][0]["gain"], sure["rows"][0]["gain"]);
    dir.run(&format!("tune fitted.toml --robust 0.05 --gain -1:2:13 {few}")).exits(0).says(&["off by 5 %"]);

    dir.run("map fitted.toml --frequency 0.1:0.3:3 --period 0.1:0.7:4 -o map.csv")
        .exits(0)
        .says(&["12 cells"]);
    let rows = table(&dir, "map.csv");
    assert_eq!(rows.len(), 12);
    let reported = dir.run("map fitted.toml --frequency 0.1:0.3:3 --period 0.1:0.7:4 --json").exits(0).json();
    for (row, cell) in pairs(&rows, reported["rows"].as_array().expect("rows")) {
        let (table, json): (f64, _) =
            (row["spectral_radius"].parse().expect("a number"), &cell["spectral_radius"]);
        close(table, json.as_f64().expect("a number"), 1e-15);
        assert_eq!(row["settling_s"].is_empty(), cell["settling_s"].is_null());
    }
    // The table's own settling time, in which a sample is outside the band 5 % of 0.06 rad.
    assert_eq!(rows[5]["period_s"].parse(), Ok(0.3));
    let settling: f64 = rows[5]["settling_s"].parse().expect("settled");
    assert!((settling - 180.3).abs() < 0.31, "{settling}");
}
