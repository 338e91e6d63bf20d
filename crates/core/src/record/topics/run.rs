//! Topics of a run as a whole: what was simulated, and what it came to.

use crate::record::row::rows;

rows! {
    package "flexsc.v1";

    /// One metric, or one element of it.
    Metric {
        /// Name, as `flexsc schema --metrics` explains it.
        name: String,
        /// Unit.
        unit: String,
        /// Position in a metric that is a list, else 0.
        index: u64,
        /// Value; NaN where there is none.
        value: f64,
        /// Value of a metric that is a word.
        text: String,
    }
    /// The metrics of the run, once at its end.
    Metrics = "/metrics" {
        /// Each metric.
        metrics: Vec<Metric>,
    }
    /// One metric in words.
    MetricLine {
        /// Name, as `flexsc schema --metrics` explains it.
        name: String,
        /// Value, or the values of a list.
        value: String,
        /// Unit.
        unit: String,
    }
    /// Some metrics.
    MetricPage {
        /// Each metric.
        metrics: Vec<MetricLine>,
    }
    /// The metrics of the run once more, for people: in pages, since tables of viewers show ten rows.
    Summary = "/summary" {
        /// Each page.
        pages: Vec<MetricPage>,
    }
    /// The name of an observed coordinate.
    OutputName {
        /// Name.
        name: String,
        /// Unit.
        unit: String,
    }
    /// What was simulated, once at the start.
    Params = "/params" {
        /// Name of the scenario.
        scenario: String,
        /// Seed of the scenario.
        seed: u64,
        /// Number of the run.
        run: u64,
        /// The scenario with all defaults, as TOML.
        toml: String,
        /// The observed coordinates, in the order of `/outputs`.
        outputs: Vec<OutputName>,
    }
}
