//! Findings: each kind is printed and saved once, and then counted.

use std::collections::BTreeMap;
use std::fmt;
use std::io::{self, Write};
use std::path::PathBuf;

use crate::case::Case;
use crate::say;
use crate::surface::Surface;

/// Finding of an input.
pub struct Found {
    pub surface: Surface,
    pub seed: u64,
    pub number: u64,
    /// First input of the process.
    pub since: u64,
    pub why: String,
}

impl Found {
    /// Returns the common part of findings of one kind: the place of a panic, and words without numbers.
    pub fn kind(why: &str) -> String {
        let place = why.split_once("panicked at ").and_then(|(_, rest)| rest.split_once(": "));
        let text = place.map_or(why, |(place, _)| place.rsplit("/src/").next().unwrap_or(place));
        let mut kind = String::new();
        for c in text.chars().take(80) {
            let c = if c.is_ascii_alphanumeric() { c.to_ascii_lowercase() } else { '-' };
            let digit = place.is_none() && c.is_ascii_digit();
            if !(digit || c == '-' && kind.ends_with('-')) {
                kind.push(c);
            }
        }
        kind.trim_matches('-').to_owned()
    }
}

/// Findings of a surface.
pub struct Findings {
    directory: PathBuf,
    kinds: BTreeMap<String, u64>,
}

impl Findings {
    pub fn new(directory: PathBuf) -> Self {
        Self { directory, kinds: BTreeMap::new() }
    }

    pub fn none(&self) -> bool {
        self.kinds.is_empty()
    }

    /// Counts a finding, and returns true if one of its kind was found before.
    pub fn is_known(&mut self, found: &Found) -> bool {
        let count = self.kinds.entry(Found::kind(&found.why)).or_default();
        *count += 1;
        *count > 1
    }

    /// Prints a finding, and saves its input.
    pub fn report(&self, found: &Found, case: &Case, alone: bool) -> io::Result<()> {
        let kept = self.keep(case, &Found::kind(&found.why))?;
        let surface = crate::name(found.surface);
        let Found { seed, number, since, why, .. } = found;
        say!("finding: {why}\n  input    {} (flexsc {})", kept.display(), case.arguments.join(" "));
        say!("  repeat   cargo run --release -p flexsc-fuzz -- --replay {}", kept.display());
        say!("  made by  --surface {surface} --seed {seed} --case {number}");
        if !alone {
            say!(
                "  it does so only after others: --surface {surface} --seed {seed} --first {since} --jobs 1"
            );
        }
        Ok(())
    }

    /// Saves an input, and returns its path.
    pub fn keep(&self, case: &Case, name: &str) -> io::Result<PathBuf> {
        let place = self.directory.join(name);
        if place.exists() {
            std::fs::remove_dir_all(&place)?;
        }
        case.save(&place)?;
        Ok(place)
    }
}

impl fmt::Display for Findings {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} findings", self.kinds.len())?;
        for (kind, count) in &self.kinds {
            write!(f, "\n  {count:>6} x {kind}")?;
        }
        Ok(())
    }
}
