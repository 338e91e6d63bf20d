//! Files of Gauss coefficients: the `.shc` of the IAGA and its table of columns (`igrf14coeffs.txt`), and the `.COF` of the World
//! Magnetic Model and of models in blocks.

use std::io::BufRead;

use super::{HarmonicRows, LARGEST, MOST_DEGREES, MOST_YEARS};
use crate::number::real;

/// Years for which the rates of a model hold.
const RATED_YEARS: f64 = 5.0;

/// Largest number of lines before the rows of a table of columns.
const HEADERS: usize = 5;

/// Lines with their numbers, from 1.
type NumberedLines = Vec<(usize, String)>;

/// Reads the text of a file; the kinds differ in the first line, and columns in their rows.
pub(super) fn read(file: impl BufRead) -> Result<HarmonicRows, String> {
    let mut lines = NumberedLines::new();
    for (index, line) in file.lines().enumerate() {
        let line = line.map_err(|error| match error.kind() {
            std::io::ErrorKind::InvalidData => format!("line {}: is not UTF-8 text", index + 1),
            _ => error.to_string(),
        })?;
        if !line.trim().is_empty() && !line.trim_start().starts_with('#') {
            lines.push((index + 1, line));
        }
    }
    let Some((_, first)) = lines.first() else {
        return Err("must have coefficients, and is empty".to_owned());
    };
    let numeric = |field: Option<&str>| field.and_then(real).is_some();
    if let Some(header) = lines.iter().take(HEADERS + 1).position(|(_, line)| is_column_row(line)) {
        return read_columns(&lines, header);
    }
    let mut fields = first.split_whitespace();
    match (numeric(fields.next()), numeric(fields.next())) {
        (true, true) => read_shc(&lines),
        (true, false) => read_wmm(&lines),
        (false, _) => read_blocks(&lines),
    }
}

/// Returns the numbers of a line of at least `least`.
fn numbers((number, line): &(usize, String), least: usize, what: &str) -> Result<Vec<f64>, String> {
    let fields = line
        .split_whitespace()
        .map(|field| real(field).ok_or_else(|| format!("line {number}: must have {what}, got `{field}`")));
    let found: Vec<f64> = fields.collect::<Result<_, _>>()?;
    if found.len() >= least {
        return Ok(found);
    }
    Err(format!("line {number}: must have {what}, got `{}`", line.trim()))
}

/// Returns a number of a line as a count of at most `most`.
fn count(value: f64, most: usize, number: usize, what: &str) -> Result<usize, String> {
    if value.fract() == 0.0 && (0.0..=most as f64).contains(&value) {
        return Ok(value as usize);
    }
    Err(format!("line {number}: must have {what} of up to {most}, got {value}"))
}

/// Reads a header, the years, and rows of degree, order and a value for each year.
fn read_shc(lines: &NumberedLines) -> Result<HarmonicRows, String> {
    let header = numbers(
        &lines[0],
        5,
        "least and highest degree, number of years, order of the spline and its steps",
    )?;
    let first = lines[0].0;
    let [lowest, highest] = [header[0], header[1]];
    let degree = count(highest, MOST_DEGREES, first, "a highest degree")?;
    let number = count(header[2], MOST_YEARS, first, "a number of years")?;
    if lowest != 1.0 {
        return Err(format!("line {first}: must begin with degree 1, got {lowest}"));
    }
    let is_linear = header[3] == 2.0 && header[4] == 1.0;
    if !is_linear && number > 1 {
        let [order, steps] = [header[3], header[4]];
        return Err(format!(
            "line {first}: must be linear between its years, with a spline of order 2 and 1 step, got order {order} and {steps} steps"
        ));
    }
    let (mut years, mut next) = (Vec::new(), 1);
    while years.len() < number {
        let Some(line) = lines.get(next) else {
            return Err(format!("must have {number} years, got {}", years.len()));
        };
        years.extend(numbers(line, 1, "years")?);
        next += 1;
    }
    if years.len() > number {
        return Err(format!("line {}: must have {number} years, got {}", lines[next - 1].0, years.len()));
    }
    let mut places = Vec::new();
    let mut rows = Vec::new();
    for line in &lines[next..] {
        rows.push(numbers(line, 3, "degree, order and values")?);
        places.push(line.0);
    }
    let expected = HarmonicRows::rows_before(degree + 1);
    if rows.len() != expected {
        return Err(format!("must have {expected} rows up to degree {degree}, got {}", rows.len()));
    }
    let mut table = HarmonicRows { years, rows };
    table.sort(&|row| format!("line {}", places[row]))?;
    Ok(table)
}

/// Returns true for a row `g n m` or `h n m` of a table of columns.
fn is_column_row(line: &str) -> bool {
    let mut fields = line.split_whitespace();
    fields.next().is_some_and(|kind| ["g", "h"].iter().any(|known| kind.eq_ignore_ascii_case(known)))
        && fields.next().and_then(real).is_some()
}

/// Reads a table of columns whose rows begin at `first`: three names and the years in the line before, rates in a last column with
/// the years between which they hold.
fn read_columns(lines: &NumberedLines, first: usize) -> Result<HarmonicRows, String> {
    let Some((number, header)) = first.checked_sub(1).and_then(|header| lines.get(header)) else {
        return Err(format!("line {}: must follow a line `g/h n m` with the years", lines[first].0));
    };
    let mut titles: Vec<&str> = header.split_whitespace().skip(3).collect();
    let has_rates = titles.last().is_some_and(|last| real(last).is_none());
    if has_rates {
        titles.pop();
    }
    let mut years = numbers(&(*number, titles.join(" ")), 1, "years behind `g/h n m`")?;
    if years.len() >= MOST_YEARS {
        return Err(format!("line {number}: must have at most {MOST_YEARS} years"));
    }
    let last = years[years.len() - 1];
    years.extend(has_rates.then_some(last + RATED_YEARS));
    let (mut rows, mut places) = (Vec::new(), Vec::new());
    for (number, line) in &lines[first..] {
        if !is_column_row(line) {
            return Err(format!(
                "line {number}: must begin with g or h, degree and order, got `{}`",
                line.trim()
            ));
        }
        let kind = line.trim_start().split_at(1);
        let mut row = numbers(&(*number, kind.1.to_owned()), 3, "degree, order and values")?;
        if kind.0.eq_ignore_ascii_case("h") {
            row[1] = -row[1];
        }
        // A sine of order 0 is always 0.
        if row[1] == 0.0 && row[1].is_sign_negative() {
            continue;
        }
        if has_rates && row.len() == years.len() + 2 {
            let value = row.len() - 2;
            row[value + 1] = row[value] + RATED_YEARS * row[value + 1];
        }
        rows.push(row);
        places.push(*number);
    }
    let mut table = HarmonicRows { years, rows };
    table.sort(&|row| format!("line {}", places[row]))?;
    Ok(table)
}

/// Coefficients of a block with their rates.
struct Block {
    year: f64,
    /// Degree, order, g, h (nT), and their rates (nT a year).
    rows: Vec<[f64; 6]>,
    /// Line of each row.
    places: Vec<usize>,
}

/// Reads a row of degree, order, g, h and their rates.
fn block_row(line: &(usize, String)) -> Result<[f64; 6], String> {
    let what = "degree, order, g, h and their rates";
    let text: Vec<&str> = line.1.split_whitespace().take(6).collect();
    let row = numbers(&(line.0, text.join(" ")), 6, what)?;
    if let Some(value) = row[2..].iter().find(|value| value.abs() > LARGEST) {
        return Err(format!("line {}: must have values of up to {LARGEST:e} nT, got {value}", line.0));
    }
    if row[1] < 0.0 {
        return Err(format!("line {}: must have an order from 0 on, got {}", line.0, row[1]));
    }
    Ok([row[0], row[1], row[2], row[3], row[4], row[5]])
}

/// Reads a header with the year, rows, and a line of nines.
fn read_wmm(lines: &NumberedLines) -> Result<HarmonicRows, String> {
    let (number, header) = &lines[0];
    let text = header.split_whitespace().next().unwrap_or_default();
    let year = numbers(&(*number, text.to_owned()), 1, "a year")?[0];
    let is_end = |line: &str| line.trim().len() > 20 && line.trim().bytes().all(|byte| byte == b'9');
    let rows = &lines[1..];
    let Some(end) = rows.iter().position(|(_, line)| is_end(line)) else {
        return Err("must end with a line of nines, as a whole file of the World Magnetic Model".to_owned());
    };
    if end == 0 {
        return Err(format!("line {}: must be a row of degree, order, g, h and their rates", rows[0].0));
    }
    let mut block = Block { year, rows: Vec::new(), places: Vec::new() };
    for line in &rows[..end] {
        block.rows.push(block_row(line)?);
        block.places.push(line.0);
    }
    join(&[block], Some(year + RATED_YEARS))
}

/// Reads blocks of a header, with a name, the year, degrees and the years between which it holds, and rows.
fn read_blocks(lines: &NumberedLines) -> Result<HarmonicRows, String> {
    let (mut blocks, mut next, mut last) = (Vec::<Block>::new(), 0, None);
    while let Some((number, header)) = lines.get(next) {
        let what = "a name, a year, three degrees and the years between which the block holds";
        let text: Vec<&str> = header.split_whitespace().skip(1).take(7).collect();
        let fields = numbers(&(*number, text.join(" ")), 7, what)?;
        let degree = count(fields[1], MOST_DEGREES, *number, "a degree")?;
        let rates = count(fields[2], degree, *number, "a degree of the rates")?;
        let expected = degree * (degree + 3) / 2;
        let rows = lines[next + 1..].iter().take(expected);
        let mut block = Block { year: fields[0], rows: Vec::new(), places: Vec::new() };
        for line in rows {
            block.rows.push(block_row(line)?);
            block.places.push(line.0);
        }
        if block.rows.len() < expected {
            return Err(format!(
                "line {number}: must be followed by {expected} rows up to degree {degree}, got {}",
                block.rows.len()
            ));
        }
        if blocks.len() >= MOST_YEARS {
            return Err(format!("line {number}: must have at most {MOST_YEARS} blocks"));
        }
        last = (rates > 0).then_some(fields[5]);
        blocks.push(block);
        next += 1 + expected;
    }
    join(&blocks, last)
}

/// Joins blocks, of which the last holds up to the year `end` with its rates. Degrees that a block does not have are zero in its year.
fn join(blocks: &[Block], end: Option<f64>) -> Result<HarmonicRows, String> {
    let Some(widest) = blocks.iter().max_by_key(|block| block.rows.len()) else {
        return Err("must have coefficients, and has none".to_owned());
    };
    let mut years: Vec<f64> = blocks.iter().map(|block| block.year).collect();
    years.extend(end);
    let (mut rows, mut places) = (Vec::new(), Vec::new());
    for (index, first) in widest.rows.iter().enumerate() {
        let [mut g, mut h] = [[first[0], first[1]].to_vec(), [first[0], -first[1]].to_vec()];
        for block in blocks {
            let own = block.rows.get(index);
            if let Some(own) = own.filter(|own| own[..2] != first[..2]) {
                let [n, m] = [own[0], own[1]];
                return Err(format!(
                    "line {}: must have degree {} and order {}, as the other blocks, got {n} and {m}",
                    block.places[index], first[0], first[1]
                ));
            }
            g.push(own.map_or(0.0, |own| own[2]));
            h.push(own.map_or(0.0, |own| own[3]));
        }
        if let (Some(end), Some(last)) = (end, blocks.last()) {
            let own = last.rows.get(index).copied().unwrap_or_default();
            g.push(own[2] + own[4] * (end - last.year));
            h.push(own[3] + own[5] * (end - last.year));
        }
        rows.push(g);
        places.push(widest.places[index]);
        if first[1] != 0.0 {
            rows.push(h);
            places.push(widest.places[index]);
        }
    }
    let mut table = HarmonicRows { years, rows };
    table.sort(&|row| format!("line {}", places[row]))?;
    Ok(table)
}
