//! Figures of a log: present in both formats, readable, and with every switching.

use flexsc_core::record::Log;
use roxmltree::{Document, Node};

use crate::util::Dir;

const FIGURES: [&str; 6] = ["phase-plane", "torque", "angle", "envelope", "gain", "modes"];

/// Returns a directory with the log of a run.
fn simulated(options: &str) -> Dir {
    let dir = Dir::with(&["relay-adaptive"]);
    dir.run(&format!("simulate relay-adaptive.toml {options}")).exits(0);
    dir
}

fn svg(dir: &Dir, figure: &str) -> String {
    dir.text(&format!("figures/relay-adaptive-{figure}.svg"))
}

/// Returns the number of elements of this name that are filled in a colour.
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
#[cfg_attr(not(feature = "full"), ignore = "not in a light build")]
fn every_figure_is_drawn_in_both_forms() {
    let dir = simulated("--set duration=2000 --log full");
    dir.run("plot relay-adaptive.mcap -o figures").exits(0).says(&["relay-adaptive-gain.svg"]);
    let axes = [
        ["angle x (arcsec)", "rate dx/dt (arcsec/s)"],
        ["acceleration (arcsec/s²)", "time (s)"],
        ["angle x (arcsec)", "time (s)"],
        ["envelope a (arcsec)", "elastic angle (arcsec)"],
        ["gain k_t", "mean envelope (arcsec)"],
        ["mode 0, 0.0700 Hz", "time (s)"],
    ];
    for (figure, axes) in FIGURES.iter().zip(axes) {
        let svg = svg(&dir, figure);
        assert!(svg.len() < 1_000_000, "{figure}");
        let document = Document::parse(&svg).expect("well-formed XML");
        let texts: Vec<_> = document.descendants().filter_map(|node| node.text()).map(str::trim).collect();
        assert!(axes.iter().all(|axis| texts.contains(axis)), "{figure}: {texts:?}");
        // A caption says the title.
        assert!(!texts.iter().any(|text| text.starts_with("Relay adaptive")), "{figure}");

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
#[cfg_attr(not(feature = "full"), ignore = "not in a light build")]
fn runs_without_a_switching_can_be_drawn() {
    for duration in ["0.01", "1", "3"] {
        let dir = simulated(&format!("--set duration={duration}"));
        dir.run("plot relay-adaptive.mcap -o figures").exits(0);
        assert!(dir.has("figures/relay-adaptive-modes.png"), "{duration}");
        assert!(!dir.has("figures/relay-adaptive-gain.svg"), "{duration}");
    }
}

#[test]
#[cfg_attr(not(feature = "full"), ignore = "not in a light build")]
fn a_figure_that_is_not_there_is_bad_input() {
    let dir = simulated("--set duration=100");
    dir.run("plot relay-adaptive.mcap -o figures --what nonsense").exits(2).says(&["phase-plane"]);
    let words = ["no figure `gain`", "hint: it has phase-plane, torque, angle, envelope, modes"];
    dir.run("plot relay-adaptive.mcap -o figures --what torque,gain").exits(2).says(&words);
    assert!(!dir.has("figures"));
    dir.run("plot relay-adaptive.mcap -o figures --what torque --format png").exits(0);
    assert_eq!(dir.names("figures"), ["relay-adaptive-torque.png"]);
}

#[test]
fn rotations_have_figures_of_their_own() {
    let dir = Dir::with(&["rotation-robust", "rotation-thrusters"]);
    let axes = [
        ("torque", ["torque (N m)", "time (s)"]),
        ("angle", ["angle (deg)", "error ("]),
        ("outputs", ["section_4 (deg)", "time (s)"]),
        ("modes", ["displacement (deg)", "time (s)"]),
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
            // Large errors have the prefix of the angle, small ones their own.
            let has = |axis: &&str| texts.iter().any(|text| text.starts_with(*axis));
            assert!(axes.iter().all(has), "{name} {figure}: {texts:?}");
            assert!(figure != "torque" || words.iter().all(|word| texts.contains(word)), "{name}: {texts:?}");
        }
    }
    dir.run("plot rotation-robust.mcap --what phase-plane")
        .exits(2)
        .says(&["it has torque, angle, outputs, modes"]);
}

#[test]
#[cfg_attr(not(feature = "full"), ignore = "not in a light build")]
fn a_file_holds_one_figure_or_a_sheet_of_all() {
    let dir = simulated("--set duration=2000");
    dir.run("plot relay-adaptive.mcap -o figures").exits(0);
    dir.run("plot relay-adaptive.mcap -o gain.svg --what gain").exits(0).says(&["gain.svg"]);
    assert_eq!(dir.text("gain.svg"), svg(&dir, "gain"));
    dir.run("plot relay-adaptive.mcap -o gain.PNG --what gain --format png").exits(0);
    assert!(dir.read("gain.PNG") == dir.read("figures/relay-adaptive-gain.png"));
    let reported = dir.run("plot relay-adaptive.mcap -o all.svg --json").exits(0);
    assert_eq!((reported.err.as_str(), reported.out.lines().count()), ("", 1));
    assert_eq!(reported.json()["figures"].as_array().map(Vec::len), Some(FIGURES.len()));
    let sheet = dir.text("all.svg");
    let document = Document::parse(&sheet).expect("well-formed XML");
    let root = document.root_element();
    let number = |node: &Node<'_, '_>, name: &str| -> u32 {
        node.attribute(name).unwrap_or("0").parse().expect("a number")
    };
    let within: Vec<[u32; 4]> = root
        .children()
        .filter(|node| node.has_tag_name("svg"))
        .map(|node| ["x", "y", "width", "height"].map(|name| number(&node, name)))
        .collect();
    assert_eq!(within.len(), FIGURES.len());
    for (index, [x, y, width, height]) in within.iter().enumerate() {
        assert!(x + width <= number(&root, "width") && y + height <= number(&root, "height"));
        let apart =
            |[a, b, w, h]: &[u32; 4]| x + width <= *a || a + w <= *x || y + height <= *b || b + h <= *y;
        assert!(within[..index].iter().all(apart), "figures overlap: {within:?}");
    }
    dir.run("plot relay-adaptive.mcap -o all.png").exits(0);
    assert_eq!(size(&dir.read("all.png")), ["width", "height"].map(|name| 2 * number(&root, name)));
    dir.run("plot relay-adaptive.mcap -o all.png --format svg").exits(2).says(&["--format", "all.png"]);
    for other in ["all.eps", "figures/all.JPG"] {
        dir.run(&format!("plot relay-adaptive.mcap -o {other}"))
            .exits(2)
            .says(&[other, ".svg, .png or .pdf"]);
        assert!(!dir.has(other));
    }
    dir.run("plot relay-adaptive.mcap --metric duty").exits(2).says(&["not the directory of a campaign"]);
}

#[test]
fn torn_and_interrupted_logs() {
    let dir = simulated("--set duration=2000 --log full");
    let whole = dir.read("relay-adaptive.mcap");
    dir.write("torn.mcap", &whole[..whole.len() / 2]);
    dir.run("plot torn.mcap -o torn.svg").exits(2).says(&["torn.mcap", "flexsc log recover"]);
    assert!(!dir.has("torn.svg"));
    // The recovered part can be drawn.
    dir.run("log recover torn.mcap --json").exits(0);
    dir.run("plot torn-recovered.mcap -o saved.svg").exits(0);
    assert!(dir.has("saved.svg"));
    dir.write("none.mcap", "no log");
    dir.run("plot none.mcap").exits(2).says(&["none.mcap"]);
    dir.run("plot missing.mcap").exits(2).says(&["missing.mcap"]);
}

#[test]
fn spatial_figures_have_units_that_people_use() {
    let dir = Dir::with(&["iss-ringdown"]);
    dir.run("simulate iss-ringdown.toml --set duration=60").exits(0);
    dir.run("plot iss-ringdown.mcap --format svg -o figures").exits(0);
    for (figure, words) in [
        ("energy", ["elastic energy (J)", "propellant (kg)"]),
        ("tracking", ["roll (Hz)", "estimated"]),
        ("jets", ["yaw pulse (s)", "time (s)"]),
        ("damping", ["predicted elastic rate", "threshold"]),
    ] {
        let svg = dir.text(&format!("figures/iss-ringdown-{figure}.svg"));
        let document = Document::parse(&svg).expect("well-formed XML");
        let texts: Vec<_> = document.descendants().filter_map(|node| node.text()).map(str::trim).collect();
        assert!(words.iter().all(|word| texts.contains(word)), "{figure}: {texts:?}");
    }
}

#[test]
fn a_log_of_other_settings_than_the_file_beside_it_is_drawn_with_a_note() {
    let dir = Dir::with(&["relay-fixed"]);
    dir.run("simulate relay-fixed.toml --set duration=100").exits(0);
    let note = "relay-fixed.mcap holds a run with other settings than relay-fixed.toml has now (`duration`: ";
    dir.run("plot relay-fixed.mcap --what torque -o x.svg").exits(0).says(&["note: ", note]);
    dir.run("simulate relay-fixed.toml --set duration=100 -o out").exits(0);
    // Nothing stands beside it.
    let quiet = dir.run("plot out/relay-fixed.mcap --what torque -o x.svg").exits(0);
    assert!(!quiet.err.contains("note"), "{}", quiet.err);
    // A run that was refused leaves the log of the one before.
    dir.write("relay-fixed.toml", "duration = -1");
    dir.run("simulate relay-fixed.toml").exits(2);
    let note = "note: relay-fixed.toml is not accepted now: relay-fixed.mcap holds an earlier run";
    dir.run("plot relay-fixed.mcap --what torque -o x.svg").exits(0).says(&[note]);
}
