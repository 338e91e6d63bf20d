//! Tables with one number for each mode and direction, and participations computed from them.

use std::ops::{Range, RangeInclusive};

use super::text::{Fields, TextLine};
use super::{FileMode, NaturalFrequency};

/// Largest number of rows of a table of modes.
const MOST_ROWS: usize = 20_000;
/// Relative tolerance between numbers that are printed twice.
const PRINTED: f64 = 1e-5;
/// Relative tolerance between effective masses and squares of factors, of a mode's largest.
const SQUARED: f64 = 1e-4;
/// Value, relative to the largest in its table, below which a number counts as zero.
const NOTHING: f64 = 1e-8;

/// Row of a table: a mode, and its six numbers in translation and rotation.
#[derive(Clone, Debug)]
pub struct ParticipationRow {
    line: usize,
    mode: usize,
    /// Frequency (Hz), if the row has it.
    cycles: Option<f64>,
    parts: [f64; 6],
}

/// Table of participation rows, in increasing order of modes.
#[derive(Clone, Debug)]
pub struct ParticipationTable {
    name: &'static str,
    rows: Vec<ParticipationRow>,
}

impl ParticipationTable {
    /// Creates an empty table with a name for messages.
    pub fn new(name: &'static str) -> Self {
        Self { name, rows: Vec::new() }
    }

    /// Appends a row `mode, Hz, six numbers`.
    ///
    /// # Errors
    /// Fields that are not of this form, and modes that begin again.
    pub fn take_with_cycles(&mut self, line: &TextLine) -> Result<(), String> {
        let fields = line.fields(["mode", "frequency", "T1", "T2", "T3", "R1", "R2", "R3"])?;
        let cycles = Some(fields.real(1)?);
        self.push(line, &fields, cycles, 2)
    }

    /// Appends a row `mode, six numbers`.
    ///
    /// # Errors
    /// Fields that are not of this form, and modes that begin again.
    pub fn read_line(&mut self, line: &TextLine) -> Result<(), String> {
        let fields = line.fields([
            "MODE NO.",
            "X-COMPONENT",
            "Y-COMPONENT",
            "Z-COMPONENT",
            "X-ROTATION",
            "Y-ROTATION",
            "Z-ROTATION",
        ])?;
        self.push(line, &fields, None, 1)
    }

    fn push<const N: usize>(
        &mut self,
        line: &TextLine,
        fields: &Fields<'_, N>,
        cycles: Option<f64>,
        from: usize,
    ) -> Result<(), String> {
        let (mode, number) = (fields.whole(0)?, line.number);
        if self.rows.last().is_some_and(|last| last.mode >= mode) {
            return Err(format!(
                "line {number}: must have one table of {}, got mode {mode} again: several subcases or steps?",
                self.name
            ));
        }
        if self.rows.len() == MOST_ROWS {
            return Err(format!("line {number}: must have at most {MOST_ROWS} {}", self.name));
        }
        self.rows.push(ParticipationRow { line: number, mode, cycles, parts: fields.six(from)? });
        Ok(())
    }

    /// Returns true if there is no row.
    pub fn is_empty(&self) -> bool {
        self.rows.is_empty()
    }

    /// Checks that all modes of the table are among those with eigenvalues.
    ///
    /// # Errors
    /// A mode without an eigenvalue.
    pub fn is_within(&self, modes: &RangeInclusive<usize>) -> Result<(), String> {
        self.rows.iter().find(|row| !modes.contains(&row.mode)).map_or(Ok(()), |row| {
            let (first, last) = (modes.start(), modes.end());
            Err(format!(
                "line {}: must be one of the modes with eigenvalues, {first} to {last}, got mode {}",
                row.line, row.mode
            ))
        })
    }

    /// Returns the row of a mode, whose frequencies must agree.
    fn find(&self, natural: &NaturalFrequency) -> Result<&ParticipationRow, String> {
        let mode = natural.mode;
        let row = self.rows.iter().find(|row| row.mode == mode).ok_or_else(|| {
            format!(
                "must have mode {mode} of line {} among its {}, which have {} rows: `keep` fewer modes, or is the file cut?",
                natural.line,
                self.name,
                self.rows.len()
            )
        })?;
        let hertz = natural.frequency / (2.0 * std::f64::consts::PI);
        if let Some(cycles) = row.cycles.filter(|cycles| (cycles - hertz).abs() > PRINTED * hertz) {
            return Err(format!(
                "line {}: `frequency` must be that of mode {mode} in line {}, {hertz} Hz, got {cycles}",
                row.line, natural.line
            ));
        }
        Ok(row)
    }
}

/// Computes the modes from participation factors and generalised masses. The factors are those of shapes as the program
/// scales them, multiplied by `sign` for programs that print the opposite. Effective masses in the file must agree with
/// them.
///
/// # Errors
/// Modes without factors, and tables that contradict each other.
pub fn modes_from_factors(
    natural: &[NaturalFrequency],
    factors: &ParticipationTable,
    masses: &ParticipationTable,
    sign: f64,
) -> Result<Vec<FileMode>, String> {
    natural
        .iter()
        .map(|natural| {
            let row = factors.find(natural)?;
            if !masses.is_empty() {
                let effective = masses.find(natural)?;
                agree(natural, row, effective)?;
            }
            let scale = sign * f64::sqrt(natural.generalised_mass);
            Ok(natural.with(row.parts.map(|part| scale * part)))
        })
        .collect()
}

/// Computes the modes from effective masses alone, which have lost the signs: this is unambiguous only for one
/// direction.
///
/// # Errors
/// A mode with two directions, with what to ask the solver for.
pub fn modes_from_masses(
    natural: &[NaturalFrequency],
    masses: &ParticipationTable,
    request: &str,
) -> Result<Vec<FileMode>, String> {
    let largest = |rows: Range<usize>| {
        masses
            .rows
            .iter()
            .flat_map(|row| &row.parts[rows.clone()])
            .fold(0.0, |most: f64, part| most.max(part.abs()))
    };
    let (translation, rotation) = (largest(0..3), largest(3..6));
    natural
        .iter()
        .map(|natural| {
            let row = masses.find(natural)?;
            let mut parts = row.parts;
            for (index, part) in parts.iter_mut().enumerate() {
                if part.abs() <= NOTHING * if index < 3 { translation } else { rotation } {
                    *part = 0.0;
                }
            }
            if parts.iter().filter(|part| **part != 0.0).count() > 1 || parts.iter().any(|part| *part < 0.0) {
                return Err(format!(
                    "line {}: must have participation factors beside effective masses, of which mode {} has several \
                     and their signs are lost: {request}",
                    row.line, natural.mode
                ));
            }
            Ok(natural.with(parts.map(f64::sqrt)))
        })
        .collect()
}

/// Checks that effective masses are the squares of the factors times the generalised mass.
fn agree(
    natural: &NaturalFrequency,
    factors: &ParticipationRow,
    masses: &ParticipationRow,
) -> Result<(), String> {
    const NAMES: [&str; 6] = ["T1", "T2", "T3", "R1", "R2", "R3"];
    for kind in [0..3, 3..6] {
        let most = masses.parts[kind.clone()].iter().fold(0.0, |most: f64, part| most.max(part.abs()));
        for index in kind {
            let (factor, mass) = (factors.parts[index], masses.parts[index]);
            let follows = natural.generalised_mass * factor * factor;
            if (follows - mass).abs() > SQUARED * most {
                return Err(format!(
                    "line {}: `{}` must be the generalised mass times the square of the factor in line {}, {follows}, got {mass}",
                    masses.line, NAMES[index], factors.line
                ));
            }
        }
    }
    Ok(())
}
