//! Answer of a log from its rows, where the run is not repeated: largest values are those of rows, not of control cycles.

use flexsc_formats::reader_units::{ReaderUnits, time};
use flexsc_numerics::time::{Instant, Span};
use flexsc_record::row::TopicRow;
use flexsc_record::{
    self as record, BlindingEvent, Columns, FaultEvent, Log, LogError, LogRow, ModeEvent, Pointing, Wheels,
};
use flexsc_scenario::Scenario;

use super::{Answer, RunObserver, RunVerdict};
use crate::metrics::{MetricValue, Metrics, MetricsCollector, NamedMetric};

/// Rows of several topics with their times (s).
#[derive(Default)]
struct TimedRows(Vec<(f64, Box<dyn LogRow>)>);

impl TimedRows {
    fn add<R: TopicRow + LogRow>(&mut self, columns: Option<&Columns>) {
        let rows = columns.and_then(Columns::timed_rows::<R>).unwrap_or_default();
        self.0.extend(rows.into_iter().map(|(time, row)| (time, Box::new(row) as Box<dyn LogRow>)));
    }
}

impl Answer {
    /// Returns the answer of a log of a scenario's run from its rows and its metrics, without a repetition of the run.
    ///
    /// # Errors
    /// A log whose rows cannot be read.
    pub fn from_rows(scenario: &Scenario, log: &Log, units: ReaderUnits) -> Result<Self, LogError> {
        let topics = [
            ModeEvent::TOPIC.name,
            BlindingEvent::TOPIC.name,
            FaultEvent::TOPIC.name,
            Pointing::TOPIC.name,
            Wheels::TOPIC.name,
            record::Metrics::TOPIC.name,
        ];
        let tables = log.tables(&topics)?;
        // Of rows of one instant, those of events come first.
        let mut rows = TimedRows::default();
        rows.add::<ModeEvent>(tables[0].as_ref());
        rows.add::<BlindingEvent>(tables[1].as_ref());
        rows.add::<FaultEvent>(tables[2].as_ref());
        rows.add::<Pointing>(tables[3].as_ref());
        rows.add::<Wheels>(tables[4].as_ref());
        rows.0.sort_by(|a, b| a.0.total_cmp(&b.0));
        let mut observer = RunObserver::new(scenario);
        for (time, row) in &rows.0 {
            observer.observe_row(Instant::START + Span::from_seconds(*time), &**row);
        }
        let observed = observer.finish();
        let metrics = tables[5].as_ref().and_then(Columns::timed_rows::<record::Metrics>).unwrap_or_default();
        let metrics = metrics.last().map(|(_, row)| row).filter(|row| !row.metrics.is_empty());
        let is_complete = log.metadata().get("end").is_some_and(|end| end == "complete");
        let mut answer = if let Some(row) = metrics.filter(|_| is_complete) {
            Self::new(scenario, &logged_metrics(scenario, row), Some(&observed), units)
        } else {
            let end = rows.0.last().map_or(0.0, |(time, _)| *time);
            let [end, all] = [end, scenario.duration.seconds()].map(time);
            Self {
                verdict: RunVerdict::Failed,
                verdict_text: format!("FAILED: the log ends at {end} of {all}"),
                requirements: Vec::new(),
                by_mode: Vec::new(),
                lines: Vec::new(),
                events: observed.events,
                ..Self::new(scenario, &Metrics::default(), None, units)
            }
        };
        answer.from_rows_s = Some(scenario.log.period_for(scenario.duration).seconds());
        Ok(answer)
    }
}

/// Returns the metrics of a row of a log.
fn logged_metrics(scenario: &Scenario, row: &record::Metrics) -> Metrics {
    // A collector without samples has the metrics of a run, each with its kind.
    let shapes = MetricsCollector::new(scenario).finish(scenario);
    let value = |name: &str, shape: &MetricValue| {
        let own: Vec<&record::Metric> = row.metrics.iter().filter(|metric| metric.name == name).collect();
        Some(match shape {
            MetricValue::Count(_) => MetricValue::Count(own.first()?.value as u64),
            MetricValue::Number(_) => MetricValue::Number(own.first()?.value),
            MetricValue::Word(_) | MetricValue::Words(_) => {
                MetricValue::Words(own.iter().map(|metric| metric.text.clone()).collect())
            }
            MetricValue::Numbers(_) | MetricValue::Quantities(_) => {
                MetricValue::Numbers(own.iter().map(|metric| metric.value).collect())
            }
        })
    };
    let metric = |(meaning, shape): &NamedMetric| Some((*meaning, value(meaning.name, shape)?));
    Metrics(shapes.0.iter().filter_map(metric).collect())
}
