//! `flexsc export`: a topic of a log as a table.

use std::path::PathBuf;

use clap::ValueEnum;
use flexsc_core::record::{Column, Columns, Log};
use serde_json::{Map, Value as Json, json};

use crate::failure::Failure;
use crate::{files, print};

#[derive(clap::Args)]
pub struct Args {
    /// Log file
    log: PathBuf,
    /// Topic, such as /command; left out, the topics of the log are listed
    #[arg(long, value_name = "TOPIC")]
    topic: Option<String>,
    /// Form of the table
    #[arg(long, value_enum, default_value = "csv")]
    format: Format,
    /// File to write, instead of stdout
    #[arg(short, long, value_name = "FILE")]
    out: Option<PathBuf>,
}

#[derive(Copy, Clone, ValueEnum)]
enum Format {
    /// Comma-separated values with a header
    Csv,
    /// One JSON object for each row
    Jsonl,
}

pub fn run(args: &Args) -> Result<(), Failure> {
    let log = Log::open(&args.log)?;
    let text = match &args.topic {
        None => format!("{}\n", log.topics().join("\n")).into_bytes(),
        Some(topic) => {
            let columns = flat(&log.columns(topic)?);
            match args.format {
                Format::Csv => csv(&columns),
                Format::Jsonl => jsonl(&columns),
            }
        }
    };
    match &args.out {
        Some(path) => files::write(path, &text),
        None => print(&text),
    }
}

/// A cell of a table.
#[derive(Clone)]
enum Cell {
    Empty,
    Number(f64),
    /// A number with more digits than a double has.
    Exact(String),
    Count(u64),
    Text(String),
}

/// Columns without nesting: `modes[0].displacement_rad`, and the exact time in place of its parts.
fn flat(columns: &Columns) -> Vec<(String, Vec<Cell>)> {
    let mut flat = Vec::new();
    let parts = (columns.get("time_whole_s"), columns.get("time_fs"));
    for (name, column) in &columns.columns {
        let cells = match (name.as_str(), column, &parts) {
            ("time_whole_s" | "time_fs", ..) => continue,
            ("time_s", _, (Some(Column::Counts(whole)), Some(Column::Counts(part)))) => {
                let exact = |(s, fs): (&u64, &u64)| Cell::Exact(format!("{s}.{fs:015}"));
                whole.iter().zip(part).map(exact).collect()
            }
            (_, Column::Rows(counts, inner), _) => {
                flat.extend(spread(name, counts, inner));
                continue;
            }
            _ => cells(column),
        };
        flat.push((name.clone(), cells));
    }
    flat
}

/// The rows within each row side by side.
fn spread(name: &str, counts: &[u32], inner: &Columns) -> Vec<(String, Vec<Cell>)> {
    let widest = counts.iter().copied().max().unwrap_or(0) as usize;
    let inner: Vec<_> = inner.columns.iter().map(|(field, column)| (field, cells(column))).collect();
    let mut spread = Vec::new();
    for index in 0..widest {
        for (field, values) in &inner {
            let mut first = 0;
            let column = counts.iter().map(|&count| {
                let cell = if index < count as usize { values[first + index].clone() } else { Cell::Empty };
                first += count as usize;
                cell
            });
            spread.push((format!("{name}[{index}].{field}"), column.collect()));
        }
    }
    spread
}

fn cells(column: &Column) -> Vec<Cell> {
    match column {
        Column::Numbers(values) => values.iter().map(|v| Cell::Number(*v)).collect(),
        Column::Counts(values) => values.iter().map(|v| Cell::Count(*v)).collect(),
        Column::Texts(values) => values.iter().map(|v| Cell::Text(v.clone())).collect(),
        Column::Labels(values, labels) => {
            let label = |v: &u8| labels.get(usize::from(*v)).cloned().map_or(Cell::Empty, Cell::Text);
            values.iter().map(label).collect()
        }
        Column::Rows(counts, _) => counts.iter().map(|v| Cell::Count(u64::from(*v))).collect(),
    }
}

fn csv(columns: &[(String, Vec<Cell>)]) -> Vec<u8> {
    let mut writer = ::csv::Writer::from_writer(Vec::new());
    let rows = columns.first().map_or(0, |(_, cells)| cells.len());
    let text = |cell: &Cell| match cell {
        Cell::Empty => String::new(),
        // The shortest text that reads back as the same double.
        Cell::Number(number) => format!("{number:e}"),
        Cell::Exact(text) | Cell::Text(text) => text.clone(),
        Cell::Count(count) => count.to_string(),
    };
    // Writing to memory does not fail.
    let _ = writer.write_record(columns.iter().map(|(name, _)| name));
    for row in 0..rows {
        let _ = writer.write_record(columns.iter().map(|(_, cells)| text(&cells[row])));
    }
    writer.into_inner().unwrap_or_default()
}

fn jsonl(columns: &[(String, Vec<Cell>)]) -> Vec<u8> {
    let rows = columns.first().map_or(0, |(_, cells)| cells.len());
    let value = |cell: &Cell| match cell {
        Cell::Empty => Json::Null,
        Cell::Number(number) => json!(number),
        Cell::Exact(text) => json!(text.parse::<f64>().unwrap_or(f64::NAN)),
        Cell::Count(count) => json!(count),
        Cell::Text(text) => json!(text),
    };
    let mut lines = Vec::new();
    for row in 0..rows {
        let object: Map<String, Json> =
            columns.iter().map(|(name, cells)| (name.clone(), value(&cells[row]))).collect();
        lines.extend(format!("{}\n", Json::Object(object)).into_bytes());
    }
    lines
}
