//! Matrices from MatrixMarket files: coordinate or array, real or integer, general or symmetric.

use std::io::BufRead;
use std::path::Path;
use std::str::FromStr;

use nalgebra::DMatrix;

use super::LARGEST;
use super::file::open_text;

const HEADER: &str = "must begin with `%%MatrixMarket matrix`, then `coordinate` or `array`, `real` or `integer`, \
                      `general` or `symmetric`";

/// Reads a matrix from a file.
pub fn read(path: &Path) -> Result<DMatrix<f64>, String> {
    parse(open_text(path)?)
}

fn parse(text: impl BufRead) -> Result<DMatrix<f64>, String> {
    let mut lines = (1..).zip(text.lines());
    let first =
        lines.next().map_or(Ok(String::new()), |(_, line)| line.map_err(|error| error.to_string()))?;
    let words: Vec<String> = first.split_whitespace().map(str::to_ascii_lowercase).collect();
    let words: Vec<&str> = words.iter().map(String::as_str).collect();
    let ["%%matrixmarket", "matrix", layout, "real" | "double" | "integer", symmetry] = words[..] else {
        return Err(format!("line 1: {HEADER}"));
    };
    let (coordinate, symmetric) = match (layout, symmetry) {
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
    let sizes = numbers::<usize>(number, &sizes, if coordinate { 3 } else { 2 }, "sizes")?;
    let (rows, columns) = (sizes[0], sizes[1]);
    if rows > LARGEST || columns > LARGEST {
        return Err(format!("line {number}: must have at most {LARGEST} rows, got {rows} x {columns}"));
    }
    if symmetric && rows != columns {
        return Err(format!("line {number}: must be square to be symmetric, got {rows} x {columns}"));
    }
    // An array is stored by columns; a symmetric one from the diagonal on.
    let from = |column: usize| if symmetric { column } else { 0 };
    let mut places = (0..columns).flat_map(|j| (from(j)..rows).map(move |i| (i, j)));
    let count = if coordinate { sizes[2] } else { (0..columns).map(|j| rows.saturating_sub(from(j))).sum() };
    let mut matrix = DMatrix::zeros(rows, columns);
    for found in 0..count {
        let (number, line) =
            lines.next().ok_or_else(|| format!("must have {count} elements, got {found}"))??;
        let (i, j, value) = if coordinate {
            let place = line.split_whitespace().take(2).collect::<Vec<_>>().join(" ");
            let place = numbers::<usize>(number, &place, 2, "indices and a number")?;
            let (i, j) = (place[0].wrapping_sub(1), place[1].wrapping_sub(1));
            if i >= rows || j >= columns {
                let (i, j) = (place[0], place[1]);
                return Err(format!(
                    "line {number}: must be within {rows} x {columns}, counted from 1, got {i} {j}"
                ));
            }
            let value = line.split_whitespace().skip(2).collect::<Vec<_>>().join(" ");
            (i, j, numbers::<f64>(number, &value, 1, "indices and a number")?[0])
        } else {
            let (i, j) = places.next().unwrap_or_default();
            (i, j, numbers::<f64>(number, &line, 1, "one number")?[0])
        };
        // Elements given twice add up, as in an assembly.
        matrix[(i, j)] += value;
        if symmetric && i != j {
            matrix[(j, i)] += value;
        }
    }
    match lines.next() {
        None => Ok(matrix),
        Some(Err(why)) => Err(why),
        Some(Ok((number, _))) => Err(format!("line {number}: must end after {count} elements")),
    }
}

fn numbers<T: FromStr>(number: usize, line: &str, count: usize, expected: &str) -> Result<Vec<T>, String> {
    let parsed: Option<Vec<T>> = line.split_whitespace().map(|word| word.parse().ok()).collect();
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
            "%%MatrixMarket matrix coordinate real symmetric\n2 2 3\n1 1 1.5\n2 1 -2\n2 2 4e0\n",
            "%%MatrixMarket MATRIX array real general\n2 2\n1.5\n-2\n-2\n4\n",
            "%%MatrixMarket matrix array real symmetric\n2 2\n1.5\n-2\n4\n",
            "%%MatrixMarket matrix coordinate real symmetric\n2 2 4\n1 1 1\n1 1 0.5\n2 1 -2\n2 2 4\n",
        ];
        for text in texts {
            assert_eq!(parse(text.as_bytes()).as_ref(), Ok(&matrix), "{text}");
        }
        let integers = "%%MatrixMarket matrix coordinate integer general\n1 2 1\n1 2 7\n";
        assert_eq!(parse(integers.as_bytes()), Ok(DMatrix::from_row_slice(1, 2, &[0.0, 7.0])));
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
        ];
        for (text, why) in cases {
            let error = parse(text.as_bytes()).expect_err("wrong");
            assert!(error.contains(why), "{error}");
        }
    }
}
