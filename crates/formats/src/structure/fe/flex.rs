//! Flexible body of 42: mass, stiffness and damping matrices of its modes, and their integrals, in SI.
//!
//! Headings begin with stars, values end where a `!` begins a comment, and missing elements are 0.

use std::collections::BTreeSet;
use std::io::BufRead;

use nalgebra::DMatrix;

use super::text::{Lines, TextLine};
use super::{FileMode, FileResults, kept};
use crate::structure::eigen;
use crate::structure::eigen_reduced::EigenError;
use crate::structure::mode_table::MOST_MODES;

/// Relative tolerance between angular and linear integrals.
const AGREEMENT: f64 = 1e-4;
/// Relative tolerance of the symmetry of matrices, as printed.
const PRINTED: f64 = 1e-6;
/// Largest coupling of modes by damping, relative to the damping of each mode, that is neglected.
const MODAL: f64 = 0.1;

/// Contents of a section.
#[derive(Copy, Clone, Debug, PartialEq, Eq)]
enum SectionKind {
    Mass,
    Stiffness,
    Damping,
    /// Linear momentum: the integral of phi dm.
    Pf,
    /// Angular momentum: the integral of r x phi dm.
    Hf,
    /// First moments: the integral of phi r' dm.
    L,
}

/// Section that is being read.
struct Section {
    holds: SectionKind,
    /// Number of elements stated in the section.
    count: Option<usize>,
    read_count: usize,
    /// The indices of its elements.
    indices: BTreeSet<[usize; 3]>,
}

struct Reader {
    modes: usize,
    section: Option<Section>,
    mass: DMatrix<f64>,
    stiffness: DMatrix<f64>,
    damping: DMatrix<f64>,
    /// Integrals of phi, r x phi and r phi' (row by row) for each mode.
    integrals: DMatrix<f64>,
    complete: Vec<SectionKind>,
}

/// Reads the modes of a file.
///
/// # Errors
/// The error, with its line.
pub fn read(text: impl BufRead, keep: Option<usize>) -> Result<FileResults, String> {
    let mut lines = Lines::new(text);
    let first = lines.next()?.map(|line| line.without_spaces()).unwrap_or_default();
    if !first.contains("Flex") {
        return Err("line 1: must be the heading of a flexible body of 42".to_owned());
    }
    lines.next()?;
    let count = lines.next()?.ok_or("must have the number of modes in line 3")?;
    let modes = values(&count).fields(["number of modes"])?.whole(0)?;
    if !(1..=MOST_MODES).contains(&modes) {
        return Err(format!("line 3: must have 1 to {MOST_MODES} modes, got {modes}"));
    }
    let square = || DMatrix::zeros(modes, modes);
    let mut reader = Reader {
        modes,
        section: None,
        mass: square(),
        stiffness: square(),
        damping: square(),
        integrals: DMatrix::zeros(modes, 15),
        complete: Vec::new(),
    };
    while let Some(line) = lines.next()? {
        reader.read_line(&line)?;
    }
    reader.close("at its end")?;
    reader.results(keep)
}

/// Returns a line without its comment.
fn values(line: &TextLine) -> TextLine {
    let text = line.text.split('!').next().unwrap_or_default().trim_end().to_owned();
    TextLine { number: line.number, text, ended: line.ended }
}

impl SectionKind {
    /// Returns true if the section has one row for each mode; other sections state their number of elements.
    const fn is_full(self) -> bool {
        matches!(self, Self::Pf | Self::Hf)
    }

    fn from_heading(heading: &str) -> Option<Self> {
        let known = [
            ("MassMatrix", Self::Mass),
            ("StiffnessMatrix", Self::Stiffness),
            ("DampingMatrix", Self::Damping),
            ("LinearMomentumModalIntegral", Self::Pf),
            ("AngularMomentumModalIntegral", Self::Hf),
            ("LinearModalIntegral", Self::L),
        ];
        known.iter().find(|(words, _)| heading.contains(words)).map(|(_, holds)| *holds)
    }
}

impl Reader {
    fn read_line(&mut self, line: &TextLine) -> Result<(), String> {
        let line_text = line.without_spaces();
        if line_text.starts_with('*') || line_text.starts_with("[EOF]") {
            self.close(&format!("before line {}", line.number))?;
            let count = |holds: SectionKind| if holds.is_full() { Some(self.modes) } else { None };
            self.section = SectionKind::from_heading(&line_text).map(|holds| Section {
                holds,
                count: count(holds),
                read_count: 0,
                indices: BTreeSet::new(),
            });
            return Ok(());
        }
        let Some(section) = &mut self.section else { return Ok(()) };
        let line = values(line);
        if line.text.is_empty() {
            return Ok(());
        }
        let Some(count) = section.count else {
            section.count = Some(line.fields(["number of elements"])?.whole(0)?);
            return Ok(());
        };
        if section.read_count == count {
            return Err(format!("line {}: must end after {count} elements", line.number));
        }
        section.read_count += 1;
        let (holds, row) = (section.holds, section.read_count - 1);
        self.element(&line, holds, row)
    }

    fn element(&mut self, line: &TextLine, holds: SectionKind, row: usize) -> Result<(), String> {
        let within = |index: usize, size: usize, name: &str| {
            let found = format!("line {}: `{name}` must be 0 to {}, got {index}", line.number, size - 1);
            if index < size { Ok(index) } else { Err(found) }
        };
        match holds {
            SectionKind::Mass | SectionKind::Stiffness | SectionKind::Damping => {
                let fields = line.fields(["Row", "Col", "Value"])?;
                let place = (
                    within(fields.whole(0)?, self.modes, "Row")?,
                    within(fields.whole(1)?, self.modes, "Col")?,
                );
                self.is_new(line, [place.0, place.1, 0])?;
                let matrix = match holds {
                    SectionKind::Mass => &mut self.mass,
                    SectionKind::Stiffness => &mut self.stiffness,
                    _ => &mut self.damping,
                };
                matrix[place] = fields.real(2)?;
            }
            SectionKind::Pf | SectionKind::Hf => {
                let fields = line.fields(["x", "y", "z"])?;
                let from = if holds == SectionKind::Pf { 0 } else { 3 };
                for axis in 0..3 {
                    self.integrals[(row, from + axis)] = fields.real(axis)?;
                }
            }
            SectionKind::L => {
                let fields = line.fields(["i", "j", "Mode", "Value"])?;
                let (i, j) = (within(fields.whole(0)?, 3, "i")?, within(fields.whole(1)?, 3, "j")?);
                let mode = within(fields.whole(2)?, self.modes, "Mode")?;
                self.is_new(line, [i, j, mode])?;
                // The file has phi r', the result r phi'.
                self.integrals[(mode, 6 + 3 * j + i)] = fields.real(3)?;
            }
        }
        Ok(())
    }

    /// Whether an element is not in its section already.
    fn is_new(&mut self, line: &TextLine, indices: [usize; 3]) -> Result<(), String> {
        if self.section.as_mut().is_none_or(|section| section.indices.insert(indices)) {
            return Ok(());
        }
        Err(format!("line {}: must have each element of its section once, got one again", line.number))
    }

    /// Ends a section.
    fn close(&mut self, place: &str) -> Result<(), String> {
        let Some(Section { holds, count, read_count, .. }) = self.section.take() else { return Ok(()) };
        let Some(count) = count.filter(|count| *count == read_count) else {
            let count = count.map_or_else(|| "a count".to_owned(), |count| format!("{count} elements"));
            return Err(format!(
                "must have {count} in its section {holds:?}, got {read_count} elements {place}"
            ));
        };
        if self.complete.contains(&holds) {
            return Err(format!("must have its section {holds:?} once, and another ends {place}"));
        }
        if holds == SectionKind::Mass && count == 0 {
            return Err(format!("must have a mass matrix, got no elements {place}"));
        }
        self.complete.push(holds);
        Ok(())
    }

    fn results(self, keep: Option<usize>) -> Result<FileResults, String> {
        let needed = [
            SectionKind::Mass,
            SectionKind::Stiffness,
            SectionKind::Damping,
            SectionKind::Pf,
            SectionKind::Hf,
            SectionKind::L,
        ];
        if let Some(holds) = needed.iter().find(|holds| !self.complete.contains(holds)) {
            return Err(format!("must have a section {holds:?}: is the file cut?"));
        }
        for (name, matrix) in
            [("mass", &self.mass), ("stiffness", &self.stiffness), ("damping", &self.damping)]
        {
            if (matrix - matrix.transpose()).amax() > PRINTED * matrix.amax() {
                return Err(format!("must have a symmetric {name} matrix"));
            }
        }
        let (modes, count) = (self.modes, kept(self.modes, keep)?);
        let integrals = self.integrals()?;
        let knows_moments = integrals.columns(6, 9).amax() > 0.0;
        let mut functionals = DMatrix::zeros(modes, modes + 15);
        functionals.columns_mut(0, modes).fill_with_identity();
        functionals.columns_mut(modes, 15).copy_from(&integrals);
        let solved = eigen::modes(self.stiffness, self.mass, &functionals).map_err(unsolved)?;
        let shapes = solved.values.columns(0, modes);
        let damping = shapes * &self.damping * shapes.transpose();
        let modal = is_modal(&damping);
        let mode = |index: usize| {
            let frequency = solved.frequencies[index];
            let three = |from: usize| std::array::from_fn(|axis| solved.values[(index, modes + from + axis)]);
            FileMode {
                frequency,
                translation: three(0),
                rotation: three(3),
                moments: knows_moments.then(|| [three(6), three(9), three(12)]),
                damping: modal.then(|| damping[(index, index)] / (2.0 * frequency)),
                shapes: Vec::new(),
            }
        };
        Ok(FileResults { modes: (0..count).map(mode).collect(), mass: None })
    }

    /// Returns the integrals, with rotations computed from the first moments if those are given.
    fn integrals(&self) -> Result<DMatrix<f64>, String> {
        let mut integrals = self.integrals.clone();
        if integrals.columns(0, 3).amax() == 0.0 {
            return Err("must have participations, and its section Pf is all 0: its modes are free, or their integrals \
                        were not computed"
                .to_owned());
        }
        let knows_rotations = integrals.columns(3, 3).amax() > 0.0;
        let largest = integrals.columns(6, 9).amax();
        if !knows_rotations && largest == 0.0 {
            return Err(
                "must have participations in rotation, and its sections Hf and L are all 0".to_owned()
            );
        }
        if largest == 0.0 {
            return Ok(integrals);
        }
        for mode in 0..self.modes {
            let n = |row: usize, column: usize| self.integrals[(mode, 6 + 3 * row + column)];
            let follows = [n(1, 2) - n(2, 1), n(2, 0) - n(0, 2), n(0, 1) - n(1, 0)];
            for (axis, follows) in follows.into_iter().enumerate() {
                let value = self.integrals[(mode, 3 + axis)];
                if knows_rotations && (value - follows).abs() > AGREEMENT * largest {
                    return Err(format!(
                        "must have the same rotation of mode {mode} about axis {axis} in Hf, {value}, and from L, {follows}"
                    ));
                }
                integrals[(mode, 3 + axis)] = follows;
            }
        }
        Ok(integrals)
    }
}

/// Returns true if a modal damping matrix is not zero and has negligible coupling of modes.
fn is_modal(damping: &DMatrix<f64>) -> bool {
    let order = damping.nrows();
    let coupled = |i: usize, j: usize| {
        damping[(i, j)].abs() > MODAL * f64::sqrt((damping[(i, i)] * damping[(j, j)]).abs())
    };
    damping.amax() > 0.0 && !(0..order).any(|i| (0..i).any(|j| coupled(i, j)))
}

fn unsolved(why: EigenError) -> String {
    match why {
        EigenError::Mass => "must have a positive definite mass matrix".to_owned(),
        EigenError::Stiffness => {
            "must have a positive definite stiffness matrix: are its modes clamped?".to_owned()
        }
        EigenError::Range => crate::structure::TOO_FAR_APART.to_owned(),
        #[cfg(not(feature = "matrices"))]
        EigenError::LeftOut => {
            let (most, why) = (eigen::SMALL, crate::structure::unavailable::LEFT_OUT);
            format!("has coupled modes: more than {most} {why}")
        }
    }
}
