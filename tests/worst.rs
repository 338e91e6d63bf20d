//! Worst cases over uncertain keys: margins against the closed form of their interval, metrics against grids of runs, and
//! the verb `worst`.

use flexsc_core::Scenario;
use flexsc_core::analysis::open_loop::LoopBreak;
use flexsc_core::campaign::{Campaign, CampaignRun};
use flexsc_core::metrics::Selection;
use flexsc_core::worst_case::{MarginKind, MarginSearch, MetricSearch, RunQuantity, WorstCase};
use serde_json::Value as Json;

use crate::margins::wheel_loop;
use crate::study;
use crate::util::{Dir, SCENARIOS};

fn shipped(name: &str) -> Scenario {
    Scenario::load(format!("{SCENARIOS}/{name}.toml").as_ref()).expect("shipped")
}

/// The wheel's loop without back-EMF, whose four frequencies are off by up to 10 %, each by itself.
fn uncertain_wheel() -> Scenario {
    let key = |mode: usize| format!("\"body.planar.modes[{mode}].frequency\" = {{ relative_uniform = 0.1 }}");
    let keys = [0, 1, 2, 3].map(key).join("\n");
    let text = wheel_loop(0.0).replace("back_emf = 1e-4", "back_emf = 0.0") + "\n[uncertain]\n" + &keys;
    Scenario::parse("wheel.toml", &text).expect("valid")
}

fn worst_metric(scenario: &Scenario, quantity: RunQuantity, is_least: bool, threads: usize) -> WorstCase {
    let search = MetricSearch { quantity, is_least, most_runs: 60, threads, starts: Vec::new() };
    let work = |run: &CampaignRun, selection: &Selection| Ok(Campaign::simulate_metrics(run, selection, ())?);
    search.run(scenario, &scenario.name, work, || false).expect("a value")
}

/// Each term of the loop is monotone in its frequency, so that the interval of the margin over the box follows from a
/// search in the frequency alone: 0.5958006848460, and a gain margin of 42.30593465 to 43.09146988.
#[test]
fn the_least_margins_of_the_wheel_are_the_ends_of_their_intervals() {
    let scenario = uncertain_wheel();
    for (kind, nominal, worst, part) in [
        (MarginKind::Modulus, 0.600_718_808_009_7, 0.595_800_684_846_0, 1e-9),
        (MarginKind::Gain, 42.727_248_515_894_8, 42.305_934_65, 1e-9),
    ] {
        let search = MarginSearch { kind, opened: LoopBreak::Command, most_loops: 200 };
        let found = search.run(&scenario, || false).expect("stable");
        assert!((found.nominal() / nominal - 1.0).abs() < 1e-12, "{}", found.nominal());
        assert!((found.value() / worst - 1.0).abs() < part, "{}", found.value());
        assert!(!found.is_unstable && found.failed == 0 && found.points.len() <= 200);
    }
}

/// The worst point is at least as bad as any of a grid of runs, and its scenario repeats the value.
#[test]
fn the_worst_arrival_is_that_of_no_point_of_a_grid() {
    let scenario = shipped("slew-wheel-lqg");
    let found = worst_metric(&scenario, RunQuantity::Requirement("arrival".to_owned()), false, 0);
    let part = |index: u32| f64::from(index) / 8.0;
    let points: Vec<Vec<f64>> = (0..81)
        .map(|index| {
            let parts = [part(index / 9), part(index % 9)];
            found.ranges.keys.iter().zip(parts).map(|(own, part)| own.number_at(part)).collect()
        })
        .collect();
    let grid = Campaign::at_points(&scenario, "grid", points).expect("a campaign");
    let value = |run: &CampaignRun| {
        let metrics = Campaign::simulate(run, ()).expect("a run");
        metrics.get("requirement_values").expect("requirements").numbers()[0]
    };
    let most = (0..81).map(|number| value(&grid.run(number).expect("a point"))).fold(0.0, f64::max);
    assert!(found.value() >= most, "{} of the search, {most} of the grid", found.value());
    assert!(found.value() < 1.05 * most);
    let run = CampaignRun::new(found.witness.clone(), 0);
    assert_eq!(value(&run).to_bits(), found.value().to_bits());
    assert!(found.witness.uncertain.is_empty());
}

/// A plan is made for the body as it is written, in a campaign and here.
#[test]
fn a_point_is_the_run_of_a_campaign_with_the_same_keys() {
    let scenario = shipped("rotation-robust");
    let campaign = Campaign::new(scenario.clone(), "campaign", []).expect("a campaign");
    let drawn = campaign.run(0).expect("a run");
    let numbers: Vec<f64> = drawn.drawn.iter().map(|value| value.as_float().expect("a number")).collect();
    let point =
        Campaign::at_points(&scenario, "campaign", vec![numbers]).expect("a campaign").run(0).expect("a run");
    // As text: NaN differs from itself.
    let metrics = |run: &CampaignRun| format!("{:?}", Campaign::simulate(run, ()).expect("a run"));
    assert_eq!(metrics(&drawn), metrics(&point));
}

#[test]
fn threads_have_no_effect() {
    let scenario = study::scenario("relay-sampled", &[("duration", "4000")]);
    let quantity = || RunQuantity::Metric("envelope_mean_rad".to_owned());
    let (one, four) =
        (worst_metric(&scenario, quantity(), true, 1), worst_metric(&scenario, quantity(), true, 4));
    assert_eq!(one.points, four.points);
    assert_eq!(one.worst, four.worst);
    assert!(one.value() <= one.nominal());
}

#[test]
fn the_verb_prints_judges_and_writes_the_witness() {
    let dir = Dir::with(&["slew-wheel-lqg"]);
    let all = "worst slew-wheel-lqg.toml --points 20";
    dir.run(all).exits(0).says(&[" points over 2 uncertain keys", "arrival", "stability", ": met"]);
    let tight = format!("{all} --set requirement[0].limit=3e-4");
    dir.run(&tight).exits(3).says(&["missed", "1 of 2 requirements not met in the worst case: arrival"]);
    dir.run(&format!("{all} --requirement arrival -o worst.toml")).exits(0);
    let json = dir.run(&format!("{all} --requirement arrival --json")).printed();
    let json: Json = serde_json::from_str(&json).expect("JSON");
    let case = &json["cases"][0];
    assert_eq!(case["met"], true);
    assert!(case["worst"].as_f64() > case["nominal"].as_f64());
    let run: Json = serde_json::from_str(&dir.run("simulate worst.toml --json").printed()).expect("JSON");
    assert_eq!(run["metrics"]["requirement_values"][0], case["worst"], "{run}");
    dir.run(&format!("{all} -o points.csv")).exits(0);
    assert!((10..=41).contains(&dir.text("points.csv").lines().count()));
    dir.run(&format!("{all} -o figures --format svg")).exits(0);
    assert!(dir.text("figures/slew-wheel-lqg-worst-2.svg").contains("stability"));
}

/// The search starts at the worst runs of a campaign, and the first point is the scenario's own.
#[test]
#[cfg(feature = "parquet")]
fn a_search_starts_at_the_worst_runs_of_a_campaign() {
    let dir = Dir::with(&["slew-wheel-lqg"]);
    dir.run("simulate slew-wheel-lqg.toml --runs 40 -o made").exits(0);
    let lines = dir.run("simulate slew-wheel-lqg.toml --runs 40 --json").exits(0).out;
    let runs = lines.lines().map(|line| serde_json::from_str::<Json>(line).expect("an object"));
    let arrival = |run: &Json| run["metrics"]["requirement_values"][0].as_f64();
    let worst = runs
        .filter(|run| arrival(run).is_some())
        .max_by(|a, b| arrival(a).partial_cmp(&arrival(b)).expect("numbers"));
    let drawn = worst.expect("a run")["drawn"].as_object().expect("keys").clone();
    let search = "worst slew-wheel-lqg.toml --points 30 --requirement arrival --campaign made";
    dir.run(&format!("{search} -o points.csv")).exits(0);
    let table = dir.text("points.csv");
    let (head, second) = (table.lines().next().expect("a head"), table.lines().nth(2).expect("a point"));
    let cells: std::collections::BTreeMap<_, _> = head.split(',').zip(second.split(',')).collect();
    for (key, value) in drawn {
        let (found, drawn) =
            (cells[key.as_str()].parse::<f64>().expect("a number"), value.as_f64().expect("a number"));
        assert!((found - drawn).abs() <= 1e-12 * drawn.abs(), "{key}: {found} {drawn}");
    }
    dir.run(&format!("{search} --seed 9")).exits(2).says(&["made", "another scenario", "seed"]);
    dir.run("worst slew-wheel-lqg.toml --metric nothing --campaign made").exits(2).says(&["nothing"]);
}

/// Kalman filter and gains of the example are for the nominal frequencies: 5 % off, a mode grows slowly.
#[test]
fn an_unstable_corner_is_found() {
    let dir = Dir::with(&["slew-wheel-lqg"]);
    let margin = "worst slew-wheel-lqg.toml --margin modulus --points 40";
    dir.run(&format!("{margin} -o corner.toml")).exits(0).says(&["where the loop is not stable"]);
    dir.run("margins corner.toml").exits(2).says(&["is not stable"]);
    dir.run("margins slew-wheel-lqg.toml --worst").exits(0).says(&["over the uncertain keys", "unstable"]);
}

#[test]
fn what_has_no_worst_case_is_refused() {
    let dir = Dir::with(&["slew-wheel-lqg", "earth-observer", "attitude-hold"]);
    let refused = |arguments: &str, why: &str| {
        dir.run(&format!("worst {arguments}")).exits(2).says(&[why]);
    };
    refused("earth-observer.toml --margin disk", "uncertain: is missing");
    refused("slew-wheel-lqg.toml --metric itaee", "did you mean `itae`?");
    refused("slew-wheel-lqg.toml --metric goal", "is a word");
    refused("slew-wheel-lqg.toml --metric fuel_kg --points 4", "fuel_kg has no value");
    refused("slew-wheel-lqg.toml --requirement arival", "did you mean `arrival`?");
    refused("slew-wheel-lqg.toml -o witness.toml", "a witness is of one quantity");
    refused("slew-wheel-lqg.toml --metric itae --margin gain", "cannot be used with");
    refused("slew-wheel-lqg.toml --margin modulus --points 0", "0 is not in");
    refused("slew-wheel-lqg.toml --mode turn", "has no modes of operation, got `turn`");
    dir.run("budget slew-wheel-lqg.toml --mode turn")
        .exits(2)
        .says(&["has no modes of operation, got `turn`"]);
    refused("relay-sampled.toml --metric itae", "No such file");
}

/// The guaranteed ranges stand beside the searched worst case, and alone for a scenario without requirements.
#[test]
fn claims_stand_beside_requirements() {
    let dir = Dir::with(&["bounded-jitter"]);
    let told = dir.run("worst bounded-jitter.toml").exits(0);
    told.says(&["guaranteed ranges of [[bound]], in which no law acts", "guaranteed", ": proved"]);
    let claims = dir.run("bound bounded-jitter.toml --json").exits(0).json();
    let text = std::fs::read_to_string(dir.path("bounded-jitter.toml")).expect("a file");
    let more = "\n[[requirement]]\nname = \"rate\"\nquantity = \"rate_error\"\nlimit = 1.0\n\n\
                [uncertain]\n\"disturbance[0].torque\" = { uniform = [1e-4, 3e-4] }\n";
    std::fs::write(dir.path("both.toml"), format!("{text}{more}")).expect("a file");
    let object = dir.run("worst both.toml --points 4 --json").exits(0).json();
    assert_eq!(object["cases"].as_array().map(Vec::len), Some(1));
    assert_eq!(object["bounds"], claims["bounds"]);
    dir.run("worst bounded-jitter.toml --set bound[0].limits=[-5e-6,5e-6]").exits(3).says(&["violated"]);
}
