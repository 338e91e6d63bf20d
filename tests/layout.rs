//! Viewer layouts: one source for shipped, attached and written ones, and every path of them in a log.

use std::collections::{BTreeMap, BTreeSet};

use flexsc_core::record::{Column, Columns, Log};
use serde_json::Value;

use crate::util::{Dir, SCENARIOS};

/// The scenarios whose layouts are shipped, by the layouts' names.
const SHIPPED: [(&str, &str); 5] = [
    ("relay", "relay-adaptive"),
    ("rotation", "rotation-robust"),
    ("wheel", "wheel-ekf"),
    ("spatial", "iss-manoeuvre"),
    ("spacecraft", "earth-observer"),
];

/// Runs with the estimators, actuators and bodies that the others lack.
const OTHERS: [(&str, &str); 15] = [
    ("relay-sampled", "--set duration=1000"),
    ("rotation-thrusters", ""),
    ("rotation-nonlinear", ""),
    ("wheel-fast-mode", "--set duration=20"),
    ("iss-manoeuvre-off", "--set duration=60"),
    ("iss-mismatch", "--set duration=60"),
    ("attitude-hold", "--set duration=40"),
    ("slew-wheel-lqg", ""),
    ("momentum-unloading", "--set duration=1400"),
    ("thruster-phase-plane", "--set duration=60"),
    ("detumble-and-point", "--set duration=60"),
    ("safe-mode", "--set duration=60"),
    ("station-keeping", "--set duration=300"),
    ("wheel-friction", "--set duration=60"),
    ("wheel-run-up", "--set duration=10"),
];

/// Collects the contents of a layout's panels: paths and topics.
fn paths(value: &Value, found: &mut BTreeSet<String>) {
    match value {
        Value::Object(object) => {
            for (key, value) in object {
                match (key.as_str(), value) {
                    ("value" | "topicPath" | "topicToRender", Value::String(text)) => {
                        found.insert(text.clone());
                    }
                    ("topics", Value::Object(topics)) => found.extend(topics.keys().cloned()),
                    _ => paths(value, found),
                }
            }
        }
        Value::Array(array) => array.iter().for_each(|value| paths(value, found)),
        _ => {}
    }
}

/// The panels that a mosaic or a tab names.
fn named(value: &Value, found: &mut Vec<String>) {
    match value {
        Value::String(id) => found.push(id.clone()),
        Value::Object(object) => {
            for part in ["first", "second"].iter().filter_map(|key| object.get(*key)) {
                named(part, found);
            }
        }
        _ => panic!("{value}"),
    }
}

/// Returns true if columns have a field such as `modes[0].displacement_rad`.
fn has(columns: &Columns, field: &str) -> bool {
    match field.split_once('[') {
        None => columns.get(field).is_some_and(|column| !column.is_empty()),
        Some((rows, rest)) => {
            let Some((index, inner)) = rest.split_once("].") else { return false };
            let index: u32 = index.parse().expect("an index");
            matches!(columns.get(rows), Some(Column::Rows(counts, columns)) if counts[0] > index && has(columns, inner))
        }
    }
}

/// The column of a field such as `channels[0].latched`, of the first row.
fn at<'a>(columns: &'a Columns, field: &str) -> Option<&'a Column> {
    match field.split_once('[') {
        None => columns.get(field),
        Some((rows, rest)) => match columns.get(rows) {
            Some(Column::Rows(_, columns)) => at(columns, rest.split_once("].")?.1),
            _ => None,
        },
    }
}

/// Every path of a layout must be a field of the log of a run, and every panel have its place.
fn check(log: &Log, layout: &str) {
    let layout: Value = serde_json::from_str(layout).expect("JSON");
    let mut found = BTreeSet::new();
    paths(&layout["configById"], &mut found);
    assert!(found.len() > 8, "{found:?}");
    let paths = found.iter().filter(|path| path.parse::<f64>().is_err());
    let found: Vec<(&str, &str)> = paths.map(|path| path.split_once('.').unwrap_or((path, ""))).collect();
    // The log is read once, for all topics.
    let others = ["/tf", "/summary", "/metrics"];
    let topics: BTreeSet<&str> = found.iter().map(|(topic, _)| *topic).chain(others).collect();
    let topics: Vec<&str> = topics.into_iter().collect();
    let read = log.tables(&topics).unwrap_or_else(|error| panic!("{error}"));
    let all: BTreeMap<&str, Option<Columns>> = topics.into_iter().zip(read).collect();
    let columns = |topic: &str| all[topic].as_ref().unwrap_or_else(|| panic!("{topic}: not in the log"));
    for (topic, field) in &found {
        assert!(field.is_empty() || has(columns(topic), field), "{topic}.{field}: no such field");
    }
    let panels = layout["configById"].as_object().expect("panels");
    let mut tables = 0;
    let mut places = Vec::new();
    named(&layout["layout"], &mut places);
    for (id, config) in panels {
        assert_eq!(config["foxglovePanelTitle"], config["lichtblickPanelTitle"], "{id}");
        for tab in config["tabs"].as_array().into_iter().flatten() {
            let before = places.len();
            named(&tab["layout"], &mut places);
            assert!((1..=10).contains(&(places.len() - before)), "{id}: {tab}");
        }
        if let Some(paths) = config["paths"].as_array() {
            // Lichtblick gives a synchronised plane the range of the others' time.
            assert_eq!(config["isSynced"], config.get("xAxisPath").is_none(), "{id}");
            let label = |path: &Value| path["label"].as_str().expect("a label").chars().count() as u64;
            let longest = paths.iter().map(label).max().unwrap_or(0);
            // Its legends need a square, a mark and an arrow beside the words.
            let width = config.get("sidebarDimension").map_or(u64::MAX, |width| width.as_u64().expect("px"));
            assert!(width >= 78 + 7 * longest, "{id}: the legend is cut off at {width} px");
            for path in paths.iter().filter(|_| id.starts_with("StateTransitions!")) {
                let path = path["value"].as_str().expect("a path");
                let (topic, field) = path.split_once('.').expect("a field");
                let named = matches!(at(columns(topic), field), Some(Column::Labels(..) | Column::Texts(..)));
                assert!(named, "{path}: states without names");
            }
        }
        if id.starts_with("3D!") {
            let transforms = &config["scene"]["transforms"];
            let most = transforms["maxPreloadMessages"].as_u64().expect("a number");
            let count = columns("/tf").len() as u64;
            assert!(transforms["enablePreloading"] == true && count <= most, "{id}: {transforms} of {count}");
        }
        if id.starts_with("Table!") {
            let path = config["topicPath"].as_str().expect("a path");
            let rows = at(columns("/summary"), path.strip_prefix("/summary.").expect("a page"))
                .map_or(0, Column::len);
            assert!(rows > 0, "{path}");
            tables += 1;
        }
        // Viewers show nothing of a plane whose axes are of one topic.
        let topic = |path: &Value| path.as_str().and_then(|path| path.split('.').next()).map(str::to_owned);
        if let Some(x) = config.get("xAxisPath") {
            for path in config["paths"].as_array().expect("paths") {
                assert_ne!(topic(&path["value"]), topic(&x["value"]), "{id}");
            }
        }
    }
    // Every page of ten rows has its table, and every metric its row.
    let Some(Column::Rows(pages, inner)) = columns("/summary").get("pages") else { panic!("no pages") };
    let Some(Column::Rows(rows, lines)) = inner.get("metrics") else { panic!("no metrics") };
    assert_eq!((pages[0], pages[0] as usize), (tables, rows.len()));
    assert!(rows.iter().all(|rows| (1..=10).contains(rows)), "{rows:?}");
    let names = |table: &Columns| match table.get("name") {
        Some(Column::Texts(names)) => names.iter().cloned().collect::<BTreeSet<_>>(),
        _ => panic!("no names"),
    };
    let Some(Column::Rows(_, metrics)) = columns("/metrics").get("metrics") else { panic!("no metrics") };
    assert!(names(lines).is_superset(&names(metrics)));
    places.sort();
    let mut ids: Vec<&String> = panels.keys().collect();
    ids.sort();
    assert_eq!(places.iter().collect::<Vec<_>>(), ids);
}

fn attached(bytes: &[u8]) -> String {
    let summary = mcap::Summary::read(bytes).expect("whole").expect("a summary");
    let index =
        summary.attachment_indexes.iter().find(|index| index.name == "layout.json").expect("attached");
    String::from_utf8(mcap::read::attachment(bytes, index).expect("whole").data.into_owned()).expect("text")
}

/// A layout without the ends of its axes, which come from the values of a log.
fn without_limits(layout: &str) -> Value {
    let mut layout: Value = serde_json::from_str(layout).expect("JSON");
    for config in layout["configById"].as_object_mut().expect("panels").values_mut() {
        let config = config.as_object_mut().expect("a panel");
        assert_eq!(config.remove("minYValue").is_some(), config.remove("maxYValue").is_some());
    }
    layout
}

/// The layout attached to a log, and the one that the command writes for it, show the topics of the log.
fn run(scenario: &str, options: &str) {
    let dir = Dir::with(&[scenario]);
    for detail in ["events", "full", "scene"] {
        dir.run(&format!("simulate {scenario}.toml --log {detail} {options}")).exits(0);
        let name = format!("{scenario}.mcap");
        let layout = attached(&dir.read(&name));
        dir.run(&format!("layout {name} -o layout.json --force")).exits(0);
        let written = dir.text("layout.json");
        let same = without_limits(&written) == serde_json::from_str::<Value>(&layout).expect("JSON");
        assert!(same, "{scenario} {detail}: attached and written differ");
        assert_eq!(layout.contains("\"3D!scene\""), detail == "scene");
        if detail == "scene" {
            // A viewer of a live run has no log of it yet.
            dir.run(&format!("layout {scenario}.toml {options} -o before.json")).exits(0);
            assert!(dir.text("before.json") == written, "{scenario}: of the scenario and of its log differ");
            dir.run(&format!("layout {name} --set duration=1.0")).exits(2).says(&["is a log"]);
        }
        if detail != "events" {
            check(&Log::open(&dir.path(&name)).expect("a log"), &layout);
        }
    }
}

#[test]
fn layouts_show_what_logs_have() {
    run("relay-adaptive", "--set duration=1200");
    run("rotation-robust", "");
    run("wheel-ekf", "--set duration=30");
    run("iss-manoeuvre", "--set duration=30");
    for (scenario, options) in OTHERS {
        run(scenario, options);
    }
}

/// Viewers have steps of 0.001 or more on the axes that they choose themselves, which leaves small values flat.
#[test]
fn small_values_have_axes_of_their_own() {
    let dir = Dir::with(&["relay-fixed", "rotation-robust"]);
    let plots = |scenario: &str| -> BTreeMap<String, Option<[f64; 2]>> {
        dir.run(&format!("layout {scenario}.toml -o layout.json --force")).exits(0);
        let layout: Value = serde_json::from_str(&dir.text("layout.json")).expect("JSON");
        let panels = layout["configById"].as_object().expect("panels").iter();
        let limits = |config: &Value| Some([config["minYValue"].as_f64()?, config["maxYValue"].as_f64()?]);
        panels.map(|(id, config)| (id.clone(), limits(config))).collect()
    };
    let relay = plots("relay-fixed");
    dir.run("simulate relay-fixed.toml --log full").exits(0);
    let log = Log::open(&dir.path("relay-fixed.mcap")).expect("a log");
    let rates = log.columns("/rate").expect("rates");
    let [mut least, mut greatest] = [f64::INFINITY, f64::NEG_INFINITY];
    for rate in rates.numbers("rate_rad_s").expect("numbers") {
        (least, greatest) = (least.min(*rate), greatest.max(*rate));
    }
    let [low, high] = relay["Plot!phase"].expect("an axis");
    // The axis has margins of 7 % of the range on both sides.
    assert!(low < least && greatest < high && high - low < 1.15 * (greatest - least), "{low} {high}");
    for plot in ["Plot!angle", "Plot!rate", "Plot!modes", "Plot!torque", "Plot!envelope"] {
        assert!(relay[plot].is_some(), "{plot}");
    }
    // Its values are large enough for a viewer.
    assert_eq!(plots("rotation-robust")["Plot!angle"], None);
}

/// Shipped layouts are those that `flexsc layout SCENARIO` writes.
#[test]
fn shipped_layouts_are_those_of_their_scenarios() {
    for (name, scenario) in SHIPPED {
        let dir = Dir::with(&[scenario]);
        dir.run(&format!("layout {scenario}.toml -o layout.json")).exits(0);
        let shipped = std::fs::read_to_string(format!("{SCENARIOS}/layouts/{name}.json")).expect("shipped");
        let same = shipped == dir.text("layout.json");
        assert!(same, "scenarios/layouts/{name}.json differs from what `flexsc layout` writes");
    }
}

/// A viewer takes minutes for hundreds of thousands of messages.
#[test]
fn a_long_log_has_some_ten_thousand_instants() {
    let dir = Dir::with(&["relay-adaptive"]);
    dir.run("simulate relay-adaptive.toml --log scene").exits(0);
    let bytes = dir.read("relay-adaptive.mcap");
    let summary = mcap::Summary::read(&bytes).expect("whole").expect("a summary");
    let statistics = summary.stats.expect("statistics");
    let counts: BTreeMap<&str, u64> = statistics
        .channel_message_counts
        .iter()
        .map(|(id, count)| (summary.channels[id].topic.as_str(), *count))
        .collect();
    let switchings = counts["/command"];
    assert!((1000..5000).contains(&switchings), "{switchings}");
    for (topic, count) in &counts {
        let most = match *topic {
            "/tf" | "/law" => 10_001,
            // A thruster that begins and one that ends.
            "/plumes" => switchings + 1,
            _ => 10_001 + switchings,
        };
        assert!(*count <= most, "{topic}: {count}");
    }
    assert_eq!(counts["/tf"], 10_001);
    assert!(statistics.message_count < 100_000, "{}", statistics.message_count);
    // A larger log is written on request.
    dir.run("simulate relay-adaptive.toml --log scene --set duration=2000 --set log.period=0.1 --force")
        .exits(0);
    let log = Log::open(&dir.path("relay-adaptive.mcap")).expect("a log");
    assert_eq!(log.columns("/tf").expect("frames").len(), 20_001);
}

/// The layout of a scenario, as JSON.
fn layout_of(scenario: &str) -> Value {
    let dir = Dir::with(&[scenario]);
    dir.run(&format!("layout {scenario}.toml -o layout.json")).exits(0);
    serde_json::from_str(&dir.text("layout.json")).expect("JSON")
}

/// Labels, colours, and whether lines join the points, of a plot.
fn lines(layout: &Value, plot: &str) -> Vec<(String, String, bool)> {
    let paths = layout["configById"][plot]["paths"].as_array().unwrap_or_else(|| panic!("{plot}"));
    let text = |path: &Value, key: &str| path[key].as_str().expect("a text").to_owned();
    let reported = |path: &Value| (text(path, "label"), text(path, "color"), path["showLine"] == true);
    paths.iter().map(reported).collect()
}

#[test]
fn plots_show_what_the_run_has_and_no_more() {
    let observer = layout_of("earth-observer");
    let labels = |layout: &Value, plot: &str| -> Vec<String> {
        lines(layout, plot).into_iter().map(|line| line.0).collect()
    };
    // A PD law has no dead zone; one in the phase plane has.
    assert_eq!(labels(&observer, "Plot!error"), ["roll", "pitch", "yaw"]);
    let station = layout_of("iss-manoeuvre");
    assert_eq!(labels(&station, "Plot!error"), ["roll", "pitch", "yaw", "+ dead zone", "- dead zone"]);
    // All eight modes, and their sum.
    assert_eq!(labels(&observer, "Plot!energy").len(), 9);
    // An error and its deviation are drawn differently.
    let angles = lines(&observer, "Plot!angles");
    for pair in angles.chunks(2) {
        assert_ne!(pair[0].1, pair[1].1, "{pair:?}");
    }
    assert_eq!(angles[1].0, "roll, standard deviation");
    // What is empty until the end has a tab of its own.
    let tabs = observer["configById"]["Tab!run"]["tabs"].as_array().expect("tabs");
    let titles: Vec<&str> = tabs.iter().map(|tab| tab["title"].as_str().expect("a title")).collect();
    assert_eq!(titles, ["Motion", "Attitude filter", "Elastic modes", "Log", "Metrics at the end"]);
    assert_eq!(tabs[3]["layout"], "RosOut!log");
}

/// Viewers mark each point of a line of few points in black, which hides a line of about as many points as pixels.
#[test]
fn curves_of_few_samples_keep_their_colours() {
    let deployment = layout_of("panel-deployment");
    assert!(lines(&deployment, "Plot!hinges").iter().all(|line| !line.2));
    // More points than pixels, and points of a sensor.
    assert!(lines(&layout_of("earth-observer"), "Plot!rigid").iter().all(|line| line.2));
    assert!(lines(&deployment, "Plot!angles").iter().all(|line| line.2));
}
