//! Results of finite-element programs: what is read from them, and what is refused.

use flexsc_core::spacecraft::body::craft::ClampedMode;
use flexsc_core::{Document, Scenario, numerics::attitude};

use crate::study::pairs;

const GOLDEN: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../tests/golden/fe/");

/// A spacecraft with the boom of bars, and some keys beside its modes.
fn boom(keys: &str) -> String {
    format!(
        r#"duration = 1.0
[spacecraft]
mass = 900.0
inertia = [[900.0, 0.0, 0.0], [0.0, 800.0, 0.0], [0.0, 0.0, 700.0]]
[[appendage]]
name = "boom"
mass = 14.4
centre = [2.375, 0.266666667, 0.888888889]
inertia = [[14.79422, -2.4, -8.0], [-2.4, 24.34722, -4.266667], [-8.0, -4.266667, 15.697]]
at = [0.5, 0.0, 0.0]
{keys}
[law.pd]
k_p = 1.0
k_d = 20.0
period = 0.5
"#
    )
}

fn read(keys: &str) -> Result<Scenario, String> {
    Scenario::parse(&format!("{GOLDEN}boom.toml"), &boom(keys)).map_err(|error| error.to_string())
}

#[test]
fn a_scenario_names_the_results_of_a_solver() {
    let files = ["bars.F06", "bars-msc.f06", "bars.flex"].map(|file| {
        let keys = format!("modes = \"{file}\"\ndamping = 0.004\nkeep = 3");
        read(&keys).expect("a scenario")
    });
    for scenario in &files {
        let modes = &scenario.appendage[0].modes;
        assert_eq!(modes.len(), 3);
        assert!((modes[0].frequency.get() - 6.227_923).abs() < 1e-6);
        assert!(modes.iter().all(|mode| mode.damping.get() == 0.004));
    }
    let each = read("modes = \"bars.F06\"\ndamping = [0.001, 0.002]\nkeep = 2").expect("a scenario");
    assert_eq!(each.appendage[0].modes[1].damping.get(), 0.002);
    // 42 knows its damping, and first moments.
    let flex = read("modes = \"bars.flex\"").expect("a scenario");
    assert!((flex.appendage[0].modes[3].damping.get() - 0.005).abs() < 1e-8);
    assert!(flex.appendage[0].modes[3].moments.is_some());
}

#[test]
fn a_scenario_with_results_repeats_without_their_file() {
    let scenario = read("modes = \"bars.flex\"\ndamping = 0.003\nkeep = 2").expect("a scenario");
    let alone = scenario.self_contained().to_toml();
    assert!(!alone.contains("keep") && !alone.contains("flex"), "{alone}");
    let again = Scenario::parse("/alone.toml", &alone).expect("a scenario");
    assert_eq!(again.body, scenario.body);
    // With the file the text says what was written.
    let written = scenario.to_toml();
    assert!(written.contains("keep = 2") && written.contains("damping = 0.003"), "{written}");
    // A scenario that differs in another key takes the modes over, one in their damping does not.
    let mut document = Document::parse(&format!("{GOLDEN}boom.toml"), written).expect("a document");
    document.set_text("law.pd.k_p", "2.0").expect("a key");
    let like = Scenario::from_document_reusing(&document, &scenario).expect("a scenario");
    assert_eq!(like.body, scenario.body);
    document.set_text("appendage[0].damping", "0.001").expect("a key");
    let like = Scenario::from_document_reusing(&document, &scenario).expect("a scenario");
    assert_eq!(like.appendage[0].modes[0].damping.get(), 0.001);
}

#[test]
fn millimetres_and_tonnes_become_metres_and_kilograms() {
    let metres = read("modes = \"bars.F06\"\ndamping = 0").expect("a scenario");
    // The same numbers, of a boom that is a thousand times smaller and heavier.
    let text = boom("modes = \"bars.F06\"\ndamping = 0\nunits = \"mm\"")
        .replace("mass = 14.4", "mass = 14400.0")
        .replace("[2.375, 0.266666667, 0.888888889]", "[2.375e-3, 0.266666667e-3, 0.888888889e-3]")
        .replace("[14.79422, -2.4, -8.0]", "[14.79422e-3, -2.4e-3, -8e-3]")
        .replace("[-2.4, 24.34722, -4.266667]", "[-2.4e-3, 24.34722e-3, -4.266667e-3]")
        .replace("[-8.0, -4.266667, 15.697]", "[-8e-3, -4.266667e-3, 15.697e-3]");
    let small = Scenario::parse(&format!("{GOLDEN}boom.toml"), &text).expect("a scenario");
    let (metres, small) = (&metres.appendage[0].modes, &small.appendage[0].modes);
    for (metres, small) in pairs(metres.iter(), small.iter()) {
        assert_eq!(metres.frequency, small.frequency);
        assert!((small.translation(1.0) - metres.translation(1.0) * 1000_f64.sqrt()).norm() < 1e-12);
        let rotation = |mode: &ClampedMode| attitude::vector(&mode.rotation.expect("one"));
        assert!((rotation(small) - rotation(metres) * 1e-3 * 1000_f64.sqrt()).norm() < 1e-12);
    }
}

#[test]
fn keys_that_do_not_fit_results_are_refused() {
    let cases = [
        ("modes = \"bars.F06\"", "`appendage[0].damping` must say the damping ratio"),
        (
            "modes = \"bars.F06\"\ndamping = [0.1, 0.2]",
            "must be one number, or one for each of 10 modes, got 2",
        ),
        ("modes = \"bars.F06\"\ndamping = -0.1", "number of 0 or more, got -0.1"),
        ("modes = \"bars.F06\"\ndamping = \"low\"", "a damping ratio, or an array of them"),
        ("modes = \"bars.F06\"\ndamping = 0\nkeep = 0", "`appendage[0].keep` must be 1 to 200 modes, got 0"),
        ("modes = \"bars.F06\"\ndamping = 0\nkeep = 11", "has 10 modes, and `keep` asks for 11"),
        ("modes = \"bars.F06\"\ndamping = 0\nunits = \"mm\"", "in the file, 14400 kg, to a fifth, got 14.4"),
        ("modes = \"bars.F06\"\ndamping = 0\nunits = \"in\"", "units"),
        ("modes = \"bars.flex\"\nunits = \"m\"", "files of 42 are in SI"),
        ("modes = []\nkeep = 2", "`appendage[0].keep` must be left out"),
        ("modes = \"feet.F06\"\ndamping = 0", "feet.F06: must have one clamped grid"),
        ("modes = \"none.f06\"\ndamping = 0", "none.f06: "),
        ("modes = \"bars.op2\"\ndamping = 0", "must be left out"),
        ("modes = \"bars.op2\"", "the path of a .csv, .f06, .frd, .dat or .flex file, got"),
        (
            "modes = \"pages-nx.f06\"\ndamping = 0\nkeep = 2",
            "`appendage[0].modes[0]` must leave the appendage mass",
        ),
    ];
    for (keys, why) in cases {
        let error = read(keys).expect_err(keys);
        assert!(error.contains(why), "{keys}: {error}");
    }
    let point = boom("modes = \"bars.F06\"\ndamping = 0").replace("inertia = [[14", "# [[14");
    let error = Scenario::parse(&format!("{GOLDEN}boom.toml"), &point).expect_err("a point mass");
    assert!(error.to_string().contains("`appendage[0].inertia` must be given"), "{error}");
}
