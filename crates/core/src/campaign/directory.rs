//! Directory of a campaign: a manifest, and parts of consecutive runs as Parquet files. Any number of processes on any
//! number of machines may write its parts; the rows do not depend on them.
//!
//! ```text
//! manifest.toml                               Manifest: version, scenario, design, runs, hash
//! runs/part-0000000000-0000002048.parquet     a row a run, and a checksum; each written beside its place, synced and renamed
//! .lock                                       held by the command that writes, released by the kernel on its death
//! statistics.csv                              of all rows, written by the command
//! ```
//!
//! A directory may come from somebody else: nothing in it is followed elsewhere or waited for, be it a link or a pipe.
//!
//! What a worker needs, such as a process of Dask:
//!
//! ```text
//! let campaign = Directory::open(path)?;           // or Work::of(manifest text), without any file system
//! for runs in campaign.missing()? {                // by the head: ranges of whole parts
//!     campaign.write_part(runs, threads, poll)?;   // by a worker: atomic, and harmless if done twice
//! }
//! ```
//!
//! Where parts go to a bucket, [`Work::part`] gives a part's name and bytes. [`Directory::create`] makes or continues a
//! directory, and holds its lock; workers need none.

use std::collections::BTreeMap;
use std::fs::{self, File, TryLockError};
use std::io::{self, Read};
use std::ops::Range;
use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};
use std::thread;
use std::time::{Duration, SystemTime};

use flexsc_record::Record;
use flexsc_record::atomic_file::{self, AtomicFile};

use super::error::{DirectoryError, invalid_file, io_error, unreadable};
use super::manifest::{LARGEST, Manifest};
use super::parquet::{ParquetFile, parquet_is_built_in};
use super::part;
use super::row_maker::{NOTE, RowMaker};
use super::rows::RunRows;

/// Name of the manifest's file.
pub const MANIFEST: &str = "manifest.toml";
/// Name of the directory of the parts.
pub const RUNS: &str = "runs";
/// The table of the statistics of all rows.
pub const STATISTICS: &str = "statistics.csv";
/// How that table begins.
const STATISTICS_BEGIN: &[u8] = b"metric,unit,runs,mean,sd,";
/// Name of the file that the writing command locks.
const LOCK: &str = ".lock";
/// Number of attempts at the lock, with a pause after each: a process that only checks the lock holds it briefly.
const ATTEMPTS: u32 = 10;
const MOMENT: Duration = Duration::from_millis(20);
/// Advice for a damaged part.
pub(super) const AGAIN: &str = "delete this file and repeat the command: its runs are computed again";

/// A part's first run and the one after its last, and the size and the time of its file.
type Whole = BTreeMap<(u64, u64), (u64, Option<SystemTime>)>;

/// Directory of a campaign.
#[derive(Debug)]
pub struct Directory {
    path: PathBuf,
    work: RowMaker,
    /// Lock file, held by the writing command for the lifetime of this value.
    _lock: Option<File>,
    /// Parts whose checksums were compared.
    whole: Mutex<Whole>,
}

impl Directory {
    /// Opens a directory, to read it or to write parts.
    pub fn open(path: &Path) -> Result<Self, DirectoryError> {
        parquet_is_built_in().map_err(unreadable(path))?;
        let place = path.join(MANIFEST);
        let manifest = read(&place)?
            .ok_or_else(|| invalid_file(path, format!("is not a campaign: it has no {MANIFEST}")))?;
        let work = RowMaker::from_manifest(manifest, &place)?;
        within(path)?;
        Ok(Self { path: path.to_owned(), work, _lock: None, whole: Mutex::default() })
    }

    /// Returns true if a directory is that of a campaign.
    pub fn is_campaign_directory(path: &Path) -> bool {
        fs::symlink_metadata(path.join(MANIFEST)).is_ok_and(|metadata| metadata.is_file())
    }

    /// Creates a directory, or continues an existing one of the same campaign with these runs too, or with `force`
    /// replaces one of another campaign. The returned value holds the directory's lock.
    ///
    /// # Errors
    /// Another campaign, which is not to be replaced; another process that is writing the directory.
    pub fn create(path: &Path, mut manifest: Manifest, force: bool) -> Result<Self, DirectoryError> {
        parquet_is_built_in().map_err(unreadable(path))?;
        let (runs, place) = (within(path)?, path.join(MANIFEST));
        // Checked before anything is changed, and again under the lock.
        fitting(path, &place, &manifest, force)?;
        fs::create_dir_all(&runs).map_err(io_error(&runs))?;
        let lock = lock(path)?;
        let existing = fitting(path, &place, &manifest, force)?;
        let fits = existing.as_ref().is_some_and(|previous| previous.first_difference(&manifest).is_none());
        if !fits {
            for file in parts(path)?.iter().map(|runs| path.join(RUNS).join(part::file_name(runs))) {
                fs::remove_file(&file).map_err(io_error(&file))?;
            }
        }
        if let Some(existing) = existing.filter(|_| fits) {
            manifest.part = existing.part;
            manifest.from = manifest.from.min(existing.from);
            manifest.to = manifest.to.max(existing.to);
        }
        let work = RowMaker::from_manifest(manifest, &place)?;
        let directory = Self { path: path.to_owned(), work, _lock: Some(lock), whole: Mutex::default() };
        directory.write_manifest()?;
        directory.remove_stale_files()?;
        for runs in directory.parts()? {
            directory.open_part(&runs)?;
        }
        Ok(directory)
    }

    /// Creates or continues a directory as [`Directory::create`] does, with these runs alone; `force` removes other parts.
    ///
    /// # Errors
    /// Every error of [`Directory::create`], and a part of this campaign with other runs, without `force`.
    #[expect(clippy::needless_pass_by_value, reason = "one signature with `create`")]
    pub fn create_whole(path: &Path, manifest: Manifest, force: bool) -> Result<Self, DirectoryError> {
        let place = path.join(MANIFEST);
        let runs = manifest.runs();
        let only_these = |existing: &Manifest| {
            let held = existing.runs();
            let is_same = existing.first_difference(&manifest).is_none();
            if force || !is_same || (runs.start <= held.start && held.end <= runs.end) {
                return Ok(());
            }
            let (held, asked) = (held.end - held.start, runs.end - runs.start);
            Err(DirectoryError::More { path: place.clone(), held, asked })
        };
        // Checked before the manifest changes.
        read(&place)?.as_ref().map_or(Ok(()), only_these)?;
        let mut directory = Self::create(path, manifest.clone(), force)?;
        only_these(&directory.work.manifest)?;
        if directory.work.manifest.runs() != runs {
            directory.shrink(runs.clone())?;
        }
        Ok(directory)
    }

    /// Removes a directory that has no parts and no other files than its own; any other one stays.
    ///
    /// # Errors
    /// Another process that is writing the directory, and files that cannot be removed.
    pub fn remove_empty(path: &Path) -> Result<(), DirectoryError> {
        let _lock = lock(path)?;
        if parts(path)?.is_empty() {
            for place in [path.join(MANIFEST), path.join(LOCK)] {
                fs::remove_file(&place).map_err(io_error(&place))?;
            }
            // One that holds other files stays.
            let _ = fs::remove_dir(path.join(RUNS)).and_then(|()| fs::remove_dir(path));
        }
        Ok(())
    }

    /// Removes the parts of all runs but these.
    fn shrink(&mut self, runs: Range<u64>) -> Result<(), DirectoryError> {
        for part in self.parts()?.iter().filter(|part| part.start < runs.start || part.end > runs.end) {
            let file = self.file(part);
            fs::remove_file(&file).map_err(io_error(&file))?;
        }
        (self.work.manifest.from, self.work.manifest.to) = (runs.start, runs.end);
        self.write_manifest()
    }

    fn write_manifest(&self) -> Result<(), DirectoryError> {
        let (place, text) = (self.path.join(MANIFEST), self.work.manifest.to_toml());
        if fs::read(&place).ok().as_deref() == Some(text.as_bytes()) {
            return Ok(());
        }
        atomic_file::write_synced(&place, text.as_bytes()).map_err(io_error(&place))
    }

    /// Whether a process of this machine writes it now.
    pub fn is_at_work(&self) -> bool {
        let file = atomic_file::open(&self.path.join(LOCK));
        file.is_ok_and(|file| matches!(file.try_lock_shared(), Err(TryLockError::WouldBlock)))
    }

    /// Returns the path of the directory.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Returns the row maker of the campaign.
    pub fn work(&self) -> &RowMaker {
        &self.work
    }

    /// Returns the runs of the existing parts, in order.
    pub fn parts(&self) -> Result<Vec<Range<u64>>, DirectoryError> {
        parts(&self.path)
    }

    /// Returns the runs of the missing parts, part by part.
    pub fn missing(&self) -> Result<Vec<Range<u64>>, DirectoryError> {
        self.missing_among(self.work.manifest.runs())
    }

    /// Returns the runs of the missing parts among `runs`, part by part.
    pub fn missing_among(&self, runs: Range<u64>) -> Result<Vec<Range<u64>>, DirectoryError> {
        let gaps = part::remove_present(runs, &self.parts()?);
        Ok(gaps.into_iter().flat_map(|gap| part::split(gap, self.work.manifest.part)).collect())
    }

    /// Computes the runs of a part, and writes it.
    pub fn write_part(
        &self,
        runs: Range<u64>,
        threads: usize,
        poll: impl Record + Clone + Send + Sync + 'static,
    ) -> Result<PathBuf, DirectoryError> {
        let rows = self.work.make_rows(runs.clone(), threads, poll)?;
        self.write(&runs, &rows)
    }

    /// Writes the rows of a part atomically: to a temporary file, synced and then renamed.
    pub fn write(&self, runs: &Range<u64>, rows: &RunRows) -> Result<PathBuf, DirectoryError> {
        let path = self.file(runs);
        let bytes = self.work.encode(rows).map_err(io_error(&path))?;
        atomic_file::write_synced(&path, &bytes).map_err(io_error(&path))?;
        Ok(path)
    }

    /// Returns the path of a part's file.
    pub fn file(&self, runs: &Range<u64>) -> PathBuf {
        self.path.join(RUNS).join(part::file_name(runs))
    }

    /// Opens a part, which must be one of this campaign, and whole.
    pub(super) fn open_part(&self, runs: &Range<u64>) -> Result<ParquetFile, DirectoryError> {
        let path = self.file(runs);
        let file = fs::symlink_metadata(&path).map_err(unreadable(&path))?;
        let (part, file_state) = ((runs.start, runs.end), (file.len(), file.modified().ok()));
        let known = || self.whole.lock().unwrap_or_else(PoisonError::into_inner);
        let is_whole = known().get(&part) == Some(&file_state);
        let reading = ParquetFile::open(&path, is_whole).map_err(damaged(&path))?;
        known().insert(part, file_state);
        if reading.metadata(NOTE).as_deref() != Some(self.work.manifest.hash.as_str()) {
            return Err(invalid_file(&path, format!("is not a part of the campaign of {MANIFEST}")));
        }
        if reading.rows() != runs.end - runs.start {
            return Err(invalid_file(
                &path,
                format!("has {} rows, which does not match its name", reading.rows()),
            ));
        }
        Ok(reading)
    }

    /// Removes partial files of killed processes; those that are being written stay.
    fn remove_stale_files(&self) -> Result<(), DirectoryError> {
        let within = self.path.join(RUNS);
        for entry in fs::read_dir(&within).map_err(io_error(&within))?.flatten() {
            let name = entry.file_name().to_string_lossy().into_owned();
            if let Some(part) = name.strip_suffix(".partial").filter(|name| part::runs_of(name).is_some()) {
                // Creating and dropping a partial file removes a leftover, unless another process has locked it.
                drop(AtomicFile::create(&within.join(part)));
            }
        }
        Ok(())
    }
}

/// Returns the existing manifest, if any.
fn read(place: &Path) -> Result<Option<Manifest>, DirectoryError> {
    match fs::symlink_metadata(place) {
        Err(error) if is_none(&error) => return Ok(None),
        Err(error) => return Err(unreadable(place)(error)),
        Ok(metadata) if !metadata.is_file() || metadata.len() > LARGEST => {
            return Err(invalid_file(place, "is not the manifest of a campaign"));
        }
        Ok(_) => {}
    }
    let text = fs::read_to_string(place).map_err(unreadable(place))?;
    Manifest::parse(&text).map(Some).map_err(|why| invalid_file(place, why))
}

/// Returns the existing manifest, and checks that the new one may replace it.
fn fitting(
    path: &Path,
    place: &Path,
    current: &Manifest,
    force: bool,
) -> Result<Option<Manifest>, DirectoryError> {
    let text = read(place)?;
    if !force {
        statistics_fit(path, text.is_some())?;
    }
    let Some(existing) = text else {
        return match parts(path)?.first().filter(|_| !force) {
            Some(runs) => Err(invalid_file(
                &path.join(RUNS).join(part::file_name(runs)),
                "exists, but its campaign is unknown",
            )),
            None => Ok(None),
        };
    };
    if force {
        return Ok(Some(existing));
    }
    match existing.first_difference(current) {
        Some(difference) => Err(DirectoryError::Other { path: place.to_owned(), difference }),
        None => Ok(Some(existing)),
    }
}

/// Refuses a table of the name of the statistics that no command wrote.
fn statistics_fit(path: &Path, is_campaign: bool) -> Result<(), DirectoryError> {
    let place = path.join(STATISTICS);
    let mut begin = Vec::new();
    match atomic_file::open(&place) {
        Ok(file) => {
            file.take(STATISTICS_BEGIN.len() as u64).read_to_end(&mut begin).map_err(unreadable(&place))?
        }
        Err(error) if is_none(&error) => return Ok(()),
        Err(error) => return Err(unreadable(&place)(error)),
    };
    if !is_campaign {
        return Err(invalid_file(&place, "exists, but its campaign is unknown"));
    }
    if begin != STATISTICS_BEGIN {
        return Err(invalid_file(&place, "exists, and flexsc did not write it"));
    }
    Ok(())
}

/// The directory of the parts within another, which is there or can be made.
fn within(path: &Path) -> Result<PathBuf, DirectoryError> {
    let runs = path.join(RUNS);
    match fs::symlink_metadata(&runs) {
        Ok(metadata) if !metadata.is_dir() => {
            Err(invalid_file(&runs, "is in the way: it is not a directory"))
        }
        _ => Ok(runs),
    }
}

/// A part that cannot be read: it is damaged, and can be made again.
pub(super) fn damaged(path: &Path) -> impl FnOnce(io::Error) -> DirectoryError + '_ {
    |source| match source.kind() {
        io::ErrorKind::InvalidData => invalid_file(path, format!("is damaged ({source}); {AGAIN}")),
        _ => unreadable(path)(source),
    }
}

/// Returns true if the error is that of a file that does not exist.
fn is_none(error: &io::Error) -> bool {
    matches!(error.kind(), io::ErrorKind::NotFound | io::ErrorKind::NotADirectory)
}

fn parts(path: &Path) -> Result<Vec<Range<u64>>, DirectoryError> {
    let mut parts = Vec::new();
    let path = &path.join(RUNS);
    let entries = match fs::read_dir(path) {
        Err(error) if is_none(&error) => return Ok(parts),
        entries => entries.map_err(unreadable(path))?,
    };
    for entry in entries {
        let name = entry.map_err(unreadable(path))?.file_name();
        parts.extend(part::runs_of(&name.to_string_lossy()));
    }
    parts.sort_by_key(|runs| (runs.start, runs.end));
    for (one, next) in parts.iter().zip(parts.iter().skip(1)) {
        if one.end > next.start {
            let why = format!("has runs that are also in {}", part::file_name(one));
            return Err(invalid_file(&path.join(part::file_name(next)), why));
        }
    }
    Ok(parts)
}

fn lock(path: &Path) -> Result<File, DirectoryError> {
    let place = path.join(LOCK);
    let file = atomic_file::open_to_lock(&place).map_err(io_error(&place))?;
    for _ in 0..ATTEMPTS {
        match file.try_lock() {
            Ok(()) => return Ok(file),
            Err(TryLockError::WouldBlock) => thread::sleep(MOMENT),
            Err(TryLockError::Error(error)) => return Err(io_error(&place)(error)),
        }
    }
    Err(DirectoryError::Busy { path: path.to_owned() })
}

#[cfg(all(test, feature = "parquet"))]
#[path = "directory_tests.rs"]
mod tests;
