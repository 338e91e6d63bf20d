//! Answers of runs: the verdict first, the same strings in text and JSON, in the reader's units, on a screen.

use std::fs;
use std::path::Path;

use flexsc_cli::simulate_to_log;
use flexsc_core::answer::{Answer, CampaignAnswer, RunObserver, RunVerdict, ScreenOptions, WarningKind};
use flexsc_core::campaign::{Campaign, CampaignRun, CampaignRuns};
use flexsc_core::formats::reader_units::ReaderUnits;
use flexsc_core::metrics::Metrics;
use flexsc_core::record::{Detail, Log};
use flexsc_core::requirement_verdict::Decision;
use flexsc_core::{Document, Scenario};
use serde_json::{Value as Json, json};
use toml::Value;

use crate::drawing::Drawing;
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

/// Returns the scenario of a shipped file, shortened if it takes long, or `None` if it cannot be shortened.
fn shipped(name: &str) -> Option<Scenario> {
    let path = format!("{SCENARIOS}/{name}.toml");
    let mut document = Document::load(Path::new(&path)).expect("a document");
    if let Some((_, duration)) = SHORTENED.iter().find(|(long, _)| *long == name) {
        document.set("duration", Value::Float(*duration)).expect("a duration");
        return Scenario::from_document(&document).ok();
    }
    Some(Scenario::from_document(&document).expect("a scenario"))
}

/// Checks that a first screen fits, that each line is for readers, and that it has the texts of the answer.
fn is_screen(name: &str, answer: &Answer) {
    let screen = answer.screen(Some(12.3), ScreenOptions::default());
    let lines: Vec<&str> = screen.lines().collect();
    assert!(lines.len() < SCREEN[0], "{name}: {} lines\n{screen}", lines.len());
    for line in &lines {
        assert!(line.chars().count() <= SCREEN[1], "{name}: {line}");
        let riddle = ["NaN", "null", "none", " 0 % of", " 0 s,"].iter().find(|riddle| line.contains(*riddle));
        let is_cycle = line.contains("limit cycle");
        assert!(riddle.is_none() || is_cycle, "{name}: {riddle:?}: {line}");
        // A bandwidth that an adaptation tunes has the unit of its key.
        let is_key = line.starts_with("  bandwidth ");
        let mut units = line.split([' ', ',', ';']);
        assert!(is_key || !units.any(|word| word == "rad" || word.starts_with("rad/")), "{name}: {line}");
        let is_power = |word: &str| word.contains('e') && word.parse::<f64>().is_ok();
        assert!(!line.split([' ', ',', ';']).any(is_power), "{name}: {line}");
    }
    let flat = |text: &str| text.split_whitespace().collect::<Vec<_>>().join(" ");
    let (screen, object) = (flat(&screen), json!(answer));
    let is_said = |text: &Json| screen.contains(&flat(text.as_str().expect("a text")));
    assert!(is_said(&object["verdict_text"]), "{name}: {screen}");
    for requirement in object["requirements"].as_array().into_iter().flatten().take(5) {
        for (part, text) in requirement["text"].as_object().expect("texts") {
            assert!(part == "unit" || is_said(text), "{name}: {text}\n{screen}");
        }
    }
    for line in object["lines"].as_array().into_iter().flatten().filter(|line| line["is_main"] == true) {
        assert!(is_said(&line["text"]) || lines.len() + 3 > SCREEN[0], "{name}: {line}");
    }
}

/// A campaign of one run has the values, the verdict and the warnings of the run.
fn is_campaign(name: &str, campaign: &Campaign, metrics: &Metrics, answer: &Answer) {
    let mut runs = CampaignRuns::new(campaign);
    runs.add(0, &[], Some(metrics));
    let all = CampaignAnswer::new(campaign.scenario(), &runs, None, None, ReaderUnits::default());
    assert_eq!(all.requirements.len(), answer.requirements.len(), "{name}");
    for own in &all.requirements {
        let single = answer.requirements.iter().find(|single| single.id == own.id).expect("a requirement");
        let value = Some(single.value).filter(|value| value.is_finite());
        assert_eq!([own.median, own.p95, own.worst.value], [value; 3], "{name}: {}", own.name);
        // One run may be too few for a confidence.
        let is_decided = own.decision != Decision::Undecided;
        assert!(!is_decided || own.met == single.met, "{name}: {}", own.name);
        assert_eq!(own.text.limit, single.text.limit, "{name}");
        assert_eq!(own.margin.map(|margin| margin.worst), value.map(|_| single.margin), "{name}");
    }
    let warned: Vec<_> = all.warnings.iter().map(|own| (own.kind, own.mode.clone())).collect();
    let from_metrics = answer.warnings.iter().filter(|own| own.kind != WarningKind::LevelHides);
    assert_eq!(warned, from_metrics.map(|own| (own.kind, own.mode.clone())).collect::<Vec<_>>(), "{name}");
    let is_decided = all.requirements.iter().all(|own| own.decision != Decision::Undecided);
    let [both, single] = [all.verdict, answer.verdict].map(|verdict| verdict == RunVerdict::Missed);
    assert!(!is_decided || both == single, "{name}");
    let modes: Vec<_> = answer.by_mode.iter().map(|own| (&own.mode, own.visits > 0)).collect();
    assert_eq!(all.by_mode.iter().map(|own| (&own.mode, own.runs > 0)).collect::<Vec<_>>(), modes, "{name}");
}

/// Each shipped scenario answers on one screen, without SI riddles, and with the strings of its JSON; a campaign of its run has the
/// same values; its log has them from rows; and its figures are in the units of readers.
#[test]
fn shipped_scenarios_answer_alike_everywhere() {
    let mut seen = 0;
    let files = fs::read_dir(SCENARIOS).expect("a folder").flatten().map(|entry| entry.path());
    for path in files.filter(|path| path.extension().is_some_and(|ending| ending == "toml")) {
        let name = path.file_stem().and_then(|stem| stem.to_str()).expect("a name");
        let (Some(scenario), dir) = (shipped(name), Dir::with(&[])) else { continue };
        let campaign = Campaign::new(scenario.clone(), name, None).expect("a campaign");
        let run = CampaignRun::new(scenario.clone(), 0);
        let mut observer = RunObserver::new(&scenario);
        let log = dir.path(&format!("{name}.mcap"));
        let (metrics, _) = simulate_to_log(&run, &log, (Detail::Full, false), &mut observer).expect("a run");
        let units = ReaderUnits::default();
        let answer = Answer::new(&scenario, &metrics, Some(&observer.finish()), units);
        is_screen(name, &answer);
        is_campaign(name, &campaign, &metrics, &answer);
        seen += answer.requirements.len();
        let rows = Answer::from_rows(&scenario, &Log::open(&log).expect("a log"), units).expect("rows");
        assert_eq!(rows.verdict, answer.verdict, "{name}");
        let values = |answer: &Answer| {
            answer.requirements.iter().map(|own| own.text.value.clone()).collect::<Vec<_>>()
        };
        assert_eq!(values(&rows), values(&answer), "{name}");
        dir.run(&format!("plot {name}.mcap --format svg -o figures")).exits(0);
        for file in dir.names("figures") {
            let drawing = Drawing::at(&dir, &format!("figures/{file}"));
            let texts = drawing.texts();
            let axes: Vec<&String> =
                texts.iter().filter(|text| text.ends_with(')') && text.contains(" (")).collect();
            let has_radians = |text: &&String| {
                let mut words = text.split([' ', '(', '/', ')']);
                !text.starts_with("bandwidth (") && words.any(|word| word.ends_with("rad"))
            };
            assert!(!axes.is_empty() && !axes.iter().any(has_radians), "{file}: {axes:?}");
            let is_long = |text: &String| text.contains("e-") && text.starts_with(['0', '1', '−']);
            assert!(!texts.iter().any(is_long), "{file}: {texts:?}");
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
        .exits(3)
        .says(&["but the filter is overconfident in 2 runs"]);
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

/// A campaign with drawn keys has the value of the scenario without them.
#[test]
fn a_campaign_has_the_run_without_drawn_keys_beside_it() {
    let dir = Dir::with(&["half-turn"]);
    let run = dir.run("simulate half-turn.toml --log none --json").json()["answer"].clone();
    let (_, answer) = campaign(&dir, "simulate half-turn.toml --runs 8 --json", 3);
    assert_eq!(answer["requirements"][0]["nominal"], run["requirements"][0]["value"]);
    dir.run("simulate half-turn.toml --runs 8").exits(3).says(&["nominal", " 1.82 "]);
}

/// The answer of a log is that of its run, which is repeated; a run that did not end has failed.
#[test]
fn a_log_answers_as_its_run() {
    let dir = Dir::with(&["half-turn"]);
    let run = dir.run("simulate half-turn.toml --json").exits(0).json()["answer"].clone();
    assert_eq!(dir.run("log answer half-turn.mcap --json").exits(0).json()["answer"], run);
    dir.run("log answer half-turn.mcap").exits(0).says(&["1 of 1 requirement met", "margin 74 %"]);
    let torn = dir.read("half-turn.mcap");
    dir.write("half-turn.mcap.partial", &torn[..torn.len() * 2 / 3]);
    dir.run("log recover half-turn.mcap.partial -o torn.mcap").exits(0);
    dir.run("log answer torn.mcap").exits(1).says(&["FAILED: the log ends at", "from rows every"]);
}
