//! `flexsc schema`: the JSON Schema of scenarios for editors, the keys of a table, and the meaning of metrics and topics.

mod keys;

use flexsc_core::Scenario;
use flexsc_core::metrics;
use flexsc_core::record::description;
use serde_json::json;

use crate::error::CliError;
use crate::print;
use keys::SchemaKeys;

#[derive(clap::Args)]
pub struct SchemaArgs {
    /// Print the keys of this table with their units, defaults and meanings instead, such as sensor.gyro
    #[arg(conflicts_with_all = ["metrics", "topics"])]
    table: Option<String>,
    /// Print the keys of TABLE as JSON
    #[arg(long, requires = "table")]
    json: bool,
    /// Print the metrics with their units and meanings instead
    #[arg(long)]
    metrics: bool,
    /// The topics of logs with their fields, instead of the form of scenarios
    #[arg(long, conflicts_with = "metrics")]
    topics: bool,
}

pub fn run(args: &SchemaArgs) -> Result<(), CliError> {
    if let Some(path) = &args.table {
        let table = SchemaKeys::new(Scenario::schema()).table(path).map_err(CliError::Arguments)?;
        let printed = if args.json { format!("{:#}\n", table.json()) } else { table.text() };
        return print(printed.as_bytes());
    }
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
