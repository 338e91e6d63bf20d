//! Answers of runs: the verdict first, the same strings in text and JSON, in the reader's units, on a screen.

use std::fs;

use serde_json::Value as Json;

use crate::util::{Dir, SCENARIOS};

/// Longest first screen, with the line on where to look next, and widest line.
const SCREEN: [usize; 2] = [15, 96];
/// Scenarios that take long; each is shortened to this duration (s).
const SHORTENED: [(&str, f64); 6] = [
    ("cubesat-day", 5000.0),
    ("forty-two-leo", 600.0),
    ("molniya", 2000.0),
    ("sun-tracking", 600.0),
    ("two-line-orbit", 600.0),
    ("wheel-run-up", 30.0),
];

fn texts(value: &Json) -> Vec<String> {
    match value {
        Json::String(text) => vec![text.clone()],
        Json::Array(all) => all.iter().flat_map(texts).collect(),
        Json::Object(all) => all.values().flat_map(texts).collect(),
        _ => Vec::new(),
    }
}

/// Each shipped scenario answers on one screen, without SI riddles, and with the strings of its JSON.
#[test]
fn first_screens_of_shipped_scenarios_are_short_and_in_the_readers_units() {
    let mut seen = 0;
    let files = fs::read_dir(SCENARIOS).expect("a folder").flatten().map(|entry| entry.path());
    let files = files.filter(|path| path.extension().is_some_and(|ending| ending == "toml"));
    for path in files {
        let name = path.file_stem().and_then(|stem| stem.to_str()).expect("a name");
        let dir = Dir::with(&[name]);
        let shortened = SHORTENED.iter().find(|(long, _)| *long == name);
        let set = shortened.map_or_else(String::new, |(_, duration)| format!(" --set duration={duration}"));
        // A shortened run may miss its requirements, or end before what its keys name.
        let ran = dir.run(&format!("simulate {name}.toml --log none{set}"));
        if ran.code == Some(2) && shortened.is_some() {
            continue;
        }
        let screen = ran.err.clone();
        let body: Vec<&str> = screen.lines().filter(|line| !line.starts_with("error")).collect();
        let body: Vec<&str> =
            body.into_iter().skip_while(|line| !line.starts_with(&format!("{name}   "))).collect();
        assert!(!body.is_empty() && body.len() <= SCREEN[0], "{name}: {} lines\n{screen}", body.len());
        for line in &body {
            assert!(line.chars().count() <= SCREEN[1], "{name}: {line}");
            for riddle in ["NaN", "null", " 0 % of"] {
                assert!(!line.contains(riddle), "{name}: {riddle}: {line}");
            }
            let mut units = line.split([' ', ',', ';']);
            assert!(!units.any(|word| word == "rad" || word.starts_with("rad/")), "{name}: {line}");
            let is_power = |word: &str| word.contains('e') && word.parse::<f64>().is_ok();
            assert!(!line.split([' ', ',', ';']).any(is_power), "{name}: {line}");
        }
        let object = dir.run(&format!("simulate {name}.toml --log none --json{set}")).json();
        let answer = &object["answer"];
        let flat = screen.split_whitespace().collect::<Vec<_>>().join(" ");
        let is_said = |text: &str| flat.contains(&text.split_whitespace().collect::<Vec<_>>().join(" "));
        assert!(is_said(answer["verdict_text"].as_str().expect("words")), "{name}: {answer}");
        for requirement in answer["requirements"].as_array().into_iter().flatten().take(5) {
            for text in ["value", "limit", "margin"] {
                let text = &requirement["text"][text];
                assert!(texts(text).iter().all(|text| is_said(text)), "{name}: {text}\n{screen}");
            }
            seen += 1;
        }
        for line in answer["lines"].as_array().into_iter().flatten() {
            let text = line["text"].as_str().expect("a text");
            assert!(
                line["is_main"] == false || is_said(text) || body.len() + 3 > SCREEN[0],
                "{name}: {text}"
            );
        }
    }
    assert!(seen > 12, "{seen}");
}

/// A requirement that is missed has the multiple of its limit, and one on an absolute error its largest value with the instant.
#[test]
fn a_requirement_says_its_margin_and_its_largest_value() {
    let dir = Dir::with(&["shaped-slew", "ground-pass"]);
    let answer = |arguments: &str, code| dir.run(arguments).exits(code).json()["answer"].clone();
    let missed = answer(
        "simulate shaped-slew.toml --log none --json --set requirement[0].limit=4.84813681109536e-6",
        3,
    );
    assert_eq!(missed["verdict"], "missed");
    let first = &missed["requirements"][0];
    assert_eq!((&first["met"], &first["text"]["limit"]), (&false.into(), &"1 arcsec".into()));
    let [value, limit] = ["value", "limit"].map(|name| first[name].as_f64().expect("a number"));
    let margin = first["margin"].as_f64().expect("a number");
    assert!((margin - (limit - value) / limit).abs() < 1e-12 && margin < -1.0, "{first}");
    let multiple: f64 = first["text"]["margin"]
        .as_str()
        .and_then(|text| text.strip_suffix(" × limit")?.parse().ok())
        .expect("a multiple");
    assert!((multiple / (value / limit) - 1.0).abs() < 5e-3, "{first}");
    // An absolute error at every instant: the value is the largest.
    let pass = &answer("simulate ground-pass.toml --log none --json", 0)["requirements"][0];
    let largest = &pass["largest"];
    assert_eq!(largest["value"], pass["value"]);
    let at = largest["at_s"].as_f64().expect("a time");
    assert!((100.0..=1000.0).contains(&at), "{pass}");
}

/// A run that has left its target by ten revolutions is a failure whose cause was known before, not a result.
#[test]
fn a_run_that_diverges_fails_with_its_cause() {
    let dir = Dir::with(&["wheel-unstable-band"]);
    let line = "simulate wheel-unstable-band.toml --set duration=60000 --log none";
    let ran = dir.run(line).exits(1).says(&[
        "FAILED: the motion diverges",
        "! loop: unstable, spectral radius 1.0477",
        "tenfold",
    ]);
    assert!(!ran.err.contains("e8") && !ran.err.contains("at most"), "{}", ran.err);
    // Within its first quarter of an hour it only misses its goal.
    dir.run("simulate wheel-unstable-band.toml --log none").exits(0).says(&["goal missed"]);
}

/// A run, and a campaign of one run, have one answer.
#[test]
fn a_campaign_of_one_run_answers_as_the_run() {
    let dir = Dir::with(&["safe-mode", "half-turn"]);
    for name in ["safe-mode", "half-turn"] {
        let short = format!("simulate {name}.toml --log none --set duration=90");
        let without_time = |text: String| {
            let lines = text.lines().filter(|line| !line.contains("simulated in"));
            lines.map(str::to_owned).collect::<Vec<_>>()
        };
        let single = without_time(dir.run(&short).err);
        let campaign = without_time(dir.run(&format!("simulate {name}.toml --runs 1 --set duration=90")).err);
        // The keys of [uncertain] are drawn in a campaign.
        if name == "safe-mode" {
            assert_eq!(single, campaign, "{name}");
        }
        assert_eq!(single.len(), campaign.len(), "{name}: {single:?} {campaign:?}");
    }
}

/// A grave warning beside requirements that are met ends with 3 where the run is judged strictly.
#[test]
fn a_strict_judge_accepts_no_lost_filter() {
    let dir = Dir::with(&["wheel-ekf"]);
    let text = dir.text("wheel-ekf.toml");
    let met = "\n[[requirement]]\nname = \"end\"\nquantity = \"angle_error_late_rad\"\nlimit = \"1 deg\"\n";
    dir.write("judged.toml", text + met);
    let line = "simulate judged.toml --log none";
    dir.run(line).exits(0).says(&["1 of 1 requirement met, but the filter is overconfident"]);
    dir.run(&format!("{line} --strict")).exits(3).says(&["met, but the filter is overconfident"]);
    dir.run(&format!("{line} --runs 2 --strict"))
        .exits(2)
        .says(&["--strict judges the warnings of single runs"]);
}

/// Returns the objects that a campaign prints with `--json`: those of the runs, and the answer.
fn campaign(dir: &Dir, line: &str, code: i32) -> (Vec<Json>, Json) {
    let printed = dir.run(line).exits(code).out;
    let mut lines: Vec<Json> =
        printed.lines().map(|line| serde_json::from_str(line).expect("an object")).collect();
    let last = lines.pop().expect("an answer");
    (lines, last["answer"].clone())
}

/// The answer of a campaign counts and orders the values of its runs, and names the key that drives the requirement.
#[test]
fn a_campaign_answers_by_the_values_of_its_runs() {
    let dir = Dir::with(&["half-turn"]);
    let (runs, answer) = campaign(&dir, "simulate half-turn.toml --runs 40 --json", 3);
    let number = |value: &Json| value.as_f64().expect("a number");
    let values: Vec<f64> = runs.iter().map(|run| number(&run["requirements"][0]["value"])).collect();
    let own = &answer["requirements"][0];
    let limit = number(&own["limit"]);
    let met = values.iter().filter(|value| **value <= limit).count();
    assert_eq!((answer["runs"].as_u64(), answer["failed"].as_u64()), (Some(40), Some(0)));
    assert_eq!(own["runs_met"].as_u64(), Some(met as u64));
    assert!((number(&own["share"]) - met as f64 / 40.0).abs() < 1e-15 && (2..38).contains(&met), "{met}");
    let mut sorted = values.clone();
    sorted.sort_by(f64::total_cmp);
    // numpy.quantile: 40 values have the median between the 20th and the 21st, and 95 % at 0.05 from the 38th to the 39th.
    let [median, p95] = [f64::midpoint(sorted[19], sorted[20]), 0.95 * sorted[37] + 0.05 * sorted[38]];
    assert!((number(&own["median"]) / median - 1.0).abs() < 1e-12, "{own}");
    assert!((number(&own["p95"]) / p95 - 1.0).abs() < 1e-12, "{own}");
    let worst = own["worst"]["run"].as_u64().expect("a run") as usize;
    assert_eq!((values[worst], number(&own["worst"]["value"])), (sorted[39], sorted[39]));
    assert!((number(&own["margin"]["worst"]) - (limit - sorted[39]) / limit).abs() < 1e-12);
    // Runs are driven by the inertia about the axis of the turn: those that miss it are farther from the design.
    let driven = &own["driven_by"][0];
    assert_eq!(driven["key"], "spacecraft.inertia[2][2]");
    let sizes: Vec<f64> = runs
        .iter()
        .map(|run| (number(&run["drawn"]["spacecraft.inertia[2][2]"]) - 600.0).abs() / 600.0)
        .collect();
    let nearest_missed =
        sizes.iter().zip(&values).filter(|(_, value)| **value > limit).map(|(size, _)| *size);
    let nearest_missed = nearest_missed.fold(f64::INFINITY, f64::min);
    let met_within = sizes.iter().copied().filter(|size| *size < nearest_missed).fold(0.0, f64::max);
    assert!((number(&driven["met_within"]) - met_within).abs() < 1e-12, "{driven}");
    // The screen says the same, in the unit of the limit.
    let screen = dir.run("simulate half-turn.toml --runs 40").exits(3).err;
    let flat = screen.split_whitespace().collect::<Vec<_>>().join(" ");
    for text in [&answer["verdict_text"], &own["text"]["worst"], &own["text"]["median"], &driven["text"]] {
        let text = text.as_str().expect("a text").split_whitespace().collect::<Vec<_>>().join(" ");
        assert!(flat.contains(&text), "{text}: {screen}");
    }
    assert!(
        screen.lines().count() <= SCREEN[0] && screen.lines().all(|line| line.chars().count() <= SCREEN[1])
    );
}

/// The answer of a campaign is the same from its directory, by any number of threads.
#[test]
fn a_campaign_answers_alike_from_its_directory() {
    let dir = Dir::with(&["half-turn"]);
    let (_, memory) = campaign(&dir, "simulate half-turn.toml --runs 10 --json --jobs 1", 3);
    let (_, mut parts) = campaign(&dir, "simulate half-turn.toml --runs 10 --json --jobs 4 -o mc", 3);
    let repeat = parts.as_object_mut().expect("an object").remove("repeat").expect("a command");
    let run = memory["requirements"][0]["worst"]["run"].as_u64().expect("a run");
    assert_eq!(repeat, format!("flexsc simulate --from mc --row {run} -o run-{run}"));
    assert_eq!(memory, parts);
}

/// Eclipses and actuators at limits are events, with their times.
#[test]
fn events_have_eclipses_and_limits() {
    let dir = Dir::with(&["cubesat-day", "safe-mode"]);
    let events = |line: &str, kind: &str| -> Vec<Json> {
        let answer = dir.run(line).json()["answer"].clone();
        let all = answer["events"].as_array().into_iter().flatten();
        all.filter(|event| event["kind"] == kind).cloned().collect()
    };
    let line =
        "simulate cubesat-day.toml --log full --json --set duration=8000 --set log.period=1 -o day.mcap";
    let found = events(line, "eclipse");
    // The light of the rows of each second.
    let rows = dir.run("export day.mcap --topic /orbit").exits(0).out;
    let mut lines = rows.lines();
    let heads: Vec<&str> = lines.next().expect("heads").split(',').collect();
    let column = |name: &str| heads.iter().position(|head| *head == name).expect("a column");
    let (time, light) = (column("time_s"), column("light"));
    let rows: Vec<(f64, bool)> = lines
        .map(|line| line.split(',').collect::<Vec<_>>())
        .map(|cells| (cells[time].parse().expect("a time"), cells[light].contains("shadow")))
        .collect();
    let changes: Vec<f64> = rows
        .windows(2)
        .filter(|pair| pair[0].1 != pair[1].1)
        .map(|pair| f64::midpoint(pair[0].0, pair[1].0))
        .collect();
    let ends: Vec<f64> = found
        .iter()
        .flat_map(|event| [event["from_s"].as_f64(), event["to_s"].as_f64()])
        .map(|end| end.expect("a time"))
        .filter(|end| *end < 8000.0)
        .collect();
    assert_eq!(ends.len(), changes.len());
    assert!(
        ends.len() == 3 && ends.iter().zip(&changes).all(|(end, change)| (end - change).abs() <= 0.51),
        "{ends:?} {changes:?}"
    );
}
