//! Merging of parts of one campaign that were made in several directories.

use std::fs;
use std::ops::Range;

use flexsc_record::atomic_file;

use super::directory::{Directory, MANIFEST};
use super::error::{DirectoryError, invalid_file, io_error, unreadable};
use super::manifest::Manifest;
use super::parquet::ParquetFile;
use super::part;
use super::rows::{ColumnCells, RunRows, SECONDS};

/// Runs of a part that are taken from a directory: its place among them, its part, and which runs of it.
#[derive(Clone, Debug)]
struct Piece {
    from: usize,
    part: Range<u64>,
    runs: Range<u64>,
}

/// Directories of one campaign, and which of their runs are taken: each run once, from the first that has it.
#[derive(Debug)]
pub struct Merge<'a> {
    all: &'a [Directory],
    manifest: Manifest,
    /// In the order of their runs.
    pieces: Vec<Piece>,
}

impl<'a> Merge<'a> {
    /// The merge of directories. Nothing is written yet.
    ///
    /// # Errors
    /// No directory; directories of several campaigns; a part that is damaged; a run that is another one elsewhere.
    pub fn new(all: &'a [Directory]) -> Result<Self, DirectoryError> {
        let Some(first) = all.first() else { return Err(invalid_file("".as_ref(), "no directory to merge")) };
        let mut manifest = first.work().manifest.clone();
        for other in all {
            let other_manifest = &other.work().manifest;
            if let Some(difference) = other_manifest.first_difference(&manifest) {
                return Err(DirectoryError::Other { path: other.path().join(MANIFEST), difference });
            }
            manifest.from = manifest.from.min(other_manifest.from);
            manifest.to = manifest.to.max(other_manifest.to);
        }
        let mut merge = Self { all, manifest, pieces: Vec::new() };
        for (from, directory) in all.iter().enumerate() {
            for part in directory.parts()? {
                merge.add(from, part)?;
            }
        }
        Ok(merge)
    }

    fn add(&mut self, from: usize, part: Range<u64>) -> Result<(), DirectoryError> {
        // All of it can be read, whether or not it is needed.
        let directory = &self.all[from];
        let reading = directory.open_part(&part)?;
        for field in directory.work().fields() {
            drop(directory.column_of(&reading, &part, &field.name)?);
        }
        let first = self.pieces.partition_point(|piece| piece.runs.end <= part.start);
        let last = self.pieces.partition_point(|piece| piece.runs.start < part.end);
        let present: Vec<Range<u64>> =
            self.pieces[first..last].iter().map(|piece| piece.runs.clone()).collect();
        for piece in &self.pieces[first..last] {
            self.compare(piece, from, &part)?;
        }
        let gaps = part::remove_present(part.clone(), &present);
        let new = gaps.into_iter().map(|runs| Piece { from, part: part.clone(), runs });
        self.pieces.extend(new);
        self.pieces.sort_by_key(|piece| piece.runs.start);
        Ok(())
    }

    /// Compares the runs that a piece and a part have in common, but for the time they took.
    fn compare(&self, piece: &Piece, from: usize, part: &Range<u64>) -> Result<(), DirectoryError> {
        let (one, other) = (&self.all[piece.from], &self.all[from]);
        let runs = piece.runs.start.max(part.start)..piece.runs.end.min(part.end);
        let (one_file, other_file) = (one.open_part(&piece.part)?, other.open_part(part)?);
        for field in self.work().fields().iter().filter(|field| field.name != SECONDS) {
            let cells_of_one = cells(one, &one_file, &piece.part, (&field.name, &runs))?;
            if cells_of_one != cells(other, &other_file, part, (&field.name, &runs))? {
                let why = format!("has other values of `{}` than {}", field.name, one.path().display());
                return Err(invalid_file(&other.file(part), why));
            }
        }
        Ok(())
    }

    /// Returns the work that computes the rows of all directories.
    pub fn work(&self) -> &super::RowMaker {
        self.all[0].work()
    }

    /// The manifest of all runs.
    pub fn manifest(&self) -> &Manifest {
        &self.manifest
    }

    /// How many runs are taken from each directory.
    pub fn used_counts(&self) -> Vec<u64> {
        let mut used = vec![0; self.all.len()];
        for piece in &self.pieces {
            used[piece.from] += piece.runs.end - piece.runs.start;
        }
        used
    }

    /// The runs that no directory has.
    pub fn missing(&self) -> Vec<Range<u64>> {
        let present: Vec<Range<u64>> = self.pieces.iter().map(|piece| piece.runs.clone()).collect();
        part::remove_present(self.manifest.runs(), &present)
    }

    /// The rows of all runs, in order.
    pub fn rows(&self) -> Result<RunRows, DirectoryError> {
        let mut rows = self.work().rows();
        for piece in &self.pieces {
            for (column, more) in rows.columns.iter_mut().zip(self.rows_of_piece(piece)?.columns) {
                column.append(more);
            }
        }
        Ok(rows)
    }

    fn rows_of_piece(&self, piece: &Piece) -> Result<RunRows, DirectoryError> {
        let directory = &self.all[piece.from];
        let reading = directory.open_part(&piece.part)?;
        let mut rows = self.work().rows();
        rows.columns = rows
            .fields
            .iter()
            .map(|field| cells(directory, &reading, &piece.part, (&field.name, &piece.runs)))
            .collect::<Result<_, _>>()?;
        Ok(rows)
    }

    /// Writes the runs into a directory that has those of the first one already, if `is_first`.
    pub fn write(&self, into: &Directory, is_first: bool) -> Result<(), DirectoryError> {
        for piece in self.pieces.iter().filter(|piece| !is_first || piece.from > 0) {
            if piece.part != piece.runs {
                into.write(&piece.runs, &self.rows_of_piece(piece)?)?;
                continue;
            }
            let (from, to) = (self.all[piece.from].file(&piece.part), into.file(&piece.runs));
            let bytes = fs::read(&from).map_err(unreadable(&from))?;
            atomic_file::write_synced(&to, &bytes).map_err(io_error(&to))?;
        }
        Ok(())
    }
}

/// The cells of a column in some runs of a part.
fn cells(
    directory: &Directory,
    reading: &ParquetFile,
    part: &Range<u64>,
    (name, runs): (&str, &Range<u64>),
) -> Result<ColumnCells, DirectoryError> {
    let column = directory.column_of(reading, part, name)?;
    Ok(column.slice((runs.start - part.start) as usize..(runs.end - part.start) as usize))
}
