//! Columns of a campaign's directory, read from all of its parts.

use std::ops::Range;

use super::directory::{AGAIN, Directory, damaged};
use super::error::{DirectoryError, invalid_file};
use super::parquet::ParquetFile;
use super::rows::{ColumnCells, ColumnKind};
use crate::metrics::list_element;

impl Directory {
    /// Returns a column of all existing rows, in the order of their runs; `None` if the campaign has no such column.
    pub fn column(&self, name: &str) -> Result<Option<ColumnCells>, DirectoryError> {
        Ok(self.columns(&[name])?.remove(0))
    }

    /// Returns several columns, or elements `NAME[i]` of columns of lists, opening each part once.
    pub fn columns<'a>(&self, names: &[&'a str]) -> Result<Vec<Option<ColumnCells>>, DirectoryError> {
        let kind =
            |name: &str| self.work().fields().iter().find(|field| field.name == name).map(|field| field.kind);
        let resolved = |name: &&'a str| match list_element(name).filter(|_| kind(name).is_none()) {
            Some((list, index)) => (list, Some(index)),
            None => (*name, None),
        };
        let resolved: Vec<(&str, Option<usize>)> = names.iter().map(resolved).collect();
        let stored: Vec<&str> = resolved.iter().map(|(name, _)| *name).collect();
        let pick = |((_, element), column): ((&str, Option<usize>), Option<ColumnCells>)| match element {
            Some(index) => column?.element(index),
            None => column,
        };
        Ok(resolved.into_iter().zip(self.stored_columns(&stored, kind)?).map(pick).collect())
    }

    /// Returns columns that are stored, opening each part once; `kind` returns the type of a column.
    fn stored_columns(
        &self,
        names: &[&str],
        kind: impl Fn(&str) -> Option<ColumnKind>,
    ) -> Result<Vec<Option<ColumnCells>>, DirectoryError> {
        let mut all: Vec<Option<ColumnCells>> =
            names.iter().map(|name| kind(name).map(ColumnCells::empty)).collect();
        let known: Vec<&str> = names.iter().copied().filter(|name| kind(name).is_some()).collect();
        for runs in self.parts()? {
            for (all, column) in all.iter_mut().flatten().zip(self.columns_of(&runs, &known)?) {
                all.append(column);
            }
        }
        Ok(all)
    }

    /// Returns columns of a part.
    pub fn columns_of(&self, runs: &Range<u64>, names: &[&str]) -> Result<Vec<ColumnCells>, DirectoryError> {
        let reading = self.open_part(runs)?;
        names.iter().map(|name| self.column_of(&reading, runs, name)).collect()
    }

    /// Returns a column of a part that is open.
    pub(super) fn column_of(
        &self,
        reading: &ParquetFile,
        runs: &Range<u64>,
        name: &str,
    ) -> Result<ColumnCells, DirectoryError> {
        let path = self.file(runs);
        let column = reading.column(name).map_err(damaged(&path))?;
        let column = column.ok_or_else(|| invalid_file(&path, format!("has no column `{name}`")))?;
        if column.len() as u64 == runs.end - runs.start {
            return Ok(column);
        }
        Err(invalid_file(&path, format!("is damaged (`{name}` has {} rows); {AGAIN}", column.len())))
    }
}
