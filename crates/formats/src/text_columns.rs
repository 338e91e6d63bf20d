//! Rows of text as columns of equal width.

/// Returns rows of text as lines, with columns two spaces apart that are aligned to the left where `is_left` says so and
/// to the right elsewhere.
pub fn columns(rows: &[Vec<String>], is_left: impl Fn(usize) -> bool) -> Vec<String> {
    let widths = widths(rows);
    let line = |row: &Vec<String>| {
        let cells = row.iter().zip(&widths).enumerate().map(|(column, (cell, width))| {
            if is_left(column) { format!("{cell:<width$}") } else { format!("{cell:>width$}") }
        });
        cells.collect::<Vec<_>>().join("  ").trim_end().to_owned()
    };
    rows.iter().map(line).collect()
}

/// Returns the width of each column (characters).
pub fn widths(rows: &[Vec<String>]) -> Vec<usize> {
    let count = rows.iter().map(Vec::len).max().unwrap_or(0);
    let width = |column: usize| {
        rows.iter().filter_map(|row| row.get(column)).map(|cell| cell.chars().count()).max().unwrap_or(0)
    };
    (0..count).map(width).collect()
}

#[cfg(test)]
mod tests {
    use super::columns;

    #[test]
    fn columns_stay_apart() {
        let row = |cells: [&str; 2]| cells.map(str::to_owned).to_vec();
        let rows = [row(["a", "b"]), row(["123456789", "37917.7205"])];
        assert_eq!(columns(&rows, |_| false), ["        a           b", "123456789  37917.7205"]);
        assert_eq!(columns(&rows, |column| column == 0), ["a                   b", "123456789  37917.7205"]);
    }
}
