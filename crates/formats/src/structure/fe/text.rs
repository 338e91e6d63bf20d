//! Lines of a text file, and the numbers in their fields.

use std::io::{BufRead, Read};
use std::ops::Range;

use crate::number::real;

/// Largest length of a line (bytes): files with longer lines are not text.
const LONGEST: usize = 4096;

/// Line of a text file.
#[derive(Debug)]
pub struct TextLine {
    /// Line number, from 1.
    pub number: usize,
    /// Text of the line, without its end and trailing blanks.
    pub text: String,
    /// True if the line has an end: the last line of a truncated file has none.
    pub ended: bool,
}

/// Reader of the lines of a file, one at a time.
pub struct Lines<R> {
    text: R,
    number: usize,
    bytes: Vec<u8>,
}

impl<R: BufRead> Lines<R> {
    /// Creates a reader of the lines of a text.
    pub fn new(text: R) -> Self {
        Self { text, number: 0, bytes: Vec::new() }
    }

    /// Returns the next line; `None` at the end.
    ///
    /// # Errors
    /// A line that cannot be read, or is too long.
    pub fn next(&mut self) -> Result<Option<TextLine>, String> {
        self.number += 1;
        let number = self.number;
        self.bytes.clear();
        let most = u64::try_from(LONGEST).unwrap_or(u64::MAX);
        let read = self.text.by_ref().take(most).read_until(b'\n', &mut self.bytes);
        if read.map_err(|error| format!("line {number}: {error}"))? == 0 {
            return Ok(None);
        }
        let ended = self.bytes.last() == Some(&b'\n');
        if !ended && self.bytes.len() >= LONGEST {
            return Err(format!("line {number}: must be shorter than {LONGEST} bytes: is this a text file?"));
        }
        // Titles may be in any encoding; the data that is read is ASCII.
        let text = String::from_utf8_lossy(&self.bytes).trim_end().to_owned();
        Ok(Some(TextLine { number, text, ended }))
    }
}

impl TextLine {
    /// Returns the line without white space: solvers print titles as `D I S P L A C E M E N T`.
    pub fn without_spaces(&self) -> String {
        self.text.chars().filter(|c| !c.is_whitespace()).collect()
    }

    /// Returns true if the line begins with a whole number after blanks, as the rows of tables do.
    pub fn is_row(&self) -> bool {
        self.text.split_whitespace().next().is_some_and(|word| word.bytes().all(|byte| byte.is_ascii_digit()))
    }

    /// Returns the fields of the line, which must be as many as `names`.
    ///
    /// # Errors
    /// Another number of fields, or a line without end.
    pub fn fields<const N: usize>(&self, names: [&'static str; N]) -> Result<Fields<'_, N>, String> {
        let number = self.number;
        if !self.ended {
            return Err(format!("line {number}: must have an end: the file was cut here"));
        }
        let words: Vec<&str> = self.text.split_whitespace().collect();
        let words = <[&str; N]>::try_from(words).map_err(|words| {
            format!("line {number}: must have {N} fields ({}), got {}", names.join(", "), words.len())
        })?;
        Ok(Fields { number, names, words })
    }
}

/// Text in fixed columns of a line.
pub struct TextColumn<'a> {
    number: usize,
    name: &'static str,
    word: &'a str,
}

impl TextLine {
    /// Returns the text between two columns, without surrounding blanks; columns count from 0.
    ///
    /// # Errors
    /// A line that ends before the columns.
    pub fn column(&self, columns: Range<usize>, name: &'static str) -> Result<TextColumn<'_>, String> {
        let number = self.number;
        let word = self.text.get(columns.clone()).filter(|_| self.ended).ok_or_else(|| {
            format!("line {number}: must have `{name}` in columns {} to {}", columns.start + 1, columns.end)
        })?;
        Ok(TextColumn { number, name, word: word.trim() })
    }
}

impl TextColumn<'_> {
    /// Parses the text as a number.
    ///
    /// # Errors
    /// A text that is not a finite number.
    pub fn real(&self) -> Result<f64, String> {
        real(self.word).ok_or_else(|| self.wrong("a finite number"))
    }

    /// Parses the text as a whole number of 0 or more.
    ///
    /// # Errors
    /// A text that is not a whole number.
    pub fn whole(&self) -> Result<usize, String> {
        self.word.parse().map_err(|_| self.wrong("a whole number"))
    }

    fn wrong(&self, expected: &str) -> String {
        format!("line {}: `{}` must be {expected}, got `{}`", self.number, self.name, self.word)
    }
}

/// Fields of a row.
pub struct Fields<'a, const N: usize> {
    number: usize,
    names: [&'static str; N],
    words: [&'a str; N],
}

impl<const N: usize> Fields<'_, N> {
    /// Parses a field as a number.
    ///
    /// # Errors
    /// A field that is not a finite number.
    pub fn real(&self, field: usize) -> Result<f64, String> {
        real(self.words[field]).ok_or_else(|| self.wrong(field, "a finite number"))
    }

    /// Parses a field as a whole number of 0 or more.
    ///
    /// # Errors
    /// A field that is not a whole number.
    pub fn whole(&self, field: usize) -> Result<usize, String> {
        self.words[field].parse().map_err(|_| self.wrong(field, "a whole number"))
    }

    /// Parses six fields from index `from` on as numbers.
    ///
    /// # Errors
    /// A field that is not a finite number.
    pub fn six(&self, from: usize) -> Result<[f64; 6], String> {
        let mut six = [0.0; 6];
        for (index, part) in six.iter_mut().enumerate() {
            *part = self.real(from + index)?;
        }
        Ok(six)
    }

    fn wrong(&self, field: usize, expected: &str) -> String {
        let shown: String = self.words[field].chars().take(40).collect();
        format!("line {}: `{}` must be {expected}, got `{shown}`", self.number, self.names[field])
    }
}
