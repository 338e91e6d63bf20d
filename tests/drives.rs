//! Driven appendages: against an oracle of point masses, balances, refused settings, and the shipped scenario.

use flexsc_core::metrics::{MetricValue, Metrics};
use flexsc_core::record::Detail;
use flexsc_core::scenario::Scenario;

use crate::study::pairs;
use crate::traces::{column, flown, golden_rows, traced, within};
use crate::util::SCENARIOS;

const GOLDEN: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../tests/golden");

fn golden() -> String {
    std::fs::read_to_string(format!("{GOLDEN}/driven.toml")).expect("a file")
}

fn parsed(text: &str) -> Scenario {
    Scenario::parse("driven.toml", text).expect("a scenario")
}

/// Point masses, whose equations follow from their kinetic energy without a derivation by hand, move the same way:
/// `golden/driven_oracle.py`.
#[test]
fn panels_of_point_masses_turn_as_the_oracle_says() {
    let trace = traced(&parsed(&golden()));
    let rows = golden_rows("driven.csv");
    let attitude = ["q_w", "q_x", "q_y", "q_z"].map(|name| column(&trace, "/pointing", name));
    let rates = within(&trace, "/rates", "axes", "rate_rad_s");
    let [momentum, elastic, rotational] =
        ["momentum_nm_s", "elastic_j", "rotational_j"].map(|name| column(&trace, "/energy", name));
    let frequencies = within(&trace, "/drives", "modes", "frequency_rad_s");
    let position = ["x_m", "y_m", "z_m"].map(|name| column(&trace, "/position", name));
    assert_eq!(attitude[0].len(), rows.len());
    let mut worst = [0.0_f64; 7];
    for (at, row) in rows.iter().enumerate() {
        let mut modes = frequencies[4 * at..4 * at + 4].to_vec();
        modes.sort_by(f64::total_cmp);
        let off = [
            (0..4).map(|k| (attitude[k][at] - row[1 + k]).abs()).fold(0.0, f64::max),
            (0..3).map(|k| (rates[3 * at + k] - row[5 + k]).abs()).fold(0.0, f64::max),
            (momentum[at] - row[8]).abs(),
            (0..4).map(|k| (modes[k] - row[9 + k]).abs()).fold(0.0, f64::max),
            (elastic[at] - row[13]).abs(),
            (elastic[at] + rotational[at] - row[14]).abs(),
            (0..3).map(|k| (position[k][at] - row[15 + k]).abs()).fold(0.0, f64::max),
        ];
        worst.iter_mut().zip(off).for_each(|(most, off)| *most = most.max(off));
    }
    for (most, bound) in worst.into_iter().zip([1e-11, 3e-11, 1e-12, 1e-13, 1e-11, 2e-11, 1e-11]) {
        assert!(most < bound, "{worst:?}");
    }
}

/// A body with a drive at rest equals one without a drive, but for rounding.
#[test]
fn a_drive_at_rest_changes_nothing() {
    let text = golden();
    let drives: Vec<&str> = text.lines().filter(|line| line.starts_with("drive = ")).collect();
    let still = "drive = { about = [0, 1, 0], rate = 0.0, angle = 0.3 }";
    let turned = "turned = [{ about = [0, 0, 1], by = 3.141592653589793 }, { about = [0, 1, 0], by = 0.3 }]";
    let first = "turned = { about = [0, 1, 0], by = 0.3 }";
    let driven = text.replace(drives[0], still).replace(drives[1], still);
    let plain = text
        .replace(drives[0], first)
        .replace("turned = { about = [0, 0, 1], by = 3.141592653589793 }", turned)
        .replace(drives[1], "");
    let [driven, plain] = [driven, plain].map(|text| traced(&parsed(&text)));
    for (topic, name) in [("/pointing", "q_x"), ("/energy", "elastic_j"), ("/position", "y_m")] {
        let [a, b] = [&driven, &plain].map(|trace| column(trace, topic, name));
        let off = pairs(a, b).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        // Steps differ: those of a body with drives resolve all modes.
        assert!(off < 5e-10, "{topic} {name} {off:e}");
    }
}

/// Without external torques the momentum is constant whatever drives and wheels do, and recording changes no number.
#[test]
fn momentum_stays_while_drives_turn() {
    let text = golden();
    let alone = text[..text.find("[[disturbance]]").expect("one")].to_owned()
        + &text[text.find("[law.open]").expect("one")..];
    let (metrics, trace) = flown(&parsed(&alone), 0, Detail::Full);
    let momentum = column(&trace, "/energy", "momentum_nm_s");
    let off = momentum.iter().map(|of| (of / momentum[0] - 1.0).abs()).fold(0.0, f64::max);
    assert!(off < 1e-13, "{off:e}");
    let (unseen, _) = flown(&parsed(&alone), 0, Detail::Events);
    let end = |metrics: &Metrics| metrics.number("pointing_error_end_rad");
    assert_eq!(end(&metrics), end(&unseen));
    // A rate that jumps, and drives by a table: the same momentum.
    let table = "table = [{ time = 3, angle = 0.0 }, { time = 13, angle = 0.9 }, { time = 20, angle = 0.2 }]";
    let jumping = alone.replace("rate = 0.08, from = 5, until = 20, acceleration = 0.04", table);
    let trace = traced(&parsed(&jumping));
    let momentum = column(&trace, "/energy", "momentum_nm_s");
    let off = momentum.iter().map(|of| (of / momentum[0] - 1.0).abs()).fold(0.0, f64::max);
    assert!(off < 1e-13, "{off:e}");
}

#[test]
fn what_does_not_go_with_drives_is_refused() {
    let refused = |change: &[(&str, &str)]| {
        let mut text = golden();
        for (from, to) in change {
            assert!(text.contains(from), "{from}");
            text = text.replacen(from, to, 1);
        }
        Scenario::parse("driven.toml", &text).expect_err("refused").to_string()
    };
    for (change, words) in [
        (("rate = 0.05,", "rate = 0.4,"), "`appendage[0].drive.rate` must be slower than 0.18"),
        (
            ("torque = 0.1\n", "torque = 0.1\nfriction = { coulomb = 0.01 }\n"),
            "`actuator.wheels.friction` needs",
        ),
        (
            ("rate = 0.05, angle = 0.3", "track = \"sun\""),
            "`appendage[0].drive.track` follows `environment.sun`",
        ),
        (("rate = 0.05, angle = 0.3", "angle = 0.3"), "`appendage[0].drive` needs exactly one of"),
        (
            (
                "[law.open]",
                "[[sensor]]\ngyro = { period = 0.1 }\n[[sensor]]\naccelerometer = { period = 0.1, watch_only = true }\n[law.open]",
            ),
            "cannot be used with appendages that turn",
        ),
    ] {
        let error = refused(&[change]);
        assert!(error.contains(words), "{error}");
    }
}

fn shipped(change: &[(&str, &str)]) -> Scenario {
    let mut text = std::fs::read_to_string(format!("{SCENARIOS}/sun-tracking.toml")).expect("a file");
    for (from, to) in change {
        assert!(text.contains(from), "{from}");
        text = text.replace(from, to);
    }
    parsed(&text)
}

/// The comment of the scenario: how the mode drifts, that the wide notch keeps the goal and the narrow one does not.
#[test]
fn a_notch_has_to_cover_the_drift() {
    let short = [
        ("duration = 5700.0", "duration = 2000.0"),
        ("assess = [300.0, 5700.0]", "assess = [300.0, 2000.0]"),
    ];
    let narrow =
        ("frequency = 2.6, depth = 0.1, damping = 0.9", "frequency = 2.386, depth = 0.05, damping = 0.1");
    let met = |metrics: &Metrics| metrics.get("goal") == Some(&MetricValue::Word("met"));
    let (metrics, trace) = flown(&shipped(&[]), 0, Detail::Full);
    assert!(met(&metrics), "{metrics:?}");
    let frequencies = within(&trace, "/drives", "modes", "frequency_rad_s");
    let second: Vec<f64> = frequencies.iter().skip(1).step_by(6).copied().collect();
    let (least, most) = second.iter().fold((f64::MAX, 0.0_f64), |(a, b), w| (a.min(*w), b.max(*w)));
    assert!((2.37..2.38).contains(&least) && (2.85..2.86).contains(&most), "{least} {most}");
    assert!((second[0] - 2.386).abs() < 1e-3, "{}", second[0]);
    assert!(!met(&flown(&shipped(&[short[0], short[1], narrow]), 0, Detail::Events).0));
    // Keys of drives can be uncertain.
    let drawn = golden() + "[uncertain]\n\"appendage[0].drive.rate\" = { relative_uniform = 0.1 }\n";
    assert!(Scenario::parse("drawn.toml", &drawn).is_ok());
}
