//! Lines of C: indentation, and breaks of long lines.

use std::fmt::{Arguments, Write as _};

/// Greatest length of a line.
const WIDTH: usize = 110;

/// Lines of a function's body.
#[derive(Debug, Default)]
pub(super) struct CodeWriter {
    lines: Vec<String>,
    level: usize,
}

impl CodeWriter {
    /// Starts at a level of indentation.
    pub(super) fn new(level: usize) -> Self {
        Self { lines: Vec::new(), level }
    }

    /// Writes a line of code, broken if it is long.
    pub(super) fn line(&mut self, text: &str) {
        let space = " ".repeat(4 * self.level);
        let mut rest = format!("{space}{text}");
        let further = " ".repeat(4 * self.level + 8);
        while rest.chars().count() > WIDTH {
            let Some(at) =
                break_of(&rest, if rest.starts_with(&further) { further.len() } else { space.len() })
            else {
                break;
            };
            let next = rest.split_off(at);
            self.lines.push(rest.trim_end().to_owned());
            rest = format!("{further}{}", next.trim_start());
        }
        self.lines.push(rest);
    }

    /// Writes lines that are laid out already.
    pub(super) fn verbatim(&mut self, text: &str) {
        self.lines.extend(text.lines().map(str::to_owned));
    }

    /// Writes a blank line, unless a block has just been opened.
    pub(super) fn blank(&mut self) {
        if self
            .lines
            .last()
            .is_some_and(|line| !line.is_empty() && !line.ends_with('{') && !line.ends_with(':'))
        {
            self.lines.push(String::new());
        }
    }

    /// Appends words to a line.
    pub(super) fn append_at(&mut self, at: usize, text: &str) {
        if let Some(line) = self.lines.get_mut(at) {
            line.push_str(text);
        }
    }

    /// Indents what follows.
    pub(super) fn indent(&mut self) {
        self.level += 1;
    }

    /// Ends an indented part.
    pub(super) fn outdent(&mut self) {
        self.level -= 1;
    }

    /// Returns the level of indentation.
    pub(super) fn level(&self) -> usize {
        self.level
    }

    /// Returns the number of lines.
    pub(super) fn len(&self) -> usize {
        self.lines.len()
    }

    /// Inserts a line before another one.
    pub(super) fn insert(&mut self, at: usize, text: &str) {
        self.lines.insert(at, format!("{}{text}", " ".repeat(4 * self.level)));
    }

    /// Returns the last line without its indentation.
    pub(super) fn last(&self) -> &str {
        self.lines.last().map_or("", |line| line.trim())
    }

    /// Returns the lines as a text.
    pub(super) fn text(&self) -> String {
        self.lines.iter().flat_map(|line| [line.as_str(), "\n"]).collect()
    }
}

/// Returns the place to break a line: outside the most brackets, before an operator or after a comma, as late as possible.
fn break_of(line: &str, start: usize) -> Option<usize> {
    let bytes = line.as_bytes();
    let mut depth = 0_usize;
    let mut is_comment = false;
    let mut best: Option<(usize, usize)> = None;
    for at in start..bytes.len() {
        if at > WIDTH {
            break;
        }
        let rest = &line.as_bytes()[at..];
        if rest.starts_with(b"/*") {
            is_comment = true;
        } else if rest.starts_with(b"*/") {
            is_comment = false;
        }
        if is_comment {
            continue;
        }
        match bytes[at] {
            b'(' | b'{' | b'[' => depth += 1,
            b')' | b'}' | b']' => depth = depth.saturating_sub(1),
            _ => {}
        }
        let starts = |signs: &[&str]| signs.iter().any(|sign| rest.starts_with(sign.as_bytes()));
        let after_comma = at > 0 && bytes[at - 1] == b',' && bytes[at] == b' ';
        let after_assignment = at > 1 && &bytes[at - 2..=at] == b" = " && depth == 0;
        // The weaker an operator binds, the better a line is broken before it.
        let strength = if after_comma || starts(&[" && ", " || "]) {
            0
        } else if after_assignment {
            2
        } else if starts(&[" + ", " - ", " | ", " & "]) {
            1
        } else if starts(&[" * "]) {
            3
        } else {
            continue;
        };
        let cost = 4 * depth + strength;
        let is_far = at > start + 24;
        if is_far && best.is_none_or(|(least, _)| cost <= least) {
            best = Some((cost, at));
        }
    }
    best.map(|(_, at)| at)
}

/// Appends formatted words to a text, which cannot fail.
pub(super) fn push(text: &mut String, words: Arguments<'_>) {
    text.write_fmt(words).unwrap_or_default();
}
