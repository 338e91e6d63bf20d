//! Levels of pointing budgets: by the linear loop against golden numbers, and against the runs and their convolution within the
//! sampling error of the runs.

use std::collections::BTreeMap;

use serde_json::Value as Json;

use crate::util::Dir;

const BUDGETS: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../tests/golden/budgets");
/// Campaigns with seeds of their own, and runs in each.
const SEEDS: u32 = 8;
/// Standard errors of the mean of the campaigns within which levels agree.
const STANDARD_ERRORS: f64 = 4.5;

fn dir(name: &str) -> Dir {
    let text = std::fs::read_to_string(format!("{BUDGETS}/{name}.toml")).expect("a scenario");
    Dir::holding("budget.toml", text)
}

fn budgets(dir: &Dir, options: &str) -> Vec<Json> {
    let object = dir.run(&format!("budget budget.toml {options} --json")).exits(0).json();
    object["budgets"].as_array().expect("a list").clone()
}

fn number(value: &Json) -> f64 {
    value.as_f64().expect("a number")
}

/// Sources and levels of the linear loop of rigid bodies by SciPy: `tests/golden/budget_reference.py`.
#[test]
fn sources_and_levels_of_the_linear_loop_are_those_of_scipy() {
    let mut golden: BTreeMap<&str, Vec<[&str; 3]>> = BTreeMap::new();
    for line in include_str!("golden/budgets.csv").lines() {
        let cells: Vec<&str> = line.split(',').collect();
        golden.entry(cells[0]).or_default().push([cells[1], cells[2], cells[3]]);
    }
    let mut count = 0;
    for (scenario, rows) in golden {
        let found = budgets(&dir(scenario), "--runs 1 --set duration=80");
        for [requirement, quantity, value] in rows {
            let budget = found.iter().find(|own| own["name"] == requirement).expect("a requirement");
            let sources = &budget["linear_sources"];
            let found = if let Some(sine) = quantity.strip_prefix("amplitude") {
                number(&sources["amplitudes"][sine.parse::<usize>().expect("an index")])
            } else if let Ok(level) = quantity.parse::<f64>() {
                let levels = budget["linear_levels"].as_array().expect("levels");
                let own = levels.iter().find(|own| number(&own["level"]) == level).expect("a level");
                number(&own["convolution"])
            } else {
                number(&sources[quantity])
            };
            let expected: f64 = value.parse().expect("a number");
            let noise = number(&sources["noise"]);
            // An ensemble is a thousand points.
            let part = if scenario == "uncertain" { 1e-3 } else { 1e-9 };
            assert!(
                (found - expected).abs() < part * (expected.abs() + noise),
                "{scenario} {requirement} {quantity}: {found:e}, expected {expected:e}"
            );
            if quantity == "noise" {
                assert!((number(&budget["linear_noise"]) / expected - 1.0).abs() < 1e-8, "{requirement}");
            }
            count += 1;
        }
    }
    assert!(count > 80, "{count}");
}

/// The least rms of an index by samples, within a modulus margin of 0.6, by a search in Python with SciPy's Lyapunov
/// equations. In windows of continuous time it would be elsewhere, at 2 N m s.
#[test]
fn a_tuned_index_is_that_of_samples() {
    let line = "tune budget.toml --vary law.pd.k_p=0.3:5 --vary law.pd.k_d=2:20 --objective middle4";
    let tuned = dir("windows").run(&format!("{line} --keep margin>=0.6 --json")).exits(0).json();
    let measure = &tuned["measures"][0];
    assert!((number(&measure["before"]) / 7.400_353_821_5e-9 - 1.0).abs() < 1e-9, "{measure}");
    assert!((number(&measure["after"]) / 3.216_842_35e-9 - 1.0).abs() < 1e-4, "{measure}");
}

/// Mean of some values and its standard error.
fn mean_and_error(values: &[f64]) -> (f64, f64) {
    let count = values.len() as f64;
    let mean = values.iter().sum::<f64>() / count;
    let square = values.iter().map(|value| (value - mean) * (value - mean)).sum::<f64>();
    (mean, (square / (count - 1.0) / count).sqrt())
}

/// Compares the mixed levels of a scenario's requirements, `runs` of them for each seed.
fn compare(name: &str, runs: u32) {
    let dir = dir(name);
    let campaigns: Vec<Vec<Json>> =
        (0..SEEDS).map(|seed| budgets(&dir, &format!("--runs {runs} --seed {}", 100 + seed))).collect();
    for (index, first) in campaigns[0].iter().enumerate() {
        for place in 0..3 {
            let mixed = |way: &str| -> Vec<f64> {
                campaigns.iter().map(|own| number(&own[index]["levels"][place]["mixed"][way])).collect()
            };
            let (level, error) = mean_and_error(&mixed("campaign"));
            let (convolved, _) = mean_and_error(&mixed("convolution"));
            let linear = number(&first["linear_levels"][place]["convolution"]);
            for (way, found) in [("linear", linear), ("convolved", convolved)] {
                assert!(
                    (found - level).abs() < STANDARD_ERRORS * error + 2e-3 * level,
                    "{name} {} {place} {way}: {found:e}, runs {level:e} with a standard error of {error:e}",
                    first["name"]
                );
            }
        }
    }
}

#[test]
fn windows_of_few_samples_agree() {
    compare("windows", 4);
}

#[test]
fn a_steady_torque_and_sines_agree() {
    compare("bias", 40);
}

#[test]
fn an_uncertain_torque_agrees() {
    compare("uncertain", 60);
}

#[test]
fn an_uncertain_loop_sampled_beside_its_law_agrees() {
    compare("uneven", 60);
}

#[test]
fn modes_that_do_not_act_back_agree() {
    compare("spatial", 6);
}

#[test]
fn panels_that_act_back_agree() {
    compare("elastic", 16);
}
