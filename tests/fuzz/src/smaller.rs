//! Reduction of an input to a smaller one with an equal finding.

use std::io;
use std::path::Path;
use std::time::{Duration, Instant};

use crate::case::Case;
use crate::findings::Found;

/// Time limit for the reduction of one input.
const EFFORT: Duration = Duration::from_secs(20);

/// Returns a smaller input with an equal finding, and true if it has this finding in a process of its own.
pub fn smaller(case: &Case, found: &Found, scratch: &Path) -> io::Result<(Case, bool)> {
    let (began, kept) = (Instant::now(), scratch.with_extension("case"));
    let kind = Found::kind(&found.why);
    let same = |case: &Case| -> io::Result<bool> {
        let _ = std::fs::remove_dir_all(&kept);
        case.save(&kept)?;
        // Without one of its files, an input may no longer run.
        let why = crate::again(&kept, scratch).unwrap_or(None);
        Ok(why.is_some_and(|why| Found::kind(&why) == kind))
    };
    let mut best = case.clone();
    if !same(&best)? {
        return Ok((best, false));
    }
    // An input that takes seconds each time is not reduced.
    let patient = || began.elapsed() < EFFORT;
    for index in (0..best.files.len()).rev() {
        let mut fewer = best.clone();
        fewer.files.remove(index);
        if patient() && fewer.is_live() == best.is_live() && same(&fewer)? {
            best = fewer;
        }
    }
    for index in 0..best.files.len() {
        let mut size = best.files[index].1.len().div_ceil(2);
        while size > 0 && patient() {
            let mut at = 0;
            while at < best.files[index].1.len() && patient() {
                let mut less = best.clone();
                let end = less.files[index].1.len().min(at + size);
                less.files[index].1.drain(at..end);
                if same(&less)? {
                    best = less;
                } else {
                    at = end;
                }
            }
            size = if size == 1 { 0 } else { size.div_ceil(2) };
        }
    }
    Ok((best, true))
}
