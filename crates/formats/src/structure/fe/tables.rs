//! Tables of a number for each mode and direction, and participations out of them.

use std::ops::{Range, RangeInclusive};

use super::text::{Fields, TextLine};
use super::{FileMode, Natural};

/// Tables with more rows are none of modes.
const MOST_ROWS: usize = 20_000;
/// Numbers that are printed twice agree to this part of them.
const PRINTED: f64 = 1e-5;
/// Effective masses and squares of factors agree to this part of the largest of a mode.
const SQUARED: f64 = 1e-4;
/// What is less, of the largest in its table, is nothing.
const NOTHING: f64 = 1e-8;

/// A row: a mode, and its six numbers in translation and rotation.
#[derive(Clone, Debug)]
pub struct ParticipationRow {
    line: usize,
    mode: usize,
    /// Frequency (Hz), where the row has it.
    cycles: Option<f64>,
    parts: [f64; 6],
}

/// A table of such rows, in rising order of modes.
#[derive(Clone, Debug)]
pub struct ParticipationTable {
    name: &'static str,
    rows: Vec<ParticipationRow>,
}

impl ParticipationTable {
    /// An empty table, and what errors call it.
    pub fn new(name: &'static str) -> Self {
        Self { name, rows: Vec::new() }
    }

    /// Takes a row `mode, Hz, six numbers`.
    ///
    /// # Errors
    /// Fields that are not of this form, and modes that begin again.
    pub fn take_with_cycles(&mut self, line: &TextLine) -> Result<(), String> {
        let fields = line.fields(["mode", "frequency", "T1", "T2", "T3", "R1", "R2", "R3"])?;
        let cycles = Some(fields.real(1)?);
        self.push(line, &fields, cycles, 2)
    }

    /// Takes a row `mode, six numbers`.
    ///
    /// # Errors
    /// Fields that are not of this form, and modes that begin again.
    pub fn take(&mut self, line: &TextLine) -> Result<(), String> {
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

    /// Whether there is no row.
    pub fn is_empty(&self) -> bool {
        self.rows.is_empty()
    }

    /// Whether all its modes are among those with eigenvalues.
    ///
    /// # Errors
    /// One that is not.
    pub fn is_within(&self, modes: &RangeInclusive<usize>) -> Result<(), String> {
        self.rows.iter().find(|row| !modes.contains(&row.mode)).map_or(Ok(()), |row| {
            let (first, last) = (modes.start(), modes.end());
            Err(format!(
                "line {}: must be one of the modes with eigenvalues, {first} to {last}, got mode {}",
                row.line, row.mode
            ))
        })
    }

    /// The row of a mode.
    fn of(&self, natural: &Natural) -> Result<&ParticipationRow, String> {
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

/// The modes, of participation factors and their generalised masses: factors of shapes as they are scaled, the sign of
/// which a program may print the other way round. Effective masses in the file have to be what follows from them.
///
/// # Errors
/// Modes without factors, and tables that contradict each other.
pub fn of_factors(
    natural: &[Natural],
    factors: &ParticipationTable,
    masses: &ParticipationTable,
    sign: f64,
) -> Result<Vec<FileMode>, String> {
    natural
        .iter()
        .map(|natural| {
            let row = factors.of(natural)?;
            if !masses.is_empty() {
                let effective = masses.of(natural)?;
                agree(natural, row, effective)?;
            }
            let scale = sign * f64::sqrt(natural.generalised_mass);
            Ok(natural.with(row.parts.map(|part| scale * part)))
        })
        .collect()
}

/// The modes, of effective masses alone: their signs are lost, which only a mode with one direction has no need of.
///
/// # Errors
/// A mode with two directions, with what to ask the solver for.
pub fn of_masses(
    natural: &[Natural],
    masses: &ParticipationTable,
    ask: &str,
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
            let row = masses.of(natural)?;
            let mut parts = row.parts;
            for (index, part) in parts.iter_mut().enumerate() {
                if part.abs() <= NOTHING * if index < 3 { translation } else { rotation } {
                    *part = 0.0;
                }
            }
            if parts.iter().filter(|part| **part != 0.0).count() > 1 || parts.iter().any(|part| *part < 0.0) {
                return Err(format!(
                    "line {}: must have participation factors beside effective masses, of which mode {} has several \
                     and their signs are lost: {ask}",
                    row.line, natural.mode
                ));
            }
            Ok(natural.with(parts.map(f64::sqrt)))
        })
        .collect()
}

/// Whether effective masses are the squares of the factors, times the generalised mass.
fn agree(natural: &Natural, factors: &ParticipationRow, masses: &ParticipationRow) -> Result<(), String> {
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
