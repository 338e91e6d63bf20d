//! Sheets of several figures, and figures of three axes whose curves coincide, are empty, or lie decades apart.

use roxmltree::{Document, Node};

use crate::drawing::Drawing;
use crate::util::{Dir, table};

/// The texts of a drawing.
fn texts(svg: &str) -> Vec<String> {
    let document = Document::parse(svg).expect("well-formed XML");
    document.descendants().filter_map(|node| node.text()).map(|text| text.trim().to_owned()).collect()
}

/// The widths of the lines of a colour, of the widest first (tenths of a pixel).
fn widths(svg: &str, colour: &str) -> Vec<u32> {
    let document = Document::parse(svg).expect("well-formed XML");
    let of = |node: Node<'_, '_>| {
        let drawn = node.attribute("stroke") == Some(colour);
        node.attribute("stroke-width").filter(|_| drawn)?.parse().ok()
    };
    let mut found: Vec<u32> = document.descendants().filter_map(of).collect();
    found.sort_unstable_by(|a, b| b.cmp(a));
    found
}

#[test]
fn no_part_of_a_sheet_is_left_blank() {
    for (scenario, options) in [
        ("earth-observer", "--set duration=40"),
        ("iss-manoeuvre", "--set duration=40"),
        ("wheel-ekf", "--set duration=40"),
    ] {
        let dir = Dir::with(&[scenario]);
        dir.run(&format!("simulate {scenario}.toml {options}")).exits(0);
        dir.run(&format!("plot {scenario}.mcap -o all.svg")).exits(0);
        let sheet = dir.text("all.svg");
        let document = Document::parse(&sheet).expect("well-formed XML");
        let area = |node: &Node<'_, '_>| -> f64 {
            ["width", "height"]
                .map(|name| node.attribute(name).expect("a size").parse::<f64>().expect("px"))
                .iter()
                .product()
        };
        let root = document.root_element();
        let covered: f64 =
            root.children().filter(|node| node.has_tag_name("svg")).map(|node| area(&node)).sum();
        let blank = 1.0 - covered / area(&root);
        assert!((0.0..0.02).contains(&blank), "{scenario}: {blank}");
    }
}

#[test]
fn coincident_curves_both_show() {
    let dir = Dir::with(&["earth-observer"]);
    dir.run("simulate earth-observer.toml --set duration=60").exits(0);
    dir.run("plot earth-observer.mcap -o figures --format svg").exits(0);
    let svg = |figure: &str| dir.text(&format!("figures/earth-observer-{figure}.svg"));
    for (figure, wide, narrow, names) in [
        ("rates", "#56B4E9", "#000000", ["at the gyro, with elastic part", "rigid part"]),
        ("energy", "#56B4E9", "#D55E00", ["all modes", "modes that move the gyro"]),
        ("torques", "#56B4E9", "#000000", ["demanded by the law", "given by the actuators"]),
    ] {
        let drawn = svg(figure);
        assert!(names.iter().all(|name| texts(&drawn).iter().any(|text| text == name)), "{figure}");
        // The line below is more than twice as wide as that above it.
        assert!(widths(&drawn, wide)[0] > 2 * widths(&drawn, narrow)[0], "{figure}");
    }
    // Errors have a panel of decades.
    let consistency = texts(&svg("consistency"));
    assert!(consistency.iter().any(|text| text == "norm (arcsec)"), "{consistency:?}");
}

/// The mean in the figure is the metric, over the same interval.
#[test]
fn the_mean_of_nees_is_the_metric() {
    let dir = Dir::with(&["earth-observer"]);
    dir.run("simulate earth-observer.toml --set duration=120 --log full").exits(0);
    let reported = dir.run("simulate earth-observer.toml --set duration=120 --log none --json").exits(0);
    let mean = reported.json()["metrics"]["nees_mean"].as_f64().expect("a number");
    dir.run("plot earth-observer.mcap -o figures --what consistency --format svg").exits(0);
    let found = texts(&dir.text("figures/earth-observer-consistency.svg"));
    let expected = format!("mean {mean:.2} from 60 to 120 s");
    assert!(found.contains(&expected), "{expected}: {found:?}");
}

#[test]
fn points_that_modes_move_have_their_deflection() {
    let dir = Dir::with(&["iss-manoeuvre", "panel-deployment"]);
    dir.run("simulate iss-manoeuvre.toml --set duration=30").exits(0);
    dir.run("plot iss-manoeuvre.mcap --what deflection -o d.svg").exits(0);
    let found = texts(&dir.text("d.svg"));
    assert!(found.iter().any(|text| text == "gyro (mm)"), "{found:?}");
    // The tail is the first of the points: the others move against it.
    assert!(!found.iter().any(|text| text.starts_with("tail")), "{found:?}");
    dir.run("simulate panel-deployment.toml --set duration=5").exits(0);
    dir.run("plot panel-deployment.mcap --what deflection -o d.svg --json").exits(2).says(&["no figure"]);
}

#[test]
fn axes_without_pulses_have_no_panel() {
    let dir = Dir::with(&["momentum-unloading"]);
    dir.run("simulate momentum-unloading.toml --set duration=1400").exits(0);
    dir.run("plot momentum-unloading.mcap --what jets,rates -o figures --format svg").exits(0);
    let jets = texts(&dir.text("figures/momentum-unloading-jets.svg"));
    assert!(jets.iter().any(|text| text == "roll pulse (s)"), "{jets:?}");
    assert!(!jets.iter().any(|text| text.starts_with("pitch") || text.starts_with("yaw")), "{jets:?}");
    // An axis that is at rest has none either.
    let rates = texts(&dir.text("figures/momentum-unloading-rates.svg"));
    assert!(rates.iter().any(|text| text == "roll (deg/s)"), "{rates:?}");
    assert!(!rates.iter().any(|text| text.starts_with("pitch") || text.starts_with("yaw")), "{rates:?}");
}

#[test]
fn a_requirement_is_drawn_with_the_runs_that_meet_it() {
    let dir = Dir::with(&["half-turn"]);
    dir.run("simulate half-turn.toml --runs 20 --table csv -o first --set reference.pointing.rms=1").exits(0);
    let errors = table(&dir, "first/runs.csv")
        .into_iter()
        .map(|row| row["pointing_rms_rad"].parse().expect("a number"));
    let mut errors: Vec<f64> = errors.collect();
    errors.sort_by(f64::total_cmp);
    let most = f64::midpoint(errors[12], errors[13]);
    dir.run(&format!(
        "simulate half-turn.toml --runs 20 --table csv -o out --set reference.pointing.rms={most:e}"
    ))
    .exits(3);
    dir.run("plot out -o figures --format svg").exits(0);
    let names = dir.names("figures");
    assert!(names.contains(&"half-turn-distribution-pointing_rms_rad.svg".to_owned()), "{names:?}");
    assert_eq!(table(&dir, "out/runs.csv").iter().filter(|row| row["requirement"] == "met").count(), 13);
    let drawing = |figure: &str| Drawing::read(&dir, &format!("half-turn-{figure}-pointing_rms_rad"));
    // scipy.stats.binomtest(13, 20).proportion_ci(0.95, "wilson"): 0.4329 to 0.8188.
    drawing("distribution").shows(&["13 of 20 runs meet the limit: 65 % (43 to 82 %)"]);
    let limit = drawing("scatter")
        .texts()
        .into_iter()
        .find_map(|text| text.strip_prefix("at most ")?.strip_suffix(" arcsec")?.parse::<f64>().ok());
    let limit = limit.expect("a limit") * std::f64::consts::PI / 648_000.0;
    assert!((limit / most - 1.0).abs() < 1e-2, "{limit} {most}");
}

/// A legend names no mark that lies outside the picture.
#[test]
fn a_mark_outside_the_picture_has_no_name() {
    let dir = Dir::with(&["wheel-fast-mode"]);
    // The scenario lies at 0.2 rad/s.
    for (frequencies, inside) in [("0.1:0.3:5", true), ("0.25:0.35:5", false)] {
        let grid = format!("--frequency {frequencies} --period 1:5:5");
        dir.run(&format!("map wheel-fast-mode.toml {grid} -o map.svg")).exits(0);
        assert_eq!(
            texts(&dir.text("map.svg")).iter().any(|text| text == "scenario"),
            inside,
            "{frequencies}"
        );
        std::fs::remove_file(dir.path("map.svg")).expect("there");
    }
}
