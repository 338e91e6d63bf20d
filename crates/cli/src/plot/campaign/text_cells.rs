//! Texts of a column's cells: those of a table, or values that are formatted.

/// Source of the cells' texts in a column.
pub enum TextCells {
    /// Texts of a table.
    Cells(Vec<String>),
    /// Integers, formatted from the values.
    Integers,
    /// Numbers, formatted from the values.
    Numbers,
    /// Goals, formatted as met or not.
    Goals,
}

impl TextCells {
    /// Returns the text of a cell with this value; empty without a value.
    pub fn formatted(&self, index: usize, value: f64) -> String {
        match self {
            Self::Cells(cells) => cells[index].clone(),
            Self::Goals if value > 0.0 => "met".to_owned(),
            Self::Goals if value == 0.0 => "missed".to_owned(),
            _ if value.is_nan() => String::new(),
            Self::Integers => format!("{value}"),
            Self::Numbers | Self::Goals => format!("{value:e}"),
        }
    }
}
