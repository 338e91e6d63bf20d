//! Merging of parts of one campaign that were made in several directories.

use std::fs;
use std::ops::Range;

use super::directory::{Directory, MANIFEST};
use super::error::{DirectoryError, io_of, unread, wrong};
use super::rows::SECONDS;
use crate::whole;

impl Directory {
    /// Copies the parts of another directory of the campaign, and returns the number of new runs.
    ///
    /// # Errors
    /// Another campaign; runs that both directories have with different rows, or in different parts.
    pub fn take(&self, other: &Self) -> Result<u64, DirectoryError> {
        let (here, there) = (&self.work().manifest, &other.work().manifest);
        if let Some(difference) = there.difference(here) {
            return Err(DirectoryError::Other { path: other.path().join(MANIFEST), difference });
        }
        let own = self.parts()?;
        let theirs = other.parts()?;
        // All parts are checked before anything is written.
        for runs in &theirs {
            let meets = |own: &&Range<u64>| own.start < runs.end && runs.start < own.end;
            match own.iter().find(meets) {
                None => {
                    other.reading(runs)?;
                }
                Some(own) if own == runs => self.same(other, runs)?,
                Some(own) => {
                    let why =
                        format!("has runs that are also in another part of {}", self.file(own).display());
                    return Err(wrong(&other.file(runs), why));
                }
            }
        }
        let mut new = 0;
        for runs in theirs.iter().filter(|runs| !own.contains(runs)) {
            let (from, to) = (other.file(runs), self.file(runs));
            let bytes = fs::read(&from).map_err(unread(&from))?;
            whole::write_synced(&to, &bytes).map_err(io_of(&to))?;
            new += runs.end - runs.start;
        }
        Ok(new)
    }

    /// Checks that a part has the same rows in both directories, except for the times of the runs.
    fn same(&self, other: &Self, runs: &Range<u64>) -> Result<(), DirectoryError> {
        let (own, theirs) = (self.reading(runs)?, other.reading(runs)?);
        let path = other.file(runs);
        let fields = self.work().fields().iter().filter(|field| field.name != SECONDS);
        for field in fields {
            let (own, theirs) = (own.column(&field.name), theirs.column(&field.name));
            if own.map_err(unread(&path))? != theirs.map_err(unread(&path))? {
                let why = format!("has other values of `{}` than {}", field.name, self.path().display());
                return Err(wrong(&path, why));
            }
        }
        Ok(())
    }
}
