//! Requirements on the contrast of an image, and the circles of its energy, against an independent computation.

use serde_json::Value;

use crate::machines::{DENSITY, agree, bench, number};
use crate::util::Dir;

/// Cooler that is strong enough to blur the image.
const COOLER: &str = r#"
[[disturbance]]
point = "rotor"
[disturbance.lines]
frequency = "51 Hz"
harmonics = [{ order = 1, force = [1, 0, 2] }, { order = 2, force = [0, 0.3, 0], torque = [0.02, 0, 0], phase = 1.0 }]
"#;

/// Requirement at 1.5e6 cycles per rad.
const SHARP: &str = r#"
[[requirement]]
name = "sharp"
quantity = "mtf"
point = "detector"
spatial_frequency = "7.27220521664304 cycles/arcsec"
least = 0.8
"#;

/// Returns the bench with samples at 1 kHz under both loads, and a requirement with some more keys.
fn study(more: &str) -> String {
    format!("{}{COOLER}{SHARP}{more}\n", bench(0.001, DENSITY))
}

/// Source: `tests/golden/image_requirements.py`.
#[test]
fn a_required_contrast_is_that_of_noise_and_lines_together() {
    let dir = Dir::new();
    #[rustfmt::skip]
    let golden = [
        ("axis = \"x\"", [0.746_880_698, 0.863_177_963, 0.865_268_497]),
        ("axis = \"y\"", [0.805_817_163, 0.842_059_149, 0.956_960_285]),
        ("axis = \"x\"\nexposure = \"10 ms\"", [0.867_278_995, 0.998_607_033, 0.868_488_780]),
        ("axis = \"y\"\nexposure = \"10 ms\"", [0.968_868_249, 0.995_030_323, 0.973_671_238]),
    ];
    for (keys, [all, broadband, cooler]) in golden {
        dir.write("bench.toml", study(keys));
        let is_met = all >= 0.8;
        let report = dir.run("spectrum bench.toml --json").exits(if is_met { 0 } else { 3 }).json();
        let own = &report["contrasts"][0];
        agree(keys, number(&own["mtf"]), all, 2e-6);
        assert_eq!(own["met"], is_met);
        assert_eq!(own["speed_rad_s"], Value::Null);
        let cost = |source: &str| {
            let costs = own["costs"].as_array().expect("costs");
            costs.iter().find(|cost| cost["source"] == source).expect("a source").clone()
        };
        let [of_broadband, of_cooler] = ["disturbance[0].density", "disturbance[1].lines"].map(cost);
        agree(keys, number(&of_broadband["alone"]), broadband, 2e-6);
        agree(keys, number(&of_broadband["without"]), cooler, 2e-6);
        agree(keys, number(&of_cooler["alone"]), cooler, 2e-6);
        agree(keys, number(&of_cooler["without"]), broadband, 2e-6);
        assert!(number(&own["costs"][0]["without"]) >= number(&own["costs"][1]["without"]));
        let last = own["curve"].as_array().and_then(|all| all.get(40)).expect("a curve");
        agree("curve", number(&last["mtf"]), all, 2e-6);
    }
    // Without an axis the worst counts, in the unit in which the frequency is written.
    dir.write("bench.toml", study(""));
    let text = dir.run("spectrum bench.toml -o figures").exits(3);
    text.says(&[
        "sharp",
        "0.7469",
        "-0.0531",
        "missed",
        "7.272 cycles/arcsec, long exposure",
        "line_of_sight0_x",
        "1 of 1 requirement on the contrast not met: sharp",
    ]);
    assert!(dir.has("figures/bench-mtf.svg"));
}

/// Half of the energy and more, by the normal distribution of both axes together, which are correlated. Source:
/// `tests/golden/image_requirements.py`.
#[test]
fn circles_hold_parts_of_the_energy() {
    let dir = Dir::new();
    dir.write("bench.toml", bench(0.001, DENSITY));
    let command = "spectrum bench.toml --pixel 1e-6";
    let report = dir.run(&format!("{command} --json")).exits(0).json();
    let own = &report["circles"][0];
    for (key, expected) in [
        ("radius_50_rad", 7.046_811_679_974e-8),
        ("radius_80_rad", 1.074_805_517_150e-7),
        ("radius_95_rad", 1.468_474_443_235e-7),
        ("major_rms_rad", 6.259_305_314_321e-8),
        ("minor_rms_rad", 5.714_509_707_676e-8),
    ] {
        agree(key, number(&own[key]), expected, 1e-7);
    }
    dir.run(command).exits(0).says(&["energy of the image within circles", "radius", "detector"]);
    // The shorter the exposure, the less of the motion is within it.
    let brief = dir.run(&format!("{command} --window 0.01 --json")).exits(0).json();
    let jitter = &brief["outputs"][0]["window"]["rpe_uniform"];
    let circle = &brief["circles"][0];
    let sum = number(&circle["major_rms_rad"]).hypot(number(&circle["minor_rms_rad"]));
    let about = |place: usize| number(&brief["outputs"][place]["window"]["rpe_uniform"]);
    let sights: Vec<usize> = (0..brief["outputs"].as_array().expect("outputs").len())
        .filter(|place| {
            brief["outputs"][*place]["output"].as_str().is_some_and(|own| own.starts_with("line"))
        })
        .collect();
    assert!(jitter.is_number() && sights.len() == 2, "{sights:?}");
    agree("jitter", sum, about(sights[0]).hypot(about(sights[1])), 1e-6);
}

#[test]
fn linear_tools_judge_a_contrast() {
    let dir = Dir::new();
    let uncertain =
        "[uncertain]\n\"disturbance[1].lines.frequency\" = { uniform = [\"48 Hz\", \"54 Hz\"] }\n";
    dir.write("bench.toml", study("axis = \"x\"") + uncertain);
    let budget = dir.run("budget bench.toml --json").exits(3).json();
    agree("budget", number(&budget["contrasts"][0]["mtf"]), 0.746_880_698, 2e-6);
    let worst = dir.run("worst bench.toml --points 12 --json").exits(3).json();
    let case = &worst["cases"][0];
    agree("nominal", number(&case["nominal"]), 0.746_880_698, 2e-6);
    assert!(number(&case["worst"]) < 0.74, "{case}");
    assert_eq!(case["least"], true);
    assert_eq!(case["met"], false);
    let command = "worst bench.toml --requirement sharp --points 12";
    dir.run(command).exits(3).says(&["sharp", "at least 0.8: missed"]);
    dir.run(&format!("{command} -o worst.toml")).exits(3);
    dir.run("spectrum worst.toml").exits(3).says(&["missed"]);
    // A run does not judge it, and is judged by what else there is.
    let run = "simulate bench.toml --set duration=1 --log none";
    dir.run(run).exits(0).says(&["sharp: not of a run; `flexsc spectrum` judges it"]);
    dir.run("report bench.toml --runs 2 -o report.html").exits(0);
    assert!(dir.text("report.html").contains("Contrast (MTF) of an image"));
    let tune = "tune bench.toml --vary law.attitude.bandwidth=0.01:0.6 --objective sharp";
    dir.run(tune).exits(0).says(&["sharp 1 - MTF"]);
}

#[test]
fn contrasts_that_do_not_hold_are_refused() {
    let dir = Dir::new();
    for (from, to, why) in [
        ("least = 0.8", "least = 1.2", "`requirement[0].least`: must be a number above 0 and at most 1"),
        ("least = 0.8", "limit = 0.8", "`requirement[0].limit` is a largest value"),
        ("least = 0.8", "", "`requirement[0].least` is missing"),
        ("least = 0.8", "least = 0.8\nexposure = 0", "`requirement[0].exposure`: must be a positive number"),
        (
            "least = 0.8",
            "least = 0.8\nexposure = 1e9",
            "requirement[0].exposure: must be positive and at most",
        ),
        ("least = 0.8", "least = 0.8\nwindow = 1", "`requirement[0].window` is that of an index"),
        ("least = 0.8", "least = 0.8\naxis = \"z\"", "requirement[0].axis: is along the line of sight"),
        ("7.27", "-7.27", "`requirement[0].spatial_frequency`: must be a positive number"),
        ("cycles/arcsec", "cycles/mm", "`requirement[0].spatial_frequency`"),
        (
            "point = \"detector\"\nspatial",
            "point = \"m9\"\nspatial",
            "`requirement[0].point` must be the point",
        ),
        (
            "\"mtf\"",
            "\"line_of_sight\"\nlimit = 1",
            "`requirement[0].spatial_frequency` is for `quantity = \"mtf\"`",
        ),
    ] {
        let text = study("");
        assert!(text.contains(from), "{from}");
        dir.write("bench.toml", text.replacen(from, to, 1));
        dir.run("spectrum bench.toml -o figures").exits(2).says(&[why]);
        assert!(!dir.has("figures"));
    }
    let start = study("");
    let [from, to] = ["[[line_of_sight]]", "[law.attitude]"].map(|head| start.find(head).expect("a table"));
    let sight = &start[from..to];
    dir.write("bench.toml", start.replace(sight, ""));
    dir.run("spectrum bench.toml").exits(2).says(&["`mtf` needs a `[[line_of_sight]]`"]);
}
