//! Figures of a plan: present in both formats, with a curve for each command and the right values.

use roxmltree::Document;

use crate::util::Dir;

const SINE: [&str; 4] = ["torque", "angle", "section_4", "robustness"];

fn svg(dir: &Dir, scenario: &str, figure: &str) -> String {
    dir.text(&format!("figures/{scenario}-plan-{figure}.svg"))
}

/// All words of a figure.
fn texts(svg: &str) -> Vec<String> {
    let document = Document::parse(svg).expect("well-formed XML");
    document.descendants().filter_map(|node| node.text()).map(|text| text.trim().to_owned()).collect()
}

/// The ordinates of the curve of a colour that has the most points, in pixels from the top.
fn curve(svg: &str, colour: &str) -> Vec<f64> {
    let document = Document::parse(svg).expect("well-formed XML");
    let lines = document
        .descendants()
        .filter(|node| node.has_tag_name("polyline") && node.attribute("stroke") == Some(colour));
    let points = lines.filter_map(|node| node.attribute("points")).max_by_key(|points| points.len());
    let ordinate = |pair: &str| pair.split(',').nth(1).expect("a pair").parse().expect("a number");
    points.expect("a curve").split_whitespace().map(ordinate).collect()
}

fn low_and_high(curve: &[f64]) -> (f64, f64) {
    (curve.iter().copied().fold(0.0, f64::max), curve.iter().copied().fold(f64::INFINITY, f64::min))
}

#[test]
#[cfg_attr(not(feature = "full"), ignore = "not in a light build")]
fn a_series_is_drawn_with_each_number_of_modes() {
    let dir = Dir::with(&["rotation-sine"]);
    let set = "--set manoeuvre.command.sine.suppress=3";
    dir.run(&format!("plan rotation-sine.toml --figures figures {set}"))
        .exits(0)
        .says(&["rotation-sine-plan-section_4.png", "peak torque"]);
    let axes = [
        ["torque (N m)", "time (s)"],
        ["hub angle (deg)", "time (s)"],
        ["section_4 (deg)", "time (s)"],
        ["left in section_4 (deg)", "all frequencies off by (%)"],
    ];
    for (figure, axes) in SINE.iter().zip(axes) {
        let svg = svg(&dir, "rotation-sine", figure);
        assert!(svg.len() < 300_000, "{figure}: {}", svg.len());
        let texts = texts(&svg);
        let legend = ["p = 0", "p = 1", "p = 2", "p = 3"];
        for words in axes.iter().chain(&legend) {
            assert!(texts.iter().any(|text| text == words), "{figure}: no {words} in {texts:?}");
        }
        assert!(!texts.iter().any(|text| text == "p = 4"), "{figure}");
        let png = dir.read(&format!("figures/rotation-sine-plan-{figure}.png"));
        assert!(png.starts_with(b"\x89PNG\r\n\x1a\n"), "{figure}");
    }
    assert_eq!(dir.names("figures").len(), 8);

    // Each curve's height is its peak torque: 316.42, 521.08, 718.28 and 904.81 N m.
    let torque = svg(&dir, "rotation-sine", "torque");
    let height = |colour: &str| {
        let (low, high) = low_and_high(&curve(&torque, colour));
        low - high
    };
    let highest = height("#D55E00");
    for (colour, peak) in [("#E69F00", 316.4216), ("#56B4E9", 521.0808), ("#009E73", 718.2752)] {
        assert!((height(colour) / highest - peak / 904.8103).abs() < 1e-3, "{colour}");
    }
    // p = 1 leaves 2.1747e-5 rad, and 1.189e-3 rad at worst, of whose logarithms a decade is an eighth of the plot or
    // more.
    let robustness = svg(&dir, "rotation-sine", "robustness");
    let (low, high) = low_and_high(&curve(&robustness, "#56B4E9"));
    let (floor, top) = low_and_high(&curve(&robustness, "#E69F00"));
    let decades = |ratio: f64| ratio.log10();
    let scale = (low - high) / decades(1.189_284e-3 / 2.174_722e-5);
    assert!(((high - top) / scale - decades(4.301_488e-2 / 1.189_284e-3)).abs() < 1e-2, "{high} {top}");
    assert!(floor < low);
}

#[test]
fn other_commands_are_drawn_beside_the_rigid_bang_bang() {
    let dir = Dir::with(&["rotation-sine", "rotation-robust", "rotation-kinematic"]);
    let set = "--set manoeuvre.command={minimum_energy={suppress=2}}";
    dir.run(&format!("plan rotation-sine.toml --figures figures --format svg --coordinate section_2 {set}"))
        .exits(0);
    let torque = svg(&dir, "rotation-sine", "torque");
    let words = texts(&torque);
    assert!(["bang-bang, rigid", "minimum energy"].iter().all(|name| words.iter().any(|text| text == name)));
    // 201.44 N m one way, then the other; 320.04 N m at the start of the other.
    let (low, high) = low_and_high(&curve(&torque, "#E69F00"));
    let (own_low, own_high) = low_and_high(&curve(&torque, "#0072B2"));
    assert!(((low - high) / (own_low - own_high) - 201.4402 / 320.04).abs() < 1e-3);
    assert_eq!(dir.names("figures").len(), 4);
    assert!(dir.has("figures/rotation-sine-plan-section_2.svg"));

    // A series with zeros of its own stands beside those of as many modes.
    dir.run("plan rotation-robust.toml --figures figures --format svg --coordinate angle").exits(0);
    let words = texts(&svg(&dir, "rotation-robust", "robustness"));
    assert!(
        ["p = 0", "p = 1", "p = 2", "as planned"].iter().all(|name| words.iter().any(|text| text == name))
    );
    assert!(words.iter().any(|text| text == "left in angle (deg)"));
    // Where the hub's motion is commanded the torque is what moves it.
    dir.run("plan rotation-kinematic.toml --figures figures --format svg").exits(0);
    let words = texts(&svg(&dir, "rotation-kinematic", "torque"));
    assert!(words.iter().any(|text| text == "torque (N m)"), "{words:?}");
}

#[test]
fn what_cannot_be_drawn_is_bad_input() {
    let dir = Dir::with(&["rotation-sine"]);
    let words = ["--coordinate must be one of angle, section_1, section_2, section_3, section_4, got tip"];
    dir.run("plan rotation-sine.toml --figures figures --coordinate tip").exits(2).says(&words);
    dir.run("plan rotation-sine.toml --compare --coordinate tip").exits(2).says(&words);
    dir.run("plan rotation-sine.toml --output section_1").exits(2);
    dir.run("plan rotation-sine.toml --compare --figures figures").exits(2);
    assert!(!dir.has("figures"));
}
