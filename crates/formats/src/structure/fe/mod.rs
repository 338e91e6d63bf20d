//! Clamped modes from the results of finite-element programs: Nastran, MYSTRAN, CalculiX, and files of 42.
//!
//! Modes are about the reference point of the file's participations, in its axes, and mass-normalised.

mod calculix;
mod craig_bampton;
mod deck;
mod element;
mod f06;
mod flex;
mod frd;
mod integrals;
mod mystran;
#[cfg(test)]
mod shape_tests;
mod tables;
#[cfg(test)]
mod tests;
mod text;

use std::path::Path;

use super::mode_table::MOST_MODES;
use crate::text_file::open_text_up_to;
pub use craig_bampton::craig_bampton_modes;
use tables::ParticipationTable;

/// Largest size of a file (bytes): larger ones contain shapes or stresses of thousands of nodes, which are not used.
const LONGEST: u64 = 64 << 20;
/// Ratio of a frequency to the next below which the mode does not belong to a clamped structure.
const MECHANISM: f64 = 1e-3;
/// Relative tolerance between a printed frequency and its square.
const PRINTED: f64 = 1e-5;

/// Format of results.
#[derive(Copy, Clone, Debug, PartialEq, Eq)]
pub enum ResultFormat {
    /// Printed results of Nastran or MYSTRAN.
    F06,
    /// Tables of CalculiX.
    CalculiX,
    /// Shapes of CalculiX, with the deck in the same directory.
    Frd,
    /// Flexible body of 42.
    Flex,
}

/// Mode of a clamped structure, in the file's units.
#[derive(Clone, Debug, PartialEq)]
pub struct FileMode {
    /// Natural frequency (rad/s).
    pub frequency: f64,
    /// Integral of phi dm (sqrt(mass)).
    pub translation: [f64; 3],
    /// Integral of r x phi dm (sqrt(mass) length).
    pub rotation: [f64; 3],
    /// Integral of r phi' dm (sqrt(mass) length), row by row, if the file has it.
    pub moments: Option<[[f64; 3]; 3]>,
    /// Damping ratio, if the file has it.
    pub damping: Option<f64>,
    /// Displacement (1/sqrt(mass)) and rotation (1/(sqrt(mass) length)) at each requested point, if the file has
    /// shapes.
    pub shapes: Vec<[[f64; 3]; 2]>,
}

/// Point of a structure, in the file's axes and units.
#[derive(Clone, Debug, PartialEq)]
pub struct StructurePoint {
    /// Name for messages.
    pub name: String,
    /// Position of the point.
    pub at: [f64; 3],
}

/// Modes and mass read from a file.
#[derive(Clone, Debug, PartialEq)]
pub struct FileResults {
    /// Modes with the lowest frequencies, increasing.
    pub modes: Vec<FileMode>,
    /// Mass of the structure, if the file has it.
    pub mass: Option<FileMass>,
}

/// Mass of a structure in the file's units, about the point to which its participations refer: of the free nodes, or of all.
#[derive(Copy, Clone, Debug, PartialEq)]
pub struct FileMass {
    /// Mass.
    pub mass: f64,
    /// Integral of r dm, if the file has it.
    pub moment: Option<[f64; 3]>,
    /// Moments of inertia about the three axes, if the file has them.
    pub inertia: Option<[f64; 3]>,
    /// Least and greatest coordinates of the nodes at rest, if the file has shapes.
    pub clamp: Option<[[f64; 3]; 2]>,
}

impl ResultFormat {
    /// Returns the format of a file by its extension.
    pub fn from_path(path: &Path) -> Option<Self> {
        match path.extension()?.to_ascii_lowercase().to_str()? {
            "f06" => Some(Self::F06),
            "dat" => Some(Self::CalculiX),
            "frd" => Some(Self::Frd),
            "flex" | "txt" => Some(Self::Flex),
            _ => None,
        }
    }

    /// Returns true if the format contains shapes, which can be evaluated at points.
    pub const fn has_shapes(self) -> bool {
        matches!(self, Self::Frd)
    }

    /// Reads the `keep` lowest modes of a file (all for `None`), with their shapes at `points`. If the file has the mesh, and its
    /// centre of mass is not at `centre`, they are about the point of the clamp from which it is.
    ///
    /// # Errors
    /// The error, with its line.
    pub fn read(
        self,
        path: &Path,
        keep: Option<usize>,
        points: &[StructurePoint],
        centre: Option<[f64; 3]>,
    ) -> Result<FileResults, String> {
        let text = open_text_up_to(path, LONGEST)?;
        match self {
            Self::F06 => f06::read(text, keep),
            Self::CalculiX => calculix::read(text, keep),
            Self::Flex => flex::read(text, keep),
            Self::Frd => {
                // CalculiX gives results the name of their deck.
                let deck = path.with_extension("inp");
                let reported = |why: String| format!("the deck {}: {why}", deck.display());
                let directory = path.parent().unwrap_or(Path::new("."));
                let deck = deck::read(open_text_up_to(&deck, LONGEST).map_err(reported)?, directory)
                    .map_err(reported)?;
                integrals::modes(frd::read(text, &deck.massless)?, &deck, keep, points, centre)
            }
        }
    }
}

/// Natural frequency in a file's table of eigenvalues.
#[derive(Clone, Debug)]
struct NaturalFrequency {
    line: usize,
    mode: usize,
    /// Natural frequency (rad/s).
    frequency: f64,
    generalised_mass: f64,
}

impl NaturalFrequency {
    /// Returns the mode with the given participations.
    fn with(&self, [a, b, c, d, e, f]: [f64; 6]) -> FileMode {
        let (translation, rotation) = ([a, b, c], [d, e, f]);
        FileMode {
            frequency: self.frequency,
            translation,
            rotation,
            moments: None,
            damping: None,
            shapes: Vec::new(),
        }
    }

    /// Checks that eigenvalue, rad/s and Hz of the row agree.
    fn checked(self, eigenvalue: f64, cycles: f64) -> Result<Self, String> {
        let Self { line, mode, frequency, generalised_mass } = self;
        if eigenvalue <= 0.0 || frequency <= 0.0 {
            return Err(format!(
                "line {line}: the eigenvalue of mode {mode} must be positive, got {eigenvalue}: is the root clamped?"
            ));
        }
        if generalised_mass <= 0.0 {
            return Err(format!(
                "line {line}: the generalised mass of mode {mode} must be positive, got {generalised_mass}"
            ));
        }
        let agrees = |other: f64| (other - frequency).abs() <= PRINTED * frequency;
        if !agrees(f64::sqrt(eigenvalue)) || !agrees(2.0 * std::f64::consts::PI * cycles) {
            return Err(format!(
                "line {line}: mode {mode} must have one frequency, got an eigenvalue of {eigenvalue}, {frequency} rad/s and {cycles} Hz"
            ));
        }
        Ok(self)
    }
}

/// Returns the modes with the lowest frequencies, increasing; checks that other tables name only modes of this list.
fn lowest(
    mut natural: Vec<NaturalFrequency>,
    tables: [&ParticipationTable; 2],
    keep: Option<usize>,
) -> Result<Vec<NaturalFrequency>, String> {
    if let Some(pair) = natural.windows(2).find(|pair| pair[1].mode != pair[0].mode + 1) {
        let (line, expected, found) = (pair[1].line, pair[0].mode + 1, pair[1].mode);
        return Err(format!("line {line}: must be mode {expected}, got mode {found}"));
    }
    let modes = natural.first().map_or(0, |first| first.mode)..=natural.last().map_or(0, |last| last.mode);
    tables.iter().try_for_each(|table| table.is_within(&modes))?;
    natural.sort_by(|a, b| a.frequency.total_cmp(&b.frequency));
    // Residual vectors may follow the modes that are kept.
    let count = kept(natural.len(), keep)?;
    let pairs = natural.windows(2).take(count.saturating_sub(1).max(1));
    if let Some(pair) = pairs.into_iter().find(|pair| pair[0].frequency < MECHANISM * pair[1].frequency) {
        return Err(format!(
            "line {}: mode {} at {} rad/s is none of a clamped structure, as the next is at {} rad/s: clamp the root, \
             or look for a mechanism",
            pair[0].line, pair[0].mode, pair[0].frequency, pair[1].frequency
        ));
    }
    natural.truncate(count);
    Ok(natural)
}

/// Returns the number of modes to keep of the modes of a file.
fn kept(available: usize, keep: Option<usize>) -> Result<usize, String> {
    match keep {
        None if available > MOST_MODES => {
            Err(format!("has {available} modes: `keep` must say how many, at most {MOST_MODES}"))
        }
        Some(keep) if keep > available => Err(format!("has {available} modes, and `keep` asks for {keep}")),
        keep => Ok(keep.unwrap_or(available)),
    }
}
