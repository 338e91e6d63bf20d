//! Runs made by tests, and the columns of their traces.

use flexsc_core::metrics::{Metrics, MetricsCollector};
use flexsc_core::record::{Column, Detail, Trace};
use flexsc_core::{Scenario, Simulation};

/// Returns the metrics and the trace of a run.
pub fn flown(scenario: &Scenario, run: u64, detail: Detail) -> (Metrics, Trace) {
    let (mut gather, mut trace) = (MetricsCollector::new(scenario), Trace::new(detail));
    Simulation::new(scenario, run).run(&mut (&mut gather, &mut trace)).expect("a run");
    (gather.finish(scenario), trace)
}

/// Returns the full trace of the first run.
pub fn traced(scenario: &Scenario) -> Trace {
    let mut trace = Trace::new(Detail::Full);
    Simulation::new(scenario, 0).run(&mut trace).expect("a run");
    trace
}

/// Returns the lines of a table of numbers among the golden values.
pub fn golden_rows(name: &str) -> Vec<Vec<f64>> {
    let path = format!("{}/../../tests/golden/{name}", env!("CARGO_MANIFEST_DIR"));
    let text = std::fs::read_to_string(&path).expect("a file");
    let cells = |line: &str| line.split(',').map(|cell| cell.parse().expect("a number")).collect();
    text.lines().map(cells).collect()
}

/// Returns a column of numbers of a topic.
pub fn column<'a>(trace: &'a Trace, topic: &str, name: &str) -> &'a [f64] {
    let numbers = trace.topic(topic).and_then(|rows| rows.numbers(name));
    numbers.unwrap_or_else(|| panic!("no {name} in {topic}"))
}

/// Returns the times of the rows of a topic (s).
pub fn times(trace: &Trace, topic: &str) -> Vec<f64> {
    let mut topics = trace.clone().into_columns();
    let (_, columns) = topics.find(|(name, _)| name == &topic[1..]).unwrap_or_else(|| panic!("no {topic}"));
    columns.numbers("time_s").expect("times").to_vec()
}

/// Returns a column of numbers of the nested rows of a topic.
pub fn within<'a>(trace: &'a Trace, topic: &str, rows: &str, name: &str) -> &'a [f64] {
    match trace.topic(topic).and_then(|all| all.get(rows)) {
        Some(Column::Rows(_, inner)) => inner.numbers(name),
        _ => None,
    }
    .unwrap_or_else(|| panic!("no {rows}.{name} in {topic}"))
}

/// Returns the numbers of the nested row `index` in each row of a topic, which has `of` nested rows.
pub fn nested(trace: &Trace, topic: &str, [rows, name]: [&str; 2], (index, of): (usize, usize)) -> Vec<f64> {
    within(trace, topic, rows, name).iter().skip(index).step_by(of).copied().collect()
}
