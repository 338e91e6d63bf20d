//! Tests of the pages of the documentation: their numbers must be the results of the commands beside
//! them.
//!
//! A page names its commands and marks its numbers in comments, which are invisible to readers:
//! - a comment of its own, `<!--{% set quiet = run("simulate scenarios/relay-quiet.toml") %}-->`, names a command's
//!   output ([`super::command_output`]);
//! - `0.34<!--{{ quiet.gain_final }}-->` is a number of the text, which must be the value rounded to its digits; such a
//!   comment must not contain `--`, and in the cell of a table a `|` is written `\|`;
//! - `<!--below 0.34 {{ quiet.gain_final }}-->`, on a line of its own, is such a number in the block that follows,
//!   where a comment would be visible;
//! - the text between a comment that begins with `made` and `<!--end-->` must equal the value of the rest of the
//!   comment.
//!
//! A page without marks is not tested, since the expected numbers are unknown.

use std::fmt::Write as _;
use std::sync::{Arc, LazyLock};

use flexsc_papers::Computed;
use flexsc_papers::page::{environment, explained};

use super::command_runner::CommandRunner;

/// Cache of the computed results, for all pages.
static COMPUTED: LazyLock<Arc<Computed>> = LazyLock::new(|| Arc::new(Computed::new(CommandRunner, |_| {})));

/// Separator between the values of marks and the empty lines between them.
const PARTING: char = '\u{1}';

/// Mark that has a value.
struct NumberMark<'a> {
    /// Line number of the mark on the page.
    line: usize,
    /// Template of the mark's value.
    template: String,
    /// Text of the page that must equal the value.
    printed: PrintedNumber<'a>,
}

enum PrintedNumber<'a> {
    /// Number before the mark.
    Number(&'a str),
    /// Number that must occur in the block.
    Within(&'a str, &'a str),
    /// Whole text.
    Text(&'a str),
}

/// Returns the errors in the numbers of a page.
fn faults(page: &str) -> Result<Vec<String>, String> {
    let (mut template, mut marks) = (String::new(), Vec::new());
    let mut rest = page;
    while let Some((before, after)) = rest.split_once("<!--") {
        let line = 1 + page[..page.len() - after.len()].matches('\n').count();
        let (comment, follows) =
            after.split_once("-->").ok_or_else(|| format!("line {line}: a comment without end"))?;
        let ahead = &page[..page.len() - after.len() - 4];
        let inline = !ahead.is_empty() && !ahead.ends_with('\n');
        // The template has the same lines as the page, so that errors have the page's line numbers.
        template.extend(before.chars().filter(|c| *c == '\n'));
        rest = follows;
        let mark =
            |template: &str, printed| NumberMark { line, template: template.replace("\\|", "|"), printed };
        let mark = if let Some(made) = comment.strip_prefix("made") {
            let (text, after) =
                follows.split_once("<!--end-->").ok_or_else(|| format!("line {line}: `made` without end"))?;
            rest = after;
            Some(mark(made, PrintedNumber::Text(text)))
        } else if let Some(below) = comment.strip_prefix("below ") {
            let (number, value) = below.split_once(' ').ok_or_else(|| format!("line {line}: no value"))?;
            // The marks of a block precede it together.
            let block = skip_comments(follows.trim_start_matches('\n'));
            let end = match block.strip_prefix("```") {
                Some(code) => code.find("```").map_or(block.len(), |end| end + 3),
                None => block.find("\n\n").unwrap_or(block.len()),
            };
            Some(mark(value, PrintedNumber::Within(number, &block[..end])))
        } else if comment.starts_with("{{") {
            if inline && comment.contains("--") {
                return Err(format!("line {line}: `--` ends a comment in some readers"));
            }
            Some(mark(comment, PrintedNumber::Number(number_at_end(ahead))))
        } else {
            if comment.starts_with("{%") {
                template.push_str(comment);
            }
            None
        };
        if let Some(mark) = mark {
            write!(template, "{PARTING}{}{PARTING}", mark.template).map_err(|error| error.to_string())?;
            marks.push(mark);
        }
        let passed = &page[page.len() - follows.len()..page.len() - rest.len()];
        template.extend(passed.chars().filter(|c| *c == '\n'));
    }
    let environment = environment(&COMPUTED)?;
    let filled = environment.render_str(&template, ()).map_err(|error| explained(&error))?;
    let values = filled.split(PARTING).skip(1).step_by(2);
    Ok(marks.iter().zip(values).filter_map(|(mark, value)| mark.fault(value)).collect())
}

/// Returns a text without its leading comments.
fn skip_comments(mut text: &str) -> &str {
    while let Some((_, after)) = text.strip_prefix("<!--").and_then(|text| text.split_once("-->")) {
        text = after.trim_start_matches('\n');
    }
    text
}

/// Returns the number at the end of a text.
fn number_at_end(text: &str) -> &str {
    let part = |c: char| c.is_ascii_digit() || matches!(c, '.' | '+' | '-' | 'e');
    let digits = text.trim_end_matches(part);
    text[digits.len()..].trim_start_matches(['.', 'e'])
}

impl NumberMark<'_> {
    /// Returns an error if the printed text differs from the value.
    fn fault(&self, value: &str) -> Option<String> {
        let (line, template) = (self.line, self.template.trim());
        match self.printed {
            PrintedNumber::Text(text) if text.trim() == value.trim() => None,
            PrintedNumber::Text(text) => {
                let mut pairs = text.trim().lines().zip(value.trim().lines());
                let (printed, should) =
                    pairs.find(|(a, b)| a != b).unwrap_or(("", "another number of lines"));
                Some(format!("line {line}: made `{printed}` should be `{should}`"))
            }
            PrintedNumber::Within(number, block) if !has_number(block, number) => {
                Some(format!("line {line}: there is no {number} in what follows"))
            }
            PrintedNumber::Number(printed) | PrintedNumber::Within(printed, _) => {
                match rounded(value.trim(), printed) {
                    Some(should) if should == printed.trim_start_matches('+') => None,
                    Some(should) => {
                        Some(format!("line {line}: `{printed}` should be {should}: {value}, {template}"))
                    }
                    None => Some(format!("line {line}: `{printed}` and `{value}`: {template}")),
                }
            }
        }
    }
}

/// Returns true if a text contains a number, not as a part of a longer one.
fn has_number(text: &str, number: &str) -> bool {
    let apart = |c: Option<char>| c.is_none_or(|c| !c.is_ascii_digit() && c != '.');
    text.match_indices(number).any(|(position, _)| {
        let (before, after) = (&text[..position], &text[position + number.len()..]);
        // A full stop at the end of a sentence is not part of a number.
        let after = after
            .strip_prefix('.')
            .filter(|rest| !rest.starts_with(|c: char| c.is_ascii_digit()))
            .unwrap_or(after);
        apart(before.chars().next_back()) && apart(after.chars().next())
    })
}

/// Returns a value rounded to the digits of a printed number.
fn rounded(value: &str, printed: &str) -> Option<String> {
    let value: f64 = value.parse().ok()?;
    printed.parse::<f64>().ok()?;
    let decimals = |mantissa: &str| mantissa.split_once('.').map_or(0, |(_, decimals)| decimals.len());
    Some(match printed.split_once('e') {
        Some((mantissa, _)) => format!("{value:.*e}", decimals(mantissa)),
        None => format!("{:.*}", decimals(printed), value),
    })
}

/// Tests the numbers of a page, given by its path in the repository.
fn tested(path: &str) {
    let path = format!("{}/../../{path}", env!("CARGO_MANIFEST_DIR"));
    let page = std::fs::read_to_string(&path).expect("a page");
    assert!(
        page.contains("<!--{{") || page.contains("<!--below") || page.contains("<!--made"),
        "{path}: no number"
    );
    let faults = faults(&page).unwrap_or_else(|error| panic!("{path}: {error}"));
    assert!(faults.is_empty(), "{path}:\n{}", faults.join("\n"));
}

#[test]
fn page_of_estimators_has_the_numbers_of_its_commands() {
    tested("docs/scenario/estimators.md");
}

#[test]
fn page_of_sampled_loops_has_the_numbers_of_its_commands() {
    tested("docs/sampled-loops.md");
}

#[test]
fn page_of_active_damping_has_the_numbers_of_its_commands() {
    tested("docs/active-damping.md");
}

#[test]
fn page_of_manoeuvres_has_the_numbers_of_its_commands() {
    tested("docs/manoeuvres.md");
}

#[test]
fn a_wrong_number_is_a_fault() {
    let faults_of = |text: &str| faults(text).map_or_else(|error| error, |faults| faults.join("; "));
    let set = "<!--{% set x = [1.0, 2.0, 4.26e-3] %}-->\n";
    let expected = [
        "So 2<!--{{ x[1] }}--> of them, 4.3e-3<!--{{ x[2] }}--> and -0.0043<!--{{ -x[2] }}--> rad, +1.00<!--{{ x[0] }}-->.",
        "| 1.0<!--{{ x\\|median }}--> |",
        "<!--made\n{% for y in x[:2] %}\n| {{ y|fixed(1) }} |\n{% endfor %}\n-->\n| 1.0 |\n| 2.0 |\n<!--end-->",
        "<!--below 0.004 {{ x[2] }}-->\n<!--below 1.0 {{ x[0] }}-->\n\n    a = 0.004 and 1.0.",
        "<!--below 2 {{ x[1] }}-->\n```\none\n\ntwo: 2\n```\n",
    ];
    for text in expected {
        assert_eq!(faults_of(&format!("{set}{text}")), "", "{text}");
    }
    let wrong = [
        ("3<!--{{ x[1] }}-->", "line 2: `3` should be 2"),
        ("0.005<!--{{ x[2] }}-->", "should be 0.004"),
        ("4.2e-3<!--{{ x[2] }}-->", "should be 4.3e-3"),
        ("none<!--{{ x[1] }}-->", "line 2: `` and `2.0`"),
        ("\n2<!--{{ y }}-->", "line 3: undefined"),
        ("2<!--{{ x[1] --}}-->", "`--`"),
        ("<!--below 2 {{ x[1] }}-->\n\n    a = 0.2 and 25.\n\nand 2.", "no 2 in what follows"),
        ("<!--made\n{{ x[1] }}\n-->\n1.0\n<!--end-->", "`1.0` should be `2.0`"),
        ("2<!--{{ run('simulate scenarios/none.toml') }}-->", "there is no example"),
    ];
    for (text, why) in wrong {
        let fault = faults_of(&format!("{set}{text}"));
        assert!(fault.contains(why), "{text}: {fault}");
    }
}
