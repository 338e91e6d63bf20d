//! Shipped scenarios run by the engine itself, and their metrics.

use flexsc_core::campaign::{Campaign, CampaignRun};
use flexsc_core::metrics::{MetricValue, Metrics};
use flexsc_core::{Document, Scenario};

/// A shipped scenario with some keys set.
pub fn scenario(name: &str, set: &[(&str, &str)]) -> Scenario {
    let path = format!("{}/../../scenarios/{name}.toml", env!("CARGO_MANIFEST_DIR"));
    let mut document = Document::load(path.as_ref()).expect("a scenario");
    for (key, value) in set {
        document.set_text(key, value).expect("a key");
    }
    Scenario::from_document(&document).expect("a valid scenario")
}

/// The metrics of a run.
pub fn metrics(scenario: Scenario) -> Metrics {
    Campaign::simulate(&CampaignRun::new(scenario, 0), ()).expect("a run")
}

/// A metric that is a list.
pub fn numbers(metrics: &Metrics, name: &str) -> Vec<f64> {
    match metrics.get(name) {
        Some(value @ (MetricValue::Numbers(_) | MetricValue::Quantities(_))) => value.numbers(),
        other => panic!("{name}: {other:?}"),
    }
}

/// Returns the pairs of two sequences, which must have the same length and not be empty.
#[track_caller]
pub fn pairs<A: IntoIterator, B: IntoIterator>(a: A, b: B) -> impl Iterator<Item = (A::Item, B::Item)> {
    let (a, b): (Vec<_>, Vec<_>) = (a.into_iter().collect(), b.into_iter().collect());
    assert_eq!(a.len(), b.len(), "lengths");
    assert!(!a.is_empty(), "nothing to compare");
    a.into_iter().zip(b)
}

/// A value must agree with an exact one, relative to it.
#[track_caller]
pub fn close(value: f64, exact: f64, relative: f64) {
    let error = (value / exact - 1.0).abs();
    assert!(error <= relative, "{value:e} is off {exact:e} by {error:e} of it");
}
