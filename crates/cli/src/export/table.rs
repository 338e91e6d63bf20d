//! Table of a topic: columns without nesting, as CSV or JSON lines.

use std::io::{self, Write};
use std::rc::Rc;

use flexsc_core::record::{Column, Columns};
use serde_json::{Map, Value as Json, json};

/// Largest number of empty cells in a table with nested rows of unequal lengths, in addition to ...
const EMPTY_CELLS: usize = 1 << 24;
/// ... this number for each full cell.
const EMPTY_PER_FULL: usize = 16;

/// Cell of a table.
enum ExportCell<'a> {
    Empty,
    Number(f64),
    /// Exact time: whole seconds and femtoseconds, more digits than a double has.
    Exact(u64, u64),
    Count(u64),
    Integer(i64),
    Text(&'a str),
}

/// Column of a table without nesting.
pub struct FlatColumn<'a> {
    name: String,
    column: &'a Column,
    cells: CellSource<'a>,
}

/// Mapping from the rows of a table to the values of a column.
enum CellSource<'a> {
    /// One value for each row.
    Own,
    /// Exact times: whole seconds, and femtoseconds past them.
    Exact(&'a [u64], &'a [u64]),
    /// Values at one index of nested rows: the index, the number of nested rows in each row, and the number before it.
    Within(usize, &'a [u32], Rc<[usize]>),
}

/// Returns columns without nesting, such as `modes[0].displacement_rad`, with the exact time instead of its two parts.
pub fn flat(columns: &Columns) -> Result<Vec<FlatColumn<'_>>, String> {
    let mut flat = Vec::new();
    let parts = (columns.get("time_whole_s"), columns.get("time_fs"));
    let own = |column| FlatColumn { name: String::new(), column, cells: CellSource::Own };
    for (name, column) in &columns.columns {
        let cells = match (name.as_str(), column, &parts) {
            ("time_whole_s" | "time_fs", Column::Counts(_), (Some(_), Some(_))) => continue,
            ("time_s", _, (Some(Column::Counts(whole)), Some(Column::Counts(part)))) => {
                FlatColumn { cells: CellSource::Exact(whole, part), ..own(column) }
            }
            (_, Column::Rows(counts, inner), _) => {
                spread(&mut flat, name, counts, inner)?;
                continue;
            }
            _ => own(column),
        };
        flat.push(FlatColumn { name: name.clone(), ..cells });
    }
    Ok(flat)
}

/// Appends a column for each index and field of nested rows.
fn spread<'a>(
    flat: &mut Vec<FlatColumn<'a>>,
    name: &str,
    counts: &'a [u32],
    inner: &'a Columns,
) -> Result<(), String> {
    let widest = counts.iter().copied().max().unwrap_or(0) as usize;
    let full: usize = counts.iter().map(|count| *count as usize).sum();
    if widest.saturating_mul(counts.len()) - full > EMPTY_CELLS.saturating_add(EMPTY_PER_FULL * full) {
        let rows = counts.len();
        return Err(format!(
            "`{name}` has up to {widest} values in one of {rows} rows, and most rows have far fewer: no table holds \
             that\n\nhint: Python reads it, as one array for each row"
        ));
    }
    let before = counts.iter().scan(0, |sum, count| {
        let before = *sum;
        *sum += *count as usize;
        Some(before)
    });
    let before: Rc<[usize]> = before.collect();
    for index in 0..widest {
        for (field, column) in &inner.columns {
            let dot = if field.is_empty() { "" } else { "." };
            let cells = CellSource::Within(index, counts, Rc::clone(&before));
            flat.push(FlatColumn { name: format!("{name}[{index}]{dot}{field}"), column, cells });
        }
    }
    Ok(())
}

impl FlatColumn<'_> {
    fn cell(&self, row: usize) -> ExportCell<'_> {
        let place = match &self.cells {
            CellSource::Own => row,
            CellSource::Exact(whole, part) => return ExportCell::Exact(whole[row], part[row]),
            CellSource::Within(index, counts, before) if *index < counts[row] as usize => before[row] + index,
            CellSource::Within(..) => return ExportCell::Empty,
        };
        match self.column {
            Column::Numbers(values) => ExportCell::Number(values[place]),
            Column::Counts(values) => ExportCell::Count(values[place]),
            Column::Integers(values) => ExportCell::Integer(values[place]),
            Column::Texts(values) => ExportCell::Text(&values[place]),
            Column::Labels(values, labels) => labels
                .get(usize::from(values[place]))
                .map_or(ExportCell::Empty, |label| ExportCell::Text(label)),
            Column::Rows(counts, _) => ExportCell::Count(u64::from(counts[place])),
        }
    }
}

/// Writes a table as comma-separated values with a header.
pub fn csv(columns: &[FlatColumn<'_>], rows: usize, out: &mut dyn Write) -> io::Result<()> {
    let mut writer = ::csv::Writer::from_writer(out);
    let text = |cell: ExportCell<'_>| match cell {
        ExportCell::Empty => String::new(),
        // The shortest text that reads back as the same double.
        ExportCell::Number(number) => format!("{number:e}"),
        ExportCell::Exact(whole, femtoseconds) => format!("{whole}.{femtoseconds:015}"),
        ExportCell::Text(text) => text.to_owned(),
        ExportCell::Count(count) => count.to_string(),
        ExportCell::Integer(number) => number.to_string(),
    };
    // The kind distinguishes a closed pipe from other errors.
    let io = |error: ::csv::Error| match error.into_kind() {
        ::csv::ErrorKind::Io(error) => error,
        other => io::Error::other(format!("{other:?}")),
    };
    writer.write_record(columns.iter().map(|column| &column.name)).map_err(io)?;
    for row in 0..rows {
        writer.write_record(columns.iter().map(|column| text(column.cell(row)))).map_err(io)?;
    }
    writer.flush()
}

/// Writes a table as one JSON object for each row.
pub fn jsonl(columns: &[FlatColumn<'_>], rows: usize, out: &mut dyn Write) -> io::Result<()> {
    let value = |cell: ExportCell<'_>| match cell {
        ExportCell::Empty => Json::Null,
        ExportCell::Number(number) => json!(number),
        ExportCell::Exact(whole, part) => {
            json!(format!("{whole}.{part:015}").parse::<f64>().unwrap_or(f64::NAN))
        }
        ExportCell::Count(count) => json!(count),
        ExportCell::Integer(number) => json!(number),
        ExportCell::Text(text) => json!(text),
    };
    for row in 0..rows {
        let object: Map<String, Json> =
            columns.iter().map(|column| (column.name.clone(), value(column.cell(row)))).collect();
        writeln!(out, "{}", Json::Object(object))?;
    }
    Ok(())
}
