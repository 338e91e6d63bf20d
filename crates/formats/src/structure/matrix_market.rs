//! Matrices from MatrixMarket files: coordinate or array, real or integer, general or symmetric.

use std::collections::BTreeMap;
use std::io::BufRead;
use std::path::Path;

use nalgebra::DMatrix;

use super::LARGEST;
use crate::number::real;
use crate::text_file::open_text;

const HEADER: &str = "must begin with `%%MatrixMarket matrix`, then `coordinate` or `array`, `real` or `integer`, \
                      `general` or `symmetric`";

/// Elements of a matrix, in the order of the file.
#[derive(Debug, Default, PartialEq)]
pub struct MatrixElements {
    /// Number of rows and of columns.
    pub shape: [usize; 2],
    /// True if the file lists single elements, of which others are 0.
    pub sparse: bool,
    /// Row of each element, from 0.
    pub rows: Vec<usize>,
    /// Column of each element, from 0.
    pub columns: Vec<usize>,
    /// Elements; those of one place add up, as in an assembly.
    pub values: Vec<f64>,
}

/// Reads a matrix from a file.
pub fn read(path: &Path) -> Result<DMatrix<f64>, String> {
    Ok(dense(&parse(open_text(path)?, LARGEST)?))
}

/// Reads the elements of a matrix of at most `most` rows and columns.
///
/// # Errors
/// The error, with its line.
pub fn read_elements(path: &Path, most: usize) -> Result<MatrixElements, String> {
    parse(open_text(path)?, most)
}

fn dense(elements: &MatrixElements) -> DMatrix<f64> {
    let [rows, columns] = elements.shape;
    let mut matrix = DMatrix::zeros(rows, columns);
    for ((i, j), value) in elements.rows.iter().zip(&elements.columns).zip(&elements.values) {
        matrix[(*i, *j)] += value;
    }
    matrix
}

fn parse(text: impl BufRead, most: usize) -> Result<MatrixElements, String> {
    let mut lines = (1..).zip(text.lines());
    let first =
        lines.next().map_or(Ok(String::new()), |(_, line)| line.map_err(|error| error.to_string()))?;
    let words: Vec<String> = first.split_whitespace().map(str::to_ascii_lowercase).collect();
    let words: Vec<&str> = words.iter().map(String::as_str).collect();
    let ["%%matrixmarket", "matrix", layout, "real" | "double" | "integer", symmetry] = words[..] else {
        return Err(format!("line 1: {HEADER}"));
    };
    let (sparse, symmetric) = match (layout, symmetry) {
        ("coordinate" | "array", "general" | "symmetric") => {
            (layout == "coordinate", symmetry == "symmetric")
        }
        _ => return Err(format!("line 1: {HEADER}")),
    };
    let mut lines = lines.filter_map(|(number, line)| match line {
        Ok(line) if line.trim().is_empty() || line.starts_with('%') => None,
        Ok(line) => Some(Ok((number, line))),
        Err(error) => Some(Err(format!("line {number}: {error}"))),
    });
    let (number, sizes) = lines.next().ok_or("must have a line with the sizes, got none")??;
    let sizes = fields(number, &sizes, if sparse { 3 } else { 2 }, "sizes", |word| word.parse().ok())?;
    let [rows, columns] = [sizes[0], sizes[1]];
    if rows > most || columns > most {
        return Err(format!("line {number}: must have at most {most} rows, got {rows} x {columns}"));
    }
    if symmetric && rows != columns {
        return Err(format!("line {number}: must be square to be symmetric, got {rows} x {columns}"));
    }
    // An array is stored by columns; a symmetric one from the diagonal on.
    let from = |column: usize| if symmetric { column } else { 0 };
    let mut places = (0..columns).flat_map(|j| (from(j)..rows).map(move |i| (i, j)));
    let all = || (0..columns).map(|j| rows.saturating_sub(from(j))).fold(0, usize::saturating_add);
    let count = if sparse { sizes[2] } else { all() };
    let mut elements = MatrixElements { shape: [rows, columns], sparse, ..MatrixElements::default() };
    // Lines of the elements off the diagonal of a symmetric matrix, by row and column: a file has one triangle.
    let mut triangle: BTreeMap<(usize, usize), usize> = BTreeMap::new();
    for found in 0..count {
        let (number, line) =
            lines.next().ok_or_else(|| format!("must have {count} elements, got {found}"))??;
        let (i, j, value) = if sparse {
            let expected = "indices and a number";
            let mut words = line.split_whitespace();
            let place: Vec<&str> = words.by_ref().take(2).collect();
            let place = fields::<usize>(number, &place.join(" "), 2, expected, |word| word.parse().ok())?;
            let value: Vec<&str> = words.collect();
            let value = fields(number, &value.join(" "), 1, expected, real)?[0];
            let (i, j) = (place[0], place[1]);
            if !(1..=rows).contains(&i) || !(1..=columns).contains(&j) {
                return Err(format!(
                    "line {number}: must be within {rows} x {columns}, counted from 1, got {i} {j}"
                ));
            }
            (i - 1, j - 1, value)
        } else {
            let (i, j) = places.next().unwrap_or_default();
            (i, j, fields(number, &line, 1, "one number", real)?[0])
        };
        elements.push(i, j, value);
        if symmetric && i != j {
            elements.push(j, i, value);
            if let Some(other) = triangle.get(&(j, i)) {
                return Err(format!(
                    "line {number}: must not mirror line {other}: a `symmetric` file has the elements of one triangle, got {} {} \
                     beside {} {}; write `general`, or leave one triangle out",
                    i + 1,
                    j + 1,
                    j + 1,
                    i + 1
                ));
            }
            triangle.insert((i, j), number);
        }
    }
    match lines.next() {
        None => Ok(elements),
        Some(Err(why)) => Err(why),
        Some(Ok((number, _))) => Err(format!("line {number}: must end after {count} elements")),
    }
}

impl MatrixElements {
    fn push(&mut self, row: usize, column: usize, value: f64) {
        self.rows.push(row);
        self.columns.push(column);
        self.values.push(value);
    }
}

/// Parses the fields of a line, which must be `count`.
fn fields<T>(
    number: usize,
    line: &str,
    count: usize,
    expected: &str,
    parse: impl Fn(&str) -> Option<T>,
) -> Result<Vec<T>, String> {
    let parsed: Option<Vec<T>> = line.split_whitespace().map(parse).collect();
    parsed.filter(|parsed| parsed.len() == count).ok_or_else(|| {
        let shown: String = line.chars().take(40).collect();
        format!("line {number}: must have {expected}, got `{shown}`")
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_layout_gives_its_matrix() {
        let matrix = DMatrix::from_row_slice(2, 2, &[1.5, -2.0, -2.0, 4.0]);
        let texts = [
            "%%MatrixMarket matrix coordinate real general\n% made by hand\n2 2 4\n1 1 1.5\n1 2 -2\n2 1 -2\n\n2 2 4\n",
            "%%MatrixMarket matrix coordinate real symmetric\n2 2 3\n1 1 1.5\n2 1 -2\n2 2 0.4D+01\n",
            "%%MatrixMarket MATRIX array real general\n2 2\n1.5\n-2\n-2\n4\n",
            "%%MatrixMarket matrix array real symmetric\n2 2\n1.5\n-2\n4\n",
            "%%MatrixMarket matrix coordinate real symmetric\n2 2 4\n1 1 1\n1 1 0.5\n2 1 -2\n2 2 4\n",
        ];
        for text in texts {
            let elements = parse(text.as_bytes(), LARGEST).expect("a matrix");
            assert_eq!(dense(&elements), matrix, "{text}");
            assert_eq!(elements.sparse, text.contains("coordinate"));
        }
        let integers = "%%MatrixMarket matrix coordinate integer general\n1 2 1\n1 2 7\n";
        let elements = parse(integers.as_bytes(), LARGEST).expect("a matrix");
        assert_eq!(dense(&elements), DMatrix::from_row_slice(1, 2, &[0.0, 7.0]));
    }

    #[test]
    fn errors_name_their_line() {
        let general = "%%MatrixMarket matrix coordinate real general\n";
        let cases = [
            (String::new(), "line 1: must begin with"),
            ("%%MatrixMarket matrix coordinate complex general\n".to_owned(), "line 1: must begin with"),
            (general.to_owned(), "sizes, got none"),
            (format!("{general}2 2\n"), "line 2: must have sizes, got `2 2`"),
            (format!("{general}2001 1 0\n"), "line 2: must have at most 2000 rows, got 2001 x 1"),
            (format!("{general}2 2 1\n3 1 1\n"), "line 3: must be within 2 x 2, counted from 1, got 3 1"),
            (format!("{general}2 2 1\n0 1 1\n"), "line 3: must be within 2 x 2, counted from 1, got 0 1"),
            (format!("{general}2 2 1\n1 1 x\n"), "line 3: must have indices and a number, got `x`"),
            (format!("{general}2 2 2\n1 1 1\n"), "must have 2 elements, got 1"),
            (format!("{general}2 2 1\n1 1 1\n2 2 1\n"), "line 4: must end after 1 elements"),
            (
                "%%MatrixMarket matrix coordinate real symmetric\n2 2 3\n2 1 1\n1 1 1\n1 2 1\n".to_owned(),
                "line 5: must not mirror line 3",
            ),
        ];
        for (text, why) in cases {
            let error = parse(text.as_bytes(), LARGEST).expect_err("wrong");
            assert!(error.contains(why), "{error}");
        }
    }
}
