//! Printed results (.f06) of Nastran and MYSTRAN: eigenvalues, participation factors, effective masses.
//!
//! Nastran breaks tables into pages, and heads each page of an eigenvalue table with its title, but those of `MEFFMASS`
//! with the headings of the columns alone. A table therefore continues until another text begins.

use std::io::BufRead;

use super::mystran::Reactions;
use super::tables::{ParticipationTable, modes_from_factors, modes_from_masses};
use super::text::{Lines, TextLine};
use super::{FileMass, FileResults, NaturalFrequency, lowest};
use crate::number::real;

const ASK: &str = "ask for `MEFFMASS(ALL) = YES`, in MYSTRAN for `MPFACTOR = ALL`";
const NO_EIGENVALUES: &str =
    "must have a table `R E A L   E I G E N V A L U E S`: run normal modes (SOL 103)";

/// Table to which the current lines belong.
#[derive(Copy, Clone, PartialEq, Eq)]
enum At {
    Elsewhere,
    Eigenvalues,
    Factors,
    Masses,
    /// Forces at the clamp in a mode, as MYSTRAN prints them.
    Reactions,
    /// Matrix whose first number is the mass.
    MassMatrix,
}

/// Eigenvalue table, and its remark about residual vectors.
#[derive(Default)]
struct Eigenvalues {
    remark: Remark,
    rows: Vec<NaturalFrequency>,
}

/// Position of an eigenvalue table relative to the augmentation by residual vectors.
#[derive(Copy, Clone, Default, PartialEq, Eq)]
enum Remark {
    #[default]
    None,
    Before,
    After,
}

struct Reader {
    at: At,
    /// Number of remaining lines in the head of a page.
    head: usize,
    eigenvalues: Vec<Eigenvalues>,
    /// Remark of a title whose table rows have not begun.
    titled: Option<Remark>,
    factors: ParticipationTable,
    masses: ParticipationTable,
    /// True if the factors are those of MYSTRAN.
    mystran: bool,
    /// Mode to which MYSTRAN's current lines belong.
    eigenvector: Option<usize>,
    reactions: Reactions,
    mass: Option<FileMass>,
    /// Rows of a mass matrix that is being read.
    matrix: Vec<[f64; 6]>,
}

/// Reads the modes of a file.
///
/// # Errors
/// The error, with its line.
pub fn read(text: impl BufRead, keep: Option<usize>) -> Result<FileResults, String> {
    let mut reader = Reader {
        at: At::Elsewhere,
        head: 0,
        eigenvalues: Vec::new(),
        titled: None,
        factors: ParticipationTable::new("participation factors"),
        masses: ParticipationTable::new("effective masses"),
        mystran: false,
        eigenvector: None,
        reactions: Reactions::default(),
        mass: None,
        matrix: Vec::new(),
    };
    let mut lines = Lines::new(text);
    while let Some(line) = lines.next()? {
        reader.read_line(&line)?;
    }
    reader.results(keep)
}

impl Reader {
    fn read_line(&mut self, line: &TextLine) -> Result<(), String> {
        let text = &line.text;
        if text.contains("FATAL MESSAGE") || text.trim_start().starts_with("*ERROR") {
            let shown: String = text.trim().chars().take(80).collect();
            return Err(format!("line {}: the run failed: `{shown}`", line.number));
        }
        if is_buckling(text) {
            return Err(format!("line {}: is a buckling analysis: run normal modes (SOL 103)", line.number));
        }
        if text.starts_with('1') && text.contains("PAGE") {
            self.head = 3;
        }
        if self.head > 0 {
            // A page head has a title, a subtitle and a label, which begins with a 0.
            self.head = if text.starts_with('0') { 0 } else { self.head - 1 };
            return Ok(());
        }
        // A digit in the first column controls the printer.
        if text.starts_with(' ') && line.is_row() {
            return self.row(line);
        }
        let line_text = line.without_spaces();
        if let Some(rest) = line_text.strip_prefix("OUTPUTFOREIGENVECTOR") {
            self.eigenvector = rest.parse().ok();
            self.at = At::Elsewhere;
        } else if line_text.starts_with("COMPLEXEIGENVALUE") {
            return Err(format!("line {}: has complex modes: run real normal modes (SOL 103)", line.number));
        } else if let Some(title) = title(&line_text) {
            self.at = title;
            match title {
                At::Eigenvalues => self.titled = Some(remark(&line_text)),
                At::Factors => self.mystran = text.contains("M O D A L"),
                At::MassMatrix => self.matrix.clear(),
                _ => {}
            }
        } else if self.at == At::Eigenvalues && remark(&line_text) != Remark::None {
            self.titled = Some(remark(&line_text));
        } else if self.at == At::MassMatrix {
            self.mass_row(line)?;
        } else if !heading(&line_text) {
            self.at = At::Elsewhere;
        }
        Ok(())
    }

    fn row(&mut self, line: &TextLine) -> Result<(), String> {
        match self.at {
            At::Eigenvalues => self.eigenvalue(line),
            At::Factors => self.factors.take_with_cycles(line),
            At::Masses => self.masses.take_with_cycles(line),
            At::Reactions => match self.eigenvector {
                Some(mode) => self.reactions.read_line(mode, line),
                None => Ok(()),
            },
            At::MassMatrix | At::Elsewhere => Ok(()),
        }
    }

    fn eigenvalue(&mut self, line: &TextLine) -> Result<(), String> {
        let fields = line.fields([
            "MODE",
            "ORDER",
            "EIGENVALUE",
            "RADIANS",
            "CYCLES",
            "GENERALIZED MASS",
            "GENERALIZED STIFFNESS",
        ])?;
        let natural = NaturalFrequency {
            line: line.number,
            mode: fields.whole(0)?,
            frequency: fields.real(3)?,
            generalised_mass: fields.real(5)?,
        };
        fields.real(6)?;
        let natural = natural.checked(fields.real(2)?, fields.real(4)?)?;
        // The title on a further page does not begin a new table.
        let is_continued = self.eigenvalues.last().is_some_and(|table| {
            let rises = table.rows.last().is_some_and(|last| last.mode < natural.mode);
            rises && self.titled.is_none_or(|remark| remark == table.remark)
        });
        let remark = self.titled.take().unwrap_or_default();
        if !is_continued {
            self.eigenvalues.push(Eigenvalues { remark, rows: Vec::new() });
        }
        if let Some(table) = self.eigenvalues.last_mut() {
            table.rows.push(natural);
        }
        Ok(())
    }

    /// Reads a row of a matrix of six rows in stars.
    fn mass_row(&mut self, line: &TextLine) -> Result<(), String> {
        let Some(row) = line.text.trim_start().strip_prefix('*').filter(|row| !row.starts_with('*')) else {
            return Ok(());
        };
        // Stars alone are a line or a column of the frame.
        let is_frame = |word: &&str| word.bytes().all(|byte| byte == b'*');
        let words: Vec<&str> = row.split_whitespace().filter(|word| !is_frame(word)).collect();
        if words.is_empty() {
            return Ok(());
        }
        let mut numbers = [0.0; 6];
        // Of a matrix without six columns, the first row has the mass.
        for (number, word) in numbers.iter_mut().zip(&words) {
            *number = real(word).ok_or_else(|| {
                let shown: String = word.chars().take(40).collect();
                format!("line {}: the mass matrix must have finite numbers, got `{shown}`", line.number)
            })?;
        }
        self.matrix.push(numbers);
        let [x, y, z] = [0, 1, 2].map(|row| self.matrix.get(row).copied().unwrap_or_default());
        let whole = self.matrix.len() == 6;
        if whole || words.len() < 6 {
            self.at = At::Elsewhere;
        }
        // The lower left block of MYSTRAN is empty.
        let diagonal = || std::array::from_fn(|axis| self.matrix[3 + axis][3 + axis]);
        self.mass = Some(FileMass {
            mass: x[0],
            moment: whole.then(|| [y[5], z[3], x[4]]),
            inertia: whole.then(diagonal),
            clamp: None,
        });
        Ok(())
    }

    fn results(mut self, keep: Option<usize>) -> Result<FileResults, String> {
        let natural = self.chosen()?;
        if natural.is_empty() {
            return Err(NO_EIGENVALUES.to_owned());
        }
        let natural = lowest(natural, [&self.factors, &self.masses], keep)?;
        let modes = if self.factors.is_empty() {
            if self.masses.is_empty() {
                return Err(format!("must have modal participation factors: {ASK}"));
            }
            modes_from_masses(&natural, &self.masses, ASK)?
        } else if self.mystran {
            // MYSTRAN's factors are those of the forces on the clamp.
            let modes = modes_from_factors(&natural, &self.factors, &self.masses, -1.0)?;
            self.reactions.confirm(&natural, &modes)?;
            modes
        } else {
            modes_from_factors(&natural, &self.factors, &self.masses, 1.0)?
        };
        Ok(FileResults { modes, mass: self.mass })
    }

    /// Returns the modes of the eigenvalue table: of the one augmented by residual vectors, if there is such a table.
    fn chosen(&mut self) -> Result<Vec<NaturalFrequency>, String> {
        let mut tables = std::mem::take(&mut self.eigenvalues);
        if tables.iter().any(|table| table.remark == Remark::After) {
            tables.retain(|table| table.remark == Remark::After);
        }
        if let [_, second, ..] = &tables[..] {
            let line = second.rows.first().map_or(0, |row| row.line);
            return Err(format!(
                "line {line}: must have one table of eigenvalues, and another begins here: several subcases?"
            ));
        }
        Ok(tables.pop().map(|table| table.rows).unwrap_or_default())
    }
}

/// Returns the table that a title (without blanks) begins, if it is the title of a relevant or similar table.
fn title(line_text: &str) -> Option<At> {
    Some(match line_text {
        "MODALPARTICIPATIONFACTORS" => At::Factors,
        "MODALEFFECTIVEMASS" | "EFFECTIVEMODALMASSESORWEIGHTS" => At::Masses,
        "SPCFORCES" => At::Reactions,
        "A-SETRIGIDBODYMASSMATRIX" => At::MassMatrix,
        "MODALEFFECTIVEMASSFRACTION" | "MODALEFFECTIVEWEIGHT" => At::Elsewhere,
        _ if line_text.starts_with("6x6Rigidbodymassmatrix") => At::MassMatrix,
        _ if line_text.starts_with("REALEIGENVALUES") => At::Eigenvalues,
        _ => return None,
    })
}

/// Returns true if a line of the executive control asks for buckling.
fn is_buckling(text: &str) -> bool {
    let mut words = text.split(|c: char| c.is_whitespace() || c == ',').filter(|word| !word.is_empty());
    words.next() == Some("SOL")
        && words.next().is_some_and(|name| name == "105" || name.to_ascii_uppercase().contains("BUCKL"))
}

fn remark(line_text: &str) -> Remark {
    if line_text.contains("BEFOREAUGMENTATION") {
        Remark::Before
    } else if line_text.contains("AFTERAUGMENTATION") {
        Remark::After
    } else {
        Remark::None
    }
}

/// Returns true if a line may be between the title of a table and its rows, or between rows.
fn heading(line_text: &str) -> bool {
    const BEGINNINGS: [&str; 11] =
        ["MODE", "NO.", "NUM", "ORDER", "MASS", "GRID", "SYS", "(", "Reference", "REFERENCE", "Units"];
    line_text.is_empty() || BEGINNINGS.iter().any(|beginning| line_text.starts_with(beginning))
}
