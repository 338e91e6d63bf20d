//! Rotations by a load that is distributed over the body (`manoeuvre.load`), against an integration of the generalised
//! coordinates (`golden/load_oracle.py`).

use flexsc_core::Scenario;
use flexsc_core::record::Trace;

use crate::spacecraft::{body, plan, report};
use crate::study::{close, scenario};
use crate::traces::{column, nested, times, traced};
use crate::util::Dir;

/// Quantity, time (s) and value of each row of a case.
fn golden(case: &str) -> Vec<(String, f64, f64)> {
    let path = format!("{}/../../tests/golden/load.csv", env!("CARGO_MANIFEST_DIR"));
    let text = std::fs::read_to_string(path).expect("a file");
    let row = |line: &str| {
        let cells: Vec<&str> = line.split(',').collect();
        let number = |cell: &str| cell.parse().expect("a number");
        (cells[0] == case).then(|| (cells[1].to_owned(), number(cells[2]), number(cells[3])))
    };
    text.lines().skip(1).filter_map(row).collect()
}

/// Checks angle, rate and outputs of a run at the instants of a case, to `tolerance` (rad, rad/s, m).
fn follows(scenario: &Scenario, case: &str, tolerance: f64) {
    let trace: Trace = traced(scenario);
    let at = times(&trace, "/attitude");
    let outputs = &body(scenario).outputs;
    let mut compared = 0;
    for (quantity, time, exact) in golden(case) {
        let values = match quantity.as_str() {
            "angle" => column(&trace, "/attitude", "angle_rad").to_vec(),
            "rate" => column(&trace, "/rate", "rate_rad_s").to_vec(),
            name => match outputs.iter().position(|output| output.name == name) {
                Some(index) => nested(&trace, "/outputs", ["outputs", "value"], (index, outputs.len())),
                None => continue,
            },
        };
        let row = at.iter().position(|t| (t - time).abs() < 1e-9).expect("a row");
        let error = (values[row] - exact).abs();
        assert!(
            error < tolerance,
            "{case}: {quantity} at {time} s is {} for {exact}: {error:e}",
            values[row]
        );
        compared += 1;
    }
    assert!(compared >= 44, "{case}: {compared} numbers");
}

/// Checks the coefficients of a case, and the elastic energy that its plan leaves.
fn is_planned(scenario: &Scenario, case: &str) {
    let (plan, report) = (plan(scenario), report(scenario));
    let coefficients = plan.coefficients.as_ref().expect("a series");
    for (quantity, _, exact) in golden(case) {
        if let Some(index) = quantity.strip_prefix("coefficient_") {
            close(coefficients.odd[index.parse::<usize>().expect("an index")], exact, 1e-9);
        }
        if quantity == "energy" {
            // What is left of all modes at rest is rounding.
            let error = (report.energy - exact).abs();
            assert!(error < 1e-6 * exact + 1e-22, "{case}: {:e} J for {exact:e}", report.energy);
        }
    }
}

/// The quarter turn of the panels by a load.
fn on_panels(load: &str, command: &str, set: &[(&str, &str)]) -> Scenario {
    let own = [
        ("manoeuvre.load", load),
        ("manoeuvre.command", command),
        ("duration", "20.0"),
        ("log.period", "0.5"),
    ];
    scenario("rotation-sine", &[&own, set].concat())
}

#[test]
fn torques_on_sections_of_panels() {
    let tips = "{ sections = [0.0, 0.0, 0.0, 1.0] }";
    for (case, load, command, end_rate) in [
        ("tips", tips, "{ sine = { suppress = 2 } }", "0.0"),
        ("shared", "{ hub = 1.0, sections = [0, 0, 0.25, 0.5] }", "{ cosine = { suppress = 1 } }", "0.1"),
        (
            "all-modes",
            "{ hub = -1.0, sections = [0.0, 2.0, 0.0, 0.5] }",
            "{ sine = { suppress = 4 } }",
            "0.0",
        ),
    ] {
        let scenario = on_panels(load, command, &[("manoeuvre.end_rate", end_rate)]);
        is_planned(&scenario, case);
        follows(&scenario, case, 1e-11);
    }
    // Only the ratios of a load matter, and an actuator that holds its torque acts there too.
    let held = on_panels(
        "{ sections = [0, 0, 0, 7] }",
        "{ sine = { suppress = 1 } }",
        &[("actuator", "{ hold = { period = 0.02 } }")],
    );
    follows(&held, "held", 1e-11);
}

#[test]
fn torques_on_sections_that_turn_by_any_angle() {
    let exact = on_panels(
        "{ hub = 0.5, sections = [0, 0, 0.1, 0.3] }",
        "{ sine = { suppress = 1 } }",
        &[("body.panels.kinematics", "\"exact\"")],
    );
    follows(&exact, "exact", 1e-9);
}

const ARMS: &str = "
duration = 20.0
log = { period = 0.5 }
[body.matrices]
mass = [[40, 0, 0, 0, 0], [0, 6, 0, 0, 0], [0, 0, 4, 0, 0], [0, 0, 0, 6, 0], [0, 0, 0, 0, 4]]
stiffness = [
    [1200, -60, -120, 60, 120],
    [-60, 150, -60, 0, 0],
    [-120, -60, 60, 0, 0],
    [60, 0, 0, 150, -60],
    [120, 0, 0, -60, 60],
]
rotation = [1, 2, 4, -2, -4]
coordinates = [\"hub\", \"a1\", \"a2\", \"b1\", \"b2\"]
outputs = [{ name = \"tip_a\", unit = \"m\", weights = { a2 = 1 } }, { name = \"tip_b\", unit = \"m\", weights = { b2 = 1 } }]
[manoeuvre]
angle = 1.5707963267948966
time = 12.0
load = { a2 = 3.0, b1 = 0.2 }
command = { sine = { suppress = 2 } }
";

const TWINS: &str = "
duration = 20.0
log = { period = 0.5 }
[body.matrices]
mass = [[50, 8, 0], [8, 4, 0], [0, 0, 4]]
stiffness = [[0, 0, 0], [0, 30, 0], [0, 0, 42]]
outputs = [{ name = \"v\", unit = \"m\", weights = { q1 = 1 } }, { name = \"s\", unit = \"m\", weights = { q2 = 1 } }]
[manoeuvre]
angle = 1.5707963267948966
time = 12.0
load = [1.0, 0.1, 0.05]
command = { cosine = { suppress = 1 } }
";

fn parsed(text: &str) -> Scenario {
    Scenario::parse("loads.toml", text).expect("a valid scenario")
}

/// A force on one arm of two also excites the modes that do not turn the hub.
#[test]
fn forces_on_coordinates_of_matrices() {
    for (text, case) in [(ARMS, "one-arm"), (TWINS, "twins")] {
        let scenario = parsed(text);
        is_planned(&scenario, case);
        follows(&scenario, case, 1e-10);
        // Without its matrices: the gains of the modes are those of the load.
        let written = scenario.self_contained();
        assert!(written.manoeuvre.as_ref().is_some_and(|manoeuvre| manoeuvre.load.is_none()));
        let again = parsed(&written.to_toml());
        assert_eq!(body(&again), body(&scenario));
        assert_eq!(plan(&again), plan(&scenario));
    }
}

/// The modes of the panels as a planar body: the load on each is X_n' Q/X_n[theta] for the torque Q[theta].
#[test]
fn loads_on_modes_of_a_planar_body() {
    let panels = on_panels("{ sections = [0, 0, 0, 1] }", "{ sine = { suppress = 2 } }", &[]);
    let mut written = panels.self_contained();
    let model = body(&panels);
    let mut planar = flexsc_core::spacecraft::body::Planar::from(model);
    let loads: Vec<f64> = model.modes.iter().map(|mode| mode.gain.get() / mode.hub_gain.get()).collect();
    for mode in &mut planar.modes {
        let at_hub = mode.hub_gain.take().expect("a load elsewhere");
        mode.gain = at_hub;
    }
    written.body = Some(flexsc_core::spacecraft::body::Body::Planar(planar));
    let load = format!("{{ rigid = 1.0, modes = {loads:?} }}");
    let text = written.to_toml().replace("[manoeuvre.load]\nsections = [0.0, 0.0, 0.0, 1.0]\n", "");
    let mut document = flexsc_core::Document::parse("planar.toml", text).expect("TOML");
    document.set_text("manoeuvre.load", &load).expect("a key");
    let planar = Scenario::from_document(&document).expect("a valid scenario");
    is_planned(&planar, "tips");
    follows(&planar, "tips", 1e-11);
}

/// A torque on the hub given as a load is the default to the last bit of the log.
#[test]
fn the_default_is_a_torque_on_the_hub() {
    let dir = Dir::with(&["rotation-sine"]);
    let rows = |set: &str| {
        dir.run(&format!("simulate rotation-sine.toml {set} --log full -o run.mcap --force")).exits(0);
        dir.run("export run.mcap --topic attitude -o attitude.csv --force").exits(0);
        dir.text("attitude.csv")
    };
    assert_eq!(rows(""), rows("--set manoeuvre.load={hub=2.0}"));
}

/// Name of a case, its keys with their values, and words of its error.
type Refused = (&'static str, &'static [(&'static str, &'static str)], &'static [&'static str]);

#[rustfmt::skip] // One case a line.
const REFUSED: &[Refused] = &[
    ("few sections", &[("manoeuvre.load", "{ sections = [0, 1, 0] }")], &["`manoeuvre.load.sections` must have one number for each of 4 sections, got 3"]),
    ("a number for sections", &[("manoeuvre.load", "{ sections = 1.0 }")], &["`manoeuvre.load.sections` must be an array with one number for each section, got 1"]),
    ("a list for the hub", &[("manoeuvre.load", "{ hub = [1.0] }")], &["`manoeuvre.load.hub` must be a number, got an array"]),
    ("a name of no part", &[("manoeuvre.load", "{ hub = 1.0, tip = 0.5 }")], &["`manoeuvre.load.tip` must be `hub` or `sections`, got `tip`"]),
    ("an array for panels", &[("manoeuvre.load", "[1.0, 0, 0, 0, 0]")], &["`manoeuvre.load` must be a table with `hub` and `sections`, got an array"]),
    ("no torque", &[("manoeuvre.load", "{ hub = -2.0, sections = [0, 1, 0, 0] }")], &["`manoeuvre.load` must turn the body, but its torque about the axis is 0"]),
    ("nothing", &[("manoeuvre.load", "{}")], &["`manoeuvre.load` must turn the body, but its torque about the axis is 0"]),
    ("a text", &[("manoeuvre.load", "\"tip\"")], &["manoeuvre.load", "a table of loads by name, or an array with one for each coordinate"]),
    ("not finite", &[("manoeuvre.load", "{ hub = inf }")], &["manoeuvre.load", "must be a finite number"]),
    ("a given motion", &[("manoeuvre.load", "{ hub = 1.0 }"), ("body.panels.drive", "\"motion\"")], &["`manoeuvre.load` needs a commanded torque"]),
    ("a disturbance", &[("manoeuvre.load", "{ sections = [0, 1, 0, 0] }"), ("disturbance", "[{ torque = 1.0 }]")], &["`disturbance[0]` is a torque that acts on the hub, but the actuator of this body elsewhere"]),
    ("a wheel", &[("manoeuvre.load", "{ sections = [0, 1, 0, 0] }"), ("actuator", "{ wheel = { gain = 1.0, back_emf = 0.1 } }"), ("law", "{ pd = { k_p = 1.0, k_d = 1.0, period = 0.1 } }")], &["`actuator.wheel` is a wheel that acts on the hub"]),
];

#[test]
fn loads_that_do_not_fit_are_refused_at_their_keys() {
    let refused = |mut document: flexsc_core::Document, set: &[(&str, &str)], name: &str, words: &[&str]| {
        for (key, value) in set {
            document.set_text(key, value).expect("a key");
        }
        let error = Scenario::from_document(&document).expect_err(name).to_string();
        assert!(words.iter().all(|word| error.contains(word)), "{name}: {error}");
    };
    let path = format!("{}/../../scenarios/rotation-sine.toml", env!("CARGO_MANIFEST_DIR"));
    for (name, set, words) in REFUSED {
        refused(flexsc_core::Document::load(path.as_ref()).expect("a scenario"), set, name, words);
    }
    for (load, words) in [
        ("{ a3 = 1.0 }", "`manoeuvre.load.a3` must name a coordinate (`hub` to `b2`), got `a3`"),
        ("{ a2 = [1.0] }", "`manoeuvre.load.a2` must be a number, got an array"),
        ("[1, 0, 0]", "`manoeuvre.load` must have one number for each of 5 coordinates, got 3"),
        ("{ a2 = 1.0, b2 = 1.0 }", "`manoeuvre.load` must turn the body"),
    ] {
        let document = flexsc_core::Document::parse("arms.toml", ARMS.to_owned()).expect("TOML");
        refused(document, &[("manoeuvre.load", load)], load, &[words]);
    }
    let planar = |load: &str| {
        format!(
            "duration = 20.0\n[body.planar]\nmodes = [{{ frequency = 3.0, gain = 0.5 }}]\n\
             [manoeuvre]\nangle = 1.0\ntime = 12.0\nload = {load}\ncommand = {{ bang_bang = {{}} }}\n"
        )
    };
    for (load, words) in [
        (
            "{ rigid = 1.0, modes = [1.0, 2.0] }",
            "`manoeuvre.load.modes` must have one number for each of 1 mode, got 2",
        ),
        ("{ modes = [1.0] }", "`manoeuvre.load` must turn the body"),
    ] {
        let document = flexsc_core::Document::parse("planar.toml", planar(load)).expect("TOML");
        refused(document, &[], load, &[words]);
    }
    let document =
        flexsc_core::Document::parse("planar.toml", planar("{ rigid = 1.0, modes = [2.0] }")).expect("TOML");
    let twice = [("body.planar.modes[0].hub_gain", "0.4")];
    refused(document, &twice, "both", &["`manoeuvre.load` must be left out where a mode has a `hub_gain`"]);
}

/// `check` points at the load.
#[test]
fn the_command_points_at_the_load() {
    let dir = Dir::with(&["rotation-panel-torque"]);
    let text = dir
        .text("rotation-panel-torque.toml")
        .replace("sections = [0.0, 1.0, 0.0, 0.0]", "sections = [0.0, 1.0]");
    dir.write("few.toml", text);
    let words = [
        "few.toml:",
        "manoeuvre.load.sections",
        "must have one number for each of 4 sections, got 2",
        "^^^^^^^^^^",
    ];
    dir.run("check few.toml").exits(2).says(&words);
}

/// Actuators on the second section of each panel bend the panels less than a torque on the hub.
#[test]
fn the_shipped_load() {
    let dir = Dir::with(&["rotation-panel-torque", "rotation-sine"]);
    let planned = |name: &str| dir.run(&format!("plan {name}.toml --json")).exits(0).json();
    let (panels, hub) = (planned("rotation-panel-torque"), planned("rotation-sine"));
    assert_eq!(panels["coefficients_nm"], hub["coefficients_nm"]);
    assert_eq!(panels["load"]["sections"][1], 1.0);
    let bent = |plan: &serde_json::Value| plan["peak_deflection_rad"].as_f64().expect("a number");
    // The reference has a value each 5 ms.
    close(bent(&panels), 0.089_716_964_6, 1e-5);
    close(bent(&hub), 0.304_802_746_8, 1e-9);
    let load = "  load             hub 0, sections 0, 1, 0, 0";
    dir.run("plan rotation-panel-torque.toml").exits(0).says(&[load]);
}
