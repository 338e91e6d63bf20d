//! Spacecraft as a newcomer writes them from the documentation, of at most 60 lines: each is read, runs, and does its work.

use flexsc_core::metrics::{MetricValue, MetricsCollector};
use flexsc_core::{Scenario, Simulation};

const FILES: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../../tests/newcomers");

#[test]
fn what_is_written_from_the_documentation_runs_and_meets_its_goal() {
    let mut names: Vec<_> =
        std::fs::read_dir(FILES).expect("files").map(|file| file.expect("a file").path()).collect();
    names.sort();
    assert_eq!(names.len(), 7);
    for path in names {
        let text = std::fs::read_to_string(&path).expect("a text");
        assert!(text.lines().count() <= 60, "{}", path.display());
        let scenario = Scenario::load(&path).unwrap_or_else(|error| panic!("{error}"));
        let mut gather = MetricsCollector::new(&scenario);
        Simulation::new(&scenario, 0).run(&mut gather).expect("a run");
        let metrics = gather.finish(&scenario);
        assert_eq!(metrics.get("goal"), Some(&MetricValue::Word("met")), "{}", path.display());
    }
}
