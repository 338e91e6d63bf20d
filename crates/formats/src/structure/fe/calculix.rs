//! Tables (.dat) of a frequency step of CalculiX.
//!
//! Participation factors omit the mass that couples clamped and free nodes: their error falls with the third power of
//! the element size at the clamp.

use std::io::BufRead;

use super::tables::{ParticipationTable, modes_from_factors};
use super::text::{Lines, TextLine};
use super::{FileMass, FileResults, NaturalFrequency, lowest};

/// Table to which the current lines belong.
#[derive(Copy, Clone, PartialEq, Eq)]
enum At {
    Elsewhere,
    Eigenvalues,
    Factors,
    Masses,
    TotalMass,
}

/// Reads the modes of a file.
///
/// # Errors
/// The error, with its line.
pub fn read(text: impl BufRead, keep: Option<usize>) -> Result<FileResults, String> {
    let mut section = At::Elsewhere;
    let mut natural: Vec<NaturalFrequency> = Vec::new();
    let mut factors = ParticipationTable::new("participation factors");
    let mut masses = ParticipationTable::new("effective modal masses");
    let mut mass = None;
    let mut lines = Lines::new(text);
    while let Some(line) = lines.next()? {
        if line.is_row() {
            match section {
                At::Eigenvalues => natural.push(eigenvalue(&line, natural.last())?),
                At::Factors => factors.read_line(&line)?,
                At::Masses => masses.read_line(&line)?,
                At::TotalMass | At::Elsewhere => {}
            }
            continue;
        }
        let line_text = line.without_spaces();
        section = match line_text.as_str() {
            "EIGENVALUEOUTPUT" => At::Eigenvalues,
            "PARTICIPATIONFACTORS" => At::Factors,
            "EFFECTIVEMODALMASS" => At::Masses,
            "TOTALEFFECTIVEMASS" => At::TotalMass,
            _ if section == At::TotalMass
                && line_text.starts_with(|c: char| c.is_ascii_digit() || "+-.".contains(c)) =>
            {
                mass = Some(total(&line)?);
                At::Elsewhere
            }
            _ if section == At::Eigenvalues && line_text.starts_with("NODAL") => {
                return Err(format!(
                    "line {}: has modes of cyclic symmetry, whose shapes are those of a sector: take the whole structure",
                    line.number
                ));
            }
            _ if line_text.is_empty()
                || ["MODE", "REAL", "("].iter().any(|head| line_text.starts_with(head)) =>
            {
                section
            }
            _ => At::Elsewhere,
        };
    }
    if natural.is_empty() {
        return Err(
            "must have a table `E I G E N V A L U E   O U T P U T`, which a step `*FREQUENCY` prints"
                .to_owned(),
        );
    }
    let natural = lowest(natural, [&factors, &masses], keep)?;
    if factors.is_empty() {
        return Err(
            "must have a table `P A R T I C I P A T I O N   F A C T O R S`, which a step `*FREQUENCY` prints"
                .to_owned(),
        );
    }
    Ok(FileResults { modes: modes_from_factors(&natural, &factors, &masses, 1.0)?, mass })
}

fn eigenvalue(line: &TextLine, last: Option<&NaturalFrequency>) -> Result<NaturalFrequency, String> {
    // Unsymmetric problems, as with friction, have no column of eigenvalues.
    let is_unsymmetric = line.text.split_whitespace().count() == 4;
    let (mode, frequency, cycles, imaginary, eigenvalue) = if is_unsymmetric {
        let fields = line.fields(["MODE NO", "RAD/TIME", "CYCLES/TIME", "IMAGINARY PART"])?;
        let frequency = fields.real(1)?;
        (fields.whole(0)?, frequency, fields.real(2)?, fields.real(3)?, frequency * frequency)
    } else {
        let fields = line.fields(["MODE NO", "EIGENVALUE", "RAD/TIME", "CYCLES/TIME", "IMAGINARY PART"])?;
        (fields.whole(0)?, fields.real(2)?, fields.real(3)?, fields.real(4)?, fields.real(1)?)
    };
    let number = line.number;
    if last.is_some_and(|last| last.mode >= mode) {
        return Err(format!("line {number}: must have one step `*FREQUENCY`, got mode {mode} again"));
    }
    if imaginary != 0.0 {
        return Err(format!(
            "line {number}: mode {mode} must be one of a clamped structure without damping, got an imaginary part of {imaginary} \
             rad/time: clamp the root, or leave out what makes the modes complex (friction, damping, rotation)"
        ));
    }
    // Shapes are mass-normalised.
    let natural = NaturalFrequency { line: number, mode, frequency, generalised_mass: 1.0 };
    natural.checked(eigenvalue, cycles)
}

/// Returns the mass of the free nodes: the largest of the masses that move along one axis, and the moments of inertia.
fn total(line: &TextLine) -> Result<FileMass, String> {
    let fields =
        line.fields(["X-COMPONENT", "Y-COMPONENT", "Z-COMPONENT", "X-ROTATION", "Y-ROTATION", "Z-ROTATION"])?;
    let [x, y, z, inertia @ ..] = fields.six(0)?;
    Ok(FileMass { mass: x.max(y).max(z), moment: None, inertia: Some(inertia), clamp: None })
}
