//! Atomically written files: each is written under a temporary name, locked by one process, and renamed when complete.

use std::fs::{self, File, OpenOptions, TryLockError};
use std::io::{self, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};
use std::thread;
use std::time::{Duration, Instant};

/// Largest number of attempts: another process may remove a new file in the short time before it is locked.
const ATTEMPTS: u32 = 100;
/// Time for which another process that writes the same file in one go is awaited.
const BUSY_TIMEOUT: Duration = Duration::from_secs(2);

/// File that is being written, under the name of its final path with the suffix `.partial`.
///
/// The temporary file is always created new, so that no existing link, pipe or file is written to, and it is locked
/// while the process lives. The file of a killed process is not locked, and the next process removes it. If the file is
/// dropped before it is [`finish`](Self::finish)ed, it is removed.
#[derive(Debug)]
pub struct AtomicFile {
    file: File,
    temporary: PathBuf,
    place: PathBuf,
    finished: bool,
}

impl AtomicFile {
    /// Creates the temporary file.
    ///
    /// # Errors
    /// [`io::ErrorKind::ResourceBusy`] if another process is writing the file; a path that is not a file, or is
    /// read-only; errors of the file system.
    pub fn create(path: &Path) -> io::Result<Self> {
        let place = place(path)?;
        let mut partial = place.as_os_str().to_owned();
        partial.push(".partial");
        let partial = PathBuf::from(partial);
        for _ in 0..ATTEMPTS {
            if let Some(file) = claim(&partial)? {
                return Ok(Self { file, temporary: partial, place, finished: false });
            }
        }
        Err(busy())
    }

    /// Begins a file at exactly this path: a link is refused, whereas [`create`](Self::create) writes its target.
    pub fn create_unlinked(path: &Path) -> io::Result<Self> {
        unlinked(path)?;
        Self::create(path)
    }

    /// Begins a file; if another process writes it, that one has a moment to finish.
    pub fn create_waiting(path: &Path) -> io::Result<Self> {
        let began = Instant::now();
        loop {
            match Self::create(path) {
                Err(error) if is_busy(&error) && began.elapsed() < BUSY_TIMEOUT => {
                    thread::sleep(Duration::from_millis(5));
                }
                done => return done,
            }
        }
    }

    /// Truncates the file to `bytes`, which needs no disk space.
    pub fn truncate(&self, bytes: u64) -> io::Result<()> {
        self.file.set_len(bytes)
    }

    /// Moves the file to its final path, and returns its size in bytes.
    pub fn finish(mut self) -> io::Result<u64> {
        let bytes = self.file.metadata()?.len();
        fs::rename(&self.temporary, &self.place)?;
        self.finished = true;
        Ok(bytes)
    }

    /// Moves the file to its final path once it is stored on disk, so that it is complete even after a loss of power.
    pub fn finish_synced(self) -> io::Result<u64> {
        self.file.sync_all()?;
        let place = self.place.clone();
        let bytes = self.finish()?;
        sync_directory(&place)?;
        Ok(bytes)
    }

    /// Moves the file to another path in the same directory.
    pub fn finish_at(mut self, path: &Path) -> io::Result<u64> {
        self.place = place(path)?;
        self.finish()
    }
}

impl Write for AtomicFile {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.file.write(bytes)
    }

    fn flush(&mut self) -> io::Result<()> {
        self.file.flush()
    }
}

impl Seek for AtomicFile {
    fn seek(&mut self, to: SeekFrom) -> io::Result<u64> {
        self.file.seek(to)
    }
}

impl Drop for AtomicFile {
    fn drop(&mut self) {
        if !self.finished && is_at(&self.file, &self.temporary) {
            // An error of the removal is less important than the reason for it.
            let _ = fs::remove_file(&self.temporary);
        }
    }
}

/// Stores the entries of a file's directory on disk, if the system supports it.
fn sync_directory(path: &Path) -> io::Result<()> {
    if cfg!(unix) {
        let directory = path.parent().filter(|parent| !parent.as_os_str().is_empty());
        File::open(directory.unwrap_or(Path::new(".")))?.sync_all()?;
    }
    Ok(())
}

/// Writes a file that is on the disk before its name is: an existing file stays until the new one is complete, even if
/// power fails. A link is refused.
pub fn write_synced(path: &Path, bytes: &[u8]) -> io::Result<()> {
    unlinked(path)?;
    let mut partial = AtomicFile::create_waiting(path)?;
    partial.write_all(bytes)?;
    partial.finish_synced().map(|_| ())
}

/// Writes a file: the previous one stays until the new one is complete. A device is written directly, and a read-only
/// file is refused.
pub fn write(path: &Path, bytes: &[u8]) -> io::Result<()> {
    match begin(path, bytes)? {
        Some(partial) => partial.finish().map(|_| ()),
        None => fs::write(path, bytes),
    }
}

/// Writes files that belong together: none is moved to its final path before all are complete, and no other process
/// writes one of them in between. An error is returned with its file.
pub fn write_all(files: &[(PathBuf, Vec<u8>)]) -> Result<(), (PathBuf, io::Error)> {
    let with_path = |path: &PathBuf| {
        let path = path.clone();
        move |error| (path, error)
    };
    let started = files.iter().map(|(path, bytes)| begin(path, bytes).map_err(with_path(path)));
    for (partial, (path, bytes)) in started.collect::<Result<Vec<_>, _>>()?.into_iter().zip(files) {
        match partial {
            Some(partial) => partial.finish().map(|_| ()).map_err(with_path(path))?,
            None => fs::write(path, bytes).map_err(with_path(path))?,
        }
    }
    Ok(())
}

/// Refuses a path that exists and is not a file: a link, a pipe or a directory.
///
/// Directories may be untrusted: their content must not decide where files are written.
pub fn unlinked(path: &Path) -> io::Result<()> {
    match fs::symlink_metadata(path) {
        Ok(entry) if entry.is_file() => Ok(()),
        Ok(entry) if entry.is_dir() => Err(io::ErrorKind::IsADirectory.into()),
        Ok(_) => Err(blocking_file(path)),
        Err(error) if error.kind() == io::ErrorKind::NotFound => Ok(()),
        Err(error) => Err(error),
    }
}

/// Opens a file for reading; refuses links, and pipes, which would block.
///
/// # Errors
/// [`io::ErrorKind::InvalidData`] if it is not a file; errors of the file system.
pub fn open(path: &Path) -> io::Result<File> {
    if fs::symlink_metadata(path)?.is_file() {
        let mut options = OpenOptions::new();
        return itself(options.read(true)).open(path);
    }
    Err(io::Error::new(io::ErrorKind::InvalidData, "is not a file"))
}

/// Opens a file for a lock, and creates it if it is missing; refuses links and pipes.
pub fn open_to_lock(path: &Path) -> io::Result<File> {
    unlinked(path)?;
    let mut options = OpenOptions::new();
    itself(options.create(true).truncate(false).write(true)).open(path)
}

/// Writes the temporary file with all bytes; `None` for a device, which is not written.
fn begin(path: &Path, bytes: &[u8]) -> io::Result<Option<AtomicFile>> {
    if fs::metadata(path).is_ok_and(|entry| !entry.is_file() && !entry.is_dir()) {
        return Ok(None);
    }
    let mut partial = AtomicFile::create_waiting(path)?;
    partial.write_all(bytes)?;
    Ok(Some(partial))
}

/// Returns true if a file could not be written because another process is writing it.
pub fn is_busy(error: &io::Error) -> bool {
    error.kind() == io::ErrorKind::ResourceBusy
}

/// Returns the final path of a file: the target of a link, so that the link is kept.
fn place(path: &Path) -> io::Result<PathBuf> {
    match fs::metadata(path) {
        Ok(entry) if entry.is_dir() => return Err(io::ErrorKind::IsADirectory.into()),
        Ok(entry) if !entry.is_file() => return Err(blocking_file(path)),
        Ok(entry) if entry.permissions().readonly() => return Err(io::ErrorKind::PermissionDenied.into()),
        _ => {}
    }
    Ok(fs::canonicalize(path).unwrap_or_else(|_| path.to_owned()))
}

/// Creates and locks a file; `None` if it existed, after removal of the file of a dead process.
fn claim(partial: &Path) -> io::Result<Option<File>> {
    match OpenOptions::new().write(true).create_new(true).open(partial) {
        Ok(file) => {
            lock(&file)?;
            // Another process may have removed the file as a leftover before it was locked.
            Ok(is_at(&file, partial).then_some(file))
        }
        Err(error) if error.kind() == io::ErrorKind::AlreadyExists => {
            remove_stale(partial)?;
            Ok(None)
        }
        Err(error) => Err(error),
    }
}

fn remove_stale(partial: &Path) -> io::Result<()> {
    let is_missing = |error: &io::Error| error.kind() == io::ErrorKind::NotFound;
    match fs::symlink_metadata(partial) {
        Ok(entry) if entry.is_file() => {}
        Ok(_) => return Err(blocking_file(partial)),
        Err(error) if is_missing(&error) => return Ok(()),
        Err(error) => return Err(error),
    }
    let file = match open_itself(partial) {
        Ok(file) => file,
        Err(error) if is_missing(&error) => return Ok(()),
        Err(error) => return Err(error),
    };
    lock(&file)?;
    if is_at(&file, partial) {
        fs::remove_file(partial)?;
    }
    Ok(())
}

/// Opens an existing file itself, without following a link or blocking on a pipe.
fn open_itself(path: &Path) -> io::Result<File> {
    let mut options = OpenOptions::new();
    itself(options.write(true)).open(path)
}

/// Sets the options to follow no link, and not to wait for the other end of a pipe.
fn itself(options: &mut OpenOptions) -> &mut OpenOptions {
    #[cfg(unix)]
    {
        use rustix::fs::OFlags;
        let flags = (OFlags::NOFOLLOW | OFlags::NONBLOCK).bits().cast_signed();
        std::os::unix::fs::OpenOptionsExt::custom_flags(options, flags);
    }
    options
}

fn lock(file: &File) -> io::Result<()> {
    file.try_lock().map_err(|error| match error {
        TryLockError::WouldBlock => busy(),
        TryLockError::Error(error) => error,
    })
}

/// Returns true if a path refers to this very file.
#[cfg(unix)]
fn is_at(file: &File, path: &Path) -> bool {
    use std::os::unix::fs::MetadataExt;
    let identity = |metadata: fs::Metadata| (metadata.dev(), metadata.ino());
    let entry = fs::symlink_metadata(path).map(identity);
    entry.is_ok_and(|identity_on_disk| file.metadata().is_ok_and(|file| identity(file) == identity_on_disk))
}

#[cfg(not(unix))]
fn is_at(_: &File, path: &Path) -> bool {
    path.exists()
}

fn busy() -> io::Error {
    io::Error::new(io::ErrorKind::ResourceBusy, "another process is writing it")
}

fn blocking_file(path: &Path) -> io::Error {
    let why = format!("{} is in the way: it is not a file that can be replaced", path.display());
    io::Error::new(io::ErrorKind::AlreadyExists, why)
}
