//! Page of a paper: its template, filled with the output of the commands that it names.
//!
//! The template is the paper's section of the page, which `tests/frozen/papers.md` keeps. It can use
//! - `run("simulate scenarios/relay-fixed.toml")`: output of the command with `--json`,
//! - `each("plan ... suppress={}", [0, 1])`: list of outputs, with each value in place of `{}`,
//! - `column("simulate ...", "/attitude", "angle_rad")`: column of the run's full log,
//! - `drawing(name, chart, caption, command)`: `Chart` of the page's own numbers,
//! - `figure(name, command, what, caption)`: figure `what` that the command draws, or of the run,
//! - `yes("subject", condition)` and `no(...)`: verdicts that are known to hold, or known not to,
//!
//! and the filters and tests of `number`. An unknown name is an error.

use std::sync::{Arc, Mutex};

use minijinja::syntax::SyntaxConfig;
use minijinja::value::{Serde, Value};
use minijinja::{Environment, Error, ErrorKind, UndefinedBehavior};

use crate::chart::{self, Chart};
use crate::computed::{Computed, locked, svg};
use crate::number;
use crate::verdict::Verdict;

/// Output form of a filled template.
#[derive(Copy, Clone, Debug, PartialEq, Eq)]
pub enum Form {
    /// Markdown of the documentation, with its figures in separate files.
    Markdown,
    /// Markdown that is converted to HTML, with placeholders for its figures.
    Html,
}

/// Figure drawn for a page.
#[derive(Clone, Debug)]
pub struct Drawn {
    /// Name of the figure and of its file.
    pub name: String,
    /// Caption of the figure.
    pub caption: String,
    /// Command that produced the figure.
    pub command: String,
    /// Drawing as SVG.
    pub svg: String,
}

/// Figures and verdicts of a page.
#[derive(Clone, Debug, Default)]
pub struct Outcome {
    /// Figures, in order.
    pub figures: Vec<Drawn>,
    /// Verdicts, in order.
    pub verdicts: Vec<Verdict>,
}

/// Creates the template environment: the functions `run`, `each` and `column`, and the filters and tests of numbers.
///
/// # Errors
/// Only on an internal error of the template syntax.
pub fn environment(computed: &Arc<Computed>) -> Result<Environment<'static>, String> {
    let mut environment = Environment::new();
    environment.set_undefined_behavior(UndefinedBehavior::Strict);
    let syntax =
        SyntaxConfig::builder().trim_blocks(true).lstrip_blocks(true).keep_trailing_newline(true).build();
    environment.set_syntax(syntax.map_err(|error| error.to_string())?);
    number::register(&mut environment);
    chart::register(&mut environment);

    let known = Arc::clone(computed);
    environment.add_function("run", move |command: &str| known.run(command));
    let known = Arc::clone(computed);
    environment.add_function("each", move |command: &str, values: Vec<Value>| {
        let with = |value: &Value| command.replace("{}", &value.to_string());
        values.iter().map(|value| known.run(&with(value))).collect::<Result<Vec<_>, _>>()
    });
    let known = Arc::clone(computed);
    environment.add_function("column", move |command: &str, topic: &str, name: &str| {
        known.column(command, topic, name)
    });
    Ok(environment)
}

/// Fills a template with results, which are computed as needed.
///
/// # Errors
/// If the template is invalid, or a command is unknown or fails.
pub fn fill(computed: &Arc<Computed>, template: &str, form: Form) -> Result<(String, Outcome), String> {
    let outcome = Arc::new(Mutex::new(Outcome::default()));
    let mut environment = environment(computed)?;
    let (known, list) = (Arc::clone(computed), Arc::clone(&outcome));
    let figure = move |name: &str, command: &str, kind: &str, caption: &str| -> Result<String, Error> {
        let (svg, command) = known.draw(command, kind, name)?;
        Ok(show(&list, form, Drawn { name: name.to_owned(), caption: caption.to_owned(), command, svg }))
    };
    environment.add_function("figure", figure);
    let list = Arc::clone(&outcome);
    let drawing = move |name: &str, chart: Serde<Chart>, caption: &str, command: &str| {
        let svg = svg(name, &chart.figure()).map_err(|why| Error::new(ErrorKind::InvalidOperation, why))?;
        let (name, caption, command) = (name.to_owned(), caption.to_owned(), command.to_owned());
        Ok::<String, Error>(show(&list, form, Drawn { name, caption, command, svg }))
    };
    environment.add_function("drawing", drawing);
    for (word, expected) in [("yes", true), ("no", false)] {
        let list = Arc::clone(&outcome);
        environment.add_function(word, move |name: &str, holds: bool| {
            let verdict = Verdict { name: name.to_owned(), holds, expected };
            let reported = match form {
                Form::Markdown => verdict.word().to_owned(),
                Form::Html => format!("<b class=\"{}\">{0}</b>", verdict.word()),
            };
            locked(&list).verdicts.push(verdict);
            reported
        });
    }
    let text = environment.render_str(template, ()).map_err(|error| explained(&error))?;
    drop(environment);
    let outcome = locked(&outcome).clone();
    Ok((text, outcome))
}

fn show(outcome: &Mutex<Outcome>, form: Form, drawn: Drawn) -> String {
    let Drawn { name, caption, command, .. } = &drawn;
    let text = match form {
        Form::Markdown => format!("![{caption}](images/{name}.svg)\n\n{caption}: `flexsc {command}`"),
        Form::Html => format!("<!--figure {name}-->"),
    };
    locked(outcome).figures.push(drawn);
    text
}

/// Formats an error with the line of the template and its cause.
pub fn explained(error: &Error) -> String {
    let line = error.line().map_or(String::new(), |line| format!("line {line}: "));
    format!("{line}{error}")
}

#[cfg(test)]
mod tests {
    use flexsc_figure::Figure;
    use serde_json::{Value as Json, json};

    use super::*;
    use crate::Laboratory;

    /// Laboratory with a single command, for tests.
    struct Toy;

    impl Laboratory for Toy {
        fn run(&self, command: &str) -> Result<Json, String> {
            match command {
                "simulate quiet" => Ok(json!({"pushes_right": 21, "angle_rad": 1.5e-4})),
                _ => Err(format!("{command}: not known")),
            }
        }

        fn column(&self, command: &str, _: &str, _: &str) -> Result<[Vec<f64>; 2], String> {
            Err(format!("{command}: no log"))
        }

        fn draw(&self, command: &str, kind: &str) -> Result<(Figure, String), String> {
            Err(format!("{command}: no figure `{kind}`"))
        }
    }

    fn filled(template: &str) -> Result<(String, Outcome), String> {
        fill(&Arc::new(Computed::new(Toy, |_| {})), template, Form::Markdown)
    }

    #[test]
    fn a_wrong_number_turns_a_verdict() {
        let quiet = "{% set run = run('simulate quiet') %}";
        let number = |printed: &str| {
            let verdict = format!("{{{{ yes('pushes', run.pushes_right is near({printed}, 0.01)) }}}}");
            filled(&format!("{quiet}{{{{ run.pushes_right }}}} {verdict}")).expect("a page")
        };
        let ((expected, known), (wrong, other)) = (number("21"), number("22"));
        assert_eq!([expected.as_str(), wrong.as_str()], ["21 yes", "21 no"]);
        assert!(known.verdicts[0].is_as_expected() && !other.verdicts[0].is_as_expected());
        let refuted = filled("{{ no('more', 1 > 2) }}").expect("a page").1;
        assert!(refuted.verdicts[0].is_as_expected());
        // Missing values are near no number.
        assert_eq!(filled("{{ yes('none', none is near(0, 1)) }}").expect("a page").0, "no");
    }

    #[test]
    fn what_is_not_known_is_an_error() {
        let wrong = [
            ("{{ nothing }}", "undefined"),
            ("{{ run('simulate quiet').settling }}", "undefined"),
            ("{{ 1|squared }}", "squared"),
            ("{{ run('simulate loud') }}", "simulate loud: not known"),
            ("{{ column('simulate quiet', '/attitude', 'angle_rad') }}", "no log"),
            ("{{ figure('a', 'simulate quiet', 'colour', 'A') }}", "no figure `colour`"),
        ];
        for (template, why) in wrong {
            let error = filled(template).expect_err(template);
            assert!(error.contains(why), "{template}: {error}");
        }
    }

    #[test]
    fn numbers_are_printed_as_they_are_asked_for() {
        let list = "[4, none, 1, 3, 2]";
        let cases = [
            ("1.97191e-5|sci(2)".to_owned(), "1.97e-5"),
            ("0.774|percent(1)".to_owned(), "77.4 %"),
            (
                "18000.0|grouped ~ ' ' ~ 2526|grouped ~ ' ' ~ 1234567|grouped".to_owned(),
                "18 000 2526 1 234 567",
            ),
            ("(0.0 * -1)|fixed(2)".to_owned(), "0.00"),
            ("7.398419 is rounds_to('7.399')".to_owned(), "False"),
            ("22.348647 is rounds_to('22.349')".to_owned(), "True"),
            (
                format!("{list}|median ~ ' ' ~ {list}|known ~ ' ' ~ {list}|above(2) ~ ' ' ~ {list}|most"),
                "2.5 4 2 4.0",
            ),
            ("[1, none, 3]|sooner([2, 2, none])".to_owned(), "2"),
            ("minima([0, 1, 2, 3], [3, 1, 2, 0])|join(' ')".to_owned(), "1.0"),
            (
                "stretches([0, 1, 2, 3, 4], [1, 1, none, 1, none], 2)|map('join', ' ')|join(', ')".to_owned(),
                "0.0 1.0",
            ),
            ("([{'a': 'x y', 'b': 1}]|by('a'))['x y'].b".to_owned(), "1"),
            ("[{'frequency': 0.1, 'gain': 2}]|as_schedule".to_owned(), "{frequency=0.100000, gain=2.0000}"),
            ("'a={} b={}'|fill([1, 0.25])".to_owned(), "a=1.0 b=0.25"),
        ];
        for (expression, printed) in cases {
            assert_eq!(
                filled(&format!("{{{{ {expression} }}}}")).expect(&expression).0,
                printed,
                "{expression}"
            );
        }
    }
}
