//! Topics of a run as a whole: the simulated scenario, and its results.

use crate::row::rows;
use crate::states::Onset;

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
        /// Value; NaN if there is none.
        value: f64,
        /// Value of a metric that is text.
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
        /// Value, or list of values.
        value: String,
        /// Unit.
        unit: String,
    }
    /// Some metrics.
    MetricPage {
        /// Each metric.
        metrics: Vec<MetricLine>,
    }
    /// The metrics of the run again as readable tables: in pages, since tables of viewers show ten rows.
    Summary = "/summary" {
        /// Each page.
        pages: Vec<MetricPage>,
    }
    /// A failure of a sensor or an actuator begins or ends.
    FaultEvent = "/faults" {
        /// Time since the start, rounded to a double (s).
        time_s: f64,
        /// Whole seconds of the exact time.
        time_whole_s: u64,
        /// Femtoseconds of the exact time past the whole second.
        time_fs: u64,
        /// The key of the part: `sensor.sampled`.
        part: String,
        /// Component that fails; empty for the whole part.
        of: String,
        /// The kind of failure.
        fault: String,
        /// Whether it begins or ends.
        onset: Onset,
    }
    /// A mode of operation begins.
    ModeEvent = "/mode" {
        /// Time since the start, rounded to a double (s).
        time_s: f64,
        /// Whole seconds of the exact time.
        time_whole_s: u64,
        /// Femtoseconds of the exact time past the whole second.
        time_fs: u64,
        /// Index of the mode in the scenario, from 0.
        index: u64,
        /// Name of the mode.
        mode: String,
        /// Name of the mode before; empty at the start.
        before: String,
        /// Condition that ended the mode before, as written; empty at the start.
        cause: String,
    }
    /// The name of an observed coordinate.
    OutputName {
        /// Name.
        name: String,
        /// Unit.
        unit: String,
    }
    /// The simulated scenario, logged once at the start.
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
