//! `flexsc schema`: the JSON Schema of scenarios for editors, and the meaning of metrics and topics.

use flexsc_core::Scenario;
use flexsc_core::metrics;
use flexsc_core::record::description;
use serde_json::json;

use crate::error::CliError;
use crate::print;

#[derive(clap::Args)]
pub struct SchemaArgs {
    /// Print the metrics with their units and meanings instead
    #[arg(long)]
    metrics: bool,
    /// The topics of logs with their fields, instead of the form of scenarios
    #[arg(long, conflicts_with = "metrics")]
    topics: bool,
}

pub fn run(args: &SchemaArgs) -> Result<(), CliError> {
    let document = if args.metrics {
        let meaning = |m: &metrics::MetricDescription| json!({"name": m.name, "unit": m.unit, "doc": m.doc});
        metrics::ALL.iter().map(meaning).collect()
    } else if args.topics {
        description::topics()
    } else {
        Scenario::schema()
    };
    print(format!("{document:#}\n").as_bytes())
}
