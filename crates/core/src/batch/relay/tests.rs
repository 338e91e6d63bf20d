//! Tests that relay runs in lanes have the results of single runs, to the bit.

use std::path::Path;

use flexsc_numerics::lanes::Processor;

use super::RelayBatch;
use crate::Scenario;
use crate::batch::{BatchJob, BatchKernel};
use crate::campaign::{Campaign, CampaignRun};
use crate::metrics::Selection;

/// Five modes with damping.
const FIVE: &str = "{ frequency = 0.44, gain = 0.0213, damping = 0.002, displacement = 2.75e-6 },
    { frequency = 0.755, gain = 0.0216, damping = 0.002 }, { frequency = 1.3, gain = 0.01, damping = 0.003 },
    { frequency = 2.1, gain = 0.01, damping = 0.004 }, { frequency = 3.4, gain = 0.01, damping = 0.005 }";

fn shipped(name: &str, changes: &[(&str, String)]) -> Scenario {
    let path = format!("{}/../../scenarios/{name}.toml", env!("CARGO_MANIFEST_DIR"));
    let mut document = crate::Document::load(Path::new(&path)).expect("shipped");
    for (key, value) in changes {
        document.set_text(key, value).expect("a key");
    }
    Scenario::from_document(&document).expect("valid")
}

/// Returns the metrics of a single run as text, with digits for all bits.
fn single(number: u64, scenario: &Scenario) -> String {
    let run = CampaignRun::new(scenario.clone(), number);
    Campaign::simulate(&run, ()).expect("a run").to_json().to_string()
}

fn compare(scenarios: &[Scenario], least: usize) {
    let jobs: Vec<BatchJob<'_>> = scenarios
        .iter()
        .zip(7..)
        .map(|(scenario, number)| BatchJob { number, scenario, selection: &Selection::ALL })
        .collect();
    assert!(scenarios.iter().all(|scenario| RelayBatch.accepts(scenario)));
    let expected: Vec<String> = jobs.iter().map(|job| single(job.number, job.scenario)).collect();
    for processor in Processor::all() {
        let found = RelayBatch.simulate(processor, &jobs);
        let whole = found.iter().flatten().count();
        assert!(whole >= least, "{}: {whole} of {}", processor.name(), jobs.len());
        for (index, (found, expected)) in found.iter().zip(&expected).enumerate() {
            if let Some(found) = found {
                assert_eq!(&found.to_json().to_string(), expected, "{}, run {index}", processor.name());
            }
        }
    }
}

#[test]
fn runs_of_many_gains_come_to_the_same() {
    let variant = |index: u32| {
        let k_t = 0.28 + 0.12 * f64::from(index) / 40.0;
        shipped("relay-fixed", &[("law.relay.k_t", k_t.to_string())])
    };
    let scenarios: Vec<Scenario> = (0..40).map(variant).collect();
    compare(&scenarios, 40);
}

#[test]
fn shipped_scenarios_and_others_come_to_the_same() {
    for name in ["relay-fixed", "relay-quiet", "relay-adaptive", "relay-no-freeze"] {
        let shipped_with = |gain: &str| shipped(name, &[("law.relay.k_t", gain.to_owned())]);
        compare(&["0.31", "0.3389", "0.35", "0.29", "0.33"].map(shipped_with), 5);
    }
    let text = |modes: &str, rest: &str| {
        let text = format!(
            "duration = 1234.5678\n[body.planar]\nangle = 4.5e-4\nrate = 2.2e-5\ninertia = 3.7\nmodes = [{modes}]\n\
             [law.relay]\ndead_zone = 5e-4\nhysteresis = 1e-4\nstrong = 14e-5\nweak = 3e-6\nk_t = 0.31\n{rest}"
        );
        Scenario::parse("relay", &text).expect("valid")
    };
    let modes = [
        "",
        "{ frequency = 0.44, gain = 0.02 }",
        "{ frequency = 0.3, gain = 0.02, rate = 1e-6 }, { frequency = 0.8, gain = 0.03 }, { frequency = 2.2, gain = 0.1 }",
        "{ frequency = 0.9, gain = 0.2 }, { frequency = 5.0, gain = 0.4 }",
        "{ frequency = 0.44, gain = 0.02, damping = 0.01 }",
        "{ frequency = 0.3, gain = 0.02, rate = 1e-6, damping = 0.3 }, { frequency = 0.8, gain = 0.03 }",
        FIVE,
    ];
    for modes in modes {
        let other = "[estimator.envelope]\nwindow = 77.0\nmodes = [{ frequency = 0.5, gain = 0.02, damping = 0.02 }]\n";
        for rest in ["", "[estimator.envelope]\nwindow = 77.0\n", "[reference]\nband = 5.1e-4\n", other] {
            // A light build has no kernels for damped modes.
            if cfg!(feature = "damped-flights") || ![modes, rest].concat().contains("damping") {
                compare(&vec![text(modes, rest); 3], 0);
            }
        }
    }
}

#[test]
#[cfg_attr(not(feature = "damped-flights"), ignore = "needs the feature `damped-flights`")]
fn runs_of_damped_modes_come_to_the_same() {
    for name in ["relay-fixed", "relay-adaptive", "relay-no-freeze"] {
        for modes in ["{ frequency = 0.44, gain = 0.0213, damping = 0.01 }", FIVE] {
            let variant = |index: u32| {
                let k_t = 0.28 + 0.12 * f64::from(index) / 19.0;
                let modes = format!("[{modes}]");
                let duration = "6000.0".to_owned();
                shipped(
                    name,
                    &[
                        ("body.planar.modes", modes),
                        ("law.relay.k_t", k_t.to_string()),
                        ("duration", duration),
                    ],
                )
            };
            let scenarios: Vec<Scenario> = (0..19).map(variant).collect();
            compare(&scenarios, 19);
        }
    }
}
