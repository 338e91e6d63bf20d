//! The figures of a log: there, in both forms, readable, and with every switching.

use flexsc_core::record::Log;
use resvg::usvg::roxmltree::{Document, Node};

use crate::util::Dir;

const FIGURES: [&str; 5] = ["phase-plane", "torque", "envelope", "gain", "modes"];

/// A directory with the log of a run.
fn simulated(options: &str) -> Dir {
    let dir = Dir::with(&["relay-adaptive"]);
    dir.run(&format!("simulate relay-adaptive.toml {options}")).exits(0);
    dir
}

fn svg(dir: &Dir, figure: &str) -> String {
    dir.text(&format!("figures/relay-adaptive-{figure}.svg"))
}

/// How many elements of this name are filled in a colour.
fn filled(document: &Document<'_>, name: &str, colour: &str) -> usize {
    let is = |node: &Node<'_, '_>| node.has_tag_name(name) && node.attribute("fill") == Some(colour);
    document.descendants().filter(|node| is(node)).count()
}

/// Width and height of a PNG.
fn size(png: &[u8]) -> [u32; 2] {
    assert!(png.starts_with(b"\x89PNG\r\n\x1a\n"));
    [16, 20].map(|at| u32::from_be_bytes(png[at..at + 4].try_into().expect("four bytes")))
}

#[test]
fn every_figure_is_drawn_in_both_forms() {
    let dir = simulated("--set duration=2000 --log full");
    dir.run("plot relay-adaptive.mcap -o figures").exits(0).says(&["relay-adaptive-gain.svg"]);
    let axes = [
        ["angle x, µrad", "rate dx/dt, µrad/s"],
        ["torque, µrad/s²", "time, s"],
        ["envelope a, µrad", "elastic angle, µrad"],
        ["gain k_t", "mean envelope, µrad"],
        ["displacement, µrad", "time, s"],
    ];
    for (figure, axes) in FIGURES.iter().zip(axes) {
        let svg = svg(&dir, figure);
        assert!(svg.len() < 1_000_000, "{figure}");
        let document = Document::parse(&svg).expect("well-formed XML");
        let texts: Vec<_> = document.descendants().filter_map(|node| node.text()).map(str::trim).collect();
        assert!(axes.iter().all(|axis| texts.contains(axis)), "{figure}: {texts:?}");
        assert!(texts.iter().any(|text| text.starts_with("relay-adaptive: ")), "{figure}");

        let root = document.root_element();
        let pixels = |name: &str| root.attribute(name).expect("a size").parse::<u32>().expect("a number");
        let png = dir.read(&format!("figures/relay-adaptive-{figure}.png"));
        assert_eq!(size(&png), [2 * 800, 2 * pixels("height")], "{figure}");
        assert_eq!(pixels("width"), 800);
    }
}

#[test]
fn every_switching_is_marked() {
    let dir = simulated("--set duration=200");
    dir.run("plot relay-adaptive.mcap -o figures --format svg").exits(0);
    let log = Log::open(&dir.path("relay-adaptive.mcap")).expect("a log");
    let switchings = log.columns("/command").expect("a topic").len();
    assert!(switchings > 20);
    let svg = svg(&dir, "phase-plane");
    let document = Document::parse(&svg).expect("well-formed XML");
    let marks = filled(&document, "circle", "#D55E00") + filled(&document, "polygon", "#0072B2");
    // The legend has one of each kind.
    assert_eq!(marks - 2, switchings);
    assert!(!dir.has("figures/relay-adaptive-phase-plane.png"));
}

#[test]
fn an_events_log_and_a_full_one_give_the_same_figures() {
    let draw = |detail: &str| {
        let dir = simulated(&format!("--set duration=1500 --log {detail}"));
        dir.run("plot relay-adaptive.mcap -o figures --format svg").exits(0);
        FIGURES.map(|figure| svg(&dir, figure))
    };
    assert!(draw("events") == draw("full"));
}

#[test]
fn runs_without_a_switching_can_be_drawn() {
    for duration in ["0.01", "1", "3"] {
        let dir = simulated(&format!("--set duration={duration}"));
        dir.run("plot relay-adaptive.mcap -o figures").exits(0);
        assert!(dir.has("figures/relay-adaptive-torque.png"), "{duration}");
        assert!(!dir.has("figures/relay-adaptive-gain.svg"), "{duration}");
    }
}

#[test]
fn a_figure_that_is_not_there_is_bad_input() {
    let dir = simulated("--set duration=100");
    dir.run("plot relay-adaptive.mcap -o figures --what nonsense").exits(2).says(&["phase-plane"]);
    let words = ["no figure `gain`", "hint: it has phase-plane, torque, envelope, modes"];
    dir.run("plot relay-adaptive.mcap -o figures --what torque,gain").exits(2).says(&words);
    assert!(!dir.has("figures"));
    dir.run("plot relay-adaptive.mcap -o figures --what torque --format png").exits(0);
    assert_eq!(dir.names("figures"), ["relay-adaptive-torque.png"]);
}

#[test]
fn rotations_have_figures_of_their_own() {
    let dir = Dir::with(&["rotation-robust", "rotation-thrusters"]);
    let axes = [
        ("torque", ["torque, N m", "time, s"]),
        ("angle", ["angle, mrad", "beyond the goal, mrad"]),
        ("outputs", ["section_4, mrad", "time, s"]),
        ("modes", ["displacement, mrad", "time, s"]),
    ];
    for (name, words) in
        [("rotation-robust", ["disturbance", "feedback"]), ("rotation-thrusters", ["executed", "planned"])]
    {
        dir.run(&format!("simulate {name}.toml --log events --set duration=20")).exits(0);
        dir.run(&format!("plot {name}.mcap --format svg -o events")).exits(0);
        dir.run(&format!("simulate {name}.toml --log full --set duration=20")).exits(0);
        dir.run(&format!("plot {name}.mcap --format svg -o full")).exits(0);
        assert_eq!(dir.names("full").iter().filter(|file| file.starts_with(name)).count(), 4);
        for (figure, axes) in axes {
            let svg = dir.text(&format!("full/{name}-{figure}.svg"));
            assert_eq!(svg, dir.text(&format!("events/{name}-{figure}.svg")), "{figure}");
            let document = Document::parse(&svg).expect("well-formed XML");
            let texts: Vec<_> =
                document.descendants().filter_map(|node| node.text()).map(str::trim).collect();
            assert!(axes.iter().all(|axis| texts.contains(axis)), "{name} {figure}: {texts:?}");
            assert!(figure != "torque" || words.iter().all(|word| texts.contains(word)), "{name}: {texts:?}");
        }
    }
    dir.run("plot rotation-robust.mcap --what phase-plane")
        .exits(2)
        .says(&["it has torque, angle, outputs, modes"]);
}
